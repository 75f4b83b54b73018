/* encode.h - frames to a film with ffmpeg; reproducible with the same version of ffmpeg. */
#ifndef REMODEL_ENCODE_VIDEO_ENCODE_H
#define REMODEL_ENCODE_VIDEO_ENCODE_H

#include "common/base/param.h"
#include "common/capture/camera_path.h"
#include "common/film/film_signal.h"
#include "stages/encode_video/eyes_picture.h"

#define ENCODE_PARAMS(X)                                                                                      \
    X(crf, int, 18, 0, 51, "", "constant rate factor: 0 lossless, 18 visually almost lossless, 51 worst")     \
    X(preset, choice, "medium", 0, 0, "ultrafast|superfast|veryfast|faster|fast|medium|slow|slower|veryslow", \
      "preset of the encoder: slower ones give smaller files")                                                \
    X(peak, double, 1000, 203, 10000, "cd/m2", "brightest light of a film in PQ; what is brighter is clipped")

struct encode_params {
    ENCODE_PARAMS(PARAM_FIELD)
};
#define ENCODE_PARAMS_DEFAULT        \
    {                                \
        ENCODE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param encode_param_table[];

struct encode_source {  /* what is encoded, as what */
    const char *frames; /* folder; of the left eye */
    const char *right;  /* of the right eye; NULL: one eye */
    enum film_eyes eyes;
    const struct film_format *format; /* NULL: H.264 */
};

/* Encodes NNNN.exr of all frames of the path, in its order and at its rate, as the file `out`. Unfilled pixels are
 * black. ST_DATA: a frame is missing or differs from the path in size, or the size is odd; ST_IO: ffmpeg fails. */
enum status encode_frames(const struct camera_path *path, const struct encode_source *source, const char *out,
                          const struct encode_params *params, struct err *err);

#endif
