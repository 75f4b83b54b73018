/* smooth.h - one label per segment: data cost against agreement with the adjacent segments. */
#ifndef REMODEL_SMOOTH_H
#define REMODEL_SMOOTH_H

#include "stages/segment_depth/oversegment.h"

/* Smoothness weight of each border (as in s->borders, the same in both directions): its length in segment widths, times
 * the similarity of the two sides. The caller frees it. NULL: no memory. */
float *smooth_border_weights(const struct segmentation *s, int segment_pixels);

/* Labels that make
 *   sum_i cost[i * labels + label_i] + sum over adjacent i, j of weight_ij min(slope |label_i - label_j|, truncation)
 * small. Deterministic. ST_NOMEM. */
enum status smooth_labels(int *label, const struct segmentation *s, const float *cost, int labels, const float *weights,
                          float slope, float truncation, struct err *err);

#endif
