/* image.c - float images: memory, limits, and the sRGB curve against its definition. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/image/image.h"

static void images_are_allocated_zeroed(void **state)
{
    struct image im = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(image_init(&im, 5, 3, 4, &err), err);
    assert_int_equal((uintptr_t)im.data % 64, 0);
    for (int i = 0; i < 60; i++) assert_true(im.data[i] == 0);
    assert_ptr_equal(image_at(&im, 2, 1), im.data + (1 * 5 + 2) * 4);
    image_release(&im);
    image_release(&im);
    image_release(NULL);
    assert_null(im.data);
}

static void invalid_sizes_are_refused(void **state)
{
    const int sizes[][3] = {{0, 3, 1}, {3, 0, 1}, {3, 3, 0}, {-1, 3, 1}, {INT_MAX, INT_MAX, 4}, {1 << 16, 1 << 15, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct image im;
        struct err err = ERR_INIT;
        assert_int_equal(image_init(&im, sizes[i][0], sizes[i][1], sizes[i][2], &err), ST_DATA);
        assert_err(err, ST_DATA, "image");
        assert_null(im.data);
    }
}

static void the_srgb_curve_matches_its_definition(void **state)
{
    (void)state;
    assert_true(srgb_from_linear(0) == 0 && srgb_from_linear(1) == 1);
    assert_true(srgb_from_linear(-1) == 0 && srgb_from_linear(2) == 1 && srgb_from_linear(NAN) == 0);
    assert_true(srgb_from_linear(INFINITY) == 1 && srgb_from_linear(-INFINITY) == 0);
    for (int i = 0; i <= 1000; i++) {
        double linear = i / 1000.0;
        double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
        assert_true(fabs(srgb_from_linear((float)linear) - srgb) < 3e-7);
        assert_true(fabs(linear_from_srgb((float)srgb) - linear) < 3e-7);
    }
}

/* Every 8-bit value survives conversion to linear and back, with one, three and four channels. */
static void eight_bit_values_survive_the_round_trip(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        struct image im = {0};
        struct err err = ERR_INIT;
        unsigned char out[3 * 256];
        if (channels == 2) continue;
        assert_ok(image_init(&im, 16, 16, channels, &err), err);
        for (int i = 0; i < 256; i++)
            for (int c = 0; c < channels; c++)
                im.data[i * channels + c] = c < 3 ? linear_from_srgb((float)((i + c) % 256) / 255) : NAN;
        image_to_srgb8(&im, out);
        for (int i = 0; i < 256; i++)
            for (int c = 0; c < 3; c++) assert_int_equal(out[3 * i + c], channels == 1 ? i : (i + c) % 256);
        image_release(&im);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_allocated_zeroed),
        cmocka_unit_test(invalid_sizes_are_refused),
        cmocka_unit_test(the_srgb_curve_matches_its_definition),
        cmocka_unit_test(eight_bit_values_survive_the_round_trip),
    };
    return cmocka_run_group_tests_name("image", tests, NULL, NULL);
}
