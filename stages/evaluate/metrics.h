/* metrics.h - how alike two pictures are. */
#ifndef REMODEL_METRICS_H
#define REMODEL_METRICS_H

#include <stdint.h>

#include "common/base/err.h"

/* Peak signal-to-noise ratio in dB over 8-bit RGB (w * h * 3), peak 255, over pixels whose mask is not 0 (mask NULL:
 * all). Equal pictures: +infinity is not printed as a result anywhere, so the value is capped at 99. ST_DATA: no
 * pixel. */
enum status metrics_psnr(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask, double *db,
                         struct err *err);

/* Structural similarity (Wang et al. 2004): Gaussian 11x11, sigma 1.5, K1 0.01, K2 0.03, L 255, mean over channels and
 * over window positions wholly inside the picture (centre pixel's mask not 0). ST_DATA: smaller than 11x11, no
 * pixel. */
enum status metrics_ssim(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask, double *ssim,
                         struct err *err);

/* windows[i] = 1 where all pixels of SSIM's window about pixel i are in the picture and in the mask: with it as the
 * mask, no pixel outside `mask` takes part. */
void metrics_ssim_windows(uint8_t *windows, const uint8_t *mask, int width, int height);

#endif
