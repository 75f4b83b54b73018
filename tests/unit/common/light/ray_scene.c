/* Rays against a box, triangles and disks: analytic hits, packets against single rays, occlusion, and hard cases. */
#include "tests/unit/common/light/near.h"

#include "common/base/rng.h"
#include "common/light/frame.h"
#include "common/light/ray_scene.h"
#include "common/math/numbers.h"

#define NO_HIT 999

static struct vec3 random_vector(const struct rng *rng, uint64_t i, uint64_t k)
{
    return vec3_make(2 * rng_uniform(rng, i, k) - 1, 2 * rng_uniform(rng, i, k + 1) - 1,
                     2 * rng_uniform(rng, i, k + 2) - 1);
}

static double axis_of(struct vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/* The box from `low` to `high`: two triangles a side with the ids 10, 11 (-x, +x), 12 .. 15; normals point outwards. */
static void add_box(struct ray_scene *s, struct vec3 low, struct vec3 high)
{
    struct err err = ERR_INIT;
    for (int side = 0; side < 6; side++) {
        const int a = side / 2, b = (a + 1) % 3;
        struct vec3 corner[4];
        for (int k = 0; k < 4; k++) {
            /* around the side in the order that is right-handed about the positive axis */
            const int u = k == 1 || k == 2, v = k >= 2;
            const double at[3] = {side % 2, u, v};
            double p[3];
            for (int axis = 0; axis < 3; axis++) {
                const double t = axis == a ? at[0] : axis == b ? at[1] : at[2];
                p[axis] = axis_of(t > 0 ? high : low, axis);
            }
            corner[k] = vec3_make(p[0], p[1], p[2]);
        }
        const struct vec3 *c = corner;
        const struct vec3 out[2][3] = {{c[0], c[1], c[2]}, {c[0], c[2], c[3]}};
        const struct vec3 in[2][3] = {{c[0], c[2], c[1]}, {c[0], c[3], c[2]}};
        for (int k = 0; k < 2; k++)
            assert_ok(ray_scene_add_triangle(s, side % 2 ? out[k] : in[k], (uint32_t)(10 + side), &err), err);
    }
}

static struct ray_scene box_scene(struct vec3 low, struct vec3 high)
{
    struct ray_scene s = {0};
    struct err err = ERR_INIT;
    add_box(&s, low, high);
    assert_ok(ray_scene_commit(&s, &err), err);
    return s;
}

/* Where a ray from inside a box leaves it: t and the side. *margin: the distance from there to the side's nearest
 * edge. */
static double leave_box(struct vec3 low, struct vec3 high, struct vec3 from, struct vec3 direction, int *side,
                        double *margin)
{
    double t = INFINITY;
    for (int a = 0; a < 3; a++) {
        const double d = axis_of(direction, a), wall = axis_of(d > 0 ? high : low, a);
        if (d == 0 || (wall - axis_of(from, a)) / d >= t) continue;
        t = (wall - axis_of(from, a)) / d;
        *side = 2 * a + (d > 0);
    }
    const struct vec3 p = vec3_add(from, vec3_scale(direction, t));
    *margin = INFINITY;
    for (int a = 0; a < 3; a++)
        if (a != *side / 2)
            *margin = fmin(*margin, fmin(axis_of(p, a) - axis_of(low, a), axis_of(high, a) - axis_of(p, a)));
    return t;
}

static const struct vec3 low = {-1, -2, 0}, high = {3, 1, 2.5};

static void rays_in_a_box_hit_its_sides(void **state)
{
    (void)state;
    struct ray_scene s = box_scene(low, high);
    const struct rng rng = rng_make(1, "test", "box");
    for (uint64_t i = 0; i < 20000; i++) {
        const struct vec3 from = {0.5 + rng_uniform(&rng, i, 0), -1 + rng_uniform(&rng, i, 1),
                                  1 + rng_uniform(&rng, i, 2)};
        const struct vec3 direction = vec3_normalize(random_vector(&rng, i, 3));
        struct ray_hit hit;
        double margin;
        int side = 0;
        const double t = leave_box(low, high, from, direction, &side, &margin);
        assert_true(ray_scene_hit(&s, from, direction, &hit)); /* it is closed: no ray escapes */
        assert_near(hit.t, t, margin > 1e-5 ? 1e-12 : 1e-5);
        if (margin < 1e-5) continue;
        assert_int_equal(hit.id, 10 + side);
        assert_false(hit.front); /* from inside: the back */
        assert_near(axis_of(hit.normal, side / 2), side % 2 ? -1 : 1, 1e-12);
        assert_true(vec3_length(vec3_sub(hit.point, vec3_add(from, vec3_scale(direction, hit.t)))) < 1e-12);
        assert_true(ray_scene_blocked(&s, from, direction, t * 1.001) &&
                    ray_scene_blocked(&s, from, direction, INFINITY));
        assert_false(ray_scene_blocked(&s, from, direction, t * 0.999));
    }
    ray_scene_release(&s);
    ray_scene_release(&s);
}

static void front_and_back_are_distinguished(void **state)
{
    (void)state;
    struct ray_scene s = box_scene(low, high);
    struct ray_hit hit;
    assert_true(ray_scene_hit(&s, vec3_make(-5, 0, 1), vec3_make(1, 0.01, 0.02), &hit));
    assert_true(hit.id == 10 && hit.front && hit.normal.x == -1);
    assert_near(hit.t, 4, 1e-12);
    assert_true(ray_scene_hit(&s, vec3_make(1, 0, 1), vec3_make(-1, 0.01, 0.02), &hit));
    assert_true(hit.id == 10 && !hit.front && hit.normal.x == 1);
    assert_false(ray_scene_hit(&s, vec3_make(-5, 0, 1), vec3_make(-1, 0, 0), &hit));
    ray_scene_release(&s);
}

/* Moeller and Trumbore's test, in double precision; *margin: the least barycentric coordinate. */
static bool hit_triangle(const struct vec3 p[3], struct vec3 from, struct vec3 direction, double *t, double *margin)
{
    const struct vec3 a = vec3_sub(p[1], p[0]), b = vec3_sub(p[2], p[0]), h = vec3_cross(direction, b);
    const double det = vec3_dot(a, h);
    const struct vec3 s = vec3_sub(from, p[0]), q = vec3_cross(s, a);
    const double u = vec3_dot(s, h) / det, v = vec3_dot(direction, q) / det;
    *t = vec3_dot(b, q) / det;
    *margin = fmin(u, fmin(v, 1 - u - v));
    return *margin > 0 && *t > 0;
}

static void rays_hit_the_nearest_of_many_triangles(void **state)
{
    (void)state;
    enum { TRIANGLES = 300, RAYS = 4000 };
    const struct rng rng = rng_make(2, "test", "triangles");
    struct vec3 corner[TRIANGLES][3];
    struct ray_scene s = {0};
    struct err err = ERR_INIT;
    int hits = 0;
    for (uint64_t i = 0; i < TRIANGLES; i++) {
        const struct vec3 middle = random_vector(&rng, i, 0);
        for (uint64_t k = 0; k < 3; k++)
            corner[i][k] = vec3_add(middle, vec3_scale(random_vector(&rng, i, 3 + 3 * k), 0.2));
        assert_ok(ray_scene_add_triangle(&s, corner[i], (uint32_t)(7 * i), &err), err);
    }
    assert_ok(ray_scene_commit(&s, &err), err);
    for (uint64_t i = 0; i < RAYS; i++) {
        const struct vec3 from = vec3_scale(vec3_normalize(random_vector(&rng, i, 20)), 3);
        const struct vec3 direction = vec3_sub(random_vector(&rng, i, 30), from);
        double nearest = INFINITY, closest_edge = INFINITY;
        uint32_t id = NO_HIT;
        for (uint32_t k = 0; k < TRIANGLES; k++) {
            double t, margin;
            const bool hit = hit_triangle(corner[k], from, direction, &t, &margin);
            closest_edge = fmin(closest_edge, fabs(margin));
            if (hit && t < nearest) nearest = t, id = 7 * k;
        }
        struct ray_hit hit;
        if (closest_edge < 1e-4) continue; /* single precision may decide otherwise */
        assert_int_equal(ray_scene_hit(&s, from, direction, &hit), id != NO_HIT);
        assert_int_equal(ray_scene_blocked(&s, from, direction, INFINITY), id != NO_HIT);
        if (id == NO_HIT) continue;
        hits++;
        assert_int_equal(hit.id, id);
        assert_near(hit.t, nearest, 1e-6); /* at grazing angles Embree's distance is kept */
        assert_true(vec3_dot(hit.normal, direction) < 0);
    }
    assert_true(hits > RAYS / 4);
    ray_scene_release(&s);
}

/* A box, a floor and two disks: what both kinds of rays are compared in. */
static struct ray_scene furnished_scene(void)
{
    struct ray_scene s = {0};
    struct err err = ERR_INIT;
    add_box(&s, low, high);
    add_box(&s, vec3_make(0, -1, 0), vec3_make(0.5, -0.5, 0.7));
    assert_ok(ray_scene_add_disk(&s, vec3_make(1, 0, 2.4), vec3_make(0, 0, -2), 0.4, 77, &err), err);
    assert_ok(ray_scene_add_disk(&s, vec3_make(2.9, 0, 1), vec3_make(-1, 0.3, 0), 0.3, 78, &err), err);
    assert_ok(ray_scene_commit(&s, &err), err);
    return s;
}

static void packets_agree_with_single_rays(void **state)
{
    (void)state;
    struct ray_scene s = furnished_scene();
    const struct rng rng = rng_make(3, "test", "packets");
    int seen[100] = {0}, same = 0, rays = 0;
    for (uint64_t i = 0; i < 4000; i++) {
        struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
        struct ray_hit hits[RAY_PACKET], hit;
        double t_max[RAY_PACKET];
        const bool coherent = i % 2; /* from one point, in a narrow bundle */
        const unsigned active = i % 3 ? 0xff : (unsigned)(i / 3) & 0xff;
        for (uint64_t k = 0; k < RAY_PACKET; k++) {
            const uint64_t a = coherent ? i : i * RAY_PACKET + k;
            from[k] = vec3_add(vec3_make(1, -0.5, 1.2), vec3_scale(random_vector(&rng, a, 0), 0.9));
            direction[k] = vec3_add(random_vector(&rng, a, 10), vec3_scale(random_vector(&rng, i * 8 + k, 20), 0.02));
            t_max[k] = 3 * rng_uniform(&rng, i * 8 + k, 30);
            if (active >> k & 1) continue;
            from[k] = direction[k] = vec3_make(NAN, NAN, NAN); /* not to be read */
            t_max[k] = NAN;
        }
        for (int k = 0; k < RAY_PACKET; k++) hits[k].id = NO_HIT;
        const unsigned found = ray_scene_hit_packet(&s, from, direction, active, hits);
        const unsigned blocked = ray_scene_blocked_packet(&s, from, direction, t_max, active);
        assert_int_equal(found & ~active, 0);
        assert_int_equal(blocked & ~active, 0);
        for (int k = 0; k < RAY_PACKET; k++) {
            if (!(found >> k & 1)) assert_int_equal(hits[k].id, NO_HIT);
            if (!(active >> k & 1)) continue;
            rays++;
            assert_int_equal(ray_scene_hit(&s, from[k], direction[k], &hit), found >> k & 1);
            assert_int_equal(ray_scene_blocked(&s, from[k], direction[k], t_max[k]), blocked >> k & 1);
            if (!(found >> k & 1)) continue;
            seen[hit.id]++;
            same += hit.id == hits[k].id && hit.t == hits[k].t && hit.front == hits[k].front &&
                    !memcmp(&hit.normal, &hits[k].normal, sizeof hit.normal);
        }
    }
    for (int id = 10; id < 16; id++) assert_true(seen[id] > 100);
    assert_true(seen[77] > 20 && seen[78] > 20);
    if (same != rays) fail_msg("%d of %d rays differ", rays - same, rays);
    ray_scene_release(&s);
}

/* A direction with 1 along the camera's axis gives the depth along that axis: constant over a wall that faces the
 * camera. */
static void t_of_a_pinhole_ray_is_depth(void **state)
{
    (void)state;
    struct ray_scene s = box_scene(low, high);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 24; x += RAY_PACKET) {
            struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
            struct ray_hit hit[RAY_PACKET];
            for (int k = 0; k < RAY_PACKET; k++) {
                from[k] = vec3_make(-0.5, -0.3, 1.1);
                direction[k] = vec3_make(1, (x + k - 11.5) / 60, (y - 9.5) / 60);
            }
            assert_int_equal(ray_scene_hit_packet(&s, from, direction, 0xff, hit), 0xff);
            for (int k = 0; k < RAY_PACKET; k++) {
                assert_int_equal(hit[k].id, 11);
                assert_near(hit[k].t, 3.5, 1e-12);
                assert_true(hit[k].normal.x == -1);
            }
        }
    ray_scene_release(&s);
}

