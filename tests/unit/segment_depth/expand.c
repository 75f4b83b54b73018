/* expand.c - expansion moves on photographs of walls: the energy never rises, a surface gets one plane, threads change
 * nothing. */
#include "stages/segment_depth/expand.h"

#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"

/* Planes as after an uncertain sweep: of constant depth, and up to `max_error` steps off. */
static void start_planes(struct plane *planes, double max_error)
{
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        const double d = bench_truth(g->cx, g->cy) + max_error * b.problem.step * (2 * scene_hash(i, 0, 0) - 1);
        planes[i] = (struct plane){0, 0, fmin(fmax(d, b.problem.min_inverse_z), b.problem.max_inverse_z)};
    }
}

static void expand(struct plane *planes)
{
    struct err err = ERR_INIT;
    if (expand_planes(planes, &b.problem, &err)) fail_msg("%s", err.text);
}

/* The cost volume of a sweep. */
static float *sweep(int planes)
{
    float *cost = malloc((size_t)b.segments.count * (size_t)planes * sizeof *cost);
    assert_non_null(cost);
    for (int i = 0; i < b.segments.count; i++)
        for (int p = 0; p < planes; p++)
            cost[i * planes + p] =
                match_cost_rough(&b.matcher, i, (struct plane){0, 0, b.problem.min_inverse_z + p * b.problem.step}, 0);
    b.problem.cost = cost;
    b.problem.planes = planes;
    return cost;
}

/* Over all passes, from planes with various errors; the tolerance is far above the rounding of energies to integers. */
static void the_energy_never_rises(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS];
    for (int k = 0; k < 4; k++) {
        bench_empty();
        scene_wall(&b.scene, 0, 0, 5, 8, 8, 0.4)->contrast = k == 3 ? 0 : 0.8;
        scene_wall(&b.scene, 0.2, 0, 3.5, 0.5, 0.6, 0)->colour[0] = 0.12f;
        bench_views();
        bench_make(0.12, 0.45);
        b.problem.rough = true; /* as in expand_planes() */
        float *cost = k == 1 ? sweep(24) : NULL;
        const int max_passes = 6; /* a pass's random numbers do not depend on the number of passes */
        double before = HUGE_VAL;
        for (int passes = 0; passes <= max_passes; passes++) {
            start_planes(planes, k == 0 ? 2 : 20);
            for (int i = 0; i < b.segments.count && k == 2; i += 3)
                planes[i].c = i % 2 ? -0.3 : 9; /* outside the depth range */
            b.params.passes = passes;
            expand(planes);
            const double energy = bench_energy(planes, true);
            if (getenv("VERDICT")) print_message("  %d passes: %.5f\n", passes, energy);
            assert_true(energy <= before + 1e-3);
            before = energy;
        }
        free(cost);
        bench_release();
    }
}

static void zero_passes_change_nothing(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS], before[MAX_SEGMENTS];
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 6, 6, 0.4);
    bench_views();
    bench_make(0.15, 0.45);
    b.params.passes = 0;
    start_planes(planes, 2);
    memcpy(before, planes, sizeof planes);
    expand(planes);
    assert_memory_equal(planes, before, sizeof planes);
    bench_release();
}

static void thread_counts_give_the_same_bits(void **state)
{
    (void)state;
    static struct plane planes[3][MAX_SEGMENTS];
    bench_empty();
    scene_wall(&b.scene, 0, 0, 5, 8, 8, 0.4);
    scene_wall(&b.scene, 0.2, 0, 3.5, 0.5, 0.6, 0)->colour[0] = 0.12f;
    bench_views();
    bench_make(0.12, 0.45);
    float *cost = sweep(24);
    b.params.segment_pixels = 16; /* smaller cells: more of them are moved in parallel */
    for (int k = 0; k < 3; k++) {
        parallel_set_threads(1 + k);
        start_planes(planes[k], 6);
        expand(planes[k]);
    }
    parallel_set_threads(1);
    for (int k = 1; k < 3; k++)
        assert_memory_equal(planes[0], planes[k], (size_t)b.segments.count * sizeof planes[0][0]);
    free(cost);
    bench_release();
}

static bool on_card(double u, double v)
{
    int surface;
    scene_depth(&b.scene, &b.scene.views[0], u, v, &surface);
    return surface > 0;
}

/* A slanted board with a textured rim and a blank middle, in front of a wall; the middle starts at random depths. In
 * the end the whole board has its true plane. */
