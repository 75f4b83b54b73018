/* walk_params.h - parameters of walk. */
#ifndef REMODEL_WALK_PARAMS_H
#define REMODEL_WALK_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define WALK_PARAMS(X)                                                                                          \
    X(texture_quality, int, 90, 1, 100, "", "quality of the WebP pictures that hold the textures of the model") \
    X(photo_quality, int, 88, 1, 100, "", "quality of the WebP pictures of photographs")                        \
    X(effort, int, 3, 0, 6, "", "effort of the WebP encoder: 0 is quick, 6 makes the smallest files")           \
    X(grid, int, 2, 1, 64, "px", "distance of the points of a view at which the depth of furniture is kept")    \
    X(tour_step, int, 6, 1, 1000, "frames", "distance of the frames of a tour that are kept as its route")      \
    X(light_step, int, 4, 1, 64, "texels", "side of the squares of texels whose change of light is averaged")

struct walk_params {
    WALK_PARAMS(PARAM_FIELD)
};
#define WALK_PARAMS_DEFAULT        \
    {                              \
        WALK_PARAMS(PARAM_DEFAULT) \
    }

#endif
