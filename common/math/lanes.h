/* lanes.h - vectors of eight lanes, of four, and of bytes: the same bits on every processor.
 *
 * Plain operators work on whole vectors (GCC's and clang's vector extensions), also between a vector and a scalar. A
 * comparison gives a mask, lanes of 0 and -1, for &, | and ~. What operators cannot say has a name here. AVX2 and F16C
 * do it where there are, loops over lanes where there are not (on any processor with FLAVOR=portable). No other file
 * contains instructions of a processor.
 *
 * The rules that make both agree: min(a, b) is a < b ? a : b, and max(a, b) is a > b ? a : b, so that the second
 * operand wins for NaN and for zeros. Conversions to integers give INT32_MIN for NaN and beyond the range. Half floats
 * round to the nearest, ties to even, also denormal ones, and a NaN becomes quiet. Divisions and roots are exactly
 * rounded; there are no approximations of reciprocals. Bits of a NaN that an operator makes are the processor's own. */
#ifndef REMODEL_LANES_H
#define REMODEL_LANES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#ifdef __SSE2__
#include <immintrin.h>
#endif
#if defined(__AVX2__) && defined(__F16C__)
#define LANES_AVX2
#endif

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "lane 0 is at the lowest address, and so is the low byte");

typedef float f32x4 __attribute__((vector_size(16)));
typedef float f32x8 __attribute__((vector_size(32)));
typedef double f64x4 __attribute__((vector_size(32)));
typedef int32_t i32x4 __attribute__((vector_size(16)));
typedef int32_t i32x8 __attribute__((vector_size(32)));
typedef uint32_t u32x8 __attribute__((vector_size(32)));
typedef int64_t i64x2 __attribute__((vector_size(16)));
typedef int64_t i64x4 __attribute__((vector_size(32)));
typedef int16_t i16x8 __attribute__((vector_size(16)));
typedef int16_t i16x16 __attribute__((vector_size(32)));
typedef uint8_t u8x16 __attribute__((vector_size(16)));
typedef uint8_t u8x32 __attribute__((vector_size(32)));

/* --------------------------------------------------------------------- in memory; `at` may be any address of a lane */

static inline f32x4 f32x4_all(float x) { return (f32x4){x, x, x, x}; }
static inline f32x8 f32x8_all(float x) { return (f32x8){x, x, x, x, x, x, x, x}; }
static inline f64x4 f64x4_all(double x) { return (f64x4){x, x, x, x}; }
static inline i32x4 i32x4_all(int32_t x) { return (i32x4){x, x, x, x}; }
static inline i32x8 i32x8_all(int32_t x) { return (i32x8){x, x, x, x, x, x, x, x}; }

#define LANES_LOAD_STORE(V, T)            \
    static inline V V##_load(const T *at) \
    {                                     \
        V v;                              \
        memcpy(&v, at, sizeof v);         \
        return v;                         \
    }                                     \
    static inline void V##_store(T *at, V v) { memcpy(at, &v, sizeof v); }
LANES_LOAD_STORE(f32x4, float)
LANES_LOAD_STORE(f32x8, float)
LANES_LOAD_STORE(f64x4, double)
LANES_LOAD_STORE(i32x4, void)
LANES_LOAD_STORE(i32x8, void)
LANES_LOAD_STORE(i16x8, void)
LANES_LOAD_STORE(i16x16, void)
LANES_LOAD_STORE(u8x16, void)
LANES_LOAD_STORE(u8x32, void)

/* ---------------------------------------------------------------------------------------------- with AVX2, and without
 *
 * if(m, a, b): a where m is negative (the sign alone counts), else b. where(m, a), unless(m, a): a where m is -1 or 0,
 * else 0. signs(m): bit k is the sign of lane k. pick(a, i): lane i[k] & 7 of a. gather(p, i): p[i[k]].
 * gather_if(m, p, i, b): the same where m is negative, else b. load_if(m, p): p[k] where m is negative, else 0. What is
 * not wanted is not read. truncate, round: to integers. */