static void disks_are_round(void **state)
{
    (void)state;
    struct ray_scene s = {0};
    struct err err = ERR_INIT;
    const struct vec3 centre = {1, 2, 3}, normal = {1, -2, 0.5};
    const struct vec3 wall[3] = {{-100, -100, -5}, {100, -100, -5}, {0, 200, -5}};
    struct vec3 x, y, z = vec3_normalize(normal);
    assert_ok(ray_scene_add_disk(&s, centre, normal, 0.5, 4, &err), err);
    assert_ok(ray_scene_add_triangle(&s, wall, 5, &err), err);
    assert_ok(ray_scene_commit(&s, &err), err);
    frame_from_normal(z, &x, &y);
    for (int i = 0; i < 720; i++) {
        const double radius = i % 2 ? 0.4999 : 0.5001, a = i * 0.5 * DEGREE;
        const struct vec3 off = vec3_add(vec3_scale(x, radius * cos(a)), vec3_scale(y, radius * sin(a)));
        const struct vec3 through = vec3_add(centre, off), direction = vec3_make(0.1, 0.1, -1);
        const struct vec3 from = vec3_sub(through, vec3_scale(direction, 2));
        struct ray_hit hit, packet[RAY_PACKET];
        struct vec3 origins[RAY_PACKET], directions[RAY_PACKET];
        for (int k = 0; k < RAY_PACKET; k++) origins[k] = from, directions[k] = direction;
        assert_true(ray_scene_hit(&s, from, direction, &hit));
        assert_int_equal(ray_scene_hit_packet(&s, origins, directions, 0x81, packet), 0x81);
        assert_int_equal(hit.id, i % 2 ? 4 : 5); /* outside the radius, what is behind */
        assert_int_equal(packet[0].id, hit.id);
        assert_int_equal(packet[7].id, hit.id);
        assert_int_equal(ray_scene_blocked(&s, from, direction, 3), i % 2);
        if (hit.id == 4) assert_near(hit.t, 2, 1e-12);
        if (hit.id == 4) assert_true(hit.front == (vec3_dot(direction, z) < 0));
    }
    ray_scene_release(&s);
}

