/* bracket_noise.c - noise of a known sensor is measured, and the variance of the merge matches its error. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "stages/hdr_merge/merge.h"

enum { WIDTH = 640, HEIGHT = 200, PIXELS = WIDTH * HEIGHT, COUNT = 3 };

struct stack {
    struct photo photos[COUNT];
    double exposures[COUNT];
};

static double normal(const struct rng *rng, uint64_t i, uint32_t k)
{
    const double a = rng_uniform(rng, i, 2 * k), b = rng_uniform(rng, i, 2 * k + 1);
    return sqrt(-2 * log(1 - a)) * cos(2 * 3.14159265358979323846 * b);
}

static double ramp(int i, double min, double max) { return min * pow(max / min, (i % WIDTH) / (WIDTH - 1.0)); }

/* 16-bit samples, or values if linear: rounding is negligible. electrons: full well; reading: read noise in
 * electrons. */
static void shoot(struct stack *s, double electrons, double reading, double min, double max, bool linear)
{
    const struct rng rng = rng_make(11, "noise", "test");
    for (int k = 0; k < COUNT; k++) {
        s->exposures[k] = 0.25 * pow(4, k);
        s->photos[k] =
            (struct photo){.info = {.width = WIDTH, .height = HEIGHT, .bits = linear ? 32 : 16}, .saturation = 1};
        if (linear)
            s->photos[k].values = malloc(sizeof(float) * 3 * PIXELS);
        else
            s->photos[k].samples = malloc(sizeof(uint16_t) * 3 * PIXELS);
        assert_true(s->photos[k].values || s->photos[k].samples);
        for (int i = 0; i < 3 * PIXELS; i++) {
            const double v = ramp(i / 3, min, max) * s->exposures[k];
            const double seen =
                v + normal(&rng, (uint64_t)i, (uint32_t)k) * sqrt(v * electrons + reading * reading) / electrons;
            if (linear)
                s->photos[k].values[i] = (float)fmin(fmax(seen, 0), 1);
            else
                s->photos[k].samples[i] = (uint16_t)(65535 * srgb_from_linear((float)seen) + 0.5f);
        }
    }
}

static void release(struct stack *s)
{
    for (int k = 0; k < COUNT; k++) photo_release(&s->photos[k]);
}

static void sensor_noise_is_measured(void **state)
{
    static const struct {
        double electrons, reading;
    } sensors[] = {{30000, 6}, {5000, 20}, {1000, 30}};
    const struct response srgb = {0};
    (void)state;
    for (int n = 0; n < 3; n++)
        for (int linear = 0; linear < 2; linear++) {
            struct stack s;
            struct noise noise;
            bool measured = false;
            struct err err = ERR_INIT;
            shoot(&s, sensors[n].electrons, sensors[n].reading, 1e-3, 3, linear);
            const struct brackets b = {s.photos, s.exposures, COUNT, &srgb, NULL};
            assert_ok(noise_measure(&noise, &measured, &b, &err), err);
            assert_true(measured);
            const double read = sensors[n].reading / sensors[n].electrons;
            print_message("%g electrons, reading %g: found %.0f, %.2f\n", sensors[n].electrons, sensors[n].reading,
                          1 / noise.photon, sqrt(noise.read2) * sensors[n].electrons);
            assert_float_equal(noise.photon * sensors[n].electrons, 1, 0.1);
            if (read > 1e-3) assert_float_equal(sqrt(noise.read2) / read, 1, 0.15);
            assert_float_equal(noise.luminance, 1, 0.06);
            release(&s);
        }
}

/* Where all colours have the same noise, the luminance's deviation is the sum of theirs, by their weights; where they
 * are independent, the root of the sum of squares. */
static void noise_that_colours_share_is_measured(void **state)
{
    const double squares = 0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722;
    const struct response srgb = {0};
    struct stack s;
    struct noise noise;
    bool measured = false;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&s, 5000, 20, 1e-3, 3, true);
    for (int k = 0; k < COUNT; k++)
        for (int i = 0; i < 3 * PIXELS; i++) s.photos[k].values[i] = s.photos[k].values[i - i % 3];
    const struct brackets b = {s.photos, s.exposures, COUNT, &srgb, NULL};
    assert_ok(noise_measure(&noise, &measured, &b, &err), err);
    assert_true(measured);
    assert_float_equal(noise.luminance * squares, 1, 0.06);
    release(&s);
}

