/* simulate_params.h - parameters of simulate. */
#ifndef REMODEL_SIMULATE_PARAMS_H
#define REMODEL_SIMULATE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define SIMULATE_PARAMS(X)                                                                                             \
    X(samples, int, 16, 1, 65536, "", "light paths per pixel of a photo; four times as many halve the noise")          \
    X(truth_samples, int, 0, 0, 65536, "", "light paths per pixel of true radiance and irradiance; 0: as for photos")  \
    X(max_bounces, int, 0, 0, 1000, "", "reflections to follow; 0: no limit, paths end by Russian roulette")           \
    X(scale, double, 1, 0.02, 16, "", "size of the photos, as a multiple of the sizes in cameras.txt")                 \
    X(seed, int, 1, 0, 2147483647, "", "seed of the light paths; the sensor noise has its own seed in cameras.txt")    \
    X(truth, choice, "yes", 0, 0, "yes|no", "write the true radiance, depth and face ids of each photo")               \
    X(irradiance_points, int, 120, 0, 100000, "", "number of points at which to compute the true irradiance; 0: none") \
    X(irradiance_samples, int, 16384, 1, 65536, "", "light paths per irradiance point")

struct simulate_params {
    SIMULATE_PARAMS(PARAM_FIELD)
};
#define SIMULATE_PARAMS_DEFAULT        \
    {                                  \
        SIMULATE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param simulate_param_table[];

#endif
