/* merge.c - brackets of known radiance, made as a camera makes them, must give that radiance back.
 *
 * The camera here: value = sRGB(clip(radiance x exposure + noise)), rounded to 8 bits. Rounding alone is an error of half
 * a step: 1.6 % of the value at code 70, a sixteenth of white's light, which is the least of the best exposed samples on
 * the ramp. There a sensor of 50000 electrons has noise of 1.8 % (one sigma), of 5000 electrons 5.8 %; the largest of
 * some 10 000 such samples is 4 to 5 sigma away.
 */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/exr.h"
#include "common/parallel.h"
#include "common/rng.h"
#include "stages/hdr_merge/merge.h"

enum { WIDTH = 512, HEIGHT = 24, PIXELS = WIDTH * HEIGHT };

struct brackets {
    struct photo photos[MERGE_MOST];
    double exposures[MERGE_MOST];
    int count;
};

/* Radiance of a pixel: from `least` at the left to `most` at the right, geometrically; the three colours differ. */
static double ramp(int i, int c, double least, double most)
{
    double tint[3] = {1, 0.8, 0.6};
    return least * pow(most / least, (i % WIDTH) / (WIDTH - 1.0)) * tint[c];
}

/* electrons: the full well, 0 for no noise. */
static void shoot(struct brackets *b, int count, double shortest, double step, double least, double most,
                  double electrons)
{
    *b = (struct brackets){.count = count};
    for (int k = 0; k < count; k++) {
        struct rng rng = rng_make(7, "merge", "test");
        b->exposures[k] = shortest * pow(step, k);
        b->photos[k].info = (struct photo_info){.width = WIDTH, .height = HEIGHT, .bits = 8};
        b->photos[k].samples = malloc(sizeof(uint16_t) * 3 * PIXELS);
        assert_non_null(b->photos[k].samples);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) {
                double v = ramp(i, c, least, most) * b->exposures[k];
                if (electrons > 0) { /* photons, and reading: 5 electrons */
                    double n = 0;
                    for (uint32_t j = 0; j < 12; j++)
                        n += rng_uniform(&rng, (uint64_t)(3 * i + c) * 16 + j, (uint32_t)k) - 0.5;
                    v += n * sqrt(v * electrons + 25) / electrons;
                }
                b->photos[k].samples[3 * i + c] = (uint16_t)(255 * srgb_from_linear((float)v) + 0.5f);
            }
    }
}

static void release(struct brackets *b)
{
    for (int k = 0; k < b->count; k++) photo_release(&b->photos[k]);
}

static struct image merge(const struct brackets *b, uint8_t *marks)
{
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct image out;
    struct err err = ERR_INIT;
    assert_ok(merge_brackets(&out, marks, b->photos, b->exposures, b->count, &params, &err), err);
    for (int i = 0; i < 3 * PIXELS; i++)
        if (!(out.data[i] >= 0 && isfinite(out.data[i]))) fail_msg("sample %d is %g", i, (double)out.data[i]);
    return out;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *values, size_t count, double q)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return values[(size_t)(q * (double)(count - 1))];
}

/* Nine brackets two stops apart cover 1e5:1 with two well exposed samples or more. */
static void a_ramp_of_1e5_comes_back(void **state)
{
    const double noise[] = {0, 50000, 5000}, most_error[] = {0.02, 0.1, 0.3}, most_median[] = {0.004, 0.008, 0.02},
                 most_bias[] = {0.001, 0.001, 0.003};
    static uint8_t marks[PIXELS];
    static double errors[3 * PIXELS];
    (void)state;
    for (int n = 0; n < 3; n++) {
        struct brackets b;
        shoot(&b, 9, 1.0 / 16384, 4, 1e-2, 1e3, noise[n]);
        struct image out = merge(&b, marks);
        double bias = 0;
        for (int i = 0; i < PIXELS; i++) {
            assert_int_equal(marks[i], 0);
            for (int c = 0; c < 3; c++) {
                double truth = ramp(i, c, 1e-2, 1e3), e = out.data[3 * i + c] / truth - 1;
                errors[3 * i + c] = fabs(e);
                bias += e / (3 * PIXELS);
            }
        }
        double median = quantile(errors, 3 * PIXELS, 0.5), worst = errors[3 * PIXELS - 1];
        print_message("noise of %g electrons: median error %.4f, largest %.4f, bias %.5f\n", noise[n], median, worst,
                      bias);
        assert_true(median < most_median[n] && worst < most_error[n] && fabs(bias) < most_bias[n]);
        image_release(&out);
        release(&b);
    }
}

