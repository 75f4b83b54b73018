/* Irradiance by rays against closed forms: values, stated errors, hard cases of emitters, convergence. */
#include "tests/unit/common/light/near.h"

#include "common/base/rng.h"
#include "common/light/frame.h"
#include "tests/unit/common/gather/fields.h"

static const struct gather_point floor_point = {{0.2, -0.3, 0}, {0, 0, 1}};
static const struct rgb white = {1, 1, 1};

/* The mean error over `keys` integrals, in standard deviations of that mean; *honesty: true over stated RMS error. */
static double bias_of(const struct light_field *f, struct gather_point p, double truth, int rays, int keys,
                      double *honesty, double *relative)
{
    double mean = 0, squares = 0, stated = 0;
    for (int k = 0; k < keys; k++) {
        struct irradiance e;
        ray_irradiance(&e, f, p, rays, 1000u + (uint64_t)k);
        assert_true(e.rays <= rays);
        mean += (e.value.g - truth) / keys;
        squares += (e.value.g - truth) * (e.value.g - truth) / keys;
        stated += e.error.g * e.error.g / keys;
    }
    *honesty = sqrt(squares / stated);
    *relative = sqrt(squares) / truth;
    return fabs(mean) / sqrt(squares / keys);
}

static void assert_exact_and_honest(const struct light_field *f, struct gather_point p, double truth, double most)
{
    for (int rays = 512; rays <= 8192; rays *= 4) {
        double honesty, relative;
        const double bias = bias_of(f, p, truth, rays, 400, &honesty, &relative);
        print_message("%d rays: relative error %.2g %%, over stated %.2f, bias %.1f sd\n", rays, 100 * relative,
                      honesty, bias);
        assert_true(bias < 4);
        assert_true(honesty > 0.7 && honesty < 1.4);
        if (rays == 8192) assert_true(relative < most);
    }
}

static void a_uniform_sphere_gives_pi_times_its_radiance(void **state)
{
    struct patch_field f;
    struct irradiance e;
    (void)state;
    field_start(&f, rgb_make(1, 2, 0.5));
    ray_irradiance(&e, &f.field, (struct gather_point){{1, 2, 3}, vec3_normalize(vec3_make(1, -2, 0.3))}, 256, 1);
    assert_near(e.value.r, PI, 1e-12);
    assert_near(e.value.g, 2 * PI, 1e-12);
    assert_near(e.value.b, 0.5 * PI, 1e-12);
    assert_near(1 + e.error.g, 1, 1e-12);
    assert_near(e.from[LIGHT_SKY], 1, 1e-12);
    assert_true(isinf(e.nearest));
    assert_near(e.mean_inverse, 0, 0);
}

static void distances_are_those_of_the_hemisphere(void **state)
{
    struct patch_field f;
    struct irradiance e;
    (void)state;
    field_start(&f, white);
    field_add(&f, EMITTER_QUAD, vec3_make(0, 0, 2), vec3_make(1e6, 0, 0), vec3_make(0, 1e6, 0), vec3_make(0, 0, -1),
              white);
    ray_irradiance(&e, &f.field, floor_point, 4096, 1);
    /* distance 2 / cos, so the mean inverse is the mean of cos / 2 over the cosine density: 1 / 3 */
    assert_near(e.mean_inverse, 1.0 / 3, 1e-3);
    assert_near(e.nearest, 2, 1e-3);
    assert_near(e.from[LIGHT_TEXTURE], 1, 1e-12);
}

static struct patch *add_quad_above(struct patch_field *f, double half, double height, struct rgb radiance)
{
    return field_add(f, EMITTER_QUAD, vec3_make(0, 0, height), vec3_make(half, 0, 0), vec3_make(0, half, 0),
                     vec3_make(0, 0, -1), radiance);
}

static void a_patch_over_a_plane_has_lamberts_form_factor(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, add_quad_above(&f, 0.5, 1, white));
    assert_exact_and_honest(&f.field, floor_point, PI * patch_factor(&f.patches[0], floor_point), 1e-3);
}

static void a_skewed_patch_has_lamberts_form_factor(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, field_add(&f, EMITTER_QUAD, vec3_make(0, 0, 1), vec3_make(0.5, 0.1, 0), vec3_make(0.2, 0.4, 0),
                             vec3_make(0, 0, -1), white));
    assert_exact_and_honest(&f.field, floor_point, PI * patch_factor(&f.patches[0], floor_point), 1e-3);
}

