/* encode.h - frames to H.264 with ffmpeg: yuv420p, BT.709, faststart; the same bytes from run to run with the same
 * ffmpeg. */
#ifndef REMODEL_ENCODE_VIDEO_ENCODE_H
#define REMODEL_ENCODE_VIDEO_ENCODE_H

#include "common/base/param.h"
#include "common/capture/camera_path.h"

#define ENCODE_PARAMS(X)                                                                                      \
    X(crf, int, 18, 0, 51, "", "constant rate factor: 0 lossless, 18 hardly to be told apart, 51 worst")      \
    X(preset, choice, "medium", 0, 0, "ultrafast|superfast|veryfast|faster|fast|medium|slow|slower|veryslow", \
      "speed against size of file")

struct encode_params {
    ENCODE_PARAMS(PARAM_FIELD)
};
#define ENCODE_PARAMS_DEFAULT        \
    {                                \
        ENCODE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param encode_param_table[];

/* folder/NNNN.exr of every frame of the path, in its order and at its rate, to the MP4 file `out`. Colour is linear
 * and becomes 8-bit sRGB; what is not filled is black. ST_DATA: a frame that is missing or of another size than the
 * path's, odd sizes; ST_IO: ffmpeg fails. */
enum status encode_frames(const struct camera_path *path, const char *folder, const char *out,
                          const struct encode_params *params, struct err *err);

#endif