/* A ramp from below what the longest exposure can tell to above what the shortest can. */
static void what_no_exposure_tells_is_bounded_and_marked(void **state)
{
    static uint8_t marks[PIXELS];
    struct brackets b;
    (void)state;
    shoot(&b, 3, 0.25, 4, 1e-7, 1e3, 0);
    struct image out = merge(&b, marks);
    for (int x = 0; x < WIDTH; x++) {
        double truth[3];
        const float *rgb = image_at(&out, x, 5);
        for (int c = 0; c < 3; c++) truth[c] = ramp(x, c, 1e-7, 1e3);
        int mark = marks[5 * WIDTH + x];
        if (truth[2] > 4) { /* all colours saturate in the shortest: radiance 1 / 0.25 is what it shows */
            assert_int_equal(mark, MERGE_BRIGHT);
            for (int c = 0; c < 3; c++) assert_float_equal(rgb[c], 4, 1e-6);
        }
        if (truth[0] < 2e-5) { /* code 0 of 255 in the longest */
            assert_int_equal(mark, MERGE_DARK);
            for (int c = 0; c < 3; c++) assert_true(rgb[c] == 0);
        }
        if (truth[0] < 3.7 && truth[2] > 1e-3) {
            assert_int_equal(mark, 0);
            for (int c = 0; c < 3; c++) assert_true(fabs(rgb[c] / truth[c] - 1) < 0.08);
        }
    }
    image_release(&out);
    release(&b);
}

/* Between an exposure and one through a strong filter there is radiance that one cuts and the other does not see. */
static void a_gap_between_exposures_is_bounded_from_below(void **state)
{
    static uint8_t marks[PIXELS];
    struct brackets b;
    (void)state;
    shoot(&b, 2, 1e-5, 1e5, 1.2, 2, 0);
    struct image out = merge(&b, marks);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            if (ramp(i, c, 1.2, 2) > 1) {
                assert_true((marks[i] & MERGE_DARK) != 0);
                assert_float_equal(out.data[3 * i + c], 1, 1e-6);
            }
    image_release(&out);
    release(&b);
}

/* A red lamp: its red saturates everywhere, green and blue are well exposed in the long exposures. */
static void a_saturated_colour_does_not_spoil_the_others(void **state)
{
    static uint8_t marks[PIXELS];
    struct brackets b;
    (void)state;
    shoot(&b, 3, 0.25, 4, 0.05, 0.06, 0);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < PIXELS; i++) b.photos[k].samples[3 * i] = 255;
    struct image out = merge(&b, marks);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(marks[i], MERGE_BRIGHT);
        assert_float_equal(out.data[3 * i], 4, 1e-6);
        for (int c = 1; c < 3; c++) assert_true(fabs(out.data[3 * i + c] / ramp(i, c, 0.05, 0.06) - 1) < 0.02);
    }
    image_release(&out);
    release(&b);
}

static void one_exposure_is_the_photo_in_linear_light(void **state)
{
    static uint8_t marks[PIXELS];
    struct brackets b;
    struct image linear;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&b, 1, 1, 2, 1e-6, 30, 0);
    struct image out = merge(&b, marks);
    assert_ok(photo_to_linear(&linear, &b.photos[0], &err), err);
    for (int i = 0; i < 3 * PIXELS; i++) assert_true(fabsf(out.data[i] - linear.data[i]) <= 2e-7f * linear.data[i]);
    assert_int_equal(marks[0], MERGE_DARK);
    assert_int_equal(marks[WIDTH - 1], MERGE_BRIGHT);
    image_release(&linear);
    image_release(&out);
    release(&b);
}

/* 16-bit photos beside 8-bit ones, and no light at all. */
static void depths_may_differ_and_black_is_black(void **state)
{
    static uint8_t marks[PIXELS];
    struct brackets b;
    (void)state;
    shoot(&b, 2, 0.5, 2, 0.01, 0.4, 0);
    b.photos[1].info.bits = 16;
    for (int i = 0; i < 3 * PIXELS; i++) b.photos[1].samples[i] = (uint16_t)(b.photos[1].samples[i] * 257);
    struct image out = merge(&b, marks);
    for (int i = 0; i < 3 * PIXELS; i++) assert_true(fabs(out.data[i] / ramp(i / 3, i % 3, 0.01, 0.4) - 1) < 0.05);
    image_release(&out);
    for (int k = 0; k < 2; k++) memset(b.photos[k].samples, 0, sizeof(uint16_t) * 3 * PIXELS);
    out = merge(&b, marks);
    for (int i = 0; i < 3 * PIXELS; i++) assert_true(out.data[i] == 0);
    assert_int_equal(marks[0], MERGE_DARK);
    image_release(&out);
    release(&b);
}

static void threads_do_not_matter(void **state)
{
    static uint8_t marks[2][PIXELS];
    struct brackets b;
    struct image out[2];
    (void)state;
    shoot(&b, 5, 0.1, 3, 1e-4, 50, 2000);
    for (int i = 0; i < 2; i++) {
        parallel_set_threads(i + 1);
        out[i] = merge(&b, marks[i]);
    }
    parallel_set_threads(0);
    assert_memory_equal(out[0].data, out[1].data, 3 * PIXELS * sizeof(float));
    assert_memory_equal(marks[0], marks[1], PIXELS);
    for (int i = 0; i < 2; i++) image_release(&out[i]);
    release(&b);
}

