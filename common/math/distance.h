/* distance.h - exact Euclidean distance transform, in linear time. */
#ifndef REMODEL_DISTANCE_H
#define REMODEL_DISTANCE_H

#include <stdint.h>

#include "common/base/err.h"

/* Sets squared[y * width + x] to the squared distance in px, between pixel centres, from each pixel to the nearest one
 * with inside 0; INFINITY if there is none. */
enum status distance_squared(float *squared, const uint8_t *inside, int width, int height, struct err *err);

#endif
