/* irradiance_ratio.h - errors of the ratio of irradiance after an edit to that before it.
 *
 * Relighting multiplies the light of a photographed surface by this ratio. Its error is judged by what comes out
 * where everything else is true: with the found ratio q = found after / found before, of each channel,
 *
 *   rms = sqrt(sum (q before - after)^2 / sum after^2)       over pixels and channels, of the true before and after
 *
 * and by |q - q_true| / q_true of luminance at each pixel. `change` is the rms of q = 1: of an edit that changes no
 * light. A channel without found light before takes the ratio of luminance. No scale is needed: it cancels. */
#ifndef REMODEL_IRRADIANCE_RATIO_H
#define REMODEL_IRRADIANCE_RATIO_H

#include "stages/evaluate/measure/quantiles.h"

struct ratio_error {
    double square, change, reference; /* sums of (q before - after)^2, (before - after)^2, after^2 */
    struct quantiles errors;          /* of luminance */
    uint64_t pixels, missing;         /* missing: of pixels with a true ratio, those without a found one */
};

struct ratio_pixels {                      /* pictures of `count` pixels from one camera */
    const float *before, *after;           /* found, R G B */
    const uint8_t *known;                  /* 0: nothing was found at the pixel */
    const float *true_before, *true_after; /* R G B; a pixel that is black in either has no true ratio */
    const uint8_t *mask;                   /* a pixel with 0 is not compared; NULL: all are */
    size_t count;
};

enum status ratio_error_init(struct ratio_error *e, struct err *err);
void ratio_error_add(struct ratio_error *e, const struct ratio_pixels *p);
void ratio_error_release(struct ratio_error *e);

#endif
