/* merge.c - simulated brackets of known radiance merge to that radiance.
 *
 * The simulated camera: value = sRGB(clip(radiance x exposure + noise)), rounded to 8 bits. Rounding alone is an error
 * of half a step: 1.6 % of the value at code 70, a sixteenth of white, the darkest of the best exposed samples on the
 * ramp. There a sensor of 50000 electrons has noise of 1.8 % (one sigma), one of 5000 electrons 5.8 %; the largest
 * error of some 10 000 samples is 4 to 5 sigma. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/sort.h"
#include "common/image/exr.h"
#include "stages/hdr_merge/merge.h"

enum { WIDTH = 512, HEIGHT = 24, PIXELS = WIDTH * HEIGHT };

struct shot {
    struct photo photos[MERGE_MAX_EXPOSURES];
    double exposures[MERGE_MAX_EXPOSURES];
    int count;
};

/* Radiance of a pixel: a geometric ramp from `min` at the left to `max` at the right; the three colours differ. */
static double ramp(int i, int c, double min, double max)
{
    double tint[3] = {1, 0.8, 0.6};
    return min * pow(max / min, (i % WIDTH) / (WIDTH - 1.0)) * tint[c];
}

/* electrons: the full well, 0 for no noise. */
static void shoot(struct shot *b, int count, double shortest, double step, double min, double max, double electrons)
{
    *b = (struct shot){.count = count};
    for (int k = 0; k < count; k++) {
        struct rng rng = rng_make(7, "merge", "test");
        b->exposures[k] = shortest * pow(step, k);
        b->photos[k].info = (struct photo_info){.width = WIDTH, .height = HEIGHT, .bits = 8};
        b->photos[k].samples = malloc(sizeof(uint16_t) * 3 * PIXELS);
        assert_non_null(b->photos[k].samples);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) {
                double v = ramp(i, c, min, max) * b->exposures[k];
                if (electrons > 0) { /* photon noise, and read noise of 5 electrons */
                    double n = 0;
                    for (uint32_t j = 0; j < 12; j++)
                        n += rng_uniform(&rng, (uint64_t)(3 * i + c) * 16 + j, (uint32_t)k) - 0.5;
                    v += n * sqrt(v * electrons + 25) / electrons;
                }
                b->photos[k].samples[3 * i + c] = (uint16_t)(255 * srgb_from_linear((float)v) + 0.5f);
            }
    }
}

static void release(struct shot *b)
{
    for (int k = 0; k < b->count; k++) photo_release(&b->photos[k]);
}

static const struct response srgb;

static enum status try_merge(struct merged *m, const struct shot *b, const struct shift *shifts, struct err *err)
{
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct noise noise[MERGE_MAX_EXPOSURES];
    struct brackets brackets = {b->photos, b->exposures, b->count, &srgb, shifts};
    for (int k = 0; k < b->count; k++)
        noise[k] = noise_given(params.electrons, params.read_noise, &srgb, b->photos[k].info.bits);
    return merge_brackets(m, &brackets, noise, &params, err);
}

static struct merged merge(const struct shot *b)
{
    struct merged m = {0};
    struct err err = ERR_INIT;
    assert_ok(try_merge(&m, b, NULL, &err), err);
    const int pixels = m.radiance.width * m.radiance.height;
    for (int i = 0; i < 3 * pixels; i++)
        if (!(m.radiance.data[i] >= 0 && isfinite(m.radiance.data[i])))
            fail_msg("sample %d is %g", i, (double)m.radiance.data[i]);
    for (int i = 0; i < pixels; i++) assert_true(m.variance[i] > 0 && m.variance[i] <= 1);
    return m;
}

static double quantile(double *values, size_t count, double q)
{
    sort_doubles(values, count);
    return values[(size_t)(q * (double)(count - 1))];
}