/* The mean of squared error over stated variance is 1 at each level. */
static void merged_variance_matches_the_error(void **state)
{
    enum { LEVELS = 8 };
    const struct response srgb = {0};
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct noise noise[COUNT];
    struct merged m = {0};
    struct stack s;
    struct err err = ERR_INIT;
    double sums[LEVELS] = {0};
    int counts[LEVELS] = {0};
    (void)state;
    params.electrons = 5000;
    params.read_noise = 20;
    params.dark = 0; /* dark samples count too: a cut would distort the noise */
    shoot(&s, 5000, 20, 5e-3, 2.5, true);
    for (int k = 0; k < COUNT; k++) noise[k] = noise_given(params.electrons, params.read_noise, &srgb, 32);
    const struct brackets b = {s.photos, s.exposures, COUNT, &srgb, NULL};
    assert_ok(merge_brackets(&m, &b, noise, &params, &err), err);
    for (int i = 0; i < PIXELS; i++) {
        const float *rgb = m.radiance.data + 3 * i;
        const double truth = ramp(i, 5e-3, 2.5), y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        const int level = i % WIDTH * LEVELS / WIDTH;
        sums[level] += (y / truth - 1) * (y / truth - 1) / (double)m.variance[i];
        counts[level]++;
    }
    for (int l = 0; l < LEVELS; l++) {
        print_message("level %d: errors^2 over variance %.3f\n", l, sums[l] / counts[l]);
        assert_float_equal(sums[l] / counts[l], 1, 0.15);
    }
    merge_release(&m);
    release(&s);
}

static void too_few_samples_give_no_measurement(void **state)
{
    const struct response srgb = {0};
    struct stack s;
    struct noise noise;
    bool measured = true;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&s, 5000, 20, 100, 200, true); /* all saturate */
    const struct brackets b = {s.photos, s.exposures, COUNT, &srgb, NULL},
                          one = {s.photos, s.exposures, 1, &srgb, NULL};
    assert_ok(noise_measure(&noise, &measured, &b, &err), err);
    assert_false(measured);
    assert_ok(noise_measure(&noise, &measured, &one, &err), err);
    assert_false(measured);
    release(&s);
}

/* 1e6:1 in eight bits and seven exposures: both ends are kept, and nothing is NaN, negative or clipped. */
static void noise_is_measured_over_six_decades(void **state)
{
    enum { SHOTS = 7 };
    const struct response srgb = {0};
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct rng rng = rng_make(2, "decades", "test");
    struct photo photos[SHOTS];
    double exposures[SHOTS], worst = 0;
    struct noise noise[SHOTS], measured;
    bool known = false;
    struct merged m = {0};
    struct err err = ERR_INIT;
    (void)state;
    for (int k = 0; k < SHOTS; k++) {
        exposures[k] = 1e-3 * pow(8, k) / 1.2;
        photos[k] = (struct photo){.info = {.width = WIDTH, .height = HEIGHT, .bits = 8}};
        photos[k].samples = malloc(sizeof(uint16_t) * 3 * PIXELS);
        assert_non_null(photos[k].samples);
        for (int i = 0; i < 3 * PIXELS; i++) {
            const double v = ramp(i / 3, 1e-3, 1e3) * exposures[k];
            const double seen = v + normal(&rng, (uint64_t)i, (uint32_t)k) * sqrt(v * 30000 + 36) / 30000;
            photos[k].samples[i] = (uint16_t)(255 * srgb_from_linear((float)seen) + 0.5f);
        }
    }
    const struct brackets b = {photos, exposures, SHOTS, &srgb, NULL};
    assert_ok(noise_measure(&measured, &known, &b, &err), err);
    assert_true(known);
    for (int k = 0; k < SHOTS; k++) noise[k] = measured;
    assert_ok(merge_brackets(&m, &b, noise, &params, &err), err);
    double sums[WIDTH] = {0};
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(m.marks[i], 0);
        for (int c = 0; c < 3; c++) {
            const float v = m.radiance.data[3 * i + c];
            assert_true(isfinite(v) && v > 0);
            sums[i % WIDTH] += (double)v / (3 * HEIGHT);
        }
    }
    for (int x = 0; x < WIDTH; x++) worst = fmax(worst, fabs(sums[x] / ramp(x, 1e-3, 1e3) - 1));
    print_message("1e6:1: the mean of a column is off by at most %.4f\n", worst);
    assert_true(worst < 0.02);
    merge_release(&m);
    for (int k = 0; k < SHOTS; k++) photo_release(&photos[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sensor_noise_is_measured),           cmocka_unit_test(noise_that_colours_share_is_measured),
        cmocka_unit_test(merged_variance_matches_the_error),  cmocka_unit_test(too_few_samples_give_no_measurement),
        cmocka_unit_test(noise_is_measured_over_six_decades),
    };
    return cmocka_run_group_tests_name("noise", tests, NULL, NULL);
}
