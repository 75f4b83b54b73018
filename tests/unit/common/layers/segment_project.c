/* segment_project.c - projected planes compared with ray intersections, in double precision. */
#include "common/layers/segment_project.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "common/base/rng.h"

enum { W = 40, H = 30 };

static struct view view_make(double focal, struct vec3 center, struct quat turn)
{
    struct view v = {.name = "v", .width = W, .height = H, .fx = focal, .fy = 1.1 * focal, .cx = 19, .cy = 16.5};
    v.cam_from_world = mat3_from_quat(turn);
    v.center = center;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, center), -1);
    return v;
}

static const struct quat straight = {1, 0, 0, 0};

/* Intersection of the ray through a pixel of the novel camera with the plane n . P = 1 in the view's camera
 * coordinates: depth in the novel camera, and pixel and depth in the view. False: not in front of both cameras, or from
 * behind. */
static bool meet(const struct view *view, const struct view *novel, const double p[3], double x, double y,
                 double *depth, double *u, double *v, double *z)
{
    const struct vec3 n = vec3_make(p[0] * view->fx, p[1] * view->fy, p[0] * view->cx + p[1] * view->cy + p[2]);
    const struct mat3 r = mat3_multiply(view->cam_from_world, mat3_transpose(novel->cam_from_world));
    const struct vec3 ray = mat3_apply(r, vec3_make((x - novel->cx) / novel->fx, (y - novel->cy) / novel->fy, 1));
    const struct vec3 origin = mat3_apply(view->cam_from_world, vec3_sub(novel->center, view->center));
    *depth = (1 - vec3_dot(n, origin)) / vec3_dot(n, ray);
    const struct vec3 at = vec3_add(origin, vec3_scale(ray, *depth));
    *z = at.z;
    *u = view->fx * at.x / at.z + view->cx;
    *v = view->fy * at.y / at.z + view->cy;
    return isfinite(*depth) && *depth > 0 && at.z > 0 && vec3_dot(n, origin) < 1 - 1e-5; /* front side */
}

static double row_at(const double row[3], double x, double y) { return row[0] * x + row[1] * y + row[2]; }

/* Checks the projection in all pixels of the novel camera, and that it covers all. Returns the number of visible
 * pixels. */
static int check(const struct view *view, const struct view *novel, const struct depth_segment *segment,
                 const struct segment_shape *shape)
{
    struct view_relation relation;
    struct projected_segment s;
    int count = 0;

    segment_relation_make(&relation, view, novel);
    const bool seen = segment_project(&s, &relation, segment, shape);
    const double center = segment->plane[0] * shape->u + segment->plane[1] * shape->v + segment->plane[2];
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            double depth, u, v, z;
            if (!meet(view, novel, segment->plane, x + 0.5, y + 0.5, &depth, &u, &v, &z)) continue;
            if (!(u > shape->x0 - 0.5 && u < shape->x1 + 1.5 && v > shape->y0 - 0.5 && v < shape->y1 + 1.5)) continue;
            if (z * center > 5e5 || depth < 2e-6 * z) continue; /* outside of the clipped range */
            assert_true(seen);
            assert_true(x >= s.x0 && x <= s.x1 && y >= s.y0 && y <= s.y1);
            const double w = row_at(s.from_target[2], x + 0.5, y + 0.5);
            assert_true(w > 0);
            assert_true(fabs(row_at(s.from_target[0], x + 0.5, y + 0.5) / w - (u + 0.5)) < 1e-6);
            assert_true(fabs(row_at(s.from_target[1], x + 0.5, y + 0.5) / w - (v + 0.5)) < 1e-6);
            assert_true(fabs(row_at(s.inverse_z, x + 0.5, y + 0.5) * depth - 1) < 1e-8);
            assert_true(u + 0.5 >= s.u0 && u + 0.5 <= s.u1 && v + 0.5 >= s.v0 && v + 0.5 <= s.v1);
            count++;
        }
    if (seen) assert_true(s.x0 >= 0 && s.y0 >= 0 && s.x1 < W && s.y1 < H && s.x0 <= s.x1 && s.y0 <= s.y1);
    return count;
}

static const struct segment_shape part = {10, 8, 25, 20, 18, 14.5, 200};

/* The plane through the point of the view's pixel (18, 14.5) at depth z, with slopes a and b of 1/z. */
static struct depth_segment segment_make(double z, double a, double b)
{
    return (struct depth_segment){.id = 1, .plane = {a, b, 1 / z - 18 * a - 14.5 * b}, .sigma = 0.01};
}

