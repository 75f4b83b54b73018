/* inherit.c - border areas that nothing holds in the foreground take over what lies behind them; other areas keep their
 * depth. */
#include "stages/segment_depth/inherit.h"

#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"

static struct plane planes[MAX_SEGMENTS], before[MAX_SEGMENTS];
static double confidence[MAX_SEGMENTS];
static bool inherited[MAX_SEGMENTS];
static bool cautious;

static const double card_depth = 1 / 0.42;

/* A wall on its true planes, all of it matched; and a blue card in front of it, not yet at its depth. */
static void start_with_card(double x0, double y0, double x1, double y1)
{
    bench_empty();
    scene_wall(&b.scene, 0, 0, 5, 8, 8, 0.2);
    const double scale = card_depth / FOCAL;
    struct painted_surface *card =
        scene_wall(&b.scene, scale * (0.5 * (x0 + x1) - W / 2), scale * (0.5 * (y0 + y1) - H / 2), card_depth,
                   scale * 0.5 * (x1 - x0), scale * 0.5 * (y1 - y0), 0);
    card->colour[0] = 0.05f;
    card->colour[2] = 0.6f;
    bench_views();
    bench_make(0.12, 0.45);
    b.params.jump = 4;
    b.scene.surface_count = 1; /* from here on the truth is the wall */
    const double slope = (bench_truth(90, 50) - bench_truth(50, 50)) / 40;
    for (int i = 0; i < b.segments.count; i++) {
        planes[i] = (struct plane){slope, 0, bench_truth(50, 50) - slope * 50};
        confidence[i] = 1;
        inherited[i] = false;
    }
}

static void start(void) { start_with_card(-400, 0, -399, 1); }

/* Puts the segments of a rectangle at an inverse depth. Returns how many. */
static int put_at(double inverse_z, double x0, double y0, double x1, double y1, double sure)
{
    int count = 0;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (!(g->cx >= x0 && g->cx < x1 && g->cy >= y0 && g->cy < y1)) continue;
        planes[i] = (struct plane){0, 0, inverse_z};
        confidence[i] = sure;
        count++;
    }
    return count;
}

static int put_in_front(double x0, double y0, double x1, double y1, double sure)
{
    return put_at(0.42, x0, y0, x1, y1, sure);
}

static void inherit(void)
{
    struct err err = ERR_INIT;
    memcpy(before, planes, sizeof before);
    if (inherit_planes(planes, inherited, confidence, &b.problem, cautious, &err)) fail_msg("%s", err.text);
}

static void must_stay(void)
{
    inherit();
    for (int i = 0; i < b.segments.count; i++) assert_false(inherited[i]);
    assert_memory_equal(planes, before, sizeof planes);
    bench_release();
}

/* The rectangle at each side of the picture, and a few segments in it that match something by chance. */
static void a_block_at_any_side_takes_over_the_wall(void **state)
{
    (void)state;
    static const double sides[][4] = {{0, 30, 40, 70}, {100, 30, W, 70}, {50, 0, 90, 40}, {50, 60, 90, H}};
    for (int k = 0; k < 4; k++) {
        const double *r = sides[k];
        start();
        assert_true(put_in_front(r[0], r[1], r[2], r[3], 0) > 15);
        for (int i = 0; i < b.segments.count; i += 5) {
            bool alone = planes[i].c > 0.4;
            for (int t = b.segments.first_border[i]; t < b.segments.first_border[i + 1]; t++) {
                const int j = b.segments.borders[t].other;
                alone = alone && planes[j].c > 0.4 && !(confidence[j] > 0);
            }
            if (alone) confidence[i] = 0.9;
        }
        inherit();
        for (int i = 0; i < b.segments.count; i++) {
            const struct segment *g = &b.segments.segments[i];
            const bool inside = before[i].c > 0.4;
            assert_int_equal(inherited[i], inside);
            if (inside) assert_near(plane_at(planes[i], g->cx, g->cy) / bench_truth(g->cx, g->cy), 1, 0.01);
            if (!inside) assert_memory_equal(&planes[i], &before[i], sizeof planes[i]);
        }
        bench_release();
    }
}

