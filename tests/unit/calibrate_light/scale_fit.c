/* scale_fit.c - one scale from exposures, and from measurements that agree or do not. */
#include "stages/calibrate_light/scale_fit.h"

#include <math.h>

#include "tests/unit/scratch.h"

#include "common/base/rng.h"
#include "common/math/numbers.h"

static const struct calibrate_params params = CALIBRATE_PARAMS_DEFAULT;

static bool near(double a, double b, double part) { return fabs(a - b) <= part * fabs(b); }

/* 1/60 s at f/8 and ISO 100 is an exposure of 1/38.4; white is 120 x 38.4 = 4608 cd/m2, a stop to either side. */
static void white_follows_from_the_exposure(void **state)
{
    struct photo_record r = {.info = {.seconds = 1.0 / 60, .f_number = 8, .iso = 100}};
    (void)state;
    double exposure = scale_exposure(&r);
    assert_true(near(exposure, 1 / 38.4, 1e-12));
    const struct lux_interval i = scale_of_exposures(&exposure, 1, &params);
    assert_true(near(i.scale, 4608, 1e-12) && near(i.low, 2304, 1e-12) && near(i.high, 9216, 1e-12));
    /* of several exposures, white counts */
    struct bracket brackets[3] = {{.exposure = 1 / 38.4}};
    r.brackets = brackets;
    r.bracket_count = 3;
    r.white = 1 / 19.2;
    assert_true(scale_exposure(&r) == r.white);
    /* a view whose white is its own, as import_photos writes it */
    brackets[0].exposure = r.white = r.bracket_count = 1;
    assert_true(near(scale_exposure(&r), 1 / 38.4, 1e-12));
    r.info.iso = 0;
    assert_true(scale_exposure(&r) == 0);
    assert_true(scale_of_exposures(&exposure, 0, &params).scale == 0);
}

static void photos_of_their_own_exposure_widen_the_interval(void **state)
{
    double exposures[3] = {0.5, 2, 1}; /* standard deviation of the logarithms sqrt(2 / 3) ln 2 */
    (void)state;
    const struct lux_interval i = scale_of_exposures(exposures, 3, &params);
    const double half = log(2) * sqrt(1 + 1.96 * 1.96 * 2 / 3);
    assert_true(near(i.scale, 120, 1e-12) && near(log(i.high / i.scale), half, 1e-12));
    assert_true(near(log(i.scale / i.low), half, 1e-12));
}

static struct lux_measurement measured(double value, double light, double expected)
{
    return (struct lux_measurement){.value = value, .light = light, .expected = expected};
}

static void measurements_that_agree_give_their_quotient(void **state)
{
    struct lux_measurement m[3] = {measured(500, 1, 0.1), measured(50, 0.1, 0.1), measured(1000, 2, 0.2)};
    (void)state;
    struct lux_interval i = scale_of_measurements(m, 3, &params);
    /* weights 100 + 100 + 25 */
    const double half = 1.96 * hypot(1 / 15.0, params.common_error);
    assert_true(near(i.scale, 500, 1e-12) && near(log(i.high / i.low), 2 * half, 1e-9));
    for (int k = 0; k < 3; k++) assert_true(!m[k].off && fabs(m[k].deviation) < 1e-12);
    i = scale_of_measurements(m, 1, &params);
    assert_true(near(log(i.high / i.scale), 1.96 * hypot(0.1, params.common_error), 1e-9));
}

static void one_that_is_off_is_named_and_moves_little(void **state)
{
    struct lux_measurement m[6];
    (void)state;
    for (int k = 0; k < 6; k++) m[k] = measured(300 * (1 + 0.01 * k), 1 + 0.01 * k, 0.1);
    m[4].value *= 10; /* klx for lx */
    const struct lux_interval i = scale_of_measurements(m, 6, &params);
    for (int k = 0; k < 6; k++) assert_int_equal(m[k].off, k == 4);
    assert_true(i.low < 300 && i.high > 300 && near(i.scale, 300, 0.04));
    assert_true(near(m[4].deviation, log(10), 0.03));
}

static void two_that_disagree_are_both_named(void **state)
{
    struct lux_measurement m[2] = {measured(100, 1, 0.05), measured(300, 1, 0.05)};
    (void)state;
    const struct lux_interval i = scale_of_measurements(m, 2, &params);
    assert_true(m[0].off && m[1].off);
    assert_true(i.low < 100 && i.high > 300);
}

/* A normal number, by Box and Muller. */
static double normal(const struct rng *r, int scene, int k)
{
    const double u = rng_uniform(r, (uint64_t)scene, (uint64_t)(2 * k));
    const double v = rng_uniform(r, (uint64_t)scene, (uint64_t)(2 * k + 1));
    return sqrt(-2 * log(1 - u)) * cos(2 * PI * v);
}

/* 1000 scenes with 6 measurements each, whose errors are as expected; one in six scenes has a gross one as well. */
static void intervals_hold_the_truth(void **state)
{
    enum { SCENES = 1000, COUNT = 6 };
    const struct rng r = rng_make(45, "calibrate_light", "");
    int held = 0;
    (void)state;
    for (int s = 0; s < SCENES; s++) {
        struct lux_measurement m[COUNT];
        const double common = exp(params.common_error * normal(&r, s, COUNT));
        for (int k = 0; k < COUNT; k++) m[k] = measured(100 * common * exp(0.1 * normal(&r, s, k)), 1, 0.1);
        if (s % 6 == 0) m[0].value *= 5;
        const struct lux_interval i = scale_of_measurements(m, COUNT, &params);
        held += i.low <= 100 && 100 <= i.high;
    }
    if (held < 930 || held > 985) fail_msg("%d of %d intervals hold the truth", held, SCENES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_follows_from_the_exposure),
        cmocka_unit_test(photos_of_their_own_exposure_widen_the_interval),
        cmocka_unit_test(measurements_that_agree_give_their_quotient),
        cmocka_unit_test(one_that_is_off_is_named_and_moves_little),
        cmocka_unit_test(two_that_disagree_are_both_named),
        cmocka_unit_test(intervals_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
