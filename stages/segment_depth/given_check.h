/* given_check.h - whether given depth belongs to the sparse points of its view, and disparity without a scale. */
#ifndef REMODEL_GIVEN_CHECK_H
#define REMODEL_GIVEN_CHECK_H

#include "stages/segment_depth/neighbours.h"

enum { GIVEN_CHECKED = 20 }; /* points with given depth; with fewer nothing is said */

/* Spearman's rank correlation of the given values, 0 unknown, and the depths of the points that the view observed: 1
 * where both rise together, -1 where one falls as the other rises; NaN with fewer than GIVEN_CHECKED points. ST_NOMEM.
 */
enum status given_check_ranks(double *correlation, const float *values, int width, int height,
                              const struct observed_points *seen, struct err *err);

/* Replaces disparities, 0 unknown, by depths: 1 / z = a value + b, robustly fitted to the points. *fits: false, and the
 * values are as they were, with fewer than GIVEN_CHECKED points, or if a is not positive. ST_NOMEM. */
enum status given_check_fit(bool *fits, float *values, int width, int height, const struct observed_points *seen,
                            struct err *err);

enum { LONE_FARTHEST = 100 };

/* The same of the only view of a scene, to which no point says anything: z = 1 where the 2 % of the greatest values
 * begin, at most LONE_FARTHEST elsewhere. Also of depths (disparity false), of which the nearest 2 % end at 1.
 * *farthest: the depth at which the farthest 2 % begin. False: no value is known. ST_NOMEM. */
enum status given_check_lone(bool *known, double *farthest, float *values, int width, int height, bool disparity,
                             struct err *err);

#endif
