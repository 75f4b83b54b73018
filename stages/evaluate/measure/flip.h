/* flip.h - FLIP, the difference that a person sees when two pictures alternate at one place [Andersson 2020]: 0 none,
 * 1 the largest. */
#ifndef REMODEL_FLIP_H
#define REMODEL_FLIP_H

#include <stdint.h>

#include "common/base/err.h"

#define FLIP_PIXELS_PER_DEGREE 67.02 /* a display of 0.7 m and 3840 px at a distance of 0.7 m, as in the paper */

/* Mean over the pixels of the mask (w * h; NULL: all), of 8-bit sRGB, w * h * 3. What lies outside the mask counts as
 * equal. Same bits for any number of threads. ST_DATA: no pixel; ST_NOMEM. */
enum status flip_mean(const uint8_t *reference, const uint8_t *test, int width, int height, const uint8_t *mask,
                      double *mean, struct err *err);

#endif
