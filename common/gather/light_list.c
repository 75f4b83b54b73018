/* light_list.c - reads and writes lights.txt: the lamps of a scene, and the openings that let daylight in.
 *
 * People write scenes/NAME/lights.txt with pixels and the word `fit`; this file, written by fit_lights, has
 * everything resolved, in the model's frame. Its reader trusts nothing all the same: normals of unit length, half
 * edges that span an area, radiances and angles within bounds, no name twice, each error with file and line.
 * References of an opening follow its place, nearest first.
 *
 * Half axes of a disk are not in the file: any two directions at right angles do, but they must be the same for the
 * same normal, because samples are placed along them and results are compared bit by bit.
 *
 * A lamp's name may hold any character; as part of a file's name all but letters, digits, - and _ become %XX, and a
 * name that would be too long becomes lampN. */
#include "common/gather/light_list.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/math/numbers.h"
#include "common/math/vec3_read.h"
#include "common/product/product.h"

enum { MAX_NAME = 255, QUOTED_SIZE = 2 * MAX_NAME + 3, MAX_EXPONENT = 10000 };
static const double min_axis = 1e-9; /* of a half edge or radius, in units of the model */

void light_list_release(struct light_list *l)
{
    if (!l) return;
    for (int i = 0; i < l->lamp_count; i++) free(l->lamps[i].name);
    for (int i = 0; i < l->opening_count; i++) {
        for (int k = 0; k < l->openings[i].reference_count; k++) free(l->openings[i].references[k]);
        free(l->openings[i].references);
        free(l->openings[i].name);
    }
    free(l->lamps);
    free(l->openings);
    *l = (struct light_list){0};
}