/* Rays to the edges, diagonals and corners of a closed box hit it: nothing shows between two triangles. */
static void no_ray_slips_through_an_edge(void **state)
{
    (void)state;
    struct ray_scene s = box_scene(low, high);
    const struct rng rng = rng_make(4, "test", "edges");
    for (uint64_t i = 0; i < 4000; i++) {
        struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
        struct ray_hit hits[RAY_PACKET], hit;
        for (uint64_t k = 0; k < RAY_PACKET; k++) {
            /* between two random corners of the box: edges, diagonals of sides, corners */
            const uint32_t a = rng_u32(&rng, i, 2 * k) % 8, b = a ^ (1u << rng_u32(&rng, i, 2 * k + 1) % 3);
            const double t = k % 4 ? rng_uniform(&rng, i, 50 + k) : 0;
            const struct vec3 p = {a & 1 ? high.x : low.x, a & 2 ? high.y : low.y, a & 4 ? high.z : low.z};
            const struct vec3 q = {b & 1 ? high.x : low.x, b & 2 ? high.y : low.y, b & 4 ? high.z : low.z};
            from[k] = vec3_add(vec3_make(1, -0.5, 1.2), vec3_scale(random_vector(&rng, i, 80), 0.5));
            direction[k] = vec3_sub(vec3_add(p, vec3_scale(vec3_sub(q, p), t)), from[k]);
            assert_true(ray_scene_hit(&s, from[k], direction[k], &hit));
            assert_true(fabs(hit.t - 1) < 1e-5);
            assert_true(isfinite(hit.point.x) && isfinite(hit.normal.x));
        }
        assert_int_equal(ray_scene_hit_packet(&s, from, direction, 0xff, hits), 0xff);
        for (int k = 0; k < RAY_PACKET; k++) assert_true(fabs(hits[k].t - 1) < 1e-5);
    }
    ray_scene_release(&s);
}

