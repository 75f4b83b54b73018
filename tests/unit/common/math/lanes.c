/* lanes.c - each operation of lanes.h by its rule, lane by lane: tests/long/portable_views.sh runs this without AVX2,
 * too. */
#include "common/math/lanes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>

#include "common/base/rng.h"

#define ROUNDS 4000

/* Bits of floats: zeros, denormal numbers, infinities, NaN, whole and half numbers, limits of integers and of halves.
 */
static const uint32_t special[] = {0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000, 0x7f7fffff,
                                   0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345, 0x7f800001, 0xff812345,
                                   0x3f000000, 0xbf000000, 0x3f800000, 0xbf800000, 0x3fc00000, 0x40200000, 0xc0200000,
                                   0x3effffff, 0x4affffff, 0x4b000000, 0x4b000001, 0xcb7fffff, 0x4effffff, 0x4f000000,
                                   0xcf000000, 0xcf000001, 0x477fe000, 0x477fefff, 0x477ff000, 0x38800000, 0x387fffff,
                                   0x33000000, 0x33000001, 0x33800000, 0xb3c00000, 0x00ffffff};
enum { SPECIAL = sizeof special / sizeof *special };

static struct rng rng = {0};

static uint32_t random_bits(uint64_t i, uint64_t k)
{
    const uint64_t bits = (uint64_t)(rng_uniform(&rng, i, k) * 0x1p52);
    return bits % 4 ? (uint32_t)(bits >> 8) : special[(bits >> 8) % SPECIAL];
}

static void fill(void *to, size_t size, uint64_t round)
{
    for (size_t k = 0; k < size / 4; k++) {
        const uint32_t bits = random_bits(round, k);
        memcpy((char *)to + 4 * k, &bits, 4);
    }
}

#define ASSERT_SAME(a, b) assert_memory_equal(&(a), &(b), sizeof(a))
#define EACH(k, n)        for (int k = 0; k < n; k++)

static void minima_and_maxima_take_the_second_of_equals(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < ROUNDS; i++) {
        float a[8], b[8], low[8], high[8], out[8];
        double c[4], d[4], low4[4], high4[4], out4[4];
        fill(a, sizeof a, 4 * i);
        fill(b, sizeof b, 4 * i + 1);
        fill(c, sizeof c, 4 * i + 2);
        fill(d, sizeof d, 4 * i + 3);
        if (i % 8 == 0) memcpy(b, a, sizeof b), memcpy(d, c, sizeof d);
        if (i % 8 == 1) EACH(k, 8) b[k] = -a[k];
        EACH(k, 8) memcpy(&low[k], a[k] < b[k] ? &a[k] : &b[k], 4), memcpy(&high[k], a[k] > b[k] ? &a[k] : &b[k], 4);
        EACH(k, 4) memcpy(&low4[k], c[k] < d[k] ? &c[k] : &d[k], 8), memcpy(&high4[k], c[k] > d[k] ? &c[k] : &d[k], 8);
        f32x8_store(out, f32x8_min(f32x8_load(a), f32x8_load(b)));
        ASSERT_SAME(out, low);
        f32x8_store(out, f32x8_max(f32x8_load(a), f32x8_load(b)));
        ASSERT_SAME(out, high);
        f32x4_store(out, f32x4_min(f32x4_load(a), f32x4_load(b)));
        assert_memory_equal(out, low, 16);
        f32x4_store(out, f32x4_max(f32x4_load(a), f32x4_load(b)));
        assert_memory_equal(out, high, 16);
        f64x4_store(out4, f64x4_min(f64x4_load(c), f64x4_load(d)));
        ASSERT_SAME(out4, low4);
        f64x4_store(out4, f64x4_max(f64x4_load(c), f64x4_load(d)));
        ASSERT_SAME(out4, high4);
    }
}

