/* pixel_planes.c - pixels of a card and of the wall behind it, which segments do not tell apart. */
#include "stages/segment_depth/pixel_planes.h"

#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"
#include "stages/segment_depth/match_features.h"

static struct plane planes[MAX_SEGMENTS];
static int label[W * H];

/* A card in front of a wall, both of one paint; each segment has the true plane of its middle. */
static void start(double contrast)
{
    bench_empty();
    struct painted_surface *wall = scene_wall(&b.scene, 0, 0, 6, 9, 9, 0),
                           *card = scene_wall(&b.scene, 0.1, 0, 4, 0.7, 0.5, 0);
    wall->cell = 0.3;
    card->cell = 0.2;
    wall->contrast = card->contrast = contrast;
    bench_views();
    bench_make(0.1, 0.4);
    for (int i = 0; i < b.segments.count; i++)
        planes[i] = (struct plane){0, 0, bench_truth(b.segments.segments[i].cx, b.segments.segments[i].cy)};
}

static void choose(void)
{
    struct err err = ERR_INIT;
    if (pixel_planes_choose(label, planes, &b.problem, &err)) fail_msg("%s", err.text);
}

/* The share of pixels that lie on a plane more than a step from the truth. */
static double wrong(const int *labels)
{
    int bad = 0;
    for (int i = 0; i < W * H; i++) {
        const double u = i % W + 0.5, v = i / W + 0.5;
        bad += fabs(plane_at(planes[labels[i]], u, v) - bench_truth(u, v)) > b.problem.step;
    }
    if (getenv("VERDICT")) print_message("  wrong: %.4f\n", bad / (double)(W * H));
    return bad / (double)(W * H);
}

static void a_border_moves_to_where_the_pictures_want_it(void **state)
{
    (void)state;
    start(0.8);
    const double before = wrong(b.segments.label);
    choose();
    assert_true(before > 0.01);
    assert_true(wrong(label) < 0.4 * before);
    bench_release();
}

/* Half of the segments' planes are those of the other surface: pixels go back to planes that match. */
static void pixels_leave_a_wrong_plane_for_one_beside_them(void **state)
{
    (void)state;
    start(0.8);
    for (int i = 0; i < b.segments.count; i++)
        if (scene_hash(i, 3, 5) < 0.2) planes[i].c = planes[i].c > 0.2 ? 1 / 6.0 : 0.25;
    const double before = wrong(b.segments.label);
    choose();
    assert_true(before > 0.1);
    assert_true(wrong(label) < 0.5 * before);
    bench_release();
}

static void blank_surfaces_keep_their_segments_planes(void **state)
{
    (void)state;
    start(0);
    for (int i = 0; i < b.segments.count; i++) planes[i].c = 0.2;
    choose();
    assert_memory_equal(label, b.segments.label, sizeof label);
    bench_release();
}

static void pixels_that_the_view_does_not_have_stay_so(void **state)
{
    (void)state;
    int none = 0;
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 9, 9, 0.3);
    b.scene.holes = true;
    bench_views();
    bench_make(0.1, 0.4);
    for (int i = 0; i < b.segments.count; i++) planes[i] = (struct plane){0, 0, 0.25};
    choose();
    for (int i = 0; i < W * H; i++) {
        assert_int_equal(label[i] < 0, b.segments.label[i] < 0);
        none += label[i] < 0;
    }
    assert_true(none > 100);
    bench_release();
}

static void the_choice_does_not_depend_on_threads(void **state)
{
    (void)state;
    static int first[W * H];
    start(0.8);
    for (int threads = 1; threads <= 3; threads++) {
        parallel_set_threads(threads);
        choose();
        if (threads == 1) memcpy(first, label, sizeof first);
        assert_memory_equal(label, first, sizeof first);
    }
    parallel_set_threads(1);
    bench_release();
}

static void costs_of_rows_are_those_of_segments(void **state)
{
    (void)state;
    start(0.8);
    const struct segment *g = &b.segments.segments[b.segments.count / 2];
    const struct plane plane = {0.0002, -0.0001, 0.2};
    const int i = b.segments.count / 2;
    for (int k = 0; k < b.matcher.neighbour_count; k++) {
        double sum = 0, weights = 0;
        for (int q = 0; q < g->pixels; q++) {
            const int pixel = b.segments.pixel[g->first + q];
            float cost[8];
            match_row(&b.matcher, k, plane, pixel % W, pixel / W, 1, cost);
            if (!(cost[0] < MATCH_UNSEEN)) continue;
            sum += (double)b.matcher.edge[pixel] * (double)cost[0];
            weights += b.matcher.edge[pixel];
        }
        b.matcher.excluded = ~(1u << k);
        /* a segment's sums are of whole numbers, rounded down */
        const double rounding = 256 / (FEATURE_UNIT * 2440.0) / (double)(b.matcher.chance_cost - b.matcher.good_cost);
        const double more = sum / weights - (double)match_cost(&b.matcher, i, plane, 0);
        assert_true(more > -1e-4 && more < rounding + 1e-4);
        b.matcher.excluded = 0;
    }
    bench_release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_border_moves_to_where_the_pictures_want_it),
        cmocka_unit_test(pixels_leave_a_wrong_plane_for_one_beside_them),
        cmocka_unit_test(blank_surfaces_keep_their_segments_planes),
        cmocka_unit_test(pixels_that_the_view_does_not_have_stay_so),
        cmocka_unit_test(the_choice_does_not_depend_on_threads),
        cmocka_unit_test(costs_of_rows_are_those_of_segments),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
