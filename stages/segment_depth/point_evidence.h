/* point_evidence.h - what the sparse points say about a segment's depth. */
#ifndef REMODEL_POINT_EVIDENCE_H
#define REMODEL_POINT_EVIDENCE_H

#include "stages/segment_depth/neighbours.h"
#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/segment_params.h"

#define NEAREST_POINTS 8

/* Points inside each segment are measurements. Where there are none, a textureless segment most likely has the depth of
 * some point nearby, in place and colour; of several, the farthest, since the edges of a flat region belong to what
 * stands in front of it. Both are soft: they decide where the pictures say nothing. */
struct point_evidence {
    int *first; /* count + 1: the points inside segment i are [first[i], first[i + 1]) */
    struct seen_point *points;
    float *nearest;           /* NEAREST_POINTS inverse depths a segment, ascending */
    int nearest_count;        /* 0 if the view has no points */
    double least, most, step; /* inverse depths of the sweep, and one pixel */
    double inside_weight, nearest_weight, far_weight;
};

enum status point_evidence_make(struct point_evidence *e, const struct segmentation *s, const struct seen_points *seen,
                                double least, double most, double step, const struct segment_params *params,
                                struct err *err);
void point_evidence_release(struct point_evidence *e);

/* In units of the matching cost. u, v: the segment's centroid. */
double point_evidence_cost(const struct point_evidence *e, int segment, struct plane plane, double u, double v);

#endif
