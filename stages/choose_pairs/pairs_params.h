/* pairs_params.h - parameters of choose_pairs. */
#ifndef REMODEL_PAIRS_PARAMS_H
#define REMODEL_PAIRS_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define PAIRS_PARAMS(X)                                                                                               \
    X(matcher, choice, "auto", 0, 0, "auto|exhaustive|sequential|similar",                                            \
      "photo pairs to match: exhaustive is all pairs, sequential neighbours by name, similar these and photos whose " \
      "largest features match; auto: exhaustive up to 60 photos, then similar")                                       \
    X(largest, int, 500, 20, 10000, "", "features of a photo by which similar ones are found, the largest")           \
    X(least, int, 5, 1, 1000, "", "matches among these that make a pair similar")

struct pairs_params {
    PAIRS_PARAMS(PARAM_FIELD)
};
#define PAIRS_PARAMS_DEFAULT        \
    {                               \
        PAIRS_PARAMS(PARAM_DEFAULT) \
    }

#endif
