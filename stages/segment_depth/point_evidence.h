/* point_evidence.h - evidence of the sparse points for a segment's depth. */
#ifndef REMODEL_POINT_EVIDENCE_H
#define REMODEL_POINT_EVIDENCE_H

#include "stages/segment_depth/neighbours.h"
#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/segment_params.h"

#define NEAREST_POINTS 8

struct near_point {
    float u, v, inverse_z;
};

struct point_evidence {
    int *first; /* count + 1: the points inside segment i are [first[i], first[i + 1]) */
    struct observed_point *points;
    struct near_point *nearest;                /* NEAREST_POINTS per segment, nearest first */
    int nearest_count;                         /* 0 if the view has no points */
    double min_inverse_z, max_inverse_z, step; /* range and step of the sweep */
    double inside_weight, nearest_weight, far_weight;
};

/* The points that the view observed, by segment, and the nearest ones of each segment. e is empty after a failure. */
enum status point_evidence_make(struct point_evidence *e, const struct segmentation *s,
                                const struct observed_points *seen, double min_inverse_z, double max_inverse_z,
                                double step, const struct segment_params *params, struct err *err);
void point_evidence_release(struct point_evidence *e);

/* The share of a segment's points that lie within two steps of the plane, 0 .. 1; a single point counts half. */
double point_evidence_support(const struct point_evidence *e, int segment, struct plane plane);

/* The part of that cost that grows towards the camera. */
double point_evidence_far(const struct point_evidence *e, struct plane plane, double u, double v);

/* Cost of the plane, in units of the matching cost. u, v: the segment's centroid. */
double point_evidence_cost(const struct point_evidence *e, int segment, struct plane plane, double u, double v);

#endif
