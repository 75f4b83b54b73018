/* kmeans1d.c - exact clusters, against a brute-force search. */
#include "stages/find_axes/kmeans1d.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/rng.h"
#include "common/base/sort.h"
#include "tests/unit/scratch.h"

/* The sum of squared distances to the mean. */
static double range_cost(const double *values, size_t count)
{
    long double mean = 0, c = 0;
    for (size_t i = 0; i < count; i++) mean += values[i];
    mean /= (long double)(count ? count : 1);
    for (size_t i = 0; i < count; i++) c += (values[i] - mean) * (values[i] - mean);
    return (double)c;
}

/* The min cost of k ranges of the first n numbers, by trying every cut. */
static double brute_force(const double *x, size_t n, int k)
{
    if (k == 1) return range_cost(x, n);
    double min_cost = INFINITY;
    for (size_t m = (size_t)k - 1; m < n; m++)
        min_cost = fmin(min_cost, brute_force(x, m, k - 1) + range_cost(x + m, n - m));
    return min_cost;
}

static double cost_of(const double *x, const size_t *begin, int k)
{
    double sum = 0;
    for (int j = 0; j < k; j++) {
        assert_true(begin[j] < begin[j + 1]);
        sum += range_cost(x + begin[j], begin[j + 1] - begin[j]);
    }
    return sum;
}

static void the_cost_is_minimal(void **state)
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

static void separate_clusters_are_found(void **state)
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

static void there_may_be_as_many_clusters_as_numbers(void **state)
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

/* Many numbers far from zero in three narrow clusters: there is no cancellation, and it is fast. */
static void numbers_far_from_zero_are_clustered_exactly(void **state)
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
        cmocka_unit_test(the_cost_is_minimal),
        cmocka_unit_test(separate_clusters_are_found),
        cmocka_unit_test(there_may_be_as_many_clusters_as_numbers),
        cmocka_unit_test(numbers_far_from_zero_are_clustered_exactly),
    };
    return cmocka_run_group_tests_name("kmeans1d", tests, NULL, NULL);
}
