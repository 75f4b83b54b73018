/* given_check.c - given depth and disparity against sparse points at known depths. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/segment_depth/given_check.h"

enum { W = 40, H = 30, POINTS = 60 };

static struct observed_point points[POINTS];
static float values[W * H];

static double depth_at(int x, int y) { return 2 + 0.1 * x + 0.05 * y * y; }

/* Points spread over the picture, the first `wrong` of them at another depth; values: a function of depth. */
static struct observed_points scene(double (*value)(double z), int wrong)
{
    for (int i = 0; i < W * H; i++) values[i] = (float)value(depth_at(i % W, i / W));
    for (int i = 0; i < POINTS; i++) {
        const int x = 17 * i % W, y = 11 * i % H;
        points[i] = (struct observed_point){i, x + 0.5, y + 0.5, i < wrong ? 0.01 * i : 1 / depth_at(x, y)};
    }
    return (struct observed_points){points, POINTS};
}

static double depth(double z) { return 3 * z; }
static double logarithm(double z) { return log(z); }
static double disparity(double z) { return 20 / z; }
static double network(double z) { return 7 * (1 / z - 0.01); } /* an unknown scale and shift */
static double level(double z) { return (void)z, 5; }

static double ranks_of(double (*value)(double z), int wrong)
{
    const struct observed_points seen = scene(value, wrong);
    struct err err = ERR_INIT;
    double ranks = 2;
    assert_ok(given_check_ranks(&ranks, values, W, H, &seen, &err), err);
    return ranks;
}

static void ranks_tell_depth_from_disparity(void **state)
{
    (void)state;
    assert_true(fabs(ranks_of(depth, 0) - 1) < 1e-3); /* in any units */
    assert_true(fabs(ranks_of(logarithm, 0) - 1) < 1e-3);
    assert_true(fabs(ranks_of(disparity, 0) + 1) < 1e-3);
    assert_true(ranks_of(depth, 12) > 0.5);
    assert_true(ranks_of(network, 12) < -0.5);
    assert_true(ranks_of(level, 0) == 0);
}

/* 1, 2, 3, ..., against the same with two neighbours exchanged: 1 - 6 sum d^2 / (n (n^2 - 1)). */
static void the_correlation_is_spearmans(void **state)
{
    (void)state;
    enum { N = GIVEN_CHECKED };
    struct observed_points seen = {points, N};
    struct err err = ERR_INIT;
    double ranks = 0;
    for (int i = 0; i < N; i++) {
        values[i] = (float)(i + 1);
        points[i] = (struct observed_point){i, i + 0.5, 0.5, 1.0 / (i == 4 ? 6 : i == 5 ? 5 : i + 1)};
    }
    assert_ok(given_check_ranks(&ranks, values, W, H, &seen, &err), err);
    assert_true(fabs(ranks - (1 - 6 * 2.0 / (N * (N * N - 1.0)))) < 1e-12);
    seen.count--;
    assert_ok(given_check_ranks(&ranks, values, W, H, &seen, &err), err);
    assert_true(isnan(ranks)); /* too few */
    seen.count = N;
    points[3].u = W + 1; /* outside of the picture */
    assert_ok(given_check_ranks(&ranks, values, W, H, &seen, &err), err);
    assert_true(isnan(ranks));
}

static void relative_disparity_becomes_depth(void **state)
{
    (void)state;
    for (int wrong = 0; wrong <= 20; wrong += 10) { /* up to a third of the points */
        const struct observed_points seen = scene(network, wrong);
        struct err err = ERR_INIT;
        bool fits = false;
        values[5] = 0; /* unknown */
        assert_ok(given_check_fit(&fits, values, W, H, &seen, &err), err);
        assert_true(fits);
        for (int i = 0; i < W * H; i++) {
            const double z = depth_at(i % W, i / W);
            assert_true(i == 5 ? values[i] == 0 : fabs((double)values[i] / z - 1) < 1e-3);
        }
    }
}

static void depth_is_no_disparity(void **state)
{
    (void)state;
    struct observed_points seen = scene(depth, 0);
    struct err err = ERR_INIT;
    bool fits = true;
    const float before = values[7];
    assert_ok(given_check_fit(&fits, values, W, H, &seen, &err), err);
    assert_false(fits);
    assert_true(values[7] == before);
    seen = scene(network, 0);
    seen.count = GIVEN_CHECKED - 1;
    fits = true;
    assert_ok(given_check_fit(&fits, values, W, H, &seen, &err), err);
    assert_false(fits);
    seen = scene(level, 0);
    assert_ok(given_check_fit(&fits, values, W, H, &seen, &err), err);
    assert_false(fits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranks_tell_depth_from_disparity),
        cmocka_unit_test(the_correlation_is_spearmans),
        cmocka_unit_test(relative_disparity_becomes_depth),
        cmocka_unit_test(depth_is_no_disparity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
