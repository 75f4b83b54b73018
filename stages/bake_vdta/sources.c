/* sources.c - see sources.h.
 *
 * The choice by texel comes later (common/texture/bake_candidates.c) and sees each view's pixels; here only their
 * number is limited. Each face is represented by some of the texels that the viewpoint does not show. The index says
 * which views show the face; a view's worth to a sample inside its picture is the clean share of the face in it, times
 * what [Buehler 2001] prefers: a small angle between the rays of the two, and enough resolution. Views are taken one at
 * a time, and what a view offers a sample counts less and less where others were taken for it. */
#include "stages/bake_vdta/sources.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/photo_camera.h"
#include "common/product/product.h"
#include "common/texture/face_index.h"

enum { SAMPLES = 100 };             /* of a tile, about */
static const double ANGLE = 0.5;    /* radians: an angle at which a view is worth half */
static const double SATURATION = 3; /* a sample that views of this worth were taken for counts a quarter */

struct sample {
    int id;       /* of its face */
    size_t order; /* of its making */
    struct vec3 p, normal;
    double texels; /* that it stands for */
    double served; /* worth of the views taken, added up */
};

struct samples {
    struct sample *list; /* owned */
    size_t count, room;
};

struct offer {
    int view;
    size_t sample;
    double worth; /* 0 to 1 */
};

struct offers {
    struct offer *list; /* owned */
    size_t count, room;
};

static int compare_samples(const void *a, const void *b)
{
    const struct sample *p = a, *q = b;
    if (p->id != q->id) return p->id < q->id ? -1 : 1;
    return p->order < q->order ? -1 : p->order > q->order;
}

/* Every step-th texel of a tile in x and y, of those that the viewpoint does not show. */
static enum status add_samples(struct samples *s, const struct bake *b, const struct bake_tile *t, struct err *err)
{
    const struct surface *of = &b->surfaces->list[t->surface];
    const int step = 1 + (int)sqrt((double)t->raster.width * t->raster.height / SAMPLES);
    for (int y = step / 2; y < t->raster.height; y += step)
        for (int x = step / 2; x < t->raster.width; x += step) {
            const uint8_t role = b->role[t->first + (size_t)y * (size_t)t->raster.width + (size_t)x];
            struct sample one = {.id = of->id, .normal = of->normal, .order = s->count, .texels = (double)step * step};
            if (role == TEXEL_NONE || role == TEXEL_ORIGINAL || !bake_tile_point(&one.p, t, x + 0.5, y + 0.5)) continue;
            if (array_reserve(&s->list, &s->room, s->count + 1, sizeof *s->list, "samples", err)) return err->status;
            s->list[s->count++] = one;
        }
    return ST_OK;
}

static enum status find_samples(struct samples *s, const struct bake *b, struct err *err)
{
    for (int i = 0; !err->status && i < b->tile_count; i++) add_samples(s, b, &b->tiles[i], err);
    return err->status;
}

/* Whether the photo of a view has a pixel where the view shows p. */
static bool is_in_photo(const struct bake_scene *s, int view, struct vec3 p)
{
    const struct view *v = &s->in.set.views[view];
    double u, w;
    if (!(view_project(v, p, &u, &w) > 0) || u < 0 || w < 0 || u >= v->width || w >= v->height) return false;
    const struct lens *l = photo_lens_of_view(&s->in.set, &s->in.lenses, view);
    if (!l) return true;
    const struct vec3 ray = {(u - v->cx) / v->fx, (w - v->cy) / v->fy, 1};
    const struct vec3 in_photo = mat3_apply(mat3_transpose(mat3_from_quat(l->view_from_photo)), ray);
    return camera_project(&l->camera, in_photo, &u, &w) && u >= 0 && w >= 0 && u < l->camera.width &&
           w < l->camera.height;
}

static double worth_of(const struct sample *s, const struct face_view *f, const struct bake_scene *scene, int view,
                       const struct bake *b, double own_focal)
{
    const struct view *camera = &scene->in.set.views[view];
    const struct vec3 to_view = vec3_sub(camera->center, s->p), to_own = vec3_sub(b->centre, s->p);
    const double far = vec3_length(to_view), own_far = vec3_length(to_own);
    const double min_cos = cos(scene->params->texture.max_slant * M_PI / 180);
    if (!(own_far > 0) || !(vec3_dot(to_view, s->normal) > min_cos * far) || !is_in_photo(scene, view, s->p)) return 0;
    const double angle = acos(fmax(-1, fmin(1, vec3_dot(to_view, to_own) / (far * own_far))));
    const double coarser = far * own_focal / (own_far * camera->fx);
    return (double)f->clean / f->pixels / (1 + (angle / ANGLE) * (angle / ANGLE)) / fmax(1, coarser);
}

