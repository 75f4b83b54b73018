/* evidence.c - the neighbours that count as evidence of a segment's plane, and those that it is matched with, on
 * photographs of a known wall. */
#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"

#define RANK_WEIGHT 0.6 /* of a neighbour relative to the next better one */

enum { LEFT = 1, RIGHT = 2, BOTH = 3 };

static struct plane truth;

/* A wall, and two neighbours of the first view that see three fifths of it each; a third sees nearly all. */
static void start(bool third)
{
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 8, 8, 0.2);
    scene_view(&b.scene, W, H, FOCAL, 0, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, -1.5, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, 1.5, 0, 0, 0);
    if (third) scene_view(&b.scene, W, H, FOCAL, 0.1, 0.3, 0, 0);
    bench_make(0.15, 0.4);
    const double slope = (bench_truth(90, 50) - bench_truth(50, 50)) / 40;
    truth = (struct plane){slope, 0, bench_truth(50, 50) - slope * 50};
}

/* The neighbours that see the whole segment on the wall; *part: those that see a part of it. */
static unsigned seen_by(int segment, unsigned *part)
{
    const struct segment *g = &b.segments.segments[segment];
    unsigned whole = 0;
    *part = 0;
    for (int k = 0; k < b.matcher.neighbour_count; k++) {
        const struct view *other = &b.scene.views[k + 1];
        int corners = 0;
        for (int c = 0; c < 4; c++) {
            const double u = c & 1 ? g->x1 + 1 : g->x0, v = c & 2 ? g->y1 + 1 : g->y0;
            double pu = -1, pv = -1;
            view_project(other, view_unproject(&b.scene.views[0], u, v, 1 / bench_truth(u, v)), &pu, &pv);
            corners += pu >= 1 && pv >= 1 && pu <= other->width - 1 && pv <= other->height - 1;
        }
        if (corners == 4) whole |= 1u << k;
        if (corners > 0 && corners < 4) *part |= 1u << k;
    }
    return whole;
}

static void only_neighbours_that_see_the_segment_are_evidence(void **state)
{
    (void)state;
    int with[4] = {0};
    start(false);
    for (int i = 0; i < b.segments.count; i++) {
        unsigned part;
        const unsigned whole = seen_by(i, &part);
        float cost = -7;
        if (part) continue;
        assert_int_equal(match_evidence(&b.matcher, i, truth, 0, &cost), (int)(whole & 1) + (int)(whole >> 1));
        if (!whole) assert_true(cost == MATCH_WORST);
        with[whole]++;
    }
    assert_true(with[LEFT] > 20 && with[RIGHT] > 20 && with[BOTH] > 10);
    bench_release();
}

static void occluded_and_excluded_neighbours_are_no_evidence(void **state)
{
    (void)state;
    start(true);
    for (int i = 0; i < b.segments.count; i++) {
        unsigned part;
        const unsigned whole = seen_by(i, &part);
        if (part || !(whole & 4)) continue;
        float all, without, excluded, none;
        const int count = match_evidence(&b.matcher, i, truth, 0, &all);
        assert_int_equal(match_evidence(&b.matcher, i, truth, 4, &without), count - 1);
        b.matcher.excluded = 4;
        assert_int_equal(match_evidence(&b.matcher, i, truth, 0, &excluded), count - 1);
        b.matcher.excluded = 0;
        assert_true(without == excluded);
        assert_int_equal(match_evidence(&b.matcher, i, truth, 7, &none), 0);
        assert_true(none == MATCH_WORST);
    }
    bench_release();
}

/* The better neighbour counts most; neighbours that do not see the segment change nothing. */
static void evidence_is_the_mean_by_rank_of_those_that_see_it(void **state)
{
    (void)state;
    int pairs = 0;
    start(true);
    for (int i = 0; i < b.segments.count; i++) {
        unsigned part;
        const unsigned whole = seen_by(i, &part);
        float each[3], both, best, wrong;
        int low = -1, high = -1;
        if (part || (whole != 5 && whole != 6)) continue;
        for (int k = 0; k < 3; k++) {
            if (!match_evidence(&b.matcher, i, truth, 7u & ~(1u << k), &each[k])) continue;
            if (low < 0 || each[k] < each[low])
                high = low, low = k;
            else
                high = k;
        }
        assert_true(low >= 0 && high >= 0);
        assert_int_equal(match_evidence(&b.matcher, i, truth, 0, &both), 2);
        assert_near(both, ((double)each[low] + RANK_WEIGHT * (double)each[high]) / (1 + RANK_WEIGHT), 1e-6);
        b.params.best_neighbours = 1;
        match_evidence(&b.matcher, i, truth, 0, &best);
        b.params.best_neighbours = MAX_NEIGHBOURS;
        assert_true(best == each[low]);
        const struct plane off = {truth.a, truth.b, truth.c + 8 * b.problem.step};
        match_evidence(&b.matcher, i, off, 0, &wrong);
        assert_true(both < 0.6f && wrong > both);
        pairs++;
    }
    assert_true(pairs > 20);
    bench_release();
}