#ifdef LANES_AVX2

static inline f32x4 f32x4_min(f32x4 a, f32x4 b) { return _mm_min_ps(a, b); }
static inline f32x4 f32x4_max(f32x4 a, f32x4 b) { return _mm_max_ps(a, b); }
static inline f32x4 f32x4_sqrt(f32x4 a) { return _mm_sqrt_ps(a); }
static inline i32x4 i32x4_min(i32x4 a, i32x4 b) { return (i32x4)_mm_min_epi32((__m128i)a, (__m128i)b); }
static inline i32x4 i32x4_max(i32x4 a, i32x4 b) { return (i32x4)_mm_max_epi32((__m128i)a, (__m128i)b); }
static inline unsigned i32x4_signs(i32x4 m) { return (unsigned)_mm_movemask_ps((__m128)m); }

static inline f32x4 f32x8_low(f32x8 a) { return _mm256_castps256_ps128(a); }
static inline f32x4 f32x8_high(f32x8 a) { return _mm256_extractf128_ps(a, 1); }
static inline f32x8 f32x8_join(f32x4 low, f32x4 high) { return _mm256_set_m128(high, low); }
static inline f32x8 f32x8_min(f32x8 a, f32x8 b) { return _mm256_min_ps(a, b); }
static inline f32x8 f32x8_max(f32x8 a, f32x8 b) { return _mm256_max_ps(a, b); }
static inline f32x8 f32x8_sqrt(f32x8 a) { return _mm256_sqrt_ps(a); }
static inline f32x8 f32x8_if(i32x8 m, f32x8 a, f32x8 b) { return _mm256_blendv_ps(b, a, (__m256)m); }
static inline f32x8 f32x8_where(i32x8 m, f32x8 a) { return _mm256_and_ps((__m256)m, a); }
static inline f32x8 f32x8_unless(i32x8 m, f32x8 a) { return _mm256_andnot_ps((__m256)m, a); }
static inline f32x8 f32x8_pick(f32x8 a, i32x8 i) { return _mm256_permutevar8x32_ps(a, (__m256i)i); }
static inline f32x8 f32x8_gather(const float *p, i32x8 i) { return _mm256_i32gather_ps(p, (__m256i)i, 4); }
static inline f32x8 f32x8_gather_if(i32x8 m, const float *p, i32x8 i, f32x8 b)
{
    return _mm256_mask_i32gather_ps(b, p, (__m256i)i, (__m256)m, 4);
}

static inline i32x8 i32x8_if(i32x8 m, i32x8 a, i32x8 b)
{
    return (i32x8)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m);
}
static inline f32x8 f32x8_load_if(i32x8 m, const float *p) { return _mm256_maskload_ps(p, (__m256i)m); }

static inline i32x8 i32x8_min(i32x8 a, i32x8 b) { return (i32x8)_mm256_min_epi32((__m256i)a, (__m256i)b); }
static inline i32x8 i32x8_max(i32x8 a, i32x8 b) { return (i32x8)_mm256_max_epi32((__m256i)a, (__m256i)b); }
static inline unsigned i32x8_signs(i32x8 m) { return (unsigned)_mm256_movemask_ps((__m256)m); }
static inline i32x8 i32x8_pick(i32x8 a, i32x8 i) { return (i32x8)_mm256_permutevar8x32_epi32((__m256i)a, (__m256i)i); }
static inline i32x8 i32x8_gather(const int32_t *p, i32x8 i) { return (i32x8)_mm256_i32gather_epi32(p, (__m256i)i, 4); }
static inline i32x8 i32x8_gather_if(i32x8 m, const int32_t *p, i32x8 i, i32x8 b)
{
    return (i32x8)_mm256_mask_i32gather_epi32((__m256i)b, p, (__m256i)i, (__m256i)m, 4);
}
static inline i32x8 i32x8_truncate(f32x8 a) { return (i32x8)_mm256_cvttps_epi32(a); }
static inline i32x8 i32x8_round(f32x8 a) { return (i32x8)_mm256_cvtps_epi32(a); }
static inline i32x8 i32x8_from_u8(const uint8_t *p)
{
    return (i32x8)_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
static inline i32x8 i32x8_from_i16(const int16_t *p)
{
    return (i32x8)_mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)(const void *)p));
}

