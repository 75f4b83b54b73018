/* depth_error.h - errors of depths.
 *
 * Depths are z along the camera's axis in the unit of the truth, 0 unknown. Every pixel with a true depth counts; the
 * "visible" numbers leave out occluded pixels. A pixel is bad-k if its disparity f B / z differs by more than k px from
 * f B / z_true, or if it has no depth. Quantiles of |z - z_true| / z_true are over the pixels with a depth. */
#ifndef REMODEL_DEPTH_ERROR_H
#define REMODEL_DEPTH_ERROR_H

#include <stdbool.h>

#include "stages/evaluate/measure/quantiles.h"

struct depth_tally {                             /* over all pixels with a true depth, or over the visible ones */
    uint64_t pixels, known, bad1, bad2, within2; /* within2: relative error of at most 2 % */
    struct quantiles errors;
};
struct depth_errors {
    struct depth_tally all, visible;
};

enum status depth_errors_init(struct depth_errors *e, struct err *err);
/* occluded: not 0 where no other photo sees the point of the pixel; NULL: nowhere. focal_baseline: f B, px x the
 * unit of the truth. */
void depth_errors_add(struct depth_errors *e, const float *z, const float *truth, const uint8_t *occluded, size_t count,
                      double focal_baseline);
void depth_errors_merge(struct depth_errors *to, const struct depth_errors *from);
void depth_errors_release(struct depth_errors *e);

#endif
