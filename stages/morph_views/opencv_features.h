/* opencv_features.h - what two pictures have in common: matched features, and the geometry of two cameras that they
 * tell.
 *
 * A thin face of OpenCV: SIFT, mutual best matches that pass the ratio test, USAC with a fixed seed. Pixels: a
 * picture's first pixel has its centre at (0.5, 0.5). */
#ifndef REMODEL_OPENCV_FEATURES_H
#define REMODEL_OPENCV_FEATURES_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

struct feature_match {
    double x1, y1, x2, y2;
    bool inlier; /* of the fundamental matrix */
};

struct two_view {
    struct feature_match *matches; /* owned */
    int count;
    int inliers;           /* of the fundamental matrix; 0: there is none */
    int plane_inliers;     /* matches that one homography explains */
    double fundamental[9]; /* row-major: p2' F p1 = 0 for pixels p = (x, y, 1) */
    double rotation[9];    /* row-major, second from first camera; of cameras with the focal length that was given */
    double translation[3]; /* of length 1; 0 if it cannot be told */
};

/* grey: 8 bits, width * height. focal: of both pictures, px; a guess serves, for it decides only what is near and what
 * far. tolerance: px from the epipolar line. Too few matches are no error: inliers is 0. Same bytes in, same bits
 * out. */
enum status two_view_find(struct two_view *out, const unsigned char *first, const unsigned char *second, int width,
                          int height, double focal, double tolerance, struct err *err);
void two_view_release(struct two_view *v);

#endif