static inline f64x4 f64x4_min(f64x4 a, f64x4 b) { return _mm256_min_pd(a, b); }
static inline f64x4 f64x4_max(f64x4 a, f64x4 b) { return _mm256_max_pd(a, b); }
static inline f64x4 f64x4_sqrt(f64x4 a) { return _mm256_sqrt_pd(a); }
static inline f64x4 f64x4_floor(f64x4 a) { return _mm256_floor_pd(a); }
static inline f64x4 f64x4_ceil(f64x4 a) { return _mm256_ceil_pd(a); }
static inline f64x4 f64x4_if(i64x4 m, f64x4 a, f64x4 b) { return _mm256_blendv_pd(b, a, (__m256d)m); }
static inline f64x4 f64x4_where(i64x4 m, f64x4 a) { return _mm256_and_pd((__m256d)m, a); }
static inline unsigned i64x4_signs(i64x4 m) { return (unsigned)_mm256_movemask_pd((__m256d)m); }
static inline f64x4 f64x4_from_f32(f32x4 a) { return _mm256_cvtps_pd(a); }
static inline f64x4 f64x4_from_i32(i32x4 a) { return _mm256_cvtepi32_pd((__m128i)a); }
static inline i32x4 i32x4_truncate_f64(f64x4 a) { return (i32x4)_mm256_cvttpd_epi32(a); }

static inline f32x4 f32x4_from_half(const uint16_t *p)
{
    return _mm_cvtph_ps(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
static inline f32x8 f32x8_from_half(const uint16_t *p)
{
    return _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)p));
}
static inline void f32x4_to_half(uint16_t *p, f32x4 a)
{
    _mm_storel_epi64((__m128i *)(void *)p, _mm_cvtps_ph(a, _MM_FROUND_TO_NEAREST_INT));
}
static inline void f32x8_to_half(uint16_t *p, f32x8 a)
{
    _mm_storeu_si128((__m128i *)(void *)p, _mm256_cvtps_ph(a, _MM_FROUND_TO_NEAREST_INT));
}

static inline float float_from_half(uint16_t bits) { return _cvtsh_ss(bits); }
static inline uint16_t half_from_float(float x) { return _cvtss_sh(x, _MM_FROUND_TO_NEAREST_INT); }

/* sums[k] = a[0] + ... + a[k] */
static inline u8x16 u8x16_running_sums(u8x16 a)
{
    a += (u8x16)_mm_slli_si128((__m128i)a, 1);
    a += (u8x16)_mm_slli_si128((__m128i)a, 2);
    a += (u8x16)_mm_slli_si128((__m128i)a, 4);
    return a + (u8x16)_mm_slli_si128((__m128i)a, 8);
}

static inline bool i16x8_any(i16x8 m) { return _mm_movemask_epi8((__m128i)m); }
static inline i16x16 i16x16_min(i16x16 a, i16x16 b) { return (i16x16)_mm256_min_epi16((__m256i)a, (__m256i)b); }
static inline i16x16 i16x16_abs(i16x16 a) { return (i16x16)_mm256_abs_epi16((__m256i)a); }
/* a - b, limited to the range; of bytes times signed bytes, and of products, the sums of neighbouring two */
static inline i16x16 i16x16_subtract(i16x16 a, i16x16 b) { return (i16x16)_mm256_subs_epi16((__m256i)a, (__m256i)b); }
static inline i16x16 i16x16_weigh_u8(u8x32 a, u8x32 weights)
{
    return (i16x16)_mm256_maddubs_epi16((__m256i)a, (__m256i)weights);
}
static inline i32x8 i32x8_weigh_i16(i16x16 a, i16x16 weights)
{
    return (i32x8)_mm256_madd_epi16((__m256i)a, (__m256i)weights);
}
/* the sums of neighbouring two: a's first two, b's first two, a's last two, b's last two */
static inline i32x8 i32x8_add_pairs(i32x8 a, i32x8 b) { return (i32x8)_mm256_hadd_epi32((__m256i)a, (__m256i)b); }