static void integers_are_least_for_nan_and_beyond_the_range(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < ROUNDS; i++) {
        float a[8];
        double d[4];
        int32_t cut[8], near[8], out[8], out4[4], cut4[4];
        fill(a, sizeof a, i);
        EACH(k, 4) d[k] = (double)a[k] + (i & 1 ? 0.75 : 0);
        EACH(k, 8)
        {
            const double whole = trunc((double)a[k]), rounded = nearbyint((double)a[k]);
            cut[k] = whole >= -0x1p31 && whole < 0x1p31 ? (int32_t)whole : INT32_MIN;
            near[k] = rounded >= -0x1p31 && rounded < 0x1p31 ? (int32_t)rounded : INT32_MIN;
        }
        EACH(k, 4) cut4[k] = trunc(d[k]) >= -0x1p31 && trunc(d[k]) < 0x1p31 ? (int32_t)d[k] : INT32_MIN;
        i32x8_store(out, i32x8_truncate(f32x8_load(a)));
        ASSERT_SAME(out, cut);
        i32x8_store(out, i32x8_round(f32x8_load(a)));
        ASSERT_SAME(out, near);
        i32x4_store(out4, i32x4_truncate_f64(f64x4_load(d)));
        ASSERT_SAME(out4, cut4);
    }
}

static void numbers_are_converted_and_rounded_exactly(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < ROUNDS; i++) {
        int32_t n[8];
        float f[8], as_float[8], root[8], out[8];
        double d[4], wide[4], low[4], high[4], out4[4];
        fill(n, sizeof n, 2 * i);
        EACH(k, 8) as_float[k] = (float)n[k];
        f32x8_store(out, f32x8_from_i32(i32x8_load(n)));
        ASSERT_SAME(out, as_float);
        EACH(k, 4) wide[k] = n[k];
        f64x4_store(out4, f64x4_from_i32(i32x4_load(n)));
        ASSERT_SAME(out4, wide);
        EACH(k, 8) f[k] = as_float[k] * 0x1p-16f;
        EACH(k, 8) root[k] = f[k] > 0 ? sqrtf(f[k]) : 0;
        f32x8_store(out, f32x8_sqrt(f32x8_max(f32x8_load(f), (f32x8){0})));
        ASSERT_SAME(out, root);
        f32x4_store(out, f32x4_sqrt(f32x4_max(f32x4_load(f), (f32x4){0})));
        assert_memory_equal(out, root, 16);
        EACH(k, 4) wide[k] = (double)f[k], d[k] = (double)f[k] / 3, low[k] = floor(d[k]), high[k] = ceil(d[k]);
        f64x4_store(out4, f64x4_from_f32(f32x4_load(f)));
        ASSERT_SAME(out4, wide);
        f64x4_store(out4, f64x4_floor(f64x4_load(d)));
        ASSERT_SAME(out4, low);
        f64x4_store(out4, f64x4_ceil(f64x4_load(d)));
        ASSERT_SAME(out4, high);
        EACH(k, 4) wide[k] = d[k] > 0 ? sqrt(d[k]) : 0;
        f64x4_store(out4, f64x4_sqrt(f64x4_max(f64x4_load(d), (f64x4){0})));
        ASSERT_SAME(out4, wide);
        EACH(k, 4) as_float[k] = (float)d[k];
        f32x4_store(out, f32x4_from_f64(f64x4_load(d)));
        assert_memory_equal(out, as_float, 16);
        float pairs[4], sum;
        EACH(k, 4) pairs[k] = f[k] + f[k + 4];
        sum = (pairs[0] + pairs[2]) + (pairs[1] + pairs[3]);
        assert_true(f32x8_sum(f32x8_load(f)) == sum);
        float largest = f[0];
        EACH(k, 8) largest = fmaxf(largest, f[k]);
        assert_true(f32x8_largest(f32x8_load(f)) == largest);
    }
}

/* A half by arithmetic: 11 significant bits, or multiples of 2^-24. */
static uint16_t half_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, 4);
    const uint32_t sign = bits >> 16 & 0x8000;
    if (isnan(x)) return (uint16_t)(sign | 0x7e00 | (bits >> 13 & 0x3ff));
    const double size = fabs((double)x);
    if (size >= 65520) return (uint16_t)(sign | 0x7c00);
    const int exponent = size < 0x1p-14 ? -14 : ilogb(size);
    return (uint16_t)(sign + (uint32_t)((exponent + 14) * 1024) + (uint32_t)nearbyint(ldexp(size, 10 - exponent)));
}

