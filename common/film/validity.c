/* validity.c - reading and writing of validity.txt: the setup of a move, and the viewpoints that are valid for its
 * ends.
 *
 * The file has a line for each field, in a fixed order, then for each end of the move its target with its focal
 * length or the size that it keeps, and a region: a grid of cells across the move, each with what was found there.
 * Numbers have 17 digits: plan_path, which reads them, must see the viewpoints that sample_validity tried, to the
 * bit.
 *
 * A reader of a later stage relies on what is checked here: a film of even size, positive lengths, boxes with an
 * inside, cells in a number that fits into memory. */
#include "common/film/validity.h"

#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"
#include "common/math/vec3_read.h"
#include "common/product/product.h"

enum { MAX_CELLS = 4096 };

enum status validity_region_init(struct validity_region *r, int columns, int rows, struct err *err)
{
    const size_t count = (size_t)columns * (size_t)rows;
    *r = (struct validity_region){columns, rows, calloc(count, sizeof *r->cells)};
    return r->cells ? ST_OK : err_nomem(err, "a region of viewpoints", count * sizeof *r->cells);
}

int validity_region_count(const struct validity_region *r)
{
    int count = 0;
    for (int i = 0; i < r->columns * r->rows; i++) count += r->cells[i].valid;
    return count;
}

double validity_region_at(const struct validity_region *r, double x, double y, double *low, double *high)
{
    const struct validity_cell *first = &r->cells[0], *last = &r->cells[r->columns * r->rows - 1];
    const double step[2] = {r->columns > 1 ? (last->x - first->x) / (r->columns - 1) : 1,
                            r->rows > 1 ? (last->y - first->y) / (r->rows - 1) : 1};
    const double at[2] = {(x - first->x) / step[0], (y - first->y) / step[1]};
    const int size[2] = {r->columns, r->rows};
    int base[2];
    double part[2];
    for (int k = 0; k < 2; k++) {
        base[k] = (int)floor(clamp(at[k], -1, size[k]));
        part[k] = clamp(at[k] - base[k], 0, 1);
    }
    double valid = 0;
    *low = *high = 0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const int c = base[0] + i, w = base[1] + j;
            const double weight = (i ? part[0] : 1 - part[0]) * (j ? part[1] : 1 - part[1]);
            if (c < 0 || w < 0 || c >= size[0] || w >= size[1] || !r->cells[w * size[0] + c].valid) continue;
            *low += weight * r->cells[w * size[0] + c].low;
            *high += weight * r->cells[w * size[0] + c].high;
            valid += weight;
        }
    return valid;
}

