/* cone.c - beta of a disk lamp from lines on a floor, with the pixels and the noise of photographs. */
#include "stages/fit_lights/cone.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/gather/light_list.h"
#include "common/math/numbers.h"
#include "tests/unit/scratch.h"

enum { PLACES = 161, MAX_LINES = 6, PHOTOS = 4 };

struct floor_lines {
    double angle[MAX_LINES][PLACES], indirect[MAX_LINES][PLACES][3];
    double radiance[MAX_LINES * PHOTOS][PLACES][3], sigma[MAX_LINES * PHOTOS][PLACES];
    struct vec3 at[MAX_LINES][PLACES];
    struct cone_line lines[MAX_LINES];
    struct cone_trace traces[MAX_LINES * PHOTOS];
    struct cone_fit fit;
};

static struct lamp lamp_of(double beta)
{
    return (struct lamp){.shape = LAMP_DISK,
                         .centre = {0, 0, 2.6},
                         .normal = {0, 0, -1},
                         .x = {0.09, 0, 0},
                         .y = {0, -0.09, 0},
                         .radius = 0.09,
                         .radiance = {1, 1, 1},
                         .beta = beta,
                         .exponent = 1};
}

static double direct(const void *ctx, int line, int place, double beta)
{
    const struct floor_lines *f = ctx;
    const struct lamp l = lamp_of(beta);
    return lamp_irradiance(&l, f->at[line][place], vec3_make(0, 0, 1)).r;
}

/* A number of the normal distribution [Box 1958]. */
static double gauss(uint64_t index)
{
    const struct rng rng = rng_make(11, "fit_lights", "test");
    return sqrt(-2 * log(1 - rng_uniform(&rng, index, 0))) * cos(2 * PI * rng_uniform(&rng, index, 1));
}

/* Lines from `from` to `to` metres from the lamp's foot, in photos whose pixels are `pixel` metres wide. */
static void draw(struct floor_lines *f, int lines, double from, double to, double beta, double noise, double pixel)
{
    const struct lamp l = lamp_of(beta);
    *f = (struct floor_lines){.fit = {.lamp = "spot",
                                      .lines = f->lines,
                                      .traces = f->traces,
                                      .line_count = lines,
                                      .trace_count = lines * PHOTOS,
                                      .direct = direct,
                                      .ctx = f,
                                      .texture = 0.01}};
    for (int k = 0; k < lines; k++) {
        f->lines[k] = (struct cone_line){PLACES, f->angle[k], (const double(*)[3])f->indirect[k], "lights.txt:9"};
        for (int i = 0; i < PLACES; i++) {
            const double r = from + (to - from) * i / (PLACES - 1);
            f->at[k][i] = vec3_make(r * cos(k), r * sin(k), 0);
            f->angle[k][i] = atan2(r, 2.6);
            for (int c = 0; c < 3; c++) f->indirect[k][i][c] = 1 - 0.1 * c + 0.1 * r;
        }
        for (int p = 0; p < PHOTOS; p++) {
            const int t = k * PHOTOS + p;
            f->traces[t] = (struct cone_trace){k, (const double(*)[3])f->radiance[t], f->sigma[t]};
            for (int i = 0; i < PLACES; i++) {
                const double r = from + (to - from) * i / (PLACES - 1);
                const double grid = (floor(r / pixel + 0.25 * p) - 0.25 * p + 0.5) * pixel; /* the pixel's middle */
                const double e =
                    235 * lamp_irradiance(&l, vec3_make(grid * cos(k), grid * sin(k), 0), vec3_make(0, 0, 1)).r;
                const uint64_t sample = (uint64_t)(1000 * t) + (uint64_t)floor(r / pixel + 0.25 * p);
                f->sigma[t][i] = noise;
                for (int c = 0; c < 3; c++)
                    f->radiance[t][i][c] =
                        0.2 * (f->indirect[k][i][c] + e) * (1 + noise * gauss(3 * sample + (uint64_t)c));
            }
        }
    }
}

