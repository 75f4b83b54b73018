/* Tests of common/math/ceres_curve_fit.h. */
#include "common/math/ceres_curve_fit.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { POINTS = 20 };

/* y = a exp(-b t), in blocks of one. */
struct decay {
    double y[POINTS];
};

static void evaluate(void *ctx, const double *x, double *residuals, double *jacobian)
{
    const struct decay *d = ctx;
    for (int i = 0; i < POINTS; i++) {
        const double t = 0.1 * i, e = exp(-x[1] * t);
        residuals[i] = x[0] * e - d->y[i];
        if (!jacobian) continue;
        jacobian[2 * i] = e;
        jacobian[2 * i + 1] = -t * x[0] * e;
    }
}

static struct decay exact(double a, double b)
{
    struct decay d;
    for (int i = 0; i < POINTS; i++) d.y[i] = a * exp(-b * 0.1 * i);
    return d;
}

static void it_finds_an_exact_solution(void **state)
{
    (void)state;
    struct decay d = exact(3, 1.7);
    const struct curve_fit fit = {2, POINTS, 1, evaluate, &d, NULL, NULL, 0, 50};
    struct curve_fit_outcome outcome;
    struct err err = ERR_INIT;
    double x[2] = {1, 0.5};
    assert_int_equal(ceres_curve_fit(&outcome, &fit, x, &err), ST_OK);
    assert_true(outcome.converged);
    assert_true(outcome.cost < 1e-16);
    assert_true(fabs(x[0] - 3) < 1e-7 && fabs(x[1] - 1.7) < 1e-7);
}

static void the_solution_stays_within_its_bounds(void **state)
{
    (void)state;
    struct decay d = exact(3, 1.7);
    const double lower[2] = {0, 0}, upper[2] = {2, INFINITY};
    const struct curve_fit fit = {2, POINTS, 1, evaluate, &d, lower, upper, 0, 50};
    struct curve_fit_outcome outcome;
    struct err err = ERR_INIT;
    double x[2] = {1, 0.5};
    assert_int_equal(ceres_curve_fit(&outcome, &fit, x, &err), ST_OK);
    assert_true(x[0] <= 2 && x[0] > 1.999);
    assert_true(x[1] < 1.7); /* a lower start falls more slowly */
}

static void an_outlier_moves_the_robust_solution_little(void **state)
{
    (void)state;
    struct decay d = exact(3, 1.7);
    d.y[7] += 5;
    struct curve_fit fit = {2, POINTS, 1, evaluate, &d, NULL, NULL, 0, 50};
    struct curve_fit_outcome outcome;
    struct err err = ERR_INIT;
    double plain[2] = {3, 1.7}, robust[2] = {3, 1.7};
    assert_int_equal(ceres_curve_fit(&outcome, &fit, plain, &err), ST_OK);
    fit.cauchy = 0.01;
    assert_int_equal(ceres_curve_fit(&outcome, &fit, robust, &err), ST_OK);
    assert_true(fabs(plain[1] - 1.7) > 0.1);
    assert_true(fabs(robust[0] - 3) < 1e-4 && fabs(robust[1] - 1.7) < 1e-4);
}

static void running_out_of_iterations_is_said(void **state)
{
    (void)state;
    struct decay d = exact(3, 1.7);
    const struct curve_fit fit = {2, POINTS, 1, evaluate, &d, NULL, NULL, 0, 1};
    struct curve_fit_outcome outcome;
    struct err err = ERR_INIT;
    double x[2] = {100, 9};
    assert_int_equal(ceres_curve_fit(&outcome, &fit, x, &err), ST_OK);
    assert_false(outcome.converged);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_finds_an_exact_solution),
        cmocka_unit_test(the_solution_stays_within_its_bounds),
        cmocka_unit_test(an_outlier_moves_the_robust_solution_little),
        cmocka_unit_test(running_out_of_iterations_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
