/* fit.c - lamps and materials of a floor under disk lamps, against sums over the lamps' area. */
#include "stages/fit_lights/fit.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/gather/light_list.h"
#include "common/math/numbers.h"
#include "tests/unit/scratch.h"

enum { MAX_POINTS = 200 };

static const double k_d[3] = {0.22, 0.2, 0.15};
static const double true_s[2][3] = {{260, 235, 195}, {120, 130, 150}};
static const struct vec3 centres[2] = {{0, 0, 2.6}, {1.6, 0.3, 2.4}};

struct room {
    struct vec3 at[MAX_POINTS];
    struct fit_point points[MAX_POINTS];
    struct fit_lamp lamps[2];
    struct fit_material materials[2];
    struct fit_mark marks[MAX_POINTS]; /* of five points each */
    double beta, exponent;             /* true */
    struct light_fit fit;
};

/* A number of the normal distribution [Box 1958]. */
static double gauss(uint64_t index)
{
    const struct rng rng = rng_make(7, "fit_lights", "test");
    return sqrt(-2 * log(1 - rng_uniform(&rng, index, 0))) * cos(2 * PI * rng_uniform(&rng, index, 1));
}

/* Irradiance of the floor from a lamp of radiance 1: a sum over its area. */
static double plain_direct(struct vec3 centre, struct vec3 at, double beta, double exponent)
{
    const double radius = 0.09;
    const int n = 100;
    double sum = 0;
    for (int i = 0; i < n * n; i++) {
        const double u = (2 * (i % n) + 1.0) / n - 1, v = (2 * (i / n) + 1.0) / n - 1;
        if (u * u + v * v > 1) continue;
        const struct vec3 w = vec3_sub(vec3_add(centre, vec3_make(radius * u, radius * v, 0)), at);
        const double r = vec3_length(w), cosine = w.z / r;
        if (cosine >= cos(beta)) sum += pow(cosine, exponent) * cosine * cosine / (r * r);
    }
    return sum * 4 * radius * radius / n / n;
}

/* What the fit computes: the exact integral. */
static double direct(const void *ctx, int lamp, int point, double exponent)
{
    const struct room *room = ctx;
    const struct lamp l = {.shape = LAMP_DISK,
                           .centre = centres[lamp],
                           .normal = {0, 0, -1},
                           .x = {0.09, 0, 0},
                           .y = {0, -0.09, 0},
                           .radius = 0.09,
                           .radiance = {1, 1, 1},
                           .beta = room->beta,
                           .exponent = exponent};
    return lamp_irradiance(&l, room->at[point], vec3_make(0, 0, 1)).r;
}

static void set_point(struct room *room, int i, int material, double x, double y, bool lit, double noise)
{
    struct fit_point *p = &room->points[i];
    room->at[i] = vec3_make(x, y, 0);
    *p = (struct fit_point){.material = material,
                            .lamp = material,
                            .mark = lit ? i / 5 : MAX_POINTS / 2 + i / 5,
                            .kind = lit ? POINT_LIT : POINT_UNLIT,
                            .at = room->at[i],
                            .sigma = noise};
    for (int c = 0; c < 3; c++) {
        p->indirect[c] = (1 + 0.2 * x - 0.1 * y) * (1 - 0.1 * c);
        double e = p->indirect[c];
        for (int l = 0; l < room->fit.lamp_count; l++)
            e += true_s[l][c] * plain_direct(centres[l], room->at[i], room->beta, room->exponent);
        p->radiance[c] = k_d[c] * e * (1 + noise * gauss(3 * (uint64_t)i + (uint64_t)c));
    }
}

/* Lit and unlit points under each lamp. */
static void furnish(struct room *room, int lamps, int each, double exponent, double noise)
{
    *room = (struct room){.beta = 35 * DEGREE, .exponent = exponent};
    room->fit = (struct light_fit){.points = room->points,
                                   .lamps = room->lamps,
                                   .materials = room->materials,
                                   .lamp_count = lamps,
                                   .material_count = lamps,
                                   .direct = direct,
                                   .ctx = room,
                                   .marks = room->marks,
                                   .mark_count = MAX_POINTS,
                                   .texture = 0.01,
                                   .draws = FIT_DRAWS};
    for (int l = 0; l < lamps; l++) {
        room->lamps[l] = (struct fit_lamp){.name = "spot", .fit = true, .exponent = exponent};
        room->materials[l].name = "floor";
        for (int k = 0; k < 2 * each; k++) {
            const bool lit = k < each;
            const double turn = 2.4 * k, r = lit ? 1.2 * sqrt((k + 0.5) / each) : 2.2 + 0.8 * (k - each) / (double)each;
            set_point(room, room->fit.point_count++, l, centres[l].x + r * cos(turn), centres[l].y + r * sin(turn), lit,
                      noise);
        }
    }
}

