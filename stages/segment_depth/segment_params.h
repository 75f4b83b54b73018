/* segment_params.h - parameters of segment_depth. */
#ifndef REMODEL_SEGMENT_PARAMS_H
#define REMODEL_SEGMENT_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define SEGMENT_PARAMS(X)                                                                                         \
    X(segment_pixels, int, 64, 16, 100000, "px", "pixels that a segment has on average")                          \
    X(compactness, double, 8, 0.1, 100, "", "over-segmentation: distance against colour; more is rounder")        \
    X(neighbours, int, 4, 1, 16, "", "views to match with")                                                       \
    X(near, double, 0, 0, 1e30, "scene units", "least depth that is tried; 0: as the sparse points tell")         \
    X(far, double, 0, 0, 1e30, "scene units", "greatest depth that is tried; 0: as the sparse points tell")       \
    X(planes, int, 256, 4, 1024, "", "most planes of the sweep; fewer if a step of one pixel needs fewer")        \
    X(smoothness, double, 1.0, 0, 100, "", "how strongly touching segments want the same depth")                  \
    X(jump, double, 12, 1, 1000, "steps", "a depth difference that costs no more when it grows")                  \
    X(rounds, int, 1, 0, 9, "", "after the first one, in which views look at each other's depths")                \
    X(passes, int, 3, 0, 20, "", "over all segments' planes in the first round; half as many later")              \
    X(slant, double, 0.02, 0, 10, "", "what a slanted plane must explain better than a constant depth")           \
    X(points, double, 1, 0, 10, "", "weight of the sparse points that a segment holds")                           \
    X(nearest_points, double, 0.01, 0, 10, "", "weight of the sparse points near a segment")                      \
    X(cross_view, double, 1.7, 0, 10, "", "weight of what neighbours' depths of the round before say")            \
    X(far_bias, double, 0.01, 0, 10, "", "from nearest to farthest: what a depth costs where nothing else tells") \
    X(matte, choice, "two_colour", 0, 0, "two_colour|none", "how pixels at depth edges are split")

struct segment_params {
    SEGMENT_PARAMS(PARAM_FIELD)
};
#define SEGMENT_PARAMS_DEFAULT        \
    {                                 \
        SEGMENT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param segment_param_table[];

#endif
