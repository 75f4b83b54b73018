/* rng.h - counter-based random numbers (Philox 4x32-10 [Salmon 2011]), keyed by (seed, stage, view, pixel).
 *
 * A number depends on its key and counter alone, not on threads, order or earlier draws. */
#ifndef REMODEL_RNG_H
#define REMODEL_RNG_H

#include <stdint.h>

struct rng {
    uint32_t key[2];
};

struct rng rng_make(uint64_t seed, const char *stage, const char *view);
/* The 128 random bits of a counter. */
void rng_block(const struct rng *rng, uint64_t counter_high, uint64_t counter_low, uint32_t out[4]);
/* The random number `index` of a pixel. */
uint32_t rng_u32(const struct rng *rng, uint64_t pixel, uint64_t index);
double rng_uniform(const struct rng *rng, uint64_t pixel, uint64_t index); /* [0, 1), 53 bits */

#endif
