/* noise_model.h - noise of linear samples: var(v) = photon v + read^2, where v = 1 is white.
 *
 * Quantization to 8 bits adds noise of nearly the same form, since the steps of tone curves grow with the light. Noise
 * given by electrons has it added. */
#ifndef REMODEL_NOISE_MODEL_H
#define REMODEL_NOISE_MODEL_H

#include "common/image/response.h"

struct noise {
    double photon, read2; /* variance of photon noise at white; variance of read noise (read^2) */
    double luminance;     /* variance of the luminance's noise, divided by what independent colours would give */
};

/* electrons: those of a pixel at white; read_noise: standard deviation of the read noise, in electrons. Includes the
 * quantization of a photo of `bits` bits; luminance is 1. */
struct noise noise_given(double electrons, double read_noise, const struct response *r, int bits);
/* Of errors of samples of 8 or 16 bits with the given variance, in steps^2; luminance is 1. */
struct noise noise_of_samples(double variance, const struct response *r, int bits);

#endif
