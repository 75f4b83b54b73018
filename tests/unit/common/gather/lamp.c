/* lamp.c - radiance and irradiance of lamps against closed forms and plain sums. */
#include <math.h>

#include "common/gather/light_list.h"
#include "tests/unit/scratch.h"

static const double quarter = 1.5707963267948966;

static struct lamp disk(double radius, double beta, double exponent)
{
    return (struct lamp){.shape = LAMP_DISK,
                         .normal = {0, 0, -1},
                         .x = {radius, 0, 0},
                         .y = {0, -radius, 0},
                         .radius = radius,
                         .radiance = {1, 2, 4},
                         .beta = beta,
                         .exponent = exponent};
}

static struct lamp quad(struct vec3 x, struct vec3 y, double beta, double exponent)
{
    return (struct lamp){.shape = LAMP_QUAD,
                         .normal = vec3_normalize(vec3_cross(x, y)),
                         .x = x,
                         .y = y,
                         .radiance = {1, 2, 4},
                         .beta = beta,
                         .exponent = exponent};
}

static void assert_near(double found, double wanted, double relative)
{
    if (!(fabs(found - wanted) <= relative * fabs(wanted))) fail_msg("found %.12g, wanted %.12g", found, wanted);
}

/* The plain sum over a grid of the lamp's area. */
static double plain_sum(const struct lamp *l, struct vec3 at, struct vec3 m, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const double u = (2 * i + 1.0) / n - 1, v = (2 * j + 1.0) / n - 1;
            if (l->shape == LAMP_DISK && u * u + v * v > 1) continue;
            const struct vec3 q = vec3_add(l->centre, vec3_add(vec3_scale(l->x, u), vec3_scale(l->y, v)));
            const struct vec3 w = vec3_sub(q, at);
            const double r = vec3_length(w), here = vec3_dot(m, w) / r;
            const struct vec3 away = vec3_scale(w, -1 / r);
            if (here > 0) sum += lamp_radiance(l, away).r * here * vec3_dot(l->normal, away) / (r * r);
        }
    return sum * 4 * vec3_length(vec3_cross(l->x, l->y)) / n / n;
}

static void radiance_ends_at_the_cone(void **state)
{
    (void)state;
    const struct lamp l = disk(0.1, 0.5, 2);
    assert_near(lamp_radiance(&l, vec3_make(0, 0, -1)).g, 2, 1e-15);
    assert_near(lamp_radiance(&l, vec3_make(sin(0.499), 0, -cos(0.499))).b, 4 * cos(0.499) * cos(0.499), 1e-12);
    assert_true(lamp_radiance(&l, vec3_make(sin(0.501), 0, -cos(0.501))).r == 0);
    assert_true(lamp_radiance(&l, vec3_make(0, 0, 1)).r == 0);
}

static void a_disk_above_a_point_has_its_closed_form(void **state)
{
    (void)state;
    const struct lamp l = disk(0.3, quarter, 0);
    for (double h = 1e-3; h < 1e4; h *= 7) {
        const double sine2 = 0.09 / (0.09 + h * h);
        assert_near(lamp_irradiance(&l, vec3_make(0, 0, -h), vec3_make(0, 0, 1)).r, 2 * quarter * sine2, 1e-8);
        assert_near(lamp_irradiance(&l, vec3_make(0, 0, -h), vec3_make(0, 0, 1)).b, 8 * quarter * sine2, 1e-8);
    }
}

static void a_disk_aside_has_its_closed_form(void **state)
{
    (void)state;
    const double radius = 0.4, h = 0.7;
    const struct lamp l = disk(radius, quarter, 0);
    for (double d = 0.05; d < 30; d *= 1.9) {
        const double sum = h * h + d * d + radius * radius;
        const double wanted =
            quarter * (1 - (h * h + d * d - radius * radius) / sqrt(sum * sum - 4 * radius * radius * d * d));
        assert_near(lamp_irradiance(&l, vec3_make(0, d, -h), vec3_make(0, 0, 1)).r, wanted, 1e-7);
    }
}

static void a_cone_within_a_large_lamp_has_its_closed_form(void **state)
{
    (void)state;
    for (int e = 0; e < 6; e++) {
        const double exponent = e == 5 ? 500 : e * 0.7, beta = 0.6;
        const double wanted = 4 * quarter / (exponent + 2) * (1 - pow(cos(beta), exponent + 2));
        const struct lamp round = disk(50, beta, exponent);
        const struct lamp square = quad(vec3_make(50, 0, 0), vec3_make(0, -40, 0), beta, exponent);
        const struct vec3 at = vec3_make(3, 2, -1.5), m = vec3_make(0, 0, 1);
        assert_near(lamp_irradiance(&round, at, m).r, wanted, 1e-8);
        assert_near(lamp_irradiance(&square, at, m).r, wanted, 1e-8);
        /* a tilt by less than the cone's complement multiplies it by its cosine */
        assert_near(lamp_irradiance(&round, at, vec3_make(sin(0.5), 0, cos(0.5))).r, cos(0.5) * wanted, 1e-8);
    }
}

