/* level_spread.c - intervals by shares of light: what fit.txt and sky.txt say becomes errors of groups, and these
 * widen a value by the group's direct light, and in other states by what the state reflects of it. */
#include "tests/unit/level_room.h"

#include "stages/light_levels/level_spread.h"

/* Two lamps, one window and `elsewhere`. */
enum { LAMP, LAMP2, REST, SKY, SKY2, SUN, SUN2, GROUPS };
static char names[2][8] = {"one", "two"};

struct lit {
    struct lamp lamps[2];
    struct model_field field;
    struct light_groups groups;
    double relative[GROUPS], absolute[GROUPS + 1];
    struct state_weights weights;
};

static void light(struct lit *l)
{
    *l = (struct lit){.groups = {.windows_count = 2,
                                 .lamps = LAMP,
                                 .rest = REST,
                                 .sky = SKY,
                                 .sun = SUN,
                                 .patch = GROUPS,
                                 .beam = GROUPS + 1,
                                 .planned = GROUPS + 1,
                                 .count = GROUPS + 1}};
    for (int i = 0; i < 2; i++) l->lamps[i] = (struct lamp){.name = names[i], .radiance = {10, 10, 10}};
    l->field.lights = (struct light_list){.lamps = l->lamps, .lamp_count = 2};
    l->groups.field = &l->field;
    l->weights = (struct state_weights){.relative = l->relative, .absolute = l->absolute};
}

static void read_errors(struct light_errors *e, const struct lit *l, const char *fit, const char *sky)
{
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (fit) fit = scratch_write("fit.txt", fit);
    if (sky) sky = scratch_write("sky.txt", sky);
    assert_ok(light_errors_read(e, fit, sky, &l->groups, &prov, &err), err);
    provenance_release(&prov);
}

static void assert_error(const struct light_errors *e, int group, double dark, double bright)
{
    assert_near(e->of[group].dark, dark / LIGHT_NORMAL_95, 1e-9);
    assert_near(e->of[group].bright, bright / LIGHT_NORMAL_95, 1e-9);
}

/* Ends of intervals of 95 % are 1.96 standard deviations of the logarithm away. */
static void files_become_errors_of_both_sides(void **state)
{
    struct lit l;
    struct light_errors e;
    (void)state;
    light(&l);
    read_errors(&e, &l,
                "remodel-light-fit 1\nlamp one fitted 10 10 10 1 1 1 beta 90 0 exponent 0 0\n"
                "range one 5 30 5 30 5 30\nlamp two unseen 10 10 10 2 2 2 beta 90 0 exponent 0 0\n",
                "remodel-sky 1\nsky 5 brightest 2 misfit 0.03\nsun patches azimuth 1 elevation 40 error 0.2 radius 1 "
                "painted 1 irradiance 2 2 2 error 0.5 places 20 lamps 0.1\n");
    assert_error(&e, LAMP, log(2), log(3));
    assert_error(&e, LAMP2, -log(0.8), log(1.2));
    assert_error(&e, REST, 0, 0);
    for (int v = 0; v < 2; v++) {
        assert_error(&e, SKY + v, 0.03 * LIGHT_NORMAL_95, 0.03 * LIGHT_NORMAL_95);
        assert_error(&e, SUN + v, log(2), log(1.5));
    }
    light_errors_release(&e);
}

/* A lower bound may be four times as bright; also in lights.txt, where no fit is known. */
static void a_lower_bound_is_wide_to_the_bright_side(void **state)
{
    struct lit l;
    struct light_errors e;
    (void)state;
    light(&l);
    l.lamps[1].bound = true;
    read_errors(&e, &l, NULL, NULL);
    assert_error(&e, LAMP, 0, 0);
    assert_error(&e, LAMP2, 0, log(4));
    light_errors_release(&e);
    read_errors(&e, &l, "remodel-light-fit 1\nlamp two bound 10 10 10 1 1 1 beta 90 0 exponent 0 0\n",
                "remodel-sky 1\nsky unknown\nsun unknown\n");
    assert_error(&e, LAMP2, -log(0.9), log(4.4));
    assert_error(&e, SKY, 0, 0);
    light_errors_release(&e);
}

static void a_lamp_that_the_scene_does_not_have_is_an_error(void **state)
{
    struct lit l;
    struct light_errors e;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    (void)state;
    light(&l);
    const char *fit = scratch_write("fit.txt", "remodel-light-fit 1\nlamp three fitted 1 1 1 0 0 0 beta 90 0\n");
    assert_int_equal(light_errors_read(&e, fit, NULL, &l.groups, &prov, &err), ST_DATA);
    assert_non_null(strstr(err.text, "fit.txt:2"));
    assert_non_null(strstr(err.text, "three"));
    light_errors_release(&e);
    provenance_release(&prov);
}

/* ------------------------------------------------------------------------------------------------------------ spread
 * */

