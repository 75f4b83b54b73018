/* layer_render_parts.c - the renderer's formulas against numbers worked out by hand: soft z, front-to-back saturation,
 * hole filling. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "common/hole_fill.h"
#include "common/layer_raster.h"
#include "common/soft_z.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

static void soft_z_weights_are_equation_3_1(void **state)
{
    (void)state;
    /* rho 10, gamma 1: one up to 1, a half in the middle (5), nothing from 9 on */
    assert_near(soft_z_weight(0, 1, 10), 1, 0);
    assert_near(soft_z_weight(1, 1, 10), 1, 0);
    assert_near(soft_z_weight(3, 1, 10), 0.5 * (1 + sqrt(0.5)), 1e-6); /* cos(pi / 4) */
    assert_near(soft_z_weight(5, 1, 10), 0.5, 1e-6);
    assert_near(soft_z_weight(7, 1, 10), 0.5 * (1 - sqrt(0.5)), 1e-6);
    assert_near(soft_z_weight(9, 1, 10), 0, 1e-6);
    assert_near(soft_z_weight(9.01f, 1, 10), 0, 0);
    assert_near(soft_z_weight(0, 0, 0), 1, 0); /* no width: the nearest alone */
    assert_near(soft_z_weight(1e-6f, 0, 0), 0, 0);
}

static void soft_z_width_is_of_two_uncertainties(void **state)
{
    (void)state;
    const struct soft_z own = {3, 100}, thesis = {0, 100};
    /* 0.03 * 10 = 0.3 and 0.02 * 20 = 0.4 make 0.5; half weight 3 of them away */
    assert_near(soft_z_rho(&own, 10, 0.03f, 20, 0.02f), 3.0, 1e-5);
    assert_near(soft_z_rho(&thesis, 10, 0.03f, 20, 0.02f), 100, 0);
    assert_near(soft_z_reach(&own, 10, 0.03f), 0.9, 1e-6);
    assert_near(soft_z_reach(&thesis, 10, 0.03f), 10, 1e-5);
    assert_near(soft_z_reach(&own, 10, 0), 3 * 10 * SOFT_Z_SIGMA_LEAST, 1e-6);
}

static void soft_z_blends_by_weight_alpha_and_depth(void **state)
{
    (void)state;
    const struct soft_z soft = {0, 10};
    float rgba[4], z;

    /* dz 5 is half of rho: w 1/2. Colour (0.6 * 1 * 1 + 0.4 * 0.5 * 0) / 0.8; depth without blend: (10 + 0.5 * 15) /
     * 1.5 */
    const struct soft_z_sample two[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.6f}, {{0, 1, 0, 1}, 15, 0.01f, 0.4f}};
    soft_z_blend(&soft, two, 2, rgba, &z);
    assert_near(rgba[0], 0.75, 1e-6);
    assert_near(rgba[1], 0.25, 1e-6);
    assert_near(rgba[3], 1, 0);
    assert_near(z, 17.5 / 1.5, 1e-5);

    /* alpha weighs, premultiplied: blends 1/2 and 1/2, alphas 1 and 0.6, one depth */
    const struct soft_z_sample thin[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.5f}, {{0, 0.6f, 0, 0.6f}, 10, 0.01f, 0.5f}};
    soft_z_blend(&soft, thin, 2, rgba, &z);
    assert_near(rgba[0], 1 / 1.6, 1e-6);
    assert_near(rgba[1], 0.6 / 1.6, 1e-6);
    assert_near(z, 10, 1e-6);

    /* hidden: far behind counts nothing, in colour and depth */
    const struct soft_z_sample far[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.1f}, {{0, 1, 0, 1}, 30, 0.01f, 0.9f}};
    soft_z_blend(&soft, far, 2, rgba, &z);
    assert_near(rgba[0], 1, 1e-6);
    assert_near(z, 10, 1e-6);
}

static void a_view_that_enters_does_so_without_a_jump(void **state)
{
    (void)state;
    const struct soft_z soft = {3, 10};
    float rgba[4], z, before = 0;

    for (int i = 0; i <= 100; i++) { /* the nearer view's blending weight from 0 to 0.1 */
        const float blend = 0.001f * (float)i;
        const struct soft_z_sample s[] = {{{1, 0, 0, 1}, 5, 0.01f, blend}, {{0, 1, 0, 1}, 8, 0.01f, 1 - blend}};
        soft_z_blend(&soft, s, 2, rgba, &z);
        if (i) assert_true(fabsf(rgba[0] - before) < 0.35f); /* no more than the last steps of hiding the far one */
        if (i == 0) assert_near(rgba[0], 0, 0);
        if (i == 1) assert_true(rgba[0] < 0.01f && z > 7.9f);
        if (i >= 50) assert_near(rgba[0], 1, 1e-5);
        before = rgba[0];
    }
}

static void composite(struct raster_pixel *p, const float rgba[4], float z, float sigma, float inside, float reach)
{
    const struct raster_fragment f = {{rgba[0], rgba[1], rgba[2], rgba[3]}, z, sigma, inside};
    raster_composite(p, &f, reach);
}

