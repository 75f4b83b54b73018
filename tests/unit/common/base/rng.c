/* rng.c - Philox against its published test vectors, keys, and the distribution. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"

/* From kat_vectors of Random123, the reference implementation. */
static void philox_matches_its_test_vectors(void **state)
{
    static const struct {
        uint32_t key[2];
        uint64_t high, low;
        uint32_t out[4];
    } cases[] = {
        {{0, 0}, 0, 0, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff}, UINT64_MAX, UINT64_MAX, {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0xa4093822, 0x299f31d0},
         0x0370734413198a2e,
         0x85a308d3243f6a88,
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };

    (void)state;
    for (int i = 0; i < 3; i++) {
        const struct rng rng = {{cases[i].key[0], cases[i].key[1]}};
        uint32_t out[4];
        rng_block(&rng, cases[i].high, cases[i].low, out);
        for (int k = 0; k < 4; k++)
            if (out[k] != cases[i].out[k])
                fail_msg("vector %d, word %d: %08x in place of %08x", i, k, out[k], cases[i].out[k]);
    }
}

static void numbers_come_from_blocks_in_order(void **state)
{
    const struct rng rng = rng_make(1, "stage", "view");
    uint32_t block[4];

    (void)state;
    rng_block(&rng, 77, 3, block);
    for (uint64_t k = 0; k < 4; k++) assert_int_equal(rng_u32(&rng, 77, 12 + k), block[k]);
    const double first = (double)(((uint64_t)block[1] << 32 | block[0]) >> 11) / 9007199254740992.0;
    assert_true(rng_uniform(&rng, 77, 6) == first);
    const struct rng ones = {{0xffffffff, 0xffffffff}};
    for (uint64_t i = 0; i < 1000; i++) assert_true(rng_uniform(&ones, 0, i) >= 0 && rng_uniform(&ones, 0, i) < 1);
}

static void seed_stage_and_view_change_the_key(void **state)
{
    const struct rng keys[] = {
        rng_make(1, "stage", "view"),  rng_make(2, "stage", "view"), rng_make(1, "stag", "eview"),
        rng_make(1, "stage", "view2"), rng_make(1, "", ""),          rng_make(1ull << 32, "stage", "view"),
    };

    (void)state;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < i; j++) assert_memory_not_equal(keys[i].key, keys[j].key, sizeof keys[i].key);
    const struct rng again = rng_make(1, "stage", "view");
    assert_memory_equal(keys[0].key, again.key, sizeof again.key);
}

/* Mean, variance, chi-squared over bins, correlation of neighbours along both counters; within four standard
 * deviations. */
static void uniform_numbers_are_uniform(void **state)
{
    enum { N = 100000, BINS = 64 };
    const struct rng rng = rng_make(42, "test", "uniform");
    double sum = 0, squares = 0, along = 0, across = 0, chi = 0;
    int bins[BINS] = {0};

    (void)state;
    for (uint64_t i = 0; i < N; i++) {
        const double u = rng_uniform(&rng, 5, i);
        sum += u;
        squares += (u - 0.5) * (u - 0.5);
        along += (u - 0.5) * (rng_uniform(&rng, 5, i + 1) - 0.5);
        across += (u - 0.5) * (rng_uniform(&rng, 6, i) - 0.5);
        bins[(int)(u * BINS)]++;
    }
    for (int b = 0; b < BINS; b++) chi += (bins[b] - (double)N / BINS) * (bins[b] - (double)N / BINS) * BINS / N;
    const double deviation = sqrt(1.0 / 12 / N);
    if (fabs(sum / N - 0.5) > 4 * deviation) fail_msg("mean %.6f", sum / N);
    if (fabs(squares / N - 1.0 / 12) > 4 * sqrt(1.0 / 180 / N)) fail_msg("variance %.6f", squares / N);
    if (fabs(along / N) > 4.0 / 12 / sqrt(N)) fail_msg("correlation along %.2e", along / N * 12);
    if (fabs(across / N) > 4.0 / 12 / sqrt(N)) fail_msg("correlation across %.2e", across / N * 12);
    if (fabs(chi - (BINS - 1)) > 4 * sqrt(2.0 * (BINS - 1))) fail_msg("chi-squared %.1f for %d", chi, BINS - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(philox_matches_its_test_vectors),
        cmocka_unit_test(numbers_come_from_blocks_in_order),
        cmocka_unit_test(seed_stage_and_view_change_the_key),
        cmocka_unit_test(uniform_numbers_are_uniform),
    };

    return cmocka_run_group_tests_name("rng", tests, NULL, NULL);
}
