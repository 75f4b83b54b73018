/* refine.h - from a label a segment to a plane a segment. */
#ifndef REMODEL_REFINE_H
#define REMODEL_REFINE_H

#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/segment_params.h"

/* Sparse points by segment. */
struct point_lists {
    int *first;               /* count + 1 */
    struct seen_point *points;
};
enum status point_lists_make(struct point_lists *lists, const struct segmentation *s, const struct seen_points *seen,
                             struct err *err);
void point_lists_release(struct point_lists *lists);
/* Mean over the segment's points of min(1, |difference in 1/z| / width), times how much they count (0 without any). */
float point_cost(const struct point_lists *lists, int segment, struct plane plane, double width);

/* Improves plane[] (on entry: constant 1/z) in passes: a segment tries its neighbours' planes, a plane fitted to those that
 * look alike and agree in depth, a constant depth, and small changes, and keeps what has the least energy: matching cost,
 * sparse points, borders that meet, and a price for being slanted. least, most: bounds of 1/z; step: one pixel in 1/z.
 * The same for any number of threads. */
enum status refine_planes(struct plane *plane, const struct matcher *m, const struct point_lists *points,
                          const float *weights, const struct segment_params *params, double least, double most,
                          double step, struct err *err);

#endif