static void a_patch_that_no_emitter_names_is_found_all_the_same(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    add_quad_above(&f, 0.5, 1, white);
    assert_exact_and_honest(&f.field, floor_point, PI * patch_factor(&f.patches[0], floor_point), 0.02);
}

static void a_disk_overhead_gives_pi_sine_squared(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 2), vec3_make(0.7, 0, 0), vec3_make(0, 0.7, 0),
                             vec3_make(0, 0, -1), white));
    assert_exact_and_honest(&f.field, floor_point, PI * 0.49 / (0.49 + 4), 1e-3);
}

static void sides_of_a_box_add_up(void **state)
{
    static const struct rgb sides[6] = {{1, 1, 1}, {1, 2, 1}, {1, 0.5, 1}, {1, 0.1, 1}, {1, 9, 1}, {1, 4, 1}};
    struct patch_field f;
    double truth = 0;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_add_box(&f, vec3_make(-1, -2, 0), vec3_make(2, 1, 1.5), sides, true);
    for (int i = 0; i < 6; i++) truth += PI * sides[i].g * patch_factor(&f.patches[i], floor_point);
    assert_exact_and_honest(&f.field, floor_point, truth, 0.005);
}

/* A quad of 1 % of the hemisphere, 1000 times as bright as the rest. */
static void a_small_bright_window_is_found(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, white);
    field_name(&f, field_add(&f, EMITTER_QUAD, vec3_make(1, 0, 1), vec3_make(0, 0.1772, 0), vec3_make(0, 0, 0.1772),
                             vec3_make(-1, 0, 0), rgb_grey(1000)));
    const double factor = patch_factor(&f.patches[0], floor_point);
    assert_exact_and_honest(&f.field, floor_point, PI * (1000 * factor + 1 - factor), 1e-3);
}

/* A wall hides half of the sun's disk: what is left is half of it, all at the same height. */
static void the_edge_of_a_sun_patch_is_lit_by_half(void **state)
{
    const double radius = 0.25 * DEGREE, height = 50 * DEGREE;
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0.01));
    field_add_sun(&f, vec3_make(cos(height), 0, sin(height)), radius, rgb_grey(1e5));
    /* y > floor_point's y is hidden by a black wall near the sun's way */
    field_add(&f, EMITTER_QUAD, vec3_make(3, -0.3 + 50, 50), vec3_make(0, 50, 0), vec3_make(0, 0, 50),
              vec3_make(-1, 0, 0), rgb_grey(0));
    const struct patch *wall = &f.patches[0];
    const double sun = PI * 1e5 * sin(radius) * sin(radius) * sin(height) / 2;
    const double sky = 0.01 * PI * (1 - patch_factor(wall, floor_point));
    assert_exact_and_honest(&f.field, floor_point, sun + sky, 0.01);
}

/* ------------------------------------------------------------------------------------------------------- hard cases */

static struct irradiance gather(const struct light_field *f, struct gather_point p)
{
    struct irradiance e;
    ray_irradiance(&e, f, p, 4096, 5);
    assert_true(isfinite(e.value.r) && isfinite(e.value.g) && isfinite(e.value.b));
    assert_true(isfinite(e.error.r) && isfinite(e.error.g) && isfinite(e.error.b));
    assert_true(isfinite(e.mean_inverse) && e.mean_inverse >= 0 && e.nearest > 0);
    for (int s = 0; s < LIGHT_SOURCES; s++) assert_true(e.from[s] >= 0 && e.from[s] <= 1 + 1e-12);
    return e;
}

/* A lamp with a cone above the point: pi sin^2 of the narrower of the cone and the disk. */
static void a_cone_of_any_width_cuts_the_light(void **state)
{
    static const double betas[] = {0, 5, 20, 45, 90};
    (void)state;
    for (size_t i = 0; i < sizeof betas / sizeof *betas; i++) {
        struct patch_field f;
        field_start(&f, rgb_grey(0));
        struct patch *p = field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 1), vec3_make(0.7, 0, 0),
                                    vec3_make(0, 0.7, 0), vec3_make(0, 0, -1), white);
        p->beta = betas[i] * DEGREE;
        field_name(&f, p);
        const double sine = fmin(sin(p->beta), 0.7 / sqrt(1.49));
        const struct irradiance e = gather(&f.field, floor_point);
        if (betas[i] > 0)
            assert_near(e.value.g, PI * sine * sine, 0.02);
        else
            assert_near(e.value.g, 0, 0);
    }
}

