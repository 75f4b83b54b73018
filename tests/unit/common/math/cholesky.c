/* cholesky.c - dense Cholesky factors against what they are factors of. */
#include "common/math/cholesky.h"

#include <math.h>

#include "common/base/rng.h"
#include "tests/unit/scratch.h"

enum { N = 43 };

/* G G^T + N 1, with G of uniform numbers. */
static void make_matrix(double a[N * N])
{
    const struct rng rng = rng_make(3, "cholesky", "test");
    for (int i = 0; i < N; i++)
        for (int k = 0; k < N; k++) {
            double sum = i == k ? N : 0;
            for (int j = 0; j < N; j++)
                sum += rng_uniform(&rng, (uint64_t)i, (uint32_t)j) * rng_uniform(&rng, (uint64_t)k, (uint32_t)j);
            a[i * N + k] = sum;
        }
}

static void the_factor_times_its_transpose_is_the_matrix(void **state)
{
    (void)state;
    double a[N * N], l[N * N];
    make_matrix(a);
    memcpy(l, a, sizeof a);
    assert_true(cholesky_factor(l, N));
    for (int i = 0; i < N; i++)
        for (int k = 0; k <= i; k++) {
            double sum = 0;
            for (int j = 0; j <= k; j++) sum += l[i * N + j] * l[k * N + j];
            assert_true(fabs(sum - a[i * N + k]) < 1e-11 * N);
        }
}

static void forward_and_backward_solve_the_system(void **state)
{
    (void)state;
    double a[N * N], l[N * N], b[N];
    make_matrix(a);
    memcpy(l, a, sizeof a);
    for (int i = 0; i < N; i++) {
        b[i] = 0;
        for (int k = 0; k < N; k++) b[i] += a[i * N + k] * (k - 7.0);
    }
    assert_true(cholesky_factor(l, N));
    cholesky_forward(l, N, b);
    cholesky_backward(l, N, b);
    for (int i = 0; i < N; i++) assert_true(fabs(b[i] - (i - 7.0)) < 1e-9);
}

/* Sums in the order of their columns, one row after another. */
static void rows_side_by_side_give_the_bits_of_single_rows(void **state)
{
    (void)state;
    double l[N * N], b[N], right[N];
    make_matrix(l);
    assert_true(cholesky_factor(l, N));
    for (int first = 0; first < N; first++) {
        for (int i = 0; i < N; i++) b[i] = right[i] = i < first ? 0 : 1 + 0.1 * i;
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < i; j++) right[i] -= l[i * N + j] * right[j];
            right[i] /= l[i * N + i];
        }
        cholesky_forward_from(l, N, first, b);
        for (int i = 0; i < N; i++) assert_true(b[i] == right[i]);
    }
}

static void a_matrix_that_is_not_positive_definite_is_refused(void **state)
{
    (void)state;
    double a[4] = {1, 2, 2, 1}, zero[1] = {0}, none[1] = {NAN};
    assert_false(cholesky_factor(a, 2));
    assert_false(cholesky_factor(zero, 1));
    assert_false(cholesky_factor(none, 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_factor_times_its_transpose_is_the_matrix),
        cmocka_unit_test(forward_and_backward_solve_the_system),
        cmocka_unit_test(rows_side_by_side_give_the_bits_of_single_rows),
        cmocka_unit_test(a_matrix_that_is_not_positive_definite_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
