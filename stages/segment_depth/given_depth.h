/* given_depth.h - planes of segments whose depth is given: fitted to it, and kept. */
#ifndef REMODEL_GIVEN_DEPTH_H
#define REMODEL_GIVEN_DEPTH_H

#include <stdbool.h>

#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/segment_params.h"

struct given_depth { /* an entry a segment */
    bool *known;     /* depth is given for an eighth of its pixels, and four: the rest has no meaning where it is not */
    struct plane *planes;
    float *good;  /* 1: the plane goes through all samples .. 0: it misses them by four steps */
    float *off;   /* mean |plane - 1/z| of the samples that the plane stands for */
    int segments; /* known ones */
    int pixels;   /* of segments, with given depth */
};

/* z: of each of the view's pixels, 0 unknown; false if none is known. Widens [least, most] to nearly all of the inverse
 * depths; where least is 0, they are all. */
bool given_depth_range(double *least, double *most, const float *z, size_t pixels);

/* Median of the given depth against that of the sparse points which the view saw where depth is given; 0 if these are fewer than
 * eight. Far from 1, the depth is in other units than the scene. */
double given_depth_ratio(const float *z, int width, int height, const struct seen_points *seen);

/* step: of inverse depth, about one pixel of the widest baseline. A segment with samples of two surfaces gets the plane of the larger
 * part; a constant depth where that explains the samples as well. g is {0} on entry; release it also after a failure. The same
 * for any number of threads. */
enum status given_depth_make(struct given_depth *g, const struct segmentation *s, const float *z, double step,
                             const struct segment_params *params, struct err *err);
void given_depth_release(struct given_depth *g);

/* g NULL: nothing is given. */
static inline bool given_depth_knows(const struct given_depth *g, int segment) { return g && g->known[segment]; }
static inline bool given_depth_is(const struct given_depth *g, int segment, struct plane p)
{
    const struct plane own = g->planes[segment];
    return own.a == p.a && own.b == p.b && own.c == p.c;
}

#endif
