/* Light reflected by gloss lobes, against closed forms. */
#include "tests/unit/common/light/near.h"

#include "common/gather/specular.h"
#include "tests/unit/common/gather/fields.h"

static const struct gather_point floor_point = {{0.2, -0.3, 0}, {0, 0, 1}};

static struct brdf gloss(enum brdf_kind kind, double ks, double shape)
{
    return (struct brdf){kind, {0.5, 0.4, 0.3}, ks, shape, brdf_gloss_albedo(kind, ks, shape)};
}

static struct irradiance reflected(const struct patch_field *f, const struct brdf *b, struct vec3 view, uint64_t key)
{
    struct irradiance e;
    specular_integral(&e, &f->field, floor_point, b, view, 0.001, 1 << 18, key);
    assert_true(isfinite(e.value.r) && isfinite(e.value.g) && isfinite(e.value.b) && isfinite(e.error.g));
    return e;
}

static void phong_in_uniform_light_is_its_reflectance(void **state)
{
    static const double shapes[] = {1, 5, 50, 5000};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        struct patch_field f;
        const struct brdf b = gloss(BRDF_PHONG, 0.7, shapes[i]);
        field_start(&f, rgb_make(1, 2, 3));
        const struct irradiance e = reflected(&f, &b, vec3_make(0, 0, 1), 1);
        assert_near(e.value.r, 2 * PI * 0.7 / (shapes[i] + 1), 1e-3);
        assert_near(e.value.b, 3 * e.value.r, 1e-9);
    }
}

/* Overhead: the lobe of a viewer overhead within the disk's angle, 2 pi k_s (1 - cos^(n+1)) / (n + 1). */
static void phong_under_a_disk_is_its_lobe_within_the_disk(void **state)
{
    static const double shapes[] = {1, 10, 200};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        for (int named = 0; named < 2; named++) {
            struct patch_field f;
            const struct brdf b = gloss(BRDF_PHONG, 0.7, shapes[i]);
            field_start(&f, rgb_grey(0));
            struct patch *p = field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 2), vec3_make(0.3, 0, 0),
                                        vec3_make(0, 0.3, 0), vec3_make(0, 0, -1), rgb_grey(5));
            if (named) field_name(&f, p);
            const double cosine = 2 / sqrt(4.09);
            const double truth = 5 * 2 * PI * 0.7 * (1 - pow(cosine, shapes[i] + 1)) / (shapes[i] + 1);
            assert_near(reflected(&f, &b, vec3_make(0, 0, 1), 1).value.g, truth, named ? 0.003 : 0.006);
        }
}

/* A small far lamp at grazing light: radiance, solid angle, and the lobe itself, without a cosine. */
static void phong_at_grazing_light_does_not_explode(void **state)
{
    const double height = 2 * DEGREE;
    const struct brdf b = gloss(BRDF_PHONG, 0.7, 30);
    const struct vec3 view = {-cos(height), 0, sin(height)};
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_add_sun(&f, vec3_make(cos(height), 0, sin(height)), 0.25 * DEGREE, rgb_grey(1e4));
    assert_near(reflected(&f, &b, view, 1).value.g, 1e4 * 2 * PI * (1 - cos(0.25 * DEGREE)) * 0.7, 0.002);
}

/* The same integral by midpoints in polar coordinates about the normal. */
static double by_quadrature(const struct brdf *b, struct vec3 view, double edge)
{
    enum { STEPS = 1200 };
    struct brdf lobe = *b;
    double sum = 0, density;
    lobe.albedo = rgb_grey(0);
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            const double t = (i + 0.5) / STEPS * edge, a = (k + 0.5) / STEPS * 2 * PI;
            const struct vec3 w = {sin(t) * cos(a), sin(t) * sin(a), cos(t)};
            sum += brdf_eval(&lobe, vec3_make(0, 0, 1), view, w, &density).r * sin(t);
        }
    return sum * edge * 2 * PI / ((double)STEPS * STEPS);
}

