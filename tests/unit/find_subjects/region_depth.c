/* region_depth.c - median depths in rectangles of synthetic layers. */
#include "stages/find_subjects/region_depth.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

enum { W = 40, H = 30 };

/* Segment 1 at depth 2 to the left of column 20, segment 2 at depth 8 to the right. */
static void make_layers(struct layered_depth *d, double left_confidence)
{
    struct err err = ERR_INIT;
    assert_int_equal(layered_depth_init(d, W, H, &err), ST_OK);
    d->segments = calloc(2, sizeof *d->segments);
    assert_non_null(d->segments);
    d->segment_count = 2;
    d->segments[0] = (struct depth_segment){.id = 1, .confidence = left_confidence};
    d->segments[1] = (struct depth_segment){.id = 2, .confidence = 1};
    for (int p = 0; p < W * H; p++) {
        const bool right = p % W >= 20;
        d->interior.id[p] = right ? 2 : 1;
        d->interior.z[p] = right ? 8 : 2;
        d->interior.rgba[4 * p + 3] = 1;
    }
}

static double depth_in(const struct layered_depth *d, double x0, double y0, double x1, double y1)
{
    const struct subject s = {.x0 = x0, .y0 = y0, .x1 = x1, .y1 = y1};
    struct err err = ERR_INIT;
    double depth = -1;
    assert_int_equal(region_depth(&depth, d, &s, &err), ST_OK);
    return depth;
}

static void the_larger_part_decides_the_depth(void **state)
{
    (void)state;
    struct layered_depth d;
    make_layers(&d, 1);
    assert_true(depth_in(&d, 5, 5, 30, 20) == 2);
    assert_true(depth_in(&d, 12, 5, 30, 20) == 8);
    assert_true(depth_in(&d, 5.2, 5.2, 5.3, 5.3) == 2); /* smaller than one pixel */
    assert_true(depth_in(&d, 39.9, 29.9, 40, 30) == 8);
    layered_depth_release(&d);
}

static void segments_of_low_confidence_have_a_lower_weight(void **state)
{
    (void)state;
    struct layered_depth d;
    make_layers(&d, 0);
    assert_true(depth_in(&d, 5, 5, 30, 20) == 8);
    assert_true(depth_in(&d, 5, 5, 15, 20) == 2); /* still used if there are no others */
    layered_depth_release(&d);
}

static void layers_are_weighted_by_alpha(void **state)
{
    (void)state;
    struct layered_depth d;
    make_layers(&d, 1);
    for (int p = 0; p < W * H; p++) { /* alpha 3/4 of segment 1 in every pixel */
        d.interior.rgba[4 * p + 3] = 0.25F;
        d.boundary.id[p] = 1;
        d.boundary.z[p] = 3;
        d.boundary.rgba[4 * p + 3] = 0.75F;
    }
    assert_true(depth_in(&d, 0, 0, W, H) == 3);
    layered_depth_release(&d);
}

static void a_rectangle_without_depth_has_depth_0(void **state)
{
    (void)state;
    struct layered_depth d;
    make_layers(&d, 1);
    for (int p = 0; p < W * H; p++)
        if (p % W < 20) d.interior.id[p] = 0, d.interior.z[p] = 0, d.interior.rgba[4 * p + 3] = 0;
    assert_true(depth_in(&d, 2, 2, 18, 20) == 0);
    assert_true(depth_in(&d, 2, 2, 21, 20) == 8);
    layered_depth_release(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_larger_part_decides_the_depth),
        cmocka_unit_test(segments_of_low_confidence_have_a_lower_weight),
        cmocka_unit_test(layers_are_weighted_by_alpha),
        cmocka_unit_test(a_rectangle_without_depth_has_depth_0),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
