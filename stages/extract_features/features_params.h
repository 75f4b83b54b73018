/* features_params.h - parameters of extract_features. */
#ifndef REMODEL_FEATURES_PARAMS_H
#define REMODEL_FEATURES_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define FEATURES_PARAMS(X)                                                                                  \
    X(max_features, int, 8192, 100, 100000, "", "maximum number of features per photo")                     \
    X(max_image_size, int, 3200, 200, 20000, "px",                                                          \
      "longer side to which larger photos are scaled down before features are found")                       \
    X(min_contrast, double, 0.013, 0.001, 0.2, "", "minimum contrast of a feature; 1: from black to white") \
    X(max_edge, double, 15, 1, 1000, "", "maximum ratio of a feature's principal curvatures; edges have large ones")

struct features_params {
    FEATURES_PARAMS(PARAM_FIELD)
};
#define FEATURES_PARAMS_DEFAULT        \
    {                                  \
        FEATURES_PARAMS(PARAM_DEFAULT) \
    }

#endif
