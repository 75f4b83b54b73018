/* scene_points.h - the middle of every segment of a scene, in the world: what is where, a few thousand points in
 * all. */
#ifndef REMODEL_SCENE_POINTS_H
#define REMODEL_SCENE_POINTS_H

#include <stdbool.h>

#include "common/layers/layer_scene.h"

struct scene_point {
    struct vec3 position;
    double weight; /* the segment's pixels */
    int view;
    bool central; /* in the middle of its view's picture, half of its width and height */
};

struct scene_points {
    struct scene_point *points;
    size_t count;
};

/* ST_DATA: no segment has a depth. */
enum status scene_points_collect(struct scene_points *points, const struct layer_scene *scene, struct err *err);
void scene_points_release(struct scene_points *points);

#endif
