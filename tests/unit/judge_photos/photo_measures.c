/* photo_measures.c - widths of edges, white, black and round pictures, of pictures whose values are known. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/judge_photos/photo_measures.h"

enum { WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT };

static unsigned char rgb[3 * PIXELS], luma[PIXELS];

static void set(int x, int y, double value)
{
    for (int c = 0; c < 3; c++) rgb[3 * (y * WIDTH + x) + c] = (unsigned char)(value + 0.5);
}

/* Stripes of 32 px, whose edges are those of a step seen through Gaussians of these standard deviations. */
static void draw_checks(double sigma_x, double sigma_y)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double to_x = 16 - fabs(fmod(x + 0.5, 32) - 16), to_y = 16 - fabs(fmod(y + 0.5, 32) - 16);
            const double in_x = erf(to_x / (sqrt(2) * sigma_x)) * (fmod(x + 0.5, 64) < 32 ? 1 : -1);
            const double in_y = erf(to_y / (sqrt(2) * sigma_y)) * (fmod(y + 0.5, 64) < 32 ? 1 : -1);
            set(x, y, 128 + 100 * in_x * in_y);
        }
}

/* A step seen through a Gaussian has the largest slope HEIGHT / (sigma sqrt(2 pi)). */
static void edges_of_a_gaussian_are_as_wide_as_its_slope_says(void **state)
{
    (void)state;
    for (double sigma = 1; sigma <= 4; sigma *= 2) {
        struct photo_measures m;
        draw_checks(sigma, sigma);
        photo_measures_take(&m, rgb, WIDTH, HEIGHT, luma);
        const double wanted = sigma * sqrt(2 * acos(-1));
        if (fabs(m.edge - wanted) > 0.1 * wanted) fail_msg("sigma %g: %g px, wanted %g", sigma, m.edge, wanted);
    }
}

static void blur_in_one_direction_is_found(void **state)
{
    (void)state;
    struct photo_measures across, along;
    draw_checks(3, 0.5);
    photo_measures_take(&across, rgb, WIDTH, HEIGHT, luma);
    draw_checks(0.5, 3);
    photo_measures_take(&along, rgb, WIDTH, HEIGHT, luma);
    assert_true(across.edge > 6.5 && along.edge > 6.5);
}

static void a_picture_without_edges_has_no_width(void **state)
{
    (void)state;
    struct photo_measures m;
    for (int i = 0; i < PIXELS; i++) set(i % WIDTH, i / WIDTH, 100 + 60.0 * (i % WIDTH) / WIDTH);
    photo_measures_take(&m, rgb, WIDTH, HEIGHT, luma);
    assert_true(m.edge == 0);
}

static void white_and_black_pixels_are_counted(void **state)
{
    (void)state;
    struct photo_measures m;
    for (int i = 0; i < PIXELS; i++) set(i % WIDTH, i / WIDTH, i % 4 == 0 ? 255 : i % 8 == 1 ? 0 : 90);
    photo_measures_take(&m, rgb, WIDTH, HEIGHT, luma);
    assert_true(fabs(m.bright - 0.25) < 1e-9 && fabs(m.dark - 0.125) < 1e-9);
    assert_false(m.round);
}

static void the_circle_of_a_fisheye_is_recognised(void **state)
{
    (void)state;
    struct photo_measures m;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) set(x, y, hypot(x - WIDTH / 2, y - HEIGHT / 2) < HEIGHT / 2 ? 120 : 3);
    photo_measures_take(&m, rgb, WIDTH, HEIGHT, luma);
    assert_true(m.round);
    for (int i = 0; i < PIXELS; i++) set(i % WIDTH, i / WIDTH, 2);
    photo_measures_take(&m, rgb, WIDTH, HEIGHT, luma);
    assert_false(m.round); /* a lens cap */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_of_a_gaussian_are_as_wide_as_its_slope_says),
        cmocka_unit_test(blur_in_one_direction_is_found),
        cmocka_unit_test(a_picture_without_edges_has_no_width),
        cmocka_unit_test(white_and_black_pixels_are_counted),
        cmocka_unit_test(the_circle_of_a_fisheye_is_recognised),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