/* The same with areas far behind the wall: what only one view sees at its border continues the wall. */
static void a_hole_at_any_side_takes_over_the_wall(void **state)
{
    (void)state;
    static const double sides[][4] = {{0, 30, 40, 70}, {100, 30, W, 70}, {50, 0, 90, 40}, {50, 60, 90, H}};
    for (int k = 0; k < 4; k++) {
        const double *r = sides[k];
        int filled = 0;
        start();
        b.problem.min_inverse_z = 0.02;
        put_at(0.03, r[0], r[1], r[2], r[3], 0);
        inherit();
        for (int i = 0; i < b.segments.count; i++) {
            const struct segment *g = &b.segments.segments[i];
            assert_int_equal(inherited[i], before[i].c == 0.03);
            if (!inherited[i]) continue;
            assert_near(plane_at(planes[i], g->cx, g->cy) / bench_truth(g->cx, g->cy), 1, 0.01);
            filled++;
        }
        assert_true(filled > 15);
        bench_release();
    }
}

/* A window at the border, whose view is matched. */
static void a_hole_that_is_seen_stays(void **state)
{
    (void)state;
    start();
    b.problem.min_inverse_z = 0.02;
    put_at(0.03, 0, 30, 40, 70, 0.5);
    must_stay();
}

/* The floor is known, and a corner of the picture that nothing matches lies below it, on the plane of a wall that ends
 * elsewhere. */
static void nothing_unseen_lies_below_the_floor(void **state)
{
    (void)state;
    static struct scene_planes scene;
    static int expected[MAX_SEGMENTS];
    struct plane_prior prior = {.count = 2, .expected = expected};
    int below = 0, on_floor = 0;
    start();
    b.problem.min_inverse_z = 0.02;
    const struct plane floor = plane_of_normal(b.problem.view, vec3_make(0, 1, 0)), wall = {0.0001, 0, 0.03};
    scene = (struct scene_planes){.count = 2, .known = 2};
    scene_planes_set(&scene, 0, floor);
    scene_planes_set(&scene, 1, wall);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        expected[i] = plane_at(floor, g->cx, g->cy) > bench_truth(g->cx, g->cy) ? 0 : -1;
        if (expected[i] == 0) planes[i] = floor;
        if (g->cx > 60 || expected[i] < 0) continue;
        planes[i] = wall;
        confidence[i] = 0;
    }
    b.problem.scene = &scene;
    b.problem.prior = &prior;
    inherit();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        assert_int_equal(inherited[i], before[i].c == wall.c);
        if (!inherited[i]) continue;
        const double off = plane_at(planes[i], g->cx, g->cy) - plane_at(floor, g->cx, g->cy);
        assert_true(off > -0.1 * plane_at(floor, g->cx, g->cy));
        on_floor += fabs(off) < 0.01 * plane_at(floor, g->cx, g->cy);
        below++;
    }
    assert_true(below > 15 && on_floor > 0.7 * below); /* others continue the wall beside them */
    bench_release();
}

/* A segment is expected where its middle lies. A plane that is behind the camera for another part is not taken. */
static void a_floor_is_not_taken_above_the_horizon(void **state)
{
    (void)state;
    static struct scene_planes scene;
    static int expected[MAX_SEGMENTS];
    struct plane_prior prior = {.count = 1, .expected = expected};
    int below = 0;
    start();
    b.problem.min_inverse_z = 0.02;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        expected[i] = -1;
        if (below || g->x0 || g->y0 || !(g->cy - g->y0 > 1)) continue; /* the corner of the picture */
        const double slope = 1 / (g->cy - g->y0); /* 0.25 at the centre, less than 0 at the first row */
        scene = (struct scene_planes){.count = 1, .known = 1};
        scene_planes_set(&scene, 0, (struct plane){0, slope, 0.25 - slope * g->cy});
        expected[i] = 0;
        planes[i] = (struct plane){0, 0, 0.03};
        confidence[i] = 0;
        below++;
    }
    assert_int_equal(below, 1);
    b.problem.scene = &scene;
    b.problem.prior = &prior;
    inherit();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        for (int corner = 0; corner < 4; corner++)
            assert_true(plane_at(planes[i], corner % 2 ? g->x1 : g->x0, corner / 2 ? g->y1 : g->y0) > 0);
    }
    bench_release();
}

