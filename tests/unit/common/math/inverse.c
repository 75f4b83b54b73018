/* inverse.c - inverses of small matrices, and matrices that have none. */
#include "common/math/inverse.h"

#include <math.h>
#include <string.h>

#include "common/base/rng.h"
#include "tests/unit/scratch.h"

enum { N = 6 };

static void make_matrix(double a[N * N])
{
    const struct rng rng = rng_make(3, "inverse", "test");
    for (int i = 0; i < N * N; i++) a[i] = rng_uniform(&rng, (uint64_t)i, 0) - 0.5;
}

static void product(double to[N * N], const double *a, const double *b)
{
    memset(to, 0, N * N * sizeof *to);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            for (int k = 0; k < N; k++) to[i * N + j] += a[i * N + k] * b[k * N + j];
}

static void assert_identity(const double p[N * N])
{
    for (int i = 0; i < N * N; i++) assert_true(fabs(p[i] - (i % (N + 1) == 0)) < 1e-10);
}

static void a_matrix_times_its_inverse_is_the_identity(void **state)
{
    double a[N * N], inverse[N * N], p[N * N];
    (void)state;
    make_matrix(a);
    a[0] = 0; /* rows must be exchanged */
    for (int j = 0; j < N; j++) a[2 * N + j] *= 1e20;
    memcpy(inverse, a, sizeof a);
    assert_true(inverse_of(inverse, N, 1e-12));
    product(p, inverse, a);
    assert_identity(p);
}

static void a_symmetric_matrix_times_its_inverse_is_the_identity(void **state)
{
    double a[N * N], b[N * N], inverse[N * N], p[N * N];
    (void)state;
    make_matrix(a);
    for (int i = 0; i < N * N; i++) b[i] = a[i % N * N + i / N];
    product(p, a, b);
    memcpy(inverse, p, sizeof p);
    assert_true(inverse_of_symmetric(inverse, N, 1e-12));
    product(a, inverse, p);
    assert_identity(a);
}

static void a_singular_matrix_has_no_inverse(void **state)
{
    double a[N * N], b[N * N];
    (void)state;
    make_matrix(a);
    for (int j = 0; j < N; j++) a[3 * N + j] = 2 * a[j] - a[N + j];
    assert_false(inverse_of(a, N, 1e-12));
    memset(b, 0, sizeof b);
    assert_false(inverse_of(b, N, 1e-12));
    assert_false(inverse_of_symmetric(b, N, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_matrix_times_its_inverse_is_the_identity),
        cmocka_unit_test(a_symmetric_matrix_times_its_inverse_is_the_identity),
        cmocka_unit_test(a_singular_matrix_has_no_inverse),
    };
    return cmocka_run_group_tests_name("inverse", tests, NULL, NULL);
}
