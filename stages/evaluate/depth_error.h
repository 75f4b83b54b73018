/* depth_error.h - how far depths are from the true ones.
 *
 * z along the camera's axis, 0 unknown; both in units of the truth. Every pixel that has a true depth counts; "visible"
 * figures leave out the occluded ones. A pixel is bad-k if its disparity f B / z is more than k px from f B / z_true, or
 * if it has no depth: a hole is no escape. Quantiles of |z - z_true| / z_true are over the pixels that have a depth. */
#ifndef REMODEL_DEPTH_ERROR_H
#define REMODEL_DEPTH_ERROR_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

/* A histogram of non-negative numbers in bins of 2^-11 of their value, so that memory does not grow with pixels. */
struct quantiles {
    uint64_t *bins; /* owned */
    uint64_t count;
};
enum status quantiles_init(struct quantiles *q, struct err *err);
void quantiles_add(struct quantiles *q, float value);
/* The least value that at least `part` of the numbers do not exceed, to 2^-12 of itself. count > 0. */
double quantiles_get(const struct quantiles *q, double part);
void quantiles_release(struct quantiles *q);

struct depth_tally {                             /* over all pixels with a true depth, or over the visible ones */
    uint64_t pixels, known, bad1, bad2, within2; /* within2: known, and off by at most 2 % */
    struct quantiles errors;
};
struct depth_errors {
    struct depth_tally all, visible;
};

enum status depth_errors_init(struct depth_errors *e, struct err *err);
/* occluded: not 0 where no other view sees the pixel's point (NULL: nowhere). focal_baseline: f B, px times units. */
void depth_errors_add(struct depth_errors *e, const float *z, const float *truth, const uint8_t *occluded, size_t count,
                      double focal_baseline);
void depth_errors_merge(struct depth_errors *to, const struct depth_errors *from);
void depth_errors_release(struct depth_errors *e);

#endif