static void fragments_saturate_front_to_back(void **state)
{
    (void)state;
    struct raster_pixel p = {0};
    const float red[4] = {0.6f, 0, 0, 0.6f}, green[4] = {0, 0.5f, 0, 0.5f}, blue[4] = {0, 0, 1, 1};

    composite(&p, red, 5, 0.01f, 1, 0.5f);
    composite(&p, green, 5.2f, 0.02f, 0.5f, 0.5f); /* the same surface: 0.4 are left */
    assert_near(p.rgba[0], 0.6, 1e-6);
    assert_near(p.rgba[1], 0.4, 1e-6);
    assert_near(p.rgba[3], 1, 1e-6);
    assert_near(p.inside, 0.6 * 1 + 0.4 * 0.5, 1e-6);
    assert_near(p.front.z, 0.6 * 5 + 0.4 * 5.2, 1e-5);
    assert_near(p.front.sigma, 0.6 * 0.01 + 0.4 * 0.02, 1e-6);
    composite(&p, blue, 9, 0.01f, 1, 0.5f); /* nothing is left */
    assert_near(p.rgba[2], 0, 0);
    assert_near(p.rgba[3], 1, 1e-6);
    assert_true(raster_visible(&p) == &p.front);
}

static void depth_is_never_a_mean_across_a_jump(void **state)
{
    (void)state;
    struct raster_pixel p = {0};
    const float edge[4] = {0.3f, 0, 0, 0.3f}, wall[4] = {0, 0, 1, 1};

    composite(&p, edge, 2, 0.01f, 1, 0.1f);
    composite(&p, wall, 7, 0.01f, 1, 0.1f);
    assert_near(p.rgba[0], 0.3, 1e-6);
    assert_near(p.rgba[2], 0.7, 1e-6);
    assert_near(raster_visible(&p)->z, 7, 0); /* most of the pixel is wall */

    p = (struct raster_pixel){0};
    composite(&p, wall, 7, 0.01f, 0.2f, 0.1f); /* out of order: the nearer one still goes in front */
    composite(&p, edge, 2, 0.01f, 1, 0.1f);
    assert_near(p.rgba[0], 0.3, 1e-6);
    assert_near(p.rgba[2], 0.7, 1e-6);
    assert_near(p.rgba[3], 1, 1e-6);
    assert_near(p.inside, 0.3 * 1 + 0.7 * 0.2, 1e-6);
    assert_near(p.front.z, 2, 0);
    assert_near(raster_visible(&p)->z, 7, 0);
}

/* ------------------------------------------------------------------------------------------------------ holes */

#define W 64
#define H 48

static void frame_make(struct rendered_frame *f)
{
    *f = (struct rendered_frame){.width = W, .height = H};
    f->rgba = calloc(W * H * 4, sizeof *f->rgba);
    f->z = calloc(W * H, sizeof *f->z);
    f->hole = calloc(W * H, 1);
}

/* Red and near left of column `edge`, blue and far right of it. */
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
    const struct soft_z soft = {3, 6};
    struct rendered_frame f;
    struct err err = ERR_INIT;

    frame_make(&f);
    for (int width = 1; width <= 20; width++) { /* narrow and wide, beside the near surface, over the whole height */
        frame_paint(&f, 20);
        frame_cut(&f, 20, 0, 20 + width, H);
        assert_int_equal(hole_fill(&f, &soft, 0.01f, 6, &err), ST_OK);
        assert_near(f.unfilled_fraction, 0, 0);
        assert_blue(&f, 20, 0, 20 + width, H);
        assert_near(f.rgba[4 * 19], 1, 0); /* what was known is left alone */
    }
    rendered_frame_release(&f);
}

static void borders_and_corners_are_filled(void **state)
{
    (void)state;
    const struct soft_z soft = {3, 6};
    struct rendered_frame f;
    struct err err = ERR_INIT;

    frame_make(&f);
    frame_paint(&f, 0);
    frame_cut(&f, 0, 0, W, 4);
    frame_cut(&f, 0, 0, 17, H);
    frame_cut(&f, W - 2, 0, W, H);
    assert_int_equal(hole_fill(&f, &soft, 0.01f, 6, &err), ST_OK);
    assert_blue(&f, 0, 0, W, H);
    rendered_frame_release(&f);
}

static void nothing_is_filled_when_told_or_when_there_is_nothing(void **state)
{
    (void)state;
    const struct soft_z soft = {3, 6};
    struct rendered_frame f;
    struct err err = ERR_INIT;

    frame_make(&f);
    frame_paint(&f, 20);
    frame_cut(&f, 30, 10, 40, 20);
    assert_int_equal(hole_fill(&f, &soft, 0.01f, 0, &err), ST_OK);
    assert_near(f.unfilled_fraction, 100.0 / (W * H), 1e-12);
    assert_near(f.rgba[4 * (12 * W + 32) + 3], 0, 0);

    frame_cut(&f, 0, 0, W, H);
    assert_int_equal(hole_fill(&f, &soft, 0.01f, 6, &err), ST_OK);
    assert_near(f.unfilled_fraction, 1, 0);
    for (int i = 0; i < W * H * 4; i++) assert_near(f.rgba[i], 0, 0);
    rendered_frame_release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soft_z_weights_are_equation_3_1),
        cmocka_unit_test(soft_z_width_is_of_two_uncertainties),
        cmocka_unit_test(soft_z_blends_by_weight_alpha_and_depth),
        cmocka_unit_test(a_view_that_enters_does_so_without_a_jump),
        cmocka_unit_test(fragments_saturate_front_to_back),
        cmocka_unit_test(depth_is_never_a_mean_across_a_jump),
        cmocka_unit_test(holes_are_filled_from_the_far_side),
        cmocka_unit_test(borders_and_corners_are_filled),
        cmocka_unit_test(nothing_is_filled_when_told_or_when_there_is_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
