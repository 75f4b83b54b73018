/* gradient_solve.c - gradient problems: both solvers against closed forms and against each other. */
#include "common/math/gradient_solve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"

/* A problem that owns its arrays: every pixel free, no data, weight 1 and gradient 0 between neighbours, values 0. */
struct made {
    struct gradient_problem p;
    uint8_t *role;
    float *data_weight, *data, *weight_x, *gradient_x, *weight_y, *gradient_y;
};

static float *floats(size_t count, float value)
{
    float *f = malloc(count * sizeof *f);
    assert_non_null(f);
    for (size_t i = 0; i < count; i++) f[i] = value;
    return f;
}

static struct made make(int width, int height)
{
    const size_t n = (size_t)width * (size_t)height;
    struct made m = {.role = malloc(n),
                     .data_weight = floats(n, 0),
                     .data = floats(3 * n, 0),
                     .weight_x = floats(n, 1),
                     .gradient_x = floats(3 * n, 0),
                     .weight_y = floats(n, 1),
                     .gradient_y = floats(3 * n, 0)};
    assert_non_null(m.role);
    memset(m.role, GRADIENT_FREE, n);
    m.p = (struct gradient_problem){width,      height,       m.role,     m.data_weight, m.data,
                                    m.weight_x, m.gradient_x, m.weight_y, m.gradient_y,  floats(3 * n, 0)};
    return m;
}

static void release(struct made *m)
{
    free(m->role);
    free(m->data_weight);
    free(m->data);
    free(m->weight_x);
    free(m->gradient_x);
    free(m->weight_y);
    free(m->gradient_y);
    free(m->p.value);
}

static void fix(struct made *m, size_t pixel, float red)
{
    m->role[pixel] = GRADIENT_FIXED;
    for (size_t c = 0; c < 3; c++) m->p.value[3 * pixel + c] = red * (float)(c + 1);
}

typedef enum status solver(const struct gradient_problem *, struct gradient_report *, struct err *);
static solver *const solvers[] = {gradient_solve, gradient_solve_direct, gradient_solve_multigrid};
enum { SOLVERS = sizeof solvers / sizeof *solvers };

static struct gradient_report solve(struct made *m, solver *s)
{
    struct gradient_report report;
    struct err err = ERR_INIT;
    if (s(&m->p, &report, &err)) fail_msg("%s", err.text);
    return report;
}

static void between_two_fixed_ends_lies_a_ramp(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(11, 1);
        fix(&m, 0, 2);
        fix(&m, 10, 7);
        const struct gradient_report report = solve(&m, solvers[k]);
        assert_int_equal(report.free, 9);
        assert_int_equal(report.undetermined, 0);
        for (size_t x = 0; x < 11; x++)
            for (size_t c = 0; c < 3; c++)
                assert_float_equal(m.p.value[3 * x + c], (2 + 0.5 * (double)x) * (double)(c + 1), 1e-5);
        release(&m);
    }
}

static void a_pixel_across_a_border_gets_both_gradients(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(3, 1); /* v1 - v0 = 1 of weight 1, v2 - v1 = 4 of weight 3 */
        fix(&m, 0, 0);
        fix(&m, 2, 6);
        for (size_t c = 0; c < 3; c++) {
            m.gradient_x[c] = 1;
            m.gradient_x[3 + c] = 4;
        }
        m.weight_x[1] = 3;
        solve(&m, solvers[k]); /* minimizes (v - 1)^2 + 3 (6 (c + 1) - v - 4)^2 */
        for (size_t c = 0; c < 3; c++)
            assert_float_equal(m.p.value[3 + c], (1 + 3 * (6 * (double)(c + 1) - 4)) / 4, 1e-5);
        release(&m);
    }
}

static void data_alone_give_a_constant(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(13, 9); /* one datum of weight 1e-5, gradients 0 of weight 1 */
        m.data_weight[50] = 1e-5F;
        for (size_t c = 0; c < 3; c++) m.data[150 + c] = (float)(c + 1);
        const struct gradient_report report = solve(&m, solvers[k]);
        assert_int_equal(report.undetermined, 0);
        for (size_t i = 0; i < 3 * 13 * 9; i++) assert_float_equal(m.p.value[i], (double)(i % 3 + 1), 1e-5);
        release(&m);
    }
}

