/* Irradiance by a hemicube against closed forms: form factors, a uniform sphere, a disk, a box, and how errors fall. */
#include "tests/unit/common/light/near.h"

#include "common/base/rng.h"
#include "common/gather/irradiance.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"

static struct hemicube *make(int n)
{
    struct hemicube *h;
    struct err err = ERR_INIT;
    assert_ok(hemicube_make(&h, n, &err), err);
    return h;
}

static struct irradiance gather(int n, const struct light_field *f, struct gather_point p)
{
    struct hemicube *h = make(n);
    struct irradiance e;
    hemicube_irradiance(&e, h, f, p);
    hemicube_free(h);
    return e;
}

static void form_factors_sum_to_one_at_every_n(void **state)
{
    (void)state;
    for (int n = 2; n <= HEMICUBE_MAX; n += 2) {
        struct hemicube *h = make(n);
        assert_near(hemicube_sum(h), 1, 1e-9);
        hemicube_free(h);
    }
}

static void a_resolution_that_is_odd_or_out_of_range_is_refused(void **state)
{
    static const int wrong[] = {-2, 0, 1, 7, 1025, 1026, 1 << 30};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct hemicube *h;
        struct err err = ERR_INIT;
        assert_int_equal(hemicube_make(&h, wrong[i], &err), ST_USAGE);
        assert_null(h);
    }
}

/* -------------------------------------------------------------------------------------------- fields of closed form */

/* Radiance by direction and place, for a single ray. */
typedef struct light_look one_look(const void *ctx, struct vec3 from, struct vec3 direction);

struct scene {
    one_look *look;
    struct vec3 centre, normal; /* of a disk */
    double radius;
    struct vec3 low, high;    /* of a box */
    struct rgb sides[6];      /* -x +x -y +y -z +z */
    struct light_field field; /* its ctx is this struct */
};

static void look_each(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                      const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    const struct scene *s = ctx;
    (void)normal;
    for (int k = 0; k < RAY_PACKET; k++) {
        if (!(active >> k & 1)) continue;
        assert_near(vec3_length(direction[k]), 1, 1e-12);
        seen[k] = s->look(s, from[k], direction[k]);
    }
}

static const struct light_field *field_of(struct scene *s)
{
    s->field = (struct light_field){.ctx = s, .look = look_each};
    return &s->field;
}

static struct light_look uniform_look(const void *ctx, struct vec3 from, struct vec3 direction)
{
    (void)ctx;
    (void)from;
    (void)direction;
    return (struct light_look){rgb_make(1, 2, 0.5), 3, LIGHT_TEXTURE, -1};
}

static struct light_look disk_look(const void *ctx, struct vec3 from, struct vec3 direction)
{
    const struct scene *s = ctx;
    const double t = vec3_dot(vec3_sub(s->centre, from), s->normal) / vec3_dot(direction, s->normal);
    const struct vec3 q = vec3_sub(vec3_add(from, vec3_scale(direction, t)), s->centre);
    if (!(t > 0) || vec3_length(q) > s->radius) return (struct light_look){{0, 0, 0}, INFINITY, LIGHT_NONE, -1};
    return (struct light_look){rgb_grey(1), t, LIGHT_LAMP, -1};
}

static double axis_of(struct vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static struct light_look box_look(const void *ctx, struct vec3 from, struct vec3 direction)
{
    const struct scene *s = ctx;
    struct light_look seen = {{0, 0, 0}, INFINITY, LIGHT_NONE, -1};
    for (int side = 0; side < 6; side++) {
        const double d = axis_of(direction, side / 2);
        const double t = (axis_of(side % 2 ? s->high : s->low, side / 2) - axis_of(from, side / 2)) / d;
        if (d == 0 || (d > 0) != side % 2 || t >= seen.distance) continue;
        seen = (struct light_look){s->sides[side], t, side < 4 ? LIGHT_TEXTURE : LIGHT_SYNTHESISED, -1};
    }
    return seen;
}

/* Lambert's form factor of a polygon above the horizon of a point: 1 / (2 pi) sum of the angles under which its edges
 * are seen, times the cosine between the normal and that of the plane through the edge. */
static double polygon_factor(const struct vec3 *corners, int count, struct gather_point p)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const struct vec3 a = vec3_normalize(vec3_sub(corners[i], p.at));
        const struct vec3 b = vec3_normalize(vec3_sub(corners[(i + 1) % count], p.at)), n = vec3_cross(a, b);
        sum += atan2(vec3_length(n), vec3_dot(a, b)) * vec3_dot(vec3_normalize(n), p.normal);
    }
    return fabs(sum) / (2 * PI);
}

