/* fit_lights_params.h - parameters of fit_lights. */
#ifndef REMODEL_FIT_LIGHTS_PARAMS_H
#define REMODEL_FIT_LIGHTS_PARAMS_H

#include "common/base/param.h"
#include "common/gather/gatherer.h"

/* name, type, default, min, max, unit, help */
#define FIT_LIGHTS_PARAMS(X)                                                                                         \
    X(patch, int, 1, 0, 20, "px", "half side of the square of a view's pixels that are averaged at a point")         \
    X(grid, int, 5, 1, 50, "", "points along each side of an annotated rectangle")                                   \
    X(texture, double, 0.05, 0, 1, "", "assumed relative deviation of a material's reflectance from point to point") \
    X(places, int, 400, 0, 1000, "",                                                                                 \
      "rays of a lamp; where they meet the model, or, if it has marks, a face of theirs, its light tells its "       \
      "radiance")                                                                                                    \
    X(irradiance_error, double, 0.05, 0, 1, "",                                                                      \
      "assumed relative error of indirect light: of all of it, of each wall's")                                      \
    X(seen_error, double, 0.02, 0.001, 1, "",                                                                        \
      "relative error of a lamp's radiance, or of its lower bound, as views show it")                                \
    X(click, double, 0.5, 0, 100, "px", "assumed error of the marked centre of a lamp, for the interval of beta")    \
    X(max_clutter, double, 0.5, 0, 1, "",                                                                            \
      "clutter of a view's pixel from which it does not show a point of the model")                                  \
    X(unseen, choice, "use", 0, 0, "use|say|no",                                                                     \
      "lamps that no photo shows, found by the light that they throw: used as lights, said only, or not looked for")

struct fit_lights_params {
    FIT_LIGHTS_PARAMS(PARAM_FIELD)
    GATHER_PARAMS(PARAM_FIELD)
};
#define FIT_LIGHTS_PARAMS_DEFAULT                                     \
    {                                                                 \
        FIT_LIGHTS_PARAMS(PARAM_DEFAULT) GATHER_PARAMS(PARAM_DEFAULT) \
    }

#endif
