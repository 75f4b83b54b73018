/* materials_params.h - parameters of fit_materials. */
#ifndef REMODEL_FIT_MATERIALS_PARAMS_H
#define REMODEL_FIT_MATERIALS_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define MATERIALS_PARAMS(X)                                                                                  \
    X(points, int, 200, 1, 5000, "", "points of a material, on grids over its regions")                      \
    X(views, int, 8, 1, 64, "", "largest number of views of a point")                                        \
    X(patch, int, 1, 0, 20, "px", "half side of the square of a view's pixels that are averaged at a point") \
    X(max_clutter, double, 0.5, 0, 1, "", "clutter of a view's pixel from which it does not show the model") \
    X(min_angle, double, 8, 0, 89, "degrees",                                                                \
      "angle between a surface and a view's rays, below which the view does not count")                      \
    X(edge, int, 3, 0, 32, "px", "distance from jumps in depth, below which a view's pixel does not count")  \
    X(noise, double, 0.01, 0, 1, "", "relative deviation of a sample beyond the noise of its pixels")        \
    X(lobe_rays, int, 1024, 16, 65536, "", "rays of a sample about its mirror direction")                    \
    X(emitter_rays, int, 64, 1, 65536, "", "rays of a point to each lamp, opening and sun")                  \
    X(diffuse_rays, int, 2048, 16, 65536, "", "cosine-weighted rays of a point")

struct materials_params {
    MATERIALS_PARAMS(PARAM_FIELD)
};
#define MATERIALS_PARAMS_DEFAULT        \
    {                                   \
        MATERIALS_PARAMS(PARAM_DEFAULT) \
    }

#endif