void validity_release(struct validity *v)
{
    if (!v) return;
    for (int i = 0; i < 2; i++) free(v->region[i].cells);
    *v = (struct validity){0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

/* Goes to the next line, which must begin with `key`. */
static enum status read_key(struct textfile *t, const char *key, struct err *err)
{
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "\"%s\"", key);
    return textfile_expect(t, key, err);
}

static enum status read_numbers(struct textfile *t, const char *key, double *values, int count, struct err *err)
{
    read_key(t, key, err);
    for (int i = 0; !err->status && i < count; i++) textfile_double(t, key, &values[i], err);
    if (!err->status) textfile_end(t, err);
    return err->status;
}

static enum status read_shot(struct textfile *t, struct validity *v, struct err *err)
{
    struct shot_setup *s = &v->shot;
    struct view *l = &s->lens;
    struct vec3 *const vectors[] = {&s->up, &s->origin, &s->axis_x, &s->axis_y, &s->axis_z, &s->centroid};
    static const char *const keys[] = {"up", "origin", "axis_x", "axis_y", "axis_z", "centroid"};
    double film[5], near[1], box[4], limits[3];

    if (read_numbers(t, "film", film, 5, err)) return err->status;
    for (int i = 0; i < 2; i++)
        if (!(film[i] >= 2 && film[i] <= 65536 && fmod(film[i], 2) == 0))
            return textfile_error(t, err, "an invalid size of the film", "even numbers from 2 to 65536");
    if (!(film[2] > 0)) return textfile_error(t, err, "a focal length of 0 or less", "one above 0");
    *l = (struct view){.name = "film",
                       .width = (int)film[0],
                       .height = (int)film[1],
                       .fx = film[2],
                       .fy = film[2],
                       .cx = film[3],
                       .cy = film[4]};
    if (read_numbers(t, "zoom", &v->zoom, 1, err)) return err->status;
    if (!(v->zoom > 0)) return textfile_error(t, err, "a zoom of 0 or less", "one above 0");
    if (read_numbers(t, "near_limit", near, 1, err) || read_numbers(t, "median_depth", &s->median_depth, 1, err))
        return err->status;
    s->near_limit = near[0];
    if (!(s->median_depth > 0)) return textfile_error(t, err, "a median depth of 0 or less", "one above 0");
    for (int i = 0; i < 6; i++)
        if (read_key(t, keys[i], err) || vec3_read(t, keys[i], vectors[i], err) || textfile_end(t, err))
            return err->status;
    if (read_numbers(t, "box", box, 4, err)) return err->status;
    for (int i = 0; i < 2; i++) {
        s->low[i] = box[i];
        s->high[i] = box[2 + i];
        if (!(s->low[i] < s->high[i])) return textfile_error(t, err, "an empty box", "LOW_X LOW_Y HIGH_X HIGH_Y");
    }
    if (read_numbers(t, "limits", limits, 3, err)) return err->status;
    if (!(limits[2] >= 1 && limits[2] <= 65536)) return textfile_error(t, err, "an invalid side", "1 to 65536 px");
    v->limits = (struct viewpoint_limits){limits[0], limits[1], (int)limits[2]};
    if (read_numbers(t, "step", &v->step, 1, err)) return err->status;
    return v->step > 0 ? ST_OK : textfile_error(t, err, "a step of 0 or less", "one above 0");
}

static enum status read_end(struct textfile *t, struct shot_end *e, struct err *err)
{
    char *word;
    if (read_key(t, "end", err) || textfile_expect(t, "target", err) || vec3_read(t, "the target", &e->target, err) ||
        textfile_word(t, "\"focal\" or \"size\"", &word, err))
        return err->status;
    if (!strcmp(word, "focal")) {
        if (textfile_double(t, "the focal length", &e->focal, err)) return err->status;
        if (!(e->focal > 0)) return textfile_error(t, err, "a focal length of 0 or less", "one above 0");
        if (!textfile_more(t)) return ST_OK;
        if (textfile_expect(t, "most", err)) return err->status;
    } else if (strcmp(word, "size"))
        return textfile_error(t, err, word, "\"focal\" or \"size\"");
    if (textfile_double(t, "the size", &e->size, err)) return err->status;
    if (!(e->size > 0)) return textfile_error(t, err, "a size of 0 or less", "one above 0");
    for (int i = 0; i < 4; i++)
        if (vec3_read(t, "a corner", &e->corner[i], err)) return err->status;
    return textfile_end(t, err);
}

static enum status read_region(struct textfile *t, struct validity_region *r, struct err *err)
{
    int64_t columns, rows;
    if (read_key(t, "region", err) || textfile_int(t, "columns", 1, MAX_CELLS, &columns, err) ||
        textfile_int(t, "rows", 1, MAX_CELLS / columns, &rows, err) || textfile_end(t, err) ||
        validity_region_init(r, (int)columns, (int)rows, err))
        return err->status;
    for (int i = 0; i < r->columns * r->rows; i++) {
        struct validity_cell *c = &r->cells[i];
        char *word;
        if (read_key(t, "cell", err) || textfile_double(t, "x", &c->x, err) || textfile_double(t, "y", &c->y, err) ||
            textfile_word(t, "\"from\" or \"none\"", &word, err))
            return err->status;
        c->valid = strcmp(word, "none");
        if (c->valid && strcmp(word, "from")) return textfile_error(t, err, word, "\"from\" or \"none\"");
        if (c->valid && (textfile_double(t, "the lowest z", &c->low, err) || textfile_expect(t, "to", err) ||
                         textfile_double(t, "the highest z", &c->high, err)))
            return err->status;
        if (!(c->low <= c->high)) return textfile_error(t, err, "a lowest z above the highest", "from LOW_Z to HIGH_Z");
        if (textfile_end(t, err)) return err->status;
    }
    return ST_OK;
}

enum status validity_read(struct validity *v, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    char *word;
    int64_t number;
    struct err why = ERR_INIT;

    *v = (struct validity){0};
    if (!product_open(&t, NULL, PRODUCT_VALIDITY, path, prov, err) && !read_key(&t, "effect", err))
        textfile_word(&t, "an effect", &word, err);
    if (!err->status && film_effect_parse(&v->effect, word, &why))
        err_set(err, ST_DATA, "%s:%d: %s", path, t.line, why.text);
    if (!err->status) textfile_end(&t, err);
    v->move.move = v->effect.move;
    if (!err->status && !read_shot(&t, v, err) && !read_key(&t, "on_axis", err) &&
        !textfile_int(&t, "on_axis", 0, 1, &number, err) && !textfile_end(&t, err))
        v->move.on_axis = number;
    for (int i = 0; !err->status && i < 2; i++)
        if (!read_end(&t, &v->move.end[i], err)) read_region(&t, &v->region[i], err);
    if (!err->status && textfile_next(&t)) textfile_error(&t, err, "another line", "the end of the file");
    textfile_release(&t);
    if (err->status) validity_release(v);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static void print_vector(FILE *fp, struct vec3 v) { fprintf(fp, " %.17g %.17g %.17g", v.x, v.y, v.z); }

static void print_key_vector(FILE *fp, const char *key, struct vec3 v)
{
    fputs(key, fp);
    print_vector(fp, v);
    fputc('\n', fp);
}

static void print_end(FILE *fp, const struct shot_end *e)
{
    fputs("end target", fp);
    print_vector(fp, e->target);
    if (e->focal > 0) fprintf(fp, " focal %.17g", e->focal);
    if (e->size > 0) {
        fprintf(fp, " %s %.17g", e->focal > 0 ? "most" : "size", e->size);
        for (int i = 0; i < 4; i++) print_vector(fp, e->corner[i]);
    }
    fputc('\n', fp);
}

static void print_region(FILE *fp, const struct validity_region *r)
{
    fprintf(fp, "region %d %d\n", r->columns, r->rows);
    for (int i = 0; i < r->columns * r->rows; i++) {
        const struct validity_cell *c = &r->cells[i];
        fprintf(fp, "cell %.17g %.17g", c->x, c->y);
        if (c->valid)
            fprintf(fp, " from %.17g to %.17g\n", c->low, c->high);
        else
            fputs(" none\n", fp);
    }
}

enum status validity_write(const struct validity *v, const char *path, const struct provenance *prov, struct err *err)
{
    const struct shot_setup *s = &v->shot;
    struct outfile f = {0};
    char effect[EFFECT_NAME_SIZE];
    if (product_begin(&f, PRODUCT_VALIDITY, path, prov, err)) return err->status;
    film_effect_name(&v->effect, effect);
    fprintf(f.fp, "effect %s\nfilm %d %d %.17g %.17g %.17g\nzoom %.17g\n", effect, s->lens.width, s->lens.height,
            s->lens.fx, s->lens.cx, s->lens.cy, v->zoom);
    fprintf(f.fp, "near_limit %.17g\nmedian_depth %.17g\n", s->near_limit, s->median_depth);
    print_key_vector(f.fp, "up", s->up);
    print_key_vector(f.fp, "origin", s->origin);
    print_key_vector(f.fp, "axis_x", s->axis_x);
    print_key_vector(f.fp, "axis_y", s->axis_y);
    print_key_vector(f.fp, "axis_z", s->axis_z);
    print_key_vector(f.fp, "centroid", s->centroid);
    fprintf(f.fp, "box %.17g %.17g %.17g %.17g\n", s->low[0], s->low[1], s->high[0], s->high[1]);
    fprintf(f.fp, "limits %.17g %.17g %d\nstep %.17g\non_axis %d\n", v->limits.max_h, v->limits.max_outside,
            v->limits.side, v->step, v->move.on_axis);
    for (int i = 0; i < 2; i++) {
        print_end(f.fp, &v->move.end[i]);
        print_region(f.fp, &v->region[i]);
    }
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
