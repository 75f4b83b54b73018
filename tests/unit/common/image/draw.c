/* draw.c - lines and dots stay within the picture and have their width; an exposed picture has its level. */
#include "common/image/draw.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 40, HEIGHT = 30 };

static const unsigned char WHITE[3] = {255, 255, 255};

static double sum_of(const unsigned char *rgb)
{
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) sum += rgb[3 * i] / 255.0;
    return sum;
}

static void a_line_has_its_length_and_width(void **state)
{
    unsigned char rgb[3 * WIDTH * HEIGHT] = {0};
    const struct canvas k = {rgb, WIDTH, HEIGHT};
    (void)state;
    draw_line(&k, 10, 15, 30, 15, 1, WHITE);
    /* a rectangle of 20 x 2 and two half discs of radius 1 */
    assert_float_equal(sum_of(rgb), 20 * 2 + 3.14159, 1.5);
    assert_int_equal(rgb[3 * (15 * WIDTH + 20)], 255);
    assert_int_equal(rgb[3 * (18 * WIDTH + 20)], 0);
}

static void what_lies_outside_is_cut(void **state)
{
    unsigned char rgb[3 * WIDTH * HEIGHT] = {0};
    const struct canvas k = {rgb, WIDTH, HEIGHT};
    (void)state;
    draw_line(&k, -10, -10, -10, 60, 2, WHITE);
    draw_line(&k, 50, 3, 1e12, 40, 2, WHITE);
    draw_dot(&k, -20, 10, 5, WHITE);
    assert_float_equal(sum_of(rgb), 0, 0);
    draw_line(&k, -1e9, 10, 1e9, 10, 0.5, WHITE);
    assert_float_equal(sum_of(rgb), WIDTH, 1);
}

static void a_dot_has_a_dark_rim(void **state)
{
    unsigned char rgb[3 * WIDTH * HEIGHT];
    const struct canvas k = {rgb, WIDTH, HEIGHT};
    (void)state;
    memset(rgb, 100, sizeof rgb);
    draw_dot(&k, 20.5, 15.5, 4, WHITE);
    assert_int_equal(rgb[3 * (15 * WIDTH + 20)], 255);
    assert_int_equal(rgb[3 * (15 * WIDTH + 24)], 0);
    assert_int_equal(rgb[3 * (15 * WIDTH + 25)], 100);
}

static void an_exposed_picture_has_its_level(void **state)
{
    struct image im = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(image_init(&im, 10, 10, 4, &err), ST_OK);
    assert_int_equal(image_expose(&im, 0.9, 0.5, &err), ST_OK); /* black */
    assert_float_equal(im.data[0], 0, 0);
    for (int i = 0; i < 100; i++)
        for (int c = 0; c < 4; c++) im.data[4 * i + c] = c < 3 ? (float)i : i < 50;
    assert_int_equal(image_expose(&im, 1, 0.5, &err), ST_OK);
    assert_float_equal(im.data[4 * 49], 0.5, 1e-6); /* the brightest that counts */
    assert_float_equal(im.data[4 * 98 + 1], 1, 1e-6);
    assert_float_equal(im.data[4 * 98 + 3], 0, 0);
    image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_has_its_length_and_width),
        cmocka_unit_test(what_lies_outside_is_cut),
        cmocka_unit_test(a_dot_has_a_dark_rim),
        cmocka_unit_test(an_exposed_picture_has_its_level),
    };
    return cmocka_run_group_tests_name("drawing", tests, NULL, NULL);
}
