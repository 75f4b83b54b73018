/* The outdoors: radiance of the sun's disk and of the panorama, by direction. */
#include "tests/unit/common/light/near.h"

#include "common/light/frame.h"
#include "common/light/sky.h"
#include "common/math/numbers.h"

static struct vec3 direction(double azimuth, double elevation)
{
    const double az = azimuth * DEGREE, el = elevation * DEGREE;
    return vec3_make(cos(el) * cos(az), cos(el) * sin(az), sin(el));
}

static struct sky sky_of(const struct sky_params *params)
{
    struct sky sky;
    sky_init(&sky, params);
    return sky;
}

static const struct sky_params grey = {.has_panorama = true,
                                       .panorama = {.seed = 3, .sky = {2, 2, 2}, .ground = {0.5, 0.5, 0.5}}};

/* A disk of constant radiance L and angular radius a gives a surface that faces it the irradiance pi L sin^2 a. */
static void sun_disk_gives_its_irradiance(void **state)
{
    (void)state;
    enum { RINGS = 400, SECTORS = 64 };
    const struct sky_params params = {.has_sun = true, .sun = {-100, 40, 3, {5000, 4000, 3000}}};
    const struct sky sky = sky_of(&params);
    const struct vec3 centre = direction(-100, 40);
    struct rgb irradiance = {0, 0, 0};
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < SECTORS; k++) {
            const double a = 6 * DEGREE * (i + 0.5) / RINGS, da = 6 * DEGREE / RINGS; /* out to twice the radius */
            const struct rgb l = sky_radiance(&sky, frame_direction(centre, sin(a), cos(a), (k + 0.5) / SECTORS));
            irradiance = rgb_add(irradiance, rgb_scale(l, cos(a) * sin(a) * da * 2 * PI / SECTORS));
        }
    const double s = sin(3 * DEGREE);
    assert_near(irradiance.r, PI * 5000 * s * s, 1e-3);
    assert_near(irradiance.b, PI * 3000 * s * s, 1e-3);
}

static void without_sun_and_panorama_the_sky_is_black(void **state)
{
    (void)state;
    const struct sky_params none = {0}, black = {.has_panorama = true,
                                                 .panorama = {.seed = 7, .sky = {0, 0, 0}, .ground = {0, 0, 0}}};
    const struct sky a = sky_of(&none), b = sky_of(&black);
    for (int i = 0; i < 2000; i++) {
        const struct vec3 d = direction(i * 137.5, i % 180 - 90);
        assert_true(rgb_max(sky_radiance(&a, d)) == 0 && rgb_max(sky_radiance(&b, d)) == 0);
    }
}

/* Above buildings and trees a grey sky keeps its colour; clouds brighten it by at most 1.3. */
static void grey_sky_is_grey_above_the_skyline(void **state)
{
    (void)state;
    const struct sky sky = sky_of(&grey);
    double mean = 0;
    for (int i = 0; i < 2000; i++) {
        const struct rgb c = sky_radiance(&sky, direction(i * 137.5, 30 + i % 60));
        assert_true(c.r == c.g && c.g == c.b && c.r > 1.999 && c.r < 2.6);
        mean += c.r / 2000;
    }
    assert_true(mean < 2.3);
}

static void ground_varies_about_its_radiance(void **state)
{
    (void)state;
    const struct sky sky = sky_of(&grey);
    double mean = 0;
    for (int i = 0; i < 4000; i++) {
        const struct rgb c = sky_radiance(&sky, direction(i * 137.5, -10 - i % 70));
        assert_true(c.r >= 0.4 * 0.5 - 1e-9 && c.r <= 1.4 * 0.5 + 1e-9);
        mean += c.r / 4000;
    }
    assert_near(mean, 0.45, 0.1); /* 0.9 of the ground's radiance */
}

