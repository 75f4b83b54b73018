/* Irradiance to a target error: when estimators end, what they spend, and what they agree on. */
#include "tests/unit/common/light/near.h"

#include "common/gather/gatherer.h"
#include "common/math/numbers.h"

/* A sky whose radiance falls with the angle from the zenith, and a small bright disk in it. */
static void look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                 const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    (void)ctx, (void)from, (void)normal;
    for (int k = 0; k < RAY_PACKET; k++) {
        if (!(active >> k & 1)) continue;
        const struct vec3 d = direction[k];
        const bool disk = vec3_dot(d, vec3_normalize(vec3_make(1, 1, 1))) > cos(10 * DEGREE);
        seen[k] = (struct light_look){rgb_grey(disk ? 20 : 1 + d.z), INFINITY, LIGHT_SKY, -1};
    }
}

static const struct light_field field = {.look = look};
static const struct gather_point point = {{0, 0, 0}, {0, 0, 1}};

/* The sky alone gives pi + 2 pi / 3; the disk hides some of it, whose mean is 1 + cos of its middle to a percent. */
static double truth(void)
{
    const double cosine = 1 / sqrt(3), sine = sin(10 * DEGREE);
    return PI + 2 * PI / 3 + PI * sine * sine * cosine * (20 - 1 - cosine);
}

static struct irradiance gather(const struct gather_params *params)
{
    struct gatherer *g;
    struct irradiance e;
    struct err err = ERR_INIT;
    assert_ok(gatherer_make(&g, params, &err), err);
    gatherer_irradiance(&e, g, &field, point, 7);
    gatherer_free(g);
    return e;
}

static struct gather_params params_of(const char *estimator, double target)
{
    struct gather_params p = GATHER_PARAMS_DEFAULT;
    snprintf(p.estimator, sizeof p.estimator, "%s", estimator);
    p.target_error = target;
    return p;
}

static void every_estimator_reaches_the_target(void **state)
{
    static const char *const names[] = {"auto", "rays", "hemicube"};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        const struct gather_params p = params_of(names[i], 0.01);
        const struct irradiance e = gather(&p);
        assert_true(rgb_luminance(e.error) <= 0.01 * rgb_luminance(e.value));
        assert_near(e.value.g, truth(), 0.03);
    }
}

static void a_smaller_target_costs_more(void **state)
{
    static const char *const names[] = {"rays", "hemicube"};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        const struct gather_params coarse = params_of(names[i], 0.05), fine = params_of(names[i], 0.00005);
        const struct irradiance a = gather(&coarse), b = gather(&fine);
        assert_true(a.rays < b.rays);
        assert_true(a.error.g > b.error.g);
    }
}

static void without_a_target_all_is_spent(void **state)
{
    struct gather_params cube = params_of("hemicube", 0);
    (void)state;
    cube.hemicube = 34;
    assert_int_equal(gather(&cube).rays, 3 * 34 * 34);
}

static void the_same_key_gives_the_same_bits(void **state)
{
    const struct gather_params p = params_of("auto", 0.01);
    const struct irradiance a = gather(&p), b = gather(&p);
    (void)state;
    assert_memory_equal(&a.value, &b.value, sizeof a.value);
    assert_int_equal(a.rays, b.rays);
}

static void an_odd_hemicube_is_refused(void **state)
{
    struct gather_params p = params_of("hemicube", 0);
    struct err err = ERR_INIT;
    (void)state;
    p.hemicube = 33;
    assert_int_equal(gather_params_check(&p, &err), ST_USAGE);
    assert_non_null(strstr(err.text, "give 34"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_estimator_reaches_the_target), cmocka_unit_test(a_smaller_target_costs_more),
        cmocka_unit_test(without_a_target_all_is_spent),      cmocka_unit_test(the_same_key_gives_the_same_bits),
        cmocka_unit_test(an_odd_hemicube_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
