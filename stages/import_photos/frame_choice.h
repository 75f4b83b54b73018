/* frame_choice.h - which frames of a clip become photos: sharp ones with parallax between them.
 *
 * Progress since the last chosen frame is 1 when parallax is FRAME_PARALLAX, or when the share FRAME_OVERLAP of the
 * picture is still seen, whichever comes first. The next frame is the sharpest of those with a progress of 0.7 to 1.3;
 * if none of them has 0.7 of the sharpness of the sharpest frame of the last half second, of those up to 2. The first
 * is the sharpest up to a progress of 0.3 from the first frame of the clip, or from the first after a cut. If these are
 * more than [import_photos] frames, evenly spaced ones of them remain.
 *
 * Sharpness is the mean square of the Laplacian of the luma divided by the luma's variance: neighbours in a clip show
 * nearly the same, so that blur decides. */
#ifndef REMODEL_FRAME_CHOICE_H
#define REMODEL_FRAME_CHOICE_H

#include <stdbool.h>

#include "common/base/err.h"

#define FRAME_PARALLAX 0.02 /* of the longer side; opencv_track.h */
#define FRAME_OVERLAP  0.75
enum { FRAME_SIDE = 1280 }; /* px, the longer side of the pictures that are compared */

struct chosen_frame {
    int number;
    double seconds, sharpness;
    double parallax, overlap; /* since the frame chosen before; 0 of the first and after a cut */
};

struct frame_choice; /* its state */

struct chosen_frames {
    struct chosen_frame *frames; /* in order; owned */
    int count;
    double most_parallax; /* since a chosen frame, of any frame of the clip */
};

enum status frame_choice_begin(struct frame_choice **c, int width, int height, struct err *err);
/* Takes the next frame of the clip: rows of 0..255, of the size above. */
enum status frame_choice_add(struct frame_choice *c, const unsigned char *grey, int number, double seconds,
                             struct err *err);
/* What was chosen, at most `most` frames. The caller releases it. */
enum status frame_choice_end(struct chosen_frames *chosen, struct frame_choice *c, int most, struct err *err);
void frame_choice_release(struct frame_choice *c); /* NULL is allowed */
void frame_choice_free(struct chosen_frames *chosen);

double frame_sharpness(const unsigned char *grey, int width, int height);

#endif