static void a_quad_by_polygon_and_by_arcs_agree(void **state)
{
    (void)state;
    const struct lamp closed = quad(vec3_make(0.5, 0.1, 0), vec3_make(0.2, -0.9, 0), quarter, 0);
    struct lamp open = closed;
    open.beta = quarter - 1e-9; /* no closed form */
    for (int i = 0; i < 40; i++) {
        const struct vec3 at = vec3_make(3 * cos(i * 1.3), 2 * sin(i * 0.7), -0.05 - 0.1 * i);
        const struct vec3 m = vec3_normalize(vec3_make(cos(i * 2.1), sin(i * 2.1), cos(i * 0.9)));
        const double wanted = lamp_irradiance(&closed, at, m).r;
        if (wanted == 0)
            assert_true(lamp_irradiance(&open, at, m).r < 1e-12);
        else
            assert_near(lamp_irradiance(&open, at, m).r, wanted, 1e-6);
    }
}

static void a_rectangle_above_its_corner_has_its_closed_form(void **state)
{
    (void)state;
    const double a = 0.8, b = 0.5, h = 0.6, x = a / h, y = b / h;
    const struct lamp l = quad(vec3_make(a / 2, 0, 0), vec3_make(0, -b / 2, 0), quarter, 0);
    const double f = x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) + y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y));
    assert_near(lamp_irradiance(&l, vec3_make(a / 2, b / 2, -h), vec3_make(0, 0, 1)).r, f / 2, 1e-12);
}

static void lamps_cut_by_cone_and_horizon_agree_with_a_plain_sum(void **state)
{
    (void)state;
    struct lamp lamps[] = {disk(0.5, 0.7, 1), disk(0.5, quarter, 3),
                           quad(vec3_make(0.5, 0.2, 0), vec3_make(0, -0.4, 0), 0.8, 0.5)};
    for (int k = 0; k < 3; k++) {
        lamps[k].centre = vec3_make(0.3, -0.2, 1);
        for (int i = 0; i < 12; i++) {
            const struct vec3 at = vec3_make(0.9 * cos(i), 0.8 * sin(i), -0.1);
            const struct vec3 m = vec3_normalize(vec3_make(cos(2.0 * i), sin(2.0 * i), 0.15 * (i % 4)));
            const double sum = plain_sum(&lamps[k], at, m, 1500), found = lamp_irradiance(&lamps[k], at, m).r;
            if (fabs(found - sum) > 2e-4 * sum + 2e-6) fail_msg("lamp %d point %d: %.9g, sum %.9g", k, i, found, sum);
        }
    }
}

static void dark_points_get_exactly_nothing(void **state)
{
    (void)state;
    const struct lamp spot = disk(0.1, 0.3, 1), none = disk(0.1, 0, 1);
    const struct lamp panel = quad(vec3_make(0.5, 0, 0), vec3_make(0, -0.5, 0), quarter, 0);
    const struct vec3 up = vec3_make(0, 0, 1), down = vec3_make(0, 0, -1);
    assert_true(lamp_irradiance(&spot, vec3_make(0, 0, 1), down).r == 0);  /* behind the lamp */
    assert_true(lamp_irradiance(&panel, vec3_make(0, 0, 1), down).r == 0); /* behind the panel */
    assert_true(lamp_irradiance(&spot, vec3_make(0, 0, -1), down).r == 0); /* turned away */
    assert_true(lamp_irradiance(&panel, vec3_make(0, 0, -1), down).r == 0);
    assert_true(lamp_irradiance(&spot, vec3_make(2, 0, -1), up).r == 0); /* outside the cone */
    assert_true(lamp_irradiance(&none, vec3_make(0, 0, -1), up).r == 0); /* beta 0 */
    assert_true(lamp_irradiance(&spot, vec3_make(0, 0, 0), up).r == 0);  /* on the lamp */
    assert_true(lamp_irradiance(&panel, vec3_make(0.5, 0.5, 0), up).r == 0);
    assert_true(isfinite(lamp_irradiance(&panel, vec3_make(0.5, 0.5, -1e-12), up).r));
    assert_true(isfinite(lamp_irradiance(&spot, vec3_make(0.1, 0, -1e-12), vec3_make(1, 0, 0)).r));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radiance_ends_at_the_cone),
        cmocka_unit_test(a_disk_above_a_point_has_its_closed_form),
        cmocka_unit_test(a_disk_aside_has_its_closed_form),
        cmocka_unit_test(a_cone_within_a_large_lamp_has_its_closed_form),
        cmocka_unit_test(a_quad_by_polygon_and_by_arcs_agree),
        cmocka_unit_test(a_rectangle_above_its_corner_has_its_closed_form),
        cmocka_unit_test(lamps_cut_by_cone_and_horizon_agree_with_a_plain_sum),
        cmocka_unit_test(dark_points_get_exactly_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
