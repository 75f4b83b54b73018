/* update_params.h - parameters of update_vita. */
#ifndef REMODEL_UPDATE_PARAMS_H
#define REMODEL_UPDATE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define UPDATE_PARAMS(X)                                                                                             \
    X(spacing, double, 0.04, 0.001, 1, "", "distance of the first samples on a face, as a part of the model's size") \
    X(finest, double, 0.005, 0.0005, 1, "",                                                                          \
      "distance of samples where light bends most, as a part of the model's size")                                   \
    X(bend, double, 0.05, 0.001, 10, "",                                                                             \
      "relative error of interpolation above which a sample is added between two others")                            \
    X(max_samples, int, 12000, 100, 1000000, "", "samples on all faces")                                             \
    X(rays, int, 2048, 64, 65536, "", "rays of a sample")                                                            \
    X(rounds, int, 400, 1, 10000, "", "most rounds of light from face to face")                                      \
    X(tolerance, double, 0.01, 1e-9, 1, "", "part of a sample's irradiance that may be missing when the rounds end")

struct update_params {
    UPDATE_PARAMS(PARAM_FIELD)
};
#define UPDATE_PARAMS_DEFAULT        \
    {                                \
        UPDATE_PARAMS(PARAM_DEFAULT) \
    }

#endif
