/* refine_planes.c - refinement of planes that start a step off, or of constant depth, on photographs of slanted walls.
 * */
#include "stages/segment_depth/refine_planes.h"

#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"

/* A slanted wall, blank if `contrast` is 0. */
static void start(double lean, double contrast)
{
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 6, 6, lean)->contrast = contrast;
    bench_views();
    bench_make(0.15, 0.45);
}

/* Planes as after a sweep: of constant depth, and up to a step off. */
static void start_planes(struct plane *planes)
{
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        planes[i] = (struct plane){0, 0, bench_truth(g->cx, g->cy) + b.problem.step * (2 * scene_hash(i, 0, 0) - 1)};
    }
}

static void refine(struct plane *planes)
{
    struct err err = ERR_INIT;
    const double before = bench_energy(planes, false);
    if (refine_planes(planes, &b.problem, &err)) fail_msg("%s", err.text);
    assert_true(bench_energy(planes, false) <= before + 1e-6 * fabs(before)); /* refinement never raises the energy */
}

/* Mean error in steps at the centroids of the segments away from the picture's border. */
static double mean_error(const struct plane *planes)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (g->cx < 25 || g->cx > W - 25) continue;
        sum += fabs(plane_at(planes[i], g->cx, g->cy) - bench_truth(g->cx, g->cy)) / b.problem.step;
        count++;
    }
    if (getenv("VERDICT")) print_message("  mean error %.4f steps\n", sum / count);
    return sum / count;
}

static void a_slanted_wall_is_found_to_a_fraction_of_a_step(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS];
    for (int free_slant = 0; free_slant < 2; free_slant++) {
        double mean_a = 0, mean_b = 0;
        start(0.4, 0.8);
        if (free_slant) b.params.slant = 0;
        start_planes(planes);
        assert_true(mean_error(planes) > 0.4);
        refine(planes);
        assert_true(mean_error(planes) < 0.05);
        const double a = bench_truth(70.5, 50) - bench_truth(69.5, 50);
        for (int i = 0; i < b.segments.count; i++) {
            mean_a += planes[i].a / b.segments.count;
            mean_b += planes[i].b / b.segments.count;
        }
        assert_true(mean_a / a > (free_slant ? 0.85 : 0.4) &&
                    mean_a / a < 1.1); /* the slant is not worth its cost to all segments */
        assert_near(mean_b / a, 0, 0.1);
        bench_release();
    }
}

static void a_facing_wall_stays_constant(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS];
    int constant = 0;
    start(0, 0.8);
    start_planes(planes);
    refine(planes);
    assert_true(mean_error(planes) < 0.05);
    for (int i = 0; i < b.segments.count; i++)
        constant += fabs(planes[i].a) + fabs(planes[i].b) < 0.02 * b.problem.step;
    assert_true(constant > 0.8 * b.segments.count);
    bench_release();
}

static void zero_passes_change_nothing(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS], before[MAX_SEGMENTS];
    start(0.4, 0.8);
    b.params.passes = 0;
    start_planes(planes);
    memcpy(before, planes, sizeof planes);
    refine(planes);
    assert_memory_equal(planes, before, sizeof planes);
    bench_release();
}

static void planes_on_a_blank_wall_stay_in_the_depth_range(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS];
    start(0.4, 0);
    b.params.passes = 12;
    b.params.slant = 0;
    for (int i = 0; i < b.segments.count; i++)
        planes[i] = (struct plane){0, 0, i % 2 ? b.problem.min_inverse_z : b.problem.max_inverse_z};
    refine(planes);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        for (int k = 0; k < 4; k++) {
            const double d = plane_at(planes[i], k & 1 ? g->x1 + 1 : g->x0, k & 2 ? g->y1 + 1 : g->y0);
            assert_true(d >= PLANE_MIN_FACTOR * b.problem.min_inverse_z - 1e-12 &&
                        d <= PLANE_MAX_FACTOR * b.problem.max_inverse_z + 1e-12);
        }
    }
    bench_release();
}

static void thread_counts_give_the_same_planes(void **state)
{
    (void)state;
    static struct plane planes[2][MAX_SEGMENTS];
    start(0.4, 0.8);
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        start_planes(planes[k]);
        refine(planes[k]);
    }
    parallel_set_threads(1);
    assert_memory_equal(planes[0], planes[1], (size_t)b.segments.count * sizeof planes[0][0]);
    bench_release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slanted_wall_is_found_to_a_fraction_of_a_step),
        cmocka_unit_test(a_facing_wall_stays_constant),
        cmocka_unit_test(zero_passes_change_nothing),
        cmocka_unit_test(planes_on_a_blank_wall_stay_in_the_depth_range),
        cmocka_unit_test(thread_counts_give_the_same_planes),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
