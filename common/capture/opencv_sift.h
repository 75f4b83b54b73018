/* opencv_sift.h - SIFT features of a picture, by OpenCV [Lowe 2004]. */
#ifndef REMODEL_OPENCV_SIFT_H
#define REMODEL_OPENCV_SIFT_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/capture/feature_list.h"

/* Finds the features of an 8-bit grey picture, the largest first, because large ones are found again most reliably.
 * longest: larger pictures are first scaled down to this length of their longer side; positions are in pixels of the
 * original picture. contrast: minimum difference of a feature from its surroundings; 1: from black to white. On failure
 * the list is empty. The same picture gives the same features. */
enum status sift_find(struct feature_list *list, const unsigned char *grey, int width, int height, int longest,
                      double contrast, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
