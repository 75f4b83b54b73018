/* level.c - a view and its neighbours in one size of their pictures.
 *
 * A pixel coordinate of a picture of half the size is exactly half of the full one's, also where the size is odd, so
 * that a plane 1/z = a u + b v + c becomes (2 a, 2 b, c). The view's own picture covers all of its pixels in half the
 * size; the neighbours' are those that matcher_add() makes of finer pictures. */
#include "stages/segment_depth/level.h"

#include <stdlib.h>

static enum status halve_views(struct level *half, const struct level *full, struct err *err)
{
    const size_t count = (size_t)full->set.view_count;
    half->set = full->set;
    half->set.views = malloc((count + 1) * sizeof *half->set.views);
    half->halved = true;
    if (!half->set.views) return err_nomem(err, "cameras", count * sizeof *half->set.views);
    for (size_t i = 0; i < count; i++) {
        const struct view *v = &full->set.views[i];
        half->set.views[i] = view_halved(*v, (v->width + 1) / 2, (v->height + 1) / 2);
    }
    return ST_OK;
}

static enum status halve_points(struct level *half, const struct level *full, struct err *err)
{
    const size_t count = (size_t)full->seen.count;
    half->seen.points = malloc((count + 1) * sizeof *half->seen.points);
    if (!half->seen.points) return err_nomem(err, "the points of a view", count * sizeof *half->seen.points);
    half->seen.count = full->seen.count;
    for (size_t i = 0; i < count; i++) {
        half->seen.points[i] = full->seen.points[i];
        half->seen.points[i].u /= 2;
        half->seen.points[i].v /= 2;
    }
    return ST_OK;
}

enum status level_halve(struct level *half, const struct level *full, struct err *err)
{
    return halve_views(half, full, err) || halve_points(half, full, err) ||
                   gamma_image_half_covering(&half->gamma, &full->gamma, err)
               ? err->status
               : ST_OK;
}

enum status level_add(struct level *full, struct level *half, int view_idx, int neighbour_idx, double typical,
                      struct gamma_image *picture, struct err *err)
{
    struct gamma_image halved = {0};
    if (half) gamma_image_half(&halved, picture, err);
    if (!err->status && half)
        matcher_add(&half->matcher, &half->set, view_idx, neighbour_idx, &half->seen, typical, &half->gamma, &halved,
                    err);
    gamma_image_release(&halved);
    if (!err->status)
        matcher_add(&full->matcher, &full->set, view_idx, neighbour_idx, &full->seen, typical, &full->gamma, picture,
                    err);
    return err->status;
}

void level_release(struct level *l)
{
    if (!l) return;
    matcher_release(&l->matcher);
    oversegment_release(&l->segments);
    gamma_image_release(&l->gamma);
    neighbours_release_points(&l->seen);
    if (l->halved) free(l->set.views);
    *l = (struct level){.halved = false};
}
