/* Distances from the surfaces of a solid model: exact for points and ways, however thin the solid. */
#include "common/light/model_clearance.h"

#include <math.h>

#include "tests/unit/box_solids.h"

static double next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 16777216.0;
}

static void distances_of_a_segment_from_a_triangle_are_exact(void **state)
{
    (void)state;
    const struct vec3 c[3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    const struct vec3 over = {0.5, 0.5, 1}, under = {0.5, 0.5, -1}, beside = {-3, 0.5, 0}, high = {0.7, 0.4, 3};
    assert_float_equal(clearance_of_triangle(over, over, c), 1, 1e-12);
    assert_float_equal(clearance_of_triangle(over, high, c), 1, 1e-12);
    assert_float_equal(clearance_of_triangle(over, under, c), 0, 0);
    assert_float_equal(clearance_of_triangle(beside, beside, c), 3, 1e-12);
    /* past an edge, above the plane: parallel to the edge, and across its line */
    assert_float_equal(clearance_of_triangle(vec3_make(-1, -3, 4), vec3_make(5, -3, 4), c), 5, 1e-12);
    assert_float_equal(clearance_of_triangle(vec3_make(1, -3, -9), vec3_make(1, -3, 9), c), 3, 1e-12);
    /* beyond the corner (2, 0) */
    assert_float_equal(clearance_of_triangle(vec3_make(5, -4, 0), vec3_make(9, -4, 0), c), 5, 1e-12);
}

static void distances_agree_with_points_all_over_both(void **state)
{
    (void)state;
    enum { STEPS = 60 };
    uint32_t seed = 20;
    for (int trial = 0; trial < 40; trial++) {
        struct vec3 p[5];
        double least = INFINITY;
        for (int i = 0; i < 5; i++) {
            const double x = next_random(&seed), y = next_random(&seed);
            p[i] = vec3_make(2 * x, 2 * y, 2 * next_random(&seed));
        }
        for (int s = 0; s <= STEPS; s++)
            for (int u = 0; u <= STEPS; u++)
                for (int v = 0; u + v <= STEPS; v++) {
                    const struct vec3 on = vec3_add(p[0], vec3_scale(vec3_sub(p[1], p[0]), (double)s / STEPS));
                    const struct vec3 at = vec3_add(vec3_scale(vec3_sub(p[3], p[2]), (double)u / STEPS),
                                                    vec3_scale(vec3_sub(p[4], p[2]), (double)v / STEPS));
                    least = fmin(least, vec3_length(vec3_sub(on, vec3_add(p[2], at))));
                }
        const double d = clearance_of_triangle(p[0], p[1], p + 2);
        assert_true(d <= least + 1e-12);
        assert_true(d > least - 0.12); /* the points are up to 0.06 apart on the segment and on the triangle */
    }
}

/* -------------------------------------------------------------------------------------------------------- points */

/* A pane a tenth of a millimetre thick. */
static const struct box PANE = {"glass/w", "pane", {0, -1, -1}, {1e-4, 1, 1}, false};

static void a_solid_thinner_than_the_margin_is_not_missed(void **state)
{
    (void)state;
    struct model_rays m = make_rays(&PANE, 1);
    for (int i = 0; i < 50; i++) {
        const struct vec3 before = {-0.1, -0.9 + 0.037 * i, 0.9 - 0.031 * i}, behind = {1e-4 + 0.1, before.y, before.z};
        assert_true(model_rays_inside(&m, before, 0.1001) && model_rays_inside(&m, behind, 0.1001));
        assert_false(model_rays_inside(&m, before, 0.0999) || model_rays_inside(&m, behind, 0.0999));
    }
    assert_true(model_rays_inside(&m, vec3_make(-7, 0, 0), 7.1)); /* a margin larger than the solid */
    assert_false(model_rays_inside(&m, vec3_make(-7, 0, 0), 6.9));
    model_rays_release(&m);
}

static void the_margin_is_round_at_edges_and_corners(void **state)
{
    (void)state;
    struct model_rays m = make_rays(&(struct box){"walls", "cube", {-1, -1, -1}, {1, 1, 1}, false}, 1);
    const struct vec3 edge = {1.3, 1.4, 0.2}, corner = {-1.1, 1.2, -1.2}; /* 0.5 and 0.3 away */
    assert_true(model_rays_inside(&m, edge, 0.5 + 1e-9));
    assert_false(model_rays_inside(&m, edge, 0.5 - 1e-9));
    assert_true(model_rays_inside(&m, corner, 0.3 + 1e-9));
    assert_false(model_rays_inside(&m, corner, 0.3 - 1e-9));
    model_rays_release(&m);
}

static void points_inside_are_found_without_a_margin(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    uint32_t seed = 4;
    for (int i = 0; i < 500; i++) {
        const double x = 8 * next_random(&seed) - 4, y = 8 * next_random(&seed) - 4, z = 8 * next_random(&seed) - 4;
        const double out = fmax(fabs(x), fmax(fabs(y), fabs(z)));
        assert_int_equal(model_rays_inside(&m, vec3_make(x, y, z), 0), out > 2 && out < 3);
    }
    assert_true(model_rays_inside(&m, vec3_make(0, 0, 2.5), 0.1)); /* further than the margin from any surface */
    assert_false(model_rays_inside(&m, vec3_make(0, 0, 0), 1.999));
    assert_true(model_rays_inside(&m, vec3_make(0, 0, 0), 2.001));
    model_rays_release(&m);
}

static void a_camera_on_a_surface_is_enclosed(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    assert_true(model_rays_enclose(&m, vec3_make(0.3, 0.2, 2)));
    assert_true(model_rays_enclose(&m, vec3_make(0.3, 0.2, 2 - 5e-6))); /* the room is 6 wide */
    assert_false(model_rays_enclose(&m, vec3_make(0.3, 0.2, 2 - 7e-6)));
    model_rays_release(&m);
}

static void a_way_through_a_thin_pane_is_not_free(void **state)
{
    (void)state;
    struct model_rays m = make_rays(&PANE, 1);
    const struct vec3 a = {-1, 0, 0}, b = {1, 0.3, 0.4}, past = {1, 0, 3};
    assert_false(model_rays_way_is_free(&m, a, b, 1e-9));
    assert_true(model_rays_way_is_free(&m, a, past, 0.25)); /* past the edge z = 1 */
    assert_false(model_rays_way_is_free(&m, a, past, 0.3));
    model_rays_release(&m);
}

static void a_model_without_solids_is_nowhere_near(void **state)
{
    (void)state;
    struct model_rays m = {0};
    assert_false(model_rays_inside(&m, vec3_make(0, 0, 0), 1000));
    assert_true(model_rays_way_is_free(&m, vec3_make(0, 0, 0), vec3_make(1, 0, 0), 1000));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_of_a_segment_from_a_triangle_are_exact),
        cmocka_unit_test(distances_agree_with_points_all_over_both),
        cmocka_unit_test(a_solid_thinner_than_the_margin_is_not_missed),
        cmocka_unit_test(the_margin_is_round_at_edges_and_corners),
        cmocka_unit_test(points_inside_are_found_without_a_margin),
        cmocka_unit_test(a_camera_on_a_surface_is_enclosed),
        cmocka_unit_test(a_way_through_a_thin_pane_is_not_free),
        cmocka_unit_test(a_model_without_solids_is_nowhere_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
