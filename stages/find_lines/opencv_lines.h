/* opencv_lines.h - straight edges of a picture, by OpenCV's detector of line segments [Grompone 2010]. */
#ifndef REMODEL_OPENCV_LINES_H
#define REMODEL_OPENCV_LINES_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/base/err.h"

struct picture_line {
    double u0, v0, u1, v1; /* ends, px; pixel centres are at +0.5 */
};

/* Finds the edges of an 8-bit grey picture that are at least min_length px long. contrast: limit of local histogram
 * equalization [Zuiderveld 1994], done first; 0: none. *lines is malloc'ed, the caller frees it. The same picture gives
 * the same lines. */
enum status lines_detect(struct picture_line **lines, int *count, const unsigned char *grey, int width, int height,
                         double min_length, double contrast, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
