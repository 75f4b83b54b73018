/* central_views.c - the views of a scene from the centre outwards. */
#include "common/capture/central_views.h"

#include <stdlib.h>

#define SAME_DISTANCE 1e-9 /* relative to the largest distance: rounding of poses */

struct ranked_view {
    double distance, gaze;
    int view;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked_view *p = a, *q = b;
    if (p->distance != q->distance) return p->distance < q->distance ? -1 : 1;
    if (p->gaze != q->gaze) return p->gaze > q->gaze ? -1 : 1;
    return p->view - q->view;
}

static struct vec3 gaze_of(const struct view *v) { return mat3_row(v->cam_from_world, 2); }

enum status central_views(int *order, const struct camera_set *set, struct err *err)
{
    const size_t n = (size_t)set->view_count;
    struct vec3 centroid = {0}, gaze = {0};
    double farthest = 0;
    struct ranked_view *ranked = calloc(n + 1, sizeof *ranked);
    if (!ranked) return err_nomem(err, "the order of views", n * sizeof *ranked);
    for (size_t i = 0; i < n; i++) {
        centroid = vec3_add(centroid, vec3_scale(set->views[i].center, 1 / (double)n));
        gaze = vec3_add(gaze, gaze_of(&set->views[i]));
    }
    for (size_t i = 0; i < n; i++) {
        const struct view *v = &set->views[i];
        ranked[i] =
            (struct ranked_view){vec3_length(vec3_sub(v->center, centroid)), vec3_dot(gaze_of(v), gaze), (int)i};
        farthest = fmax(farthest, ranked[i].distance);
    }
    const double step = SAME_DISTANCE * farthest;
    for (size_t i = 0; i < n && step > 0; i++) ranked[i].distance = round(ranked[i].distance / step);
    qsort(ranked, n, sizeof *ranked, compare_ranked);
    for (size_t i = 0; i < n; i++) order[i] = ranked[i].view;
    free(ranked);
    return ST_OK;
}
