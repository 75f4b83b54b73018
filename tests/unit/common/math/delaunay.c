/* delaunay.c - the triangulation is Delaunay, covers the hull, is counter-clockwise, and is empty for degenerate
 * input. */
#include "common/math/delaunay.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/base/rng.h"

typedef const double (*points_t)[2];

static double cross_at(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* > 0: d is inside the circle through the counter-clockwise a, b, c. */
static double in_circle(const double *a, const double *b, const double *c, const double *d)
{
    double ax = a[0] - d[0], ay = a[1] - d[1], bx = b[0] - d[0], by = b[1] - d[1], cx = c[0] - d[0], cy = c[1] - d[1];
    double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    return aa * (bx * cy - by * cx) - bb * (ax * cy - ay * cx) + cc * (ax * by - ay * bx);
}

static void check_delaunay(points_t p, int n, double hull_area)
{
    int(*t)[3], count;
    struct err err = ERR_INIT;
    assert_int_equal(delaunay(p, n, &t, &count, &err), ST_OK);
    double area = 0;
    for (int i = 0; i < count; i++) {
        const double *a = p[t[i][0]], *b = p[t[i][1]], *c = p[t[i][2]];
        assert_true(cross_at(a, b, c) > 0);
        assert_true(t[i][0] < t[i][1] && t[i][0] < t[i][2]);
        if (i) assert_true(memcmp(t[i - 1], t[i], sizeof *t) != 0 && t[i - 1][0] <= t[i][0]);
        area += cross_at(a, b, c) / 2;
        for (int k = 0; k < n; k++) assert_true(in_circle(a, b, c, p[k]) < 1e-9);
    }
    assert_float_equal(area, hull_area, 1e-9 * hull_area);
    free(t);
}

static void random_points_are_triangulated(void **state)
{
    (void)state;
    double p[60][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    struct rng rng = rng_make(1, "test", "delaunay");
    for (int i = 4; i < 60; i++)
        for (int k = 0; k < 2; k++) p[i][k] = 0.01 + 0.98 * rng_uniform(&rng, (uint64_t)i, (uint64_t)k);
    check_delaunay((points_t)p, 60, 1);
}

static void cocircular_grid_points_are_triangulated(void **state)
{
    (void)state;
    double p[35][2];
    for (int i = 0; i < 35; i++) p[i][0] = i % 7, p[i][1] = i / 7;
    check_delaunay((points_t)p, 35, 24);
}

static void simple_shapes_far_from_the_origin_are_triangulated(void **state)
{
    (void)state;
    double p[4][2] = {{1e6, -1e6}, {1e6 + 1, -1e6}, {1e6 + 1, -1e6 + 1}, {1e6, -1e6 + 1}};
    int(*t)[3], count;
    struct err err = ERR_INIT;
    assert_int_equal(delaunay((points_t)p, 3, &t, &count, &err), ST_OK);
    assert_int_equal(count, 1);
    assert_memory_equal(t, ((int[]){0, 1, 2}), sizeof *t);
    free(t);
    assert_int_equal(delaunay((points_t)p, 4, &t, &count, &err), ST_OK);
    assert_int_equal(count, 2);
    free(t);
}

static void degenerate_input_gives_no_triangles(void **state)
{
    (void)state;
    double line[9][2], same[5][2] = {{0}};
    for (int i = 0; i < 9; i++) line[i][0] = 0.1 * i * i, line[i][1] = 0.3 * i * i - 2;
    int(*t)[3], count;
    struct err err = ERR_INIT;
    for (int n = 0; n <= 9; n++) {
        assert_int_equal(delaunay((points_t)line, n, &t, &count, &err), ST_OK);
        assert_int_equal(count, 0);
        assert_null(t);
    }
    assert_int_equal(delaunay((points_t)same, 5, &t, &count, &err), ST_OK);
    assert_int_equal(count, 0);
    assert_null(t);
}

static void one_of_coincident_points_is_used(void **state)
{
    (void)state;
    double p[8][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0.9}, {1, 0.9}, {2, 2}, {0, 0}};
    check_delaunay((points_t)p, 8, 4);
}

static void the_result_is_deterministic(void **state)
{
    (void)state;
    double p[16][2];
    for (int i = 0; i < 16; i++) p[i][0] = i % 4, p[i][1] = i / 4;
    int(*a)[3], (*b)[3], na, nb;
    struct err err = ERR_INIT;
    assert_int_equal(delaunay((points_t)p, 16, &a, &na, &err), ST_OK);
    assert_int_equal(delaunay((points_t)p, 16, &b, &nb, &err), ST_OK);
    assert_int_equal(na, nb);
    assert_memory_equal(a, b, (size_t)na * sizeof *a);
    free(a);
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_points_are_triangulated),
        cmocka_unit_test(cocircular_grid_points_are_triangulated),
        cmocka_unit_test(simple_shapes_far_from_the_origin_are_triangulated),
        cmocka_unit_test(degenerate_input_gives_no_triangles),
        cmocka_unit_test(one_of_coincident_points_is_used),
        cmocka_unit_test(the_result_is_deterministic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
