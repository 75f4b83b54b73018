/* parallax.c - what two cameras hide from each other, of a plane before a plane. */
#include "stages/plan_path/parallax.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { W = 203, H = 61 }; /* no multiple of what is done at a time */

#define NEAR 2.0
#define FAR  8.0
#define FX   160.0

/* At x, upright, looking along z: a wall at FAR, before it a strip at NEAR from -half to half; `rows` are known. */
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
    assert_int_equal(depth_picture_init(d, z, &err), ST_OK);
}

static double parallax_of(double baseline, double half, int rows, double tolerance)
{
    struct depth_picture a, b;
    picture(&a, -baseline / 2, half, H);
    picture(&b, baseline / 2, half, rows);
    const double parallax = parallax_between(&a, &b, tolerance);
    assert_true(parallax == parallax_between(&b, &a, tolerance));
    depth_picture_release(&a);
    depth_picture_release(&b);
    return parallax;
}

/* Beside the strip either camera sees as much of the wall as the strip moves against it. */
static void a_strip_hides_its_disparity_from_each(void **state)
{
    (void)state;
    for (double baseline = 0; baseline < 0.3; baseline += 0.025) {
        const double disparity = FX * baseline * (1 / NEAR - 1 / FAR);
        assert_true(fabs(parallax_of(baseline, 0.4, H, 0.01) - 2 * disparity / W) <= 2.0 / W); /* a pixel a rim */
    }
}

static void one_depth_or_one_place_has_none(void **state)
{
    (void)state;
    assert_true(parallax_of(0.3, 0, H, 0.01) == 0);   /* a wall alone */
    assert_true(parallax_of(0.3, 100, H, 0.01) == 0); /* a strip that is all */
    assert_true(parallax_of(0.2, 0.4, H, 3.5) == 0);  /* FAR is four times NEAR: within the tolerance */
}

/* What is not known hides nothing, and is hidden by nothing: a half of one picture is lost, and of the other what it told. */
static void what_is_not_known_does_not_count(void **state)
{
    (void)state;
    const double all = parallax_of(0.2, 0.4, H, 0.01), part = parallax_of(0.2, 0.4, 30, 0.01);
    assert_true(part > 0.45 * all && part < 0.52 * all);
    assert_true(parallax_of(0.2, 0.4, 0, 0.01) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_strip_hides_its_disparity_from_each),
        cmocka_unit_test(one_depth_or_one_place_has_none),
        cmocka_unit_test(what_is_not_known_does_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