/* Nine exposures two stops apart cover 1e5:1 with at least two well exposed samples. */
static void a_ramp_of_1e5_is_recovered(void **state)
{
    const double noise[] = {0, 50000, 5000}, max_error[] = {0.02, 0.1, 0.3}, max_median[] = {0.004, 0.008, 0.02},
                 max_bias[] = {0.001, 0.001, 0.003};
    static double errors[3 * PIXELS];
    (void)state;
    for (int n = 0; n < 3; n++) {
        struct shot b;
        shoot(&b, 9, 1.0 / 16384, 4, 1e-2, 1e3, noise[n]);
        struct merged out = merge(&b);
        double bias = 0;
        for (int i = 0; i < PIXELS; i++) {
            assert_int_equal(out.marks[i], 0);
            for (int c = 0; c < 3; c++) {
                double truth = ramp(i, c, 1e-2, 1e3), e = out.radiance.data[3 * i + c] / truth - 1;
                errors[3 * i + c] = fabs(e);
                bias += e / (3 * PIXELS);
            }
        }
        double median = quantile(errors, 3 * PIXELS, 0.5), worst = errors[3 * PIXELS - 1];
        print_message("noise of %g electrons: median error %.4f, largest %.4f, bias %.5f\n", noise[n], median, worst,
                      bias);
        assert_true(median < max_median[n] && worst < max_error[n] && fabs(bias) < max_bias[n]);
        merge_release(&out);
        release(&b);
    }
}

/* A ramp from below the range of the longest exposure to above that of the shortest. */
static void saturated_and_dark_pixels_are_bounded_and_marked(void **state)
{
    struct shot b;
    (void)state;
    shoot(&b, 3, 0.25, 4, 1e-7, 1e3, 0);
    struct merged out = merge(&b);
    for (int x = 0; x < WIDTH; x++) {
        double truth[3];
        const float *rgb = image_at(&out.radiance, x, 5);
        for (int c = 0; c < 3; c++) truth[c] = ramp(x, c, 1e-7, 1e3);
        int mark = out.marks[5 * WIDTH + x];
        if (truth[2] > 4) { /* all colours saturate in the shortest exposure, at radiance 1 / 0.25 */
            assert_int_equal(mark, PHOTO_BRIGHT);
            for (int c = 0; c < 3; c++) assert_float_equal(rgb[c], 4, 1e-6);
        }
        if (truth[0] < 2e-5) { /* code 0 of 255 in the longest */
            assert_int_equal(mark, PHOTO_DARK);
            for (int c = 0; c < 3; c++) assert_true(rgb[c] == 0);
        }
        if (truth[0] < 3.7 && truth[2] > 1e-3) {
            assert_int_equal(mark, 0);
            for (int c = 0; c < 3; c++) assert_true(fabs(rgb[c] / truth[c] - 1) < 0.08);
        }
    }
    merge_release(&out);
    release(&b);
}

/* Radiance between the ranges of two exposures: one clips it, for the other (through a strong filter) it is too
 * dark. */
static void a_gap_between_exposures_is_bounded_from_below(void **state)
{
    struct shot b;
    (void)state;
    shoot(&b, 2, 1e-5, 1e5, 1.2, 2, 0);
    struct merged out = merge(&b);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            if (ramp(i, c, 1.2, 2) > 1) {
                assert_true((out.marks[i] & PHOTO_DARK) != 0);
                assert_float_equal(out.radiance.data[3 * i + c], 1, 1e-6);
            }
    merge_release(&out);
    release(&b);
}

/* A red lamp: its red saturates everywhere, green and blue are well exposed in the long exposures. */
static void a_saturated_colour_does_not_spoil_the_others(void **state)
{
    struct shot b;
    (void)state;
    shoot(&b, 3, 0.25, 4, 0.05, 0.06, 0);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < PIXELS; i++) b.photos[k].samples[3 * i] = 255;
    struct merged out = merge(&b);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(out.marks[i], PHOTO_BRIGHT);
        assert_float_equal(out.radiance.data[3 * i], 4, 1e-6);
        for (int c = 1; c < 3; c++) assert_true(fabs(out.radiance.data[3 * i + c] / ramp(i, c, 0.05, 0.06) - 1) < 0.02);
    }
    merge_release(&out);
    release(&b);
}

static void a_single_exposure_is_the_linear_photo(void **state)
{
    struct shot b;
    struct image linear;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&b, 1, 1, 2, 1e-6, 30, 0);
    struct merged out = merge(&b);
    assert_ok(photo_to_linear(&linear, &b.photos[0], &err), err);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(fabsf(out.radiance.data[i] - linear.data[i]) <= 2e-7f * linear.data[i]);
    assert_int_equal(out.marks[0], PHOTO_DARK);
    assert_int_equal(out.marks[WIDTH - 1], PHOTO_BRIGHT);
    image_release(&linear);
    merge_release(&out);
    release(&b);
}