static void ward_agrees_with_quadrature(void **state)
{
    static const double shapes[] = {0.1, 0.2, 0.5};
    const struct vec3 view = {sin(40 * DEGREE), 0, cos(40 * DEGREE)};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        struct patch_field f;
        const struct brdf b = gloss(BRDF_WARD, 0.3, shapes[i]);
        field_start(&f, rgb_grey(1));
        assert_near(reflected(&f, &b, view, 1).value.g, by_quadrature(&b, view, PI / 2), 0.003);
        field_start(&f, rgb_grey(0));
        field_name(&f, field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 1), vec3_make(1, 0, 0), vec3_make(0, 1, 0),
                                 vec3_make(0, 0, -1), rgb_grey(1)));
        assert_near(reflected(&f, &b, view, 1).value.g, by_quadrature(&b, view, PI / 4), 0.003);
    }
}

static void stated_errors_are_honest(void **state)
{
    const struct brdf b = gloss(BRDF_WARD, 0.3, 0.2);
    const struct vec3 view = {sin(40 * DEGREE), 0, cos(40 * DEGREE)};
    const double truth = by_quadrature(&b, view, PI / 4);
    struct patch_field f;
    double squares = 0, stated = 0;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 1), vec3_make(1, 0, 0), vec3_make(0, 1, 0),
                             vec3_make(0, 0, -1), rgb_grey(1)));
    for (uint64_t k = 0; k < 300; k++) {
        struct irradiance e;
        specular_integral(&e, &f.field, floor_point, &b, view, 0, 512, k);
        squares += (e.value.g - truth) * (e.value.g - truth);
        stated += e.error.g * e.error.g;
    }
    print_message("true over stated error %.2f\n", sqrt(squares / stated));
    assert_true(sqrt(squares / stated) > 0.7 && sqrt(squares / stated) < 1.4);
}

static void no_lobe_no_gloss_and_a_viewer_below_give_nothing(void **state)
{
    const struct brdf lambert = gloss(BRDF_LAMBERT, 1, 1), dull = gloss(BRDF_PHONG, 0, 20);
    const struct brdf shiny = gloss(BRDF_PHONG, 0.7, 20);
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(1));
    assert_near(reflected(&f, &lambert, vec3_make(0, 0, 1), 1).value.g, 0, 0);
    assert_near(reflected(&f, &dull, vec3_make(0, 0, 1), 1).value.g, 0, 0);
    assert_near(reflected(&f, &shiny, vec3_make(0, 0, -1), 1).value.g, 0, 0);
    field_start(&f, rgb_grey(0));
    assert_near(reflected(&f, &shiny, vec3_make(0, 0, 1), 1).value.g, 0, 0);
}

/* The error that counts is that of all that the surface shows. */
static void a_lobe_on_a_bright_surface_needs_fewer_rays(void **state)
{
    const struct brdf b = gloss(BRDF_PHONG, 0.7, 10);
    const struct vec3 view = {0, 0, 1};
    struct patch_field f;
    struct irradiance dark, bright;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 2), vec3_make(0.3, 0, 0), vec3_make(0, 0.3, 0),
              vec3_make(0, 0, -1), rgb_grey(5));
    specular_integral_beside(&dark, &f.field, floor_point, &b, view, 0, 0.01, 1 << 16, 1);
    specular_integral_beside(&bright, &f.field, floor_point, &b, view, 100, 0.01, 1 << 16, 1);
    assert_true(bright.rays <= 128 && dark.rays > 8 * bright.rays);
    assert_true(rgb_luminance(bright.error) <= 0.01 * (100 + rgb_luminance(bright.value)));
    assert_true(rgb_luminance(dark.error) <= 0.01 * rgb_luminance(dark.value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phong_in_uniform_light_is_its_reflectance),
        cmocka_unit_test(phong_under_a_disk_is_its_lobe_within_the_disk),
        cmocka_unit_test(phong_at_grazing_light_does_not_explode),
        cmocka_unit_test(ward_agrees_with_quadrature),
        cmocka_unit_test(stated_errors_are_honest),
        cmocka_unit_test(a_lobe_on_a_bright_surface_needs_fewer_rays),
        cmocka_unit_test(no_lobe_no_gloss_and_a_viewer_below_give_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
