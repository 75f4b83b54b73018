/* scene_points.h - the centroids of all segments of a scene as world points: a coarse point cloud of a few thousand. */
#ifndef REMODEL_SCENE_POINTS_H
#define REMODEL_SCENE_POINTS_H

#include <stdbool.h>

#include "common/layers/layer_scene.h"

struct scene_point {
    struct vec3 position;
    double weight; /* pixels of the segment */
    int view;
    bool central; /* in the middle half of its view's picture, in width and in height */
};

struct scene_points {
    struct scene_point *points;
    size_t count;
};

/* ST_DATA: no segment has a depth. ST_NOMEM. */
enum status scene_points_collect(struct scene_points *points, const struct layer_scene *scene, struct err *err);
void scene_points_release(struct scene_points *points);

#endif
