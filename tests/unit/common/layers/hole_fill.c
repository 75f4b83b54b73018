/* hole_fill.c - holes between a near and a far side. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "common/layers/hole_fill.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

#define W 64
#define H 48

/* Red and near to the left of column `edge`, blue and far to the right. */
static void frame_paint(struct rendered_frame *f, int edge)
{
    for (int i = 0; i < W * H; i++) {
        float *c = f->rgba + 4 * (size_t)i;
        c[0] = i % W < edge;
        c[1] = 0;
        c[2] = 1 - c[0];
        c[3] = 1;
        f->z[i] = i % W < edge ? 2 : 8;
        f->hole[i] = 0;
    }
}

static void frame_cut(struct rendered_frame *f, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)(y * W + x);
            for (int k = 0; k < 4; k++) f->rgba[4 * p + (size_t)k] = 0;
            f->z[p] = 0;
            f->hole[p] = 1;
        }
}

static struct rendered_frame frame_make(int edge)
{
    struct rendered_frame f = {.width = W, .height = H};
    f.rgba = calloc(W * H * 4, sizeof *f.rgba);
    f.z = calloc(W * H, sizeof *f.z);
    f.hole = calloc(W * H, 1);
    assert_true(f.rgba && f.z && f.hole);
    frame_paint(&f, edge);
    return f;
}

static void fill(struct rendered_frame *f, int diameter)
{
    const struct soft_z soft = {3, 6};
    struct err err = ERR_INIT;
    assert_int_equal(hole_fill(f, &soft, 0.01f, diameter, &err), ST_OK);
}

static void assert_blue(const struct rendered_frame *f, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)(y * W + x);
            assert_near(f->rgba[4 * p], 0, 1e-6);
            assert_near(f->rgba[4 * p + 2], 1, 1e-6);
            assert_near(f->rgba[4 * p + 3], 1, 0);
            assert_near(f->z[p], 8, 1e-5);
        }
}

static void holes_are_filled_from_the_far_side(void **state)
{
    (void)state;
    struct rendered_frame f = frame_make(20);
    for (int width = 1; width <= 20; width++) { /* narrow and wide, beside the near surface, over the full height */
        frame_paint(&f, 20);
        frame_cut(&f, 20, 0, 20 + width, H);
        fill(&f, 6);
        assert_near(f.unfilled_fraction, 0, 0);
        assert_blue(&f, 20, 0, 20 + width, H);
        assert_near(f.rgba[4 * 19], 1, 0); /* known pixels do not change */
    }
    rendered_frame_release(&f);
}

static void borders_and_corners_are_filled(void **state)
{
    (void)state;
    struct rendered_frame f = frame_make(0);
    frame_cut(&f, 0, 0, W, 4);
    frame_cut(&f, 0, 0, 17, H);
    frame_cut(&f, W - 2, 0, W, H);
    fill(&f, 6);
    assert_blue(&f, 0, 0, W, H);
    rendered_frame_release(&f);
}

static void nothing_is_filled_with_diameter_0_or_without_known_pixels(void **state)
{
    (void)state;
    struct rendered_frame f = frame_make(20);
    frame_cut(&f, 30, 10, 40, 20);
    fill(&f, 0);
    assert_near(f.unfilled_fraction, 100.0 / (W * H), 1e-12);
    assert_near(f.rgba[4 * (12 * W + 32) + 3], 0, 0);

    frame_cut(&f, 0, 0, W, H);
    fill(&f, 6);
    assert_near(f.unfilled_fraction, 1, 0);
    for (int i = 0; i < W * H * 4; i++) assert_near(f.rgba[i], 0, 0);
    rendered_frame_release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holes_are_filled_from_the_far_side),
        cmocka_unit_test(borders_and_corners_are_filled),
        cmocka_unit_test(nothing_is_filled_with_diameter_0_or_without_known_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
