/* depth_deviation.h - how far off the depth of segments may be: a standard deviation for each. */
#ifndef REMODEL_DEPTH_DEVIATION_H
#define REMODEL_DEPTH_DEVIATION_H

#include "stages/segment_depth/plane_problem.h"

/* 68 % of the sparse points are at most *steps of inverse depth off the planes of their segments. With few points it
 * tends to 1. ST_NOMEM. */
enum status deviation_of_points(double *steps, const struct plane_problem *p, const struct plane *planes,
                                struct err *err);

/* Standard deviation, in steps, of the depths around a segment's plane that match as well as it does: pictures of the
 * surface around the segment decide. Only in the first round, which has matching costs at all depths. room: for
 * 2 p->planes numbers. */
double deviation_of_matches(const struct plane_problem *p, const struct plane *planes, int segment, double *room);

/* Fills deviation[] of all segments: the standard deviation of the relative error of inverse depth, (1/z - 1/z_true) z.
 * before: after the first round, the deviation of each segment's previous plane, in steps; agreeing: how many other
 * views agree on each segment's depth; both NULL in the first round. ST_NOMEM. */
enum status deviation_find(double *deviation, const struct plane_problem *p, const struct plane *planes,
                           const double *before, const double *agreeing, struct err *err);

#endif
