/* Tests of the fit of one model: stages/fit_materials/material_samples.h and material_fit.h. */
#include "stages/fit_materials/material_fit.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/unit/fit_materials/room_samples.h"

static const struct vec3 up = {0, 0, 1};

static struct vec3 slanted(double degrees, double turn)
{
    const double t = degrees * DEGREE;
    return vec3_make(sin(t) * cos(turn), sin(t) * sin(turn), cos(t));
}

/* One sample with light from a few directions. */
static void few_directions(struct material_samples *s, struct vec3 view, const struct vec3 *light, int count)
{
    struct err err = ERR_INIT;
    assert_int_equal(material_samples_init(s, 1, &err), ST_OK);
    for (int k = 0; k < count; k++) material_samples_add(s, 0, up, view, light[k], rgb_make(1, 2, 0.5 + k));
}

static void lobes_agree_with_the_reflectance_models(void **state)
{
    (void)state;
    const struct vec3 view = slanted(50, 1),
                      light[] = {slanted(48, 4.2), slanted(40, 4), slanted(70, 5), slanted(20, 1)};
    struct material_samples s;
    few_directions(&s, view, light, 4);
    for (int k = 0; k <= 12; k++)
        for (int ward = 0; ward < 2; ward++) {
            const enum brdf_kind kind = ward ? BRDF_WARD : BRDF_PHONG;
            const double shape = ward ? 0.02 * pow(50, k / 12.0) : pow(5000, k / 12.0),
                         log_s = material_lobe_log_s(kind, shape);
            const struct brdf b = {kind, {0, 0, 0}, material_lobe_ks(kind, log_s), shape, 1};
            double value[3], expected = 0, pdf;
            for (int i = 0; i < 4; i++) expected += 2 * brdf_eval(&b, up, view, light[i], &pdf).r;
            material_lobe_integrals(&s, kind, log_s, value, NULL);
            /* chords are too large by 1e-4 of the lobe's peak at most */
            const double peak = ward ? 8 / (4 * PI * shape * shape) : 8 * b.ks;
            assert_true(value[1] > expected - 1e-12 * peak && value[1] < expected + 2e-4 * peak);
        }
    material_samples_release(&s);
}

static void derivatives_agree_with_differences(void **state)
{
    (void)state;
    const struct brdf truth = {BRDF_WARD, {0.5, 0.4, 0.3}, 0.2, 0.15, 1};
    struct material_samples s;
    room_samples(&s, &truth, 3, 2, 2, 0);
    const int rows = 3 * s.count;
    double scratch[72], predicted[36], jacobian[36 * FIT_UNKNOWNS], above[36], below[36];
    const double x[FIT_UNKNOWNS] = {0.1, 0.2, 0.15, 0.3, 4};
    assert_int_equal(rows, 36);
    for (int kind = BRDF_LAMBERT; kind <= BRDF_WARD; kind++) {
        const int n = fit_unknowns((enum brdf_kind)kind);
        fit_predict(&s, (enum brdf_kind)kind, x, scratch, predicted, jacobian);
        for (int k = 0; k < n; k++) {
            const double step = 1e-5;
            double moved[FIT_UNKNOWNS] = {x[0], x[1], x[2], x[3], x[4]};
            moved[k] = x[k] + step;
            fit_predict(&s, (enum brdf_kind)kind, moved, scratch, above, NULL);
            moved[k] = x[k] - step;
            fit_predict(&s, (enum brdf_kind)kind, moved, scratch, below, NULL);
            for (int r = 0; r < rows; r++) {
                const double difference = (above[r] - below[r]) / (2 * step);
                assert_true(fabs(jacobian[r * n + k] - difference) < 1e-7 * (1 + fabs(predicted[r])));
            }
        }
    }
    material_samples_release(&s);
}

static void expect_truth(const struct brdf *truth, double noise, double k_d, double ks, double shape)
{
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    room_samples(&s, truth, 8, 6, 4, noise);
    assert_int_equal(material_fit(&f, &s, truth->kind, NULL, &err), ST_OK);
    assert_true(f.converged && f.gloss_known);
    assert_true(fabs(f.k_d[0] * PI / truth->albedo.r - 1) < k_d);
    assert_true(fabs(f.k_d[2] * PI / truth->albedo.b - 1) < k_d);
    assert_true(fabs(f.ks / truth->ks - 1) < ks);
    assert_true(fabs(f.shape / truth->shape - 1) < shape);
    assert_true(f.shape_range.low <= f.shape && f.shape <= f.shape_range.high);
    material_samples_release(&s);
}

