/* frame_encoder.h - frames to a film with ffmpeg, reproducible with the same version of ffmpeg.
 *
 *   struct frame_encoder e = {0};
 *   frame_encoder_begin(&e, "film.mp4", 640, 480, 25, &(struct frame_quality){"medium", 18}, err);
 *   frame_encoder_put(&e, rgb);                 for each frame
 *   frame_encoder_end(&e, frames, err);         the film is there, whole
 *   frame_encoder_release(&e);                  after a failure: nothing is left */
#ifndef REMODEL_FRAME_ENCODER_H
#define REMODEL_FRAME_ENCODER_H

#include "common/base/outfile.h"
#include "common/base/process.h"
#include "common/film/film_signal.h"
#include "common/film/stereo_boxes.h"

struct frame_quality {
    const char *preset;               /* of x264 and x265; that of AV1 follows it */
    int crf;                          /* 0 lossless .. 51 */
    const struct film_format *format; /* NULL: H.264 */
    struct film_light light;          /* of a film in PQ; 0: unknown */
    double peak;                      /* cd/m2 of a film in PQ */
    enum stereo_mode stereo;          /* the frames hold two eyes */
    bool half_sphere;                 /* of 180 degrees */
};

/* {0} is the empty state. */
struct frame_encoder {
    struct process ffmpeg;
    struct outfile file;
    struct frame_quality quality;
    size_t bytes; /* of a frame */
    int written;  /* frames */
    bool ended;   /* ffmpeg took no more */
};

/* ST_DATA: a side is odd; ST_IO: ffmpeg cannot be started. */
enum status frame_encoder_begin(struct frame_encoder *e, const char *path, int width, int height, double fps,
                                const struct frame_quality *quality, struct err *err);
/* A frame as film_format_signal() makes it; of H.264: sRGB, interleaved. A frame that ffmpeg does not take is reported
 * by frame_encoder_end(); *ended says so before. */
void frame_encoder_put(struct frame_encoder *e, const void *frame);
/* Waits for ffmpeg and commits the file. ST_IO: it failed, or took fewer frames than `frames`. */
enum status frame_encoder_end(struct frame_encoder *e, int frames, struct err *err);
void frame_encoder_release(struct frame_encoder *e);

#endif