static void assert_radiance(const struct room *room, int lamp, double most)
{
    for (int c = 0; c < 3; c++) {
        const double s = room->lamps[lamp].radiance[c], off = fabs(s / true_s[lamp][c] - 1);
        if (!(off <= most)) fail_msg("lamp %d, colour %d: %.5g, wanted %.5g", lamp, c, s, true_s[lamp][c]);
        assert_true(room->lamps[lamp].radiance_error[c] > 0);
        assert_true(fabs(s - true_s[lamp][c]) < 4 * room->lamps[lamp].radiance_error[c] + 1e-3 * s);
    }
}

static void one_lit_and_one_unlit_point_give_the_lamp(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 1, 1, 0);
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 2e-3); /* of the sum over the lamp's area */
    for (int c = 0; c < 3; c++) assert_true(fabs(room.materials[0].k_d[c] / k_d[c] - 1) < 2e-3);
}

static void noise_of_photographs_leaves_the_lamp_within_three_percent(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 20, 1, 0.02 / 3); /* pixels with 2 %, nine for each point */
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.03);
}

static void lamps_that_light_each_others_points_are_fitted_together(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 2, 20, 0, 0.01);
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.03);
    assert_radiance(&room, 1, 0.03);
}

static void lamps_over_the_same_material_share_its_reflectance(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 2, 20, 0, 0.01);
    room.fit.material_count = 1;
    for (int i = 0; i < room.fit.point_count; i++) room.points[i].material = 0;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.03);
    assert_radiance(&room, 1, 0.03);
    assert_int_equal(room.materials[0].unlit, 40);
}

static void the_exponent_is_fitted(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 25, 2.5, 0.005);
    room.lamps[0].fit_exponent = true;
    room.lamps[0].exponent = 1;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_true(fabs(room.lamps[0].exponent - 2.5) < 0.25);
    assert_true(fabs(room.lamps[0].exponent - 2.5) < 4 * room.lamps[0].exponent_error);
    assert_radiance(&room, 0, 0.03);
}

static void a_lit_point_on_another_material_counts_little(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 20, 1, 0.01);
    for (int c = 0; c < 3; c++) room.points[3].radiance[c] *= 0.2;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.03);
}

/* Plaster: its reflectance varies by waves of one to three metres. */
static double plaster(uint64_t seed, double x, double y)
{
    const struct rng rng = rng_make(seed, "fit_lights", "plaster");
    double sum = 0;
    for (uint64_t k = 0; k < 12; k++) {
        const double turn = 2 * PI * rng_uniform(&rng, k, 0), wave = 2 * PI * (0.3 + 0.5 * rng_uniform(&rng, k, 1));
        sum += cos(wave * (x * cos(turn) + y * sin(turn)) + 2 * PI * rng_uniform(&rng, k, 2));
    }
    return exp(0.06 * sum / sqrt(6));
}

