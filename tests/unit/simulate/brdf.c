/* Surfaces: reflectance never above 1, sampling densities that integrate to one, sampled estimates against quadrature. */
#include "tests/unit/simulate/worlds.h"

#include "common/light/brdf.h"
#include "common/light/sobol.h"

static struct brdf make(enum brdf_kind kind, double albedo, double ks, double shape)
{
    return (struct brdf){kind, {albedo, albedo, albedo}, ks, shape, brdf_gloss_albedo(kind, ks, shape)};
}

static const struct vec3 n = {0, 0, 1};

static struct vec3 viewer(double degrees) { return vec3_make(sin(degrees * PI / 180), 0, cos(degrees * PI / 180)); }

/* Integrals over the hemisphere, of f cos and of the density: a grid, finer towards the mirrored view, in angles around
 * that direction so that narrow lobes are met. */
static void quadrature(const struct brdf *b, struct vec3 view, double *reflected, double *density)
{
    enum { RINGS = 3000, SECTORS = 360 };
    const struct vec3 axis = {-view.x, -view.y, view.z};
    *reflected = *density = 0;
    for (int i = 0; i < RINGS; i++) {
        const double x0 = (double)i / RINGS, x1 = (i + 1.0) / RINGS; /* angle = pi x^2 */
        const double middle = (x0 + x1) / 2, a = PI * middle * middle;
        const double weight = (cos(PI * x0 * x0) - cos(PI * x1 * x1)) * 2 * PI / SECTORS;
        for (int k = 0; k < SECTORS; k++) {
            double pdf;
            const struct vec3 light = frame_direction(axis, sin(a), cos(a), (k + 0.5) / SECTORS);
            *reflected += brdf_eval(b, n, view, light, &pdf).g * weight;
            *density += pdf * weight;
        }
    }
}

static void energy_density_estimate(void **state)
{
    (void)state;
    const struct brdf surfaces[] = {
        make(BRDF_LAMBERT, 0.7, 0, 0),    make(BRDF_PHONG, 0.4, 0.15, 1),  make(BRDF_PHONG, 0, 2, 20),
        make(BRDF_PHONG, 0.3, 100, 1000), make(BRDF_WARD, 0.2, 0.5, 0.05), make(BRDF_WARD, 0.5, 0.3, 0.2),
        make(BRDF_WARD, 0, 0.9, 0.5),
    };
    const double angles[] = {0, 30, 60, 80, 88};
    const struct rng rng = rng_make(3, "test", "brdf");
    for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++)
        for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
            const struct brdf *b = &surfaces[i];
            const struct vec3 view = viewer(angles[k]);
            double reflected, density, estimate = 0, lost = 0;
            enum { SAMPLES = 65536 };
            struct sobol s = sobol_make(&rng, i * 16 + k, SAMPLES);
            quadrature(b, view, &reflected, &density);
            assert_true(reflected <= b->albedo.g + b->gloss + 1e-3);
            assert_true(reflected <= 1.001);
            for (; s.sample < SAMPLES; s.sample++) {
                struct vec3 light;
                double u[4], pdf;
                sobol_group(&s, 0, u);
                if (!brdf_sample(b, n, view, u, &light)) {
                    lost++;
                    continue;
                }
                assert_true(fabs(vec3_length(light) - 1) < 1e-9 && light.z > 0);
                const double f = brdf_eval(b, n, view, light, &pdf).g;
                assert_true(pdf > 0);
                estimate += f / pdf;
            }
            /* what falls below the horizon is the rest of the density */
            assert_near(density + lost / SAMPLES, 1, 0.005);
            assert_near(estimate / SAMPLES, reflected, 0.01);
        }
}

static void closed_forms(void **state)
{
    (void)state;
    double reflected, density;
    const struct brdf phong = make(BRDF_PHONG, 0.25, 0.7, 12);
    quadrature(&phong, viewer(0), &reflected, &density); /* all of the lobe is above the horizon */
    assert_near(reflected, 0.25 + 2 * PI * 0.7 / 13, 1e-3);
    assert_near(phong.gloss, 2 * PI * 0.7 / 13, 1e-12);
    const struct brdf ward = make(BRDF_WARD, 0, 1, 0.03); /* narrow: nearly all of ks */
    quadrature(&ward, viewer(0), &reflected, &density);
    assert_near(reflected, 1, 0.01);
    double pdf;
    assert_true(brdf_eval(&ward, n, viewer(20), vec3_make(0, 0.6, -0.8), &pdf).r == 0 && pdf == 0);
}

/* The numbers of a pixel: each uniform, all pairs even, no two pixels alike. */
static void even_numbers(void **state)
{
    (void)state;
    const struct rng rng = rng_make(3, "test", "sampler");
    double mean[4] = {0, 0, 0, 0};
    for (uint64_t pixel = 0; pixel < 1000; pixel++) {
        struct sobol s = sobol_make(&rng, pixel, 16);
        int cells[4][16] = {{0}}, squares[16] = {0};
        for (; s.sample < 16; s.sample++) {
            double u[4];
            sobol_group(&s, 5, u);
            for (int d = 0; d < 4; d++) {
                assert_true(u[d] >= 0 && u[d] < 1);
                cells[d][(int)(16 * u[d])]++;
                mean[d] += u[d] / 16000;
            }
            squares[4 * (int)(4 * u[0]) + (int)(4 * u[1])]++;
        }
        for (int i = 0; i < 16; i++) {
            for (int d = 0; d < 4; d++) assert_int_equal(cells[d][i], 1);
            assert_int_equal(squares[i], 1);
        }
    }
    for (int d = 0; d < 4; d++) assert_near(mean[d], 0.5, 0.003);
    struct sobol a = sobol_make(&rng, 1, 4), b = a; /* beyond the table, other sets follow */
    double u[4], v[4];
    b.sample = 4;
    sobol_group(&a, 0, u);
    sobol_group(&b, 0, v);
    assert_true(u[0] != v[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_density_estimate),
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(even_numbers),
    };
    return cmocka_run_group_tests_name("simulate brdf", tests, scratch_make, scratch_remove);
}
