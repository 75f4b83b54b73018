/* sigma_bins.c - coverage of stated uncertainties, by fifths of the pixels. */
#include "stages/evaluate/views/sigma_bins.h"

#include <math.h>

#include "tests/unit/scratch.h"

static struct sigma_bins b;
static struct sigma_bin bins[SIGMA_BINS];

static void start(void)
{
    struct err err = ERR_INIT;
    assert_ok(sigma_bins_init(&b, &err), err);
}

static void finish(void)
{
    sigma_bins_get(&b, bins);
    sigma_bins_release(&b);
    sigma_bins_release(&b);
}

/* Ten pixels at each of five sigmas; at the k-th, k of them are within one sigma, and all but k within two. */
static void each_bin_has_its_own_coverage(void **state)
{
    (void)state;
    start();
    for (int k = 0; k < 5; k++)
        for (int i = 0; i < 10; i++) {
            const double sigma = 0.001 * pow(3, k);
            sigma_bins_add(&b, sigma, sigma * (i < k ? 1 : i < 10 - k ? 1.5 : 2.5));
        }
    finish();
    for (int k = 0; k < 5; k++) {
        assert_float_equal(bins[k].within[0], k / 10.0, 1e-9);
        assert_float_equal(bins[k].within[1], 1 - k / 10.0, 1e-9);
        assert_float_equal(bins[k].most / (0.001 * pow(3, k)), 1, 0.01);
    }
}

/* Errors that are uniform up to sqrt(3) sigma have the deviation sigma: 1 / sqrt(3) of them are within it. */
static void uniform_errors_of_many_sizes_are_covered_alike(void **state)
{
    enum { COUNT = 100000 };
    (void)state;
    start();
    for (int i = 0; i < COUNT; i++) {
        const double sigma = exp(-9 + 8 * fmod(i * 0.6180339887498949, 1));
        sigma_bins_add(&b, sigma, sqrt(3) * sigma * fmod(i * 0.7548776662466927, 1));
    }
    finish();
    for (int k = 0; k < SIGMA_BINS; k++) {
        assert_float_equal(bins[k].within[0], 1 / sqrt(3), 0.01);
        assert_float_equal(bins[k].within[1], 1, 1e-9);
        assert_float_equal(log(bins[k].most), -9 + 8 * (k + 1) / 5.0, 0.02);
    }
}

/* Where all sigmas are the same, the bins share the pixels. */
static void equal_sigmas_are_divided(void **state)
{
    (void)state;
    start();
    for (int i = 0; i < 7; i++) sigma_bins_add(&b, 0.01, i < 3 ? 0 : 1);
    finish();
    for (int k = 0; k < SIGMA_BINS; k++) assert_float_equal(bins[k].within[0], 3 / 7.0, 1e-9);
}

static void the_extremes_are_counted(void **state)
{
    (void)state;
    start();
    sigma_bins_add(&b, 0, 0);
    sigma_bins_add(&b, 0, 1e-9);
    sigma_bins_add(&b, 1e30, 1e30);
    sigma_bins_add(&b, 1e30, 3e30);
    sigma_bins_add(&b, 1e30, 1.5e30);
    finish();
    assert_float_equal(bins[0].within[0], 0.5, 1e-9);
    assert_float_equal(bins[1].within[1], 0.5, 1e-9);
    for (int k = 2; k < SIGMA_BINS; k++) {
        assert_float_equal(bins[k].within[0], 1 / 3.0, 1e-9);
        assert_float_equal(bins[k].within[1], 2 / 3.0, 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_bin_has_its_own_coverage),
        cmocka_unit_test(uniform_errors_of_many_sizes_are_covered_alike),
        cmocka_unit_test(equal_sigmas_are_divided),
        cmocka_unit_test(the_extremes_are_counted),
    };
    return cmocka_run_group_tests_name("sigma_bins", tests, NULL, NULL);
}