/* In the plane of a triangle there is no distance to it; along its edge there may be a hit. Numbers stay finite. */
static void rays_in_the_plane_of_a_triangle_give_finite_numbers(void **state)
{
    (void)state;
    struct ray_scene s = {0};
    struct err err = ERR_INIT;
    const struct vec3 corner[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, flat[3] = {{5, 5, 5}, {6, 6, 6}, {7, 7, 7}};
    const struct {
        struct vec3 from, direction;
    } rays[] = {
        {{-1, 0, 0}, {1, 0, 0}},          {{2, 0, 0}, {-1, 0, 0}},     {{-1, -1, 0}, {1, 1, 0}},
        {{0.2, 0.2, 0}, {1, 0.3, 0}},     {{0.2, 0.2, 0}, {0, 0, 1}},  {{-1, 0.1, 0}, {1, 0, 1e-9}},
        {{0, 0, 1}, {0, 0, -1}},          {{0, 0, 0}, {0, 0, 1}},      {{5, 5, 4}, {1, 1, 2}},
        {{-1, 0.3, 1e-8}, {1, 0, -1e-8}}, {{0.5, 0.5, 1}, {0, 0, -1}}, {{0, -1, 0}, {0, 1, 0}},
    };
    assert_ok(ray_scene_add_triangle(&s, corner, 1, &err), err);
    assert_ok(ray_scene_add_triangle(&s, flat, 2, &err), err); /* no area: never hit */
    assert_ok(ray_scene_commit(&s, &err), err);
    for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
        struct ray_hit hit;
        if (!ray_scene_hit(&s, rays[i].from, rays[i].direction, &hit)) continue;
        assert_int_equal(hit.id, 1);
        assert_true(isfinite(hit.t) && hit.t >= 0 && isfinite(vec3_length(hit.point)));
        assert_near(fabs(hit.normal.z), 1, 1e-12);
    }
    ray_scene_release(&s);
}

