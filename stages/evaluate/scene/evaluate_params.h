/* evaluate_params.h - the parameters of evaluate. */
#ifndef REMODEL_EVALUATE_PARAMS_H
#define REMODEL_EVALUATE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define EVALUATE_PARAMS(X)                                                                                      \
    X(baseline, double, 0, 0, 1e9, "m",                                                                         \
      "baseline of disparities; 0: the median over the photos of the true distance to the nearest other one")   \
    X(disparity_side, int, 1200, 0, 100000, "px",                                                               \
      "long side of the picture in whose pixels disparity is measured; 0: the view's own")                      \
    X(far, double, 1000, 0, 1e30, "m", "maximum true depth; greater ones are sky and count as unknown")         \
    X(white, double, 0, 0, 1e9, "",                                                                             \
      "true radiance that is white where pictures are compared in 8 bits; 0: that of the value 1 in the views") \
    X(max_offset, double, 0.1, 0, 1e9, "m",                                                                     \
      "maximum distance of a rendered picture's camera from the true one; pictures farther away are skipped")   \
    X(surface_distance, double, 0.05, 0, 1e9, "m",                                                              \
      "maximum distance of a true point from a face of the model that it counts as lying on")

struct evaluate_params {
    EVALUATE_PARAMS(PARAM_FIELD)
};
#define EVALUATE_PARAMS_DEFAULT        \
    {                                  \
        EVALUATE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param evaluate_param_table[];

#endif