static void halves_become_floats_and_are_rounded_to_even(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x10000; h += 8) {
        uint16_t halves[8], back[8];
        float out[8];
        EACH(k, 8) halves[k] = (uint16_t)(h + (uint32_t)k);
        f32x8_store(out, f32x8_from_half(halves));
        EACH(k, 8)
        {
            const int exponent = halves[k] >> 10 & 31, mantissa = halves[k] & 1023;
            const double size = exponent == 31 ? INFINITY
                                : exponent     ? ldexp(1024 + mantissa, exponent - 25)
                                               : ldexp(mantissa, -24);
            if (exponent == 31 && mantissa) {
                uint32_t bits;
                memcpy(&bits, &out[k], 4);
                assert_int_equal(bits, ((uint32_t)halves[k] >> 15 << 31) | 0x7fc00000 | (uint32_t)mantissa << 13);
            } else
                assert_true((double)out[k] == (halves[k] >> 15 ? -size : size) && !signbit(out[k]) == !(h >> 15));
            assert_true(isnan(out[k]) || float_from_half(halves[k]) == out[k]);
        }
        f32x8_to_half(back, f32x8_load(out));
        EACH(k, 8) assert_int_equal(back[k], half_of(out[k]));
        EACH(k, 8) assert_true(back[k] == halves[k] || back[k] == (halves[k] | 0x200)); /* a NaN becomes quiet */
    }
    /* around what lies halfway between two halves */
    static const uint32_t low[] = {0, 1, 0x7ff, 0x800, 0x801, 0xfff, 0x1000, 0x1001, 0x1800, 0x1fff};
    for (uint32_t h = 0; h < 0x80000; h++)
        for (size_t l = 0; l < sizeof low / sizeof *low; l++) {
            const uint32_t bits = h << 13 | low[l];
            float x;
            memcpy(&x, &bits, 4);
            assert_int_equal(half_from_float(x), half_of(x));
        }
}

