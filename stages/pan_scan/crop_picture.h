/* crop_picture.h - resampling of a crop to a frame's size. */
#ifndef REMODEL_CROP_PICTURE_H
#define REMODEL_CROP_PICTURE_H

#include "common/image/image.h"
#include "stages/pan_scan/crop_fit.h"

/* out: initialised, of the frame's size and the picture's number of channels. All channels are filtered alike and must
 * be scene-linear and premultiplied. Beyond the picture its border samples are repeated. ST_NOMEM. Same bits for any
 * number of threads. */
enum status crop_picture(struct image *out, const struct image *picture, const struct crop *crop, struct err *err);

#endif
