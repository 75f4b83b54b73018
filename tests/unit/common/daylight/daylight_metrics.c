/* daylight_metrics.c - figures of a year, worked out by hand. */
#include "common/daylight/daylight_metrics.h"

#include <math.h>

#include "tests/unit/scratch.h"

static void a_year_has_its_3650_hours(void **state)
{
    const struct daylight_hour first = daylight_hour(0), second_day = daylight_hour(10), last = daylight_hour(3649);
    (void)state;
    assert_true(first.month == 1 && first.day == 1 && first.middle == 8.5);
    assert_true(second_day.month == 1 && second_day.day == 2 && second_day.middle == 8.5);
    assert_true(last.month == 12 && last.day == 31 && last.middle == 17.5);
    assert_int_equal(daylight_hour_of_year(0), 8);
    assert_int_equal(daylight_hour_of_year(9), 17);
    assert_int_equal(daylight_hour_of_year(10), 32);
    assert_int_equal(daylight_hour_of_year(3649), 364 * 24 + 17);
}

/* Point 0: 300 lx in exactly half of the hours; 1000 lx of sun in 250. Point 1: one hour less, and one more. */
static void limits_are_those_of_the_standard(void **state)
{
    struct daylight_point points[2] = {0};
    struct daylight_sum s;
    (void)state;
    for (int k = 0; k < DAYLIGHT_HOURS; k++)
        for (int i = 0; i < 2; i++)
            daylight_point_add(&points[i], k < 1825 - i ? 300 : 299.9, k < 250 + i ? 1000 : 999);
    daylight_sum(&s, points, (const double[]){3, 1}, 2);
    assert_true(s.sda == 0.75 && s.ase == 0.25);
    assert_true(fabs(s.autonomy - (0.5 - 0.25 / 3650)) < 1e-12);
    assert_true(s.sun_hours == 3650);
    daylight_sum(&s, points, NULL, 2);
    assert_true(s.sda == 0.5 && s.ase == 0.5);
}

static void useful_light_has_four_classes(void **state)
{
    static const double lux[8] = {0, 99.9, 100, 299.9, 300, 3000, 3000.1, 1e5};
    struct daylight_point p = {0};
    struct daylight_sum s;
    (void)state;
    for (int k = 0; k < 8; k++) daylight_point_add(&p, lux[k], 0);
    daylight_sum(&s, &p, NULL, 1);
    for (int k = 0; k < DAYLIGHT_USES; k++) assert_true(s.use[k] == 0.25);
    assert_true(s.autonomy == 0.5 && s.sda == 1 && s.ase == 0 && s.sun_hours == 0);
    assert_true(fabs(p.sum - 106799.9) < 1e-6); /* 99.9 + 100 + 299.9 + 300 + 3000 + 3000.1 + 100000 */
}

static void spread_of_points(void **state)
{
    struct daylight_spread s;
    (void)state;
    daylight_spread(&s, (const double[]){200, 400, 600}, (const double[]){1, 1, 2}, 3);
    assert_true(s.mean == 450 && s.min == 200 && s.max == 600 && fabs(s.uniformity - 4.0 / 9) < 1e-12);
    daylight_spread(&s, (const double[]){0, 0}, NULL, 2);
    assert_true(s.mean == 0 && s.uniformity == 0);
    assert_true(daylight_factor(200, 10000) == 2 && daylight_factor(1, 0) == 0);
}

static void nothing_gives_nothing(void **state)
{
    struct daylight_point p = {0};
    struct daylight_sum s;
    struct daylight_spread spread;
    (void)state;
    daylight_sum(&s, &p, NULL, 1);
    assert_true(s.sda == 0 && s.use[USE_FALLS_SHORT] == 0);
    daylight_sum(&s, NULL, NULL, 0);
    daylight_spread(&spread, NULL, NULL, 0);
    assert_true(s.ase == 0 && spread.mean == 0 && spread.min == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_year_has_its_3650_hours),     cmocka_unit_test(limits_are_those_of_the_standard),
        cmocka_unit_test(useful_light_has_four_classes), cmocka_unit_test(spread_of_points),
        cmocka_unit_test(nothing_gives_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
