/* tour_params.h - parameters of plan_tour. */
#ifndef REMODEL_TOUR_PARAMS_H
#define REMODEL_TOUR_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define TOUR_PARAMS(X)                                                                                             \
    X(speed, double, 1, 0.01, 100, "m/s", "walking speed; without a scale in median distances between viewpoints") \
    X(turn, double, 50, 1, 720, "degrees/s", "greatest speed of turning; turns that need more time slow the walk") \
    X(hold, double, 1, 0, 60, "s", "rest at each stop")                                                            \
    X(clearance, double, 0.2, 0.01, 10, "m",                                                                       \
      "the camera keeps this distance from walls; without a scale in model units")                                 \
    X(fov, double, 80, 20, 140, "degrees", "horizontal field of view")                                             \
    X(width, int, 1280, 16, 8192, "px", "width of the frames, even")                                               \
    X(height, int, 720, 16, 8192, "px", "height of the frames, even")                                              \
    X(fps, double, 30, 1, 240, "1/s", "frames per second")

struct tour_params {
    TOUR_PARAMS(PARAM_FIELD)
};
#define TOUR_PARAMS_DEFAULT        \
    {                              \
        TOUR_PARAMS(PARAM_DEFAULT) \
    }

#endif
