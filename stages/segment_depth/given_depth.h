/* given_depth.h - planes of segments whose depth is given: fitted to it, and fixed. */
#ifndef REMODEL_GIVEN_DEPTH_H
#define REMODEL_GIVEN_DEPTH_H

#include <stdbool.h>

#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/segment_params.h"

struct given_depth { /* arrays have one entry per segment */
    bool *known;     /* depth is given for 1/8 of its pixels and for 4; else the other entries are undefined */
    struct plane *planes;
    float *quality;  /* 1: the plane passes through all samples .. 0: it misses them by four steps */
    float *residual; /* mean |plane - 1/z| of the inliers */
    int segments;    /* number of known ones */
    int pixels;      /* number with given depth, in segments */
};

/* z: depth of each of the view's pixels, 0 if unknown. Widens the range to nearly all of the inverse depths; if
 * *min_inverse_z is 0, sets it. Returns false if no depth is known. */
bool given_depth_range(double *min_inverse_z, double *max_inverse_z, const float *z, size_t pixels);

/* Median ratio of the given depth to that of the sparse points that the view observed; 0 if fewer than eight of them
 * have a given depth. Far from 1, the given depth is in other units than the scene. */
double given_depth_ratio(const float *z, int width, int height, const struct observed_points *seen);

/* Fits a plane to the given depths of each segment: to those of the larger surface if there are two, of constant depth
 * if that explains the samples as well. step: of inverse depth, about one pixel of the widest baseline. g is {0} on
 * entry; release it also after a failure. Same result for any number of threads. */
enum status given_depth_make(struct given_depth *g, const struct segmentation *s, const float *z, double step,
                             const struct segment_params *params, struct err *err);
void given_depth_release(struct given_depth *g);

/* g may be NULL: no depth is given. */
static inline bool given_depth_has(const struct given_depth *g, int segment) { return g && g->known[segment]; }
static inline bool given_depth_equals(const struct given_depth *g, int segment, struct plane p)
{
    const struct plane own = g->planes[segment];
    return own.a == p.a && own.b == p.b && own.c == p.c;
}

#endif