static void without_a_constraint_a_texture_keeps_its_mean(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(10, 8); /* a ramp of slope 0.5 along x */
        for (size_t i = 0; i < 240; i++) {
            m.gradient_x[i] = 0.5F;
            m.p.value[i] = i % 2 ? 3 : 5;
        }
        const struct gradient_report report = solve(&m, solvers[k]);
        assert_int_equal(report.free, 80);
        assert_int_equal(report.undetermined, 80);
        for (size_t i = 0; i < 240; i++) assert_float_equal(m.p.value[i], 4 + 0.5 * ((double)(i / 3 % 10) - 4.5), 1e-4);
        release(&m);
    }
}

static void one_constraint_determines_a_texture(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(10, 8);
        for (size_t i = 0; i < 240; i++) m.gradient_y[i] = -0.25F;
        fix(&m, 0, 3);
        const struct gradient_report report = solve(&m, solvers[k]);
        assert_int_equal(report.free, 79);
        assert_int_equal(report.undetermined, 0);
        for (size_t i = 0; i < 240; i++)
            assert_float_equal(m.p.value[i], 3 * (double)(i % 3 + 1) - 0.25 * (double)(i / 30), 1e-4);
        release(&m);
    }
}

/* Two constant halves, data 0 and 1 of weight 1e-5, a border of weight 1e-5: constants a, b with
 * n a + h (a - b) = 0 and n (b - 1) + h (b - a) = 0 for n pixels a half and a border of h pixels. */
static void weights_of_1e_5_act_beside_weights_of_1(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        enum { W = 60, H = 40 };
        struct made m = make(W, H);
        for (size_t p = 0; p < W * H; p++) {
            m.data_weight[p] = 1e-5F;
            for (size_t c = 0; c < 3; c++) m.data[3 * p + c] = p % W >= W / 2;
            if (p % W == W / 2 - 1) m.weight_x[p] = 1e-5F;
        }
        solve(&m, solvers[k]);
        const double n = W / 2 * H, h = H, low = h / (n + 2 * h);
        for (size_t p = 0; p < W * H; p++) {
            const double expected = p % W < W / 2 ? low : 1 - low, from = p % W < W / 2 ? 0 : 1;
            assert_float_equal(m.p.value[3 * p], expected, 1e-4);
            assert_true(fabs((double)m.p.value[3 * p] - from) > 0.02); /* the border is felt */
        }
        release(&m);
    }
}

static void an_isolated_texel_takes_its_datum_or_stays(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(5, 5);
        memset(m.role, GRADIENT_OUT, 25);
        m.role[6] = m.role[18] = GRADIENT_FREE;
        m.p.value[3 * 6] = 7;
        m.data_weight[18] = 1e-5F;
        m.data[3 * 18 + 1] = 9;
        const struct gradient_report report = solve(&m, solvers[k]);
        assert_int_equal(report.free, 2);
        assert_int_equal(report.undetermined, 1);
        assert_true(m.p.value[3 * 6] == 7 && m.p.value[3 * 6 + 1] == 0);
        assert_float_equal(m.p.value[3 * 18 + 1], 9, 1e-5);
        release(&m);
    }
}

static void a_range_of_1e8_is_kept(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(101, 1);
        fix(&m, 0, 1);
        fix(&m, 100, 1e8F);
        solve(&m, solvers[k]);
        const double error = solvers[k] == gradient_solve_multigrid ? 1e-4 * 1e8 : 1e-7 * 1e8;
        for (size_t x = 0; x <= 100; x++) assert_float_equal(m.p.value[3 * x], 1 + (1e8 - 1) * (double)x / 100, error);
        release(&m);
    }
}

static void zeros_stay_exact_zeros(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(30, 20);
        fix(&m, 40, 0);
        for (size_t p = 0; p < 600; p++) {
            m.data_weight[p] = p % 3 ? 0 : 1e-5F;
            if (p % 7 == 0) m.weight_x[p] = 0;
        }
        const struct gradient_report report = solve(&m, solvers[k]);
        assert_true(report.residual == 0);
        for (size_t i = 0; i < 1800; i++) assert_true(m.p.value[i] == 0);
        release(&m);
    }
}

static void one_pixel_is_solved(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++)
        for (int role = GRADIENT_OUT; role <= GRADIENT_FIXED; role++) {
            struct made m = make(1, 1);
            m.role[0] = (uint8_t)role;
            m.p.value[0] = 2;
            m.data_weight[0] = 0.5F;
            m.data[0] = 6;
            const struct gradient_report report = solve(&m, solvers[k]);
            assert_int_equal(report.free, role == GRADIENT_FREE);
            assert_float_equal(m.p.value[0], role == GRADIENT_FREE ? 6 : 2, 1e-6);
            release(&m);
        }
}