static void a_uniform_sphere_gives_pi_times_its_radiance(void **state)
{
    struct scene s = {.look = uniform_look};
    (void)state;
    for (int n = 2; n <= 64; n *= 2) {
        const struct irradiance e =
            gather(n, field_of(&s), (struct gather_point){{1, 2, 3}, vec3_normalize(vec3_make(1, -2, 0.3))});
        assert_near(e.value.r, PI, 1e-12);
        assert_near(e.value.g, 2 * PI, 1e-12);
        assert_near(e.value.b, 0.5 * PI, 1e-12);
        assert_near(1 + e.error.g, 1, 1e-12);
        assert_near(e.nearest, 3, 0);
        assert_near(e.mean_inverse, 1.0 / 3, 1e-12);
        assert_near(e.from[LIGHT_TEXTURE], 1, 1e-12);
        assert_int_equal(e.rays, 3 * n * n);
    }
}

static void darkness_is_no_light_and_no_nan(void **state)
{
    struct scene s = {.look = disk_look, .centre = {0, 0, -1}, .normal = {0, 0, 1}, .radius = 1};
    const struct irradiance e = gather(32, field_of(&s), (struct gather_point){{0, 0, 0}, {0, 0, 1}});
    (void)state;
    assert_near(e.value.g, 0, 0);
    assert_near(e.error.g, 0, 0);
    assert_true(isinf(e.nearest));
    for (int k = 0; k < LIGHT_SOURCES; k++) assert_near(e.from[k], 0, 0);
}

/* E = pi L sin^2 of the half angle under which a disk is seen from below its middle. */
static double disk_error(double radius, int n, struct vec3 normal)
{
    struct scene s = {.look = disk_look, .centre = vec3_scale(normal, 1), .normal = normal, .radius = radius};
    const double truth = PI * radius * radius / (1 + radius * radius);
    return gather(n, field_of(&s), (struct gather_point){{0, 0, 0}, normal}).value.g / truth - 1;
}

static void a_disk_above_a_patch_has_its_closed_form(void **state)
{
    (void)state;
    assert_near(1 + disk_error(0.5, 512, vec3_make(0, 0, 1)), 1, 1e-3);
    assert_near(1 + disk_error(3, 512, vec3_normalize(vec3_make(1, 2, 3))), 1, 1e-3);
}

/* RMS over disks of many radii: an edge cuts pixels at random, so that of n^2 pixels about n are wrong by a half, and
 * their sum by sqrt(n): the error falls as n^-1.5. */
