/* sky_fit.c - the standard's skies, and which of them what is seen belongs to. */
#include "stages/bake_outdoors/sky_fit.h"

#include "tests/unit/scratch.h"

#include "common/math/numbers.h"

enum { MOST = 4096 };

static struct vec3 from_angles(double azimuth, double elevation)
{
    const double a = azimuth * DEGREE, e = elevation * DEGREE;
    return vec3_make(cos(e) * cos(a), cos(e) * sin(a), sin(e));
}

static const struct vec3 zenith = {0, 0, 1};

static void a_uniform_sky_is_the_same_everywhere(void **state)
{
    (void)state;
    for (int e = 0; e <= 90; e += 10)
        assert_true(fabs(sky_standard(SKY_UNIFORM, from_angles(e, e), from_angles(7, 30)) - 1) < 1e-12);
}

static void an_overcast_sky_is_three_times_as_bright_at_the_zenith(void **state)
{
    (void)state;
    const double horizon = sky_standard(1, from_angles(0, 0), zenith);
    assert_true(fabs(horizon - 1) < 1e-12);
    assert_true(fabs(sky_standard(1, zenith, zenith) - (1 + 4 * exp(-0.7))) < 1e-12);
}

static void a_clear_sky_is_brightest_at_the_sun_and_darkest_beside_the_zenith(void **state)
{
    (void)state;
    const struct vec3 to_sun = from_angles(20, 40);
    const double at_sun = sky_standard(12, to_sun, to_sun), opposite = sky_standard(12, from_angles(200, 50), to_sun);
    /* f = 1 + c (1 - exp(d pi / 2)) + e at the sun; 1 + c (exp(d pi / 2) - exp(d pi / 2)) + 0 a right angle away */
    const double f = 1 + 10 * (1 - exp(-3 * PI / 2)) + 0.45, phi = 1 - exp(-0.32 / sin(40 * DEGREE));
    assert_true(fabs(at_sun / (f * phi) - 1) < 1e-6); /* acos() near 1 */
    const double phi50 = 1 - exp(-0.32 / sin(50 * DEGREE));
    assert_true(fabs(opposite / phi50 - 1) < 1e-9);
}

/* Samples of a window: azimuths -50 to 50, elevations 3 to 40. */
static int look_out(struct sky_sample *samples, int type, struct vec3 to_sun, double noise)
{
    int count = 0;
    for (int a = -50; a <= 50; a += 3)
        for (int e = 3; e <= 40; e += 2) {
            struct sky_sample *s = &samples[count];
            *s = (struct sky_sample){.direction = from_angles(a, e), .weight = cos(e * DEGREE)};
            const double n = noise * ((count * 37 % 101) / 50.0 - 1);
            for (int c = 0; c < 3; c++) s->level[c] = log(2 + c) + log(sky_standard(type, s->direction, to_sun)) + n;
            count++;
        }
    return count;
}

static void the_type_is_found_with_the_sun_known(void **state)
{
    (void)state;
    struct sky_sample samples[MOST];
    const struct vec3 to_sun = from_angles(35, 40);
    for (int type = 7; type <= SKY_TYPES; type++) {
        struct sky_fit f;
        struct err err = ERR_INIT;
        const int count = look_out(samples, type, to_sun, 0.02);
        assert_ok(sky_fit_samples(&f, samples, count, &to_sun, &err), err);
        assert_int_equal(f.type, type);
        for (int c = 0; c < 3; c++) assert_true(fabs(f.level[c] - log(2 + c)) < 0.02);
    }
}

static void without_the_sun_a_sky_with_a_gradient_is_close(void **state)
{
    (void)state;
    struct sky_sample samples[MOST];
    const struct vec3 to_sun = from_angles(45, 40);
    struct sky_fit f;
    struct err err = ERR_INIT;
    const int count = look_out(samples, 12, to_sun, 0);
    assert_ok(sky_fit_samples(&f, samples, count, NULL, &err), err);
    assert_true(f.misfit < 0.06);
    assert_true(acos(vec3_dot(f.to_sun, to_sun)) < 40 * DEGREE);
}

static void a_sky_that_is_the_same_everywhere_is_believed(void **state)
{
    (void)state;
    struct sky_sample samples[MOST];
    struct sky_fit f;
    struct err err = ERR_INIT;
    double level[3];
    const int count = look_out(samples, SKY_UNIFORM, zenith, 0.1);
    assert_ok(sky_fit_samples(&f, samples, count, NULL, &err), err);
    assert_int_equal(f.type, SKY_UNIFORM);
    sky_fit_level(level, &f, zenith);
    assert_true(fabs(level[1] - log(3)) < 0.02);
}

static void nothing_seen_is_no_sky(void **state)
{
    (void)state;
    struct sky_fit f;
    struct err err = ERR_INIT;
    assert_ok(sky_fit_samples(&f, NULL, 0, NULL, &err), err);
    assert_int_equal(f.type, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_uniform_sky_is_the_same_everywhere),
        cmocka_unit_test(an_overcast_sky_is_three_times_as_bright_at_the_zenith),
        cmocka_unit_test(a_clear_sky_is_brightest_at_the_sun_and_darkest_beside_the_zenith),
        cmocka_unit_test(the_type_is_found_with_the_sun_known),
        cmocka_unit_test(without_the_sun_a_sky_with_a_gradient_is_close),
        cmocka_unit_test(a_sky_that_is_the_same_everywhere_is_believed),
        cmocka_unit_test(nothing_seen_is_no_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
