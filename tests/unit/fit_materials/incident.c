/* Tests of the light that the fit gathers: stages/fit_materials/incident.h, against closed forms. */
#include "stages/fit_materials/incident.h"

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

/* Radiance 1 from everywhere, or only from within a cone about a direction. */
struct cone {
    struct vec3 axis;
    double cosine, inside, outside;
};

static void cone_look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                      const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    const struct cone *c = ctx;
    (void)from, (void)normal;
    for (int k = 0; k < RAY_PACKET; k++) {
        if (!(active >> k & 1)) continue;
        const bool in = vec3_dot(direction[k], c->axis) >= c->cosine;
        seen[k] = (struct light_look){rgb_grey(in ? c->inside : c->outside), INFINITY, in ? LIGHT_LAMP : LIGHT_SKY, -1};
    }
}

static void gather(struct material_samples *s, const struct light_field *f, const struct vec3 *view, int count,
                   double *shares)
{
    struct err err = ERR_INIT;
    assert_int_equal(material_samples_init(s, count, &err), ST_OK);
    incident_light_at(s, 0, count, f, vec3_make(0, 0, 0), up, view, &room_effort, 1, shares);
}

static void uniform_light_fills_the_whole_lobe(void **state)
{
    (void)state;
    const struct cone all = {{0, 0, 1}, -1, 1, 1};
    const struct light_field f = {&all, cone_look, NULL, 0};
    const struct vec3 view[2] = {{0, 0, 1}, {0.6, 0, 0.8}};
    struct material_samples s;
    double value[6];
    gather(&s, &f, view, 2, NULL);
    assert_true(fabs(s.irradiance[0] / PI - 1) < 1e-3);
    for (double n = 20; n < 5000; n *= 2) {
        material_lobe_integrals(&s, BRDF_PHONG, material_lobe_log_s(BRDF_PHONG, n), value, NULL);
        assert_true(fabs(value[0] - 1) < 0.01); /* a lobe of reflectance 1, all of it above the horizon */
        if (n > 100) assert_true(fabs(value[3] - 1) < 0.01);
    }
    material_samples_release(&s);
}

/* A cone of half angle a about the normal, seen from straight above: 1 - cos^(n+1) a of the lobe, pi sin^2 a. */
static void expect_cone(const struct light_field *f, double angle, double inside, double fraction)
{
    const struct vec3 view[1] = {{0, 0, 1}};
    struct material_samples s;
    double value[3], shares[LIGHT_SOURCES];
    gather(&s, f, view, 1, shares);
    assert_true(fabs(s.irradiance[0] / (PI * inside * pow(sin(angle), 2)) - 1) < fraction);
    assert_true(fabs(shares[LIGHT_LAMP] - 1) < 1e-9);
    for (double n = 1; n < 5000; n *= 3) {
        material_lobe_integrals(&s, BRDF_PHONG, log(n), value, NULL);
        assert_true(fabs(value[0] / (inside * (1 - pow(cos(angle), n + 1))) - 1) < 3 * fraction);
    }
    material_samples_release(&s);
}

static void a_lamp_that_no_emitter_names_is_found(void **state)
{
    (void)state;
    const struct cone cone = {{0, 0, 1}, cos(0.5), 1, 0};
    const struct light_field f = {&cone, cone_look, NULL, 0};
    expect_cone(&f, 0.5, 1, 0.01);
}

static void emitters_add_no_light_and_take_noise_away(void **state)
{
    (void)state;
    const double angle = 0.03;
    const struct cone cone = {{0, 0, 1}, cos(angle), 1000, 0};
    const struct emitter sun = {.kind = EMITTER_SUN, .normal = {0, 0, 1}, .cone = cos(angle), .luminance = 1000};
    const double r = tan(angle);
    const struct emitter disk = {
        .kind = EMITTER_DISK, .centre = {0, 0, 1}, .x = {r, 0, 0}, .y = {0, r, 0}, .normal = {0, 0, -1}};
    const struct emitter quad = {.kind = EMITTER_QUAD, /* larger than the lamp */
                                 .centre = {0, 0, 1},
                                 .x = {1.2 * r, 0, 0},
                                 .y = {0, 1.2 * r, 0},
                                 .normal = {0, 0, -1}};
    const struct emitter *const named[] = {&sun, &disk, &quad};
    for (int k = 0; k < 3; k++) {
        const struct light_field f = {&cone, cone_look, named[k], 1};
        expect_cone(&f, angle, 1000, k == 2 ? 0.03 : 0.005);
    }
}

