/* model_params.h - the parameters of build_model. */
#ifndef REMODEL_BUILD_MODEL_MODEL_PARAMS_H
#define REMODEL_BUILD_MODEL_MODEL_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define MODEL_PARAMS(X)                                                                                    \
    X(max_angle, double, 25, 1, 44, "degrees", "between a point's normal and the axis that it counts for") \
    X(least_points, int, 30, 1, 1000000, "", "in a rectangle on a wall, that rest on the wall")            \
    X(window, double, 0.01, 1e-6, 1, "",                                                                   \
      "width in which the points of a wall's position gather, as a part of the ceiling's "                 \
      "height")                                                                                            \
    X(overlay_side, int, 1200, 64, 20000, "px", "longest side of the photographs with the model's edges")

struct model_params {
    MODEL_PARAMS(PARAM_FIELD)
};
#define MODEL_PARAMS_DEFAULT        \
    {                               \
        MODEL_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param model_param_table[];

#endif
