/* judge_params.h - parameters of judge_photos. */
#ifndef REMODEL_JUDGE_PARAMS_H
#define REMODEL_JUDGE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define JUDGE_PARAMS(X)                                                                                  \
    X(max_edge, double, 4, 1, 100, "px",                                                                 \
      "largest width of the sharper edges of a sharp photo, in a picture of at most 1600 px")            \
    X(max_edge_ratio, double, 1.8, 1, 100, "",                                                           \
      "largest ratio of a photo's width of edges to the median of all photos, if it is above soft_edge") \
    X(soft_edge, double, 2.5, 1, 100, "px", "width of edges up to which no photo is blurred")            \
    X(max_bright, double, 0.3, 0, 1, "", "largest fraction of white pixels of a well exposed photo")     \
    X(max_dark, double, 0.5, 0, 1, "", "largest fraction of black pixels of a well exposed photo")       \
    X(min_matches, int, 30, 1, 100000, "", "minimum number of matches of two photos that overlap")

struct judge_params {
    JUDGE_PARAMS(PARAM_FIELD)
};
#define JUDGE_PARAMS_DEFAULT        \
    {                               \
        JUDGE_PARAMS(PARAM_DEFAULT) \
    }

#endif
