/* frame_prior.c - what the rays of a view meet first: floor, ceiling, or a wall.
 *
 * A wall is met between its ends, from the side of its room, and between floor and ceiling. Floor and ceiling have no
 * ends. The planes that most of the view's pixels are expected on are kept.
 *
 * The pictures know better than lines what stands in a room. So a segment is drawn to its expected plane only where
 * they say little: in scenes whose photos share few points, in views of which little matches distinctly, and less where
 * the segment does. */
#include "stages/segment_depth/frame_prior.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"

#define MIN_PART      0.003 /* of the view's pixels that a plane is expected for */
#define EXPECTED_GAIN 0.8   /* of a blank segment */
#define SURE_PART     0.5   /* by which a distinct match lowers it */
#define HARDLY_SURE   0.28  /* share of the view that matches distinctly */
#define MOSTLY_SURE   0.36  /* ... from which on the pictures decide alone */
#define NEAREST       1e-6  /* distance of a plane from the camera, of the wall's offset: none is nearer */

struct surface {
    struct vec3 normal;            /* in the view's axes, normal . X = 1 */
    const struct frame_wall *wall; /* NULL: floor or ceiling */
    double pixels;
    int kept; /* index into the planes, -1 */
};

/* Adds a plane of the world, normal . X = offset, unless the camera lies on it. */
static void add_surface(struct surface *list, int *count, struct vec3 normal, double offset, const struct view *view,
                        const struct frame_wall *wall)
{
    const double distance = offset - vec3_dot(normal, view->center);
    if (!(fabs(distance) > NEAREST * (1 + fabs(offset)))) return;
    list[(*count)++] =
        (struct surface){vec3_scale(mat3_apply(view->cam_from_world, normal), 1 / distance), wall, 0, -1};
}

/* The first surface that the ray of a pixel meets; -1: none. */
static int first_surface(const struct surface *list, int count, const struct room_frame *f, const struct view *view,
                         double u, double v)
{
    const struct vec3 ray = vec3_make((u - view->cx) / view->fx, (v - view->cy) / view->fy, 1);
    double nearest = 0; /* inverse depth */
    int first = -1;
    for (int k = 0; k < count; k++) {
        const double inverse = vec3_dot(list[k].normal, ray);
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

static int compare_pixels(const void *a, const void *b)
{
    const struct surface *const *x = a, *const *y = b;
    if ((*x)->pixels != (*y)->pixels) return (*x)->pixels > (*y)->pixels ? -1 : 1;
    return (*x > *y) - (*x < *y);
}

enum status frame_prior_make(struct frame_prior *prior, const struct room_frame *f, double trust,
                             const struct view *view, const struct segmentation *s, struct err *err)
{
    const size_t most = (size_t)(f ? f->wall_count : 0) + 2;
    struct surface *list = calloc(most, sizeof *list), **order = calloc(most, sizeof *order);
    int count = 0;
    *prior = (struct frame_prior){.trust = trust};
    prior->expected = malloc(((size_t)s->count + 1) * sizeof *prior->expected);
    prior->gain = calloc((size_t)s->count + 1, sizeof *prior->gain);
    if (!list || !order || !prior->expected || !prior->gain)
        err_nomem(err, "expected planes", (size_t)s->count * sizeof(int));
    for (int i = 0; !err->status && i < s->count; i++) prior->expected[i] = -1;
    if (!err->status && f && f->floor.known) add_surface(list, &count, f->up, f->floor.height, view, NULL);
    if (!err->status && f && f->ceiling.known) add_surface(list, &count, f->up, f->ceiling.height, view, NULL);
    for (int k = 0; !err->status && f && k < f->wall_count; k++) {
        const struct vec3 across = frame_across(f, f->walls[k].heading);
        if (f->walls[k].side * (vec3_dot(across, view->center) - f->walls[k].offset) > 0)
            add_surface(list, &count, across, f->walls[k].offset, view, &f->walls[k]);
    }
    for (int i = 0; !err->status && count && i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        const int k = prior->expected[i] = first_surface(list, count, f, view, g->cx, g->cy);
        if (k >= 0) list[k].pixels += g->pixels;
    }
    for (int k = 0; !err->status && k < count; k++) order[k] = &list[k];
    if (!err->status) qsort(order, (size_t)count, sizeof *order, compare_pixels);
    for (int k = 0; !err->status && k < count && prior->count < PRIOR_PLANES; k++) {
        if (!(order[k]->pixels >= MIN_PART * s->width * s->height)) break;
        order[k]->kept = prior->count;
        prior->planes[prior->count++] = plane_of_normal(view, order[k]->normal);
    }
    for (int i = 0; !err->status && i < s->count; i++)
        if (prior->expected[i] >= 0) prior->expected[i] = list[prior->expected[i]].kept;
    free(list);
    free(order);
    return err->status;
}

void frame_prior_weigh(struct frame_prior *prior, const double *distinct, const struct segmentation *s)
{
    double sure = 0, pixels = 0;
    for (int i = 0; i < s->count; i++) {
        sure += s->segments[i].pixels * distinct[i];
        pixels += s->segments[i].pixels;
    }
    const double weight =
        EXPECTED_GAIN * prior->trust * clamp((MOSTLY_SURE - sure / pixels) / (MOSTLY_SURE - HARDLY_SURE), 0, 1);
    for (int i = 0; i < s->count; i++) prior->gain[i] = (float)(weight * (1 - SURE_PART * distinct[i]));
}

void frame_prior_release(struct frame_prior *prior)
{
    if (!prior) return;
    free(prior->gain);
    free(prior->expected);
    *prior = (struct frame_prior){.count = 0};
}
