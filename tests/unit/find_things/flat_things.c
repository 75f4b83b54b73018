/* Outlines of what lies flat on the faces of a room. */
#include "stages/find_things/flat_things.h"

#include <math.h>
#include <stdlib.h>

#include "tests/unit/box_solids.h"

enum { CORNERS = 4, SIDE = 40 };

#define VOXEL 0.05
#define SLACK 0.025

static const struct box room[] = {{"walls", "in", {-2, -2, 0}, {2, 2, 2.5}, true}};
static const struct model_axes same_frame = {.rotation = {1, 0, 0, 0}, .scale = 1};
static const struct vec3 eye = {0.3, 0.2, 1.5};

/* An outline called rug by points that the eye sees. */
static struct thing_marks outline(const struct vec3 corners[CORNERS])
{
    static char name[] = "rug", view[] = "a", *names[] = {name};
    static int lines[] = {7};
    static bool flat[] = {true};
    static struct thing_mark marks[CORNERS];
    for (int k = 0; k < CORNERS; k++)
        marks[k] = (struct thing_mark){0, 7, view, 10 + k, 20, eye, vec3_sub(corners[k], eye)};
    return (struct thing_marks){names, lines, marks, flat, 1, CORNERS};
}

static enum status try_place(struct flat_things *f, const struct vec3 corners[CORNERS], struct err *err)
{
    const struct thing_marks marks = outline(corners);
    struct model_rays model = make_rays(room, 1);
    flat_things_place(f, &marks, &same_frame, &model, SLACK, err);
    model_rays_release(&model);
    return err->status;
}

static void a_poster_hangs_on_a_wall(void **state)
{
    (void)state;
    static const struct vec3 poster[CORNERS] = {{2, -0.5, 1}, {2, 0.5, 1}, {2, 0.5, 1.6}, {2, -0.5, 1.6}};
    const size_t voxels = (size_t)SIDE * SIDE * SIDE;
    struct thing_volume v = {.grid = {{0.3, -1, 0.3}, VOXEL, {SIDE, SIDE, SIDE}}};
    struct flat_things f;
    struct thing t = {0};
    struct err err = ERR_INIT;
    assert_ok(try_place(&f, poster, &err), err);
    assert_int_equal(f.count, 1);
    assert_float_equal(f.list[0].outline.normal.x, -1, 1e-6); /* into the room */
    v.id = calloc(voxels, sizeof *v.id);
    v.distance = calloc(voxels, sizeof *v.distance);
    assert_true(v.id && v.distance);
    for (size_t i = 0; i < voxels; i++) v.distance[i] = THING_UNSEEN;
    f.list[0].id = 3;
    flat_things_fill(&f, &v);
    const struct vec3 before = vec3_make(1.97, 0, 1.3), behind = vec3_make(2.02, 0, 1.3);
    assert_int_equal(thing_volume_at(&v, before), 3);
    assert_int_equal(thing_volume_at(&v, behind), 3);
    assert_true(v.distance[thing_voxel_at(&v.grid, before)] > 0 && v.distance[thing_voxel_at(&v.grid, behind)] < 0);
    assert_int_equal(thing_volume_at(&v, vec3_make(1.97, 0, 1.75)), 0);
    assert_int_equal(thing_volume_at(&v, vec3_make(1.8, 0, 1.3)), 0);
    assert_ok(flat_thing_measure(&t, &f.list[0], &v, &err), err);
    assert_int_equal(t.outline.count, CORNERS);
    for (int i = 0; i < CORNERS; i++)
        assert_float_equal(vec3_length(vec3_sub(flat_outline_corner(&t.outline, i), poster[i])), 0, 1e-6);
    flat_outline_release(&t.outline);
    assert_int_equal(t.support, THING_ON_WALL);
    assert_float_equal(t.low.x, 2 - VOXEL, 1e-9);
    assert_float_equal(t.high.z, 1.6, 1e-6);
    assert_true(t.voxels > 500);
    flat_things_release(&f);
    thing_volume_release(&v);
}

static void an_outline_is_on_one_face(void **state)
{
    (void)state;
    static const struct vec3 corners[CORNERS] = {{0.5, 0.5, 0}, {1.5, 0.5, 0}, {2, 0.5, 0.4}, {0.5, 1.5, 0}};
    struct flat_things f;
    struct err err = ERR_INIT;
    assert_int_equal(try_place(&f, corners, &err), ST_DATA);
    assert_err(err, ST_DATA,
               "things.txt:7: the corner 12 20 of rug in a is not on the face of the first corner, but 0.4 off");
    assert_null(f.list);
}

static void an_outline_holds_an_area(void **state)
{
    (void)state;
    static const struct vec3 corners[CORNERS] = {{0.5, 0.5, 0}, {0.7, 0.5, 0}, {1, 0.5, 0}, {1.5, 0.5, 0}};
    struct flat_things f;
    struct err err = ERR_INIT;
    assert_int_equal(try_place(&f, corners, &err), ST_DATA);
    assert_err(err, ST_DATA, "things.txt:7: the outline of rug holds no area.");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_poster_hangs_on_a_wall),
        cmocka_unit_test(an_outline_is_on_one_face),
        cmocka_unit_test(an_outline_holds_an_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