static void phong_and_ward_are_found_without_noise(void **state)
{
    (void)state;
    const struct brdf phong = {BRDF_PHONG, {0.5, 0.4, 0.3}, 1.5, 40, 1},
                      ward = {BRDF_WARD, {0.3, 0.4, 0.2}, 0.1, 0.12, 1};
    expect_truth(&phong, 0, 0.005, 0.02, 0.02);
    expect_truth(&ward, 0, 0.005, 0.02, 0.02);
}

static void outliers_in_a_tenth_of_the_samples_change_little(void **state)
{
    (void)state;
    const struct brdf truth = {BRDF_PHONG, {0.5, 0.4, 0.3}, 1.5, 40, 1};
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    room_samples(&s, &truth, 8, 6, 4, 0.01);
    for (int i = 0; i < s.count; i += 10)
        for (int c = 0; c < 3; c++) s.radiance[3 * i + c] *= 2;
    assert_int_equal(material_fit(&f, &s, BRDF_PHONG, NULL, &err), ST_OK);
    assert_true(fabs(f.k_d[1] * PI / 0.4 - 1) < 0.02);
    assert_true(fabs(f.ks / 1.5 - 1) < 0.05);
    assert_true(fabs(f.shape / 40 - 1) < 0.05);
    material_samples_release(&s);
}

/* Each point has a reflectance of its own: samples of a point share their error. */
static void intervals_hold_for_a_textured_surface(void **state)
{
    (void)state;
    enum { TEXTURES = 30 };
    const struct brdf truth = {BRDF_PHONG, {0.5, 0.4, 0.3}, 1.5, 40, 1};
    const struct rng rng = rng_make(1, "test", "texture");
    struct material_samples s;
    struct material_fit plain, textured;
    struct err err = ERR_INIT;
    int inside = 0;
    room_samples(&s, &truth, 8, 6, 4, 0.01);
    double *even = malloc(3 * (size_t)s.count * sizeof *even);
    assert_non_null(even);
    memcpy(even, s.radiance, 3 * (size_t)s.count * sizeof *even);
    assert_int_equal(material_fit(&plain, &s, BRDF_PHONG, NULL, &err), ST_OK);
    assert_true(plain.scale < 1.5);
    for (int k = 0; k < TEXTURES; k++) {
        for (int r = 0; r < 3 * s.count; r++)
            s.radiance[r] = even[r] * (1 + 0.1 * room_normal(&rng, (uint64_t)s.point[r / 3], (uint64_t)k));
        assert_int_equal(material_fit(&textured, &s, BRDF_PHONG, NULL, &err), ST_OK);
        assert_true(textured.scale > 3);
        inside += textured.k_d_range[0].low * PI < 0.5 && textured.k_d_range[0].high * PI > 0.5;
    }
    assert_true(inside >= TEXTURES * 85 / 100);
    free(even);
    material_samples_release(&s);
}

/* --- hard cases */

static void without_light_there_is_nothing_to_fit(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    assert_int_equal(material_samples_init(&s, 10, &err), ST_OK);
    assert_int_equal(material_fit(&f, &s, BRDF_WARD, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, "no light arrives at any of the 10 samples"));
    material_samples_release(&s);
}

static void no_samples_are_refused(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    assert_int_equal(material_samples_init(&s, 0, &err), ST_OK);
    assert_int_equal(material_fit(&f, &s, BRDF_LAMBERT, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, "no samples"));
    material_samples_release(&s);
}

static void expect_finite(const struct material_fit *f)
{
    for (int c = 0; c < 3; c++) {
        assert_true(isfinite(f->k_d[c]) && f->k_d[c] >= 0);
        assert_true(f->k_d_range[c].low <= f->k_d[c] && f->k_d[c] <= f->k_d_range[c].high);
    }
    assert_true(isfinite(f->ks) && f->ks >= 0 && isfinite(f->shape));
    assert_false(isnan(f->ks_range.low) || isnan(f->ks_range.high) || isnan(f->shape_range.low));
    assert_true(isfinite(f->cost) && isfinite(f->scale));
}