/* A weak lamp over plaster, with points just inside and some just outside of the edge of its cone. */
static void points_on_both_sides_of_an_edge_tell_the_lamp_from_the_plaster(void **state)
{
    (void)state;
    enum { ROOMS = 40, EACH = 40 };
    int inside = 0;
    double squares = 0;
    for (uint64_t seed = 0; seed < ROOMS; seed++) {
        struct room room;
        struct err err = ERR_INIT;
        furnish(&room, 1, EACH, 1, 0.005);
        room.fit.texture = 0.05;
        for (int k = 0; k < 2 * EACH; k++) {
            /* all lit points, but few of the others, lie at the edge */
            const bool near = k < EACH || k % 4 == 0;
            const double turn = 2 * PI * (k % EACH) / EACH, step = near ? 0.13 : 0.8;
            const double r = 2.6 * tan(room.beta) + (k < EACH ? -step : step);
            set_point(&room, k, 0, r * cos(turn), r * sin(turn), k < EACH, 0.005);
            for (int c = 0; c < 3; c++) /* the rest of the light is three times as bright */
                room.points[k].radiance[c] += 2 * k_d[c] * room.points[k].indirect[c];
            for (int c = 0; c < 3; c++) {
                room.points[k].indirect[c] *= 3;
                room.points[k].radiance[c] *= plaster(seed, room.at[k].x, room.at[k].y);
            }
        }
        assert_ok(fit_solve(&room.fit, &err), err);
        const double off = room.lamps[0].radiance[1] - true_s[0][1];
        inside += fabs(off) < 1.96 * room.lamps[0].radiance_error[1];
        squares += off * off / (true_s[0][1] * true_s[0][1]);
    }
    const double rms = sqrt(squares / ROOMS);
    if (!(rms < 0.11)) fail_msg("the lamp is off by %.3f", rms); /* 0.15 if points deviate at random */
    if (inside < 34) fail_msg("%d of %d intervals of 95 %% hold the lamp", inside, ROOMS);
}

static void the_picture_of_a_lamp_counts_beside_its_points(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 20, 1, 0.05);
    assert_ok(fit_solve(&room.fit, &err), err);
    const double points_alone = room.lamps[0].radiance_error[1];
    for (int c = 0; c < 3; c++) {
        room.lamps[0].seen[c] = 1.005 * true_s[0][c];
        room.lamps[0].seen_error[c] = 0.01;
    }
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.012);
    assert_true(room.lamps[0].radiance_error[1] < fmin(points_alone, 0.011 * true_s[0][1]));
}

static void an_error_of_indirect_light_widens_the_interval(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 20, 1, 0.01);
    room.fit.irradiance_error = 0.1;
    for (int i = 0; i < room.fit.point_count; i++)
        for (int c = 0; c < 3; c++) room.points[i].indirect[c] *= 1.1;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_true(fabs(room.lamps[0].radiance[1] / (1.1 * true_s[0][1]) - 1) < 0.03); /* S scales with it */
    assert_true(room.lamps[0].radiance_error[1] > 0.1 * true_s[0][1]);
}

/* Whether the interval of a lamp's green radiance holds a value. */
static bool holds(const struct room *room, double value)
{
    return room->lamps[0].low[1] <= value && value <= room->lamps[0].high[1];
}

static double width(const struct room *room) { return room->lamps[0].high[1] / room->lamps[0].low[1]; }

static void points_that_are_lit_alike_tell_next_to_nothing(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 1, 1, 0);
    set_point(&room, 1, 0, room.at[0].x, room.at[0].y, false, 0);
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_true(holds(&room, true_s[0][1]));
    if (!(width(&room) > 10)) fail_msg("the interval spans a factor of %.3g", width(&room));
}

static void lit_points_that_the_lamp_does_not_reach_tell_nothing(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 1, 1, 0);
    set_point(&room, 0, 0, 3, 0, true, 0);
    assert_ok(fit_solve(&room.fit, &err), err);
    if (!(width(&room) > 30)) fail_msg("the interval spans a factor of %.3g", width(&room));
}

static void lit_points_that_are_no_brighter_are_of_a_dim_lamp(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 3, 1, 0);
    for (int i = 0; i < room.fit.point_count; i++)
        for (int c = 0; c < 3; c++)
            room.points[i].radiance[c] = k_d[c] * room.points[i].indirect[c] * (i < 3 ? 0.98 : 1);
    assert_ok(fit_solve(&room.fit, &err), err);
    if (!(room.lamps[0].high[1] < 0.15 * true_s[0][1])) fail_msg("up to %.3g", room.lamps[0].high[1]);
    assert_true(room.lamps[0].low[1] > 0 && room.lamps[0].radiance[1] > 0);
}

static void an_unlit_point_without_any_light_counts_little(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 10, 1, 0.01);
    for (int c = 0; c < 3; c++) room.points[13].indirect[c] = 0;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.05);
}

