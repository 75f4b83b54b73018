/* sigma_error.h - how well the stated uncertainty of depths covers their errors. */
#ifndef REMODEL_SIGMA_ERROR_H
#define REMODEL_SIGMA_ERROR_H

#include "common/layers/depth_sigma.h"
#include "stages/evaluate/measure/quantiles.h"

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
