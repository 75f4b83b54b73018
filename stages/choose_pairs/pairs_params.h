/* pairs_params.h - parameters of choose_pairs. */
#ifndef REMODEL_PAIRS_PARAMS_H
#define REMODEL_PAIRS_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define PAIRS_PARAMS(X)                                                                                                \
    X(matcher, choice, "auto", 0, 0, "auto|exhaustive|sequential|similar",                                             \
      "photo pairs to match; exhaustive: all; sequential: neighbours by name; similar: neighbours by name and photos " \
      "that look alike; auto: exhaustive up to 60 photos, else similar")                                               \
    X(compared_features, int, 500, 20, 10000, "", "number of a photo's largest features used to find similar photos")  \
    X(min_matches, int, 5, 1, 1000, "",                                                                                \
      "minimum number of matches between the compared features of two similar photos")                                 \
    X(max_similar, int, 120, 1, 100000, "",                                                                            \
      "maximum number of similar photos that each photo selects; others may select it as well")

struct pairs_params {
    PAIRS_PARAMS(PARAM_FIELD)
};
#define PAIRS_PARAMS_DEFAULT        \
    {                               \
        PAIRS_PARAMS(PARAM_DEFAULT) \
    }

#endif
