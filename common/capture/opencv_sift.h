/* opencv_sift.h - SIFT features of a picture, by OpenCV [Lowe 2004]. */
#ifndef REMODEL_OPENCV_SIFT_H
#define REMODEL_OPENCV_SIFT_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/capture/feature_list.h"

struct sift_limits {
    int longest;     /* px: larger pictures are first scaled down to this length of their longer side */
    double contrast; /* minimum difference of a feature from its surroundings; 1: from black to white */
    double edge;     /* maximum ratio of the principal curvatures; features on edges have large ones */
};

/* Finds the features of an 8-bit grey picture, the largest first, because large ones are found again most reliably.
 * Positions are in pixels of the original picture. On failure the list is empty. The same picture gives the same
 * features. */
enum status sift_find(struct feature_list *list, const unsigned char *grey, int width, int height,
                      const struct sift_limits *limits, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
