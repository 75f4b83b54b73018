/* rays.h - which points a camera sees, from points alone: lines of sight through free space. */
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

/* A point is seen from the nearest of the views that it faces, whose picture it lies in and where no other point stands
 * before it (a coarse depth buffer of all points); as many of them as its views that agree. */
enum status rays_find(struct ray_list *list, const struct point_cloud *cloud, const struct view *views, int view_count,
                      struct err *err);
void ray_list_release(struct ray_list *list);

#endif
