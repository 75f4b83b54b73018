/* picture_error.h - errors of a picture that was rendered in place of a held-out photograph.
 *
 * Both are 8-bit sRGB of the view's own size. Pixels outside the photograph are never compared: SSIM is over windows
 * without them. */
#ifndef REMODEL_PICTURE_ERROR_H
#define REMODEL_PICTURE_ERROR_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

struct picture_errors {
    double psnr, ssim;                 /* over all pixels of the photograph; psnr: dB */
    double psnr_covered, ssim_covered; /* without holes */
    double flip;                       /* over all pixels of the photograph */
    double holes;                      /* share of the photograph's pixels that no view covers, before filling */
    bool has_ssim, has_covered, has_ssim_covered; /* false: no window of 11 x 11 pixels; no covered pixel */
};

/* photo, frame: RGB, w * h * 3; inside (the photograph), hole: w * h. ST_DATA: no pixel is inside. */
enum status picture_errors(struct picture_errors *e, const uint8_t *photo, const uint8_t *frame, const uint8_t *inside,
                           const uint8_t *hole, int width, int height, struct err *err);

#endif
