/* tone.c - tone mapping keeps detail in dark and bright parts and is deterministic. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "stages/hdr_merge/tone.h"

enum { WIDTH = 400, HEIGHT = 300 };

/* A checkerboard of 20 % contrast; the right half is `times` brighter. */
static void paint(struct image *im, double dark, double times)
{
    struct err err = ERR_INIT;
    assert_ok(image_init(im, WIDTH, HEIGHT, 3, &err), err);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++)
                image_at(im, x, y)[c] =
                    (float)(dark * (x < WIDTH / 2 ? 1 : times) * ((x / 8 + y / 8) % 2 ? 1.1 : 0.9) * (1 - 0.1 * c));
}

static unsigned char *tone(const struct image *im)
{
    struct err err = ERR_INIT;
    unsigned char *rgb = malloc((size_t)im->width * (size_t)im->height * 3);
    assert_non_null(rgb);
    assert_ok(tone_map(rgb, im, &err), err);
    return rgb;
}

/* Steps between neighbouring squares in the middle of a half. */
static int contrast(const unsigned char *rgb, int x)
{
    const int y = HEIGHT / 2, at = x / 16 * 16 + 4;
    return abs(rgb[3 * (y * WIDTH + at) + 1] - rgb[3 * (y * WIDTH + at + 8) + 1]);
}

static void dark_and_bright_parts_keep_their_detail(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const double dark = k == 0 ? 0.02 : k == 1 ? 0.005 : 0.1, times = k == 0 ? 100 : k == 1 ? 2000 : 30;
        struct image im;
        paint(&im, dark, times);
        unsigned char *rgb = tone(&im);
        const int left = contrast(rgb, WIDTH / 4), right = contrast(rgb, 3 * WIDTH / 4);
        print_message("%g and %g times that: contrast of %d and %d steps; levels %d and %d\n", dark, times, left, right,
                      rgb[3 * (150 * WIDTH + 100)], rgb[3 * (150 * WIDTH + 300)]);
        assert_true(left >= 5 && right >= 5);
        assert_true(rgb[3 * (150 * WIDTH + 100)] < rgb[3 * (150 * WIDTH + 300)]);
        free(rgb);
        image_release(&im);
    }
}

static void any_radiance_can_be_mapped(void **state)
{
    struct image im;
    struct err err = ERR_INIT;
    (void)state;
    for (int k = 0; k < 3; k++) {
        const int sizes[3][2] = {{1, 1}, {3, 700}, {5, 2}};
        assert_ok(image_init(&im, sizes[k][0], sizes[k][1], 3, &err), err);
        for (int i = 0; i < im.width * im.height * 3; i++) im.data[i] = i % 5 == 0 ? 0 : powf(10, (float)(i % 13) - 6);
        unsigned char *rgb = tone(&im);
        free(rgb);
        image_release(&im);
    }
    assert_ok(image_init(&im, 64, 64, 3, &err), err); /* black */
    unsigned char *black = tone(&im);
    for (int i = 0; i < 64 * 64 * 3; i++) assert_true(black[i] <= 2);
    free(black);
    image_release(&im);
}

static void the_result_does_not_depend_on_threads(void **state)
{
    struct image im;
    unsigned char *rgb[2];
    (void)state;
    paint(&im, 0.02, 100);
    for (int i = 0; i < 2; i++) {
        parallel_set_threads(i + 1);
        rgb[i] = tone(&im);
    }
    parallel_set_threads(0);
    assert_memory_equal(rgb[0], rgb[1], WIDTH * HEIGHT * 3);
    free(rgb[0]);
    free(rgb[1]);
    image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dark_and_bright_parts_keep_their_detail),
        cmocka_unit_test(any_radiance_can_be_mapped),
        cmocka_unit_test(the_result_does_not_depend_on_threads),
    };
    return cmocka_run_group_tests_name("tone", tests, NULL, NULL);
}
