/* Legs of a table on a patterned floor, whose depth is that of the floor. */
#include "stages/find_things/legs.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "tests/unit/box_solids.h"

enum { W = 200, H = 150, PIXELS = W * H, NX = 80, NY = 80, NZ = 40, VIEWS = 8, TABLE = 1 };

#define VOXEL 0.025
#define FAR   6.0 /* half the side of the floor */

static const struct voxel_grid grid = {{-1, -1, 0}, VOXEL, {NX, NY, NZ}};
static const struct vec3 top[2] = {{-0.4, -0.3, 0.4}, {0.4, 0.3, 0.45}};
static const struct vec3 legs_of_table[4][2] = {{{-0.38, -0.28, 0}, {-0.31, -0.21, 0.4}},
                                                {{0.31, -0.28, 0}, {0.38, -0.21, 0.4}},
                                                {{-0.38, 0.21, 0}, {-0.31, 0.28, 0.4}},
                                                {{0.31, 0.21, 0}, {0.38, 0.28, 0.4}}};

/* Where a ray enters a box; infinite: it misses the box. */
static double enter(const struct vec3 box[2], struct vec3 from, struct vec3 along)
{
    double in = -INFINITY, out = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double a = (vec3_axis(box[0], k) - vec3_axis(from, k)) / vec3_axis(along, k),
                     b = (vec3_axis(box[1], k) - vec3_axis(from, k)) / vec3_axis(along, k);
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    return in < out && out > 0 ? in : INFINITY;
}

/* Tiles of random colours, or one colour. */
static void floor_colour(float rgb[3], struct vec3 p, bool plain)
{
    const unsigned tile = (unsigned)(floor(p.x / 0.11) + 100) * 131 + (unsigned)(floor(p.y / 0.11) + 100) * 17;
    for (unsigned c = 0; c < 3; c++) rgb[c] = plain ? 0.4f : 0.1f + 0.1f * (float)((tile * 7919 + c * 104729) / 13 % 8);
}

static struct view camera_of(int i)
{
    const double angle = 0.3 + 2 * M_PI * i / VIEWS;
    const struct vec3 center = vec3_make(1.7 * cos(angle), 1.7 * sin(angle), 1.3 + 0.1 * (i % 3));
    const struct vec3 z = vec3_normalize(vec3_sub(vec3_make(0, 0, 0.15), center));
    const struct vec3 x = vec3_normalize(vec3_cross(z, vec3_make(0, 0, 1))), y = vec3_cross(z, x);
    struct view v = {.name = "view", .width = W, .height = H, .fx = 170, .fy = 170, .cx = W / 2.0, .cy = H / 2.0};
    v.cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v.center = center;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, center), -1);
    return v;
}

struct scene {
    struct view camera;
    struct layered_depth depth;
    struct view_ids ids;
    struct image photo;
};

static void scene_make(struct scene *s, int i, bool with_legs, bool plain)
{
    static const float wood[3] = {0.5f, 0.33f, 0.15f};
    struct err err = ERR_INIT;
    *s = (struct scene){.camera = camera_of(i)};
    assert_ok(layered_depth_init(&s->depth, W, H, &err), err);
    assert_ok(view_ids_init(&s->ids, W, H, &err), err);
    assert_ok(image_init(&s->photo, W, H, 4, &err), err);
    for (int p = 0; p < PIXELS; p++) {
        const struct vec3 along =
            vec3_sub(view_unproject(&s->camera, p % W + 0.5, (int)(p / W) + 0.5, 1), s->camera.center);
        const double down = along.z < 0 ? -s->camera.center.z / along.z : INFINITY,
                     table = enter(top, s->camera.center, along);
        double leg = INFINITY;
        for (int k = 0; k < 4 && with_legs; k++) leg = fmin(leg, enter(legs_of_table[k], s->camera.center, along));
        const struct vec3 at = vec3_add(s->camera.center, vec3_scale(along, down));
        const bool on_floor = fabs(at.x) < FAR && fabs(at.y) < FAR;
        float *rgba = s->photo.data + 4 * p;
        if (on_floor) floor_colour(rgba, at, plain);
        for (int c = 0; c < 3 && (isfinite(table) || isfinite(leg)); c++) rgba[c] = wood[c];
        rgba[3] = 1;
        s->ids.z[p] = on_floor ? (float)down : 0;
        s->ids.clutter[p] = isfinite(table) && table < leg;
        s->depth.interior.z[p] = s->ids.clutter[p] > 0 ? (float)table : s->ids.z[p];
    }
}

