/* sobol.h - low-discrepancy random numbers for the samples of a pixel.
 *
 * Sobol' points in groups of four dimensions, shuffled and Owen-scrambled by hashing [Burley 2020]. Each number
 * alone is uniform in [0, 1), so that estimates are unbiased for any number of samples; over the samples of a pixel
 * the numbers are stratified, which gives less noise than independent ones. All seeds come from the counter-based
 * generator of common/base/rng.h, keyed by (seed, stage, view, pixel): the numbers do not depend on threads or
 * order. */
#ifndef REMODEL_SOBOL_H
#define REMODEL_SOBOL_H

#include "common/base/rng.h"

struct sobol {
    uint32_t key;    /* of the pixel */
    uint32_t mask;   /* number of samples, rounded up to a power of two (at most 2^16), minus 1 */
    uint32_t sample; /* index of the current sample */
};

/* For `samples` samples of a pixel; the caller sets .sample before each. A sample index beyond `mask` is allowed: it
 * belongs to a further set of points, with seeds of its own. */
struct sobol sobol_make(const struct rng *rng, uint64_t pixel, int samples);

/* The four numbers of a group of dimensions of the current sample. Numbers within a group are stratified together,
 * numbers of different groups only each by itself. */
void sobol_group(const struct sobol *s, uint32_t group, double u[4]);

/* The first two numbers of a group, as sobol_group() gives them, of the samples s->sample, s->sample + 1, ...;
 * s->sample is a multiple of SOBOL_BATCH. */
enum { SOBOL_BATCH = 8 };
void sobol_pairs(const struct sobol *s, uint32_t group, double u[2][SOBOL_BATCH]);

#endif
