/* recover.c - known response curves are recovered from exposures. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "stages/fit_response/recover.h"

enum { WIDTH = 480, HEIGHT = 320, EXPOSURES = 5 };

typedef double curve(double light, int colour); /* the sample of light, both in [0, 1] */

static double srgb(double light, int c) { return (void)c, (double)srgb_from_linear((float)light); }
static double gamma_18(double light, int c) { return (void)c, pow(light, 1 / 1.8); }
/* Film: a toe, a shoulder, a black level of 5 %, colours that differ. */
static double film(double light, int c)
{
    const double x = pow(light, 0.75 + 0.05 * c);
    return 0.05 + 0.95 * x * (1.25 + 0.25) / (1.25 * x + 0.25);
}

struct stack {
    struct photo photos[EXPOSURES];
    double exposures[EXPOSURES];
};

/* Uniform patches of 12 px, radiance over five decades. noise: in steps of 8 bits. */
static void shoot(struct stack *s, curve *f, double step, double noise)
{
    for (int k = 0; k < EXPOSURES; k++) {
        const struct rng rng = rng_make(5, "recover", "test");
        s->exposures[k] = 0.02 * pow(step, k);
        s->photos[k] = (struct photo){.info = {.width = WIDTH, .height = HEIGHT, .bits = 8}};
        s->photos[k].samples = malloc(sizeof(uint16_t) * 3 * WIDTH * HEIGHT);
        assert_non_null(s->photos[k].samples);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const uint32_t patch = (uint32_t)(i % WIDTH / 12 + 40 * (i / WIDTH / 12));
            const double light = pow(10, 5 * rng_uniform(&rng, 1u << 30, patch) - 3);
            for (int c = 0; c < 3; c++) {
                const double v = fmin(light * (1 - 0.15 * c) * s->exposures[k], 1);
                const double n = rng_uniform(&rng, (uint64_t)(3 * i + c), (uint32_t)k) - 0.5;
                s->photos[k].samples[3 * i + c] = (uint16_t)fmin(fmax(255 * f(v, c) + 2 * noise * n + 0.5, 0), 255);
            }
        }
    }
}

static void decide(struct response *r, char summary[RESPONSE_SUMMARY], const struct stack *s, const char *how)
{
    struct patches patches = {0};
    struct fit_params params = FIT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    strcpy(params.response, how);
    assert_ok(recover_add_patches(&patches, s->photos, s->exposures, EXPOSURES, params.max_patches, &err), err);
    assert_ok(recover_decide(r, summary, &patches, &params, &err), err);
    print_message("%s\n", summary);
    recover_release_patches(&patches);
}

/* The largest relative error of light for samples `from` to `to` of 255, after scaling both to agree at 128. */
static double worst_error(const struct response *r, curve *f, int from, int to)
{
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        double scale = 0, lights[256];
        for (int z = from; z <= to; z++) { /* the light of a sample, by bisection */
            double low = 0, high = 1;
            for (int i = 0; i < 60; i++) *(f((low + high) / 2, c) < z / 255.0 ? &low : &high) = (low + high) / 2;
            lights[z] = low;
        }
        scale = lights[128] / (double)response_light(r, c, 128.0f / 255);
        for (int z = from; z <= to; z++)
            worst = fmax(worst, fabs((double)response_light(r, c, (float)z / 255) * scale / lights[z] - 1));
    }
    return worst;
}

static void release(struct stack *s)
{
    for (int k = 0; k < EXPOSURES; k++) photo_release(&s->photos[k]);
}

static void srgb_photos_keep_the_srgb_curve(void **state)
{
    struct response r;
    struct stack s;
    char summary[RESPONSE_SUMMARY];
    (void)state;
    shoot(&s, srgb, 4, 1);
    decide(&r, summary, &s, "auto");
    assert_false(r.table);
    assert_contains(summary, "sRGB: exposure ratios vary by");
    s.exposures[3] *= 1.3; /* a wrong exposure does not change the curve */
    s.exposures[4] *= 1.3;
    decide(&r, summary, &s, "auto");
    assert_false(r.table);
    s.exposures[3] /= 1.3;
    s.exposures[4] /= 1.3;
    decide(&r, summary, &s, "recover");
    assert_true(r.table);
    const double worst = worst_error(&r, srgb, 20, 250);
    print_message("sRGB recovered: worst error %.4f\n", worst);
    assert_true(worst < 0.03);
    release(&s);
}

/* Up to 226, where the weights of the merge begin to fall. */
static void other_curves_are_recovered(void **state)
{
    static const struct {
        const char *name;
        curve *f;
        double step;
        int from;
        double max_error;
    } cases[] = {
        {"gamma 1.8", gamma_18, 4, 20, 0.03}, {"film", film, 2, 40, 0.05}, {"film, 2 stops", film, 4, 40, 0.05}};
    struct response r;
    char summary[RESPONSE_SUMMARY];
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        struct stack s;
        shoot(&s, cases[n].f, cases[n].step, 1);
        decide(&r, summary, &s, "auto");
        assert_true(r.table);
        assert_contains(summary, "recovered: ");
        const double worst = worst_error(&r, cases[n].f, cases[n].from, 226);
        print_message("%s: worst error %.4f\n", cases[n].name, worst);
        assert_true(worst < cases[n].max_error);
        for (int c = 0; c < 3; c++)
            for (int z = 1; z < RESPONSE_LEVELS; z++) assert_true(r.light[c][z] > r.light[c][z - 1]);
        decide(&r, summary, &s, "srgb");
        assert_false(r.table);
        release(&s);
    }
}

static void too_few_patches_are_reported(void **state)
{
    struct patches none = {0};
    struct response r;
    struct fit_params params = FIT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    char summary[RESPONSE_SUMMARY];
    (void)state;
    assert_ok(recover_decide(&r, summary, &none, &params, &err), err);
    assert_false(r.table);
    assert_contains(summary, "too few patches");
    strcpy(params.response, "recover");
    assert_int_equal(recover_decide(&r, summary, &none, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "too few patches are well exposed in two photos");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_photos_keep_the_srgb_curve),
        cmocka_unit_test(other_curves_are_recovered),
        cmocka_unit_test(too_few_patches_are_reported),
    };
    return cmocka_run_group_tests_name("recover", tests, NULL, NULL);
}
