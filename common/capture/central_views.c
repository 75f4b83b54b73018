/* central_views.c - see central_views.h. */
#include "common/capture/central_views.h"

#include <stdlib.h>

#define SAME_DISTANCE 1e-9 /* relative to the farthest view's: rounding of poses */

struct place {
    double distance, gaze;
    int view;
};

static int compare_places(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
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
    struct place *places = calloc(n + 1, sizeof *places);
    if (!places) return err_nomem(err, "the views' order", n * sizeof *places);
    for (size_t i = 0; i < n; i++) {
        centroid = vec3_add(centroid, vec3_scale(set->views[i].center, 1 / (double)n));
        gaze = vec3_add(gaze, gaze_of(&set->views[i]));
    }
    for (size_t i = 0; i < n; i++) {
        const struct view *v = &set->views[i];
        places[i] = (struct place){vec3_length(vec3_sub(v->center, centroid)), vec3_dot(gaze_of(v), gaze), (int)i};
        farthest = fmax(farthest, places[i].distance);
    }
    const double step = SAME_DISTANCE * farthest;
    for (size_t i = 0; i < n && step > 0; i++) places[i].distance = round(places[i].distance / step);
    qsort(places, n, sizeof *places, compare_places);
    for (size_t i = 0; i < n; i++) order[i] = places[i].view;
    free(places);
    return ST_OK;
}
