/* Factors of lamps and windows by measurements in states of switches. */
#include "stages/light_levels/group_fit.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "tests/unit/scratch.h"

enum { GROUPS = 4, PLACES = 6, STATES = 3, COUNT = PLACES * STATES };

/* A number of the normal distribution by Box and Muller. */
static double normal(struct rng *rng, uint64_t *at)
{
    const double radius = sqrt(-2 * log(1 - rng_uniform(rng, 0, *at))), turn = 2 * PI * rng_uniform(rng, 1, *at);
    ++*at;
    return radius * cos(turn);
}

static void assert_near(double found, double wanted, double tolerance)
{
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.9g, wanted %.9g +- %g", found, wanted, tolerance);
}

/* Light of each group at each place falls off from the place that it is nearest to; each state leaves one out. */
static void set_light(double light[COUNT][GROUPS])
{
    for (int k = 0; k < COUNT; k++)
        for (int g = 0; g < GROUPS; g++) {
            const int place = k % PLACES, away = abs(place - g * PLACES / GROUPS);
            light[k][g] = k / PLACES == g ? 0 : 400.0 / (1 + away * away);
        }
}

static void measure(struct group_measurement m[COUNT], double light[COUNT][GROUPS], const double truth[GROUPS],
                    double error, struct rng *rng, uint64_t *at)
{
    for (int k = 0; k < COUNT; k++) {
        double sum = 0;
        for (int g = 0; g < GROUPS; g++) sum += light[k][g] * truth[g];
        m[k] =
            (struct group_measurement){light[k], (sum + 25) * (1 + (rng ? error * normal(rng, at) : 0)), 25, error, 0};
        m[k].lux = fmax(m[k].lux, 26);
    }
}

static void exact_measurements_give_the_factors(void **state)
{
    static const double truth[GROUPS] = {0.4, 1.7, 0, 1};
    double light[COUNT][GROUPS];
    struct group_measurement m[COUNT];
    struct group_factor found[GROUPS];
    struct err err = ERR_INIT;
    (void)state;
    set_light(light);
    measure(m, light, truth, 1e-4, NULL, NULL);
    assert_int_equal(group_fit(found, GROUPS, m, COUNT, 0.5, &err), ST_OK);
    for (int g = 0; g < GROUPS; g++) {
        assert_near(found[g].factor, truth[g], 1e-3);
        assert_true(found[g].low <= found[g].factor && found[g].factor <= found[g].high && found[g].low >= 0);
        assert_int_equal(found[g].measurements > 0, truth[g] > 0);
    }
    for (int k = 0; k < COUNT; k++) assert_true(fabs(m[k].deviation) < 3);
}

/* Without measurements a factor is 1 within its spread; one measurement of two lamps tells their sum alone. */
static void what_is_not_measured_stays_as_it_was(void **state)
{
    struct group_factor found[2];
    double light[2] = {100, 100};
    struct group_measurement m = {light, 300, 0, 0.01, 0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(group_fit(found, 1, NULL, 0, 0.5, &err), ST_OK);
    assert_near(found[0].factor, 1, 1e-9);
    assert_near(found[0].high - 1, 0.98, 0.001);
    assert_int_equal(group_fit(found, 2, &m, 1, 0.5, &err), ST_OK);
    assert_near(found[0].factor, found[1].factor, 1e-6);
    assert_near(found[0].factor + found[1].factor, 3, 0.01);
    assert_near(found[0].high - found[0].low, 2 * 1.96 * 0.5 / sqrt(2), 0.02);
}

/* 95 % intervals hold the truth 93 to 97 % of the time, over 1000 rooms whose lamps spread as assumed. */
static void intervals_hold_the_truth(void **state)
{
    enum { ROOMS = 1000 };
    double light[COUNT][GROUPS], truth[GROUPS];
    struct group_measurement m[COUNT];
    struct group_factor found[GROUPS];
    struct rng rng = rng_make(7, "tests", "group_fit");
    uint64_t at = 0;
    int held = 0;
    (void)state;
    set_light(light);
    for (int i = 0; i < ROOMS; i++) {
        struct err err = ERR_INIT;
        for (int g = 0; g < GROUPS; g++) truth[g] = fmax(0, 1 + 0.5 * normal(&rng, &at));
        measure(m, light, truth, 0.2, &rng, &at);
        assert_int_equal(group_fit(found, GROUPS, m, COUNT, 0.5, &err), ST_OK);
        for (int g = 0; g < GROUPS; g++) held += found[g].low <= truth[g] && truth[g] <= found[g].high;
    }
    assert_in_range(held, 93 * GROUPS * ROOMS / 100, 97 * GROUPS * ROOMS / 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_measurements_give_the_factors),
        cmocka_unit_test(what_is_not_measured_stays_as_it_was),
        cmocka_unit_test(intervals_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