static void radiance_is_linear_in_sky_and_ground(void **state)
{
    (void)state;
    struct sky_params twice = grey;
    twice.panorama.sky = rgb_scale(grey.panorama.sky, 2);
    twice.panorama.ground = rgb_scale(grey.panorama.ground, 2);
    const struct sky a = sky_of(&grey), b = sky_of(&twice);
    for (int i = 0; i < 2000; i++) {
        const struct vec3 d = direction(i * 0.18, i % 180 - 90);
        assert_near(sky_radiance(&b, d).g, 2 * sky_radiance(&a, d).g, 1e-12);
    }
}

static void every_direction_has_a_finite_radiance(void **state)
{
    (void)state;
    struct sky_params params = grey;
    params.has_sun = true;
    params.sun = (struct sun){0, 90, 1, {10, 10, 10}};
    const struct sky sky = sky_of(&params);
    const struct vec3 hard[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {-1, -0.0, 0}, {0, 0, 1.0000000001}};
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
        const struct rgb c = sky_radiance(&sky, hard[i]);
        assert_true(isfinite(c.r) && isfinite(c.g) && isfinite(c.b) && c.r >= 0);
    }
    assert_true(sky_radiance(&sky, hard[0]).r >= 12); /* the sun adds to the sky */
}

/* Noise joins where the azimuth wraps around; the look on both sides of it is nearly the same. */
static void panorama_has_no_seam(void **state)
{
    (void)state;
    const struct sky sky = sky_of(&grey);
    for (int el = -80; el < 80; el++) {
        if (el >= 0 && el < 16) continue; /* buildings and leaves have edges of their own */
        const double a = sky_radiance(&sky, direction(180 - 1e-7, el)).g,
                     b = sky_radiance(&sky, direction(-180 + 1e-7, el)).g;
        assert_near(a, b, 1e-3);
    }
}

/* Skies of the CIE above a ground of their own: a horizontal surface has pi L under the uniform sky, and 7 pi / 9 of
 * the zenith's luminance under the traditional overcast one, whose horizon has a third of it. */
static void skies_of_the_cie_have_their_illuminance(void **state)
{
    enum { RINGS = 400, SECTORS = 32 };
    static const int types[] = {SKY_UNIFORM, SKY_TRADITIONAL, SKY_CLEAR};
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct sky_params params = {.has_panorama = true, .panorama = {0, {2, 3, 4}, {0.5, 0.25, 1}, true, {0}}};
        params.sun = (struct sun){30, 50, 0.27, {0, 0, 0}};
        params.panorama.shape = sky_standard_shape(types[k]);
        const struct sky sky = sky_of(&params);
        double sum = 0;
        for (int i = 0; i < RINGS; i++)
            for (int s = 0; s < SECTORS; s++) {
                const double up = sqrt((i + 0.5) / RINGS), turn = 360 * (s + 0.5) / SECTORS;
                const struct vec3 d = direction(turn, asin(up) / DEGREE);
                sum += PI * sky_radiance(&sky, d).g / (RINGS * SECTORS);
            }
        const double wanted[] = {3 * PI, 3 * 7 * PI / 9,
                                 3 * sky_shape_illuminance(&params.panorama.shape, sky.to_sun) / sky.at_zenith};
        assert_near(sum / wanted[k], 1, 2e-3);
        assert_near(sky_radiance(&sky, vec3_make(0, 0, 1)).b, 4, 1e-9);
        assert_near(sky_radiance(&sky, direction(77, -3)).r, 0.5, 1e-12);
        if (types[k] == SKY_TRADITIONAL) assert_near(sky_radiance(&sky, direction(77, 1e-9)).g, 1, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sun_disk_gives_its_irradiance),
        cmocka_unit_test(without_sun_and_panorama_the_sky_is_black),
        cmocka_unit_test(grey_sky_is_grey_above_the_skyline),
        cmocka_unit_test(ground_varies_about_its_radiance),
        cmocka_unit_test(radiance_is_linear_in_sky_and_ground),
        cmocka_unit_test(every_direction_has_a_finite_radiance),
        cmocka_unit_test(panorama_has_no_seam),
        cmocka_unit_test(skies_of_the_cie_have_their_illuminance),
    };
    return cmocka_run_group_tests_name("light sky", tests, NULL, NULL);
}
