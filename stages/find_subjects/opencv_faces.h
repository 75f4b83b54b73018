/* opencv_faces.h - OpenCV's face cascades: frontal faces, and profiles to both sides. */
#ifndef REMODEL_OPENCV_FACES_H
#define REMODEL_OPENCV_FACES_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/base/err.h"

struct face_box {
    double x0, y0, x1, y1; /* px */
    double score;          /* number of a cascade's overlapping detection windows */
};

struct face_detector;

/* File names of the cascades, terminated by NULL. */
extern const char *const face_cascades[];

/* folder: of the cascades. ST_IO: a cascade is missing, or OpenCV cannot read it. *detector is NULL on failure. */
enum status face_detector_open(struct face_detector **detector, const char *folder, struct err *err);
void face_detector_release(struct face_detector *detector); /* NULL is fine */

/* Detects the faces in an upright 8-bit grey picture whose width is from min_width to max_width, in px; *faces is
 * malloc'ed, the caller frees it. A face found by several cascades is listed several times. The same picture gives the
 * same faces. */
enum status face_detect(struct face_detector *detector, const unsigned char *grey, int width, int height,
                        double min_width, double max_width, struct face_box **faces, int *count, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
