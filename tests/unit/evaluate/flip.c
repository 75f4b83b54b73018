/* flip.c - FLIP of equal pictures, of extreme colours, and of pictures with a value by the paper's kernels in the
 * plane. */
#include "stages/evaluate/measure/flip.h"

#include <math.h>

#include "common/base/parallel.h"
#include "tests/unit/scratch.h"

enum { W = 40, H = 28 };

/* Blocks of smooth colours and of noise. */
static void make_picture(uint8_t *rgb, int seed)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const int noise =
                    x * x * (3 + c) + y * y * (5 - c) + x * y * (1 + seed) + 40 * seed * ((x / 5 + y / 4) % 2) * c;
                const int smooth = 6 * x + 5 * y + 60 * c + 20 * seed;
                rgb[3 * (y * W + x) + c] = (uint8_t)(((x / 8 + y / 7) % 2 ? noise : smooth) % 256);
            }
}

static double flip(const uint8_t *a, const uint8_t *b, const uint8_t *mask)
{
    struct err err = ERR_INIT;
    double mean = -1;
    assert_ok(flip_mean(a, b, W, H, mask, &mean, &err), err);
    return mean;
}

static void flat(uint8_t *rgb, uint8_t r, uint8_t g, uint8_t b)
{
    for (int i = 0; i < W * H; i++) rgb[3 * i] = r, rgb[3 * i + 1] = g, rgb[3 * i + 2] = b;
}

static void equal_pictures_do_not_differ(void **state)
{
    (void)state;
    uint8_t a[3 * W * H];
    make_picture(a, 0);
    assert_true(flip(a, a, NULL) == 0);
}

/* By the paper the distance of green and blue is the largest, 1. That of black and white is 100 in lightness alone:
 * 100^0.7 against the largest, 203.3^0.7, which is compressed to 0.967. */
static void extreme_colours_have_their_distance(void **state)
{
    (void)state;
    uint8_t a[3 * W * H], b[3 * W * H];
    flat(a, 0, 255, 0);
    flat(b, 0, 0, 255);
    assert_float_equal(flip(a, b, NULL), 1, 1e-4);
    flat(a, 0, 0, 0);
    flat(b, 255, 255, 255);
    assert_float_equal(flip(a, b, NULL), 0.96738, 1e-4);
}

/* Computed apart from this code, in double precision with kernels in the plane. */
static void pictures_differ_as_the_paper_says(void **state)
{
    (void)state;
    uint8_t a[3 * W * H], b[3 * W * H];
    make_picture(a, 0);
    make_picture(b, 1);
    assert_float_equal(flip(a, b, NULL), 0.482979, 1e-4);
    assert_float_equal(flip(b, a, NULL), 0.482979, 1e-4);
    make_picture(b, 0);
    for (int i = 3 * 10 * W; i < 3 * 12 * W; i++) b[i] = (uint8_t)(255 - b[i]); /* two rows inverted */
    assert_float_equal(flip(a, b, NULL), 0.102321, 1e-4);
}

static void what_lies_outside_the_mask_is_not_seen(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    uint8_t a[3 * W * H], b[3 * W * H], mask[W * H] = {0};
    double mean;
    make_picture(a, 0);
    make_picture(b, 0);
    for (int i = 0; i < W * H; i++) mask[i] = i % W < 20;
    for (int i = 0; i < W * H; i++)
        if (!mask[i]) b[3 * i] ^= 0x80;
    assert_true(flip(a, b, mask) == 0);
    memset(mask, 0, sizeof mask);
    assert_int_equal(flip_mean(a, b, W, H, mask, &mean, &err), ST_DATA);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    uint8_t a[3 * W * H], b[3 * W * H];
    make_picture(a, 0);
    make_picture(b, 1);
    parallel_set_threads(1);
    const double one = flip(a, b, NULL);
    parallel_set_threads(3);
    assert_true(flip(a, b, NULL) == one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_do_not_differ),
        cmocka_unit_test(extreme_colours_have_their_distance),
        cmocka_unit_test(pictures_differ_as_the_paper_says),
        cmocka_unit_test(what_lies_outside_the_mask_is_not_seen),
        cmocka_unit_test(threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
