/* annotations.c - reads lights.txt as people write it: which openings let daylight in, lamps, and marked points.
 *
 * A line is a statement with a name: window, shut, disk, area, lit, unlit, line. It is read into one form with the
 * pixels in the order of the line; what they mean in the model is found later (lit_scene.c). An option may be given
 * once, and a quantity is a number or the word `fit`.
 *
 * Names. A window or a lamp may be declared once. Points name their lamp, which may stand below them, so they are
 * connected after the last line. Points without a material are of one named like the lamp.
 *
 * All bounds are checked here, with file and line, so that later stages only meet geometry that is wrong, not
 * numbers. */
#include "stages/fit_lights/annotations.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

enum { MAX_NAME = 255 };

static const char *const words[NOTE_KINDS] = {"window", "shut", "disk", "area", "lit", "unlit", "line"};

const char *annotation_word(enum annotation_kind kind) { return words[kind]; }

void annotation_list_release(struct annotation_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        struct annotation *a = &list->items[i];
        for (int k = 0; k < a->reference_count; k++) free(a->references[k]);
        free(a->references);
        free(a->name);
        free(a->view);
        free(a->material);
    }
    free(list->items);
    free(list->path);
    *list = (struct annotation_list){0};
}

static enum status copy_word(struct textfile *t, const char *what, char **to, struct err *err)
{
    char word[MAX_NAME + 1];
    if (textfile_word_into(t, what, word, sizeof word, err)) return err->status;
    if (strchr(word, '\r')) return textfile_error(t, err, word, "%s without a line break", what);
    *to = strdup(word);
    return *to ? ST_OK : err_nomem(err, what, strlen(word) + 1);
}

static enum status read_pixels(struct annotation *a, struct textfile *t, int count, struct err *err)
{
    for (int i = 0; i < count; i++) {
        double *p = &a->pixel[2 * (a->pixels + i)];
        if (textfile_number(t, "a pixel's x", 0, 1e6, &p[0], err) ||
            textfile_number(t, "a pixel's y", 0, 1e6, &p[1], err))
            return err->status;
    }
    a->pixels += count;
    return ST_OK;
}

/* "in VIEW" and the first pixels. */
static enum status read_place(struct annotation *a, struct textfile *t, int count, struct err *err)
{
    if (textfile_expect(t, "in", err) || copy_word(t, "a photo's id or a view's name", &a->view, err) ||
        read_pixels(a, t, count, err))
        return err->status;
    return ST_OK;
}

static enum status read_references(struct annotation *a, struct textfile *t, struct err *err)
{
    if (!textfile_more(t)) return ST_OK;
    if (textfile_expect(t, "reference", err)) return err->status;
    do {
        if (array_append(&a->references, (size_t)a->reference_count, sizeof *a->references, "references", err) ||
            copy_word(t, "the id of a lighting reference image", &a->references[a->reference_count], err))
            return err->status;
        a->reference_count++;
    } while (textfile_more(t));
    return ST_OK;
}

/* A number, or the word "fit". */
static enum status read_quantity(struct textfile *t, const char *what, double max, enum quantity *has, double *value,
                                 struct err *err)
{
    char *word;
    if (*has) return textfile_error(t, err, what, "%s only once", what);
    if (textfile_word(t, what, &word, err)) return err->status;
    *has = QUANTITY_FIT;
    if (!strcmp(word, "fit")) return ST_OK;
    *has = QUANTITY_GIVEN;
    if (!scan_double(word, value) || !(*value >= 0 && *value <= max))
        return textfile_error(t, err, word, "%s from 0 to %g, or fit", what, max);
    return ST_OK;
}

static enum status read_beta(struct annotation *a, struct textfile *t, struct err *err)
{
    if (read_quantity(t, "the cone's angle beta", 90, &a->has_beta, &a->beta, err)) return err->status;
    if (a->has_beta == QUANTITY_GIVEN && !(a->beta > 0))
        return textfile_error(t, err, "beta 0", "an angle above 0 degrees: a lamp with a cone of 0 lights nothing");
    return ST_OK;
}

