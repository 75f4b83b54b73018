/* The graph of a tour: weights, which ways are open, shortest ways. */
#include "tests/unit/plan_tour/walk.h"

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
    assert_true(model_rays_way_is_free(&w.rays, a, b, 0.2999));
    assert_false(model_rays_way_is_free(&w.rays, a, b, 0.3001));
    assert_true(model_rays_way_is_free(&w.rays, a, a, 0.9999)); /* from the wall x = -3 */
    assert_false(model_rays_way_is_free(&w.rays, a, a, 1.0001));
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

static void photos_cut_from_one_panorama_are_no_step_apart(void **state)
{
    (void)state;
    const struct box boxes[] = {HALL_OUTSIDE, HALL_INSIDE};
    const struct place places[] = {
        {"p1", {-2, 0, 1.5}, 0}, {"p2", {-2 + 1e-9, 0, 1.5}, 60}, {"p3", {-1, 0, 1.5}, 0}, {"p4", {-1, 1e-9, 1.5}, 60}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, boxes, 2, places, 4);
    w.axes.metric = false;
    assert_ok(walk_graph(&w, &err), err);
    assert_float_equal(w.g.unit, 1, 1e-6);
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
        cmocka_unit_test(weights_are_finite_for_coincident_viewpoints),
        cmocka_unit_test(no_way_leads_through_a_wall_however_thin),
        cmocka_unit_test(a_way_keeps_the_clearance_all_along),
        cmocka_unit_test(a_viewpoint_near_a_thin_pane_is_left_out),
        cmocka_unit_test(a_viewpoint_inside_what_an_edit_adds_is_left_out),
        cmocka_unit_test(without_a_scale_a_step_is_the_median_spacing),
        cmocka_unit_test(photos_cut_from_one_panorama_are_no_step_apart),
        cmocka_unit_test(the_shortest_way_goes_through_the_gap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
