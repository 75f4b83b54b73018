/* parallax.c - tests of the parallax between two cameras that see a strip in front of a wall. */
#include "stages/plan_path/parallax.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { W = 203, H = 61 }; /* no multiple of the vector width */

#define NEAR 2.0
#define FAR  8.0
#define FX   160.0

/* Seen from (at, 0, 0) along z: a wall at FAR, in front of it a strip at NEAR from -half to half. Depths are known in
 * the first `rows` rows. */
static void picture(struct depth_picture *d, double at, double half, int rows)
{
    static float z[W * H];
    struct err err = ERR_INIT;
    *d = (struct depth_picture){.camera = {.width = W, .height = H, .fx = FX, .fy = FX, .cx = W / 2.0, .cy = H / 2.0}};
    d->camera.cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    d->camera.center = vec3_make(at, 0, 0);
    d->camera.translation = vec3_make(-at, 0, 0);
    for (int p = 0; p < W * H; p++) {
        const double x = at + NEAR * (p % W + 0.5 - W / 2.0) / FX;
        z[p] = fabs(x) <= half ? (float)NEAR : (float)FAR;
        if (p / W >= rows) z[p] = 0;
    }
    assert_int_equal(parallax_picture_init(d, z, &err), ST_OK);
}

static double parallax_of(double baseline, double half, int rows, double tolerance)
{
    struct depth_picture a, b;
    picture(&a, -baseline / 2, half, H);
    picture(&b, baseline / 2, half, rows);
    const double parallax = parallax_between(&a, &b, tolerance);
    assert_true(parallax == parallax_between(&b, &a, tolerance));
    parallax_picture_release(&a);
    parallax_picture_release(&b);
    return parallax;
}

/* Beside the strip, each camera sees a part of the wall, as wide as the disparity, that the other does not. */
static void a_strip_hides_its_disparity_in_both_pictures(void **state)
{
    (void)state;
    for (double baseline = 0; baseline < 0.3; baseline += 0.025) {
        const double disparity = FX * baseline * (1 / NEAR - 1 / FAR);
        assert_true(fabs(parallax_of(baseline, 0.4, H, 0.01) - 2 * disparity / W) <= 2.0 / W); /* one pixel per edge */
    }
}

static void a_single_depth_or_position_has_no_parallax(void **state)
{
    (void)state;
    assert_true(parallax_of(0.3, 0, H, 0.01) == 0);   /* no strip */
    assert_true(parallax_of(0.3, 100, H, 0.01) == 0); /* no wall */
    assert_true(parallax_of(0.2, 0.4, H, 3.5) == 0);  /* FAR is four times NEAR: within the tolerance */
}

/* With half of one picture unknown, half of the parallax is lost in both. */
static void unknown_depths_neither_hide_nor_are_hidden(void **state)
{
    (void)state;
    const double all = parallax_of(0.2, 0.4, H, 0.01), part = parallax_of(0.2, 0.4, 30, 0.01);
    assert_true(part > 0.45 * all && part < 0.52 * all);
    assert_true(parallax_of(0.2, 0.4, 0, 0.01) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_strip_hides_its_disparity_in_both_pictures),
        cmocka_unit_test(a_single_depth_or_position_has_no_parallax),
        cmocka_unit_test(unknown_depths_neither_hide_nor_are_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
