/* surface.c - see surface.h.
 *
 * A segment's plane 1/z = a u + b v + c is n . X = 1 in the camera's axes, with n = (a fx, b fy, a cx + b cy + c): put
 * u = fx x/z + cx, v = fy y/z + cy and multiply by z. With X = R W + t that is (R^T n) . W = 1 - n . t in the world.
 * n . X = 1 > 0 in front of the camera, so that n points away from it. */
#include "stages/fuse_points/surface.h"

#include <stdlib.h>

static struct surface_plane plane_in_world(const struct depth_segment *s, const struct view *view)
{
    struct surface_plane out = {.inverse_z = {s->plane[0], s->plane[1], s->plane[2]},
                                .sigma = (float)fmax(s->sigma, LEAST_SIGMA),
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
            "the depth map of view %s has %d x %d pixels, but its camera has %d x %d. Make the depth map again.",
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

enum status surface_cache_init(struct surface_cache *c, const struct camera_set *set, const struct depth_source *source,
                               size_t room, struct err *err)
{
    *c = (struct surface_cache){.set = set, .source = source, .room = room};
    c->surfaces = calloc((size_t)set->view_count + 1, sizeof *c->surfaces);
    c->asked = calloc((size_t)set->view_count + 1, sizeof *c->asked);
    return c->surfaces && c->asked ? ST_OK : err_nomem(err, "views", (size_t)set->view_count * sizeof *c->surfaces);
}

static void make_room(struct surface_cache *c, int keep)
{
    while (c->used > c->room) {
        int oldest = -1;
        for (int i = 0; i < c->set->view_count; i++)
            if (c->asked[i] && i != keep && (oldest < 0 || c->asked[i] < c->asked[oldest])) oldest = i;
        if (oldest < 0) return;
        c->used -= surface_bytes(&c->surfaces[oldest]);
        c->asked[oldest] = 0;
        surface_release(&c->surfaces[oldest]);
    }
}

enum status surface_cache_get(struct surface_cache *c, int view_idx, const struct surface **s, struct err *err)
{
    struct surface *at = &c->surfaces[view_idx];
    if (!c->asked[view_idx]) {
        struct layered_depth d = {0};
        enum status st = c->source->read_ids(c->source->ctx, view_idx, &d, err);
        if (!st) st = surface_make(at, &c->set->views[view_idx], &d, err);
        layered_depth_release(&d);
        if (st) {
            surface_release(at);
            return st;
        }
        c->reads++;
        c->used += surface_bytes(at);
    }
    c->asked[view_idx] = ++c->clock;
    make_room(c, view_idx);
    *s = at;
    return ST_OK;
}

void surface_cache_release(struct surface_cache *c)
{
    if (!c) return;
    for (int i = 0; c->surfaces && i < c->set->view_count; i++) surface_release(&c->surfaces[i]);
    free(c->surfaces);
    free(c->asked);
    *c = (struct surface_cache){0};
}
