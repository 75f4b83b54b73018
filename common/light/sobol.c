/* sobol.c - hash-based Owen-scrambled Sobol' points [Burley 2020].
 *
 * A group is one set of four-dimensional Sobol' points, at most 2^16 of them. The order of the points is an
 * Owen-scrambled permutation of the sample index; each dimension is then Owen-scrambled with a seed of its own. Owen
 * scrambling of a number is a hash in which each bit depends on higher bits only; the code keeps the points with their
 * bits reversed, where "higher" becomes "lower" and the hash is built of multiplications and additions [Laine 2011].
 * The result is reversed at the end. Differs from the source: the four dimensions of a sample, or eight samples, are
 * scrambled at once in a vector register. */
#include "common/light/sobol.h"

#include "common/light/value_noise.h"
#include "common/math/lanes.h"

/* Direction numbers of [Joe 2008], dimensions 1 to 4, first 16 bits, bits reversed. */
#define BITS 16
static const noise_u32x4 directions[BITS] = {
    {0x1, 0x1, 0x1, 0x1},
    {0x2, 0x3, 0x3, 0x3},
    {0x4, 0x5, 0x6, 0x4},
    {0x8, 0xf, 0x9, 0xa},
    {0x10, 0x11, 0x17, 0x1f},
    {0x20, 0x33, 0x3a, 0x2e},
    {0x40, 0x55, 0x71, 0x45},
    {0x80, 0xff, 0xa3, 0xc9},
    {0x100, 0x101, 0x116, 0x11b},
    {0x200, 0x303, 0x339, 0x2a4},
    {0x400, 0x505, 0x677, 0x79a},
    {0x800, 0xf0f, 0x9aa, 0xb67},
    {0x1000, 0x1111, 0x1601, 0x101e},
    {0x2000, 0x3333, 0x3903, 0x302d},
    {0x4000, 0x5555, 0x7706, 0x4041},
    {0x8000, 0xffff, 0xaa09, 0xa0c3},
};

/* The permutation of [Laine 2011], with constants by N. Vegdahl that scramble better; of a number or lanes. */
#define SCRAMBLE(x, seed)        \
    do {                         \
        (x) ^= (x)*0x3d20adeau;  \
        (x) += (seed);           \
        (x) *= (seed) >> 16 | 1; \
        (x) ^= (x)*0x05526c56u;  \
        (x) ^= (x)*0x53a22864u;  \
    } while (0)
#define REVERSE_BITS(x)                                          \
    do {                                                         \
        (x) = ((x) >> 1 & 0x55555555u) | ((x)&0x55555555u) << 1; \
        (x) = ((x) >> 2 & 0x33333333u) | ((x)&0x33333333u) << 2; \
        (x) = ((x) >> 4 & 0x0f0f0f0fu) | ((x)&0x0f0f0f0fu) << 4; \
        (x) = ((x) >> 8 & 0x00ff00ffu) | ((x)&0x00ff00ffu) << 8; \
        (x) = (x) >> 16 | (x) << 16;                             \
    } while (0)

struct sobol sobol_make(const struct rng *rng, uint64_t pixel, int samples)
{
    uint32_t mask = 1;
    while (mask < (uint32_t)samples && mask < 1u << BITS) mask *= 2;
    return (struct sobol){rng_u32(rng, pixel, 0), mask - 1, 0};
}

static const noise_u32x4 dimensions = {0x51633e2du, 0xa2c67c5au, 0xf429ba87u, 0x458cf8b4u};

/* Sample indices beyond the mask belong to further sets, with other seeds. */
static uint32_t seed_of(const struct sobol *s, uint32_t group)
{
    const uint32_t set = s->sample & ~s->mask;
    return noise_mix(s->key ^ noise_mix(group + 0x68bc21ebu * (set + 1)));
}

void sobol_group(const struct sobol *s, uint32_t group, double u[4])
{
    const uint32_t seed = seed_of(s, group), order = noise_mix(seed + 0x9e3779b9u);
    const noise_u32x4 seeds = noise_mix4(seed + dimensions);
    uint32_t index = s->sample & s->mask;
    SCRAMBLE(index, order);
    noise_u32x4 x = {0, 0, 0, 0};
    for (uint32_t left = index & s->mask; left; left &= left - 1) x ^= directions[__builtin_ctz(left)];
    SCRAMBLE(x, seeds);
    REVERSE_BITS(x);
    for (int d = 0; d < 4; d++) u[d] = x[d] * 0x1p-32;
}

void sobol_pairs(const struct sobol *s, uint32_t group, double u[2][SOBOL_BATCH])
{
    const uint32_t seed = seed_of(s, group), order = noise_mix(seed + 0x9e3779b9u);
    const u32x8 steps = {0, 1, 2, 3, 4, 5, 6, 7};
    u32x8 index = (s->sample + steps) & s->mask, x[2] = {{0}};
    SCRAMBLE(index, order);
    for (int bit = 0; s->mask >> bit & 1; bit++) {
        const u32x8 has = -(index >> bit & 1);
        for (int d = 0; d < 2; d++) x[d] ^= has & directions[bit][d];
    }
    for (int d = 0; d < 2; d++) {
        const uint32_t own = noise_mix(seed + dimensions[d]);
        SCRAMBLE(x[d], own);
        REVERSE_BITS(x[d]);
        for (int k = 0; k < SOBOL_BATCH; k++) u[d][k] = x[d][k] * 0x1p-32;
    }
}
