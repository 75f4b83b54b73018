/* The graph of a tour: distances from surfaces, weights, which ways are open, shortest ways. */
#include "tests/unit/plan_tour/walk.h"

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
    assert_float_equal(segment_triangle_distance(over, over, c), 1, 1e-12);
    assert_float_equal(segment_triangle_distance(over, high, c), 1, 1e-12);
    assert_float_equal(segment_triangle_distance(over, under, c), 0, 0);
    assert_float_equal(segment_triangle_distance(beside, beside, c), 3, 1e-12);
    /* past an edge, above the plane: parallel to the edge, and across its line */
    assert_float_equal(segment_triangle_distance(vec3_make(-1, -3, 4), vec3_make(5, -3, 4), c), 5, 1e-12);
    assert_float_equal(segment_triangle_distance(vec3_make(1, -3, -9), vec3_make(1, -3, 9), c), 3, 1e-12);
    /* beyond the corner (2, 0) */
    assert_float_equal(segment_triangle_distance(vec3_make(5, -4, 0), vec3_make(9, -4, 0), c), 5, 1e-12);
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
        const double d = segment_triangle_distance(p[0], p[1], p + 2);
        assert_true(d <= least + 1e-12);
        assert_true(d > least - 0.12); /* the points are up to 0.06 apart on the segment and on the triangle */
    }
}

static void weights_are_finite_for_coincident_viewpoints(void **state)
{
    (void)state;
    assert_float_equal(tour_weight(0, 0), 1, 1e-12);
    assert_float_equal(tour_weight(0, M_PI), 1 + M_PI, 1e-12);             /* theta for theta / max(0, 2/pi) */
    assert_float_equal(tour_weight(2, M_PI), 1 + 2 + 1, 1e-12);            /* the thesis' formula */
    assert_float_equal(tour_weight(2 / M_PI, 1), 1 + 2 / M_PI + 1, 1e-12); /* where the two rules meet */
}

static void no_way_leads_through_a_wall_however_thin(void **state)
{
    (void)state;
    const struct box boxes[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION};
    const struct place places[] = {{"p1", {-2, 0, 1.5}, 0}, {"p2", {-1, 0, 1.5}, 90}, {"p3", {1, 0, 1.5}, 0}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, boxes, 3, places, 3);
    assert_ok(walk_graph(&w, &err), err);
    assert_true(isfinite(w.g.weights[0 * 3 + 1]));
    assert_float_equal(w.g.weights[1], tour_weight(1, M_PI / 2), 1e-6);
    assert_true(isinf(w.g.weights[0 * 3 + 2]) && isinf(w.g.weights[2 * 3 + 1]));
    walk_release(&w);
}

static void a_way_keeps_the_clearance_all_along(void **state)
{
    (void)state;
    /* a post whose corner is 0.3 from the way between two viewpoints */
    const struct box boxes[] = {HALL_OUTSIDE, HALL_INSIDE, {"post", "post", {0, 0.3, 0.001}, {0.1, 0.4, 2}, false}};
    const struct vec3 a = {-2, 0, 1.5}, b = {2, 0, 1.5};
    const struct place places[] = {{"p1", a, 0}, {"p2", b, 0}};
    struct walk w;
    walk_make(&w, boxes, 3, places, 2);
    assert_true(tour_way_is_free(&w.rays, a, b, 0.2999));
    assert_false(tour_way_is_free(&w.rays, a, b, 0.3001));
    assert_true(tour_way_is_free(&w.rays, a, a, 0.9999)); /* from the wall x = -3 */
    assert_false(tour_way_is_free(&w.rays, a, a, 1.0001));
    walk_release(&w);
}

static void a_viewpoint_near_a_thin_pane_is_left_out(void **state)
{
    (void)state;
    const struct box boxes[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION};
    const struct place places[] = {{"p1", {-0.1, 0.2, 1.3}, 0}, {"p2", {-1, 0, 1.5}, 90}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, boxes, 3, places, 2);
    assert_ok(walk_graph(&w, &err), err);
    assert_false(w.g.nodes[0].usable);
    assert_true(w.g.nodes[1].usable);
    walk_release(&w);
}

static void a_viewpoint_inside_what_an_edit_adds_is_left_out(void **state)
{
    (void)state;
    const struct box boxes[] = {
        HALL_OUTSIDE, HALL_INSIDE, {"box/pier", "pier", {-0.5, -0.5, 0.001}, {0.5, 0.5, 2.4}, false}};
    const struct place places[] = {{"p1", {0, 0, 1.5}, 0}, {"p2", {-2, 0, 1.5}, 90}, {"p3", {2, 1.5, 1.5}, 90}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, boxes, 3, places, 3);
    assert_ok(walk_graph(&w, &err), err);
    assert_false(w.g.nodes[0].usable);
    for (int k = 1; k < 3; k++) assert_true(isinf(w.g.weights[k]));
    walk_release(&w);

    walk_make(&w, boxes, 3, places, 1);
    assert_int_equal(walk_graph(&w, &err), ST_DATA);
    assert_err(err, ST_DATA, "none of the 1 viewpoints");
    walk_release(&w);
}

static void without_a_scale_a_step_is_the_median_spacing(void **state)
{
    (void)state;
    const struct box boxes[] = {HALL_OUTSIDE, HALL_INSIDE};
    const struct place places[] = {{"p1", {-2, 0, 1.5}, 0}, {"p2", {-1.5, 0, 1.5}, 0}, {"p3", {-1, 0, 1.5}, 0}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, boxes, 2, places, 3);
    w.axes.metric = false;
    assert_ok(walk_graph(&w, &err), err);
    assert_float_equal(w.g.unit, 0.5, 1e-12);
    assert_float_equal(w.g.weights[1], 2, 1e-6);
    walk_release(&w);
}

static void the_shortest_way_goes_through_the_gap(void **state)
{
    (void)state;
    const struct box boxes[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION_WITH_GAP};
    const struct place places[] = {{"p1", {-2, -1, 1.5}, 0}, {"p2", {0, 1.4, 1.5}, 0}, {"p3", {2, -1, 1.5}, 0}};
    struct walk w;
    struct err err = ERR_INIT;
    double costs[3];
    int before[3];
    walk_make(&w, boxes, 3, places, 3);
    assert_ok(walk_graph(&w, &err), err);
    assert_ok(tour_shortest(costs, before, &w.g, 0, &err), err);
    assert_int_equal(before[2], 1);
    assert_int_equal(before[1], 0);
    assert_int_equal(before[0], -1);
    assert_float_equal(costs[2], 2 * tour_weight(hypot(2, 2.4), 0), 1e-5);
    walk_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_of_a_segment_from_a_triangle_are_exact),
        cmocka_unit_test(distances_agree_with_points_all_over_both),
        cmocka_unit_test(weights_are_finite_for_coincident_viewpoints),
        cmocka_unit_test(no_way_leads_through_a_wall_however_thin),
        cmocka_unit_test(a_way_keeps_the_clearance_all_along),
        cmocka_unit_test(a_viewpoint_near_a_thin_pane_is_left_out),
        cmocka_unit_test(a_viewpoint_inside_what_an_edit_adds_is_left_out),
        cmocka_unit_test(without_a_scale_a_step_is_the_median_spacing),
        cmocka_unit_test(the_shortest_way_goes_through_the_gap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
