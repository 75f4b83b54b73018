/* eyes_params.h - parameters of plan_eyes. */
#ifndef REMODEL_EYES_PARAMS_H
#define REMODEL_EYES_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define EYES_PARAMS(X)                                                                                               \
    X(base, double, 0, 0, 1e9, "scene units",                                                                        \
      "distance between the eyes; 0: the largest that near_ratio, max_front and max_behind allow")                   \
    X(near_ratio, double, 30, 2, 1000, "", "least ratio of the nearest depth to the distance between the eyes")      \
    X(max_front, double, 1, 0, 10, "%", "largest disparity in front of the screen, of the width of the picture")     \
    X(max_behind, double, 2, 0.01, 10, "%", "largest disparity behind the screen, of the width of the picture")      \
    X(samples, int, 25, 2, 10000, "", "number of frames, spread evenly over the film, in which depths are measured") \
    X(side, int, 192, 16, 4096, "px", "longer side of the pictures in which depths are measured")                    \
    X(vr_side, int, 1440, 16, 8192, "px", "side of the square picture of each eye in a film of a half-sphere; even")

struct eyes_params {
    EYES_PARAMS(PARAM_FIELD)
};
#define EYES_PARAMS_DEFAULT        \
    {                              \
        EYES_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param eyes_param_table[];

#endif
