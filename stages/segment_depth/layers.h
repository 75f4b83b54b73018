/* layers.h - segments with planes become two layers of colour. */
#ifndef REMODEL_LAYERS_H
#define REMODEL_LAYERS_H

#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "stages/segment_depth/plane_match.h"

/* Fills the layers of `out` (sized like the view; its segments are set by the caller but for `pixels`, which is counted
 * here) from the photo (linear R G B A). step: one pixel of the widest baseline in 1/z; depths further than two of them
 * apart are a jump. matte: pixels at jumps are split into two colours; else all are opaque. */
enum status layers_make(struct layered_depth *out, const struct segmentation *s, const struct plane *planes,
                        const struct image *linear_rgba, double step, bool matte, struct err *err);

#endif