/* What the views that show a face offer to its samples, first .. last - 1. */
static enum status add_offers(struct offers *o, const struct samples *samples, size_t first, size_t last,
                              const struct face_views *f, const struct bake_scene *s, const struct bake *b,
                              double own_focal, struct err *err)
{
    for (int k = 0; k < f->count; k++) {
        const int view = camera_set_find(&s->in.set, f->views[k].name);
        for (size_t i = first; view >= 0 && i < last; i++) {
            const double worth = worth_of(&samples->list[i], &f->views[k], s, view, b, own_focal);
            if (!(worth > 0)) continue;
            if (array_reserve(&o->list, &o->room, o->count + 1, sizeof *o->list, "views of faces", err))
                return err->status;
            o->list[o->count++] = (struct offer){view, i, worth};
        }
    }
    return ST_OK;
}

static enum status find_offers(struct offers *o, const struct samples *samples, const struct bake_scene *s,
                               const struct bake *b, double own_focal, struct provenance *prov, struct err *err)
{
    struct face_index index = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, s->from.ids, PRODUCT_FACE_INDEX, NULL, err)) face_index_open(&index, path, prov, err);
    for (size_t first = 0, last; !err->status && first < samples->count; first = last) {
        struct face_views shown_by = {0};
        for (last = first; last < samples->count && samples->list[last].id == samples->list[first].id;) last++;
        if (!face_index_load(&shown_by, &index, samples->list[first].id, err))
            add_offers(o, samples, first, last, &shown_by, s, b, own_focal, err);
        face_views_release(&shown_by);
    }
    face_index_close(&index);
    return err->status;
}

/* Takes the view that is worth most, again and again. */
static void take_views(bool *taken, int view_count, const struct offers *o, struct samples *samples, int limit,
                       double *worth)
{
    for (int n = 0; n < limit; n++) {
        int best = -1;
        memset(worth, 0, (size_t)view_count * sizeof *worth);
        for (size_t i = 0; i < o->count; i++) {
            const struct sample *s = &samples->list[o->list[i].sample];
            worth[o->list[i].view] += o->list[i].worth * s->texels / (1 + SATURATION * s->served);
        }
        for (int v = 0; v < view_count; v++)
            if (!taken[v] && worth[v] > 0 && (best < 0 || worth[v] > worth[best])) best = v;
        if (best < 0) return;
        taken[best] = true;
        for (size_t i = 0; i < o->count; i++)
            if (o->list[i].view == best) samples->list[o->list[i].sample].served += o->list[i].worth;
    }
}

enum status sources_choose(int **views, int *count, const struct bake_scene *scene, const int *own, int own_count,
                           const struct bake *b, struct provenance *prov, struct err *err)
{
    const int n = scene->in.set.view_count;
    struct samples samples = {0};
    struct offers offers = {0};
    bool *taken = calloc((size_t)n + 1, sizeof *taken);
    double *worth = malloc(((size_t)n + 1) * sizeof *worth);
    *views = malloc(((size_t)n + 1) * sizeof **views);
    *count = 0;
    if (!taken || !worth || !*views) err_nomem(err, "views", (size_t)n * sizeof *worth);
    if (!err->status) find_samples(&samples, b, err);
    if (!err->status && samples.count) qsort(samples.list, samples.count, sizeof *samples.list, compare_samples);
    if (!err->status) find_offers(&offers, &samples, scene, b, scene->in.set.views[own[0]].fx, prov, err);
    for (int i = 0; !err->status && i < own_count; i++) taken[own[i]] = true;
    if (!err->status) take_views(taken, n, &offers, &samples, scene->params->texture.max_sources, worth);
    for (int v = 0; !err->status && v < n; v++)
        if (taken[v]) (*views)[(*count)++] = v;
    free(samples.list);
    free(offers.list);
    free(taken);
    free(worth);
    return err->status;
}