static enum status read_normal(struct annotation *a, struct textfile *t, struct err *err)
{
    double n[3];
    if (a->has_normal) return textfile_error(t, err, "normal", "the normal only once");
    a->has_normal = true;
    for (int i = 0; i < 3; i++)
        if (textfile_number(t, "a part of the normal", -1e6, 1e6, &n[i], err)) return err->status;
    const double length = vec3_length(vec3_make(n[0], n[1], n[2]));
    if (!(length > 1e-6)) return textfile_wrong_number(t, length, "a normal with a length above 0", err);
    a->normal = vec3_scale(vec3_make(n[0], n[1], n[2]), 1 / length);
    return ST_OK;
}

static enum status read_radiance(struct annotation *a, struct textfile *t, struct err *err)
{
    if (a->has_radiance) return textfile_error(t, err, "radiance", "the radiance only once");
    a->has_radiance = QUANTITY_GIVEN;
    for (int i = 0; i < 3; i++)
        if (textfile_number(t, "a radiance", 0, 1e30, &a->radiance[i], err)) return err->status;
    return ST_OK;
}

static enum status read_options(struct annotation *a, struct textfile *t, struct err *err)
{
    const bool disk = a->kind == NOTE_DISK;
    char *word;
    while (textfile_more(t)) {
        if (textfile_word(t, "an option", &word, err)) return err->status;
        if (!strcmp(word, "radiance"))
            read_radiance(a, t, err);
        else if (!strcmp(word, "off"))
            textfile_number(t, "a distance", 0, 1000, &a->off, err);
        else if (disk && !strcmp(word, "normal"))
            read_normal(a, t, err);
        else if (disk && !strcmp(word, "beta"))
            read_beta(a, t, err);
        else if (disk && !strcmp(word, "exponent"))
            read_quantity(t, "the exponent", 1000, &a->has_exponent, &a->exponent, err);
        else
            return textfile_error(t, err, word, disk ? "off, normal, beta, exponent or radiance" : "off or radiance");
        if (err->status) return err->status;
    }
    return ST_OK;
}

static enum status read_disk(struct annotation *a, struct textfile *t, struct err *err)
{
    if (read_place(a, t, 1, err) || textfile_expect(t, "rim", err) || read_pixels(a, t, 1, err)) return err->status;
    return read_options(a, t, err);
}

static enum status read_area(struct annotation *a, struct textfile *t, struct err *err)
{
    return read_place(a, t, 4, err) ? err->status : read_options(a, t, err);
}

/* The rest of a rectangle, whose lower right x is a word of the line. */
static enum status read_corner(struct annotation *a, struct textfile *t, const char *x, struct err *err)
{
    if (textfile_number_of(t, x, "of, or a pixel's x", 0, 1e6, &a->pixel[2], err) ||
        textfile_number(t, "a pixel's y", 0, 1e6, &a->pixel[3], err))
        return err->status;
    a->pixels = 2;
    if (a->pixel[2] > a->pixel[0] && a->pixel[3] > a->pixel[1]) return ST_OK;
    return textfile_error(t, err, "an empty rectangle", "its upper left and its lower right pixel");
}

static enum status read_point(struct annotation *a, struct textfile *t, struct err *err)
{
    char *word;
    if (read_place(a, t, 1, err)) return err->status;
    if (!textfile_more(t)) return ST_OK;
    if (textfile_word(t, "a pixel's x, or of", &word, err)) return err->status;
    if (strcmp(word, "of")) {
        if (read_corner(a, t, word, err)) return err->status;
        if (!textfile_more(t)) return ST_OK;
        if (textfile_expect(t, "of", err)) return err->status;
    }
    return copy_word(t, "the name of a material", &a->material, err) ? err->status : textfile_end(t, err);
}

