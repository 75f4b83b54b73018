/* sampler.h - evenly spread random numbers for the samples of a pixel.
 *
 * Sobol' points in groups of four dimensions, shuffled and Owen-scrambled by hashing (B. Burley, "Practical Hash-based
 * Owen Scrambling", JCGT 2020). Every number is by itself uniform in [0, 1), so estimates are unbiased for any number of
 * samples; over the samples of a pixel they are spread more evenly than independent ones. All seeds come from the
 * counter-based generator of common/base/rng.h, keyed by (seed, stage, view, pixel). */
#ifndef REMODEL_SIMULATE_SAMPLER_H
#define REMODEL_SIMULATE_SAMPLER_H

#include "common/base/rng.h"

struct sampler {
    uint32_t key;    /* of the pixel */
    uint32_t mask;   /* as many samples as these bits can count */
    uint32_t sample; /* which one this is */
};

/* For `samples` samples of a pixel; set .sample before each. */
struct sampler sampler_make(const struct rng *rng, uint64_t pixel, int samples);

/* The four numbers of a group of dimensions. */
void sampler_group(const struct sampler *s, uint32_t group, double u[4]);

#endif