void light_list_lamp_file(char to[LAMP_FILE_NAME], const struct light_list *l, int lamp)
{
    static const char kept[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
    size_t n = 0;
    for (const char *c = l->lamps[lamp].name; *c; c++) {
        if (n + 4 > LAMP_FILE_NAME) {
            snprintf(to, LAMP_FILE_NAME, "lamp%d", lamp + 1);
            return;
        }
        n += (size_t)snprintf(to + n, LAMP_FILE_NAME - n, strchr(kept, *c) ? "%c" : "%%%02X", (unsigned char)*c);
    }
    to[n] = '\0';
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status copy_name(struct textfile *t, const char *what, char **name, struct err *err)
{
    char word[MAX_NAME + 1];
    if (textfile_word_into(t, what, word, sizeof word, err)) return err->status;
    if (strchr(word, '\r')) return textfile_error(t, err, word, "%s without a line break", what);
    *name = strdup(word);
    return *name ? ST_OK : err_nomem(err, what, strlen(word) + 1);
}

/* The name of the lamp or opening that was added last. */
static enum status read_name(const struct light_list *l, struct textfile *t, char **name, struct err *err)
{
    bool used = false;
    if (copy_name(t, "a name", name, err)) return err->status;
    for (int i = 0; i < l->lamp_count; i++) used |= &l->lamps[i].name != name && !strcmp(l->lamps[i].name, *name);
    for (int i = 0; i < l->opening_count; i++)
        used |= &l->openings[i].name != name && !strcmp(l->openings[i].name, *name);
    return used ? textfile_error(t, err, *name, "a name that no line above has") : ST_OK;
}

/* The half edges of a parallelogram, and its unit normal. */
static enum status read_edges(struct textfile *t, struct vec3 *x, struct vec3 *y, struct vec3 *normal, struct err *err)
{
    if (vec3_read_bounded(t, "the first half edge", x, err) || vec3_read_bounded(t, "the second half edge", y, err))
        return err->status;
    const struct vec3 cross = vec3_cross(*x, *y);
    const double area = vec3_length(cross), most = vec3_length(*x) * vec3_length(*y);
    if (!(area > min_axis * most) || !(fmin(vec3_length(*x), vec3_length(*y)) > min_axis))
        return textfile_error(t, err, "half edges that span no area", "half edges in two directions");
    *normal = vec3_scale(cross, 1 / area);
    return ST_OK;
}

/* Half axes of a disk: any two directions at right angles, the same ones for the same normal. */
static void span_disk(struct lamp *l)
{
    const struct vec3 n = l->normal;
    const struct vec3 other = fabs(n.x) < 0.6 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
    l->x = vec3_scale(vec3_normalize(vec3_cross(other, n)), l->radius);
    l->y = vec3_cross(n, l->x);
}

static enum status read_disk(struct lamp *l, struct textfile *t, struct err *err)
{
    if (vec3_read_bounded(t, "the normal", &l->normal, err)) return err->status;
    const double length = vec3_length(l->normal);
    if (!(fabs(length - 1) < 1e-6)) return textfile_wrong_number(t, length, "a normal of length 1", err);
    if (textfile_double(t, "the radius", &l->radius, err)) return err->status;
    if (!(l->radius > min_axis && l->radius <= 1e9))
        return textfile_wrong_number(t, l->radius, "a radius above 0 and at most 1e9", err);
    span_disk(l);
    return ST_OK;
}

static enum status read_emission(struct lamp *l, struct textfile *t, struct err *err)
{
    double *const s[] = {&l->radiance.r, &l->radiance.g, &l->radiance.b}, degrees;
    for (int i = 0; i < 3; i++)
        if (textfile_number(t, "a radiance", 0, 1e30, s[i], err)) return err->status;
    if (textfile_number(t, "the angle of the cone in degrees", 0, 90, &degrees, err) ||
        textfile_number(t, "the exponent", 0, MAX_EXPONENT, &l->exponent, err))
        return err->status;
    l->beta = degrees / 90 * (0.5 * PI);
    if (!textfile_more(t)) return ST_OK;
    l->bound = true;
    return textfile_expect(t, "bound", err) ? err->status : textfile_end(t, err);
}

static enum status read_lamp(struct light_list *list, struct textfile *t, enum lamp_shape shape, struct err *err)
{
    if (array_append(&list->lamps, (size_t)list->lamp_count, sizeof *list->lamps, "lamps", err)) return err->status;
    struct lamp *l = &list->lamps[list->lamp_count++];
    *l = (struct lamp){.shape = shape};
    if (read_name(list, t, &l->name, err) || vec3_read_bounded(t, "the centre", &l->centre, err)) return err->status;
    if (shape == LAMP_DISK ? read_disk(l, t, err) : read_edges(t, &l->x, &l->y, &l->normal, err)) return err->status;
    return read_emission(l, t, err);
}

static enum status read_references(struct daylight *o, struct textfile *t, struct err *err)
{
    if (!textfile_more(t)) return ST_OK;
    if (textfile_expect(t, "reference", err)) return err->status;
    do {
        if (array_append(&o->references, (size_t)o->reference_count, sizeof *o->references, "references", err) ||
            copy_name(t, "the id of a lighting reference image", &o->references[o->reference_count], err))
            return err->status;
        o->reference_count++;
    } while (textfile_more(t));
    return ST_OK;
}

static enum status read_opening(struct light_list *list, struct textfile *t, struct err *err)
{
    if (array_append(&list->openings, (size_t)list->opening_count, sizeof *list->openings, "openings", err))
        return err->status;
    struct daylight *o = &list->openings[list->opening_count++];
    *o = (struct daylight){0};
    if (read_name(list, t, &o->name, err) || vec3_read_bounded(t, "the centre", &o->centre, err) ||
        read_edges(t, &o->x, &o->y, &o->normal, err))
        return err->status;
    return read_references(o, t, err);
}

static enum status read_statement(struct light_list *l, struct textfile *t, struct err *err)
{
    char *verb;
    if (textfile_word(t, "a statement", &verb, err)) return err->status;
    if (!strcmp(verb, "disk")) return read_lamp(l, t, LAMP_DISK, err);
    if (!strcmp(verb, "quad")) return read_lamp(l, t, LAMP_QUAD, err);
    if (!strcmp(verb, "opening")) return read_opening(l, t, err);
    return textfile_error(t, err, verb, "disk, quad or opening");
}

enum status light_list_read(struct light_list *l, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *l = (struct light_list){0};
    product_open(&t, NULL, PRODUCT_LIGHTS, path, prov, err);
    while (!err->status && textfile_next(&t)) read_statement(l, &t, err);
    textfile_release(&t);
    if (err->status) light_list_release(l);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static void write_vector(FILE *to, struct vec3 v) { fprintf(to, " %.17g %.17g %.17g", v.x, v.y, v.z); }

static enum status write_name(FILE *to, const char *verb, const char *name, struct err *err)
{
    char quoted[QUOTED_SIZE];
    if (textfile_quote(name, quoted, sizeof quoted, err)) return err->status;
    fprintf(to, "%s %s", verb, quoted);
    return ST_OK;
}

static enum status write_lamp(const struct lamp *l, FILE *to, struct err *err)
{
    if (write_name(to, l->shape == LAMP_DISK ? "disk" : "quad", l->name, err)) return err->status;
    write_vector(to, l->centre);
    if (l->shape == LAMP_DISK) {
        write_vector(to, l->normal);
        fprintf(to, " %.17g", l->radius);
    } else {
        write_vector(to, l->x);
        write_vector(to, l->y);
    }
    fprintf(to, " %.17g %.17g %.17g %.17g %.17g%s\n", l->radiance.r, l->radiance.g, l->radiance.b,
            l->beta / (0.5 * PI) * 90, l->exponent, l->bound ? " bound" : "");
    return ST_OK;
}

static enum status write_opening(const struct daylight *o, FILE *to, struct err *err)
{
    if (write_name(to, "opening", o->name, err)) return err->status;
    write_vector(to, o->centre);
    write_vector(to, o->x);
    write_vector(to, o->y);
    for (int i = 0; i < o->reference_count; i++)
        if (write_name(to, i ? "" : " reference", o->references[i], err)) return err->status;
    fputc('\n', to);
    return ST_OK;
}

enum status light_list_write(const struct light_list *l, const char *path, const struct provenance *prov,
                             struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_LIGHTS, path, prov, err);
    for (int i = 0; !err->status && i < l->lamp_count; i++) write_lamp(&l->lamps[i], f.fp, err);
    for (int i = 0; !err->status && i < l->opening_count; i++) write_opening(&l->openings[i], f.fp, err);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
