/* Scrambled Sobol' numbers: uniform, stratified, different in every pixel, and better than independent numbers. */
#include "tests/unit/common/light/near.h"

#include "common/light/sobol.h"

static void each_dimension_is_stratified(void **state)
{
    (void)state;
    enum { SAMPLES = 256 };
    const struct rng rng = rng_make(3, "test", "sobol");
    for (uint64_t pixel = 0; pixel < 200; pixel++) {
        struct sobol s = sobol_make(&rng, pixel, SAMPLES);
        bool taken[4][SAMPLES] = {{false}};
        for (; s.sample < SAMPLES; s.sample++) {
            double u[4];
            sobol_group(&s, 5, u);
            for (int d = 0; d < 4; d++) {
                assert_true(u[d] >= 0 && u[d] < 1);
                assert_false(taken[d][(int)(SAMPLES * u[d])]); /* one number in each interval */
                taken[d][(int)(SAMPLES * u[d])] = true;
            }
        }
    }
}

/* The first two dimensions are a (0, 2)-sequence: every rectangle 2^-k by 2^(k - 6) of the grid holds one of 64
 * points. */
static void first_two_dimensions_fill_all_elementary_intervals(void **state)
{
    (void)state;
    const struct rng rng = rng_make(4, "test", "sobol");
    for (uint64_t pixel = 0; pixel < 100; pixel++)
        for (int k = 0; k <= 6; k++) {
            struct sobol s = sobol_make(&rng, pixel, 64);
            bool taken[64] = {false};
            for (; s.sample < 64; s.sample++) {
                double u[4];
                sobol_group(&s, 0, u);
                const int cell = (int)(u[0] * (1 << k)) + (int)(u[1] * (64 >> k)) * (1 << k);
                assert_false(taken[cell]);
                taken[cell] = true;
            }
        }
}

/* Over pixels, each sample alone is uniform: 16 000 of them in 16 bins; a bin's standard deviation is 31. */
static void each_number_alone_is_uniform(void **state)
{
    (void)state;
    enum { PIXELS = 16000 };
    const struct rng rng = rng_make(3, "test", "sobol");
    for (uint32_t sample = 0; sample < 3; sample++) {
        int bins[4][16] = {{0}};
        double mean[4] = {0};
        for (uint64_t pixel = 0; pixel < PIXELS; pixel++) {
            struct sobol s = sobol_make(&rng, pixel, 5); /* no power of two */
            double u[4];
            s.sample = sample;
            sobol_group(&s, 1, u);
            for (int d = 0; d < 4; d++) {
                bins[d][(int)(16 * u[d])]++;
                mean[d] += u[d] / PIXELS;
            }
        }
        for (int d = 0; d < 4; d++) {
            assert_near(mean[d], 0.5, 0.02);
            for (int i = 0; i < 16; i++) assert_near(bins[d][i], 1000, 0.16);
        }
    }
}

static void pixels_and_groups_are_uncorrelated(void **state)
{
    (void)state;
    enum { PIXELS = 20000 };
    const struct rng rng = rng_make(6, "test", "sobol");
    double neighbours = 0, groups = 0;
    for (uint64_t pixel = 0; pixel < PIXELS; pixel++) {
        const struct sobol a = sobol_make(&rng, pixel, 16), b = sobol_make(&rng, pixel + 1, 16);
        double u[4], v[4], w[4];
        sobol_group(&a, 0, u);
        sobol_group(&b, 0, v);
        sobol_group(&a, 1, w);
        neighbours += 12 * (u[0] - 0.5) * (v[0] - 0.5) / PIXELS;
        groups += 12 * (u[0] - 0.5) * (w[0] - 0.5) / PIXELS;
    }
    assert_true(fabs(neighbours) < 0.03 && fabs(groups) < 0.03); /* the standard deviation is 0.007 */
}

static void samples_beyond_the_set_are_new_points(void **state)
{
    (void)state;
    const struct rng rng = rng_make(3, "test", "sobol");
    struct sobol a = sobol_make(&rng, 1, 4), b = a;
    double u[4], v[4];
    for (a.sample = 0; a.sample < 4; a.sample++) {
        b.sample = a.sample + 4;
        sobol_group(&a, 0, u);
        sobol_group(&b, 0, v);
        assert_true(u[0] != v[0] && u[1] != v[1]);
    }
}

static void eight_at_a_time_are_the_same_numbers(void **state)
{
    (void)state;
    const struct rng rng = rng_make(3, "test", "sobol");
    for (int samples = 1; samples <= 64; samples *= 2) {
        const struct sobol first = sobol_make(&rng, 7, samples);
        for (uint32_t from = 0; from < 256; from += SOBOL_BATCH) {
            struct sobol s = first;
            double pairs[2][SOBOL_BATCH], u[4];
            s.sample = from;
            sobol_pairs(&s, 5, pairs);
            for (int k = 0; k < SOBOL_BATCH && k < samples; k++) {
                s.sample = from + (uint32_t)k;
                sobol_group(&s, 5, u);
                assert_true(pairs[0][k] == u[0] && pairs[1][k] == u[1]);
            }
        }
    }
}

/* The integral of x^2 y over the unit square is 1/6. With 256 samples, independent numbers have an RMS error of
 * 0.0132. */
static void integrals_converge_faster_than_with_independent_numbers(void **state)
{
    (void)state;
    enum { PIXELS = 400, SAMPLES = 256 };
    const struct rng rng = rng_make(9, "test", "sobol");
    double square = 0, bias = 0;
    for (uint64_t pixel = 0; pixel < PIXELS; pixel++) {
        struct sobol s = sobol_make(&rng, pixel, SAMPLES);
        double sum = 0;
        for (; s.sample < SAMPLES; s.sample++) {
            double u[4];
            sobol_group(&s, 0, u);
            sum += u[0] * u[0] * u[1] / SAMPLES;
        }
        square += (sum - 1.0 / 6) * (sum - 1.0 / 6) / PIXELS;
        bias += (sum - 1.0 / 6) / PIXELS;
    }
    assert_true(sqrt(square) < 0.0132 / 10);
    assert_true(fabs(bias) < 4 * sqrt(square / PIXELS)); /* unbiased */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_dimension_is_stratified),
        cmocka_unit_test(first_two_dimensions_fill_all_elementary_intervals),
        cmocka_unit_test(each_number_alone_is_uniform),
        cmocka_unit_test(pixels_and_groups_are_uncorrelated),
        cmocka_unit_test(samples_beyond_the_set_are_new_points),
        cmocka_unit_test(eight_at_a_time_are_the_same_numbers),
        cmocka_unit_test(integrals_converge_faster_than_with_independent_numbers),
    };
    return cmocka_run_group_tests_name("light sobol", tests, NULL, NULL);
}
