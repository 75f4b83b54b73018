/* gamma_image.c - exposure, halving and sampling against values computed by hand. */
#include "stages/segment_depth/gamma_image.h"

#include "tests/unit/segment_depth/scene.h"

static const struct tone plain = {1, 0.5};

static void make(struct gamma_image *g, int width, int height, struct tone tone, float (*value)(int x, int y, int c))
{
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, width, height, 4, &err), ST_OK);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 4; c++) image_at(&im, x, y)[c] = value(x, y, c);
    assert_int_equal(gamma_image_make(g, &im, tone, &err), ST_OK);
    image_release(&im);
}

/* linear in gamma-encoded values, so that bilinear samples are exact */
static float ramp(int x, int y, int c)
{
    const float f = 0.1f + 0.03f * ((float)x + 0.5f) + 0.02f * ((float)y + 0.5f) + 0.05f * (float)c;
    return c < 3 ? f * f : 1;
}
static float holed(int x, int y, int c) { return c == 3 ? x != 2 || y != 1 : ramp(x, y, c); }
static float black(int x, int y, int c) { return c == 3 && x + y >= 0; }
static float wild(int x, int y, int c) { return c == 3 ? 1 : x == 0 ? NAN : x == 1 ? -3 : y ? 1e30f : INFINITY; }

static void samples_of_a_linear_ramp_are_exact(void **state)
{
    (void)state;
    struct gamma_image g;
    float rgb[3];
    make(&g, 9, 7, plain, ramp);
    for (int i = 0; i < 200; i++) {
        const double u = 0.5 + 8 * scene_hash(i, 0, 0), v = 0.5 + 6 * scene_hash(i, 0, 1);
        assert_true(gamma_image_at(&g, u, v, rgb));
        for (int c = 0; c < 3; c++) assert_near(rgb[c], 0.1 + 0.03 * u + 0.02 * v + 0.05 * c, 1e-6);
    }
    assert_true(gamma_image_at(&g, 0, 0, rgb) && gamma_image_at(&g, 9, 7, rgb)); /* the border is repeated */
    assert_near(rgb[0], 0.1 + 0.03 * 8.5 + 0.02 * 6.5, 1e-6);
    assert_false(gamma_image_at(&g, -0.001, 3, rgb) || gamma_image_at(&g, 3, 7.001, rgb) ||
                 gamma_image_at(&g, NAN, 3, rgb));
    gamma_image_release(&g);
    gamma_image_release(&g);
    gamma_image_release(NULL);
}

static void a_sample_needs_four_valid_pixels(void **state)
{
    (void)state;
    struct gamma_image g;
    float rgb[3];
    make(&g, 5, 4, plain, holed);
    assert_false(gamma_image_at(&g, 2.5, 1.5, rgb) || gamma_image_at(&g, 3.4, 2.4, rgb) ||
                 gamma_image_at(&g, 1.6, 0.6, rgb));
    assert_true(gamma_image_at(&g, 3.6, 2.6, rgb) && gamma_image_at(&g, 1.4, 1.5, rgb));
    gamma_image_release(&g);
}

static void halving_averages_and_keeps_one_pixel(void **state)
{
    (void)state;
    struct gamma_image g;
    struct err err = ERR_INIT;
    make(&g, 7, 5, plain, holed);
    assert_int_equal(gamma_image_halve(&g, &err), ST_OK);
    assert_true(g.width == 3 && g.height == 2);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(g.valid[i], i != 1);
        for (int c = 0; c < 3; c++)
            assert_near(g.rgb[c][i], 0.1 + 0.03 * (i % 3 * 2 + 1) + 0.02 * (i / 3 * 2 + 1) + 0.05 * c, 1e-6);
    }
    for (int k = 0; k < 3; k++) assert_int_equal(gamma_image_halve(&g, &err), ST_OK);
    assert_true(g.width == 1 && g.height == 1);
    gamma_image_release(&g);
}

/* One row of a hundred is a lamp; half of the others are bright, and the other half, with the median, `dark`. */
static struct tone tone_with(double bright, double dark)
{
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, 16, 100, 4, &err), ST_OK);
    for (int i = 0; i < 6400; i++)
        im.data[i] = i % 4 == 3 ? 1 : i < 64 ? 2000 * (float)bright : i / 4 % 16 < 7 ? (float)bright : (float)dark;
    const struct tone tone = gamma_tone_of(&im);
    image_release(&im);
    return tone;
}

static void the_tone_follows_the_bright_pixels_but_not_the_brightest(void **state)
{
    (void)state;
    static const double brights[] = {0.002, 1, 300};
    for (int k = 0; k < 3; k++)
        for (double ratio = 1; ratio > 1e-7; ratio /= 3) {
            const struct tone t = tone_with(brights[k], brights[k] * ratio);
            const double middle = pow(t.exposure * brights[k] * ratio, t.power);
            assert_near(pow(t.exposure * brights[k], t.power), 0.95, 1e-4);
            assert_true(t.power <= 0.5 && t.power >= 0.2);
            if (t.power > 0.2) assert_true(middle > 0.33); /* the curve is strong enough, */
            if (t.power < 0.5) assert_true(middle < 0.34); /* and no more */
        }
}

static void a_black_photo_has_exposure_1(void **state)
{
    (void)state;
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, 16, 100, 4, &err), ST_OK); /* no valid pixel */
    for (int k = 0; k < 2; k++) {
        assert_near(gamma_tone_of(&im).exposure, 1, 0);
        assert_near(gamma_tone_of(&im).power, 0.5, 0);
        for (int i = 3; i < 6400; i += 4) im.data[i] = 1; /* black */
    }
    image_release(&im);
    const struct tone lamp = tone_with(1, 0); /* half of the picture is black */
    assert_near(pow(lamp.exposure, lamp.power), 0.95, 1e-6);
}

static void a_change_of_exposure_is_a_factor_at_any_power(void **state)
{
    (void)state;
    struct gamma_image g[2];
    for (double power = 0.5; power > 0.15; power -= 0.15) {
        for (int k = 0; k < 2; k++) make(&g[k], 9, 7, (struct tone){k ? 0.5 : 1, power}, ramp);
        for (int i = 0; i < 63; i++) assert_near(g[1].rgb[1][i] / g[0].rgb[1][i], pow(0.5, power), 1e-5);
        assert_near(g[0].rgb[0][0], pow(0.125 * 0.125, power), 1e-6);
        for (int k = 0; k < 2; k++) gamma_image_release(&g[k]);
    }
}

static void values_are_between_0_and_1(void **state)
{
    (void)state;
    struct gamma_image g;
    make(&g, 4, 3, (struct tone){2, 0.5}, wild);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 12; i++) assert_true(g.rgb[c][i] >= 0 && g.rgb[c][i] <= 1);
    gamma_image_release(&g);
    make(&g, 4, 3, (struct tone){2, 0.5}, black);
    for (int i = 0; i < 12; i++) assert_near(g.rgb[1][i], 0, 0);
    gamma_image_release(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_of_a_linear_ramp_are_exact),
        cmocka_unit_test(a_sample_needs_four_valid_pixels),
        cmocka_unit_test(halving_averages_and_keeps_one_pixel),
        cmocka_unit_test(the_tone_follows_the_bright_pixels_but_not_the_brightest),
        cmocka_unit_test(a_black_photo_has_exposure_1),
        cmocka_unit_test(a_change_of_exposure_is_a_factor_at_any_power),
        cmocka_unit_test(values_are_between_0_and_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
