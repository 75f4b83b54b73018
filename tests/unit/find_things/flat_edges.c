/* flat_edges.c - the outline of a rug from one pixel of it. */
#include "stages/find_things/flat_edges.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { W = 240, H = 160 };

#define CU 120.0 /* the rug is an ellipse */
#define CV 80.0
#define AU 60.0
#define AV 35.0

static struct image photo;
static uint8_t shown[W * H];

static bool in_rug(double u, double v) { return hypot((u - CU) / AU, (v - CV) / AV) < 1; }

static double noise(int i)
{
    const double s = sin(12.9898 * i) * 43758.5453;
    return s - floor(s) - 0.5;
}

/* A floor that gets darker to the right, and a rug that is `times` as bright. */
static void paint(double times)
{
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&photo, W, H, 4, &err), ST_OK);
    memset(shown, 1, sizeof shown);
    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;
        const double light = 0.3 * exp(-0.0025 * x) * (1 + 0.08 * noise(i)) * (in_rug(x + 0.5, y + 0.5) ? times : 1);
        for (int c = 0; c < 4; c++) photo.data[4 * i + c] = c == 3 ? 1 : (float)(light * (c == 1 ? 0.9 : 1));
    }
}

static bool holds(const struct flat_corner *c, int count, double u, double v)
{
    for (int i = 0; i < count; i++) {
        const struct flat_corner p = c[i], q = c[(i + 1) % count];
        if ((q.u - p.u) * (v - p.v) - (q.v - p.v) * (u - p.u) < 0) return false;
    }
    return true;
}

/* The share of the pixels in the outline or the rug that are in both; 0: no outline. */
static double overlap(int x, int y)
{
    struct flat_corner *corners;
    struct err err = ERR_INIT;
    int count, both = 0, either = 0;
    assert_int_equal(flat_edges_find(&corners, &count, &photo, shown, x, y, &err), ST_OK);
    assert_true((count > 0) == (corners != NULL));
    for (int i = 0; i < W * H && count; i++) {
        const double u = i % W + 0.5, v = i / W + 0.5;
        const bool a = holds(corners, count, u, v), b = in_rug(u, v);
        both += a && b;
        either += a || b;
    }
    free(corners);
    image_release(&photo);
    return either ? (double)both / either : 0;
}

static void a_rug_ends_where_its_colour_does(void **state)
{
    (void)state;
    paint(2.5);
    assert_true(overlap(100, 70) > 0.95);
    paint(0.5);
    assert_true(overlap(150, 90) > 0.95);
}

static void a_chair_may_stand_on_it(void **state)
{
    (void)state;
    paint(2.5);
    for (int i = 0; i < W * H; i++)
        if (i % W > 130 && i % W < 145 && i / W < 90) shown[i] = 0;
    assert_true(overlap(100, 70) > 0.95);
}

/* The lamp is as bright on the floor as the rug, and touches it; it fades within 25 pixels. */
static void a_reflection_beside_it_is_left_out(void **state)
{
    (void)state;
    paint(2);
    for (int i = 0; i < W * H; i++) {
        const double far = hypot(i % W + 0.5 - 175, i / W + 0.5 - 105);
        const double more = 1 + 1.2 * exp(-far * far / (2 * 12 * 12.0));
        for (int c = 0; c < 3 && !in_rug(i % W + 0.5, i / W + 0.5); c++) photo.data[4 * i + c] *= (float)more;
    }
    assert_true(overlap(100, 70) > 0.9);
}

static void a_floor_alone_has_no_outline(void **state)
{
    (void)state;
    paint(1);
    assert_true(overlap(100, 70) <= 0);
}

static void what_shows_no_face_has_none(void **state)
{
    (void)state;
    paint(2.5);
    memset(shown, 0, sizeof shown);
    assert_true(overlap(100, 70) <= 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rug_ends_where_its_colour_does),   cmocka_unit_test(a_chair_may_stand_on_it),
        cmocka_unit_test(a_reflection_beside_it_is_left_out), cmocka_unit_test(a_floor_alone_has_no_outline),
        cmocka_unit_test(what_shows_no_face_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
