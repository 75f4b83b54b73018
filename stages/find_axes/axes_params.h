/* axes_params.h - the parameters of find_axes. */
#ifndef REMODEL_AXES_PARAMS_H
#define REMODEL_AXES_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define AXES_PARAMS(X)                                                                                                 \
    X(least_part, double, 0.05, 0, 1, "",                                                                              \
      "part of the points that must look along an axis (within 10 degrees), at least, of two axes")                    \
    X(up_angle, double, 25, 1, 45, "degrees", "points whose normals are nearer to up (down) seek the floor (ceiling)") \
    X(least_floor, double, 0.001, 0, 1, "", "part of the points that must seek the floor")                             \
    X(least_ceiling, double, 0.0002, 0, 1, "", "part of the points that must seek the ceiling, which is often blank")  \
    X(plane_angle, double, 15, 1, 45, "degrees", "points whose normals are nearer to an axis may lie in its planes")   \
    X(least_plane, double, 0.01, 0, 1, "",                                                                             \
      "part of the points that a wall, floor or ceiling has, at least, to refine axes")                                \
    X(click, double, 1, 0.01, 100, "px", "standard error of the pixels that a user marked")                            \
    X(pictures, int, 4, 0, 1000, "", "photographs on which the axes are drawn")

struct axes_params {
    AXES_PARAMS(PARAM_FIELD)
};
#define AXES_PARAMS_DEFAULT        \
    {                              \
        AXES_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param axes_param_table[];

#endif
