/* smooth.h - one label a segment: its own cost against agreement with the segments that it touches. */
#ifndef REMODEL_SMOOTH_H
#define REMODEL_SMOOTH_H

#include "stages/segment_depth/oversegment.h"

/* Weight of each touch (as in s->touches, the same in both directions): length of the border in segment widths, times
 * how alike the two sides are. Allocated. NULL: no memory. */
float *touch_weights(const struct segmentation *s, int segment_pixels);

/* Labels that make
 *   sum_i cost[i * labels + label_i] + sum_touching weight_ij min(slope |label_i - label_j|, most)
 * small: sequential tree-reweighted message passing (Kolmogorov 2006). Deterministic. */
enum status smooth_labels(int *label, const struct segmentation *s, const float *cost, int labels, const float *weights,
                          float slope, float most, struct err *err);

#endif
