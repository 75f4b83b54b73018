/* picture_error.h - a rendered picture against the photograph that was held out.
 *
 * Both are 8-bit sRGB of the view's own size. Pixels that the photograph does not reach are never compared:
 * SSIM is over windows of which every pixel is compared. */
#ifndef REMODEL_PICTURE_ERROR_H
#define REMODEL_PICTURE_ERROR_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

struct picture_errors {
    double psnr, ssim;                 /* dB, 1: over all pixels that the photograph has */
    double psnr_covered, ssim_covered; /* over those of them that are no hole */
    double holes;                      /* part of the photograph's pixels that no view covered, before filling */
    bool has_ssim, has_covered, has_ssim_covered; /* false: no window of 11x11 pixels, no covered pixel */
};

/* photo, frame: RGB, w * h * 3; inside, hole: w * h. ST_DATA: the photograph has no pixel. */
enum status picture_errors(struct picture_errors *e, const uint8_t *photo, const uint8_t *frame, const uint8_t *inside,
                           const uint8_t *hole, int width, int height, struct err *err);

#endif
