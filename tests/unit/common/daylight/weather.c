/* weather.c - reader of EnergyPlus weather files. */
#include "common/daylight/weather.h"

#include <math.h>

#include "tests/unit/scratch.h"

#define LOCATION "LOCATION,Berlin,-,DEU,IWEC Data,103840,52.47,13.40,1.0,49.0\n"
#define HEADER \
    LOCATION "DESIGN CONDITIONS,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n"
/* year, month, day, hour, minute, flags, dry bulb, dew point, six more, direct normal, diffuse horizontal, ... */
#define RECORD(when, dew, direct, diffuse) \
    when ",60,C9C9C9,5.0," dew ",90,100000,0,0,300,0," direct "," diffuse ",0,0,0,0,180,2.0\n"

static void read_it(struct weather *w, const char *text, struct err *err)
{
    char path[512];
    scratch_write("weather.epw", text);
    snprintf(path, sizeof path, "%s/weather.epw", scratch);
    weather_read(w, path, NULL, err);
}

static void a_file_gives_place_and_hours(void **state)
{
    struct weather w;
    struct err err = ERR_INIT;
    (void)state;
    read_it(&w, HEADER RECORD("1987, 6,21,12", "11.5", "650", "120") RECORD("1987,6,21,13", "99.9", "9999", "80"),
            &err);
    assert_int_equal(err.status, ST_OK);
    assert_string_equal(w.place, "Berlin, DEU");
    assert_true(w.at.latitude == 52.47 && w.at.longitude == 13.4 && w.at.time_zone == 1 && w.elevation == 49);
    assert_int_equal(w.count, 2);
    assert_int_equal(w.missing, 1);
    const struct weather_hour *h = w.hours;
    assert_true(h->middle.year == 1987 && h->middle.month == 6 && h->middle.day == 21 && h->middle.hour == 11.5);
    assert_true(h->sky.direct_normal == 650 && h->sky.diffuse_horizontal == 120 && h->sky.dew_point == 11.5);
    assert_true(h[1].sky.direct_normal == 0 && h[1].sky.diffuse_horizontal == 80);
    assert_true(h[1].sky.dew_point == DEW_POINT_TYPICAL);
    weather_release(&w);
    weather_release(&w);
}

static void an_hour_has_its_sun(void **state)
{
    struct weather w;
    struct sun_position sun;
    struct err err = ERR_INIT;
    (void)state;
    read_it(&w, HEADER RECORD("1987, 6,21,13", "11.5", "650", "120"), &err);
    assert_int_equal(err.status, ST_OK);
    /* Berlin at the solstice, half an hour after noon: the sun is up by about 90 - 52.47 + 23.44 = 60.97 degrees */
    sun_position_find(&sun, &w.at, &w.hours->middle);
    assert_true(sun.altitude > 60.5 && sun.altitude < 60.97 && sun.azimuth > 180 && sun.azimuth < 195);
    const struct sky_luminance s = sky_from_weather(&w.hours->sky, &sun, 0, 0.2);
    assert_true(sky_horizontal_illuminance(&s) > 60000 && sky_horizontal_illuminance(&s) < 90000);
    weather_release(&w);
}

static void fails(const char *text, const char *expected)
{
    struct weather w;
    struct err err = ERR_INIT;
    read_it(&w, text, &err);
    assert_int_equal(err.status, ST_DATA);
    if (!strstr(err.text, expected)) fail_msg("%s\nwanted: %s", err.text, expected);
    assert_true(!w.hours && !w.place);
}

static void errors_name_line_and_field(void **state)
{
    (void)state;
    fails("", "found an empty file, wanted a line LOCATION");
    fails("PLACE,Berlin\n", "weather.epw:1: found \"PLACE\", wanted a line LOCATION");
    fails("LOCATION,Berlin\n", "weather.epw:1: ");
    fails("LOCATION,a,b,c,d,e,95,0,0,0\n", "found \"95\", wanted the latitude in degrees, a number from -90 to 90");
    fails(LOCATION "DATA PERIODS,1,4,Data,Sunday,1/1,12/31\n", ":2: found \"4\", wanted 1 record an hour");
    fails(LOCATION, "found the end of the file, wanted a line DATA PERIODS");
    fails(HEADER, "wanted a record of an hour");
    fails(HEADER "1987,1,1,1\n", ":5: found the end of the line, wanted a record of at least 16 fields");
    fails(HEADER RECORD("1987,13,1,1", "1", "0", "0"), ":5: found \"13\", wanted the month, an integer from 1 to 12");
    fails(HEADER RECORD("1987,1,1,1", "1", "x", "0"), "found \"x\", wanted the direct normal irradiance in W/m2");
    fails(HEADER RECORD("1987,1,1,1", "1", "9999", "0"), "none of its 1 hours has direct normal");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_gives_place_and_hours),
        cmocka_unit_test(an_hour_has_its_sun),
        cmocka_unit_test(errors_name_line_and_field),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