static void masks_choose_lanes(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < ROUNDS; i++) {
        int32_t mask[8], index[8], all[16], chosen[8], kept[8], dropped[8], read[8], picked[8], out[8];
        int64_t wide[4], chosen4[4], kept4[4], out4[4];
        unsigned signs = 0, signs4 = 0;
        fill(mask, sizeof mask, 3 * i);
        fill(all, sizeof all, 3 * i + 1);
        fill(index, sizeof index, 3 * i + 2);
        EACH(k, 8)
        {
            index[k] = (int32_t)((uint32_t)index[k] % 8);
            signs |= (unsigned)(mask[k] < 0) << k;
            chosen[k] = mask[k] < 0 ? all[k] : all[k + 8];
            read[k] = mask[k] < 0 ? all[index[k] + 8] : all[k];
            picked[k] = all[index[k]];
            kept[k] = mask[k] < 0 ? all[k] : 0;
            dropped[k] = mask[k] < 0 ? 0 : all[k];
        }
        const i32x8 m = i32x8_load(mask), a = i32x8_load(all), b = i32x8_load(all + 8), at = i32x8_load(index);
        assert_int_equal(i32x8_signs(m), signs);
        assert_int_equal(i32x8_any(m), signs > 0);
        assert_int_equal(i32x4_signs(i32x4_load(mask)), signs & 15);
        i32x8_store(out, i32x8_if(m, a, b));
        ASSERT_SAME(out, chosen);
        i32x8_store(out, (i32x8)f32x8_if(m, (f32x8)a, (f32x8)b));
        ASSERT_SAME(out, chosen);
        i32x8_store(out, (i32x8)f32x8_where(m < 0, (f32x8)a));
        ASSERT_SAME(out, kept);
        i32x8_store(out, (i32x8)f32x8_unless(m < 0, (f32x8)a));
        ASSERT_SAME(out, dropped);
        i32x8_store(out, (i32x8)f32x8_load_if(m, (const void *)all));
        ASSERT_SAME(out, kept);
        const i32x8 far = at + (i32x8_load(all + 8) & ~7); /* the low bits of an index count */
        i32x8_store(out, i32x8_pick(a, far));
        ASSERT_SAME(out, picked);
        i32x8_store(out, (i32x8)f32x8_pick((f32x8)a, far));
        ASSERT_SAME(out, picked);
        i32x8_store(out, i32x8_gather(all, at));
        ASSERT_SAME(out, picked);
        i32x8_store(out, (i32x8)f32x8_gather((const void *)all, at));
        ASSERT_SAME(out, picked);
        i32x8_store(out, i32x8_gather_if(m, all + 8, at, a));
        ASSERT_SAME(out, read);
        i32x8_store(out, (i32x8)f32x8_gather_if(m, (const void *)(all + 8), at, (f32x8)a));
        ASSERT_SAME(out, read);
        EACH(k, 4)
        {
            memcpy(&wide[k], all + 2 * k, 8);
            signs4 |= (unsigned)(wide[k] < 0) << k;
            chosen4[k] = wide[k] < 0 ? k + 1 : -k;
            kept4[k] = wide[k] < 0 ? k + 1 : 0;
        }
        const i64x4 m4 = (i64x4)a, first = {1, 2, 3, 4}, second = {0, -1, -2, -3};
        assert_int_equal(i64x4_signs(m4), signs4);
        f64x4_store((double *)(void *)out4, f64x4_if(m4, (f64x4)first, (f64x4)second));
        ASSERT_SAME(out4, chosen4);
        f64x4_store((double *)(void *)out4, f64x4_where(m4 < 0, (f64x4)first));
        ASSERT_SAME(out4, kept4);
        EACH(k, 8) out[k] = (int32_t)((uint32_t)all[k] * 641u + (uint32_t)all[k + 8]);
        i32x8_store(chosen, i32x8_index(a, 641, b));
        ASSERT_SAME(out, chosen);
        EACH(k, 4)
        chosen[k] = all[k] < all[k + 8] ? all[k] : all[k + 8], kept[k] = all[k] > all[k + 8] ? all[k] : all[k + 8];
        i32x4_store(out, i32x4_min(i32x4_load(all), i32x4_load(all + 8)));
        assert_memory_equal(out, chosen, 16);
        i32x4_store(out, i32x4_max(i32x4_load(all), i32x4_load(all + 8)));
        assert_memory_equal(out, kept, 16);
    }
}

static int32_t limited(int32_t x) { return x < INT16_MIN ? INT16_MIN : x > INT16_MAX ? INT16_MAX : x; }

