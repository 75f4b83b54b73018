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

/* ----------------------------------------------------------------------------------------------------------- photos */

enum { PATCHES = 400, PHOTOS = 2 };

/* Patches along a wall of 4 m; three lamps 1 m before it, and a window that lights one half. */
static void light_patches(double light[PATCHES][GROUPS])
{
    for (int j = 0; j < PATCHES; j++) {
        const double x = 4.0 * j / PATCHES;
        for (int g = 0; g < 3; g++) {
            const double r2 = 1 + (x - 0.5 - 1.5 * g) * (x - 0.5 - 1.5 * g);
            light[j][g] = 100 / (r2 * sqrt(r2)) + 5;
        }
        light[j][3] = x < 2 ? 60 - 20 * x : 10;
    }
}

static double quotient_of(const double *light, const double *weights, const double *truth, double exposure)
{
    double all = 0, lit = 0;
    for (int g = 0; g < GROUPS; g++) {
        all += light[g] * truth[g];
        lit += weights[g] * light[g] * truth[g];
    }
    return exposure * lit / all;
}

/* The textures have all light, one photo lacks the second lamp, another one is taken at night; both have exposures that
 * nobody knows, and one patch in ten shows something else. What photos say is how groups compare. */
static void photos_in_other_light_give_factors_beside_each_other(void **state)
{
    static const double truth[GROUPS] = {1.2, 0.5, 1.6, 0.9}, weights[PHOTOS][GROUPS] = {{1, 0, 1, 1}, {1, 1, 1, 0}};
    static const double exposures[PHOTOS] = {0.7, 2.5};
    static double light[PATCHES][GROUPS];
    static struct group_quotient list[PHOTOS][PATCHES];
    struct group_photo photos[PHOTOS];
    struct group_factor found[GROUPS];
    struct err err = ERR_INIT;
    (void)state;
    light_patches(light);
    for (int k = 0; k < PHOTOS; k++) {
        for (int j = 0; j < PATCHES; j++) {
            const double other = j % 10 == 3 ? 3 : 1;
            list[k][j] = (struct group_quotient){light[j], weights[k],
                                                 other * quotient_of(light[j], weights[k], truth, exposures[k])};
        }
        photos[k] = (struct group_photo){.patches = list[k], .count = PATCHES};
    }
    assert_int_equal(group_fit_photos(found, GROUPS, NULL, 0, photos, PHOTOS, 0.005, 0.5, &err), ST_OK);
    for (int g = 0; g < GROUPS; g++) {
        assert_near(found[g].factor / found[3].factor, truth[g] / truth[3], 0.02 * truth[g] / truth[3]);
        assert_true(found[g].measurements > 0);
    }
    for (int k = 0; k < PHOTOS; k++) {
        assert_near(photos[k].exposure / exposures[k], 1, 0.01);
        assert_true(photos[k].misfit < 0.01);
    }
    /* one lux-meter gives the sum: here 500 lx of light 1 each */
    double meter[GROUPS] = {100, 100, 100, 100};
    struct group_measurement m = {meter, 100 * (1.2 + 0.5 + 1.6 + 0.9), 0, 0.005, 0};
    assert_int_equal(group_fit_photos(found, GROUPS, &m, 1, photos, PHOTOS, 0.005, 0.5, &err), ST_OK);
    for (int g = 0; g < GROUPS; g++) assert_near(found[g].factor, truth[g], 0.02 * truth[g]);
}

/* A lamp that lights all patches alike is told from the window by a photo without it only if its exposure is known. */
static void a_known_exposure_tells_what_no_pattern_does(void **state)
{
    static const double truth[2] = {0.6, 1.2}, weights[2] = {0, 1};
    static double light[PATCHES][2];
    static struct group_quotient list[PATCHES];
    struct group_factor found[2];
    struct err err = ERR_INIT;
    (void)state;
    for (int j = 0; j < PATCHES; j++) {
        light[j][0] = light[j][1] = 10 + j % 7;
        list[j] = (struct group_quotient){light[j], weights, 0.8 * truth[1] / (truth[0] + truth[1])};
    }
    for (int known = 0; known < 2; known++) {
        struct group_photo photo = {.patches = list, .count = PATCHES, .known = known ? 0.8 : 0};
        assert_int_equal(group_fit_photos(found, 2, NULL, 0, &photo, 1, 0.01, 0.5, &err), ST_OK);
        const double wanted = known ? truth[0] / truth[1] : 1;
        assert_near(found[0].factor / found[1].factor, wanted, 0.1 * wanted);
    }
}