static void random_planes_agree_with_rays(void **state)
{
    (void)state;
    const struct rng rng = rng_make(3, "test", "planes");
    int seen = 0, pixels = 0;
    for (uint64_t i = 0; i < 1500; i++) {
        double r[16];
        for (uint64_t k = 0; k < 16; k++) r[k] = 2 * rng_uniform(&rng, i, k) - 1;
        const double z = 4 * exp(r[0]), q = 1 / sqrt(1 + 0.3 * (r[4] * r[4] + r[5] * r[5] + r[6] * r[6]));
        const struct quat turn = {q, sqrt(0.3) * q * r[4], sqrt(0.3) * q * r[5], sqrt(0.3) * q * r[6]};
        const struct view view = view_make(35, vec3_make(r[1], r[2], r[3]), turn);
        const double p = 1 / sqrt(1 + 0.5 * (r[10] * r[10] + r[11] * r[11] + r[12] * r[12]));
        const struct quat other = {p, sqrt(0.5) * p * r[10], sqrt(0.5) * p * r[11], sqrt(0.5) * p * r[12]};
        const struct view novel = view_make(30 + 10 * r[13], vec3_make(2 * r[7], 2 * r[8], 2 * r[9]), other);
        const struct depth_segment s = segment_make(z, 0.02 * r[14], 0.02 * r[15]);
        const int count = check(&view, &novel, &s, &part);
        seen += count > 0;
        pixels += count;
    }
    assert_true(seen > 200 && pixels > 20000);
}

static bool projects(const struct view *view, const struct view *novel, struct depth_segment s)
{
    struct view_relation relation;
    struct projected_segment p;
    segment_relation_make(&relation, view, novel);
    return segment_project(&p, &relation, &s, &part);
}

static void segments_behind_the_camera_are_not_visible(void **state)
{
    (void)state;
    const struct view view = view_make(35, vec3_make(0, 0, 0), straight);
    const struct view beyond = view_make(35, vec3_make(0, 0, 5), straight);
    const struct view turned = view_make(35, vec3_make(0, 0, 0), (struct quat){0, 0, 1, 0});
    assert_true(projects(&view, &view, segment_make(4, 0, 0)));
    assert_false(projects(&view, &beyond, segment_make(4, 0, 0)));
    assert_true(projects(&view, &beyond, segment_make(6, 0, 0)));
    assert_false(projects(&view, &turned, segment_make(4, 0, 0)));
    assert_false(projects(&view, &turned, segment_make(4, 0.01, -0.01)));
}

static void planes_through_the_camera_are_not_visible(void **state)
{
    (void)state;
    const struct view view = view_make(35, vec3_make(0, 0, 0), straight);
    const struct view inside = view_make(35, vec3_make(0.3, -0.2, 4), straight);
    assert_false(projects(&view, &inside, segment_make(4, 0, 0)));
    /* a slanted plane, the camera moved along it until it is in it: at (18, 14.5), depth 4 */
    const struct depth_segment slanted = segment_make(4, 0.01, 0.004);
    const struct view on = view_make(35, view_unproject(&view, 18, 14.5, 4), straight);
    assert_false(projects(&view, &on, slanted));
    /* close to it on both sides: visible only from the view's side, in agreement with rays */
    struct view before = view_make(35, view_unproject(&view, 18, 14.5, 4 - 1e-3), straight);
    struct view behind = view_make(35, view_unproject(&view, 18, 14.5, 4 + 1e-3), straight);
    assert_true(check(&view, &before, &slanted, &part) > 0);
    assert_false(projects(&view, &behind, slanted));
    /* a plane that the view's rays miss, except grazing ones: no depth in the view */
    assert_false(projects(&view, &view, (struct depth_segment){.id = 1, .plane = {0, 0, 0}}));
    assert_false(projects(&view, &view, (struct depth_segment){.id = 1, .plane = {0, 0, -0.25}}));
    assert_false(projects(&view, &view, (struct depth_segment){.id = 1, .plane = {NAN, 0, 0.25}}));
    assert_false(projects(&view, &view, (struct depth_segment){.id = 1, .plane = {0, NAN, INFINITY}}));
}

static void far_and_near_depths_are_exact(void **state)
{
    (void)state;
    static const double depths[] = {1e6, 1e9, 1e-3};
    for (int i = 0; i < 3; i++) {
        const double z = depths[i];
        const struct view view = view_make(35, vec3_make(0, 0, 0), straight);
        const struct view beside = view_make(35, vec3_make(0.1 * z, -0.05 * z, 0.2 * z), straight);
        const struct view same_place = view_make(35, vec3_make(1e-4, 0, 0), straight);
        struct depth_segment s = segment_make(z, 0, 0);
        assert_true(check(&view, &beside, &s, &part) > 100);
        if (z > 1) assert_true(check(&view, &same_place, &s, &part) > 100);
        s = segment_make(z, 0.01 / z, -0.02 / z);
        assert_true(check(&view, &beside, &s, &part) > 100);
    }
}

static void a_segment_without_texels_is_not_visible(void **state)
{
    (void)state;
    const struct view view = view_make(35, vec3_make(0, 0, 0), straight);
    const struct depth_segment s = segment_make(4, 0, 0);
    const struct segment_shape none = {0, 0, -1, 0, 0, 0, 0};
    struct view_relation relation;
    struct projected_segment p;
    segment_relation_make(&relation, &view, &view);
    assert_false(segment_project(&p, &relation, &s, &none));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_planes_agree_with_rays),
        cmocka_unit_test(segments_behind_the_camera_are_not_visible),
        cmocka_unit_test(planes_through_the_camera_are_not_visible),
        cmocka_unit_test(far_and_near_depths_are_exact),
        cmocka_unit_test(a_segment_without_texels_is_not_visible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
