/* normal_fit.h - the normal of a pixel, corrected by the depths around it. */
#ifndef REMODEL_NORMAL_FIT_H
#define REMODEL_NORMAL_FIT_H

#include "common/capture/camera_set.h"

/* Corrects `normal` (world, length 1, towards the camera; from the pixel's segments) as far as the depths determine it.
 * inverse_z: w * h, 0 if unknown, known at (x, y). window: half width in px, at least 1. noise: relative standard
 * deviation of the depths; much larger differences belong to another surface. */
struct vec3 normal_fit(struct vec3 normal, const float *inverse_z, const struct view *view, int x, int y, int window,
                       double noise);

#endif