/* 16-bit photos with 8-bit ones, and black. */
static void bit_depths_may_differ_and_black_stays_black(void **state)
{
    struct shot b;
    (void)state;
    shoot(&b, 2, 0.5, 2, 0.01, 0.4, 0);
    b.photos[1].info.bits = 16;
    for (int i = 0; i < 3 * PIXELS; i++) b.photos[1].samples[i] = (uint16_t)(b.photos[1].samples[i] * 257);
    struct merged out = merge(&b);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(fabs(out.radiance.data[i] / ramp(i / 3, i % 3, 0.01, 0.4) - 1) < 0.05);
    merge_release(&out);
    for (int k = 0; k < 2; k++) memset(b.photos[k].samples, 0, sizeof(uint16_t) * 3 * PIXELS);
    out = merge(&b);
    for (int i = 0; i < 3 * PIXELS; i++) assert_true(out.radiance.data[i] == 0);
    assert_int_equal(out.marks[0], PHOTO_DARK);
    merge_release(&out);
    release(&b);
}

static void the_result_does_not_depend_on_threads(void **state)
{
    struct shot b;
    struct merged out[2];
    (void)state;
    shoot(&b, 5, 0.1, 3, 1e-4, 50, 2000);
    for (int i = 0; i < 2; i++) {
        parallel_set_threads(i + 1);
        out[i] = merge(&b);
    }
    parallel_set_threads(0);
    assert_memory_equal(out[0].radiance.data, out[1].radiance.data, 3 * PIXELS * sizeof(float));
    assert_memory_equal(out[0].marks, out[1].marks, PIXELS);
    assert_memory_equal(out[0].variance, out[1].variance, PIXELS * sizeof(float));
    for (int i = 0; i < 2; i++) merge_release(&out[i]);
    release(&b);
}

static void agreement(struct exposure_agreement *worst, const struct shot *b, int count)
{
    struct brackets brackets = {b->photos, b->exposures, count, &srgb, NULL};
    struct err err = ERR_INIT;
    assert_ok(merge_agreement(worst, &brackets, &err), err);
}

static void disagreeing_exposures_are_found(void **state)
{
    struct shot b;
    struct exposure_agreement worst;
    (void)state;
    shoot(&b, 4, 0.25, 4, 1e-3, 3, 0);
    agreement(&worst, &b, 4);
    assert_true(worst.pair > 0 && fabs(worst.measured / worst.stated - 1) < 0.01);
    b.exposures[2] *= 2; /* now 8 times the one before is stated */
    b.exposures[3] *= 2;
    agreement(&worst, &b, 4);
    assert_int_equal(worst.pair, 2);
    assert_true(fabs(worst.stated - 8) < 1e-9 && fabs(worst.measured - 4) < 0.05);
    agreement(&worst, &b, 1);
    assert_int_equal(worst.pair, 0);
    release(&b);
    shoot(&b, 2, 0.01, 1000, 0.1, 0.5, 0); /* nothing is well exposed in both */
    agreement(&worst, &b, 2);
    assert_int_equal(worst.pair, 0);
    release(&b);
}

