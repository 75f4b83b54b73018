/* distance.h - exact Euclidean distance transform (Felzenszwalb and Huttenlocher 2012), separable and linear in
 * time. */
#ifndef REMODEL_DISTANCE_H
#define REMODEL_DISTANCE_H

#include <stdint.h>

#include "common/base/err.h"

/* squared[y * width + x]: the square of the distance in px from a pixel of `inside` 1 to the nearest one of 0, centre
 * to centre; 0 where inside is 0; INFINITY if nothing is 0. */
enum status distance_squared(float *squared, const uint8_t *inside, int width, int height, struct err *err);

#endif
