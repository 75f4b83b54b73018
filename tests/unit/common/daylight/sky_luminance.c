/* sky_luminance.c - skies in absolute units, against closed forms and figures worked out by hand. */
#include "common/daylight/sky_luminance.h"

#include <stdlib.h>

#include "tests/unit/scratch.h"

#include "common/math/numbers.h"

static const struct vec3 zenith = {0, 0, 1};

static bool near(double a, double b, double part) { return fabs(a - b) <= part * fabs(b); }

static struct sun_position sun_at(double altitude) { return (struct sun_position){altitude, 150, 1}; }

/* The horizontal illuminance by a fine grid over altitude and azimuth, another way than the library's. */
static double by_grid(const struct sky_luminance *s)
{
    double sum = 0;
    for (int row = 0; row < 180; row++)
        for (int column = 0; column < 360; column++) {
            const double up = (row + 0.5) * 0.5, z = sin(up * DEGREE);
            sum += sky_luminance_at(s, sky_compass_direction(0, column + 0.5, up)) * z * cos(up * DEGREE);
        }
    return sum * 0.5 * DEGREE * DEGREE;
}

/* The traditional overcast sky: E = 7/9 pi Lz. */
static void an_overcast_sky_has_its_closed_form(void **state)
{
    const struct sky_luminance s = sky_of_type(SKY_TRADITIONAL, zenith, 10000, 0, 0.2);
    (void)state;
    const double lz = sky_luminance_at(&s, zenith);
    assert_true(near(lz, 10000 * 9 / (7 * PI), 1e-4));
    assert_true(near(sky_luminance_at(&s, vec3_make(1, 0, 0)), lz / 3, 1e-9));
    assert_true(near(sky_luminance_at(&s, vec3_make(0, 0, -1)), 0.2 * 10000 / PI, 1e-9));
    assert_true(near(sky_horizontal_illuminance(&s), 10000, 1e-12));
}

static void a_uniform_sky_lights_by_pi_times_its_luminance(void **state)
{
    const struct sky_luminance s = sky_of_type(SKY_UNIFORM, zenith, 1000 * PI, 0, 0);
    (void)state;
    assert_true(near(sky_luminance_at(&s, vec3_make(0.6, 0, 0.8)), 1000, 1e-9));
}

static void every_type_has_the_illuminance_asked_for(void **state)
{
    (void)state;
    for (int type = 1; type <= SKY_TRADITIONAL; type++)
        for (int altitude = 5; altitude <= 85; altitude += 40) {
            const struct sky_luminance s = sky_of_type(type, sky_compass_direction(0, 77, altitude), 20000, 50000, 0.2);
            assert_true(near(by_grid(&s), 20000, 1e-3));
        }
}

/* By hand: overcast at 30 degrees, 0.3 + 21 sin 30 = 10.8 klx; clear, 0.8 + 15.5 sqrt(0.5) = 11.760 klx, and the sun
 * 127.5 exp(-0.21 / 0.5) = 83.77 klx; partly, 22.8 klx and 25.74 klx. */
static void usual_skies_have_the_published_levels(void **state)
{
    const struct sun_position sun = sun_at(30), night = sun_at(-1);
    (void)state;
    assert_true(near(sky_of_cover(SKY_COVER_OVERCAST, &sun, 0, 0.2).diffuse, 10800, 1e-9));
    assert_true(sky_of_cover(SKY_COVER_OVERCAST, &sun, 0, 0.2).sun == 0);
    assert_true(near(sky_of_cover(SKY_COVER_CLEAR, &sun, 0, 0.2).diffuse, 11760.2, 1e-5));
    assert_true(near(sky_of_cover(SKY_COVER_CLEAR, &sun, 0, 0.2).sun, 83773, 1e-4));
    assert_true(near(sky_of_cover(SKY_COVER_PARTLY, &sun, 0, 0.2).diffuse, 22800, 1e-9));
    assert_true(near(sky_of_cover(SKY_COVER_PARTLY, &sun, 0, 0.2).sun, 25742, 1e-4));
    assert_true(sky_horizontal_illuminance(&(struct sky_luminance){0}) == 0);
    assert_true(sky_horizontal_illuminance((struct sky_luminance[]){sky_of_cover(SKY_COVER_CLEAR, &night, 0, 0.2)}) ==
                0);
}

