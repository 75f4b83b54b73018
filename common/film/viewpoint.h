/* viewpoint.h - whether a scene can be shown from a camera (thesis 3.4.2, "Valid viewpoint sampling").
 *
 * A viewpoint is valid if H < max_h (common/layers/hole_measure.h). Two more limits are not in the thesis, and keep pictures
 * from being worse than their holes tell: how much of the frame may lie beyond the borders of the views that the view
 * mesh blends there (others step in, with a seam), and that what is near may not come nearer than shot.near_limit. */
#ifndef REMODEL_VIEWPOINT_H
#define REMODEL_VIEWPOINT_H

#include "common/film/shot.h"
#include "common/layers/hole_measure.h"
#include "common/layers/layer_render.h"
#include "common/layers/scene_points.h"

struct viewpoint_limits {
    double max_h;
    double max_outside; /* part of the frame */
    int side;           /* longest side of the pictures in which holes are looked for, at most the film's */
};

struct viewpoint {
    double h;       /* INFINITY: nothing is seen */
    double holes;   /* part of the frame */
    double outside; /* likewise */
    double near;    /* part of what is seen that is nearer than shot.near_limit */
    bool valid;
};

struct viewpoint_test { /* keeps buffers; one thread uses it at a time */
    const struct layer_scene *scene;
    const struct scene_points *points;
    const struct shot *shot;
    struct viewpoint_limits limits;
    struct rendered_frame coverage;
    float *distance;
    size_t distance_room;
    long renders; /* coverage drawn so far */
};

/* Measures all of it. */
enum status viewpoint_measure(struct viewpoint *v, struct viewpoint_test *test, const struct view *camera,
                              struct err *err);
/* Whether it is valid; what is cheap is looked at first, and the rest only if that is good. */
enum status viewpoint_is_valid(bool *valid, struct viewpoint_test *test, const struct view *camera, struct err *err);
/* The same for `count` cameras, on all threads; `like` says of what, and counts the renders. */
enum status viewpoints_measure(struct viewpoint *out, const struct view *cameras, int count,
                               struct viewpoint_test *like, struct err *err);
/* Another one of the same scene, for another thread. */
void viewpoint_test_like(struct viewpoint_test *test, const struct viewpoint_test *like);
void viewpoint_test_release(struct viewpoint_test *test);

#endif
