/* match_features.h - the features of a picture that matching compares. */
#ifndef REMODEL_MATCH_FEATURES_H
#define REMODEL_MATCH_FEATURES_H

#include "stages/segment_depth/gamma_image.h"

/* Bytes per pixel: R G B, fine gradient x y, coarse gradient x y (offset 128), validity (255 or 0). */
#define FEATURE_CHANNELS 8
/* Integer weights of bilinear interpolation sum to this: interpolated features are bytes times FEATURE_UNIT. */
#define FEATURE_UNIT 127

/* Standard deviation of the picture's noise, in grey levels. */
float match_image_noise(const struct gamma_image *g);

/* The features of a picture, w * h * FEATURE_CHANNELS bytes; the caller frees them. NULL: no memory. gain: of each
 * colour. jacobian: a gradient in the reference's axes is jacobian (gx, gy). noise: of the reference, grey levels. */
uint8_t *match_features(const struct gamma_image *g, const double gain[3], double jacobian[2][2], float noise);

#endif