/* Selects with the true plane of each segment; `occluded` is the same for all, or 0 for none. */
static void select_at_truth(int ranks, unsigned occluded)
{
    static struct plane planes[MAX_SEGMENTS];
    static unsigned all[MAX_SEGMENTS];
    struct err err = ERR_INIT;
    for (int i = 0; i < b.segments.count; i++) planes[i] = truth, all[i] = occluded;
    b.params.best_neighbours = ranks;
    if (match_select(&b.matcher, planes, occluded ? all : NULL, &err)) fail_msg("%s", err.text);
}

static void few_neighbours_are_all_kept(void **state)
{
    (void)state;
    start(true);
    select_at_truth(3, 1);
    assert_null(b.matcher.use);
    bench_release();
}

static void a_segment_is_matched_with_neighbours_that_see_it(void **state)
{
    (void)state;
    int chosen[4] = {0};
    start(false);
    select_at_truth(1, 0);
    for (int i = 0; i < b.segments.count; i++) {
        unsigned part;
        const unsigned whole = seen_by(i, &part);
        assert_true(b.matcher.use[i] == LEFT || b.matcher.use[i] == RIGHT);
        if (part || (whole != LEFT && whole != RIGHT)) continue;
        assert_int_equal(b.matcher.use[i], whole);
        chosen[whole]++;
        /* from now on the cost is that of the one neighbour */
        float alone;
        match_evidence(&b.matcher, i, truth, BOTH & ~whole, &alone);
        assert_near(match_cost(&b.matcher, i, truth, 0), alone, 1e-6);
    }
    assert_true(chosen[LEFT] > 20 && chosen[RIGHT] > 20);
    bench_release();
}

static void occluded_neighbours_come_last_and_excluded_ones_never(void **state)
{
    (void)state;
    start(true);
    select_at_truth(2, 4);
    for (int i = 0; i < b.segments.count; i++) assert_int_equal(b.matcher.use[i], BOTH); /* even where unseen */
    bench_release();

    start(true);
    b.matcher.excluded = 4;
    select_at_truth(2, 0);
    for (int i = 0; i < b.segments.count; i++) assert_int_equal(b.matcher.use[i], BOTH);
    bench_release();
}

/* A card hides a part of the wall from the third neighbour only. */
static void a_neighbour_that_shows_something_else_is_left_out(void **state)
{
    (void)state;
    int hidden = 0;
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 8, 8, 0.2);
    for (int k = 0; k < 4; k++)
        scene_view(&b.scene, W, H, FOCAL, k == 1 ? -0.2 : k == 2 ? 0.2 : 0, k == 3 ? -1.2 : 0, 0, 0);
    struct painted_surface *card = scene_wall(&b.scene, 0, -1.15, 1, 0.12, 0.12, 0);
    card->colour[0] = 0.05f;
    card->colour[2] = 0.6f;
    bench_make(0.15, 0.4);
    const double slope = (bench_truth(90, 50) - bench_truth(50, 50)) / 40;
    truth = (struct plane){slope, 0, bench_truth(50, 50) - slope * 50};
    select_at_truth(2, 0);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        int covered = 0;
        for (int c = 0; c < 4; c++) {
            const double u = c & 1 ? g->x1 + 1 : g->x0, v = c & 2 ? g->y1 + 1 : g->y0;
            double pu = -1, pv = -1;
            int at = -1;
            view_project(&b.scene.views[3], view_unproject(&b.scene.views[0], u, v, 1 / bench_truth(u, v)), &pu, &pv);
            scene_depth(&b.scene, &b.scene.views[3], pu, pv, &at);
            covered += at == 1;
        }
        if (covered < 4) continue;
        assert_int_equal(b.matcher.use[i], BOTH);
        hidden++;
    }
    assert_true(hidden > 5);
    bench_release();
}

/* 14 is what furniture_sweep.c asks for. */
static void a_blank_wall_has_no_texture(void **state)
{
    (void)state;
    bench_empty();
    scene_wall(&b.scene, -4, 0, 4, 4, 8, 0)->contrast = 0;
    scene_wall(&b.scene, 4, 0, 4, 4, 8, 0);
    scene_view(&b.scene, W, H, FOCAL, 0, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, 0.3, 0, 0, 0);
    bench_make(0.15, 0.4);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (g->x1 < W / 2 - 2) assert_near(match_texture(&b.matcher, i), 0, 1e-9);
        if (g->x0 > W / 2 + 2) assert_true(match_texture(&b.matcher, i) > 14 && match_texture(&b.matcher, i) < 30);
    }
    bench_release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blank_wall_has_no_texture),
        cmocka_unit_test(only_neighbours_that_see_the_segment_are_evidence),
        cmocka_unit_test(occluded_and_excluded_neighbours_are_no_evidence),
        cmocka_unit_test(evidence_is_the_mean_by_rank_of_those_that_see_it),
        cmocka_unit_test(few_neighbours_are_all_kept),
        cmocka_unit_test(a_segment_is_matched_with_neighbours_that_see_it),
        cmocka_unit_test(occluded_neighbours_come_last_and_excluded_ones_never),
        cmocka_unit_test(a_neighbour_that_shows_something_else_is_left_out),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
