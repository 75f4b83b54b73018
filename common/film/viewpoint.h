/* viewpoint.h - whether a camera shows a scene well enough to be used in a film [Colburn 2014, 3.4.2]. */
#ifndef REMODEL_VIEWPOINT_H
#define REMODEL_VIEWPOINT_H

#include "common/film/shot.h"
#include "common/layers/hole_measure.h"
#include "common/layers/layer_render.h"
#include "common/layers/scene_points.h"

struct viewpoint_limits {
    double max_h;
    double max_outside; /* fraction of the frame */
    int side;           /* longer side of the pictures in which holes are measured, at most the film's; px */
};

struct viewpoint {
    double h;       /* INFINITY: no pixel shows the scene */
    double holes;   /* fraction of the frame */
    double outside; /* fraction of the frame beyond the borders of the views blended there */
    double near;    /* fraction of the visible points nearer than shot->near_limit */
    bool valid;
};

struct viewpoint_test { /* holds buffers: for one thread at a time */
    const struct layer_scene *scene;
    const struct scene_points *points;
    const struct shot_setup *shot;
    struct viewpoint_limits limits;
    struct rendered_frame coverage;
    float *distance;
    size_t distance_room;
    long renders; /* number of coverage pictures rendered so far */
};

/* Measures everything. A camera whose fx is 0 is invalid. */
enum status viewpoint_measure(struct viewpoint *v, struct viewpoint_test *test, const struct view *camera,
                              struct err *err);
/* Validity alone: the cheap tests come first, and a failed test skips the rest. */
enum status viewpoint_is_valid(bool *valid, struct viewpoint_test *test, const struct view *camera, struct err *err);
/* viewpoint_measure of `count` cameras on all threads. `test` gives scene and limits; its `renders` is increased. */
enum status viewpoints_measure(struct viewpoint *out, const struct view *cameras, int count,
                               struct viewpoint_test *test, struct err *err);
/* Whether all `count` cameras are valid, on all threads; the first that is not skips the rest, so those that are most
 * likely invalid should come first. */
enum status viewpoints_are_valid(bool *valid, const struct view *cameras, int count, struct viewpoint_test *test,
                                 struct err *err);
/* How many pixels of the views lie in a camera's frame, hidden or not: the weight of their points. */
double viewpoint_pixels_within(const struct viewpoint_test *test, const struct view *camera);
/* Sets up a test of the same scene and limits for another thread. */
void viewpoint_test_copy(struct viewpoint_test *test, const struct viewpoint_test *from);
void viewpoint_test_release(struct viewpoint_test *test);

#endif
