/* frame_prior.c - what the rays of a view meet first: floor, ceiling, or a wall.
 *
 * A wall is met between its ends, from the side of its room, and between floor and ceiling. Floor and ceiling have no
 * ends.
 *
 * The pictures know better than lines what stands in a room. So a segment is drawn to its expected plane only where
 * they say little: in scenes whose photos share few points, in views of which little matches distinctly, and less where
 * the segment does. */
#include "stages/segment_depth/frame_prior.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"

#define EXPECTED_GAIN 0.8  /* of a blank segment */
#define SURE_PART     0.5  /* by which a distinct match lowers it */
#define HARDLY_SURE   0.28 /* share of the view that matches distinctly */
#define MOSTLY_SURE   0.36 /* ... from which on the pictures decide alone */
#define NEAREST       1e-6 /* distance of a plane from the camera, of the wall's offset: none is nearer */

struct surface {
    struct prior_candidate plane;
    const struct frame_wall *wall; /* NULL: floor or ceiling */
};

/* Adds a plane of the world, normal . X = offset, unless the camera lies on it. */
static void add_surface(struct surface *list, int *count, struct vec3 normal, double offset, const struct view *view,
                        const struct frame_wall *wall)
{
    const double distance = offset - vec3_dot(normal, view->center);
    if (!(fabs(distance) > NEAREST * (1 + fabs(offset)))) return;
    list[(*count)++] = (struct surface){{vec3_scale(mat3_apply(view->cam_from_world, normal), 1 / distance), 0}, wall};
}

/* The first surface that the ray of a pixel meets; -1: none. */
static int first_surface(const struct surface *list, int count, const struct room_frame *f, const struct view *view,
                         double u, double v)
{
    const struct vec3 ray = vec3_make((u - view->cx) / view->fx, (v - view->cy) / view->fy, 1);
    double nearest = 0; /* inverse depth */
    int first = -1;
    for (int k = 0; k < count; k++) {
        const double inverse = vec3_dot(list[k].plane.normal, ray);
        if (!(inverse > nearest)) continue;
        if (list[k].wall) {
            const struct vec3 place = view_unproject(view, u, v, 1 / inverse);
            const double at = vec3_dot(f->headings[list[k].wall->heading].along, place);
            if (!(at > list[k].wall->from && at < list[k].wall->to)) continue;
        }
        nearest = inverse;
        first = k;
    }
    return first;
}

enum status frame_prior_make(struct plane_prior *prior, const struct room_frame *f, const struct view *view,
                             const struct segmentation *s, struct err *err)
{
    const size_t most = (size_t)(f ? f->wall_count : 0) + 2;
    struct surface *list = calloc(most, sizeof *list);
    struct prior_candidate *candidates = calloc(most, sizeof *candidates);
    int count = 0;
    if (!list || !candidates)
        err_nomem(err, "expected planes", most * sizeof *list);
    else
        plane_prior_init(prior, s->count, err);
    if (!err->status && f && f->floor.known) add_surface(list, &count, f->up, f->floor.height, view, NULL);
    if (!err->status && f && f->ceiling.known) add_surface(list, &count, f->up, f->ceiling.height, view, NULL);
    for (int k = 0; !err->status && f && k < f->wall_count; k++) {
        const struct vec3 across = frame_across(f, f->walls[k].heading);
        if (f->walls[k].side * (vec3_dot(across, view->center) - f->walls[k].offset) > 0)
            add_surface(list, &count, across, f->walls[k].offset, view, &f->walls[k]);
    }
    for (int k = 0; !err->status && k < count; k++) candidates[k] = list[k].plane;
    for (int i = 0; !err->status && count && i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        const int k = prior->expected[i] = first_surface(list, count, f, view, g->cx, g->cy);
        if (k >= 0) candidates[k].pixels += g->pixels;
    }
    if (!err->status) plane_prior_keep(prior, candidates, count, view, s, err);
    free(list);
    free(candidates);
    return err->status;
}

void frame_prior_weigh(struct plane_prior *prior, double trust, const double *distinct, const struct segmentation *s)
{
    double sure = 0, pixels = 0;
    for (int i = 0; i < s->count; i++) {
        sure += s->segments[i].pixels * distinct[i];
        pixels += s->segments[i].pixels;
    }
    const double weight =
        EXPECTED_GAIN * trust * clamp((MOSTLY_SURE - sure / pixels) / (MOSTLY_SURE - HARDLY_SURE), 0, 1);
    for (int i = 0; i < s->count; i++) prior->gain[i] = (float)(weight * (1 - SURE_PART * distinct[i]));
}
