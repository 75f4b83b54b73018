/* Tests of the choice of a model: stages/fit_materials/choose_material.h, with hard cases of the samples. */
#include "stages/fit_materials/choose_material.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/unit/fit_materials/room_samples.h"

static const struct brdf phong = {BRDF_PHONG, {0.5, 0.4, 0.3}, 1.5, 40, 1};
static const struct brdf matte = {.kind = BRDF_LAMBERT, .albedo = {0.5, 0.4, 0.3}};

static void choose(struct material_choice *c, struct material_samples *s)
{
    struct err err = ERR_INIT;
    assert_int_equal(material_choose(c, s, &err), ST_OK);
    for (int k = 0; k < MATERIAL_KINDS; k++) {
        const struct material_fit *f = &c->fit[k];
        if (!c->fitted[k]) continue;
        assert_true(isfinite(f->k_d[0]) && isfinite(f->ks) && isfinite(f->shape) && isfinite(c->error[k]));
        assert_true(isfinite(c->gain[k]) && isfinite(c->gain_error[k]));
    }
}

static void the_model_of_the_samples_is_chosen(void **state)
{
    (void)state;
    const struct brdf ward = {BRDF_WARD, {0.3, 0.4, 0.2}, 0.1, 0.12, 1};
    const struct brdf *const truths[] = {&phong, &ward, &matte};
    for (int k = 0; k < 3; k++) {
        struct material_samples s;
        struct material_choice c;
        room_samples(&s, truths[k], 8, 6, 4, 0.01);
        choose(&c, &s);
        assert_int_equal(c.kind, truths[k]->kind);
        assert_true(fabs(c.fit[c.kind].k_d[1] * PI / 0.4 - 1) < 0.01);
        /* losses are below the squares whose mean is 1 */
        assert_true(c.error[c.kind] > 0.7 && c.error[c.kind] < 1.2);
        material_samples_release(&s);
    }
}

static void samples_without_gloss_are_lambertian(void **state)
{
    (void)state;
    const struct brdf no_gloss = {BRDF_PHONG, {0.5, 0.4, 0.3}, 0, 40, 0};
    struct material_samples s;
    struct material_choice c;
    room_samples(&s, &no_gloss, 8, 6, 4, 0.01);
    choose(&c, &s);
    assert_int_equal(c.kind, BRDF_LAMBERT);
    assert_non_null(strstr(c.why, "no lobe predicts"));
    material_samples_release(&s);
}

static void one_view_is_enough(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_choice c;
    room_samples(&s, &phong, 12, 9, 1, 0.01);
    choose(&c, &s);
    assert_int_equal(c.kind, BRDF_PHONG);
    assert_true(fabs(c.fit[BRDF_PHONG].ks / 1.5 - 1) < 0.1);
    assert_true(fabs(c.fit[BRDF_PHONG].shape / 40 - 1) < 0.15);
    material_samples_release(&s);
}

static void one_sample_is_lambertian_with_the_reason(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_choice c;
    room_samples(&s, &phong, 1, 1, 1, 0.01);
    choose(&c, &s);
    assert_int_equal(c.kind, BRDF_LAMBERT);
    assert_int_equal(c.folds, 0);
    assert_non_null(strstr(c.why, "too few points"));
    material_samples_release(&s);
}

static void dark_samples_are_lambertian_and_black(void **state)
{
    (void)state;
    const struct brdf black = {.kind = BRDF_LAMBERT};
    struct material_samples s;
    struct material_choice c;
    room_samples(&s, &black, 4, 3, 2, 0);
    choose(&c, &s);
    assert_int_equal(c.kind, BRDF_LAMBERT);
    assert_true(c.fit[BRDF_LAMBERT].k_d[0] < 1e-9);
    material_samples_release(&s);
}

/* All samples have the same direction, and light of the same distribution: the lobe is a constant times the
 * irradiance. */
static void equal_directions(struct material_samples *s)
{
    struct err err = ERR_INIT;
    const struct vec3 up = {0, 0, 1}, view = {0.6, 0, 0.8}, light[2] = {{-0.6, 0, 0.8}, {0, 0.6, 0.8}};
    const struct rng rng = rng_make(1, "test", "noise");
    assert_int_equal(material_samples_init(s, 40, &err), ST_OK);
    for (int i = 0; i < 40; i++) {
        const double strength = 1 + 0.1 * i;
        for (int k = 0; k < 2; k++) material_samples_add(s, i, up, view, light[k], rgb_grey(strength));
        for (int c = 0; c < 3; c++) {
            s->irradiance[3 * i + c] = 1.6 * strength;
            s->radiance[3 * i + c] = 0.5 * strength * (1 + 0.01 * room_normal(&rng, (uint64_t)i, (uint64_t)c));
            s->variance[3 * i + c] = pow(0.005 * strength, 2);
        }
        s->point[i] = i;
    }
}

static void equal_directions_are_lambertian_with_the_reason(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_choice c;
    equal_directions(&s);
    choose(&c, &s);
    assert_int_equal(c.kind, BRDF_LAMBERT);
    assert_non_null(strstr(c.why, "do not tell a lobe"));
    material_samples_release(&s);
}

static void a_declared_lobe_that_samples_do_not_show_is_refused(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_choice c;
    struct err err = ERR_INIT;
    equal_directions(&s);
    assert_int_equal(material_declared(&c, &s, BRDF_WARD, &err), ST_DATA);
    assert_non_null(strstr(err.text, "the 40 samples do not tell a lobe of model ward from the diffuse part"));
    material_samples_release(&s);
}

static void a_declared_model_is_kept(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_choice c;
    struct err err = ERR_INIT;
    room_samples(&s, &phong, 8, 6, 4, 0.01);
    assert_int_equal(material_declared(&c, &s, BRDF_WARD, &err), ST_OK);
    assert_int_equal(c.kind, BRDF_WARD);
    assert_true(c.error[BRDF_WARD] > 1.2); /* it is not the right one, and the error shows that */
    material_samples_release(&s);
}

static void two_points_seen_from_many_views_are_too_few(void **state)
{
    (void)state;
    struct material_samples s;
    struct material_choice c;
    room_samples(&s, &phong, 2, 1, 8, 0.01);
    choose(&c, &s);
    assert_int_equal(c.kind, BRDF_LAMBERT);
    assert_non_null(strstr(c.why, "too few points"));
    material_samples_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_model_of_the_samples_is_chosen),
        cmocka_unit_test(samples_without_gloss_are_lambertian),
        cmocka_unit_test(one_view_is_enough),
        cmocka_unit_test(one_sample_is_lambertian_with_the_reason),
        cmocka_unit_test(dark_samples_are_lambertian_and_black),
        cmocka_unit_test(equal_directions_are_lambertian_with_the_reason),
        cmocka_unit_test(a_declared_lobe_that_samples_do_not_show_is_refused),
        cmocka_unit_test(a_declared_model_is_kept),
        cmocka_unit_test(two_points_seen_from_many_views_are_too_few),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
