/* kmeans1d.c - exact clusters, against all ways to cut. */
#include "stages/find_axes/kmeans1d.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/rng.h"
#include "common/base/sort.h"
#include "tests/unit/scratch.h"

/* The least cost of k ranges of the first n numbers, by trying every cut. */
static double brute_force(const double *x, size_t n, int k)
{
    if (k == 1) return kmeans1d_cost(x, n);
    double least = INFINITY;
    for (size_t m = (size_t)k - 1; m < n; m++)
        least = fmin(least, brute_force(x, m, k - 1) + kmeans1d_cost(x + m, n - m));
    return least;
}

static double cost_of(const double *x, const size_t *begin, int k)
{
    double sum = 0;
    for (int j = 0; j < k; j++) {
        assert_true(begin[j] < begin[j + 1]);
        sum += kmeans1d_cost(x + begin[j], begin[j + 1] - begin[j]);
    }
    return sum;
}

static void nothing_is_better(void **state)
{
    (void)state;
    const struct rng rng = rng_make(7, "test", "kmeans1d");
    for (uint64_t trial = 0; trial < 400; trial++) {
        double x[18];
        size_t begin[6];
        struct err err = ERR_INIT;
        const size_t n = 5 + trial % 14;
        const int k = 1 + (int)(trial / 14 % 5);
        for (size_t i = 0; i < n; i++) /* every other trial with many equal numbers */
            x[i] = trial % 2 ? 1000 + rng_uniform(&rng, trial, i) : floor(4 * rng_uniform(&rng, trial, i));
        sort_doubles(x, n);
        assert_ok(kmeans1d(begin, x, n, k, &err), err);
        assert_int_equal(begin[0], 0);
        assert_int_equal(begin[k], n);
        const double best = brute_force(x, n, k);
        assert_true(fabs(cost_of(x, begin, k) - best) <= 1e-12 * (1 + best));
    }
}

static void clusters_that_stand_apart_are_found(void **state)
{
    (void)state;
    static const double x[] = {-1, -0.9, -1.0 + 1e-9, 4, 4.1, 4.2, 4.3, 9};
    double sorted[8];
    size_t begin[4];
    struct err err = ERR_INIT;
    memcpy(sorted, x, sizeof x);
    sort_doubles(sorted, 8);
    assert_ok(kmeans1d(begin, sorted, 8, 3, &err), err);
    assert_int_equal(begin[1], 3);
    assert_int_equal(begin[2], 7);
}

static void as_many_clusters_as_numbers(void **state)
{
    (void)state;
    const double x[4] = {2, 2, 2, 2};
    size_t begin[5];
    struct err err = ERR_INIT;
    for (int k = 1; k <= 4; k++) {
        assert_ok(kmeans1d(begin, x, 4, k, &err), err);
        assert_true(cost_of(x, begin, k) == 0);
    }
}

/* Many numbers far from zero, three narrow clusters: nothing cancels, and it takes no minute. */
static void far_from_zero_it_stays_exact(void **state)
{
    (void)state;
    enum { N = 300000 };
    const struct rng rng = rng_make(3, "test", "kmeans1d");
    double *x = malloc(N * sizeof *x);
    size_t begin[4];
    struct err err = ERR_INIT;
    assert_non_null(x);
    for (size_t i = 0; i < N; i++) x[i] = 1e6 + (double)(i % 3) * 1e-3 + 1e-5 * rng_uniform(&rng, 0, i);
    sort_doubles(x, N);
    assert_ok(kmeans1d(begin, x, N, 3, &err), err);
    assert_int_equal(begin[1], N / 3);
    assert_int_equal(begin[2], 2 * N / 3);
    free(x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_better),
        cmocka_unit_test(clusters_that_stand_apart_are_found),
        cmocka_unit_test(as_many_clusters_as_numbers),
        cmocka_unit_test(far_from_zero_it_stays_exact),
    };
    return cmocka_run_group_tests_name("kmeans1d", tests, NULL, NULL);
}
