/* rng.c - Philox 4x32-10 [Salmon 2011].
 *
 * Ten rounds of a bijection of the 128-bit counter. Between rounds the key advances by a Weyl sequence. */
#include "common/base/rng.h"

#include <string.h>
#include <xxhash.h>

struct rng rng_make(uint64_t seed, const char *stage, const char *view)
{
    /* the hash of the stage seeds that of the view, so that ("ab", "c") and ("a", "bc") differ */
    uint64_t key = XXH3_64bits_withSeed(stage, strlen(stage), seed);
    key = XXH3_64bits_withSeed(view, strlen(view), key);
    return (struct rng){{(uint32_t)key, (uint32_t)(key >> 32)}};
}

void rng_block(const struct rng *rng, uint64_t counter_high, uint64_t counter_low, uint32_t out[4])
{
    uint32_t c[4] = {(uint32_t)counter_low, (uint32_t)(counter_low >> 32), (uint32_t)counter_high,
                     (uint32_t)(counter_high >> 32)};
    uint32_t k0 = rng->key[0], k1 = rng->key[1];

    for (int round = 0; round < 10; round++) {
        const uint64_t a = (uint64_t)0xD2511F53u * c[0], b = (uint64_t)0xCD9E8D57u * c[2];
        c[0] = (uint32_t)(b >> 32) ^ c[1] ^ k0;
        c[1] = (uint32_t)b;
        c[2] = (uint32_t)(a >> 32) ^ c[3] ^ k1;
        c[3] = (uint32_t)a;
        k0 += 0x9E3779B9u; /* golden ratio */
        k1 += 0xBB67AE85u; /* sqrt(3) - 1 */
    }
    memcpy(out, c, sizeof c);
}

uint32_t rng_u32(const struct rng *rng, uint64_t pixel, uint64_t index)
{
    uint32_t block[4];

    rng_block(rng, pixel, index / 4, block);
    return block[index % 4];
}

double rng_uniform(const struct rng *rng, uint64_t pixel, uint64_t index)
{
    uint32_t block[4];

    rng_block(rng, pixel, index / 2, block);
    const uint64_t bits = (uint64_t)block[index % 2 * 2 + 1] << 32 | block[index % 2 * 2];
    return (double)(bits >> 11) * 0x1p-53;
}
