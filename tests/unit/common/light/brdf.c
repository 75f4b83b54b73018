/* Reflectance models: closed forms of the albedo, energy conservation, and sampling that matches its density. */
#include "tests/unit/common/light/near.h"

#include "common/light/brdf.h"
#include "common/light/frame.h"
#include "common/light/sobol.h"
#include "common/math/numbers.h"

static struct brdf surface(enum brdf_kind kind, double albedo, double ks, double shape)
{
    return (struct brdf){kind, {albedo, albedo, albedo}, ks, shape, brdf_gloss_albedo(kind, ks, shape)};
}

static const struct vec3 n = {0, 0, 1};

static struct vec3 viewer(double degrees) { return vec3_make(sin(degrees * DEGREE), 0, cos(degrees * DEGREE)); }

/* Integrals of f cos and of the sampling density over the hemisphere: a grid around the mirrored view, finer towards
 * it so that narrow lobes are resolved. */
static void integrate(const struct brdf *b, struct vec3 view, double *reflectance, double *density)
{
    enum { RINGS = 1500, SECTORS = 180 };
    const struct vec3 axis = {-view.x, -view.y, view.z};
    *reflectance = *density = 0;
    for (int i = 0; i < RINGS; i++) {
        const double x0 = (double)i / RINGS, x1 = (i + 1.0) / RINGS; /* angle = pi x^2 */
        const double middle = (x0 + x1) / 2, a = PI * middle * middle;
        const double weight = (cos(PI * x0 * x0) - cos(PI * x1 * x1)) * 2 * PI / SECTORS;
        for (int k = 0; k < SECTORS; k++) {
            double pdf;
            const struct vec3 light = frame_direction(axis, sin(a), cos(a), (k + 0.5) / SECTORS);
            *reflectance += brdf_eval(b, n, view, light, &pdf).g * weight;
            *density += pdf * weight;
        }
    }
}

static const struct {
    enum brdf_kind kind;
    double albedo, ks, shape;
} cases[] = {
    {BRDF_LAMBERT, 0.7, 0, 0},    {BRDF_LAMBERT, 1, 0, 0},     {BRDF_PHONG, 0.4, 0.15, 1}, {BRDF_PHONG, 0, 2, 20},
    {BRDF_PHONG, 0.3, 100, 1000}, {BRDF_WARD, 0.2, 0.5, 0.05}, {BRDF_WARD, 0.5, 0.3, 0.2}, {BRDF_WARD, 0, 0.9, 0.5},
};
enum { CASES = sizeof cases / sizeof *cases, ANGLES = 5 };
static const double angles[ANGLES] = {0, 30, 60, 80, 88};

static struct brdf case_surface(size_t i)
{
    return surface(cases[i].kind, cases[i].albedo, cases[i].ks, cases[i].shape);
}

static void no_surface_reflects_more_than_its_bound(void **state)
{
    (void)state;
    for (size_t i = 0; i < CASES; i++)
        for (size_t k = 0; k < ANGLES; k++) {
            const struct brdf b = case_surface(i);
            double reflectance, density;
            integrate(&b, viewer(angles[k]), &reflectance, &density);
            assert_true(reflectance <= b.albedo.g + b.gloss + 1e-3);
            assert_true(reflectance <= 1.001);
            if (b.kind == BRDF_LAMBERT)
                assert_near(reflectance, b.albedo.g, 1e-4); /* the furnace: exactly the albedo */
            if (b.kind == BRDF_LAMBERT) assert_near(density, 1, 1e-4);
        }
}

