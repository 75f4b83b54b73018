/* stereo_boxes.h - says in an MP4 or QuickTime file that a picture holds those of two eyes: spherical video, version 2
 * [Google 2017]. ffmpeg 5 cannot write these boxes from raw frames. */
#ifndef REMODEL_STEREO_BOXES_H
#define REMODEL_STEREO_BOXES_H

#include <stdbool.h>

#include "common/base/err.h"

enum stereo_mode { STEREO_NONE = 0, STEREO_TOP_BOTTOM = 1, STEREO_SIDE_BY_SIDE = 2 }; /* as in the box st3d */

/* Adds st3d to the first track of the file, and for a half-sphere sv3d: equirectangular, the middle 180 degrees. The
 * left eye is on the left, or on top. ST_DATA: the file is not an MP4 with its index in one box, or its index is as
 * large as 64 MiB; ST_IO. */
enum status stereo_boxes_add(const char *path, enum stereo_mode mode, bool half_sphere, struct err *err);

#endif
