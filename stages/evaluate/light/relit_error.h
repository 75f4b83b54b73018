/* relit_error.h - errors of pictures under the light that an edit makes. */
#ifndef REMODEL_RELIT_ERROR_H
#define REMODEL_RELIT_ERROR_H

#include "stages/evaluate/measure/radiance_error.h"

#define RELIT_CHANGE 0.05 /* a smaller change of light is none */

/* Sets mask[i] to 0 where either of two pictures of light (R G B, before and after) is black, or their luminances
 * differ by at most RELIT_CHANGE of that before. */
void relit_changes_keep(uint8_t *mask, const float *before, const float *after, size_t count);

/* Squared errors of pictures clipped at white and encoded as sRGB. */
struct encoded_error {
    double square;
    uint64_t samples;
};

/* clip of p: white. */
void relit_encoded_error_add(struct encoded_error *e, const struct radiance_pixels *p);
/* At most 100 dB. False: no sample. */
bool relit_encoded_error_psnr(const struct encoded_error *e, double *psnr);

/* Multiplies what a picture (R G B) shows in the old light by the true change of light, after / before by channel; a
 * channel whose light is 0 before takes the quotient of luminances. Only pixels whose mask is not 0. */
void relit_change_apply(float *picture, const float *before, const float *after, const uint8_t *mask, size_t count);

/* Adds |q - q_true| / q_true of the pixels whose mask is not 0: q = Y(quotient x before) / Y(before) for a quotient of
 * each channel, q_true = Y(after) / Y(before); before and after are true irradiance, R G B. */
void relit_quotient_errors_add(struct quantiles *errors, const float *quotient, const float *before, const float *after,
                               const uint8_t *mask, size_t count);

#endif