static void all_weather_skies_have_their_illuminance(void **state)
{
    static const double direct[] = {0, 20, 100, 200, 300, 500, 800, 900},
                        diffuse[] = {100, 150, 200, 200, 150, 120, 90, 60};
    (void)state;
    for (size_t i = 0; i < 8; i++)
        for (int altitude = 10; altitude <= 70; altitude += 30) {
            const struct sun_position sun = sun_at(altitude);
            const struct sky_luminance s =
                sky_from_weather(&(struct sky_weather){direct[i], diffuse[i], DEW_POINT_TYPICAL}, &sun, 20, 0.2);
            assert_true(near(by_grid(&s), s.diffuse, 1e-3));

            /* daylight has 90 to 160 lm/W in the sky, and up to 125 in the sun */
            assert_true(s.diffuse > 90 * diffuse[i] && s.diffuse < 165 * diffuse[i]);
            assert_true(s.sun >= 0 && s.sun <= 125 * direct[i]);
            for (int a = 0; a < 360; a += 30) assert_true(sky_luminance_at(&s, sky_compass_direction(0, a, 3)) >= 0);
        }
}

/* By hand, with the sun at 30 degrees and 100 W/m2 of diffuse light alone: clearness 1, the first class; Z = 1.0472,
 * air mass 1 / (0.5 + 0.15 x 33.885^-1.253) = 1.99276, brightness 100 x 1.99276 / 1367 = 0.145776; W = exp(0.695) =
 * 2.00371; efficacy 97.24 - 0.46 W + 12 x 0.5 - 8.91 ln 0.145776 = 119.476: 11947.6 lx. The gradation: a = 1.3525 -
 * 0.2576 Z + 0.145776 (-0.269 - 1.4366 Z) = 0.824217 and b = -0.767 + 0.0007 Z + 0.145776 (1.2734 - 0.1233 Z) =
 * -0.599458; the indicatrix: c = exp((0.145776 (2.8 + 0.6004 Z))^1.2375) - 1 = 0.527951, d = -exp(0.145776 (1.8734 +
 * 0.6297 Z)) + 0.9738 + 0.145776 x 0.2809 = -0.431865, e = 0.0356 - 0.1246 Z + 0.145776 (-0.5718 + 0.9938 Z) =
 * -0.026526. */
static void the_cloudiest_class_is_as_worked_out_by_hand(void **state)
{
    const struct sun_position sun = sun_at(30);
    const struct sky_luminance s = sky_from_weather(&(struct sky_weather){0, 100, DEW_POINT_TYPICAL}, &sun, 0, 0.2);
    (void)state;
    assert_true(near(s.diffuse, 11947.6, 1e-4));
    assert_true(s.sun == 0);
    assert_true(near(s.shape.a, 0.824217, 1e-4));
    assert_true(near(s.shape.b, -0.599458, 1e-4));
    assert_true(near(s.shape.c, 0.527951, 1e-4));
    assert_true(near(s.shape.d, -0.431865, 1e-4));
    assert_true(near(s.shape.e, -0.026526, 1e-3));
    const double ratio = sky_luminance_at(&s, zenith) / sky_luminance_at(&s, s.to_sun);
    const double chi = 60 * DEGREE, f = 1 + s.shape.c * exp(s.shape.d * chi) + s.shape.e * 0.25;
    assert_true(near(ratio,
                     (1 + s.shape.a * exp(s.shape.b)) * f /
                         ((1 + s.shape.a * exp(s.shape.b * 2)) * (1 + s.shape.c + s.shape.e)),
                     1e-6));
}

/* By hand: 800 and 90 W/m2, sun at 60 degrees: Z = 0.523599, Z^3 1.041 = 0.149431; clearness (1 + 8.88889 + 0.149431) /
 * 1.149431 = 8.7333, the clearest class; air mass 1.15361; brightness 0.075951; the sun's efficacy 101.18 + 1.58 x
 * 2.00371 - 1.1 exp(3.00022 - 5) - 8.29 x 0.075951 = 103.567. */
static void a_clear_sun_is_as_worked_out_by_hand(void **state)
{
    const struct sun_position sun = sun_at(60);
    const struct sky_luminance s = sky_from_weather(&(struct sky_weather){800, 90, DEW_POINT_TYPICAL}, &sun, 0, 0.2);
    (void)state;
    assert_true(near(s.sun, 800 * 103.567, 1e-4));
    assert_true(near(sky_horizontal_illuminance(&s), s.diffuse + s.sun * sin(60 * DEGREE), 1e-12));
    /* the disk: its luminance times pi sin^2 of its radius is the illuminance */
    assert_true(near(sky_sun_luminance(&s) * 6.797e-5, s.sun, 1e-3));
    assert_true(sky_luminance_at(&s, s.to_sun) > 5 * sky_luminance_at(&s, zenith));
}