static void bytes_and_short_numbers_keep_their_limits(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < ROUNDS; i++) {
        uint8_t a[32], b[32], sums[16], out1[16];
        int16_t s[16], t[16], wanted[16], out2[16];
        int32_t u[8], v[8], wanted4[8], out4[8];
        fill(a, sizeof a, 6 * i);
        fill(b, sizeof b, 6 * i + 1);
        fill(s, sizeof s, 6 * i + 2);
        fill(t, sizeof t, 6 * i + 3);
        fill(u, sizeof u, 6 * i + 4);
        fill(v, sizeof v, 6 * i + 5);
        EACH(k, 16)
        wanted[k] = (int16_t)limited(a[2 * k] * (int8_t)b[2 * k] + a[2 * k + 1] * (int8_t)b[2 * k + 1]);
        i16x16_store(out2, i16x16_weigh_u8(u8x32_load(a), u8x32_load(b)));
        ASSERT_SAME(out2, wanted);
        EACH(k, 16) wanted[k] = (int16_t)limited(s[k] - t[k]);
        i16x16_store(out2, i16x16_subtract(i16x16_load(s), i16x16_load(t)));
        ASSERT_SAME(out2, wanted);
        EACH(k, 16) wanted[k] = (int16_t)(s[k] < 0 ? -s[k] : s[k]);
        i16x16_store(out2, i16x16_abs(i16x16_load(s)));
        ASSERT_SAME(out2, wanted);
        EACH(k, 16) wanted[k] = s[k] < t[k] ? s[k] : t[k];
        i16x16_store(out2, i16x16_min(i16x16_load(s), i16x16_load(t)));
        ASSERT_SAME(out2, wanted);
        EACH(k, 16) wanted[k] = k < 8 ? s[k] : t[k - 8];
        i16x16_store(out2, i16x16_lows(i16x16_load(s), i16x16_load(t)));
        ASSERT_SAME(out2, wanted);
        EACH(k, 16) wanted[k] = k < 8 ? s[k + 8] : t[k];
        i16x16_store(out2, i16x16_highs(i16x16_load(s), i16x16_load(t)));
        ASSERT_SAME(out2, wanted);
        EACH(k, 16) s[k] = (int16_t)(s[k] >> 1);
        EACH(k, 8) wanted4[k] = s[2 * k] * t[2 * k] + s[2 * k + 1] * t[2 * k + 1];
        i32x8_store(out4, i32x8_weigh_i16(i16x16_load(s), i16x16_load(t)));
        ASSERT_SAME(out4, wanted4);
        EACH(k, 8) u[k] >>= 1, v[k] >>= 1;
        EACH(k, 8)
        {
            const int32_t *from = (k & 2 ? v : u) + (k & 4) + 2 * (k & 1);
            wanted4[k] = from[0] + from[1];
        }
        i32x8_store(out4, i32x8_add_pairs(i32x8_load(u), i32x8_load(v)));
        ASSERT_SAME(out4, wanted4);
        EACH(k, 16) sums[k] = (uint8_t)(a[k] + (k ? sums[k - 1] : 0));
        u8x16_store(out1, u8x16_running_sums(u8x16_load(a)));
        ASSERT_SAME(out1, sums);
        EACH(k, 8) wanted4[k] = a[k];
        i32x8_store(out4, i32x8_from_u8(a));
        ASSERT_SAME(out4, wanted4);
        EACH(k, 8) wanted4[k] = s[k];
        i32x8_store(out4, i32x8_from_i16(s));
        ASSERT_SAME(out4, wanted4);
        EACH(k, 8) s[k] = (int16_t)(k == (int)(i % 16) ? -1 : 0);
        assert_int_equal(i16x8_any(i16x8_load(s)), i % 16 < 8);
    }
}

static void rows_and_columns_are_exchanged(void **state)
{
    (void)state;
    f32x8 v[4];
    f32x4 w[4];
    EACH(r, 4) EACH(c, 8) v[r][c] = (float)(8 * r + c);
    EACH(r, 4) w[r] = f32x8_low(v[r]);
    f32x8_transpose(v);
    f32x4_transpose(w);
    EACH(r, 4) EACH(c, 8) assert_true(v[r][c] == (float)(8 * (c % 4) + r + c / 4 * 4));
    EACH(r, 4) EACH(c, 4) assert_true(w[r][c] == v[r][c]);
    const f32x8 joined = f32x8_join(w[1], w[0]);
    EACH(c, 4) assert_true(joined[c] == w[1][c] && joined[c + 4] == w[0][c] && f32x8_high(joined)[c] == w[0][c]);
    EACH(c, 4) assert_true(f32x4_abs(-w[0])[c] == w[0][c]);
    EACH(c, 8) assert_true(f32x8_abs(-joined)[c] == joined[c]);
}

static void denormal_numbers_count_as_0_where_asked(void **state)
{
    (void)state;
    volatile float small = 0x1p-126f;
    const uint64_t before = denormals_flush();
#if defined(__SSE2__) || defined(__aarch64__)
    assert_true(small * 0.5f == 0);
#endif
    denormals_restore(before);
    assert_true(small * 0.5f > 0);
}

int main(void)
{
    rng = rng_make(1, "lanes", "test");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(minima_and_maxima_take_the_second_of_equals),
        cmocka_unit_test(integers_are_least_for_nan_and_beyond_the_range),
        cmocka_unit_test(numbers_are_converted_and_rounded_exactly),
        cmocka_unit_test(halves_become_floats_and_are_rounded_to_even),
        cmocka_unit_test(masks_choose_lanes),
        cmocka_unit_test(bytes_and_short_numbers_keep_their_limits),
        cmocka_unit_test(rows_and_columns_are_exchanged),
        cmocka_unit_test(denormal_numbers_count_as_0_where_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