static void a_blank_middle_gets_the_plane_of_its_rim(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS];
    for (int slope = 0; slope < 2; slope++) {
        bench_empty();
        const double lean = slope ? 0.7 : -0.4;
        scene_wall(&b.scene, 0, 0, 6, 12, 12, 0)->cell = 0.35;
        scene_wall(&b.scene, 0, 0, 4, 1.2, 1.0, lean)->colour[0] = 0.12f;
        scene_wall(&b.scene, 0, 0, 4 - 1e-4, 0.75, 0.65, lean)->contrast = 0;
        b.scene.surfaces[2].colour[0] = 0.12f;
        bench_views();
        bench_make(0.12, 0.4);
        b.params.passes = 6;
        float *cost = sweep(21);
        for (int i = 0; i < b.segments.count; i++) {
            const struct segment *g = &b.segments.segments[i];
            int surface;
            scene_depth(&b.scene, &b.scene.views[0], g->cx, g->cy, &surface);
            planes[i] = (struct plane){0, 0, bench_truth(g->cx, g->cy)};
            if (surface == 2) planes[i].c = 0.12 + 0.28 * scene_hash(i, 0, 0);
        }
        expand(planes);
        int right = 0, count = 0;
        const double a = bench_truth(70.5, 50) - bench_truth(69.5, 50);
        double mean_a = 0;
        for (int i = 0; i < b.segments.count; i++) {
            const struct segment *g = &b.segments.segments[i];
            bool inside = true;
            for (int c = 0; c < 4; c++)
                inside = inside && on_card(c & 1 ? g->x1 + 1 : g->x0, c & 2 ? g->y1 + 1 : g->y0);
            if (!inside) continue;
            count += g->pixels;
            mean_a += g->pixels * planes[i].a;
            for (int k = 0; k < g->pixels; k++) {
                const int pixel = b.segments.pixel[g->first + k];
                const double u = pixel % W + 0.5, v = pixel / W + 0.5;
                right += fabs(plane_at(planes[i], u, v) - bench_truth(u, v)) < 0.3 * b.problem.step;
            }
        }
        if (getenv("VERDICT"))
            print_message("  right %d of %d, slope %.3f of the truth\n", right, count, mean_a / count / a);
        assert_true(count > 2000 && right > 0.97 * count);
        assert_near(mean_a / count / a, 1, 0.1);
        free(cost);
        bench_release();
    }
}

/* Even where no term prefers any depth. */
static void planes_stay_in_the_depth_range(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS];
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 6, 6, 0.4)->contrast = 0;
    bench_views();
    bench_make(0.15, 0.45);
    b.params.slant = 0;
    for (int i = 0; i < b.segments.count; i++)
        planes[i] = (struct plane){0, 0, i % 2 ? b.problem.min_inverse_z : b.problem.max_inverse_z};
    expand(planes);
    for (int i = 0; i < b.segments.count; i++)
        assert_true(plane_within(planes[i], &b.segments.segments[i], b.problem.min_inverse_z, b.problem.max_inverse_z));
    bench_release();
}

/* A wall of which some segments have a given depth, half a step off: the rest is fitted to the pictures, they stay. */
static void given_depth_stays_on_a_plane_of_the_scene(void **state)
{
    (void)state;
    static struct plane planes[MAX_SEGMENTS], given[MAX_SEGMENTS];
    static bool known[MAX_SEGMENTS];
    static struct scene_planes scene;
    const struct given_depth fixed = {.known = known, .planes = given};
    int off = 0, moved = 0;
    bench_empty();
    scene_wall(&b.scene, 0, 0, 5, 8, 8, 0.4);
    bench_views();
    bench_make(0.12, 0.45);
    const double slope = (bench_truth(90, 50) - bench_truth(50, 50)) / 40;
    const struct plane plane = {slope, 0, bench_truth(50, 50) - slope * 50 + 0.5 * b.problem.step};
    for (int i = 0; i < b.segments.count; i++) {
        known[i] = i % 7 == 0;
        planes[i] = given[i] = plane;
    }
    b.problem.given = &fixed;
    b.problem.scene = &scene;
    b.params.passes = 1;
    expand(planes);
    assert_true(scene.count > 0);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (known[i]) {
            assert_memory_equal(&planes[i], &plane, sizeof plane);
            continue;
        }
        off += fabs(plane_at(planes[i], g->cx, g->cy) - bench_truth(g->cx, g->cy)) > 0.3 * b.problem.step;
        moved++;
    }
    if (getenv("VERDICT")) print_message("  %d of %d off\n", off, moved);
    assert_true(off < moved / 10);
    bench_release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_energy_never_rises),           cmocka_unit_test(zero_passes_change_nothing),
        cmocka_unit_test(thread_counts_give_the_same_bits), cmocka_unit_test(a_blank_middle_gets_the_plane_of_its_rim),
        cmocka_unit_test(planes_stay_in_the_depth_range),   cmocka_unit_test(given_depth_stays_on_a_plane_of_the_scene),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
