/* bright_ceilings.c - see bright_ceilings.h.
 *
 * Each face that looks down is cut into cells. A cell is bright if at least half of the views that see it show it
 * saturated, or brighter than a limit. What hangs below a ceiling shows at another place of it in each photo, so its
 * cells are not bright. Bright cells that touch are one place; its rectangle has their extent, and their area. */
#include "stages/fit_lights/bright_ceilings.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/capture/view_image.h"

static const double CELL = 0.03;   /* of the model's height */
static const double LEAST = 0.004; /* of its height's square: a smaller place is glare, or no light for a room */
static const double DOWN = 0.95;   /* least cosine between a face's normal and straight down */
static const double ASLANT = 0.08; /* least cosine between that and the way to a camera */

struct cell {
    struct vec3 at, normal;
    int seen, bright, place; /* place: 0: none */
};

struct sheet { /* of one tile */
    struct cell *cells;
    int columns, rows;
};

struct viewer {
    const struct lit_model *model;
    struct view camera; /* model frame */
    struct view_planes picture;
    double bright;
};

void bright_ceilings_release(struct bright_places *b)
{
    free(b->list);
    *b = (struct bright_places){0};
}

static enum status cut(struct sheet *s, const struct model_field *field, const struct atlas_tile *t, double side,
                       struct err *err)
{
    const double *m = t->matrix[0], scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    const int stride = (int)fmax(1, lround(side * scale));
    *s = (struct sheet){.columns = t->width / stride, .rows = t->height / stride};
    const size_t count = (size_t)s->columns * (size_t)s->rows;
    s->cells = calloc(count + 1, sizeof *s->cells);
    if (!s->cells) return err_nomem(err, "cells of a ceiling", count * sizeof *s->cells);
    for (size_t i = 0; i < count; i++) {
        const int x = (int)(i % (size_t)s->columns) * stride + stride / 2,
                  y = (int)(i / (size_t)s->columns) * stride + stride / 2;
        s->cells[i].at = field_atlas_place(t, field->planes[t->face], x, y);
        s->cells[i].normal = field->planes[t->face].normal;
        if (!field_atlas_has(&field->atlas, t, x, y)) s->cells[i].seen = -1; /* outside the face */
    }
    return ST_OK;
}

static bool pixel_of(int *pixel, const struct viewer *v, const struct cell *c)
{
    const struct vec3 to = vec3_sub(v->camera.center, c->at);
    double x, y;
    if (c->seen < 0 || !(vec3_dot(c->normal, to) > ASLANT * vec3_length(to))) return false;
    if (!(view_project(&v->camera, c->at, &x, &y) > 0)) return false;
    if (!(x >= 0 && y >= 0 && x < v->camera.width && y < v->camera.height)) return false;
    *pixel = (int)y * v->camera.width + (int)x;
    const struct vec3 from = vec3_add(c->at, vec3_scale(c->normal, 4 * v->model->rays.rays.epsilon));
    return !ray_scene_blocked(&v->model->rays.rays, from, vec3_sub(v->camera.center, from), 1);
}

static void look(struct viewer *v, struct sheet *s)
{
    for (int i = 0; i < s->columns * s->rows; i++) {
        struct cell *c = &s->cells[i];
        int p;
        if (!pixel_of(&p, v, c) || !(v->picture.channel[VIEW_A][p] > 0.999f)) continue;
        const double radiance =
            rgb_luminance(rgb_make((double)v->picture.channel[VIEW_R][p], (double)v->picture.channel[VIEW_G][p],
                                   (double)v->picture.channel[VIEW_B][p]));
        c->seen++;
        c->bright += ((int)v->picture.channel[VIEW_CLIPPED][p] & PHOTO_BRIGHT) || radiance >= v->bright;
    }
}

static bool sees_any(const struct viewer *v, const struct sheet *sheets, int count)
{
    int pixel;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < sheets[k].columns * sheets[k].rows; i++)
            if (pixel_of(&pixel, v, &sheets[k].cells[i])) return true;
    return false;
}

