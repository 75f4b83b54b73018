/* depth_error.h - errors of depths.
 *
 * Depths are z along the camera's axis in the unit of the truth, 0 unknown. Every pixel with a true depth counts; the
 * "visible" numbers leave out occluded pixels. A pixel is bad-k if its disparity f B / z differs by more than k px from
 * f B / z_true, or if it has no depth. Quantiles of |z - z_true| / z_true are over the pixels with a depth. */
#ifndef REMODEL_DEPTH_ERROR_H
#define REMODEL_DEPTH_ERROR_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/layers/depth_sigma.h"

/* A histogram of non-negative numbers with bins of 2^-11 of the value: memory does not grow with the pixels. */
struct quantiles {
    uint64_t *bins; /* owned */
    uint64_t count;
};
enum status quantiles_init(struct quantiles *q, struct err *err);
void quantiles_add(struct quantiles *q, float value);
/* The minimum value that at least `share` of the numbers do not exceed, to 2^-12 of itself. count > 0. */
double quantiles_get(const struct quantiles *q, double share);
void quantiles_release(struct quantiles *q);

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

/* How often the stated uncertainty of depth covers its error, over the pixels of a class with both depths. The error is
 * that of the inverse depth, abs(1/z - 1/z_true) z / sigma, in stated standard deviations. */
struct sigma_tally {
    uint64_t within[3]; /* pixels with an error of at most 1, 2, 3 */
    struct quantiles errors;
};
struct sigma_errors {
    struct sigma_tally classes[DEPTH_CLASSES];
};
enum status sigma_errors_init(struct sigma_errors *e, struct err *err);
/* sigma: as depth_sigma() of each pixel's segment; classes: enum depth_class. */
void sigma_errors_add(struct sigma_errors *e, const float *z, const float *truth, const float *sigma,
                      const uint8_t *classes, size_t count);
void sigma_errors_release(struct sigma_errors *e);
/* Adds `from` to `to`. */
void sigma_tally_merge(struct sigma_tally *to, const struct sigma_tally *from);

#endif
