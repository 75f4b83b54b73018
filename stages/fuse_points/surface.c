/* surface.c - depth maps as planes in world space, with a cache.
 *
 * A segment's plane 1/z = a u + b v + c is n . X = 1 in the camera's axes, with n = (a fx, b fy, a cx + b cy + c):
 * substitute u = fx x/z + cx, v = fy y/z + cy and multiply by z. With X = R W + t that is (R^T n) . W = 1 - n . t in
 * the world. n . X = 1 > 0 in front of the camera, so that n points away from it. The cache evicts the least recently
 * used surface. */
#include "stages/fuse_points/surface.h"

#include <stdlib.h>

static struct surface_plane plane_in_world(const struct depth_segment *s, const struct view *view)
{
    struct surface_plane out = {.inverse_z = {s->plane[0], s->plane[1], s->plane[2]},
                                .sigma = (float)fmax(s->sigma, MIN_SIGMA),
                                .confidence = (float)s->confidence};
    const struct vec3 n = {s->plane[0] * view->fx, s->plane[1] * view->fy,
                           s->plane[0] * view->cx + s->plane[1] * view->cy + s->plane[2]};
    const double length = vec3_length(n);
    if (!(length > 0) || !isfinite(1 / length)) return out;
    out.normal = vec3_scale(mat3_apply(mat3_transpose(view->cam_from_world), n), -1 / length);
    out.offset = (vec3_dot(n, view->translation) - 1) / length;
    return out;
}

enum status surface_make(struct surface *s, const struct view *view, struct layered_depth *d, struct err *err)
{
    *s = (struct surface){.view = view};
    if (d->width != view->width || d->height != view->height)
        return err_set(
            err, ST_DATA,
            "the depth map of view %s has %d x %d pixels, but its camera has %d x %d; make the depth map again.",
            view->name, d->width, d->height, view->width, view->height);
    s->planes = malloc(((size_t)d->segment_count + 1) * sizeof *s->planes);
    if (!s->planes) return err_nomem(err, "planes", (size_t)d->segment_count * sizeof *s->planes);
    for (int i = 0; i < d->segment_count; i++) s->planes[i] = plane_in_world(&d->segments[i], view);
    s->plane_count = d->segment_count;
    s->id = d->interior.id;
    d->interior.id = NULL;
    return ST_OK;
}

void surface_release(struct surface *s)
{
    if (!s) return;
    free(s->id);
    free(s->planes);
    *s = (struct surface){0};
}

static size_t surface_bytes(const struct surface *s)
{
    return (size_t)s->view->width * (size_t)s->view->height * sizeof *s->id +
           (size_t)s->plane_count * sizeof *s->planes;
}

enum status surface_cache_init(struct surface_cache *c, const struct camera_set *set, const struct depth_reader *source,
                               size_t max_bytes, struct err *err)
{
    *c = (struct surface_cache){.set = set, .source = source, .max_bytes = max_bytes};
    c->surfaces = calloc((size_t)set->view_count + 1, sizeof *c->surfaces);
    c->last_use = calloc((size_t)set->view_count + 1, sizeof *c->last_use);
    return c->surfaces && c->last_use ? ST_OK : err_nomem(err, "views", (size_t)set->view_count * sizeof *c->surfaces);
}

static void make_room(struct surface_cache *c, int keep)
{
    while (c->used_bytes > c->max_bytes) {
        int oldest = -1;
        for (int i = 0; i < c->set->view_count; i++)
            if (c->last_use[i] && i != keep && (oldest < 0 || c->last_use[i] < c->last_use[oldest])) oldest = i;
        if (oldest < 0) return;
        c->used_bytes -= surface_bytes(&c->surfaces[oldest]);
        c->last_use[oldest] = 0;
        surface_release(&c->surfaces[oldest]);
    }
}

enum status surface_cache_get(struct surface_cache *c, int view_idx, const struct surface **s, struct err *err)
{
    struct surface *at = &c->surfaces[view_idx];
    if (!c->last_use[view_idx]) {
        struct layered_depth d = {0};
        if (!c->source->read_ids(c->source->ctx, view_idx, &d, err))
            surface_make(at, &c->set->views[view_idx], &d, err);
        layered_depth_release(&d);
        if (err->status) {
            surface_release(at);
            return err->status;
        }
        c->reads++;
        c->used_bytes += surface_bytes(at);
    }
    c->last_use[view_idx] = ++c->clock;
    make_room(c, view_idx);
    *s = at;
    return ST_OK;
}

void surface_cache_release(struct surface_cache *c)
{
    if (!c) return;
    for (int i = 0; c->surfaces && i < c->set->view_count; i++) surface_release(&c->surfaces[i]);
    free(c->surfaces);
    free(c->last_use);
    *c = (struct surface_cache){0};
}