/* The lamps give 2 and 1 directly and the sky 1; 1, 0 and 1 of them are reflected. */
static const float direct[GROUPS + 1] = {2, 1, 0, 1}, whole[GROUPS + 1] = {3, 1, 0, 2};

/* The ends of the interval of a state's light at that point, with standard errors of 0.1 of lamps and 0.05 of the
 * sky. */
static double sum_of(double ends[2], struct lit *l, const struct levels_params *params)
{
    static const double factors[2] = {1, 1}, none[2] = {0, 0};
    struct group_error of[GROUPS] = {{0.1, 0.1}, {0.1, 0.1}, {0, 0}, {0.05, 0.05}, {0.05, 0.05}};
    const struct light_errors e = {of, GROUPS};
    float all[GROUPS + 1], alone[GROUPS + 1];
    memcpy(all, whole, sizeof all);
    memcpy(alone, direct, sizeof alone);
    all[GROUPS] = 4; /* of another sky, of which 2 are reflected */
    alone[GROUPS] = 2;
    const struct level_points points = {NULL, 1, GROUPS + 1, all, alone};
    struct level_spread s;
    struct err err = ERR_INIT;
    double value[2];
    level_points_sum(value, &points, 0, &l->weights, NULL);
    assert_ok(level_spread_init(&s, &e, &err), err);
    level_spread_add_point(&s, &points, 0, &l->groups, &l->weights, factors, 1);
    level_spread_ends(ends, &s, value[0] + value[1], &e, &l->groups, &l->weights, params, none);
    level_spread_release(&s);
    return value[0] + value[1];
}

static void assert_ends(const double ends[2], double error)
{
    assert_near(log(ends[1]) / LIGHT_NORMAL_95, error, 1e-6);
    assert_near(log(ends[0]) / LIGHT_NORMAL_95, -error, 1e-6);
}

/* What is reflected was photographed, so direct light counts: 3 of lamps, whose errors add up, and 1 of the sky. */
static void photographed_light_is_off_by_its_direct_parts(void **state)
{
    struct levels_params params = LEVELS_PARAMS_DEFAULT;
    struct lit l;
    double ends[2];
    (void)state;
    light(&l);
    for (int k = 0; k < GROUPS; k++) l.relative[k] = 1;
    params.error = 0;
    assert_near(sum_of(ends, &l, &params), 6, 1e-12);
    assert_ends(ends, hypot(0.1 * 3, 0.05 * 1) / 6);
    params.error = 0.07;
    sum_of(ends, &l, &params);
    assert_ends(ends, hypot(0.07, hypot(0.1 * 3, 0.05 * 1) / 6));
}

/* The lamps alone: with reflected light of the photograph l + s = 2, half of it each, a surface's reflectance falls by
 * half of what a lamp or the sky seems brighter by. So the first lamp's 2 + 1 change by 2.5, and by -0.5 with the
 * sky. */
static void lamps_alone_are_off_by_what_the_sky_seems_to_give(void **state)
{
    struct levels_params params = LEVELS_PARAMS_DEFAULT;
    struct lit l;
    double ends[2];
    (void)state;
    light(&l);
    l.relative[LAMP] = 1;
    params.error = 0;
    assert_near(sum_of(ends, &l, &params), 3, 1e-12);
    assert_ends(ends, hypot(0.1 * 2.5, 0.05 * 0.5) / 3);
}

/* Another sky, 4 of light: its own error, and those of the reflectances that 2 of it met. */
static void another_sky_has_an_error_of_its_own(void **state)
{
    struct levels_params params = LEVELS_PARAMS_DEFAULT;
    struct lit l;
    double ends[2];
    (void)state;
    light(&l);
    l.absolute[GROUPS] = 1;
    params.error = 0;
    params.sky_error = 0.2;
    assert_near(sum_of(ends, &l, &params), 4, 1e-12);
    assert_ends(ends, sqrt(0.2 * 0.2 + (0.1 * 1 * 0.1 * 1 + 0.05 * 1 * 0.05 * 1) / 16));
}

/* In the dark nothing is known but the rest. */
static void no_light_has_no_share(void **state)
{
    struct levels_params params = LEVELS_PARAMS_DEFAULT;
    struct lit l;
    double ends[2];
    (void)state;
    light(&l);
    assert_near(sum_of(ends, &l, &params), 0, 0);
    assert_ends(ends, params.error);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_become_errors_of_both_sides),
        cmocka_unit_test(a_lower_bound_is_wide_to_the_bright_side),
        cmocka_unit_test(a_lamp_that_the_scene_does_not_have_is_an_error),
        cmocka_unit_test(photographed_light_is_off_by_its_direct_parts),
        cmocka_unit_test(lamps_alone_are_off_by_what_the_sky_seems_to_give),
        cmocka_unit_test(another_sky_has_an_error_of_its_own),
        cmocka_unit_test(no_light_has_no_share),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
