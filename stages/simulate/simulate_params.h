/* simulate_params.h - parameters of simulate. */
#ifndef REMODEL_SIMULATE_PARAMS_H
#define REMODEL_SIMULATE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define SIMULATE_PARAMS(X)                                                                                        \
    X(samples, int, 16, 1, 65536, "", "light paths for every pixel of a photo; the noise halves with four times") \
    X(max_bounces, int, 0, 0, 1000, "", "reflections that are followed; 0: all of them, by Russian roulette")     \
    X(scale, double, 1, 0.02, 16, "", "size of the photos, as a multiple of what cameras.txt says")               \
    X(seed, int, 1, 0, 2147483647, "", "of the light paths; the noise of the sensor has its own in cameras.txt")  \
    X(truth, choice, "yes", 0, 0, "yes|no", "radiance, depth and faces of every photo")                           \
    X(irradiance_points, int, 120, 0, 100000, "", "places at which the true irradiance is found")                 \
    X(irradiance_samples, int, 16384, 1, 65536, "", "light paths for each of them")

struct simulate_params {
    SIMULATE_PARAMS(PARAM_FIELD)
};
#define SIMULATE_PARAMS_DEFAULT        \
    {                                  \
        SIMULATE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param simulate_param_table[];

#endif
