/* The quotient of light: exact where nothing changes, bounded where the albedo would be more than any surface has. */
#include <float.h>

#include "common/math/numbers.h"
#include "common/relight/light_quotient.h"
#include "tests/unit/common/light/near.h"

static double of(double before, double after, double radiance, bool *bounded)
{
    const struct rgb q = light_quotient(rgb_grey(before), rgb_grey(after), rgb_grey(radiance), bounded);
    assert_true(q.r == q.g && q.g == q.b);
    return q.r;
}

static void equal_light_gives_exactly_one(void **state)
{
    static const double light[] = {0, 1e-300, 1e-9, 0.1, 1.0 / 3, 7, 1e9};
    (void)state;
    for (size_t i = 0; i < sizeof light / sizeof *light; i++)
        for (size_t k = 0; k < sizeof light / sizeof *light; k++) {
            bool bounded = false;
            assert_true(of(light[i], light[i], light[k], &bounded) == 1);
            assert_false(bounded);
        }
}

static void a_surface_that_can_be_is_multiplied(void **state)
{
    bool bounded = false;
    (void)state;
    assert_near(of(2, 5, 0.5, &bounded), 2.5, 1e-15);
    assert_near(of(2, 0.5, 0.5, &bounded), 0.25, 1e-15);
    assert_near(of(1e-2, 1e2, 1e-3, &bounded), 1e4, 1e-12);
    assert_near(of(2, 4, 0, &bounded), 2, 1e-15);
    assert_false(bounded);
}

static void a_surface_brighter_than_white_reflects_white_more_and_all_of_less(void **state)
{
    bool bounded = false;
    const double before = 1, radiance = 3; /* an albedo of 3 pi */
    (void)state;
    assert_near(radiance * of(before, 0.25, radiance, &bounded), 0.75, 1e-15);
    assert_false(bounded);
    assert_near(radiance * of(before, 5, radiance, &bounded), 3 + 0.95 * 4 / PI, 1e-15);
    assert_true(bounded);
}

static void without_light_before_light_is_added(void **state)
{
    bool bounded = false;
    (void)state;
    assert_near(0.3 * of(0, 2, 0.3, &bounded), 0.3 + 0.95 * 2 / PI, 1e-15);
    assert_true(bounded);
}

static void both_rules_agree_where_they_meet(void **state)
{
    const double before = 1.7, radiance = 0.95 * before / PI;
    (void)state;
    for (double after = 1.7; after < 20; after += 0.5)
        assert_near(of(before, after, radiance * (1 + 1e-9), NULL), of(before, after, radiance * (1 - 1e-9), NULL),
                    1e-8);
}

static void all_quotients_are_finite_numbers(void **state)
{
    static const double x[] = {0, DBL_MIN / 4, DBL_MIN, 1e-45, 1e-30, 1e-9, 1, 65504, 1e30};
    const int n = sizeof x / sizeof *x;
    (void)state;
    for (int i = 0; i < n * n * n; i++) {
        const double q = of(x[i % n], x[i / n % n], x[i / n / n], NULL);
        assert_true(q >= 0 && isfinite((float)q) && isfinite(q * x[i / n / n]));
    }
}

static void the_albedo_that_light_and_radiance_imply(void **state)
{
    (void)state;
    assert_near(light_albedo(rgb_grey(2), rgb_grey(0.5)).g, 0.25 * PI, 1e-15);
    assert_true(isinf(light_albedo(rgb_grey(0), rgb_grey(0.5)).g));
    assert_true(light_albedo(rgb_grey(0), rgb_grey(0)).g == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_light_gives_exactly_one),
        cmocka_unit_test(a_surface_that_can_be_is_multiplied),
        cmocka_unit_test(a_surface_brighter_than_white_reflects_white_more_and_all_of_less),
        cmocka_unit_test(without_light_before_light_is_added),
        cmocka_unit_test(both_rules_agree_where_they_meet),
        cmocka_unit_test(all_quotients_are_finite_numbers),
        cmocka_unit_test(the_albedo_that_light_and_radiance_imply),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