#else /* the same without */

#define LANES_EACH(k, n) for (int k = 0; k < n; k++)

static inline i32x4 i32x4_if(i32x4 m, i32x4 a, i32x4 b) { return m >>= 31, (a & m) | (b & ~m); }
static inline f32x4 f32x4_if(i32x4 m, f32x4 a, f32x4 b) { return (f32x4)i32x4_if(m, (i32x4)a, (i32x4)b); }
static inline f32x4 f32x4_min(f32x4 a, f32x4 b) { return f32x4_if(a < b, a, b); }
static inline f32x4 f32x4_max(f32x4 a, f32x4 b) { return f32x4_if(a > b, a, b); }
static inline f32x4 f32x4_sqrt(f32x4 a) { return (f32x4){sqrtf(a[0]), sqrtf(a[1]), sqrtf(a[2]), sqrtf(a[3])}; }
static inline i32x4 i32x4_min(i32x4 a, i32x4 b) { return i32x4_if(a < b, a, b); }
static inline i32x4 i32x4_max(i32x4 a, i32x4 b) { return i32x4_if(a > b, a, b); }
static inline unsigned i32x4_signs(i32x4 m)
{
    unsigned bits = 0;
    LANES_EACH(k, 4) bits |= (unsigned)(m[k] < 0) << k;
    return bits;
}

static inline f32x4 f32x8_low(f32x8 a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
static inline f32x4 f32x8_high(f32x8 a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }
static inline f32x8 f32x8_join(f32x4 low, f32x4 high)
{
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
static inline i32x8 i32x8_if(i32x8 m, i32x8 a, i32x8 b) { return m >>= 31, (a & m) | (b & ~m); }
static inline f32x8 f32x8_if(i32x8 m, f32x8 a, f32x8 b) { return (f32x8)i32x8_if(m, (i32x8)a, (i32x8)b); }
static inline i32x8 i32x8_min(i32x8 a, i32x8 b) { return i32x8_if(a < b, a, b); }
static inline i32x8 i32x8_max(i32x8 a, i32x8 b) { return i32x8_if(a > b, a, b); }
static inline f32x8 f32x8_min(f32x8 a, f32x8 b) { return f32x8_if(a < b, a, b); }
static inline f32x8 f32x8_max(f32x8 a, f32x8 b) { return f32x8_if(a > b, a, b); }
static inline f32x8 f32x8_sqrt(f32x8 a)
{
    LANES_EACH(k, 8) a[k] = sqrtf(a[k]);
    return a;
}
static inline f32x8 f32x8_where(i32x8 m, f32x8 a) { return (f32x8)(m & (i32x8)a); }
static inline f32x8 f32x8_unless(i32x8 m, f32x8 a) { return (f32x8)(~m & (i32x8)a); }
static inline i32x8 i32x8_gather_if(i32x8 m, const int32_t *p, i32x8 i, i32x8 b)
{
    LANES_EACH(k, 8) if (m[k] < 0) memcpy((char *)&b + 4 * k, p + i[k], 4);
    return b;
}
static inline i32x8 i32x8_gather(const int32_t *p, i32x8 i) { return i32x8_gather_if(i32x8_all(-1), p, i, i); }
static inline f32x8 f32x8_gather(const float *p, i32x8 i) { return (f32x8)i32x8_gather((const void *)p, i); }
static inline f32x8 f32x8_gather_if(i32x8 m, const float *p, i32x8 i, f32x8 b)
{
    return (f32x8)i32x8_gather_if(m, (const void *)p, i, (i32x8)b);
}
static inline f32x8 f32x8_load_if(i32x8 m, const float *p)
{
    return f32x8_gather_if(m, p, (i32x8){0, 1, 2, 3, 4, 5, 6, 7}, (f32x8){0});
}
static inline i32x8 i32x8_pick(i32x8 a, i32x8 i) { return i32x8_gather((const void *)&a, i & 7); }
static inline f32x8 f32x8_pick(f32x8 a, i32x8 i) { return f32x8_gather((const void *)&a, i & 7); }
static inline unsigned i32x8_signs(i32x8 m)
{
    unsigned bits = 0;
    LANES_EACH(k, 8) bits |= (unsigned)(m[k] < 0) << k;
    return bits;
}
static inline i32x8 i32x8_truncate(f32x8 a)
{
    const i32x8 fits = (a >= -0x1p31f) & (a < 0x1p31f);
    return i32x8_if(fits, __builtin_convertvector(f32x8_where(fits, a), i32x8), i32x8_all(INT32_MIN));
}
static inline i32x8 i32x8_round(f32x8 a) /* from 2^23 on all values are whole */
{
    const f32x8 size = (f32x8)((i32x8)a & INT32_MAX), far = (f32x8)((i32x8)f32x8_all(0x1p23f) | ((i32x8)a & INT32_MIN));
    return i32x8_truncate(f32x8_if(size < 0x1p23f, a + far - far, a));
}
static inline i32x8 i32x8_from_u8(const uint8_t *p) { return (i32x8){p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]}; }
static inline i32x8 i32x8_from_i16(const int16_t *p) { return (i32x8){p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]}; }