static void a_mark_on_another_material_is_found_and_counts_little(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 20, 1, 0.01);
    for (int i = 0; i < room.fit.point_count; i++) room.points[i].mark = i / 5;
    for (int i = 5; i < 10; i++)
        for (int c = 0; c < 3; c++) room.points[i].radiance[c] *= 0.6;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.04);
    if (!(fabs(room.marks[1].off - log(0.6)) < 0.05)) fail_msg("the mark is off by %.3g", room.marks[1].off);
    assert_true(room.marks[1].off_error < 0.05);
    for (int m = 0; m < 8; m++) assert_true(m == 1 || fabs(room.marks[m].off) < 0.05);
}

static void marks_that_contradict_each_other_widen_the_interval(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    double alike = 0;
    for (int step = 0; step < 2; step++) {
        furnish(&room, 1, 12, 1, 0.01);
        for (int i = 0; i < room.fit.point_count; i++) room.points[i].mark = i / 6;
        for (int i = 18; step && i < 24; i++) /* one of two unlit marks */
            for (int c = 0; c < 3; c++) room.points[i].radiance[c] *= 0.7;
        assert_ok(fit_solve(&room.fit, &err), err);
        assert_true(holds(&room, true_s[0][1]));
        if (!step) alike = width(&room);
    }
    if (!(log(width(&room)) > 1.5 * log(alike))) fail_msg("a factor of %.3g, alike %.3g", width(&room), alike);
}

static void a_lamp_without_unlit_points_is_told_by_how_its_light_falls_off(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 30, 1, 0.005);
    room.beta = 90 * DEGREE;
    for (int i = 0; i < 30; i++) set_point(&room, i, 0, 0.1 * i - 0.5, 0.3, true, 0.005);
    room.fit.point_count = 30;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_true(holds(&room, true_s[0][1]));
    if (!(width(&room) < 1.6)) fail_msg("the interval spans a factor of %.3g", width(&room));
    room.fit.point_count = 1; /* and one point has the usual albedo, more or less */
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_true(holds(&room, true_s[0][1]));
    if (!(width(&room) > 4)) fail_msg("the interval spans a factor of %.3g", width(&room));
}

static void a_lamp_is_at_least_as_bright_as_it_saturates(void **state)
{
    (void)state;
    struct room room;
    struct err err = ERR_INIT;
    furnish(&room, 1, 1, 1, 0);
    set_point(&room, 0, 0, 3, 0, true, 0);
    room.lamps[0].seen_is_bound = true;
    for (int c = 0; c < 3; c++) room.lamps[0].seen[c] = 100, room.lamps[0].seen_error[c] = 0.02;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_true(room.lamps[0].low[1] > 97);
    furnish(&room, 1, 20, 1, 0.01); /* where the points know better it says nothing */
    room.lamps[0].seen_is_bound = true;
    for (int c = 0; c < 3; c++) room.lamps[0].seen[c] = 100, room.lamps[0].seen_error[c] = 0.02;
    assert_ok(fit_solve(&room.fit, &err), err);
    assert_radiance(&room, 0, 0.03);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_lit_and_one_unlit_point_give_the_lamp),
        cmocka_unit_test(noise_of_photographs_leaves_the_lamp_within_three_percent),
        cmocka_unit_test(lamps_that_light_each_others_points_are_fitted_together),
        cmocka_unit_test(lamps_over_the_same_material_share_its_reflectance),
        cmocka_unit_test(the_exponent_is_fitted),
        cmocka_unit_test(a_lit_point_on_another_material_counts_little),
        cmocka_unit_test(points_on_both_sides_of_an_edge_tell_the_lamp_from_the_plaster),
        cmocka_unit_test(the_picture_of_a_lamp_counts_beside_its_points),
        cmocka_unit_test(an_error_of_indirect_light_widens_the_interval),
        cmocka_unit_test(points_that_are_lit_alike_tell_next_to_nothing),
        cmocka_unit_test(lit_points_that_the_lamp_does_not_reach_tell_nothing),
        cmocka_unit_test(lit_points_that_are_no_brighter_are_of_a_dim_lamp),
        cmocka_unit_test(an_unlit_point_without_any_light_counts_little),
        cmocka_unit_test(a_mark_on_another_material_is_found_and_counts_little),
        cmocka_unit_test(marks_that_contradict_each_other_widen_the_interval),
        cmocka_unit_test(a_lamp_without_unlit_points_is_told_by_how_its_light_falls_off),
        cmocka_unit_test(a_lamp_is_at_least_as_bright_as_it_saturates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
