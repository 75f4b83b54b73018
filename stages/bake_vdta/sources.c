/* sources.c - see sources.h.
 *
 * The choice by texel comes later (common/texture/candidates.c) and sees each view's pixels; here only their number is
 * limited. Every face asks for views in proportion to its texels that the viewpoint does not show. A view's worth to a
 * face is the number of its clean pixels, up to those asked for, times what [Buehler 2001] prefers: a small angle
 * between the rays of the two, from the middle of the face's missing texels, and enough resolution. Views are taken one
 * at a time, and what a view offers counts less and less where others were taken for the same face. */
#include "stages/bake_vdta/sources.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/texture/face_index.h"

static const double ANGLE = 0.5;    /* radians: an angle at which a view is worth half */
static const double SATURATION = 3; /* a face is served when the views taken show it as often as this */

struct demand { /* of a face */
    int id;
    double texels; /* that the viewpoint does not show */
    struct vec3 middle;
    double served; /* share of its texels that the views taken show, added up */
};

struct offer {
    int view, demand;
    double worth; /* 0..1 of the face */
};

static int compare_ids(const void *a, const void *b)
{
    const struct demand *p = a, *q = b;
    return p->id < q->id ? -1 : p->id > q->id;
}

/* One demand for each face, in order of id. */
static enum status find_demands(struct demand **demands, int *count, const struct bake *b, struct err *err)
{
    struct demand *d = calloc((size_t)b->tile_count + 1, sizeof *d);
    if (!d) return err_nomem(err, "faces", (size_t)b->tile_count * sizeof *d);
    int n = 0;
    for (int i = 0; i < b->tile_count; i++) {
        const struct bake_tile *t = &b->tiles[i];
        struct demand one = {.id = b->surfaces->list[t->surface].id};
        for (int y = 0; y < t->raster.height; y++)
            for (int x = 0; x < t->raster.width; x++) {
                struct vec3 p;
                const uint8_t role = b->role[t->first + (size_t)y * (size_t)t->raster.width + (size_t)x];
                if (role == TEXEL_NONE || role == TEXEL_ORIGINAL || !bake_tile_point(&p, t, x + 0.5, y + 0.5)) continue;
                one.middle = vec3_add(one.middle, p);
                one.texels++;
            }
        if (one.texels > 0) d[n++] = one;
    }
    if (n) qsort(d, (size_t)n, sizeof *d, compare_ids);
    *demands = d;
    *count = 0;
    for (int i = 0; i < n; i++) {
        if (*count && d[*count - 1].id == d[i].id) {
            d[*count - 1].texels += d[i].texels;
            d[*count - 1].middle = vec3_add(d[*count - 1].middle, d[i].middle);
        } else
            d[(*count)++] = d[i];
    }
    for (int i = 0; i < *count; i++) d[i].middle = vec3_scale(d[i].middle, 1 / d[i].texels);
    return ST_OK;
}

static double worth_of(const struct demand *d, const struct face_view *f, const struct view *camera,
                       const struct bake *b, double own_focal)
{
    const struct vec3 to_view = vec3_sub(camera->center, d->middle), to_own = vec3_sub(b->centre, d->middle);
    const double far = vec3_length(to_view), own_far = vec3_length(to_own);
    if (!(far > 0 && own_far > 0)) return 0;
    const double angle = acos(fmax(-1, fmin(1, vec3_dot(to_view, to_own) / (far * own_far))));
    const double coarser = far * own_focal / (own_far * camera->fx);
    const double shown = fmin(1, f->clean / d->texels);
    return shown / (1 + (angle / ANGLE) * (angle / ANGLE)) / fmax(1, coarser);
}

static enum status find_offers(struct offer **offers, size_t *count, struct demand *demands, int demand_count,
                               const struct face_index *index, const struct bake_scene *s, const struct bake *b,
                               double own_focal, struct err *err)
{
    size_t room = 0;
    for (int i = 0; i < demand_count; i++) {
        const struct face_views *f = face_index_find(index, demands[i].id);
        for (int k = 0; f && k < f->count; k++) {
            const int view = camera_set_find(&s->set, f->views[k].view);
            if (view < 0) continue;
            if (array_reserve(offers, &room, *count + 1, sizeof **offers, "views of faces", err)) return err->status;
            (*offers)[(*count)++] =
                (struct offer){view, i, worth_of(&demands[i], &f->views[k], &s->set.views[view], b, own_focal)};
        }
    }
    return ST_OK;
}

/* Takes the view that is worth most, again and again. */
static void take_views(bool *taken, int view_count, const struct offer *offers, size_t count, struct demand *demands,
                       int limit, double *worth)
{
    for (int n = 0; n < limit; n++) {
        int best = -1;
        memset(worth, 0, (size_t)view_count * sizeof *worth);
        for (size_t i = 0; i < count; i++) {
            const struct demand *d = &demands[offers[i].demand];
            worth[offers[i].view] += offers[i].worth * d->texels / (1 + SATURATION * d->served);
        }
        for (int v = 0; v < view_count; v++)
            if (!taken[v] && worth[v] > 0 && (best < 0 || worth[v] > worth[best])) best = v;
        if (best < 0) return;
        taken[best] = true;
        for (size_t i = 0; i < count; i++)
            if (offers[i].view == best) demands[offers[i].demand].served += offers[i].worth;
    }
}

static enum status read_index(struct face_index *index, const struct bake_scene *s, const struct demand *demands,
                              int count, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    int *ids = malloc(((size_t)count + 1) * sizeof *ids);
    enum status st = ids ? provenance_add_in(prov, "ids", s->ids, "index", ".txt", path, err)
                         : err_nomem(err, "faces", (size_t)count * sizeof *ids);
    for (int i = 0; !st && i < count; i++) ids[i] = demands[i].id;
    if (!st) st = face_index_read(index, path, ids, count, err);
    free(ids);
    return st;
}

enum status sources_choose(int **views, int *count, const struct bake_scene *scene, const int *own, int own_count,
                           const struct bake *b, struct provenance *prov, struct err *err)
{
    const int n = scene->set.view_count;
    struct demand *demands = NULL;
    struct offer *offers = NULL;
    struct face_index index = {0};
    size_t offer_count = 0;
    int demand_count = 0;
    bool *taken = calloc((size_t)n + 1, sizeof *taken);
    double *worth = malloc(((size_t)n + 1) * sizeof *worth);
    *views = malloc(((size_t)n + 1) * sizeof **views);
    *count = 0;
    enum status st = taken && worth && *views ? ST_OK : err_nomem(err, "views", (size_t)n * sizeof *worth);
    if (!st) st = find_demands(&demands, &demand_count, b, err);
    if (!st) st = read_index(&index, scene, demands, demand_count, prov, err);
    if (!st)
        st = find_offers(&offers, &offer_count, demands, demand_count, &index, scene, b, scene->set.views[own[0]].fx,
                         err);
    for (int i = 0; !st && i < own_count; i++) taken[own[i]] = true;
    if (!st) take_views(taken, n, offers, offer_count, demands, scene->params->texture.max_sources, worth);
    for (int v = 0; !st && v < n; v++)
        if (taken[v]) (*views)[(*count)++] = v;
    face_index_release(&index);
    free(demands);
    free(offers);
    free(taken);
    free(worth);
    return st;
}