static void sampled_reflectance_agrees_with_quadrature(void **state)
{
    (void)state;
    enum { SAMPLES = 65536 };
    const struct rng rng = rng_make(3, "test", "brdf");
    for (size_t i = 0; i < CASES; i++)
        for (size_t k = 0; k < ANGLES; k++) {
            const struct brdf b = case_surface(i);
            const struct vec3 view = viewer(angles[k]);
            double reflectance, density, estimate = 0, below = 0;
            struct sobol s = sobol_make(&rng, i * 16 + k, SAMPLES);
            integrate(&b, view, &reflectance, &density);
            for (; s.sample < SAMPLES; s.sample++) {
                struct vec3 light;
                double u[4], pdf;
                sobol_group(&s, 0, u);
                if (!brdf_sample(&b, n, view, u, &light)) {
                    below++;
                    continue;
                }
                assert_true(fabs(vec3_length(light) - 1) < 1e-9 && light.z > 0);
                const double f = brdf_eval(&b, n, view, light, &pdf).g;
                assert_true(pdf > 0);
                estimate += f / pdf;
            }
            /* the density above the horizon, and the samples below it, make 1 */
            assert_near(density + below / SAMPLES, 1, 0.005);
            assert_near(estimate / SAMPLES, reflectance, 0.01);
        }
}

/* Pearson's test of independent samples in 8 x 16 bins of equal solid angle. The statistic has mean `freedom` and
 * variance 2 freedom; 5 standard deviations are allowed. */
static void samples_follow_their_density(void **state)
{
    (void)state;
    enum { RINGS = 8, SECTORS = 16, FINE = 24, SAMPLES = 40000 };
    const struct rng rng = rng_make(5, "test", "density");
    for (size_t i = 0; i < CASES; i++) {
        const struct brdf b = case_surface(i);
        if (b.kind != BRDF_LAMBERT && (b.shape > 100 || b.shape < 0.1)) continue; /* too narrow for the bins */
        const struct vec3 view = viewer(40);
        double counts[RINGS * SECTORS] = {0}, statistic = 0;
        int freedom = -1;
        for (uint64_t k = 0; k < SAMPLES; k++) {
            const double u[3] = {rng_uniform(&rng, i, 3 * k), rng_uniform(&rng, i, 3 * k + 1),
                                 rng_uniform(&rng, i, 3 * k + 2)};
            struct vec3 light;
            if (!brdf_sample(&b, n, view, u, &light)) continue;
            const double turn = atan2(light.y, light.x) / (2 * PI) + 0.5;
            counts[clamp_int((int)(light.z * RINGS), 0, RINGS - 1) * SECTORS +
                   clamp_int((int)(turn * SECTORS), 0, SECTORS - 1)]++;
        }
        for (int bin = 0; bin < RINGS * SECTORS; bin++) {
            double expected = 0;
            for (int k = 0; k < FINE * FINE; k++) {
                const double z = (bin / SECTORS + (k / FINE + 0.5) / FINE) / RINGS, r = sqrt(1 - z * z);
                const double a = 2 * PI * ((bin % SECTORS + (k % FINE + 0.5) / FINE) / SECTORS - 0.5);
                double pdf;
                brdf_eval(&b, n, view, vec3_make(r * cos(a), r * sin(a), z), &pdf);
                expected += pdf;
            }
            expected *= 2 * PI / (RINGS * SECTORS) / (FINE * FINE) * SAMPLES;
            if (expected < 5) continue;
            statistic += (counts[bin] - expected) * (counts[bin] - expected) / expected;
            freedom++;
        }
        if (statistic > freedom + 5 * sqrt(2.0 * freedom))
            fail_msg("case %zu: chi square %.1f with %d degrees of freedom", i, statistic, freedom);
    }
}

static void phong_lobe_integrates_to_its_closed_form(void **state)
{
    (void)state;
    double reflectance, density;
    const struct brdf b = surface(BRDF_PHONG, 0.25, 0.7, 12);
    integrate(&b, viewer(0), &reflectance, &density); /* all of the lobe is above the horizon */
    assert_near(reflectance, 0.25 + 2 * PI * 0.7 / 13, 1e-3);
    assert_near(b.gloss, 2 * PI * 0.7 / 13, 1e-12);
    for (int e = 1; e < 5000; e *= 7) /* ks = (n + 1) / (2 pi) normalises it */
        assert_near(brdf_gloss_albedo(BRDF_PHONG, (e + 1) / (2 * PI), e), 1, 1e-12);
}