static void beta_is_found_within_half_a_degree(void **state)
{
    (void)state;
    static struct floor_lines f;
    for (int degrees = 20; degrees <= 50; degrees += 6) {
        struct err err = ERR_INIT;
        const double r = 2.6 * tan(degrees * DEGREE);
        draw(&f, 3, fmax(0, r - 0.6), r + 0.5, degrees * DEGREE, 0.02, 0.012);
        assert_ok(cone_fit_solve(&f.fit, &err), err);
        if (fabs(f.fit.beta / DEGREE - degrees) > 0.25) fail_msg("found %.3f, wanted %d", f.fit.beta / DEGREE, degrees);
        assert_true(f.fit.error > 0 && f.fit.error < 0.5 * DEGREE);
    }
}

static void a_known_radiance_and_a_near_start_refine_beta(void **state)
{
    (void)state;
    static struct floor_lines f;
    struct err err = ERR_INIT;
    draw(&f, 2, 1.5, 2.5, 38 * DEGREE, 0.02, 0.012);
    f.fit.has_radiance = true;
    f.fit.radiance[0] = f.fit.radiance[1] = f.fit.radiance[2] = 1.1 * 235; /* it need not be exact */
    f.fit.reach = 3 * DEGREE;
    f.fit.beta = 39.4 * DEGREE;
    assert_ok(cone_fit_solve(&f.fit, &err), err);
    assert_true(fabs(f.fit.beta / DEGREE - 38) < 0.25);
}

static void an_edge_of_the_material_does_not_replace_the_cones(void **state)
{
    (void)state;
    static struct floor_lines f;
    struct err err = ERR_INIT;
    draw(&f, 4, 1.4, 2.6, 38 * DEGREE, 0.01, 0.012);
    for (int t = 0; t < PHOTOS; t++) /* a poster on one line of four */
        for (int i = 20; i < 45; i++)
            for (int c = 0; c < 3; c++) f.radiance[t][i][c] *= 0.3;
    assert_ok(cone_fit_solve(&f.fit, &err), err);
    assert_true(fabs(f.fit.beta / DEGREE - 38) < 0.25);
}

static void places_that_photos_do_not_show_are_left_out(void **state)
{
    (void)state;
    static struct floor_lines f;
    struct err err = ERR_INIT;
    draw(&f, 2, 1.5, 2.5, 38 * DEGREE, 0.01, 0.012);
    for (int i = 0; i < 60; i++)
        for (int c = 0; c < 3; c++) f.radiance[1][i][c] = 0;
    assert_ok(cone_fit_solve(&f.fit, &err), err);
    assert_true(fabs(f.fit.beta / DEGREE - 38) < 0.25);
}

static void assert_refused(struct floor_lines *f, const char *why)
{
    struct err err = ERR_INIT;
    assert_int_equal(cone_fit_solve(&f->fit, &err), ST_DATA);
    if (!strstr(err.text, why)) fail_msg("the error says: %s", err.text);
}

static void a_line_that_is_lit_all_along_is_refused(void **state)
{
    (void)state;
    static struct floor_lines f;
    draw(&f, 1, 0.2, 1.2, 60 * DEGREE, 0, 0.012);
    assert_refused(&f, "as if beta were 90");
}

static void a_line_that_is_dark_all_along_is_refused(void **state)
{
    (void)state;
    static struct floor_lines f;
    draw(&f, 1, 2.0, 3.0, 20 * DEGREE, 0, 0.012);
    assert_refused(&f, "as if beta were 0");
}

static void a_lamp_without_lines_is_refused(void **state)
{
    (void)state;
    static struct floor_lines f;
    draw(&f, 1, 2.0, 3.0, 20 * DEGREE, 0, 0.012);
    f.fit.trace_count = 0;
    assert_refused(&f, "no line that a view shows");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beta_is_found_within_half_a_degree),
        cmocka_unit_test(a_known_radiance_and_a_near_start_refine_beta),
        cmocka_unit_test(an_edge_of_the_material_does_not_replace_the_cones),
        cmocka_unit_test(places_that_photos_do_not_show_are_left_out),
        cmocka_unit_test(a_line_that_is_lit_all_along_is_refused),
        cmocka_unit_test(a_line_that_is_dark_all_along_is_refused),
        cmocka_unit_test(a_lamp_without_lines_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
