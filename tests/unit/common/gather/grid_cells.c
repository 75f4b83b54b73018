/* Points of a grid: which are computed, and that all are set. */
#include "common/gather/grid_cells.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "tests/unit/common/light/near.h"

enum { MOST = 64 * 64 };

struct values {
    int width;
    double v[MOST];
    int set[MOST]; /* 0: not yet, 1: filled, 2: computed */
};

/* A slope with a step: linear on both sides of the column `edge`. */
static double true_value(int x, int y, int edge) { return x + 2.0 * y + (x >= edge ? 100 : 0); }

static bool is_flat(const void *ctx, const struct grid_cell *cell, const size_t corners[4])
{
    const struct values *v = ctx;
    (void)cell;
    return fabs(v->v[corners[0]] - v->v[corners[3]]) < 50 && fabs(v->v[corners[1]] - v->v[corners[2]]) < 50;
}

static void fill(const void *ctx, size_t point, const size_t corners[4], const double weights[4])
{
    struct values *v = (struct values *)(size_t)ctx;
    v->v[point] = 0;
    for (int k = 0; k < 4; k++) v->v[point] += weights[k] * v->v[corners[k]];
    v->set[point] = 1;
}

/* The result is how many points were computed. */
static size_t run(struct values *v, int width, int height, int step, int edge)
{
    const struct grid_fill f = {v, is_flat, fill};
    struct grid_cells g;
    struct err err = ERR_INIT;
    size_t computed = 0;
    *v = (struct values){.width = width};
    assert_ok(grid_cells_start(&g, width, height, step, &err), err);
    while (g.count || g.wanted_count) {
        for (size_t k = 0; k < g.wanted_count; k++) {
            const size_t i = g.wanted[k];
            assert_int_not_equal(v->set[i], 2);
            v->v[i] = true_value((int)i % width, (int)i / width, edge);
            v->set[i] = 2;
        }
        computed += g.wanted_count;
        assert_ok(grid_cells_next(&g, &f, &err), err);
    }
    grid_cells_release(&g);
    grid_cells_release(&g);
    return computed;
}

static void every_point_of_a_slope_is_right_for_any_size(void **state)
{
    static const int sizes[][2] = {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {8, 8}, {9, 17}, {33, 10}, {40, 30}, {63, 5}};
    static struct values v;
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int step = 1; step <= 16; step *= 2) {
            const int width = sizes[s][0], height = sizes[s][1];
            run(&v, width, height, step, 1000);
            for (int i = 0; i < width * height; i++) {
                assert_true(v.set[i]);
                assert_true(fabs(v.v[i] - true_value(i % width, i / width, 1000)) < 1e-9);
            }
        }
}

static void a_step_is_found_to_the_point_and_costs_a_part(void **state)
{
    static struct values v;
    (void)state;
    const size_t computed = run(&v, 60, 60, 8, 21);
    for (int i = 0; i < 60 * 60; i++) assert_true(fabs(v.v[i] - true_value(i % 60, i / 60, 21)) < 1e-9);
    assert_true(computed < 900);
}

static void with_step_1_all_points_are_computed(void **state)
{
    static struct values v;
    (void)state;
    assert_int_equal(run(&v, 13, 11, 1, 1000), 13 * 11);
}

static void threads_do_not_change_a_bit(void **state)
{
    static struct values a, b;
    (void)state;
    parallel_set_threads(1);
    run(&a, 57, 43, 8, 21);
    parallel_set_threads(4);
    run(&b, 57, 43, 8, 21);
    parallel_set_threads(0);
    assert_memory_equal(&a, &b, sizeof a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_of_a_slope_is_right_for_any_size),
        cmocka_unit_test(a_step_is_found_to_the_point_and_costs_a_part),
        cmocka_unit_test(with_step_1_all_points_are_computed),
        cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