static enum status read_line(struct annotation *a, struct textfile *t, struct err *err)
{
    if (read_place(a, t, 2, err)) return err->status;
    if (hypot(a->pixel[2] - a->pixel[0], a->pixel[3] - a->pixel[1]) < 4)
        return textfile_error(t, err, "a shorter line", "a line of at least 4 pixels");
    if (!textfile_more(t)) return ST_OK;
    if (textfile_expect(t, "of", err) || copy_word(t, "the name of a material", &a->material, err)) return err->status;
    return textfile_end(t, err);
}

/* A second statement about the same window or lamp. */
static enum status check_name(const struct annotation_list *list, const struct annotation *a, struct textfile *t,
                              struct err *err)
{
    if (a->kind >= NOTE_LIT) return ST_OK;
    for (int i = 0; i < list->count; i++) {
        const struct annotation *b = &list->items[i];
        if (b != a && b->kind < NOTE_LIT && !strcmp(b->name, a->name))
            return textfile_error(t, err, a->name, "a name that line %d does not have", b->line);
    }
    return ST_OK;
}

static enum status read_statement(struct annotation_list *list, struct textfile *t, struct err *err)
{
    char *word;
    int kind = 0;
    if (textfile_word(t, "a statement", &word, err)) return err->status;
    while (kind < NOTE_KINDS && strcmp(word, words[kind])) kind++;
    if (kind == NOTE_KINDS) return textfile_error(t, err, word, "window, shut, disk, area, lit, unlit or line");
    if (array_append(&list->items, (size_t)list->count, sizeof *list->items, "lines", err)) return err->status;
    struct annotation *a = &list->items[list->count++];
    *a = (struct annotation){.kind = (enum annotation_kind)kind, .line = t->line, .lamp = -1};
    if (copy_word(t, "a name", &a->name, err) || check_name(list, a, t, err)) return err->status;
    switch (a->kind) {
    case NOTE_WINDOW:
        return read_references(a, t, err);
    case NOTE_SHUT:
        return textfile_end(t, err);
    case NOTE_DISK:
        return read_disk(a, t, err);
    case NOTE_AREA:
        return read_area(a, t, err);
    case NOTE_LINE:
        return read_line(a, t, err);
    default:
        return read_point(a, t, err);
    }
}

static enum status find_lamps(struct annotation_list *list, struct err *err)
{
    for (int i = 0; i < list->count; i++) {
        struct annotation *a = &list->items[i];
        if (a->kind < NOTE_LIT) continue;
        for (int k = 0; k < list->count; k++)
            if ((list->items[k].kind == NOTE_DISK || list->items[k].kind == NOTE_AREA) &&
                !strcmp(list->items[k].name, a->name))
                a->lamp = k;
        if (a->lamp < 0)
            return err_set(err, ST_DATA, "%s:%d: found %s, wanted the name of a lamp: a line disk or area.", list->path,
                           a->line, a->name);
        if (a->kind == NOTE_LINE && list->items[a->lamp].kind == NOTE_AREA)
            return err_set(err, ST_DATA, "%s:%d: found a line of %s, which is an area lamp; only a disk has a cone.",
                           list->path, a->line, a->name);
        if (a->kind == NOTE_LINE && list->items[a->lamp].has_beta == QUANTITY_GIVEN)
            return err_set(err, ST_DATA, "%s:%d: found a line of %s, but line %d gives its beta; write beta fit there.",
                           list->path, a->line, a->name, list->items[a->lamp].line);
    }
    return ST_OK;
}

enum status annotation_list_read(struct annotation_list *list, const char *path, struct provenance *prov,
                                 struct err *err)
{
    struct textfile t = {0};
    int64_t version;
    *list = (struct annotation_list){.path = strdup(path)};
    if (!list->path) err_nomem(err, "a path", strlen(path) + 1);
    if (!err->status && !provenance_open(prov, "lights.txt", &t, path, err) &&
        !textfile_expect_line(&t, "remodel-lamps", err) && !textfile_int(&t, "the version", 1, 1, &version, err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_statement(list, &t, err);
    textfile_release(&t);
    if (!err->status) find_lamps(list, err);
    if (err->status) annotation_list_release(list);
    return err->status;
}