static void a_strip_of_20000_by_16_is_solved(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        enum { W = 20000, H = 16 };
        struct made m = make(W, H);
        for (size_t y = 0; y < H; y++) {
            fix(&m, y * W, 0);
            fix(&m, y * W + W - 1, 1);
        }
        solve(&m, solvers[k]);
        for (size_t p = 0; p < W * H; p += 37) assert_float_equal(m.p.value[3 * p], (double)(p % W) / (W - 1), 1e-4);
        release(&m);
    }
}

static void what_is_not_finite_is_named_by_pixel(void **state)
{
    (void)state;
    static const char *const expected[] = {
        "pixel (2, 1) has the value nan; expected a finite number.",
        "pixel (2, 1) has the data weight -1; expected a finite number of at least 0.",
        "pixel (2, 1) has the datum inf; expected a finite number.",
        "pixel (2, 1) has the horizontal weight nan; expected a finite number of at least 0.",
        "pixel (2, 1) has the horizontal gradient inf; expected a finite number.",
        "pixel (2, 1) has the vertical weight inf; expected a finite number of at least 0.",
        "pixel (2, 1) has the vertical gradient nan; expected a finite number."};
    for (int k = 0; k < 7; k++) {
        struct made m = make(4, 3);
        struct gradient_report report;
        struct err err = ERR_INIT;
        enum { AT = 6 };
        m.data_weight[AT] = 1;
        m.p.value[0] = 8;
        if (k == 0) m.p.value[3 * AT] = NAN;
        if (k == 1) m.data_weight[AT] = -1;
        if (k == 2) m.data[3 * AT + 1] = INFINITY;
        if (k == 3) m.weight_x[AT] = NAN;
        if (k == 4) m.gradient_x[3 * AT + 2] = INFINITY;
        if (k == 5) m.weight_y[AT] = INFINITY;
        if (k == 6) m.gradient_y[3 * AT + 1] = NAN;
        assert_int_equal(gradient_solve(&m.p, &report, &err), ST_DATA);
        assert_string_equal(err.text, expected[k]);
        assert_true(m.p.value[0] == 8);
        release(&m);
    }
}

static void what_does_not_count_is_not_read(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made m = make(4, 1); /* out, fixed, fixed, free */
        m.role[0] = GRADIENT_OUT;
        fix(&m, 1, 1);
        fix(&m, 2, 2);
        m.p.value[0] = m.data_weight[0] = m.data_weight[1] = m.weight_x[0] = m.weight_x[1] = m.weight_x[3] = NAN;
        m.data[9] = NAN; /* of weight 0 */
        for (size_t i = 0; i < 4; i++) m.weight_y[i] = m.gradient_y[3 * i] = NAN;
        solve(&m, solvers[k]);
        assert_float_equal(m.p.value[9], 2, 1e-6);
        assert_true(isnan(m.p.value[0]));
        release(&m);
    }
}

/* Pixels of random roles, weights of 0, 1e-5 and 1, random gradients and data. */
static struct made make_random(int width, int height, uint64_t round)
{
    const struct rng rng = rng_make(round, "test", "gradient_solve");
    struct made m = make(width, height);
    const double fixed = round % 3 == 0 ? 0.3 : round % 3 == 1 ? 0.001 : 0, out = 0.1 * (double)(round % 5);
    const double weak = 0.15 * (double)(round % 4);
    for (size_t p = 0; p < (size_t)width * (size_t)height; p++) {
        const double role = rng_uniform(&rng, p, 0), x = rng_uniform(&rng, p, 1), y = rng_uniform(&rng, p, 2);
        m.role[p] = role < out ? GRADIENT_OUT : role < out + fixed ? GRADIENT_FIXED : GRADIENT_FREE;
        m.data_weight[p] = rng_uniform(&rng, p, 3) < 0.8 ? 1e-5F : 0;
        m.weight_x[p] = x < 0.02 ? 0 : x < 0.02 + weak ? 1e-5F : x < 0.9 ? 1 : 2;
        m.weight_y[p] = y < 0.02 ? 0 : y < 0.02 + weak ? 1e-5F : y < 0.9 ? 1 : 2;
        for (size_t c = 0; c < 3; c++) {
            m.data[3 * p + c] = (float)rng_uniform(&rng, p, 4 + c);
            m.p.value[3 * p + c] = (float)rng_uniform(&rng, p, 8 + c);
            m.gradient_x[3 * p + c] = (float)(0.2 * rng_uniform(&rng, p, 12 + c) - 0.1);
            m.gradient_y[3 * p + c] = (float)(0.2 * rng_uniform(&rng, p, 16 + c) - 0.1);
        }
    }
    return m;
}

