/* layers.h - the two colour layers of a view, from its segments and their planes. */
#ifndef REMODEL_LAYERS_H
#define REMODEL_LAYERS_H

#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "stages/segment_depth/plane_match.h"

/* Fills the layers of `out`, which has the view's size and its segments, from the photo (linear RGBA), and counts the
 * segments' pixels. label: w * h, the segment of each pixel, -1 where the view has none. step: one pixel of the widest
 * baseline in 1/z; depths that differ by more than two steps are a depth edge. matte: whether pixels at depth edges are
 * split into two colours; else all are opaque. ST_NOMEM. */
enum status layers_make(struct layered_depth *out, const int *label, const struct plane *planes,
                        const struct image *linear_rgba, double step, bool matte, struct err *err);

#endif
