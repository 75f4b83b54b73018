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

/* The only view: 49 of 50 of 2 % are cut at either end of an even ramp from 10 to 40 with two wild values. */
static void the_only_view_has_a_free_scale(void **state)
{
    enum { N = 1000 };
    float own[N];
    struct err err = ERR_INIT;
    (void)state;
    for (int disparity = 0; disparity < 2; disparity++) {
        bool known = false;
        double farthest = 0;
        for (int i = 0; i < N; i++) own[i] = i < 2 ? 0 : 10 + 30 * (float)(i - 2) / (N - 3); /* two are unknown */
        own[N - 1] = 1e6f;
        own[2] = 1e-3f;
        const double low = 10 + 30 * 19 / 997.0, high = 10 + 30 * 978 / 997.0; /* of 998 known ones, 19 at either end */
        assert_ok(given_check_lone(&known, &farthest, own, N / 10, 10, disparity, &err), err);
        assert_true(known);
        assert_float_equal(farthest, high / low, 1e-4 * high / low);
        assert_true(own[0] == 0 && own[1] == 0);
        assert_float_equal(own[500], disparity ? high / (10 + 30 * 498 / 997.0) : (10 + 30 * 498 / 997.0) / low, 1e-4);
        assert_true(own[disparity ? 2 : N - 1] == LONE_FARTHEST); /* as far as it may be */
    }
    bool known = true;
    double farthest = 0;
    memset(own, 0, sizeof own);
    assert_ok(given_check_lone(&known, &farthest, own, N / 10, 10, true, &err), err);
    assert_false(known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranks_tell_depth_from_disparity),  cmocka_unit_test(the_correlation_is_spearmans),
        cmocka_unit_test(relative_disparity_becomes_depth), cmocka_unit_test(depth_is_no_disparity),
        cmocka_unit_test(the_only_view_has_a_free_scale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
