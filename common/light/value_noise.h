/* value_noise.h - integer hashes, and repeatable value noise over the plane. Everything is a pure function of its
 * arguments. */
#ifndef REMODEL_VALUE_NOISE_H
#define REMODEL_VALUE_NOISE_H

#include <math.h>
#include <stdint.h>

/* A bijection on 32 bits in which every input bit changes about half of the output bits: the finaliser of
 * MurmurHash3. */
static inline uint32_t noise_mix(uint32_t h)
{
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

static inline uint32_t noise_hash(uint32_t seed, int x, int y)
{
    return noise_mix(noise_mix(seed + 0x9e3779b9u * (uint32_t)x) + 0x7f4a7c15u * (uint32_t)y);
}

/* The k-th uniform number in [0, 1) derived from a hash. */
static inline double noise_unit(uint32_t hash, int k)
{
    return noise_mix(hash + 0x632be5abu * (uint32_t)(k + 1)) * 0x1p-32;
}

/* floor(x) as an int; wraps around outside the range of int. */
static inline int noise_floor(double x) { return (int)(uint32_t)(int64_t)floor(x); }

/* 0 below `from`, 1 above `to`, a cubic with zero end slopes between them; from < to. */
static inline double smooth_step(double from, double to, double x)
{
    double t = (x - from) / (to - from);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

typedef uint32_t noise_u32x4 __attribute__((vector_size(16)));
typedef int32_t noise_i32x4 __attribute__((vector_size(16)));
typedef float noise_f32x4 __attribute__((vector_size(16)));

static inline noise_u32x4 noise_mix4(noise_u32x4 h)
{
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

/* Value noise in [-1, 1] with features about 1 wide: noise_hash() of the four corners of the cell of the integer grid,
 * interpolated by smooth_step(). */
static inline double noise_value(uint32_t seed, double x, double y)
{
    const double fx = floor(x), fy = floor(y);
    const float tx = (float)(x - fx), ty = (float)(y - fy);
    const float wx = tx * tx * (3 - 2 * tx), wy = ty * ty * (3 - 2 * ty);
    const uint32_t ix = (uint32_t)noise_floor(x), iy = (uint32_t)noise_floor(y);
    const noise_u32x4 xs = {ix, ix + 1, ix, ix + 1}, ys = {iy, iy, iy + 1, iy + 1};
    const noise_u32x4 h = noise_mix4(noise_mix4(seed + 0x9e3779b9u * xs) + 0x7f4a7c15u * ys);
    const noise_f32x4 v = __builtin_convertvector((noise_i32x4)(h >> 8), noise_f32x4);
    const float top = v[0] + (v[1] - v[0]) * wx, bottom = v[2] + (v[3] - v[2]) * wx;
    return (double)((top + (bottom - top) * wy) * 0x1p-23f - 1);
}

/* A sum of `octaves` layers of value noise, each with half the feature size and 0.6 of the amplitude of the one before,
 * normalised to [-1, 1]. */
static inline double noise_octaves(uint32_t seed, double x, double y, int octaves)
{
    double sum = 0, weight = 1, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += weight * noise_value(seed + (uint32_t)i * 77u, x, y);
        total += weight;
        weight *= 0.6;
        x = 2 * x + 17.3;
        y = 2 * y - 9.7;
    }
    return sum / total;
}

#endif
