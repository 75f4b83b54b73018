/* encode.h - frames to H.264 with ffmpeg: yuv420p, BT.709, faststart; reproducible with the same version of ffmpeg. */
#ifndef REMODEL_ENCODE_VIDEO_ENCODE_H
#define REMODEL_ENCODE_VIDEO_ENCODE_H

#include "common/base/param.h"
#include "common/capture/camera_path.h"

#define ENCODE_PARAMS(X)                                                                                      \
    X(crf, int, 18, 0, 51, "", "constant rate factor: 0 lossless, 18 visually almost lossless, 51 worst")     \
    X(preset, choice, "medium", 0, 0, "ultrafast|superfast|veryfast|faster|fast|medium|slow|slower|veryslow", \
      "x264 preset: slower ones give smaller files")

struct encode_params {
    ENCODE_PARAMS(PARAM_FIELD)
};
#define ENCODE_PARAMS_DEFAULT        \
    {                                \
        ENCODE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param encode_param_table[];

/* Encodes folder/NNNN.exr of all frames of the path, in its order and at its rate, as the MP4 file `out`. Linear colour
 * becomes 8-bit sRGB; unfilled pixels are black. ST_DATA: a frame is missing or differs from the path in size, or the
 * size is odd; ST_IO: ffmpeg fails. */
enum status encode_frames(const struct camera_path *path, const char *folder, const char *out,
                          const struct encode_params *params, struct err *err);

#endif