static inline f64x4 f64x4_where(i64x4 m, f64x4 a) { return (f64x4)(m & (i64x4)a); }
static inline f64x4 f64x4_if(i64x4 m, f64x4 a, f64x4 b) { return m >>= 63, (f64x4)(((i64x4)a & m) | ((i64x4)b & ~m)); }
static inline f64x4 f64x4_min(f64x4 a, f64x4 b) { return f64x4_if(a < b, a, b); }
static inline f64x4 f64x4_max(f64x4 a, f64x4 b) { return f64x4_if(a > b, a, b); }
static inline f64x4 f64x4_sqrt(f64x4 a) { return (f64x4){sqrt(a[0]), sqrt(a[1]), sqrt(a[2]), sqrt(a[3])}; }
static inline f64x4 f64x4_floor(f64x4 a) { return (f64x4){floor(a[0]), floor(a[1]), floor(a[2]), floor(a[3])}; }
static inline f64x4 f64x4_ceil(f64x4 a) { return (f64x4){ceil(a[0]), ceil(a[1]), ceil(a[2]), ceil(a[3])}; }
static inline unsigned i64x4_signs(i64x4 m)
{
    unsigned bits = 0;
    LANES_EACH(k, 4) bits |= (unsigned)(m[k] < 0) << k;
    return bits;
}
static inline f64x4 f64x4_from_f32(f32x4 a) { return __builtin_convertvector(a, f64x4); }
static inline f64x4 f64x4_from_i32(i32x4 a) { return __builtin_convertvector(a, f64x4); }
static inline i32x4 i32x4_truncate_f64(f64x4 a)
{
    const i64x4 fits = (a > -0x1p31 - 1) & (a < 0x1p31);
    const i32x4 whole = __builtin_convertvector(f64x4_where(fits, a), i32x4);
    return i32x4_if(__builtin_convertvector(fits, i32x4), whole, (i32x4){0} + INT32_MIN);
}

