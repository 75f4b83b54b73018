/* thing_list.c - the list of things and its file; see thing_list.h. */
#include "common/model/thing_list.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

#define NORMAL_SLACK 1e-6

enum { MAX_CORNERS = 100000 };

static const char *const words[THING_SUPPORTS] = {"floor", "wall", "ceiling", "none"};

const char *thing_support_word(enum thing_support support) { return words[support]; }

int thing_list_find(const struct thing_list *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->things[i].name, name)) return i;
    return -1;
}

static void release(struct thing *t)
{
    free(t->name);
    free(t->view);
    flat_outline_release(&t->outline);
    *t = (struct thing){0};
}

enum status thing_list_add(struct thing_list *list, struct thing *t, struct err *err)
{
    if (!t->name || !t->view)
        err_nomem(err, "a thing", sizeof *t);
    else if (!array_append(&list->things, (size_t)list->count, sizeof *list->things, "things", err)) {
        list->things[list->count++] = *t;
        *t = (struct thing){0};
    }
    release(t);
    return err->status;
}

void thing_list_release(struct thing_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) release(&list->things[i]);
    free(list->things);
    *list = (struct thing_list){0};
}

struct vec3 thing_radiance_of_side(const struct thing *t, struct vec3 normal)
{
    const double n[3] = {normal.x, normal.y, normal.z};
    struct vec3 sum = {0, 0, 0};
    if (!(vec3_length(normal) > 0)) return vec3_make(t->radiance[0], t->radiance[1], t->radiance[2]);
    for (int k = 0; k < 3; k++) {
        const double *side = t->sides[2 * k + (n[k] < 0)];
        sum = vec3_add(sum, vec3_scale(vec3_make(side[0], side[1], side[2]), n[k] * n[k]));
    }
    return sum;
}

static void write_sides(FILE *to, const struct thing *t)
{
    fputs("sides", to);
    for (int i = 0; i < 3 * THING_SIDES; i++) fprintf(to, " %.9g", t->sides[i / 3][i % 3]);
    fputc('\n', to);
}

static void write_outline(FILE *to, const struct flat_outline *o)
{
    fprintf(to, "flat %.17g %.17g %.17g %.17g %d", o->normal.x, o->normal.y, o->normal.z, o->offset, o->count);
    for (int i = 0; i < o->count; i++) fprintf(to, " %.17g %.17g", o->xy[i][0], o->xy[i][1]);
    fputc('\n', to);
}

