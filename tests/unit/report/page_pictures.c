/* page_pictures.c - thumbnails are upright and average light, not codes; depth colours grow lighter towards the camera.
 * */
#include "stages/report/page_pictures.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/image/false_colour.h"

/* The letter F in 3 x 4 pixels, stored in each of EXIF's eight orientations, which follow the table of the standard:
 * turned upright, all are the same. */
static void every_orientation_is_turned_upright(void **state)
{
    static const char *const STORED[9] = {NULL,
                                          "###"
                                          "#.."
                                          "##."
                                          "#..",
                                          "###"
                                          "..#"
                                          ".##"
                                          "..#",
                                          "..#"
                                          ".##"
                                          "..#"
                                          "###",
                                          "#.."
                                          "##."
                                          "#.."
                                          "###",
                                          "####"
                                          "#.#."
                                          "#...",
                                          "#..."
                                          "#.#."
                                          "####",
                                          "...#"
                                          ".#.#"
                                          "####",
                                          "####"
                                          ".#.#"
                                          "...#"};
    struct err err = ERR_INIT;
    (void)state;
    for (int orientation = 1; orientation <= 8; orientation++) {
        uint16_t samples[36];
        struct picture p = {0};
        struct photo photo = {.samples = samples};
        photo.info.width = orientation >= 5 ? 4 : 3;
        photo.info.height = orientation >= 5 ? 3 : 4;
        photo.info.bits = 8;
        photo.info.orientation = orientation;
        for (int i = 0; i < 36; i++) samples[i] = STORED[orientation][i / 3] == '#' ? 0 : 255;
        assert_int_equal(picture_from_photo(&p, &photo, 240, &err), ST_OK);
        assert_int_equal(p.width, 3);
        assert_int_equal(p.height, 4);
        for (int i = 0; i < 12; i++) assert_int_equal(p.rgb[3 * i], STORED[1][i] == '#' ? 0 : 255);
        picture_release(&p);
        picture_release(&p);
    }
}

static void thumbnails_have_the_upright_height(void **state)
{
    struct err err = ERR_INIT;
    struct picture p = {0};
    struct photo photo = {.info = {.width = 1000, .height = 400, .bits = 16}};
    (void)state;
    photo.samples = calloc(1000 * 400 * 3, sizeof *photo.samples);
    assert_non_null(photo.samples);
    for (size_t i = 0; i < 1000 * 400; i++) /* black and white columns: half the light is sRGB 188 */
        for (int c = 0; c < 3; c++) photo.samples[3 * i + (size_t)c] = i % 2 ? 65535 : 0;
    photo.info.orientation = 1;
    assert_int_equal(picture_from_photo(&p, &photo, 100, &err), ST_OK);
    assert_int_equal(p.width, 250);
    assert_int_equal(p.height, 100);
    for (int i = 0; i < 250 * 100 * 3; i++) assert_int_equal(p.rgb[i], 188);
    picture_release(&p);
    photo.info.orientation = 6;
    assert_int_equal(picture_from_photo(&p, &photo, 100, &err), ST_OK);
    assert_int_equal(p.width, 40);
    assert_int_equal(p.height, 100);
    picture_release(&p);
    free(photo.samples);
}

/* CIE L* of an sRGB colour. */
static double lightness(const unsigned char rgb[3])
{
    double y = 0.2126 * (double)linear_from_srgb((float)rgb[0] / 255) +
               0.7152 * (double)linear_from_srgb((float)rgb[1] / 255) +
               0.0722 * (double)linear_from_srgb((float)rgb[2] / 255);
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static void ramp_colours_grow_lighter(void **state)
{
    unsigned char rgb[3];
    double last = 0;
    (void)state;
    for (int i = 0; i <= 100; i++) {
        colour_of_ramp(i / 100.0, rgb);
        double l = lightness(rgb);
        assert_true(l > last + 0.1 && l < last + (i ? 2 : 20));
        last = l;
    }
    colour_of_ramp(NAN, rgb);
    assert_true(lightness(rgb) < 20);
}

static void depth_is_coloured_and_the_unknown_hatched(void **state)
{
    float z[6] = {1, 2, 4, 8, 0, 0};
    struct err err = ERR_INIT;
    struct depth_thumb d = {0};
    struct picture p = {0};
    unsigned char rgb[3];
    double near, far;
    (void)state;
    assert_int_equal(page_depth_thumb_make(&d, z, 6, 1, 1, 240, &err), ST_OK);
    assert_float_equal(d.known, 4.0 / 6, 1e-12);
    assert_true(page_depth_range(&d, 0, &near, &far));
    assert_float_equal(near, 1, 0);
    assert_float_equal(far, 8, 0);
    assert_int_equal(picture_from_depth(&p, &d, near, far, &err), ST_OK);
    colour_of_ramp(1, rgb);
    assert_memory_equal(p.rgb, rgb, 3);
    colour_of_ramp((0.5 - 0.125) / (1 - 0.125), rgb);
    assert_memory_equal(p.rgb + 3, rgb, 3);
    colour_of_ramp(0, rgb);
    assert_memory_equal(p.rgb + 9, rgb, 3);
    assert_int_equal(p.rgb[12], p.rgb[13]); /* grey */
    picture_release(&p);
    assert_int_equal(picture_from_depth(&p, &d, 2, 2, &err), ST_OK); /* near equals far: no division by zero */
    picture_release(&p);
    page_depth_thumb_release(&d);

    memset(z, 0, sizeof z);
    assert_int_equal(page_depth_thumb_make(&d, z, 3, 2, 8, 240, &err), ST_OK);
    assert_int_equal(d.width, 2);
    assert_false(page_depth_range(&d, 0.02, &near, &far));
    page_depth_thumb_release(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_orientation_is_turned_upright),
        cmocka_unit_test(thumbnails_have_the_upright_height),
        cmocka_unit_test(ramp_colours_grow_lighter),
        cmocka_unit_test(depth_is_coloured_and_the_unknown_hatched),
    };
    return cmocka_run_group_tests_name("pictures", tests, NULL, NULL);
}
