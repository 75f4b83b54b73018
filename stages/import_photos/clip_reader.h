/* clip_reader.h - the frames of a video, by libavformat and libavcodec.
 *
 * Frames come in the order in which they are shown, numbered from 0. Pictures stand upright: the rotation that the file
 * states is applied. Their pixels are square. Decoders give the same bytes for any number of threads. */
#ifndef REMODEL_CLIP_READER_H
#define REMODEL_CLIP_READER_H

#include <stdbool.h>

#include "common/image/photo.h"

struct clip_reader;

struct clip_frame {
    int number;     /* from 0 */
    double seconds; /* since the clip began */
};

/* ST_IO, ST_DATA with the path: the file cannot be read, is damaged, has no video, or its video is of a kind that
 * cannot be read. The caller closes *clip, also after a failure. */
enum status clip_open(struct clip_reader **clip, const char *path, struct err *err);
/* Decodes the next frame; false at the end. ST_DATA: the file is damaged or cut off. */
bool clip_next(struct clip_reader *clip, struct clip_frame *frame, struct err *err);

/* Whether a frame that was decoded is interlaced: only its even rows are used. */
bool clip_is_interlaced(const struct clip_reader *clip);

/* The size of pictures whose longer side has at most `longest` pixels. */
void clip_size(const struct clip_reader *clip, int longest, int *width, int *height);
/* The present frame as its luma, 0..255, in this size; as stored, not upright. */
enum status clip_grey(struct clip_reader *clip, unsigned char *grey, int width, int height, struct err *err);
/* The present frame as a photo of 8 bits, or of 16 if the clip has more than 8, in the clip's colour space. The caller
 * releases it. */
enum status clip_photo(struct clip_reader *clip, struct photo *photo, struct err *err);

void clip_close(struct clip_reader *clip); /* NULL is allowed */

#endif