enum status thing_list_write(const struct thing_list *list, const char *path, const struct provenance *prov,
                             struct err *err)
{
    struct outfile f = {0};
    char name[FILE_PATH], view[FILE_PATH];
    product_begin(&f, PRODUCT_THINGS, path, prov, err);
    for (int i = 0; !err->status && i < list->count; i++) {
        const struct thing *t = &list->things[i];
        if (!textfile_quote(t->name, name, sizeof name, err) && !textfile_quote(t->view, view, sizeof view, err))
            fprintf(f.fp,
                    "thing %s %s %.9g %.9g %.9g %.9g %.9g %.9g %" PRId64 " %d %s %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n",
                    name, words[t->support], t->low.x, t->low.y, t->low.z, t->high.x, t->high.y, t->high.z, t->voxels,
                    t->views, view, t->rect[0], t->rect[1], t->rect[2], t->rect[3], t->radiance[0], t->radiance[1],
                    t->radiance[2]);
        if (!err->status) write_sides(f.fp, t);
        if (!err->status && t->outline.count) write_outline(f.fp, &t->outline);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static enum status read_support(struct textfile *f, enum thing_support *support, struct err *err)
{
    char *word;
    if (textfile_word(f, "what it stands on", &word, err)) return err->status;
    for (int i = 0; i < THING_SUPPORTS; i++)
        if (!strcmp(words[i], word)) {
            *support = (enum thing_support)i;
            return ST_OK;
        }
    return textfile_error(f, err, word, "floor, wall, ceiling or none");
}

static enum status read_thing(struct thing *t, struct textfile *f, struct err *err)
{
    double *const box[] = {&t->low.x, &t->low.y, &t->low.z, &t->high.x, &t->high.y, &t->high.z};
    char *word;
    int64_t views = 0;
    if (textfile_word(f, "name", &word, err)) return err->status;
    if (!(t->name = strdup(word))) return err_nomem(err, "a name", strlen(word));
    if (read_support(f, &t->support, err)) return err->status;
    for (int i = 0; i < 6; i++)
        if (textfile_double(f, "corner of the box", box[i], err)) return err->status;
    if (!(t->low.x < t->high.x && t->low.y < t->high.y && t->low.z < t->high.z))
        return textfile_error(f, err, "a box without size", "a lower corner, then an upper one");
    if (textfile_int(f, "voxels", 1, INT64_MAX, &t->voxels, err) || textfile_int(f, "views", 0, INT_MAX, &views, err) ||
        textfile_word(f, "view", &word, err))
        return err->status;
    t->views = (int)views;
    if (!(t->view = strdup(word))) return err_nomem(err, "a name", strlen(word));
    for (int i = 0; i < 4; i++)
        if (textfile_double(f, "edge of the rectangle", &t->rect[i], err)) return err->status;
    if (!(t->rect[0] <= t->rect[2] && t->rect[1] <= t->rect[3]))
        return textfile_error(f, err, "a rectangle without size", "its left and upper edge, then right and lower");
    for (int i = 0; i < 3; i++)
        if (textfile_number(f, "mean radiance", 0, INFINITY, &t->radiance[i], err)) return err->status;
    for (int k = 0; k < THING_SIDES; k++) memcpy(t->sides[k], t->radiance, sizeof t->sides[k]);
    return textfile_end(f, err);
}

/* The line "sides" of a thing, whose first word has been read. */
static enum status read_sides(struct thing *t, struct textfile *f, struct err *err)
{
    for (int i = 0; i < 3 * THING_SIDES; i++)
        if (textfile_number(f, "radiance of a side", 0, INFINITY, &t->sides[i / 3][i % 3], err)) return err->status;
    return textfile_end(f, err);
}

/* The line "flat" of a thing, whose first word has been read. */
static enum status read_outline(struct flat_outline *o, struct textfile *f, struct err *err)
{
    struct vec3 normal = {0, 0, 0};
    double offset = 0, *const plane[] = {&normal.x, &normal.y, &normal.z, &offset};
    int64_t count = 0;
    for (int i = 0; i < 4; i++)
        if (textfile_double(f, "the plane of a face", plane[i], err)) return err->status;
    if (!(fabs(vec3_length(normal) - 1) < NORMAL_SLACK))
        return textfile_wrong_number(f, vec3_length(normal), "a normal of length 1", err);
    if (textfile_int(f, "a number of corners", 3, MAX_CORNERS, &count, err) ||
        flat_outline_init(o, normal, offset, (int)count, err))
        return err->status;
    for (int i = 0; i < 2 * o->count; i++)
        if (textfile_double(f, "coordinate of a corner", &o->xy[i / 2][i % 2], err)) return err->status;
    return textfile_end(f, err);
}

static enum status read_line(struct thing_list *list, struct textfile *f, struct err *err)
{
    struct thing t = {0};
    char *word;
    struct thing *last = list->count ? &list->things[list->count - 1] : NULL;
    if (textfile_word(f, "thing, sides or flat", &word, err)) return err->status;
    const bool sides = !strcmp(word, "sides"), flat = !strcmp(word, "flat");
    if ((sides || flat) && (!last || last->outline.count))
        return textfile_error(f, err, word, "a line \"thing\" before it");
    if (sides) return read_sides(last, f, err);
    if (flat) return read_outline(&last->outline, f, err);
    if (strcmp(word, "thing")) return textfile_error(f, err, word, "thing, sides or flat");
    if (!read_thing(&t, f, err) && thing_list_find(list, t.name) >= 0)
        textfile_error(f, err, t.name, "another name than those above");
    if (!err->status) return thing_list_add(list, &t, err);
    release(&t);
    return err->status;
}

enum status thing_list_read(struct thing_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile f = {0};
    *list = (struct thing_list){0};
    product_open(&f, NULL, PRODUCT_THINGS, path, prov, err);
    while (!err->status && textfile_next(&f)) read_line(list, &f, err);
    textfile_release(&f);
    if (err->status) thing_list_release(list);
    return err->status;
}
