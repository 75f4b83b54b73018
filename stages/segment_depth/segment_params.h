/* segment_params.h - parameters of segment_depth. */
#ifndef REMODEL_SEGMENT_PARAMS_H
#define REMODEL_SEGMENT_PARAMS_H

#include <stdbool.h>

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define SEGMENT_PARAMS(X)                                                                                            \
    X(segment_pixels, int, 64, 16, 100000, "px", "mean size of a segment in the first round")                        \
    X(fine_pixels, int, 16, 8, 100000, "px", "mean size of a segment in the rounds after the first")                 \
    X(half_from, double, 0, 0, 1000, "Mpx",                                                                          \
      "size of a view from which on the first round matches pictures of half the size; 0: it never does")            \
    X(half_pixels, int, 48, 8, 100000, "px", "mean size of a segment in pictures of half the size")                  \
    X(compactness, double, 8, 0.1, 100, "",                                                                          \
      "weight of distance against colour in over-segmentation; higher: rounder segments")                            \
    X(neighbours, int, 8, 1, 16, "", "maximum number of views to match with")                                        \
    X(best_neighbours, int, 4, 1, 16, "", "how many of them each segment is matched with: those that match it best") \
    X(near, double, 0, 0, 1e30, "scene units", "minimum depth; 0: found from the sparse points")                     \
    X(far, double, 0, 0, 1e30, "scene units", "maximum depth; 0: found from the sparse points")                      \
    X(planes, int, 256, 4, 1024, "", "maximum number of planes in the sweep; fewer if one-pixel steps need fewer")   \
    X(smoothness, double, 1.0, 0, 100, "", "weight of the smoothness cost between adjacent segments")                \
    X(jump, double, 12, 1, 1000, "steps", "depth difference at which the smoothness cost is truncated")              \
    X(rounds, int, 1, 0, 9, "",                                                                                      \
      "maximum number of rounds after the first, each using the neighbours' depth of the previous round")            \
    X(min_change, double, 0.1, 0, 1, "",                                                                             \
      "share of pixels whose depth must change by over 1 % in a round, in a view or on average in those it is "      \
      "matched with, for the view to be estimated in the next; 0: every round estimates all views")                  \
    X(passes, int, 3, 0, 20, "",                                                                                     \
      "optimization passes over all segments in the first round; a third as many in later rounds")                   \
    X(slant, double, 0.01, 0, 10, "",                                                                                \
      "cost of a slanted plane along half the outline of a mean segment, where its neighbours have other planes")    \
    X(points, double, 1, 0, 10, "", "weight of the sparse points inside a segment")                                  \
    X(nearest_points, double, 0.01, 0, 10, "", "weight of the sparse points near a segment")                         \
    X(cross_view, double, 1.7, 0, 10, "", "weight of consistency with the neighbours' depth of the previous round")  \
    X(model_gain, double, 0.08, 0, 10, "",                                                                           \
      "by how much less a segment costs on the face of the solid model that it may show")                            \
    X(far_bias, double, 0.01, 0, 10, "",                                                                             \
      "cost of the nearest depth relative to the farthest where nothing else decides")                               \
    X(matte, choice, "two_colour", 0, 0, "two_colour|none", "how pixels at depth edges are split")

struct segment_params {
    SEGMENT_PARAMS(PARAM_FIELD)
};
#define SEGMENT_PARAMS_DEFAULT        \
    {                                 \
        SEGMENT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param segment_param_table[];

/* Later rounds start from the planes of the previous one and need fewer passes. */
static inline int depth_passes(const struct segment_params *p, bool first)
{
    return first ? p->passes : (p->passes + 2) / 3;
}

/* Whether the first round matches a view of so many pixels at half its size. */
static inline bool depth_halves(const struct segment_params *p, double pixels)
{
    return p->half_from > 0 && pixels >= p->half_from * 1e6;
}

#endif