static void a_lamp_that_falls_off_keeps_its_integral(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    struct patch *p = field_add(&f, EMITTER_DISK, vec3_make(0.2, -0.3, 1), vec3_make(0.7, 0, 0), vec3_make(0, 0.7, 0),
                                vec3_make(0, 0, -1), white);
    p->exponent = 3;
    field_name(&f, p);
    /* 2 pi integral of cos^4 sin from 0 to the disk's edge */
    assert_near(gather(&f.field, floor_point).value.g, 2 * PI / 5 * (1 - pow(1 / sqrt(1.49), 5)), 1e-3);
}

static void an_emitter_behind_the_point_or_turned_away_gives_nothing(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct patch_field f;
        field_start(&f, rgb_grey(0));
        field_name(&f, field_add(&f, EMITTER_QUAD, vec3_make(0, 0, turned ? 1 : -1), vec3_make(1, 0, 0),
                                 vec3_make(0, 1, 0), vec3_make(0, 0, 1), white));
        assert_near(gather(&f.field, floor_point).value.g, 0, 0);
    }
}

static void an_emitter_in_the_plane_of_the_point_gives_nothing(void **state)
{
    (void)state;
    for (int on = 0; on < 2; on++)
        for (int kind = EMITTER_DISK; kind <= EMITTER_QUAD; kind++) {
            struct patch_field f;
            field_start(&f, rgb_grey(0));
            field_name(&f, field_add(&f, kind, vec3_make(on ? 0.2 : 3, -0.3, 0), vec3_make(1, 0, 0), vec3_make(0, 1, 0),
                                     vec3_make(0, 0, 1), white));
            assert_near(gather(&f.field, floor_point).value.g, 0, 0);
        }
}

static void a_point_that_nearly_touches_an_emitter_sees_it_everywhere(void **state)
{
    (void)state;
    for (int kind = EMITTER_DISK; kind <= EMITTER_QUAD; kind++)
        for (int power = 1; power <= 12; power++) {
            struct patch_field f;
            field_start(&f, rgb_grey(0));
            field_name(&f, field_add(&f, kind, vec3_make(0.2, -0.3, pow(10, -power)), vec3_make(1, 0, 0),
                                     vec3_make(0, 1, 0), vec3_make(0, 0, -1), white));
            const double value = gather(&f.field, floor_point).value.g;
            assert_near(value, power > 8 ? value : PI, 0.02);
        }
}

static void an_emitter_across_the_horizon_counts_by_what_rises(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, field_add(&f, EMITTER_QUAD, vec3_make(1.2, 0, 0.2), vec3_make(0, 1, 0), vec3_make(0, 0, 1),
                             vec3_make(-1, 0, 0), white));
    assert_exact_and_honest(&f.field, floor_point, PI * patch_factor(&f.patches[0], floor_point), 0.01);
}

static void an_emitter_that_is_hidden_or_not_there_gives_nothing(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, white);
    field_name(&f, add_quad_above(&f, 0.5, 1, rgb_grey(100)));
    add_quad_above(&f, 50, 0.5, rgb_grey(0.5));
    const double hides = patch_factor(&f.patches[1], floor_point);
    assert_near(gather(&f.field, floor_point).value.g, PI * (0.5 * hides + 1 - hides), 0.01);
    f.count = 0;
    assert_near(gather(&f.field, floor_point).value.g, PI, 0.01);
}

static void two_emitters_in_one_direction_count_once(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, add_quad_above(&f, 0.5, 1, white));
    for (int i = 0; i < 5; i++) f.emitters[f.field.emitter_count++] = f.emitters[0];
    assert_exact_and_honest(&f.field, floor_point, PI * patch_factor(&f.patches[0], floor_point), 0.005);
}

static void no_light_is_zero_and_never_nan(void **state)
{
    struct patch_field f;
    struct irradiance e;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_name(&f, add_quad_above(&f, 0.5, 1, rgb_grey(0)));
    field_add_sun(&f, vec3_make(0, 0, 1), 0, white);
    e = gather(&f.field, floor_point);
    assert_near(e.value.g, 0, 0);
    assert_near(e.error.g, 0, 0);
    ray_irradiance_to(&e, &f.field, floor_point, 0.01, 1 << 16, 1);
    assert_near(e.value.g, 0, 0);
    assert_true(e.rays < 1 << 12);
}

/* ------------------------------------------------------------------------------------------------------- whole runs */

static void a_key_gives_the_same_bits_and_another_key_others(void **state)
{
    struct patch_field f;
    struct irradiance a, b, c;
    (void)state;
    field_start(&f, white);
    field_name(&f, add_quad_above(&f, 0.5, 1, rgb_grey(7)));
    ray_irradiance(&a, &f.field, floor_point, 512, 3);
    ray_irradiance(&b, &f.field, floor_point, 512, 3);
    ray_irradiance(&c, &f.field, floor_point, 512, 4);
    assert_memory_equal(&a, &b, sizeof a);
    assert_true(a.value.g != c.value.g);
}