static enum status look_at_all(struct sheet *sheets, int count, const struct lit_model *model, const char *views,
                               double bright, struct provenance *prov, struct err *err)
{
    for (int i = 0; !err->status && i < model->in.set.view_count; i++) {
        struct viewer v = {.model = model, .bright = bright};
        v.camera = model_from_world_view(&model->in.axes, &model->in.set.views[i]);
        if (!sees_any(&v, sheets, count)) continue;
        view_planes_read(&v.picture, views, &v.camera, VIEW_CHANNELS, prov, err);
        for (int k = 0; !err->status && k < count; k++) look(&v, &sheets[k]);
        view_planes_release(&v.picture);
    }
    return err->status;
}

static bool is_bright(const struct cell *c) { return c->seen > 0 && 2 * c->bright >= c->seen; }

/* Gives the bright cells that touch a bright cell its number, one after another. */
static int flood(struct sheet *s, int first, int place, int *queue)
{
    int count = 0;
    s->cells[first].place = place;
    queue[count++] = first;
    for (int k = 0; k < count; k++) {
        const int x = queue[k] % s->columns, y = queue[k] / s->columns;
        for (int d = 0; d < 4; d++) {
            const int u = x + (d == 0) - (d == 1), w = y + (d == 2) - (d == 3), n = w * s->columns + u;
            if (u < 0 || w < 0 || u >= s->columns || w >= s->rows) continue;
            if (s->cells[n].place || !is_bright(&s->cells[n])) continue;
            s->cells[n].place = place;
            queue[count++] = n;
        }
    }
    return count;
}

static struct bright_place surround(const struct sheet *s, const int *cells, int count, double side)
{
    struct vec3 low = s->cells[cells[0]].at, high = low;
    for (int k = 1; k < count; k++) {
        const struct vec3 at = s->cells[cells[k]].at;
        low = vec3_make(fmin(low.x, at.x), fmin(low.y, at.y), low.z);
        high = vec3_make(fmax(high.x, at.x), fmax(high.y, at.y), low.z);
    }
    const double x = high.x - low.x + side, y = high.y - low.y + side,
                 part = sqrt(fmin(1, count * side * side / (x * y)));
    return (struct bright_place){vec3_scale(vec3_add(low, high), 0.5), x * part / 2, y * part / 2, false};
}

static enum status list_places(struct bright_places *b, struct sheet *s, double side, double least, struct err *err)
{
    int *queue = malloc(((size_t)s->columns * (size_t)s->rows + 1) * sizeof *queue);
    if (!queue) return err_nomem(err, "cells", (size_t)s->columns * (size_t)s->rows * sizeof *queue);
    for (int i = 0; !err->status && i < s->columns * s->rows; i++) {
        if (s->cells[i].place || !is_bright(&s->cells[i])) continue;
        const int count = flood(s, i, 1, queue);
        if (count * side * side < least) continue;
        if (!array_append(&b->list, (size_t)b->count, sizeof *b->list, "bright places", err))
            b->list[b->count++] = surround(s, queue, count, side);
    }
    free(queue);
    return err->status;
}

enum status bright_ceilings_find(struct bright_places *b, const struct model_field *field,
                                 const struct lit_model *model, const char *views, double bright,
                                 struct provenance *prov, struct err *err)
{
    const struct atlas *a = &field->atlas.atlas;
    const double height = model_rays_height(&model->rays), side = CELL * height;
    struct sheet *sheets = calloc((size_t)a->tile_count + 1, sizeof *sheets);
    int count = 0;
    *b = (struct bright_places){0};
    if (!sheets) return err_nomem(err, "ceilings", (size_t)a->tile_count * sizeof *sheets);
    for (int i = 0; !err->status && i < a->tile_count; i++)
        if (field->planes[a->tiles[i].face].normal.z < -DOWN) cut(&sheets[count++], field, &a->tiles[i], side, err);
    if (!err->status) look_at_all(sheets, count, model, views, bright, prov, err);
    for (int i = 0; !err->status && i < count; i++) list_places(b, &sheets[i], side, LEAST * height * height, err);
    for (int i = 0; i < count; i++) free(sheets[i].cells);
    free(sheets);
    return err->status;
}