static void errors_at_edges_fall_as_n_to_the_minus_one_and_a_half(void **state)
{
    const struct rng rng = rng_make(1, "test", "hemicube");
    double squares[2] = {0, 0}, stated[2] = {0, 0};
    (void)state;
    for (uint64_t i = 0; i < 200; i++)
        for (int k = 0; k < 2; k++) {
            const struct vec3 normal = vec3_normalize(
                vec3_make(rng_uniform(&rng, i, 1) - 0.5, rng_uniform(&rng, i, 2) - 0.5, rng_uniform(&rng, i, 3) - 0.5));
            struct scene s = {.look = disk_look, .centre = vec3_add(normal, vec3_make(0.2, -0.1, 0.15))};
            s.normal = vec3_normalize(s.centre);
            s.radius = (0.2 + 0.2 * rng_uniform(&rng, i, 0)) * vec3_length(s.centre);
            const double cosine = vec3_dot(s.normal, normal), t = s.radius / vec3_length(s.centre);
            const double truth = PI * cosine * t * t / (1 + t * t); /* while all of it is above the horizon */
            const struct irradiance e = gather(k ? 128 : 16, field_of(&s), (struct gather_point){{0, 0, 0}, normal});
            squares[k] += (e.value.g / truth - 1) * (e.value.g / truth - 1);
            stated[k] += e.error.g * e.error.g / truth / truth;
        }
    const double order = log(sqrt(squares[0] / squares[1])) / log(8);
    assert_true(order > 1.3 && order < 1.7);
    for (int k = 0; k < 2; k++) assert_true(sqrt(stated[k] / squares[k]) > 0.7 && sqrt(stated[k] / squares[k]) < 2);
}

static struct scene test_box(void)
{
    return (struct scene){.look = box_look,
                          .low = {-1, -2, 0},
                          .high = {3, 1.5, 2.5},
                          .sides = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {0.5, 0.5, 0.5}, {9, 9, 9}, {4, 1, 2}}};
}

/* The irradiance on the floor of a box whose sides have uniform radiances. */
static struct rgb box_truth(const struct scene *s, struct gather_point p)
{
    struct rgb sum = {0, 0, 0};
    for (int side = 0; side < 6; side++) {
        const int axis = side / 2;
        struct vec3 corners[4];
        if (side == 4) continue; /* the floor itself */
        for (int k = 0; k < 4; k++) {
            double c[3];
            c[axis] = axis_of(side % 2 ? s->high : s->low, axis);
            c[(axis + 1) % 3] = axis_of(k == 1 || k == 2 ? s->high : s->low, (axis + 1) % 3);
            c[(axis + 2) % 3] = axis_of(k >= 2 ? s->high : s->low, (axis + 2) % 3);
            corners[k] = vec3_make(c[0], c[1], c[2]);
        }
        sum = rgb_add(sum, rgb_scale(s->sides[side], PI * polygon_factor(corners, 4, p)));
    }
    return sum;
}

static void a_box_agrees_with_polygonal_form_factors(void **state)
{
    static const double places[][2] = {{0, 0}, {2.9, -1.8}, {1.234, 0.777}, {-0.9, 1.4}};
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct scene s = test_box();
        const struct gather_point p = {{places[i][0], places[i][1], 0}, {0, 0, 1}};
        const struct rgb truth = box_truth(&s, p);
        const struct irradiance e = gather(512, field_of(&s), p);
        assert_near(e.value.r, truth.r, 1e-3 * truth.r);
        assert_near(e.value.g, truth.g, 1e-3 * truth.g);
        assert_near(e.value.b, truth.b, 1e-3 * truth.b);
        assert_near(e.from[LIGHT_TEXTURE] + e.from[LIGHT_SYNTHESISED], 1, 1e-12);
        const double ceiling =
            PI * rgb_luminance(s.sides[5]) *
            polygon_factor((struct vec3[]){{-1, -2, 2.5}, {3, -2, 2.5}, {3, 1.5, 2.5}, {-1, 1.5, 2.5}}, 4, p);
        assert_near(e.from[LIGHT_SYNTHESISED], ceiling / rgb_luminance(truth), 5e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(form_factors_sum_to_one_at_every_n),
        cmocka_unit_test(a_resolution_that_is_odd_or_out_of_range_is_refused),
        cmocka_unit_test(a_uniform_sphere_gives_pi_times_its_radiance),
        cmocka_unit_test(darkness_is_no_light_and_no_nan),
        cmocka_unit_test(a_disk_above_a_patch_has_its_closed_form),
        cmocka_unit_test(errors_at_edges_fall_as_n_to_the_minus_one_and_a_half),
        cmocka_unit_test(a_box_agrees_with_polygonal_form_factors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
