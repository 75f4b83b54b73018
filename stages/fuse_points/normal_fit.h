/* normal_fit.h - a normal that follows the depths around a pixel. */
#ifndef REMODEL_NORMAL_FIT_H
#define REMODEL_NORMAL_FIT_H

#include "common/capture/camera_set.h"

/* normal: world, length 1, towards the camera; on entry that of the pixel's segments, which the depths then correct as far as
 * they tell. inverse_z: w * h, 0 unknown, known at (x, y). window: half its width in px, at least 1. noise: of the
 * depths, relative; what differs by much more belongs to another surface. */
struct vec3 normal_fit(struct vec3 normal, const float *inverse_z, const struct view *view, int x, int y, int window,
                       double noise);

#endif