static void darkness_is_zero(void **state)
{
    (void)state;
    const struct cone none = {{0, 0, 1}, -1, 0, 0};
    const struct emitter edge_on = {
        .kind = EMITTER_QUAD, .centre = {2, 0, 0}, .x = {0, 1, 0}, .y = {1, 0, 0}, .normal = {0, 0, 1}};
    const struct light_field f = {&none, cone_look, &edge_on, 1};
    const struct vec3 view[1] = {{0.6, 0, 0.8}};
    struct material_samples s;
    double value[3], shares[LIGHT_SOURCES];
    gather(&s, &f, view, 1, shares);
    material_lobe_integrals(&s, BRDF_WARD, material_lobe_log_s(BRDF_WARD, 0.1), value, NULL);
    assert_true(s.irradiance[0] == 0 && value[0] == 0 && shares[LIGHT_LAMP] == 0);
    material_samples_release(&s);
}

static void a_room_is_gathered_as_quadrature_says(void **state)
{
    (void)state;
    const struct brdf lobes[2] = {{BRDF_PHONG, {0, 0, 0}, 1, 60, 1}, {BRDF_WARD, {0, 0, 0}, 1, 0.15, 1}};
    struct glossy_room room;
    struct err err = ERR_INIT;
    double sum[3] = {0}, off[3] = {0}, bias[3] = {0};
    room_make(&room, 3);
    const struct light_field field = room_field(&room);
    for (int i = 0; i < 24; i++) {
        const struct vec3 at = room_grid_point(&room, i, 6, 4);
        const struct vec3 view[1] = {vec3_normalize(vec3_sub(room_viewer(&room, 3, i % 3), at))};
        struct material_samples s;
        assert_int_equal(material_samples_init(&s, 1, &err), ST_OK);
        incident_light_at(&s, 0, 1, &field, at, up, view, &room_effort, (uint64_t)i, NULL);
        const double e = room_irradiance(&room, at).g;
        sum[0] += e;
        off[0] += fabs(s.irradiance[1] - e);
        bias[0] += s.irradiance[1] - e;
        for (int k = 0; k < 2; k++) {
            double value[3];
            const double log_s = material_lobe_log_s(lobes[k].kind, lobes[k].shape);
            const double truth = room_reflection(&room, &lobes[k], at, view[0]).g;
            material_lobe_integrals(&s, lobes[k].kind, log_s, value, NULL);
            sum[1 + k] += truth;
            const double error = value[1] * lobes[k].ks / material_lobe_ks(lobes[k].kind, log_s) - truth;
            off[1 + k] += fabs(error);
            bias[1 + k] += error;
        }
        material_samples_release(&s);
    }
    for (int k = 0; k < 3; k++) {
        assert_true(off[k] < 0.02 * sum[k]);
        assert_true(fabs(bias[k]) < 0.005 * sum[k]);
    }
}

static void the_same_key_gives_the_same_bits(void **state)
{
    (void)state;
    const struct cone cone = {{0, 0, 1}, cos(0.5), 1, 0.1};
    const struct light_field f = {&cone, cone_look, NULL, 0};
    const struct vec3 view[2] = {{0.6, 0, 0.8}, {0, 0.6, 0.8}};
    struct material_samples a, b;
    double va[6], vb[6];
    gather(&a, &f, view, 2, NULL);
    gather(&b, &f, view, 2, NULL);
    material_lobe_integrals(&a, BRDF_WARD, 4, va, NULL);
    material_lobe_integrals(&b, BRDF_WARD, 4, vb, NULL);
    assert_memory_equal(va, vb, sizeof va);
    material_samples_release(&a);
    material_samples_release(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_fills_the_whole_lobe),
        cmocka_unit_test(a_lamp_that_no_emitter_names_is_found),
        cmocka_unit_test(emitters_add_no_light_and_take_noise_away),
        cmocka_unit_test(darkness_is_zero),
        cmocka_unit_test(a_room_is_gathered_as_quadrature_says),
        cmocka_unit_test(the_same_key_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
