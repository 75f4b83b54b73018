/* model_params.h - the parameters of build_model. */
#ifndef REMODEL_BUILD_MODEL_MODEL_PARAMS_H
#define REMODEL_BUILD_MODEL_MODEL_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define MODEL_PARAMS(X)                                                                                                \
    X(max_angle, double, 25, 1, 44, "degrees",                                                                         \
      "maximum angle between a point's normal and the axis that it votes for")                                         \
    X(min_points, int, 30, 1, 1000000, "", "minimum number of points with the wall's normal in a rectangle on a wall") \
    X(window, double, 0.01, 1e-6, 1, "",                                                                               \
      "width of the window of a wall's points, as a fraction of the ceiling's height")                                 \
    X(click, double, 2, 0.01, 100, "px", "standard error of the pixels of corners and of lines along a wall")          \
    X(max_turn, double, 5, 0, 30, "degrees",                                                                           \
      "maximum angle between a wall and its line or corners in photographs, besides what clicks explain")              \
    X(overlay_side, int, 1200, 64, 20000, "px", "length of the longer side of the photographs with the model's edges")

struct model_params {
    MODEL_PARAMS(PARAM_FIELD)
};
#define MODEL_PARAMS_DEFAULT        \
    {                               \
        MODEL_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param model_param_table[];

#endif