/* On a dominant plane of the scene a block that nothing matches stays: it is the near end of a ceiling. */
static void a_block_on_a_plane_of_the_scene_stays(void **state)
{
    (void)state;
    static struct scene_planes scene;
    start();
    assert_true(put_in_front(50, 0, 90, 40, 0) > 15);
    scene = (struct scene_planes){.count = 1};
    scene_planes_set(&scene, 0, (struct plane){0, 0, 0.42});
    b.problem.scene = &scene;
    inherit();
    assert_memory_equal(planes, before, (size_t)b.segments.count * sizeof *planes);
    for (int i = 0; i < b.segments.count; i++) assert_false(inherited[i]);
    bench_release();
}

/* A matched object stands at the edge of the block, nearer than the wall: the block takes over the wall's depth. */
static void a_block_beside_foreground_takes_over_the_wall(void **state)
{
    (void)state;
    start();
    put_in_front(0, 30, 40, 70, 0);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (g->cx >= 40 && g->cx < 70 && g->cy >= 40 && g->cy < 60) planes[i] = (struct plane){0, 0, 0.34};
    }
    inherit();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        assert_int_equal(inherited[i], before[i].c > 0.4);
        if (inherited[i]) assert_near(plane_at(planes[i], g->cx, g->cy) / bench_truth(g->cx, g->cy), 1, 0.01);
    }
    bench_release();
}

/* A card of its own colour, matched, and the wall beside it as near as the card, up to the picture's border: the wall
 * is cut off from the card and continued. Then the same with a card that reaches the border, but is unsure there. */
static void a_block_is_cut_off_from_the_foreground_that_it_touches(void **state)
{
    (void)state;
    for (int end = 0; end < 2; end++) {
        const double card[4] = {end ? -30 : 40, 30, 100, 70};
        int walls = 0;
        start_with_card(card[0], card[1], card[2], card[3]);
        put_in_front(0, 10, 40, 90, 0);
        put_in_front(card[0], 30, 100, 70, 1);
        if (end) put_in_front(0, 30, 40, 70, 0);
        inherit();
        for (int i = 0; i < b.segments.count; i++) {
            const struct segment *g = &b.segments.segments[i];
            const bool of_card = g->x0 >= card[0] && g->x1 < 100 && g->y0 >= 30 && g->y1 < 70;
            const bool apart = g->x1 + 1 < card[0] || g->y1 + 1 < 30 || g->y0 > 70;
            if (!inherited[i]) assert_memory_equal(&planes[i], &before[i], sizeof planes[i]);
            if (of_card) assert_false(inherited[i]);
            if (!apart || !(before[i].c > 0.4)) continue;
            assert_true(inherited[i]);
            assert_near(plane_at(planes[i], g->cx, g->cy) / bench_truth(g->cx, g->cy), 1, 0.01);
            walls++;
        }
        assert_true(walls > 20);
        bench_release();
    }
}

/* Towards the border the wall comes nearer without a jump, but nothing matches there. */
static void a_ramp_does_not_hold_a_block(void **state)
{
    (void)state;
    int front = 0;
    start();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (!(g->cx < 60 && g->cy > 20 && g->cy < 80)) continue;
        const double near = fmin((60 - g->cx) / 25, 1);
        planes[i] = (struct plane){0, 0, bench_truth(g->cx, g->cy) * (1 - near) + 0.42 * near};
        confidence[i] = 0;
    }
    inherit();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (!(before[i].c > 0.4)) continue;
        assert_near(plane_at(planes[i], g->cx, g->cy) / bench_truth(g->cx, g->cy), 1, 0.02);
        front++;
    }
    assert_true(front > 15);
    bench_release();
}