/* A half of exponent 31 is infinite or NaN, one of exponent 0 a multiple of 2^-24. */
static inline f32x4 f32x4_from_half(const uint16_t *p)
{
    const i32x4 bits = {p[0], p[1], p[2], p[3]}, sign = (bits & 0x8000) << 16, size = bits & 0x7fff;
    i32x4 normal = (size << 13) + (112 << 23);
    normal += (size >= 0x7c00) & (112 << 23);
    normal |= (size > 0x7c00) & 0x400000;
    return (f32x4)(sign | i32x4_if(size < 0x400, (i32x4)(__builtin_convertvector(size, f32x4) * 0x1p-24f), normal));
}
static inline f32x8 f32x8_from_half(const uint16_t *p)
{
    return __builtin_shufflevector(f32x4_from_half(p), f32x4_from_half(p + 4), 0, 1, 2, 3, 4, 5, 6, 7);
}
static inline void f32x4_to_half(uint16_t *p, f32x4 a)
{
    const i32x4 sign = (i32x4)a >> 16 & 0x8000, size = (i32x4)a & INT32_MAX;
    i32x4 bits = (size - (112 << 23) + 0xfff + (size >> 13 & 1)) >> 13;
    bits = i32x4_if(size < 113 << 23, (i32x4)((f32x4)size + 0.5f) - (126 << 23), bits); /* rounded by the addition */
    bits = i32x4_if(size >= 143 << 23, (i32x4){0} + 0x7c00, bits);
    bits = i32x4_if(size > 255 << 23, (size >> 13 & 0x3ff) | 0x7e00, bits) | sign;
    LANES_EACH(k, 4) p[k] = (uint16_t)bits[k];
}
static inline void f32x8_to_half(uint16_t *p, f32x8 a)
{
    f32x4_to_half(p, __builtin_shufflevector(a, a, 0, 1, 2, 3));
    f32x4_to_half(p + 4, __builtin_shufflevector(a, a, 4, 5, 6, 7));
}

static inline float float_from_half(uint16_t bits) { return f32x4_from_half((const uint16_t[4]){bits})[0]; }
static inline uint16_t half_from_float(float x)
{
    uint16_t bits[4];
    f32x4_to_half(bits, (f32x4){x});
    return bits[0];
}

static inline u8x16 u8x16_running_sums(u8x16 a)
{
    for (int k = 1; k < 16; k++) a[k] = (uint8_t)(a[k] + a[k - 1]);
    return a;
}

static inline int32_t limit_i16(int32_t x) { return x < INT16_MIN ? INT16_MIN : x > INT16_MAX ? INT16_MAX : x; }
static inline bool i16x8_any(i16x8 m)
{
    const i64x2 halves = (i64x2)m;
    return halves[0] | halves[1];
}
static inline i16x16 i16x16_min(i16x16 a, i16x16 b)
{
    const i16x16 m = a < b;
    return (a & m) | (b & ~m);
}
static inline i16x16 i16x16_abs(i16x16 a)
{
    LANES_EACH(k, 16) a[k] = (int16_t)(a[k] < 0 ? -a[k] : a[k]);
    return a;
}
static inline i16x16 i16x16_subtract(i16x16 a, i16x16 b)
{
    LANES_EACH(k, 16) a[k] = (int16_t)limit_i16(a[k] - b[k]);
    return a;
}
static inline i16x16 i16x16_weigh_u8(u8x32 a, u8x32 weights)
{
    i16x16 sums;
    LANES_EACH(k, 16)
    sums[k] = (int16_t)limit_i16(a[2 * k] * (int8_t)weights[2 * k] + a[2 * k + 1] * (int8_t)weights[2 * k + 1]);
    return sums;
}
static inline i32x8 i32x8_weigh_i16(i16x16 a, i16x16 weights)
{
    i32x8 sums;
    LANES_EACH(k, 8) sums[k] = a[2 * k] * weights[2 * k] + a[2 * k + 1] * weights[2 * k + 1];
    return sums;
}
static inline i32x8 i32x8_add_pairs(i32x8 a, i32x8 b)
{
    return __builtin_shufflevector(a, b, 0, 2, 8, 10, 4, 6, 12, 14) +
           __builtin_shufflevector(a, b, 1, 3, 9, 11, 5, 7, 13, 15);
}

#endif

/* ------------------------------------------------------------------------------------------------ made of the above */

