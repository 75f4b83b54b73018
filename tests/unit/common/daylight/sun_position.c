/* sun_position.c - the sun's place against published worked examples. */
#include "common/daylight/sun_position.h"

#include <math.h>

#include "tests/unit/scratch.h"

/* [Meeus 1998], example 7.a: Sputnik 1, 1957 October 4.81 is JD 2436116.31 */
static void a_date_has_its_julian_day(void **state)
{
    (void)state;
    assert_true(fabs(sun_days(&(struct sun_time){1957, 10, 4, 0.81 * 24}) + 2451545 - 2436116.31) < 1e-6);
    assert_true(fabs(sun_days(&(struct sun_time){2000, 1, 1, 12})) < 1e-9);
    assert_true(fabs(sun_days(&(struct sun_time){1999, 1, 1, 0}) + 2451545 - 2451179.5) < 1e-6);
    assert_true(fabs(sun_days(&(struct sun_time){1988, 6, 19, 12}) + 2451545 - 2447332) < 1e-6);
}

/* [Meeus 1998], example 25.a: 1992 October 13, 0 h; what it prints has five decimals */
static void coordinates_are_those_of_the_worked_example(void **state)
{
    (void)state;
    double right_ascension, declination, distance;
    sun_coordinates(sun_days(&(struct sun_time){1992, 10, 13, 0}), &right_ascension, &declination, &distance);
    assert_true(fabs(right_ascension - 198.38083) < 2e-5);
    assert_true(fabs(declination - -7.78507) < 2e-5);
    assert_true(fabs(distance - 0.99766) < 1e-5);
}

/* [Reda 2004], table A5.1: Golden, Colorado, 2003 October 17, 12:30:30; azimuth 194.34024, and 39.87205 degrees
 * without refraction (90 - 50.11162 - 0.01633) */
static void altitude_and_azimuth_are_those_of_a_precise_algorithm(void **state)
{
    const struct sun_place golden = {39.742476, -105.1786, -7};
    struct sun_position sun;
    (void)state;
    sun_position_find(&sun, &golden, &(struct sun_time){2003, 10, 17, 12 + 30.5 / 60});
    assert_true(fabs(sun.altitude - 39.87205) < 0.01);
    assert_true(fabs(sun.azimuth - 194.34024) < 0.01);
    assert_true(fabs(sun.distance - 0.9965423) < 1e-5);
}

/* On the equator at an equinox the sun passes the zenith; at the poles it stays at its declination. */
static void equinox_solstice_and_poles(void **state)
{
    struct sun_position sun;
    (void)state;
    /* equinox 2000 March 20, 7:35 UTC; the equation of time is -7.5 minutes: noon is at 12:07:30 of local mean time */
    sun_position_find(&sun, &(struct sun_place){0, 0, 0}, &(struct sun_time){2000, 3, 20, 12 + 7.5 / 60});
    assert_true(sun.altitude > 89.8);
    for (int hour = 0; hour < 24; hour += 3) {
        sun_position_find(&sun, &(struct sun_place){90, 0, 0}, &(struct sun_time){2000, 6, 21, hour});
        assert_true(fabs(sun.altitude - 23.44) < 0.01);
        sun_position_find(&sun, &(struct sun_place){-90, 0, 0}, &(struct sun_time){2000, 6, 21, hour});
        assert_true(fabs(sun.altitude + 23.44) < 0.01);
    }
}

static void morning_is_in_the_east_and_noon_in_the_south_or_north(void **state)
{
    struct sun_position sun;
    (void)state;
    sun_position_find(&sun, &(struct sun_place){52.5, 13.4, 1}, &(struct sun_time){2001, 3, 20, 6.25});
    assert_true(fabs(sun.azimuth - 90) < 3 && fabs(sun.altitude) < 3);
    sun_position_find(&sun, &(struct sun_place){52.5, 13.4, 1}, &(struct sun_time){2001, 12, 21, 12.07});
    assert_true(fabs(sun.azimuth - 180) < 1.5 && fabs(sun.altitude - (90 - 52.5 - 23.44)) < 0.05);
    sun_position_find(&sun, &(struct sun_place){-33.9, 151.2, 10}, &(struct sun_time){2001, 12, 21, 11.9});
    assert_true(sun.azimuth < 10 || sun.azimuth > 350);
}

static void days_count_around_the_year(void **state)
{
    int month, day;
    (void)state;
    assert_int_equal(sun_day_of_year(1, 1), 1);
    assert_int_equal(sun_day_of_year(2, 29), sun_day_of_year(3, 1));
    assert_int_equal(sun_day_of_year(12, 31), 365);
    for (int d = -364; d <= 730; d++) {
        sun_date_of_day(d, &month, &day);
        assert_int_equal((sun_day_of_year(month, day) - d) % 365, 0);
    }
    sun_date_of_day(60, &month, &day);
    assert_true(month == 3 && day == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_date_has_its_julian_day),
        cmocka_unit_test(coordinates_are_those_of_the_worked_example),
        cmocka_unit_test(altitude_and_azimuth_are_those_of_a_precise_algorithm),
        cmocka_unit_test(equinox_solstice_and_poles),
        cmocka_unit_test(morning_is_in_the_east_and_noon_in_the_south_or_north),
        cmocka_unit_test(days_count_around_the_year),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
