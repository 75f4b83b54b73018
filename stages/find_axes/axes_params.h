/* axes_params.h - the parameters of find_axes. */
#ifndef REMODEL_AXES_PARAMS_H
#define REMODEL_AXES_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define AXES_PARAMS(X)                                                                                           \
    X(min_part, double, 0.05, 0, 1, "",                                                                          \
      "minimum fraction of the points with normals within 10 degrees of an axis, for the best two axes")         \
    X(up_angle, double, 25, 1, 45, "degrees",                                                                    \
      "maximum angle between up and the normals of floor points, and between down and those of ceiling points")  \
    X(min_floor, double, 0.001, 0, 1, "", "minimum number of floor points, as a fraction of all points")         \
    X(min_ceiling, double, 0.0002, 0, 1, "",                                                                     \
      "minimum number of ceiling points, as a fraction of all points; small, as ceilings are often blank")       \
    X(plane_angle, double, 15, 1, 45, "degrees",                                                                 \
      "maximum angle between an axis and the normals of points in the planes across it")                         \
    X(min_plane, double, 0.01, 0, 1, "",                                                                         \
      "minimum number of points of a wall, floor or ceiling that refines the axes, as a fraction of all points") \
    X(click, double, 1, 0.01, 100, "px", "standard error of the pixels that a user marked")                      \
    X(pictures, int, 4, 0, 1000, "", "number of photographs on which the axes are drawn")

struct axes_params {
    AXES_PARAMS(PARAM_FIELD)
};
#define AXES_PARAMS_DEFAULT        \
    {                              \
        AXES_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param axes_param_table[];

#endif