static inline f32x4 f32x4_abs(f32x4 a) { return (f32x4)((i32x4)a & INT32_MAX); }
static inline f32x8 f32x8_abs(f32x8 a) { return (f32x8)((i32x8)a & INT32_MAX); }
static inline f32x8 f32x8_from_i32(i32x8 a) { return __builtin_convertvector(a, f32x8); }
static inline f32x4 f32x4_from_f64(f64x4 a) { return __builtin_convertvector(a, f32x4); }
static inline i16x16 i16x16_lows(i16x16 a, i16x16 b)
{
    return (i16x16)__builtin_shufflevector((i64x4)a, (i64x4)b, 0, 1, 4, 5);
}
static inline i16x16 i16x16_highs(i16x16 a, i16x16 b)
{
    return (i16x16)__builtin_shufflevector((i64x4)a, (i64x4)b, 2, 3, 6, 7);
}
static inline bool i32x8_any(i32x8 m) { return i32x8_signs(m); }

/* Always in the same order. */
static inline float f32x8_sum(f32x8 a)
{
    const f32x4 four = f32x8_low(a) + f32x8_high(a), two = four + __builtin_shufflevector(four, four, 2, 3, 2, 3);
    return two[0] + two[1];
}
static inline float f32x8_largest(f32x8 a)
{
    const f32x4 four = f32x4_max(f32x8_low(a), f32x8_high(a));
    const f32x4 two = f32x4_max(four, __builtin_shufflevector(four, four, 2, 3, 2, 3));
    return f32x4_max(two, __builtin_shufflevector(two, two, 1, 1, 1, 1))[0];
}

/* Exchanges rows and columns: of 4 x 4 lanes, and of the lower and the upper 4 x 4 lanes. */
static inline void f32x4_transpose(f32x4 v[4])
{
    const f32x4 a = __builtin_shufflevector(v[0], v[1], 0, 4, 1, 5),
                b = __builtin_shufflevector(v[2], v[3], 0, 4, 1, 5);
    const f32x4 c = __builtin_shufflevector(v[0], v[1], 2, 6, 3, 7),
                d = __builtin_shufflevector(v[2], v[3], 2, 6, 3, 7);
    v[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    v[1] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    v[2] = __builtin_shufflevector(c, d, 0, 1, 4, 5);
    v[3] = __builtin_shufflevector(c, d, 2, 3, 6, 7);
}
static inline void f32x8_transpose(f32x8 v[4])
{
    const f32x8 a = __builtin_shufflevector(v[0], v[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const f32x8 b = __builtin_shufflevector(v[2], v[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const f32x8 c = __builtin_shufflevector(v[0], v[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const f32x8 d = __builtin_shufflevector(v[2], v[3], 2, 10, 3, 11, 6, 14, 7, 15);
    v[0] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    v[1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    v[2] = __builtin_shufflevector(c, d, 0, 1, 8, 9, 4, 5, 12, 13);
    v[3] = __builtin_shufflevector(c, d, 2, 3, 10, 11, 6, 7, 14, 15);
}

/* The index of element (column, row) in rows of `stride`; of lanes that are not used it may wrap. */
static inline i32x8 i32x8_index(i32x8 row, int stride, i32x8 column)
{
    return (i32x8)((u32x8)row * (uint32_t)stride + (u32x8)column);
}

/* Makes denormal numbers, which are slow, count as 0. Returns what denormals_restore() takes. */
#ifdef __SSE2__
static inline uint64_t denormals_flush(void)
{
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
    return before;
}
static inline void denormals_restore(uint64_t before) { _mm_setcsr((unsigned)before); }
#elif defined(__aarch64__)
static inline void denormals_restore(uint64_t before) { __asm__ volatile("msr fpcr, %0" ::"r"(before)); }
static inline uint64_t denormals_flush(void)
{
    uint64_t before;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before));
    denormals_restore(before | 1u << 24);
    return before;
}
#else
static inline uint64_t denormals_flush(void) { return 0; }
static inline void denormals_restore(uint64_t before) { (void)before; }
#endif

#endif
