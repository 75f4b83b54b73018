/* Quotients of light that are sure: noise goes, edges and large changes stay, small ones are left out. */
#include "stages/relight/quotients.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "tests/unit/common/light/near.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE };

/* A floor, a pixel a centimetre. */
struct floor {
    uint8_t kind[PIXELS];
    struct gather_point points[PIXELS];
    float quotient[PIXELS][4], error[PIXELS];
    struct pixels pixels;
};

static struct floor *make_floor(double quotient)
{
    struct floor *f = calloc(1, sizeof *f);
    assert_non_null(f);
    for (int i = 0; i < PIXELS; i++) {
        f->kind[i] = PIXEL_TEXTURE;
        f->points[i] = (struct gather_point){{0.01 * (i % SIDE), 0.01 * (i / SIDE), 0}, {0, 0, 1}};
        for (int k = 0; k < 4; k++) f->quotient[i][k] = k < 3 ? (float)quotient : RELIT_SURE;
    }
    f->pixels = (struct pixels){SIDE, SIDE, .kind = f->kind, .before = f->points, .after = f->points};
    return f;
}

static void settle(struct floor *f, int smooth)
{
    struct relight_params params = RELIGHT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    params.smooth = smooth;
    assert_ok(quotients_settle(f->quotient, f->error, &f->pixels, &params, &err), err);
}

/* A random number of mean 0 and variance 1. */
static double noise(int i)
{
    const struct rng rng = rng_make(7, "test", "noise");
    uint32_t bits[4];
    rng_block(&rng, 0, (uint64_t)i, bits);
    double sum = 0;
    for (int k = 0; k < 4; k++) sum += bits[k] * 0x1p-32 - 0.5;
    return sum * sqrt(3);
}

static void what_does_not_change_stays_exactly_one(void **state)
{
    struct floor *f = make_floor(1);
    (void)state;
    for (int i = 0; i < PIXELS / 2; i++)
        f->quotient[i][0] = f->quotient[i][1] = f->quotient[i][2] = 3, f->error[i] = 0.1f;
    settle(f, 3);
    for (int i = PIXELS / 2; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) assert_true(f->quotient[i][k] == 1);
    free(f);
}

/* exp(d d^4 / (d^4 + s^4)), in closed form; one of four times its error loses less than half a percent. */
static void a_change_fades_below_its_error(void **state)
{
    static const double changes[] = {0.001, 0.02, 0.05, 0.3, -0.05, -2};
    (void)state;
    for (size_t n = 0; n < sizeof changes / sizeof *changes; n++) {
        struct floor *f = make_floor(exp(changes[n]));
        for (int i = 0; i < PIXELS; i++) f->error[i] = 0.04f;
        settle(f, 0);
        const double d = changes[n], kept = d / (1 + pow(0.04 / d, 4));
        for (int i = 0; i < PIXELS; i++) assert_near((double)f->quotient[i][1], exp(kept), 1e-6);
        if (fabs(d) > 4 * 0.04) assert_near(kept, d, 0.005 * fabs(d));
        free(f);
    }
}

/* Noise of a third falls to a sixth or less; the edge of a patch of sun stays within a pixel. */
static void noise_is_smoothed_and_edges_stay(void **state)
{
    enum { EDGE = 20 };
    struct floor *f = make_floor(1);
    double before = 0, after = 0;
    (void)state;
    for (int i = 0; i < PIXELS; i++) {
        const double truth = i % SIDE < EDGE ? log(1.5) : log(6), d = truth + 0.03 * noise(i);
        for (int k = 0; k < 3; k++) f->quotient[i][k] = (float)exp(d);
        f->error[i] = 0.03f;
        before += (d - truth) * (d - truth);
    }
    settle(f, 3);
    for (int i = 0; i < PIXELS; i++) {
        const double truth = i % SIDE < EDGE ? log(1.5) : log(6), d = log((double)f->quotient[i][0]);
        assert_true(fabs(d - truth) < 0.06);
        after += (d - truth) * (d - truth);
    }
    assert_true(after < before / 16);
    free(f);
}

/* Another surface, and what was bounded or went dark, neither gives nor takes. */
static void other_surfaces_bounded_quotients_and_darkness_stay(void **state)
{
    struct floor *f = make_floor(2);
    (void)state;
    for (int i = 0; i < PIXELS; i++) f->error[i] = 0.5f;
    for (int i = 0; i < PIXELS; i += 5) {
        const int kind = i / 5 % 3;
        for (int k = 0; k < 3; k++) f->quotient[i][k] = kind == 0 ? 2.2f : kind == 1 ? 2.4f : 0;
        if (kind == 0) f->points[i].normal = vec3_make(1, 0, 0);
        if (kind == 1) f->quotient[i][3] = RELIT_BOUNDED;
    }
    settle(f, 3);
    for (int i = 0; i < PIXELS; i++) {
        const int kind = i % 5 ? -1 : i / 5 % 3;
        const double d = log(2), kept = d / (1 + pow(0.5 / d, 4));
        if (kind < 0) assert_near((double)f->quotient[i][2], exp(kept), 1e-5);
        if (kind == 1) assert_true(f->quotient[i][2] == 2.4f);
        if (kind == 2) assert_true(f->quotient[i][2] == 0);
    }
    free(f);
}

static void threads_do_not_change_a_bit(void **state)
{
    struct floor *f[2];
    (void)state;
    for (int n = 0; n < 2; n++) {
        f[n] = make_floor(1);
        for (int i = 0; i < PIXELS; i++) {
            for (int k = 0; k < 3; k++) f[n]->quotient[i][k] = (float)exp(0.1 + 0.1 * noise(3 * i + k));
            f[n]->error[i] = 0.1f;
        }
        parallel_set_threads(n ? 4 : 1);
        settle(f[n], 3);
    }
    parallel_set_threads(0);
    assert_memory_equal(f[0]->quotient, f[1]->quotient, sizeof f[0]->quotient);
    free(f[0]);
    free(f[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_does_not_change_stays_exactly_one),
        cmocka_unit_test(a_change_fades_below_its_error),
        cmocka_unit_test(noise_is_smoothed_and_edges_stay),
        cmocka_unit_test(other_surfaces_bounded_quotients_and_darkness_stay),
        cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
