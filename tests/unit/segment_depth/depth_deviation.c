/* depth_deviation.c - how far off the depth of segments may be, on a problem whose matching costs are made up. */
#include "stages/segment_depth/depth_deviation.h"

#include "common/base/parallel.h"
#include "tests/unit/scratch.h"
#include "tests/unit/segment_depth/problem.h"

enum { LABELS = 41, OWN = 20 };

static struct plane planes[MAX_SEGMENTS];
static float cost[MAX_SEGMENTS * LABELS];
static double deviation[MAX_SEGMENTS];

/* A wall that faces the view; all segments are on its plane, which is label OWN, and every depth matches badly. */
static void start(void)
{
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 8, 8, 0);
    bench_views();
    bench_make(0.1, 0.4);
    b.problem.cost = cost;
    b.problem.planes = LABELS;
    b.problem.step = 0.15 / OWN;
    for (int i = 0; i < b.segments.count; i++) planes[i] = (struct plane){0, 0, 0.25};
    for (int i = 0; i < b.segments.count * LABELS; i++) cost[i] = 1;
}

/* A segment in the middle of the picture. */
static int middle(void) { return b.segments.label[H / 2 * W + W / 2]; }

static double matches_of(int segment)
{
    double room[2 * LABELS];
    return deviation_of_matches(&b.problem, planes, segment, room);
}

static double points_of(void)
{
    double found;
    struct err err = ERR_INIT;
    assert_ok(deviation_of_points(&found, &b.problem, planes, &err), err);
    return found;
}

static void find(double *found, const double *before, const double *agreeing)
{
    struct err err = ERR_INIT;
    assert_ok(deviation_find(found, &b.problem, planes, before, agreeing, &err), err);
}

/* Where no depth matches better than another, the deviation is that of a uniform distribution. */
static void a_blank_surface_may_be_anywhere(void **state)
{
    (void)state;
    start();
    double square = 0;
    for (int k = 0; k < LABELS; k++) square += (k - OWN) * (k - OWN);
    assert_near(matches_of(middle()), sqrt(square / LABELS), 1e-9);
    bench_release();
}

/* One depth that matches leaves no doubt; two of equal cost, 6 steps apart, leave half of each. */
static void the_spread_is_that_of_the_depths_that_match(void **state)
{
    (void)state;
    start();
    for (int i = 0; i < b.segments.count; i++) cost[i * LABELS + OWN] = 0;
    assert_near(matches_of(middle()), 0, 0.01);
    for (int i = 0; i < b.segments.count; i++) cost[i * LABELS + OWN + 6] = 0;
    assert_near(matches_of(middle()), sqrt(0.5 * 36), 0.01);
    bench_release();
}

/* A wrong depth that is the only one to match is off by all of its distance. */
static void a_match_elsewhere_counts_by_its_distance(void **state)
{
    (void)state;
    start();
    for (int i = 0; i < b.segments.count; i++) cost[i * LABELS + OWN - 9] = 0;
    assert_near(matches_of(middle()), 9, 0.01);
    bench_release();
}

/* A blank segment is known by the surface around it, but not by one behind. */
static void the_surface_around_decides(void **state)
{
    (void)state;
    start();
    const int own = middle();
    for (int i = 0; i < b.segments.count; i++)
        if (i != own) cost[i * LABELS + OWN] = -1;
    assert_near(matches_of(own), 0, 0.01);
    for (int i = 0; i < b.segments.count; i++)
        if (i != own) planes[i].c = 0.25 - 3 * b.problem.step;
    assert_true(matches_of(own) > 10);
    bench_release();
}

/* A surface may be slanted: costs are compared at equal distances from its plane. */
static void a_slanted_surface_is_one(void **state)
{
    (void)state;
    start();
    const struct plane slanted = {0.1 * b.problem.step, 0, 0.25 - 0.1 * b.problem.step * W / 2};
    for (int i = 0; i < b.segments.count; i++) {
        const double label = (plane_at(slanted, b.segments.segments[i].cx, 0) - 0.1) / b.problem.step;
        planes[i] = slanted;
        cost[i * LABELS + (int)(label + 0.5)] = 0;
    }
    assert_near(matches_of(middle()), 0, 0.01);
    bench_release();
}