static void dark_samples_are_a_black_surface(void **state)
{
    (void)state;
    const struct brdf truth = {.kind = BRDF_LAMBERT};
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    room_samples(&s, &truth, 4, 3, 2, 0);
    for (int kind = BRDF_LAMBERT; kind <= BRDF_WARD; kind++) {
        assert_int_equal(material_fit(&f, &s, (enum brdf_kind)kind, NULL, &err), ST_OK);
        expect_finite(&f);
        assert_true(f.k_d[0] < 1e-9 && f.ks < 1e-9);
    }
    material_samples_release(&s);
}

static void an_exponent_of_1_is_found(void **state)
{
    (void)state;
    const struct brdf truth = {BRDF_PHONG, {0.2, 0.2, 0.2}, 0.15, 1, 1};
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    room_samples(&s, &truth, 8, 6, 4, 0);
    assert_int_equal(material_fit(&f, &s, BRDF_PHONG, NULL, &err), ST_OK);
    expect_finite(&f);
    assert_true(f.shape < 1.1);
    assert_true(f.shape_range.low == PHONG_MIN);
    assert_true(fabs(f.ks / 0.15 - 1) < 0.05);
    material_samples_release(&s);
}

static void an_exponent_of_5000_is_found(void **state)
{
    (void)state;
    const struct brdf truth = {BRDF_PHONG, {0.2, 0.2, 0.2}, 200, 5000, 1};
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    room_samples(&s, &truth, 8, 6, 4, 0.01);
    assert_int_equal(material_fit(&f, &s, BRDF_PHONG, NULL, &err), ST_OK);
    expect_finite(&f);
    assert_true(f.shape > 4250 && f.shape <= PHONG_MAX);
    /* what the lobe reflects, all angles together, is known better than its width */
    assert_true(fabs(f.ks / (f.shape + 1) / (200.0 / 5001) - 1) < 0.03);
    material_samples_release(&s);
}

static void the_ends_of_wards_range_are_found(void **state)
{
    (void)state;
    const double ends[2] = {WARD_MIN, WARD_MAX};
    for (int k = 0; k < 2; k++) {
        const struct brdf truth = {BRDF_WARD, {0.2, 0.2, 0.2}, 0.3, ends[k], 1};
        struct material_samples s;
        struct material_fit f;
        struct err err = ERR_INIT;
        room_samples(&s, &truth, 8, 6, 4, 0);
        assert_int_equal(material_fit(&f, &s, BRDF_WARD, NULL, &err), ST_OK);
        expect_finite(&f);
        assert_true(fabs(log(f.shape / ends[k])) < 0.4);
        assert_true(fabs(f.ks / 0.3 - 1) < 0.1);
        material_samples_release(&s);
    }
}

static void one_sample_gives_a_finite_fit(void **state)
{
    (void)state;
    const struct brdf truth = {BRDF_PHONG, {0.5, 0.4, 0.3}, 1.5, 40, 1};
    struct material_samples s;
    struct material_fit f;
    struct err err = ERR_INIT;
    room_samples(&s, &truth, 1, 1, 1, 0.01);
    for (int kind = BRDF_LAMBERT; kind <= BRDF_WARD; kind++) {
        assert_int_equal(material_fit(&f, &s, (enum brdf_kind)kind, NULL, &err), ST_OK);
        expect_finite(&f);
    }
    material_samples_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_agree_with_the_reflectance_models),
        cmocka_unit_test(derivatives_agree_with_differences),
        cmocka_unit_test(phong_and_ward_are_found_without_noise),
        cmocka_unit_test(outliers_in_a_tenth_of_the_samples_change_little),
        cmocka_unit_test(intervals_hold_for_a_textured_surface),
        cmocka_unit_test(without_light_there_is_nothing_to_fit),
        cmocka_unit_test(no_samples_are_refused),
        cmocka_unit_test(dark_samples_are_a_black_surface),
        cmocka_unit_test(an_exponent_of_1_is_found),
        cmocka_unit_test(an_exponent_of_5000_is_found),
        cmocka_unit_test(the_ends_of_wards_range_are_found),
        cmocka_unit_test(one_sample_gives_a_finite_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