/* A photo in the light of the others says nothing. */
static void a_photo_in_the_same_light_changes_nothing(void **state)
{
    static const double ones[GROUPS] = {1, 1, 1, 1};
    static double light[PATCHES][GROUPS];
    static struct group_quotient list[PATCHES];
    struct group_photo photo = {.patches = list, .count = PATCHES};
    struct group_factor found[GROUPS];
    struct err err = ERR_INIT;
    (void)state;
    light_patches(light);
    for (int j = 0; j < PATCHES; j++) list[j] = (struct group_quotient){light[j], ones, 1.3 + 0.1 * (j % 2)};
    assert_int_equal(group_fit_photos(found, GROUPS, NULL, 0, &photo, 1, 0.1, 0.5, &err), ST_OK);
    for (int g = 0; g < GROUPS; g++) {
        assert_near(found[g].factor, 1, 1e-9);
        assert_int_equal(found[g].measurements, 0);
    }
}

/* Intervals hold the truth where all light is known to a tenth, and patches beside each other err together, in twenty
 * runs. */
static void intervals_by_photos_hold_the_truth(void **state)
{
    enum { ROOMS = 300 };
    static const double weights[PHOTOS][GROUPS] = {{1, 0, 1, 1}, {1, 1, 1, 0}};
    static double light[PATCHES][GROUPS];
    static struct group_quotient list[PHOTOS][PATCHES];
    struct group_photo photos[PHOTOS];
    struct group_factor found[GROUPS];
    struct rng rng = rng_make(8, "tests", "group_fit photos");
    uint64_t at = 0;
    int held = 0;
    (void)state;
    light_patches(light);
    for (int i = 0; i < ROOMS; i++) {
        double truth[GROUPS], error = 0;
        struct err err = ERR_INIT;
        double all = 0, sum = 0;
        for (int g = 0; g < GROUPS; g++) truth[g] = fmax(0.05, 1 + 0.5 * normal(&rng, &at));
        for (int j = 0; j < PATCHES; j++)
            for (int g = 0; g < GROUPS; g++) all += light[j][g], sum += truth[g] * light[j][g];
        const double kept = all / sum * (1 + 0.1 * normal(&rng, &at)); /* of all light together */
        for (int g = 0; g < GROUPS; g++) truth[g] *= kept;
        for (int k = 0; k < PHOTOS; k++) {
            for (int j = 0; j < PATCHES; j++) {
                if (j % (PATCHES / 20) == 0) error = 0.14 * normal(&rng, &at);
                list[k][j] = (struct group_quotient){light[j], weights[k],
                                                     exp(error) * quotient_of(light[j], weights[k], truth, 1)};
            }
            photos[k] = (struct group_photo){.patches = list[k], .count = PATCHES};
        }
        assert_int_equal(group_fit_photos(found, GROUPS, NULL, 0, photos, PHOTOS, 0.14, 0.5, &err), ST_OK);
        for (int g = 0; g < GROUPS; g++) held += found[g].low <= truth[g] && truth[g] <= found[g].high;
    }
    print_message("%.1f %% of intervals hold the truth\n", 100.0 * held / GROUPS / ROOMS);
    assert_in_range(held, 93 * GROUPS * ROOMS / 100, 98 * GROUPS * ROOMS / 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_measurements_give_the_factors),
        cmocka_unit_test(what_is_not_measured_stays_as_it_was),
        cmocka_unit_test(intervals_hold_the_truth),
        cmocka_unit_test(photos_in_other_light_give_factors_beside_each_other),
        cmocka_unit_test(a_known_exposure_tells_what_no_pattern_does),
        cmocka_unit_test(a_photo_in_the_same_light_changes_nothing),
        cmocka_unit_test(intervals_by_photos_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