/* A ceiling that comes near towards the border is blank there, beside a wall; its pieces have nearly one plane. */
static void a_blank_surface_stays_on_the_plane_of_its_matched_part(void **state)
{
    (void)state;
    int near = 0;
    start();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (g->cy > 50 || g->cx < 60) continue;
        const double wall = bench_truth(50, 50), lean = (0.42 - wall) / 50, piece = 0.002 * lean * (i % 3 - 1);
        planes[i] = (struct plane){piece, -lean, wall + 50 * lean - piece * g->cx};
        confidence[i] = g->cy > 30 ? 1 : 0;
    }
    inherit();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (g->cy > 30 || g->cx < 60) continue;
        assert_memory_equal(&planes[i], &before[i], sizeof before[i]);
        near += plane_at(before[i], g->cx, g->cy) > 0.35;
    }
    assert_true(near > 15);
    bench_release();
}

/* Inside the picture the last round moves an area back that matches the other views there. */
static void an_island_goes_back_to_the_wall_that_matches(void **state)
{
    (void)state;
    start();
    const int island = put_in_front(50, 30, 90, 70, 0);
    inherit();
    assert_true(island > 15);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        assert_int_equal(inherited[i], before[i].c > 0.4);
        assert_near(plane_at(planes[i], g->cx, g->cy) / bench_truth(g->cx, g->cy), 1, 0.01);
    }
    bench_release();

    cautious = true;
    start();
    put_in_front(50, 30, 90, 70, 0);
    must_stay();
    cautious = false;
}

/* A thin or plain object of which no segment is sure, though the views show it. */
static void an_island_that_views_confirm_stays(void **state)
{
    (void)state;
    start_with_card(50, 30, 90, 70);
    assert_true(put_in_front(50, 30, 90, 70, 0) > 15);
    must_stay();
}

/* Matched; with a matched rim; and the unmatched end of a matched object. */
static void other_areas_keep_their_depth(void **state)
{
    (void)state;
    start();
    put_in_front(0, 30, 40, 70, 0.5);
    must_stay();

    start();
    put_in_front(0, 20, 60, 80, 0.5);
    put_in_front(0, 40, 40, 60, 0);
    must_stay();

    start_with_card(-30, 30, 90, 70);
    put_in_front(0, 30, 90, 70, 0.5);
    put_in_front(0, 30, 20, 70, 0);
    must_stay();
}

/* The unsure end of a matched object of the wall's colour. */
static void only_the_last_round_cuts_foreground_of_the_same_colour(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        int moved = 0;
        start();
        put_in_front(0, 30, 100, 70, 0.5);
        const int unsure = put_in_front(0, 30, 40, 70, 0);
        cautious = !k;
        inherit();
        cautious = false;
        for (int i = 0; i < b.segments.count; i++) moved += inherited[i];
        assert_true(unsure > 15 && (k ? moved > 0.7 * unsure : moved < 0.2 * unsure)); /* early: corners only */
        bench_release();
    }
}

/* Nothing adjoins the block: it keeps its depth. */
static void a_block_that_fills_the_picture_keeps_its_depth(void **state)
{
    (void)state;
    start();
    put_in_front(0, 0, W, H, 0);
    must_stay();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_at_any_side_takes_over_the_wall),
        cmocka_unit_test(a_hole_at_any_side_takes_over_the_wall),
        cmocka_unit_test(a_hole_that_is_seen_stays),
        cmocka_unit_test(nothing_unseen_lies_below_the_floor),
        cmocka_unit_test(a_floor_is_not_taken_above_the_horizon),
        cmocka_unit_test(a_block_on_a_plane_of_the_scene_stays),
        cmocka_unit_test(a_block_beside_foreground_takes_over_the_wall),
        cmocka_unit_test(a_block_is_cut_off_from_the_foreground_that_it_touches),
        cmocka_unit_test(a_ramp_does_not_hold_a_block),
        cmocka_unit_test(a_blank_surface_stays_on_the_plane_of_its_matched_part),
        cmocka_unit_test(an_island_goes_back_to_the_wall_that_matches),
        cmocka_unit_test(an_island_that_views_confirm_stays),
        cmocka_unit_test(other_areas_keep_their_depth),
        cmocka_unit_test(only_the_last_round_cuts_foreground_of_the_same_colour),
        cmocka_unit_test(a_block_that_fills_the_picture_keeps_its_depth),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
