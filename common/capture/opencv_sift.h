/* opencv_sift.h - SIFT features of a picture, by OpenCV [Lowe 2004]. */
#ifndef REMODEL_OPENCV_SIFT_H
#define REMODEL_OPENCV_SIFT_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/capture/feature_list.h"

/* Finds the features of an 8-bit grey picture, the largest first: those of large scale are found again most reliably.
 * contrast: the least difference from their surroundings, 1 being that of black and white. longest: the longer side to
 * which a larger picture is scaled down before; features stay in its own pixels. On failure the list is empty. The same
 * picture gives the same features. */
enum status sift_find(struct feature_list *list, const unsigned char *grey, int width, int height, int longest,
                      double contrast, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
