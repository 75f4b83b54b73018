/* opencv_faces.h - OpenCV's face cascades: frontal faces, and profiles to both sides. */
#ifndef REMODEL_OPENCV_FACES_H
#define REMODEL_OPENCV_FACES_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/base/err.h"

struct face {
    double x0, y0, x1, y1; /* px */
    double score;          /* how much speaks for it: overlapping windows that a cascade takes for it */
};

struct face_detector;

/* The cascades' files, NULL after the last. */
extern const char *const face_cascades[];

/* folder: of the cascades. ST_IO: one is not there, or OpenCV cannot use it. *detector is NULL on failure. */
enum status face_detector_open(struct face_detector **detector, const char *folder, struct err *err);
void face_detector_release(struct face_detector *detector); /* NULL is fine */

/* Faces in an upright 8-bit grey picture whose width lies between least and most, px; *faces is malloc'ed, the caller
 * frees it. What several cascades find at one place stands there several times. The same picture gives the same
 * faces. */
enum status face_detect(struct face_detector *detector, const unsigned char *grey, int width, int height, double least,
                        double most, struct face **faces, int *count, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