static void exposures_that_do_not_agree_are_seen(void **state)
{
    struct brackets b;
    struct exposure_agreement worst;
    (void)state;
    shoot(&b, 4, 0.25, 4, 1e-3, 3, 0);
    merge_agreement(&worst, b.photos, b.exposures, 4);
    assert_true(worst.pair > 0 && fabs(worst.seen / worst.stated - 1) < 0.01);
    b.exposures[2] *= 2; /* and the next: 8 times the one before is stated */
    b.exposures[3] *= 2;
    merge_agreement(&worst, b.photos, b.exposures, 4);
    assert_int_equal(worst.pair, 2);
    assert_true(fabs(worst.stated - 8) < 1e-9 && fabs(worst.seen - 4) < 0.05);
    merge_agreement(&worst, b.photos, b.exposures, 1);
    assert_int_equal(worst.pair, 0);
    release(&b);
    shoot(&b, 2, 0.01, 1000, 0.1, 0.5, 0); /* nothing is well exposed in both */
    merge_agreement(&worst, b.photos, b.exposures, 2);
    assert_int_equal(worst.pair, 0);
    release(&b);
}

static void bad_input_is_refused(void **state)
{
    struct brackets b;
    struct image out;
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&b, 2, 0.5, 2, 0.01, 0.4, 0);
    b.photos[1].info.width = WIDTH / 2;
    assert_int_equal(merge_brackets(&out, NULL, b.photos, b.exposures, 2, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "exposure 2 has 256 x 24 pixels, but the first one 512 x 24");
    assert_null(out.data);
    err = (struct err)ERR_INIT;
    assert_int_equal(merge_brackets(&out, NULL, b.photos, b.exposures, 0, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "0 exposures");
    err = (struct err)ERR_INIT;
    b.photos[1].info.width = WIDTH;
    b.exposures[1] = 1e30;
    assert_int_equal(merge_brackets(&out, NULL, b.photos, b.exposures, 2, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "exposure 2 is 1e+30 times that of white");
    release(&b);
}

/* Photos of a flat that exists only in a renderer: radiance is known but for one factor. */
static void rendered_brackets_give_the_true_radiance(void **state)
{
    static const char *const views[] = {"v00", "v05", "v15", "v24"};
    const char *folder = "../shared/data/apartment";
    const double seconds[] = {1.0 / 500, 1.0 / 125, 1.0 / 30};
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    (void)state;
    if (access(folder, R_OK)) {
        print_message("%s is not there\n", folder);
        skip();
    }
    for (int n = 0; n < 4; n++) {
        char path[256];
        const char *const names[] = {"R", "G", "B"};
        struct brackets b = {.count = 3};
        struct exr_image truth;
        struct image out;
        struct err err = ERR_INIT;
        for (int k = 0; k < 3; k++) {
            snprintf(path, sizeof path, "%s/photos/%s_e%d.jpg", folder, views[n], k);
            assert_ok(photo_read(&b.photos[k], path, &err), err);
            b.exposures[k] = 120 * seconds[k];
        }
        snprintf(path, sizeof path, "%s/truth/hdr/%s.exr", folder, views[n]);
        assert_ok(exr_read(&truth, path, names, 3, &err), err);
        size_t pixels = (size_t)truth.width * (size_t)truth.height, count = 0;
        uint8_t *marks = malloc(pixels);
        double *errors = malloc(3 * pixels * sizeof *errors), bias = 0;
        assert_non_null(marks);
        assert_non_null(errors);
        assert_ok(merge_brackets(&out, marks, b.photos, b.exposures, 3, &params, &err), err);
        for (size_t i = 0; i < pixels; i++)
            for (int c = 0; c < 3; c++) {
                double x = exr_find(&truth, names[c])->f[i];
                if (marks[i] || !(x > 0)) continue;
                double e = out.data[3 * i + (size_t)c] / x - 1;
                bias += e;
                errors[count++] = fabs(e);
            }
        double median = quantile(errors, count, 0.5), most = errors[(size_t)(0.9 * (double)count)];
        print_message("%s: median error %.4f, of 90 %% below %.4f, bias %.4f, of %.2f %% of the samples\n", views[n],
                      median, most, bias / (double)count, 100.0 * (double)count / (double)(3 * pixels));
        assert_true(median < 0.02);
        assert_true((double)count > 0.97 * 3 * (double)pixels);
        free(marks);
        free(errors);
        image_release(&out);
        exr_image_release(&truth);
        release(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ramp_of_1e5_comes_back),
        cmocka_unit_test(what_no_exposure_tells_is_bounded_and_marked),
        cmocka_unit_test(a_gap_between_exposures_is_bounded_from_below),
        cmocka_unit_test(a_saturated_colour_does_not_spoil_the_others),
        cmocka_unit_test(one_exposure_is_the_photo_in_linear_light),
        cmocka_unit_test(depths_may_differ_and_black_is_black),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(exposures_that_do_not_agree_are_seen),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(rendered_brackets_give_the_true_radiance),
    };
    return cmocka_run_group_tests_name("merge", tests, NULL, NULL);
}
