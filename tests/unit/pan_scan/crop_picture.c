/* crop_picture.c - tests of resampling: identity, constants, ramps, no halos, the same bits for any thread count. */
#include "stages/pan_scan/crop_picture.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"

enum { W = 64, H = 48 };

static struct image make(int width, int height, float (*value)(int x, int y))
{
    struct image im = {0};
    struct err err = ERR_INIT;
    assert_ok(image_init(&im, width, height, 4, &err), err);
    for (int y = 0; y < height && value; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 4; c++) image_at(&im, x, y)[c] = value(x, y) * (float)(c + 1);
    return im;
}

static float noise(int x, int y) { return (float)((x * 7919 + y * 104729) % 997); }
static float constant(int x, int y) { return (void)x, (void)y, 0.3f; }
static float ramp(int x, int y) { return (float)(x + 0.5) + 2 * (float)(y + 0.5); }
static float spot(int x, int y) { return x == 30 && y == 20 ? 1e4f : 0; }

static struct image crop_of(const struct image *from, int width, int height, struct crop crop)
{
    struct image out = make(width, height, NULL);
    struct err err = ERR_INIT;
    assert_ok(crop_picture(&out, from, &crop, &err), err);
    return out;
}

static void an_aligned_crop_copies_pixels(void **state)
{
    struct image im = make(W, H, noise);
    struct image out = crop_of(&im, 20, 10, (struct crop){13, 5, 20, 10});
    (void)state;
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 20; x++)
            for (int c = 0; c < 4; c++) assert_true(image_at(&out, x, y)[c] == image_at(&im, x + 13, y + 5)[c]);
    image_release(&out);
    out = crop_of(&im, W, H, (struct crop){0, 0, W, H});
    assert_memory_equal(out.data, im.data, sizeof *im.data * 4 * W * H);
    image_release(&out);
    image_release(&im);
}

static const struct crop crops[] = {{0, 0, W, H}, {10.3, 7.7, 8.25, 6.5}, {3.1, 2.2, 55, 41}, {0, 0, 20, 15}};
static const int sizes[][2] = {{160, 120}, {16, 12}, {1, 1}, {61, 47}};

static void a_constant_stays_constant_and_a_ramp_linear(void **state)
{
    struct image flat = make(W, H, constant), slope = make(W, H, ramp);
    (void)state;
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 4; k++) {
            const int w = sizes[k][0], h = sizes[k][1];
            const double sx = crops[i].width / w, sy = crops[i].height / h;
            struct image a = crop_of(&flat, w, h, crops[i]), b = crop_of(&slope, w, h, crops[i]);
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) {
                    const double u = crops[i].x + (x + 0.5) * sx, v = crops[i].y + (y + 0.5) * sy;
                    const double reach_x = 2 * fmax(1, sx) + 0.5, reach_y = 2 * fmax(1, sy) + 0.5;
                    assert_true(fabsf(image_at(&a, x, y)[0] - 0.3f) < 1e-6f);
                    if (u < reach_x || v < reach_y || u > W - reach_x || v > H - reach_y) continue;
                    if (!(fabs((double)image_at(&b, x, y)[0] - (u + 2 * v)) < 0.02 * (sx > 1 || sy > 1) + 1e-3))
                        fail_msg("crop %zu size %zu (%d, %d): found %g, wanted %g", i, k, x, y,
                                 (double)image_at(&b, x, y)[0], u + 2 * v);
                }
            image_release(&a);
            image_release(&b);
        }
    image_release(&flat);
    image_release(&slope);
}

static void a_light_has_no_halo(void **state)
{
    struct image im = make(W, H, spot);
    (void)state;
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 4; k++) {
            struct image out = crop_of(&im, sizes[k][0], sizes[k][1], crops[i]);
            for (int p = 0; p < out.width * out.height; p++)
                assert_true(out.data[4 * p] >= 0 && out.data[4 * p] <= 1e4f);
            image_release(&out);
        }
    image_release(&im);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    const int threads = parallel_threads();
    struct image im = make(W, H, noise);
    (void)state;
    parallel_set_threads(1);
    struct image one = crop_of(&im, 61, 47, crops[2]);
    parallel_set_threads(3);
    struct image three = crop_of(&im, 61, 47, crops[2]);
    parallel_set_threads(threads);
    assert_memory_equal(one.data, three.data, sizeof *one.data * 4 * 61 * 47);
    image_release(&one);
    image_release(&three);
    image_release(&im);
}

static void a_picture_of_one_pixel_is_resampled(void **state)
{
    struct image im = make(1, 1, constant);
    struct image out = crop_of(&im, 6, 4, (struct crop){0.2, 0.1, 0.6, 0.4});
    (void)state;
    for (int p = 0; p < 24; p++) assert_true(fabsf(out.data[4 * p] - 0.3f) < 1e-7f);
    image_release(&out);
    image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_aligned_crop_copies_pixels),
        cmocka_unit_test(a_constant_stays_constant_and_a_ramp_linear),
        cmocka_unit_test(a_light_has_no_halo),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(a_picture_of_one_pixel_is_resampled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
