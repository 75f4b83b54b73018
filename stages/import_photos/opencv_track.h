/* opencv_track.h - how far the picture of a clip has moved since a key frame, by points that OpenCV follows. */
#ifndef REMODEL_OPENCV_TRACK_H
#define REMODEL_OPENCV_TRACK_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

#include "common/base/err.h"

struct track; /* a key frame, its points, and where they were found last */

struct track_motion {
    bool known;      /* enough points were found; else nothing is known */
    double parallax; /* what a turn of the camera or one plane does not explain, as a share of the longer side: the 80th
                        percentile of the points' distances from their places by one homography */
    double overlap;  /* share of the key frame's points that are still in the picture, by that homography */
};

/* Pictures are rows of 0..255. Replaces *t by a track from this key frame. ST_NOMEM, ST_INTERNAL. */
enum status track_begin(struct track **t, const unsigned char *grey, int width, int height, struct err *err);
/* Follows the points to a later frame, which should be asked for in order. */
enum status track_measure(struct track_motion *m, struct track *t, const unsigned char *grey, struct err *err);
void track_release(struct track *t); /* NULL is allowed */

#ifdef __cplusplus
}
#endif

#endif
