/* suggest_params.h - the parameters of suggest_model. */
#ifndef REMODEL_SUGGEST_PARAMS_H
#define REMODEL_SUGGEST_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define SUGGEST_PARAMS(X)                                                                               \
    X(max_angle, double, 20, 1, 44, "degrees", "maximum angle between a point's normal and the wall's") \
    X(window, double, 0.01, 0.001, 0.1, "",                                                             \
      "width of the window in which the points of a wall lie, as a fraction of the ceiling's height")   \
    X(cell, double, 0.04, 0.005, 0.2, "",                                                               \
      "edge of a wall's cells, which are solid or seen through, as a fraction of the ceiling's height") \
    X(min_wall, double, 0.3, 0.01, 1, "",                                                               \
      "minimum fraction of a wall's length that was seen; a border with less is written as a doubt")    \
    X(weak_wall, double, 0.2, 0.01, 1, "",                                                              \
      "the same for an outer wall behind which no camera stands, at most min_wall")                     \
    X(max_thickness, double, 0.25, 0.01, 1, "",                                                         \
      "maximum thickness of a wall between rooms, as a fraction of the ceiling's height")               \
    X(min_opening, double, 0.2, 0.02, 1, "",                                                            \
      "min width and height of an opening, as a fraction of the ceiling's height")

struct suggest_params {
    SUGGEST_PARAMS(PARAM_FIELD)
};
#define SUGGEST_PARAMS_DEFAULT        \
    {                                 \
        SUGGEST_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param suggest_param_table[];

#endif
