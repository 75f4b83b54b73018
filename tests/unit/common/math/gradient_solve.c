/* gradient_solve.c - gradient problems against closed forms. */
#include "common/math/gradient_solve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
static solver *const solvers[] = {gradient_solve, gradient_solve_direct};
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(between_two_fixed_ends_lies_a_ramp),
                                       cmocka_unit_test(a_pixel_across_a_border_gets_both_gradients)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
