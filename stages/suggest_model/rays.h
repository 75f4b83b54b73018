/* rays.h - which points are visible from which views, from the points alone: lines of sight through free space. */
#ifndef REMODEL_SUGGEST_RAYS_H
#define REMODEL_SUGGEST_RAYS_H

#include "common/capture/camera_set.h"
#include "common/capture/point_cloud.h"

struct ray {
    int view;
    size_t point;
};
struct ray_list {
    struct ray *rays; /* owned; in order of points */
    size_t count;
};

/* A point is visible from a view if it faces the camera, lies in its picture, and is not hidden by other points (in a
 * coarse depth buffer of all points). A point gets rays to the nearest of these views: as many as the number of views
 * that agree on it, at most 8. weight: of each point. The caller releases the list, which a failure leaves empty. */
enum status rays_find(struct ray_list *list, const struct point_cloud *cloud, const float *weight,
                      const struct view *views, int view_count, struct err *err);
void ray_list_release(struct ray_list *list);

#endif
