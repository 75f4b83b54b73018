/* depth_deviation.h - how far off the depth of segments may be: a standard deviation for each. */
#ifndef REMODEL_DEPTH_DEVIATION_H
#define REMODEL_DEPTH_DEVIATION_H

#include "stages/segment_depth/plane_problem.h"

/* What 68 % of the sparse points are off the planes of their segments at most, in steps of inverse depth. With few
 * points it tends to 1. */
double deviation_of_points(const struct plane_problem *p, const struct plane *planes);

/* Standard deviation, in steps, of the depths around segment i's plane that match as well as it does: pictures of the
 * surface around the segment decide. Only in the first round, which has matching costs at all depths. */
double deviation_of_matches(const struct plane_problem *p, const struct plane *planes, int segment);

/* Fills deviation[] of all segments: the standard deviation of the relative error of inverse depth, (1/z - 1/z_true) z.
 * before: after the first round, the deviation of each segment's previous plane, in steps; agreeing: how many other
 * views agree on each segment's depth; both NULL in the first round. */
void deviation_find(double *deviation, const struct plane_problem *p, const struct plane *planes, const double *before,
                    const double *agreeing);

#endif