static void rays_that_begin_epsilon_off_a_surface_do_not_hit_it(void **state)
{
    (void)state;
    for (double far = 0; far < 2000; far += 400) { /* where single precision is coarse */
        const struct vec3 shift = {far, -far / 2, far / 3}, from_low = vec3_add(low, shift),
                          from_high = vec3_add(high, shift);
        struct ray_scene s = box_scene(from_low, from_high);
        const struct rng rng = rng_make(5, "test", "epsilon");
        assert_near(s.epsilon, 4e-6 * fmax(fabs(from_high.x), fmax(fabs(from_low.y), from_high.z)), 1e-12);
        for (uint64_t i = 0; i < 2000; i++) {
            const struct vec3 middle = vec3_scale(vec3_add(from_low, from_high), 0.5);
            struct ray_hit hit;
            assert_true(ray_scene_hit(&s, middle, random_vector(&rng, i, 0), &hit));
            const struct vec3 start = vec3_add(hit.point, vec3_scale(hit.normal, s.epsilon));
            struct vec3 direction = vec3_normalize(random_vector(&rng, i, 3));
            if (vec3_dot(direction, hit.normal) < 0) direction = vec3_scale(direction, -1);
            double margin;
            int side = 0;
            const double t = leave_box(from_low, from_high, start, direction, &side, &margin);
            if (t < 0.01) continue; /* near an edge of the box */
            assert_false(ray_scene_blocked(&s, start, direction, t * 0.99 - s.epsilon));
        }
        ray_scene_release(&s);
    }
}

static void nothing_is_hit_in_an_empty_scene(void **state)
{
    (void)state;
    struct ray_scene s = {0};
    struct err err = ERR_INIT;
    struct ray_hit hit, hits[RAY_PACKET];
    struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
    double t_max[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++)
        from[k] = vec3_make(k, 0, 0), direction[k] = vec3_make(0, k + 1, 1), t_max[k] = INFINITY;
    assert_ok(ray_scene_commit(&s, &err), err);
    assert_false(ray_scene_hit(&s, from[0], direction[0], &hit));
    assert_false(ray_scene_blocked(&s, from[0], direction[0], INFINITY));
    assert_int_equal(ray_scene_hit_packet(&s, from, direction, 0xff, hits), 0);
    assert_int_equal(ray_scene_blocked_packet(&s, from, direction, t_max, 0xff), 0);
    ray_scene_release(&s);
    ray_scene_release(&s);
    ray_scene_release(NULL);
    assert_null(s.embree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_in_a_box_hit_its_sides),
        cmocka_unit_test(front_and_back_are_distinguished),
        cmocka_unit_test(rays_hit_the_nearest_of_many_triangles),
        cmocka_unit_test(packets_agree_with_single_rays),
        cmocka_unit_test(t_of_a_pinhole_ray_is_depth),
        cmocka_unit_test(disks_are_round),
        cmocka_unit_test(no_ray_slips_through_an_edge),
        cmocka_unit_test(rays_in_the_plane_of_a_triangle_give_finite_numbers),
        cmocka_unit_test(rays_that_begin_epsilon_off_a_surface_do_not_hit_it),
        cmocka_unit_test(nothing_is_hit_in_an_empty_scene),
    };
    return cmocka_run_group_tests_name("light ray_scene", tests, NULL, NULL);
}
