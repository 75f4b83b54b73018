/* crop_picture.h - a crop of a picture, resampled to a frame's size. */
#ifndef REMODEL_CROP_PICTURE_H
#define REMODEL_CROP_PICTURE_H

#include "common/image/image.h"
#include "stages/pan_scan/crop_fit.h"

/* out: initialised, of the frame's size and the picture's number of channels, all of which are filtered alike:
 * scene-linear, premultiplied. The kernel is cubic (Catmull-Rom), along either axis as wide as a reduction asks for;
 * results stay within the range of the samples next to the pixel, so that there are no halos and nothing is negative.
 * Beyond the picture its last sample goes on. ST_NOMEM. The same bits for any number of threads. */
enum status crop_picture(struct image *out, const struct image *picture, const struct crop *crop, struct err *err);

#endif