static void invalid_input_is_refused(void **state)
{
    struct shot b;
    struct merged out;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&b, 2, 0.5, 2, 0.01, 0.4, 0);
    b.photos[1].info.width = WIDTH / 2;
    assert_int_equal(try_merge(&out, &b, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "exposure 2 has 256 x 24 pixels, but the first one 512 x 24");
    assert_null(out.radiance.data);
    err = (struct err)ERR_INIT;
    b.count = 0;
    assert_int_equal(try_merge(&out, &b, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "0 exposures");
    err = (struct err)ERR_INIT;
    b.count = 2;
    b.photos[1].info.width = WIDTH;
    b.exposures[1] = 1e30;
    assert_int_equal(try_merge(&out, &b, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "exposure 2 is 1e+30 times that of white");
    release(&b);
}

/* ------------------------------------------------------------------------------------------------ photos with known
 * radiance */

struct errors {
    double *colour, *luma, *block; /* relative errors: of samples, of pixels, of colours of 2 x 2 pixels */
    size_t colours, lumas, blocks, pixels;
    double bias, within; /* mean of colours' errors; fraction of pixels whose luminance is within 3 sigma */
};

static double luminance(const double x[3]) { return 0.2126 * x[0] + 0.7152 * x[1] + 0.0722 * x[2]; }

/* Compares well exposed samples: no colour of the pixel is near saturation, and the value is above a twentieth of
 * white. */
static void find_errors(struct errors *e, const struct merged *m, const struct exr_image *truth,
                        const double *exposures, int count)
{
    static const char *const names[] = {"R", "G", "B"};
    const int width = truth->width, height = truth->height;
    *e = (struct errors){.pixels = (size_t)width * (size_t)height};
    e->colour = malloc(3 * e->pixels * sizeof *e->colour);
    e->luma = malloc(e->pixels * sizeof *e->luma);
    e->block = malloc(e->pixels * sizeof *e->block);
    assert_true(e->colour && e->luma && e->block);
    for (int y = 0; y + 1 < height; y += 2)
        for (int x = 0; x + 1 < width; x += 2) {
            double true_sum[3] = {0}, sum[3] = {0}, brightest = 0;
            for (int i = 0; i < 4; i++) {
                const size_t at = (size_t)(y + i / 2) * (size_t)width + (size_t)(x + i % 2);
                double is[3], rgb[3], max = 0, longest = 0;
                for (int c = 0; c < 3; c++) {
                    true_sum[c] += is[c] = exr_find(truth, names[c])->f[at];
                    sum[c] += rgb[c] = m->radiance.data[3 * at + (size_t)c];
                    max = fmax(max, is[c]);
                }
                brightest = fmax(brightest, max);
                for (int k = 0; k < count; k++)
                    if (max * exposures[k] < 0.76) longest = exposures[k];
                for (int c = 0; c < 3; c++) {
                    if (is[c] * longest < 0.05) continue;
                    e->colour[e->colours] = fabs(rgb[c] / is[c] - 1);
                    e->bias += rgb[c] / is[c] - 1;
                    e->colours++;
                }
                if (luminance(is) * longest < 0.05) continue;
                e->luma[e->lumas] = fabs(luminance(rgb) / luminance(is) - 1);
                e->within += e->luma[e->lumas++] < 3 * sqrt(m->variance[at]);
            }
            double longest = 0;
            for (int k = 0; k < count; k++)
                if (brightest * exposures[k] < 0.76) longest = exposures[k];
            for (int c = 0; c < 3; c++)
                if (true_sum[c] / 4 * longest > 0.05 && e->blocks < e->pixels)
                    e->block[e->blocks++] = fabs(sum[c] / true_sum[c] - 1);
        }
    e->bias /= (double)e->colours;
    e->within /= (double)e->lumas;
}

/* exposures: relative to that of white. colours: do the JPEGs have full chroma resolution? */
static void compare_with_truth(const char *folder, const char *const *views, int view_count, const double *exposures,
                               int count, bool colours)
{
    static const char *const names[] = {"R", "G", "B"};
    char path[256];
    for (int i = 0; i < view_count * count; i++) { /* an interrupted run leaves some of them */
        snprintf(path, sizeof path, "%s/photos/%s_e%d.jpg", folder, views[i / count], i % count);
        if (!access(path, R_OK)) continue;
        print_message("%s does not exist\n", path);
        skip();
    }
    for (int n = 0; n < view_count; n++) {
        struct shot b = {.count = count};
        struct exr_image truth;
        struct merged out = {0};
        struct brackets brackets = {b.photos, b.exposures, count, &srgb, NULL};
        struct merge_params params = MERGE_PARAMS_DEFAULT;
        struct noise noise[MERGE_MAX_EXPOSURES], measured;
        struct errors e;
        bool known = false;
        struct err err = ERR_INIT;
        for (int k = 0; k < count; k++) {
            snprintf(path, sizeof path, "%s/photos/%s_e%d.jpg", folder, views[n], k);
            assert_ok(photo_read(&b.photos[k], path, &err), err);
            b.exposures[k] = exposures[k];
        }
        assert_ok(noise_measure(&measured, &known, &brackets, &err), err);
        assert_true(known);
        for (int k = 0; k < count; k++) noise[k] = measured;
        assert_ok(merge_brackets(&out, &brackets, noise, &params, &err), err);
        snprintf(path, sizeof path, "%s/truth/hdr/%s.exr", folder, views[n]);
        assert_ok(exr_read(&truth, path, names, 3, &err), err);
        find_errors(&e, &out, &truth, exposures, count);
        const double colour = quantile(e.colour, e.colours, 0.5), luma = quantile(e.luma, e.lumas, 0.5),
                     block = quantile(e.block, e.blocks, 0.5);
        print_message(
            "%s: median error of colours %.4f (90 %% below %.3f), of luminance %.4f (%.3f), of colours of 2 x 2 "
            "px %.4f (%.3f); bias %.4f; %.0f %% of the pixels, %.0f %% of them within 3 sigma\n",
            views[n], colour, e.colour[e.colours * 9 / 10], luma, e.luma[e.lumas * 9 / 10], block,
            e.block[e.blocks * 9 / 10], e.bias, 100.0 * (double)e.lumas / (double)e.pixels, 100 * e.within);
        assert_true(block < 0.02 && fabs(e.bias) < 0.02 && (!colours || (luma < 0.02 && colour < 0.02)));
        assert_true(e.lumas > e.pixels / 2);
        free(e.colour);
        free(e.luma);
        free(e.block);
        merge_release(&out);
        exr_image_release(&truth);
        release(&b);
    }
}

/* Linear light with a colour outside of Rec.709, alone and in two exposures. */
static void negative_light_stays(void **state)
{
    const float light[3] = {0.5f, -0.0625f, 0.25f};
    (void)state;
    for (int count = 1; count <= 2; count++) {
        struct merged out = {0};
        struct err err = ERR_INIT;
        struct shot b = {.count = count};
        for (int k = 0; k < count; k++) {
            b.exposures[k] = k + 1;
            b.photos[k].info = (struct photo_info){.width = 1, .height = 1, .bits = 32};
            b.photos[k].values = malloc(3 * sizeof *b.photos[k].values);
            assert_non_null(b.photos[k].values);
            for (int c = 0; c < 3; c++) b.photos[k].values[c] = light[c] * (float)(k + 1);
        }
        assert_ok(try_merge(&out, &b, NULL, &err), err);
        for (int c = 0; c < 3; c++) assert_float_equal(out.radiance.data[c], light[c], 1e-6);
        assert_int_equal(out.marks[0], PHOTO_DARK);
        assert_true(out.variance[0] > 0 && out.variance[0] <= 1);
        merge_release(&out);
        release(&b);
    }
}

/* Rendered photos of a flat. */
static void rendered_brackets_merge_to_the_true_radiance(void **state)
{
    static const char *const views[] = {"v00", "v05", "v15", "v24"};
    const double exposures[] = {120.0 / 500, 120.0 / 125, 120.0 / 30};
    (void)state;
    compare_with_truth("../shared/data/apartment", views, 4, exposures, 3, true);
}

/* The built-in scene, if it has been run: gain 60 at f/8 and ISO 100. Its JPEGs subsample chroma 2 x 2. */
static void simulated_brackets_merge_to_the_true_radiance(void **state)
{
    static const char *const views[] = {"v00", "v06", "v12", "v20"};
    const double exposures[] = {60.0 / 240, 60.0 / 60, 60.0 / 15};
    (void)state;
    compare_with_truth("out/loft/simulated", views, 4, exposures, 3, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ramp_of_1e5_is_recovered),
        cmocka_unit_test(saturated_and_dark_pixels_are_bounded_and_marked),
        cmocka_unit_test(a_gap_between_exposures_is_bounded_from_below),
        cmocka_unit_test(a_saturated_colour_does_not_spoil_the_others),
        cmocka_unit_test(a_single_exposure_is_the_linear_photo),
        cmocka_unit_test(bit_depths_may_differ_and_black_stays_black),
        cmocka_unit_test(the_result_does_not_depend_on_threads),
        cmocka_unit_test(disagreeing_exposures_are_found),
        cmocka_unit_test(invalid_input_is_refused),
        cmocka_unit_test(negative_light_stays),
        cmocka_unit_test(rendered_brackets_merge_to_the_true_radiance),
        cmocka_unit_test(simulated_brackets_merge_to_the_true_radiance),
    };
    return cmocka_run_group_tests_name("merge", tests, NULL, NULL);
}
