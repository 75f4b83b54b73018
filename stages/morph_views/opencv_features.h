/* opencv_features.h - matched features of two pictures, and the two-view geometry estimated from them.
 *
 * SIFT features (common/capture/opencv_sift.h), mutual matches (mutual_matches.h), and OpenCV's USAC with a fixed seed.
 * The centre of the first pixel is at (0.5, 0.5). */
#ifndef REMODEL_OPENCV_FEATURES_H
#define REMODEL_OPENCV_FEATURES_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

struct feature_match {
    double x1, y1, x2, y2;
    bool inlier; /* to the fundamental matrix */
};

struct two_view {
    struct feature_match *matches; /* owned */
    int count;
    int inliers;           /* to the fundamental matrix; 0: not found */
    int plane_inliers;     /* inliers to the best homography */
    double fundamental[9]; /* row-major: p2' F p1 = 0 for pixels p = (x, y, 1) */
    double rotation[9];    /* row-major, second from first camera, for the given focal length */
    double translation[3]; /* of length 1; 0: not found */
};

/* first, second: grey pictures, 8 bits, width * height. focal: of both pictures, px; may be a guess, because the pose
 * is used only to distinguish near from far. tolerance: max distance of inliers from the epipolar line, px. Too few
 * matches are not an error: inliers is 0. Deterministic. ST_NOMEM; ST_INTERNAL: OpenCV failed. */
enum status features_find(struct two_view *out, const unsigned char *first, const unsigned char *second, int width,
                          int height, double focal, double tolerance, struct err *err);
void features_release(struct two_view *v);

#endif