static void a_target_is_met(void **state)
{
    static const struct rgb sides[6] = {{1, 1, 1}, {1, 2, 1}, {1, 0.5, 1}, {1, 0.1, 1}, {1, 9, 1}, {1, 4, 1}};
    static const double targets[] = {0.03, 0.01, 0.003, 0.001};
    struct patch_field f;
    double truth = 0;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_add_box(&f, vec3_make(-1, -2, 0), vec3_make(2, 1, 1.5), sides, true);
    for (int i = 0; i < 6; i++) truth += PI * rgb_luminance(sides[i]) * patch_factor(&f.patches[i], floor_point);
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        double squares = 0;
        for (uint64_t k = 0; k < 50; k++) {
            struct irradiance e;
            ray_irradiance_to(&e, &f.field, floor_point, targets[i], 1 << 20, k);
            assert_true(rgb_luminance(e.error) <= targets[i] * rgb_luminance(e.value));
            squares += pow(rgb_luminance(e.value) / truth - 1, 2) / 50;
        }
        print_message("target %g: error %.2g\n", targets[i], sqrt(squares));
        assert_true(sqrt(squares) < 1.2 * targets[i]);
    }
}

static void a_limit_of_rays_is_kept(void **state)
{
    struct patch_field f;
    (void)state;
    field_start(&f, rgb_grey(0));
    add_quad_above(&f, 0.05, 1, white);
    for (int most = 128; most <= 1 << 14; most *= 2) {
        struct irradiance e;
        ray_irradiance_to(&e, &f.field, floor_point, 1e-9, most, 1);
        assert_true(e.rays <= most);
    }
}

/* Light that varies smoothly over the hemisphere. */
static void smooth_looks(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                         const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    (void)ctx;
    (void)from;
    (void)normal;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1)
            seen[k] = (struct light_look){rgb_grey(2 + direction[k].x + direction[k].x * direction[k].y), 1,
                                          LIGHT_TEXTURE, -1};
}

static void errors_on_smooth_light_fall_faster_than_by_three_quarters(void **state)
{
    const struct light_field f = {.look = smooth_looks};
    double honesty, coarse, fine;
    (void)state;
    bias_of(&f, floor_point, 2 * PI, 256, 200, &honesty, &coarse);
    bias_of(&f, floor_point, 2 * PI, 16384, 200, &honesty, &fine);
    const double rate = log(coarse / fine) / log(64);
    print_message("errors fall as n^-%.2f\n", rate);
    assert_true(rate > 0.75);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_uniform_sphere_gives_pi_times_its_radiance),
        cmocka_unit_test(distances_are_those_of_the_hemisphere),
        cmocka_unit_test(a_patch_over_a_plane_has_lamberts_form_factor),
        cmocka_unit_test(a_skewed_patch_has_lamberts_form_factor),
        cmocka_unit_test(a_patch_that_no_emitter_names_is_found_all_the_same),
        cmocka_unit_test(a_disk_overhead_gives_pi_sine_squared),
        cmocka_unit_test(sides_of_a_box_add_up),
        cmocka_unit_test(a_small_bright_window_is_found),
        cmocka_unit_test(the_edge_of_a_sun_patch_is_lit_by_half),
        cmocka_unit_test(a_cone_of_any_width_cuts_the_light),
        cmocka_unit_test(a_lamp_that_falls_off_keeps_its_integral),
        cmocka_unit_test(an_emitter_behind_the_point_or_turned_away_gives_nothing),
        cmocka_unit_test(an_emitter_in_the_plane_of_the_point_gives_nothing),
        cmocka_unit_test(a_point_that_nearly_touches_an_emitter_sees_it_everywhere),
        cmocka_unit_test(an_emitter_across_the_horizon_counts_by_what_rises),
        cmocka_unit_test(an_emitter_that_is_hidden_or_not_there_gives_nothing),
        cmocka_unit_test(two_emitters_in_one_direction_count_once),
        cmocka_unit_test(no_light_is_zero_and_never_nan),
        cmocka_unit_test(a_key_gives_the_same_bits_and_another_key_others),
        cmocka_unit_test(a_target_is_met),
        cmocka_unit_test(a_limit_of_rays_is_kept),
        cmocka_unit_test(errors_on_smooth_light_fall_faster_than_by_three_quarters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
