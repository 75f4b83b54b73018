/* lens_fit.c - verdicts on lens models from made-up residuals. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "stages/sfm_import/lens_fit.h"

enum { MAX_RESIDUALS = 20000 };
static const double DIAGONAL = 1000; /* px */

/* Normally distributed noise of 0.3 px in both directions, times 1 + growth r^2, plus `bias` px outwards beyond r =
 * 0.5. Radii up to max_radius, uniform over the disk. */
static size_t make(struct lens_residual *r, size_t count, double growth, double bias, double max_radius)
{
    const struct rng rng = rng_make(5, "lens_fit", "test");
    for (size_t i = 0; i < count; i++) {
        const double radius = max_radius * sqrt(rng_uniform(&rng, i, 0));
        const double length = 0.3 * sqrt(-2 * log(1 - rng_uniform(&rng, i, 1))) * (1 + growth * radius * radius);
        const double angle = 2 * M_PI * rng_uniform(&rng, i, 2);
        const double radial = length * cos(angle) + (radius > 0.5 ? bias : 0), across = length * sin(angle);
        r[i] = (struct lens_residual){radius, hypot(radial, across), radial};
    }
    return count;
}

static struct lens_fit measure(const struct lens_residual *r, size_t count)
{
    struct lens_fit fit;
    struct err err = ERR_INIT;
    assert_ok(lens_fit_measure(&fit, r, count, &err), err);
    return fit;
}

static void even_residuals_fit(void **state)
{
    (void)state;
    static struct lens_residual r[MAX_RESIDUALS];
    struct lens_fit fit = measure(r, make(r, MAX_RESIDUALS, 0, 0, 1));
    assert_true(fit.measured && fit.rim_radius == 1);
    assert_true(fabs(fit.middle - 0.353) < 0.03 && fabs(fit.rim - 0.353) < 0.03);
    assert_false(lens_fit_grows(&fit, DIAGONAL) || lens_fit_is_biased(&fit, DIAGONAL));
    fit = measure(r, make(r, MAX_RESIDUALS, 0.5, 0, 1)); /* the corners of real lenses are softer */
    assert_false(lens_fit_grows(&fit, DIAGONAL) || lens_fit_is_biased(&fit, DIAGONAL));
    for (size_t i = 0; i < MAX_RESIDUALS; i++) r[i] = (struct lens_residual){r[i].radius, 1e-12 * r[i].radius, 0};
    fit = measure(r, MAX_RESIDUALS); /* exact models of simulated scenes */
    assert_true(fit.measured);
    assert_false(lens_fit_grows(&fit, DIAGONAL) || lens_fit_is_biased(&fit, DIAGONAL));
}

static void residuals_that_grow_towards_the_rim_do_not_fit(void **state)
{
    (void)state;
    static struct lens_residual r[MAX_RESIDUALS];
    struct lens_fit fit = measure(r, make(r, 2000, 4, 0, 0.85));
    assert_true(lens_fit_grows(&fit, DIAGONAL));
    assert_true(fit.rim_radius == 0.9 && fit.rim > 3 * fit.middle);
    fit = measure(r, make(r, MAX_RESIDUALS, 4, 0, 1));
    assert_true(lens_fit_grows(&fit, DIAGONAL));
    assert_false(lens_fit_grows(&fit, 20 * DIAGONAL)); /* 1.4 px of 20000 px is little */
}

static void systematic_radial_residuals_do_not_fit(void **state)
{
    (void)state;
    static struct lens_residual r[MAX_RESIDUALS];
    struct lens_fit fit = measure(r, make(r, MAX_RESIDUALS, 0, -0.3, 1));
    assert_true(lens_fit_is_biased(&fit, DIAGONAL));
    assert_false(lens_fit_grows(&fit, DIAGONAL));
    assert_true(fit.bias < -0.25 && fit.bias_radius > 0.5);
}

static void outliers_do_not_count(void **state)
{
    (void)state;
    static struct lens_residual r[MAX_RESIDUALS];
    make(r, MAX_RESIDUALS, 0, 0, 1);
    for (size_t i = 0; i < MAX_RESIDUALS; i += 5)
        if (r[i].radius > 0.5) r[i].error = r[i].radial = 1e300;
    const struct lens_fit fit = measure(r, MAX_RESIDUALS);
    assert_false(lens_fit_grows(&fit, DIAGONAL) || lens_fit_is_biased(&fit, DIAGONAL));
}

static void few_observations_give_no_verdict(void **state)
{
    (void)state;
    static struct lens_residual r[MAX_RESIDUALS];
    static const size_t counts[] = {0, 1, 20, 100};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        const struct lens_fit fit = measure(r, make(r, counts[i], 10, 1, 1));
        assert_false(fit.measured || lens_fit_grows(&fit, DIAGONAL) || lens_fit_is_biased(&fit, DIAGONAL));
    }
    make(r, 1000, 10, 0, 0.15); /* all of them in the middle */
    assert_false(measure(r, 1000).measured);
    for (int i = 0; i < 1000; i++) r[i].radius = 0.9 + 1e-4 * i; /* or all at the rim */
    assert_false(measure(r, 1000).measured);
    r[0].radius = 1e300; /* an observation outside the picture */
    assert_false(measure(r, 1000).measured);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_residuals_fit),
        cmocka_unit_test(residuals_that_grow_towards_the_rim_do_not_fit),
        cmocka_unit_test(systematic_radial_residuals_do_not_fit),
        cmocka_unit_test(outliers_do_not_count),
        cmocka_unit_test(few_observations_give_no_verdict),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