static void scene_release(struct scene *s)
{
    layered_depth_release(&s->depth);
    view_ids_release(&s->ids);
    image_release(&s->photo);
}

static struct thing_volume table_volume(void)
{
    const size_t voxels = voxel_count(&grid);
    struct thing_volume v = {grid, calloc(voxels, sizeof *v.id), calloc(voxels, sizeof *v.distance)};
    assert_non_null(v.id);
    assert_non_null(v.distance);
    for (size_t i = 0; i < voxels; i++) {
        const struct vec3 p = thing_voxel_centre(&grid, (int64_t)i);
        v.distance[i] = 1;
        if (fabs(p.x) < top[1].x && fabs(p.y) < top[1].y && p.z > top[0].z && p.z < top[1].z) v.id[i] = TABLE;
    }
    return v;
}

/* Looks for legs in all views; the caller frees *voxels. */
static void look(int64_t **voxels, size_t *count, struct thing_volume *v, bool with_legs, bool plain)
{
    const struct legged table = {TABLE, top[0], top[1], 0};
    struct legs legs;
    struct err err = ERR_INIT;
    assert_ok(legs_init(&legs, v, &table, 1, &err), err);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < VIEWS; i++) {
            struct scene s;
            scene_make(&s, i, with_legs, plain);
            const struct legs_view view = {s.camera, &s.depth, &s.ids, &s.photo, 1};
            if (pass)
                legs_look(&legs, &view);
            else
                legs_learn_floor(&legs, &view);
            scene_release(&s);
        }
        if (!pass) legs_settle(&legs);
    }
    assert_ok(legs_take(voxels, count, &legs, v, &err), err);
    legs_release(&legs);
}

static void find_all_legs(bool plain)
{
    struct thing_volume v = table_volume();
    int64_t *voxels;
    size_t count;
    int of_leg[4] = {0}, beside = 0;
    look(&voxels, &count, &v, true, plain);
    for (size_t i = 0; i < count; i++) {
        const struct vec3 p = thing_voxel_centre(&grid, voxels[i]);
        bool inside = false;
        for (int k = 0; k < 4; k++) {
            const struct vec3 *leg = legs_of_table[k];
            if (p.x < leg[0].x - 2 * VOXEL || p.x > leg[1].x + 2 * VOXEL || p.y < leg[0].y - 2 * VOXEL ||
                p.y > leg[1].y + 2 * VOXEL)
                continue;
            inside = true;
            of_leg[k]++;
        }
        beside += !inside;
        assert_int_equal(v.id[voxels[i]], TABLE);
        assert_true(v.distance[voxels[i]] < 0);
    }
    for (int k = 0; k < 4; k++) assert_in_range(of_leg[k], 50, 500);
    assert_in_range(beside, 0, count / 20);
    free(voxels);
    thing_volume_release(&v);
}

static void all_legs_of_a_table_are_found(void **state)
{
    (void)state;
    find_all_legs(false);
}

static void legs_on_a_plain_floor_are_found(void **state)
{
    (void)state;
    find_all_legs(true);
}

static void a_table_without_legs_gets_none(void **state)
{
    struct thing_volume v = table_volume();
    int64_t *voxels;
    size_t count;
    (void)state;
    look(&voxels, &count, &v, false, false);
    assert_int_equal(count, 0);
    free(voxels);
    thing_volume_release(&v);
}

static void a_box_that_reaches_the_floor_has_no_legs(void **state)
{
    struct thing_volume v = table_volume();
    const struct legged box = {TABLE, {-0.4, -0.3, 0}, {0.4, 0.3, 0.05}, 0};
    struct legs legs;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(legs_init(&legs, &v, &box, 1, &err), err);
    assert_int_equal(legs.count, 0);
    legs_release(&legs);
    thing_volume_release(&v);
}

static void legs_are_the_same_for_any_number_of_threads(void **state)
{
    int64_t *voxels[2];
    size_t count[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct thing_volume v = table_volume();
        parallel_set_threads(k ? 3 : 1);
        look(&voxels[k], &count[k], &v, true, false);
        thing_volume_release(&v);
    }
    parallel_set_threads(0);
    assert_int_equal(count[0], count[1]);
    assert_memory_equal(voxels[0], voxels[1], count[0] * sizeof *voxels[0]);
    free(voxels[0]);
    free(voxels[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_legs_of_a_table_are_found),
        cmocka_unit_test(legs_on_a_plain_floor_are_found),
        cmocka_unit_test(a_table_without_legs_gets_none),
        cmocka_unit_test(a_box_that_reaches_the_floor_has_no_legs),
        cmocka_unit_test(legs_are_the_same_for_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
