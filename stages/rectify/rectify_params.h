/* rectify_params.h - parameters of rectify: what is assumed of a photo of one exposure, for the channels sigma and
 * clipped. */
#ifndef REMODEL_RECTIFY_PARAMS_H
#define REMODEL_RECTIFY_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define RECTIFY_PARAMS(X)                                                                                           \
    X(electrons, double, 30000, 10, 1e9, "",                                                                        \
      "electrons that a pixel of an unmerged photo collects at white, for its photon noise")                        \
    X(read_noise, double, 6, 0, 1e6, "", "standard deviation of the read noise of an unmerged photo, in electrons") \
    X(saturated, double, 0.95, 0.1, 1, "",                                                                          \
      "linear sample value, as a fraction of white, from which a pixel of an unmerged photo counts as clipped")     \
    X(dark, double, 0.001, 0, 0.1, "",                                                                              \
      "linear sample value, as a fraction of white, up to which a pixel of an unmerged photo counts as dark")

struct rectify_params {
    RECTIFY_PARAMS(PARAM_FIELD)
};
#define RECTIFY_PARAMS_DEFAULT        \
    {                                 \
        RECTIFY_PARAMS(PARAM_DEFAULT) \
    }

#endif