static void multigrid_agrees_with_cholmod_on_random_masks(void **state)
{
    (void)state;
    static const int sizes[][2] = {{7, 5}, {1, 40}, {60, 47}, {200, 3}, {128, 128}};
    for (uint64_t round = 0; round < 60; round++) {
        const int *size = sizes[round % 5];
        struct made a = make_random(size[0], size[1], round), b = make_random(size[0], size[1], round);
        const struct gradient_report ours = solve(&a, gradient_solve_multigrid);
        const struct gradient_report direct = solve(&b, gradient_solve_direct);
        const size_t count = 3 * (size_t)size[0] * (size_t)size[1];
        double low = INFINITY, high = -INFINITY, error = 0;
        for (size_t i = 0; i < count; i++) {
            if (b.role[i / 3] == GRADIENT_OUT) continue;
            low = fmin(low, (double)b.p.value[i]);
            high = fmax(high, (double)b.p.value[i]);
            error = fmax(error, fabs((double)a.p.value[i] - (double)b.p.value[i]));
        }
        if (error > 1e-4 * (high - low)) fail_msg("round %d: error %g of %g", (int)round, error, high - low);
        assert_int_equal(ours.free, direct.free);
        assert_int_equal(ours.undetermined, direct.undetermined);
        assert_true(ours.iterations > 0 && direct.iterations == 0 && direct.residual < 1e-9);
        release(&a);
        release(&b);
    }
}

static void a_large_part_is_solved_by_multigrid(void **state)
{
    (void)state;
    struct made small = make_random(100, 100, 1), large = make_random(300, 300, 1);
    assert_int_equal(solve(&small, gradient_solve).iterations, 0);
    assert_true(solve(&large, gradient_solve).iterations > 0);
    release(&small);
    release(&large);
}

static void weights_too_small_for_multigrid_get_the_direct_solver(void **state)
{
    (void)state;
    enum { W = 240, H = 220 };
    struct made m = make(W, H);
    struct gradient_report report;
    struct err err = ERR_INIT;
    for (size_t p = 0; p < W * H; p++) {
        m.data_weight[p] = 1e-9F;
        for (size_t c = 0; c < 3; c++) m.data[3 * p + c] = 5;
    }
    assert_int_equal(gradient_solve_multigrid(&m.p, &report, &err), ST_INTERNAL);
    assert_true(m.p.value[0] == 0);
    assert_int_equal(solve(&m, gradient_solve).iterations, 0);
    for (size_t i = 0; i < 3 * W * H; i++) assert_float_equal(m.p.value[i], 5, 1e-5);
    release(&m);
}

static void any_number_of_threads_gives_the_same_bytes(void **state)
{
    (void)state;
    for (int k = 0; k < SOLVERS; k++) {
        struct made one = make_random(290, 280, 5), two = make_random(290, 280, 5);
        parallel_set_threads(1);
        solve(&one, solvers[k]);
        parallel_set_threads(2);
        solve(&two, solvers[k]);
        parallel_set_threads(0);
        assert_memory_equal(one.p.value, two.p.value, 3 * 290 * 280 * sizeof(float));
        release(&one);
        release(&two);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(between_two_fixed_ends_lies_a_ramp),
                                       cmocka_unit_test(a_pixel_across_a_border_gets_both_gradients),
                                       cmocka_unit_test(data_alone_give_a_constant),
                                       cmocka_unit_test(without_a_constraint_a_texture_keeps_its_mean),
                                       cmocka_unit_test(one_constraint_determines_a_texture),
                                       cmocka_unit_test(weights_of_1e_5_act_beside_weights_of_1),
                                       cmocka_unit_test(an_isolated_texel_takes_its_datum_or_stays),
                                       cmocka_unit_test(a_range_of_1e8_is_kept),
                                       cmocka_unit_test(zeros_stay_exact_zeros),
                                       cmocka_unit_test(one_pixel_is_solved),
                                       cmocka_unit_test(a_strip_of_20000_by_16_is_solved),
                                       cmocka_unit_test(what_is_not_finite_is_named_by_pixel),
                                       cmocka_unit_test(what_does_not_count_is_not_read),
                                       cmocka_unit_test(multigrid_agrees_with_cholmod_on_random_masks),
                                       cmocka_unit_test(a_large_part_is_solved_by_multigrid),
                                       cmocka_unit_test(weights_too_small_for_multigrid_get_the_direct_solver),
                                       cmocka_unit_test(any_number_of_threads_gives_the_same_bytes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
