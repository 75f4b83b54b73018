/* noise.h - noise model of linear samples: var(v) = photon v + read^2, where v = 1 is white.
 *
 * Quantization to 8 bits adds noise of nearly the same form, since the steps of tone curves grow with the light.
 * Measured noise includes it; to given noise it is added. */
#ifndef REMODEL_HDR_NOISE_H
#define REMODEL_HDR_NOISE_H

#include "common/image/response.h"
#include "stages/hdr_merge/merge_params.h"

struct noise {
    double photon, read2; /* variance of photon noise at white; variance of read noise (read^2) */
};

struct brackets;

/* From electrons and read_noise of params, and the quantization of a photo of `bits` bits. */
struct noise noise_given(const struct merge_params *params, const struct response *r, int bits);

/* Measures noise from the differences between neighbouring exposures where both are well exposed. Robust against edges
 * and small shifts. *measured is false if there are too few samples; *noise is then unchanged. Independent of
 * threads. */
enum status noise_measure(struct noise *noise, bool *measured, const struct brackets *b, struct err *err);

#endif
