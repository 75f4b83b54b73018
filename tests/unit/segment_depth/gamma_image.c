/* gamma_image.c - exposure, halving and sampling against sums done by hand. */
#include "stages/segment_depth/gamma_image.h"

#include "tests/unit/segment_depth/scene.h"

static void make(struct gamma_image *g, int width, int height, double exposure, float (*value)(int x, int y, int c))
{
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, width, height, 4, &err), ST_OK);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 4; c++) image_at(&im, x, y)[c] = value(x, y, c);
    assert_int_equal(gamma_image_make(g, &im, exposure, &err), ST_OK);
    image_release(&im);
}

/* a plane in gamma-encoded values, so that bilinear samples are exact */
static float ramp(int x, int y, int c)
{
    const float f = 0.1f + 0.03f * ((float)x + 0.5f) + 0.02f * ((float)y + 0.5f) + 0.05f * (float)c;
    return c < 3 ? f * f : 1;
}
static float holed(int x, int y, int c) { return c == 3 ? x != 2 || y != 1 : ramp(x, y, c); }
static float mostly_dark(int x, int y, int c) { return c == 3 ? 1 : y == 0 ? 4 : x < 8 ? 0.002f : 0.001f; }
static float black(int x, int y, int c) { return c == 3 && x + y >= 0; }
static float wild(int x, int y, int c) { return c == 3 ? 1 : x == 0 ? NAN : x == 1 ? -3 : y ? 1e30f : INFINITY; }

static void a_sample_of_a_plane_is_exact(void **state)
{
    (void)state;
    struct gamma_image g;
    float rgb[3];
    make(&g, 9, 7, 1, ramp);
    for (int i = 0; i < 200; i++) {
        const double u = 0.5 + 8 * scene_hash(i, 0, 0), v = 0.5 + 6 * scene_hash(i, 0, 1);
        assert_true(gamma_image_at(&g, u, v, rgb));
        for (int c = 0; c < 3; c++) assert_near(rgb[c], 0.1 + 0.03 * u + 0.02 * v + 0.05 * c, 1e-6);
    }
    assert_true(gamma_image_at(&g, 0, 0, rgb) && gamma_image_at(&g, 9, 7, rgb)); /* the rim repeats */
    assert_near(rgb[0], 0.1 + 0.03 * 8.5 + 0.02 * 6.5, 1e-6);
    assert_false(gamma_image_at(&g, -0.001, 3, rgb) || gamma_image_at(&g, 3, 7.001, rgb) ||
                 gamma_image_at(&g, NAN, 3, rgb));
    gamma_image_release(&g);
    gamma_image_release(&g);
    gamma_image_release(NULL);
}

static void a_sample_needs_all_its_pixels(void **state)
{
    (void)state;
    struct gamma_image g;
    float rgb[3];
    make(&g, 5, 4, 1, holed);
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
    make(&g, 7, 5, 1, holed);
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

static void exposure_follows_the_bright_pixels_but_not_the_brightest(void **state)
{
    (void)state;
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, 16, 100, 4, &err), ST_OK); /* one row in a hundred is a lamp */
    for (int i = 0; i < 6400; i++) im.data[i] = mostly_dark(i / 4 % 16, i / 64, i % 4);
    assert_near(exposure_of(&im) * 0.002 / (0.95 * 0.95), 1, 1e-5);
    memset(im.data, 0, 6400 * sizeof *im.data); /* no pixel at all */
    assert_near(exposure_of(&im), 1, 0);
    for (int i = 3; i < 6400; i += 4) im.data[i] = 1; /* black */
    assert_near(exposure_of(&im), 1, 0);
    image_release(&im);
}

static void values_are_between_0_and_1(void **state)
{
    (void)state;
    struct gamma_image g;
    make(&g, 4, 3, 2, wild);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 12; i++) assert_true(g.rgb[c][i] >= 0 && g.rgb[c][i] <= 1);
    gamma_image_release(&g);
    make(&g, 4, 3, 2, black);
    for (int i = 0; i < 12; i++) assert_near(g.rgb[1][i], 0, 0);
    gamma_image_release(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sample_of_a_plane_is_exact),
        cmocka_unit_test(a_sample_needs_all_its_pixels),
        cmocka_unit_test(halving_averages_and_keeps_one_pixel),
        cmocka_unit_test(exposure_follows_the_bright_pixels_but_not_the_brightest),
        cmocka_unit_test(values_are_between_0_and_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
