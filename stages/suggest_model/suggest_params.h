/* suggest_params.h - the parameters of suggest_model. */
#ifndef REMODEL_SUGGEST_PARAMS_H
#define REMODEL_SUGGEST_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help; parts are of the ceiling's height */
#define SUGGEST_PARAMS(X)                                                                                        \
    X(max_angle, double, 20, 1, 44, "degrees", "between a point's normal and the wall's, at most")               \
    X(window, double, 0.01, 0.001, 0.1, "",                                                                      \
      "width in which the points of a wall gather, as a part of the ceiling's height")                           \
    X(cell, double, 0.04, 0.005, 0.2, "", "edge of the cells in which a wall is seen or seen through, the same") \
    X(least_wall, double, 0.2, 0.01, 1, "",                                                                      \
      "part of a wall's cells with points less those that are seen through, at least")                           \
    X(thickest, double, 0.25, 0.01, 1, "", "wall between rooms, at most, as a part of the ceiling's height")     \
    X(narrowest, double, 0.2, 0.02, 1, "", "opening, at least, the same")

struct suggest_params {
    SUGGEST_PARAMS(PARAM_FIELD)
};
#define SUGGEST_PARAMS_DEFAULT        \
    {                                 \
        SUGGEST_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param suggest_param_table[];

#endif