static void narrow_ward_lobe_reflects_ks(void **state)
{
    (void)state;
    double reflectance, density;
    const struct brdf b = surface(BRDF_WARD, 0, 1, 0.03);
    integrate(&b, viewer(0), &reflectance, &density);
    assert_near(reflectance, 1, 0.01);
    assert_near(b.gloss, 1, 0.01);
}

static void ward_gloss_albedo_is_the_maximum_over_viewers(void **state)
{
    (void)state;
    const double alphas[] = {0.1, 0.3, 0.6, 1};
    for (int i = 0; i < 4; i++) {
        const struct brdf b = surface(BRDF_WARD, 0, 0.4, alphas[i]);
        double max = 0;
        for (int k = 1; k <= 20; k++) {
            double reflectance, density;
            integrate(&b, vec3_make(sqrt(1 - k * k / 400.0), 0, k / 20.0), &reflectance, &density);
            max = fmax(max, reflectance);
        }
        assert_near(b.gloss, max, 0.01);
    }
}

static void ward_is_reciprocal(void **state)
{
    (void)state;
    const struct brdf b = surface(BRDF_WARD, 0.2, 0.4, 0.3);
    const struct vec3 l = vec3_normalize(vec3_make(0.3, -0.5, 0.4)), v = viewer(35);
    double pdf;
    assert_near(brdf_eval(&b, n, v, l, &pdf).g / l.z, brdf_eval(&b, n, l, v, &pdf).g / v.z, 1e-12);
}

static void nothing_is_reflected_below_the_horizon(void **state)
{
    (void)state;
    for (size_t i = 0; i < CASES; i++) {
        const struct brdf b = case_surface(i);
        double pdf;
        assert_true(brdf_eval(&b, n, viewer(20), vec3_make(0, 0.6, -0.8), &pdf).r == 0 && pdf == 0);
        assert_true(brdf_eval(&b, n, vec3_make(0, 0.6, -0.8), viewer(20), &pdf).r == 0 && pdf == 0);
        assert_true(brdf_eval(&b, n, viewer(20), vec3_make(1, 0, 0), &pdf).r == 0 && pdf == 0);
    }
}

static void grazing_directions_give_finite_numbers(void **state)
{
    (void)state;
    const double u[][3] = {{0, 0, 0}, {0, 1 - 1e-16, 0.5}, {1 - 1e-16, 1 - 1e-16, 1 - 1e-16}, {0, 0.999999, 0.25}};
    for (size_t i = 0; i < CASES; i++)
        for (size_t k = 0; k < sizeof u / sizeof *u; k++) {
            const struct brdf b = case_surface(i);
            const struct vec3 view = vec3_normalize(vec3_make(1, 0, 1e-9));
            struct vec3 light;
            double pdf;
            if (!brdf_sample(&b, n, view, u[k], &light)) continue;
            const struct rgb f = brdf_eval(&b, n, view, light, &pdf);
            assert_true(isfinite(f.r) && f.r >= 0 && isfinite(pdf) && pdf >= 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_surface_reflects_more_than_its_bound),
        cmocka_unit_test(sampled_reflectance_agrees_with_quadrature),
        cmocka_unit_test(samples_follow_their_density),
        cmocka_unit_test(phong_lobe_integrates_to_its_closed_form),
        cmocka_unit_test(narrow_ward_lobe_reflects_ks),
        cmocka_unit_test(ward_gloss_albedo_is_the_maximum_over_viewers),
        cmocka_unit_test(ward_is_reciprocal),
        cmocka_unit_test(nothing_is_reflected_below_the_horizon),
        cmocka_unit_test(grazing_directions_give_finite_numbers),
    };
    return cmocka_run_group_tests_name("light brdf", tests, NULL, NULL);
}
