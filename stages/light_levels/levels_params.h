/* levels_params.h - parameters of light_levels. */
#ifndef REMODEL_LEVELS_PARAMS_H
#define REMODEL_LEVELS_PARAMS_H

#include "common/base/param.h"
#include "common/model/model_metre.h"

/* name, type, default, min, max, unit, help */
#define LEVELS_PARAMS(X)                                                                                              \
    X(patches, int, 4000, 50, 100000, "", "number of patches that the surfaces are divided into, about")              \
    X(rays, int, 512, 16, 65536, "", "rays of a patch to other patches; as many go to the windows")                   \
    X(point_rays, int, 2048, 16, 1 << 20, "", "rays of a point to patches; as many go to the windows")                \
    X(spacing, double, 0.5, 0.05, 10, "m", "distance of the points on a work plane or floor")                         \
    X(margin, double, 0.5, 0, 10, "m", "distance of these points from the walls")                                     \
    X(work_plane, double, 0.75, 0.05, 3, "m", "height of the work plane above the floor")                             \
    X(room_height, double, MODEL_METRE_ROOM, 1.5, 10, "m",                                                            \
      "height of rooms by which a metre is guessed in a scene without a scale; those of homes are 2.2 to 3.2")        \
    X(glass, double, 0.8, 0.01, 1, "",                                                                                \
      "part of the light that the panes let through, for skies other than the photographed one, which has it")        \
    X(ground, double, 0.2, 0, 1, "", "reflectance of the ground outdoors, for skies other than the photographed one") \
    X(day_sky, choice, "clear", 0, 0, "clear|partly|overcast", "sky of the film of a day without a weather file")     \
    X(error, double, 0.07, 0, 2, "",                                                                                  \
      "relative standard error of an illuminance by model, textures and rays, beside those of lamps, sky and sun")    \
    X(sky_error, double, 0.2, 0, 2, "",                                                                               \
      "the same of light of skies other than the photographed one: panes, ground, what stands outdoors")              \
    X(tolerance, double, 1e-4, 1e-8, 0.1, "", "part of a patch's light that the last round may change")

struct levels_params {
    LEVELS_PARAMS(PARAM_FIELD)
};
#define LEVELS_PARAMS_DEFAULT        \
    {                                \
        LEVELS_PARAMS(PARAM_DEFAULT) \
    }

#endif
