/* radiance_error.h - relative errors of light: irradiance at points, radiance of textures. Scene-linear, 3 channels.
 *
 * The relative RMS is sqrt(sum (found - true)^2 / sum true^2), over points and channels together: dark points, whose
 * own ratio would explode, count by what they are worth. */
#ifndef REMODEL_RADIANCE_ERROR_H
#define REMODEL_RADIANCE_ERROR_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"

/* Over i with mask[i] == which (mask NULL: all). ST_DATA: no such point, or all of the truth is black. */
enum status relative_rms(double *rms, const float *found, const float *truth, size_t count, const uint8_t *mask,
                         uint8_t which, struct err *err);

enum texel_kind { TEXEL_OUTSIDE, TEXEL_SEEN, TEXEL_HIDDEN }; /* hidden: no photograph shows it */

/* Relative RMS of a face's texels, apart for those that some photograph shows and those that none does; a kind that
 * has no texel (or a black truth) gets -1. */
enum status texture_errors(double *seen, double *hidden, const float *found, const float *truth, const uint8_t *kinds,
                           size_t count, struct err *err);

#endif