/* Points that are off the wall by some steps, in the middle of as many segments. */
static void set_points(int count, double steps)
{
    static struct observed_point points[MAX_SEGMENTS];
    struct err err = ERR_INIT;
    for (int i = 0; i < count; i++) {
        const struct segment *g = &b.segments.segments[i];
        const int pixel = b.segments.pixel[g->first + g->pixels / 2];
        points[i] = (struct observed_point){0, pixel % W + 0.5, pixel / W + 0.5,
                                            0.25 + (i & 1 ? 1 : -1) * steps * b.problem.step};
    }
    point_evidence_release(&b.points);
    assert_int_equal(point_evidence_make(&b.points, &b.segments, &(struct observed_points){points, count}, 0.1, 0.4,
                                         b.problem.step, &b.params, &err),
                     ST_OK);
}

static void points_measure_what_planes_are_off(void **state)
{
    (void)state;
    start();
    assert_near(points_of(), 1, 1e-9);
    set_points(95, 0.2);
    assert_near(points_of(), (95 * 0.2 + 5) / 100, 1e-6);
    set_points(15, 3);
    assert_near(points_of(), (15 * 3 + 5) / 20.0, 1e-6);
    bench_release();
}

/* A blank wall is less certain than a textured one, and twice as far away, twice as much. */
static void deviations_are_relative_to_the_inverse_depth(void **state)
{
    (void)state;
    start();
    find(deviation, NULL, NULL);
    const int own = middle();
    const double blank = deviation[own];
    for (int i = 0; i < b.segments.count; i++) cost[i * LABELS + OWN] = 0;
    find(deviation, NULL, NULL);
    assert_true(deviation[own] < blank / 2);
    const double near = deviation[own];
    for (int i = 0; i < b.segments.count; i++) {
        planes[i].c = 0.125;
        cost[i * LABELS + OWN] = 1;
        cost[i * LABELS + (int)((0.125 - 0.1) / b.problem.step + 0.5)] = 0;
    }
    find(deviation, NULL, NULL);
    assert_near(deviation[own], 2 * near, 0.02 * near);
    bench_release();
}

/* In later rounds a deviation shrinks if other views agree on the depth. Otherwise it stays as it was. */
static void agreement_of_other_views_replaces_matches(void **state)
{
    (void)state;
    static double before[MAX_SEGMENTS], agreeing[MAX_SEGMENTS];
    start();
    b.problem.cost = NULL;
    b.problem.planes = 0;
    set_points(95, 0.05);
    for (int i = 0; i < b.segments.count; i++) before[i] = 10;
    agreeing[1] = 1;
    agreeing[2] = 2;
    agreeing[3] = 5;
    find(deviation, before, agreeing);
    const double step = b.problem.step / 0.25;
    assert_near(deviation[0], 10 * step, 0.01 * step);
    assert_near(deviation[1], 5 * step, 0.02 * step);
    assert_true(deviation[2] < 0.3 * step);
    assert_near(deviation[3], deviation[2], 1e-9);
    bench_release();
}

/* The result does not depend on the number of threads. */
static void threads_change_nothing(void **state)
{
    static double other[MAX_SEGMENTS];
    (void)state;
    start();
    for (int i = 0; i < b.segments.count * LABELS; i++) cost[i] = (float)(i * 7919 % 1000) / 1000;
    parallel_set_threads(1);
    find(deviation, NULL, NULL);
    parallel_set_threads(3);
    find(other, NULL, NULL);
    assert_memory_equal(deviation, other, (size_t)b.segments.count * sizeof *other);
    bench_release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blank_surface_may_be_anywhere),
        cmocka_unit_test(the_spread_is_that_of_the_depths_that_match),
        cmocka_unit_test(a_match_elsewhere_counts_by_its_distance),
        cmocka_unit_test(the_surface_around_decides),
        cmocka_unit_test(a_slanted_surface_is_one),
        cmocka_unit_test(points_measure_what_planes_are_off),
        cmocka_unit_test(deviations_are_relative_to_the_inverse_depth),
        cmocka_unit_test(agreement_of_other_views_replaces_matches),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests_name("depth_deviation", tests, NULL, NULL);
}
