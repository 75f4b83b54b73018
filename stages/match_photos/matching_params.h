/* matching_params.h - parameters of match_photos. */
#ifndef REMODEL_MATCHING_PARAMS_H
#define REMODEL_MATCHING_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define MATCHING_PARAMS(X)                                                                            \
    X(max_ratio, double, 0.8, 0.1, 1, "",                                                             \
      "maximum angle between matching descriptors, as a fraction of the angle to the second nearest") \
    X(max_angle, double, 0.7, 0.1, 1.58, "rad", "maximum angle between matching descriptors")

struct matching_params {
    MATCHING_PARAMS(PARAM_FIELD)
};
#define MATCHING_PARAMS_DEFAULT        \
    {                                  \
        MATCHING_PARAMS(PARAM_DEFAULT) \
    }

#endif
