/* radiance_error.h - errors of linear radiance: relative RMS, and relative errors of luminance.
 *
 * The relative RMS is sqrt(sum (found - true)^2 / sum true^2) over pixels and channels. The relative error of a pixel
 * is |Y - Y_true| / Y_true of Rec.709 luminance, over pixels with Y_true > 0. */
#ifndef REMODEL_RADIANCE_ERROR_H
#define REMODEL_RADIANCE_ERROR_H

#include "stages/evaluate/measure/quantiles.h"

struct radiance_error {
    double square, reference; /* sums of (found - true)^2 and true^2 */
    struct quantiles errors;
    uint64_t pixels;
};

struct radiance_pixels { /* two pictures of `count` pixels */
    const float *found;  /* R G B */
    const float *truth;  /* R G B A; a pixel with A 0 is not compared */
    const uint8_t *mask; /* a pixel with 0 is not compared; NULL: all are */
    size_t count;
    double scale; /* of `found`, to the unit of the truth */
    double clip;  /* both are clipped at this radiance; 0: not */
};

enum status radiance_error_init(struct radiance_error *e, struct err *err);
void radiance_error_add(struct radiance_error *e, const struct radiance_pixels *p);
/* Adds the ratios true / found of luminance, where both are above 0, to q; scale and clip are not used. */
void radiance_ratios_add(struct quantiles *q, const struct radiance_pixels *p);
/* False: no pixel was compared, or the truth is black. */
bool radiance_error_rms(const struct radiance_error *e, double *rms);
void radiance_error_release(struct radiance_error *e);

#endif