/* A file may hold what no sky has: brightness counts up to 0.6. */
static void impossible_weather_gives_finite_light(void **state)
{
    static const double diffuse[] = {1e-9, 0.5, 50, 1000, 9998};
    (void)state;
    for (int i = 0; i < 5; i++)
        for (int direct = 0; direct <= 9000; direct += 3000)
            for (int altitude = -1; altitude <= 90; altitude += 13) {
                const struct sun_position sun = sun_at(altitude);
                const struct sky_luminance s =
                    sky_from_weather(&(struct sky_weather){direct, diffuse[i], direct ? -99 : 90}, &sun, 0, 0.2);
                const double at_sun = sky_luminance_at(&s, sun.altitude < 0 ? vec3_make(1, 0, 0) : s.to_sun);
                assert_true(s.diffuse >= 0 && s.sun >= 0 && isfinite(at_sun) && isfinite(s.ground));
                assert_true(s.diffuse <= 250 * diffuse[i]);
            }
}

static void night_is_black(void **state)
{
    struct sky_patches patches;
    struct err err = ERR_INIT;
    double luminance[146];
    const struct sun_position sun = sun_at(-30);
    const struct sky_luminance s = sky_from_weather(&(struct sky_weather){0, 0, DEW_POINT_TYPICAL}, &sun, 0, 0.2);
    (void)state;
    assert_ok(sky_patches_init(&patches, 1, 0, &err), err);
    sky_patch_luminances(luminance, &patches, &s);
    for (int p = 0; p < patches.count; p++) assert_true(luminance[p] == 0);
    assert_true(sky_sun_luminance(&s) == 0 && sky_luminance_at(&s, zenith) == 0);
    /* a sun that is up to the middle of the hour only: some diffuse light, finite luminances */
    const struct sun_position dusk = sun_at(-0.5);
    const struct sky_luminance t = sky_from_weather(&(struct sky_weather){50, 8, DEW_POINT_TYPICAL}, &dusk, 0, 0.2);
    assert_true(t.sun == 0 && t.diffuse > 0 && isfinite(sky_luminance_at(&t, zenith)));
}

static void patches_light_as_the_sky_does(void **state)
{
    const struct sun_position sun = sun_at(40);
    (void)state;
    for (int m = 1; m <= 4; m *= 2) {
        struct sky_patches patches;
        struct err err = ERR_INIT;
        assert_ok(sky_patches_init(&patches, m, 30, &err), err);
        double *luminance = calloc((size_t)patches.count, sizeof *luminance);
        assert_non_null(luminance);
        const struct sky_luminance skies[2] = {
            sky_of_type(SKY_TRADITIONAL, zenith, 10000, 0, 0.2),
            sky_from_weather(&(struct sky_weather){600, 100, DEW_POINT_TYPICAL}, &sun, 30, 0.2)};
        for (int k = 0; k < 2; k++) {
            double sum = 0;
            sky_patch_luminances(luminance, &patches, &skies[k]);
            for (int p = 1; p < patches.count; p++) sum += luminance[p] * sky_patch_projected(&patches, p);
            assert_true(near(sum, skies[k].diffuse, 1e-12));
            assert_true(luminance[SKY_GROUND] == skies[k].ground);
        }
        /* the second sky is brightest in the patch of the sun; the first has 9 / (7 pi) E at the zenith */
        for (int p = 1; p < patches.count; p++)
            assert_true(luminance[p] <= luminance[sky_patch_at(&patches, skies[1].to_sun)]);
        sky_patch_luminances(luminance, &patches, &skies[0]);
        assert_true(near(luminance[patches.count - 1], 10000 * 9 / (7 * PI), 3e-3));
        free(luminance);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_overcast_sky_has_its_closed_form),
        cmocka_unit_test(a_uniform_sky_lights_by_pi_times_its_luminance),
        cmocka_unit_test(every_type_has_the_illuminance_asked_for),
        cmocka_unit_test(usual_skies_have_the_published_levels),
        cmocka_unit_test(all_weather_skies_have_their_illuminance),
        cmocka_unit_test(the_cloudiest_class_is_as_worked_out_by_hand),
        cmocka_unit_test(a_clear_sun_is_as_worked_out_by_hand),
        cmocka_unit_test(impossible_weather_gives_finite_light),
        cmocka_unit_test(night_is_black),
        cmocka_unit_test(patches_light_as_the_sky_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
