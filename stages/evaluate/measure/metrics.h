/* metrics.h - similarity of two pictures: PSNR and SSIM. */
#ifndef REMODEL_METRICS_H
#define REMODEL_METRICS_H

#include <stdint.h>

#include "common/base/err.h"

/* Peak signal-to-noise ratio, dB, of 8-bit RGB (w * h * 3), peak 255, over the pixels whose mask is not 0 (mask NULL:
 * all). Capped at 99, so that equal pictures have a finite value. ST_DATA: no pixel; metrics.tsv quotes this error. */
enum status metrics_psnr(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask, double *db,
                         struct err *err);

/* Structural similarity [Wang 2004]: Gaussian window 11 x 11, sigma 1.5, K1 0.01, K2 0.03, L 255; mean over channels
 * and over the windows inside the picture whose centre's mask is not 0. ST_DATA: a picture smaller than 11 x 11, no
 * window. */
enum status metrics_ssim(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask, double *ssim,
                         struct err *err);

/* windows[i] = 1 where all pixels of the SSIM window around pixel i are in the picture and in the mask, else 0. With
 * `windows` as its mask, metrics_ssim() uses no pixel outside `mask`. */
void metrics_ssim_windows(uint8_t *windows, const uint8_t *mask, int width, int height);

#endif
