/* light_things.c - the furniture that light meets before and after an edit, and where moved furniture was. */
#include "common/relight/light_things.h"

#include "common/model/thing_mesh.h"
#include "tests/unit/box_solids.h"

/* ROOM_INSIDE has its floor at -2 and its walls at -2 and 2. The things are balls, each in a corner of its own. */
static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE};
/* A wall hides the western half; the room goes on behind it. */
static const struct box walled[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"new", "new", {-1.9, -2, -2}, {-1.8, 2, 2}, false}};

enum { SOFA = 1, PICTURE, LAMP, BIRD, UNSEEN, THINGS = UNSEEN, SIDE = 40 };

#define VOXEL  0.1
#define RADIUS 0.3
#define TOP    3.0 /* more red radiance of what faces up */

static const struct provenance no_inputs = {.stage = "test", .version = "1"};
static const struct vec3 middles[THINGS] = {{1, 0, -1.6}, {1.5, 1, 0}, {0.5, -1, 1.5}, {-1, 1, 0}, {-1, -1, -1}};

static void write_list(void)
{
    static const char *const names[THINGS] = {"sofa", "picture", "lamp", "bird", "unseen"};
    static const enum thing_support supports[THINGS] = {THING_ON_FLOOR, THING_ON_WALL, THING_ON_CEILING, THING_ON_NONE,
                                                        THING_ON_NONE};
    struct thing things[THINGS];
    const struct thing_list list = {things, THINGS};
    struct err err = ERR_INIT;
    for (int k = 0; k < THINGS; k++) {
        const struct vec3 half = vec3_make(RADIUS, RADIUS, RADIUS);
        things[k] = (struct thing){.name = (char *)names[k],
                                   .support = supports[k],
                                   .low = vec3_sub(middles[k], half),
                                   .high = vec3_add(middles[k], half),
                                   .voxels = 10,
                                   .views = 1,
                                   .view = (char *)"a",
                                   .radiance = {k + 1, 0.5, 0.25 * k}};
        for (int n = 0; n < THING_SIDES; n++) memcpy(things[k].sides[n], things[k].radiance, sizeof things[k].sides[n]);
        things[k].sides[4][0] = k + 1 + TOP;
    }
    assert_ok(thing_list_write(&list, scratch_path("things/things.txt"), &no_inputs, &err), err);
}

/* No view has seen the surface of the last thing. */
static void write_volume(void)
{
    static uint32_t id[SIDE * SIDE * SIDE];
    static float distance[SIDE * SIDE * SIDE];
    const struct thing_volume v = {{{-2, -2, -2}, VOXEL, {SIDE, SIDE, SIDE}}, id, distance};
    struct err err = ERR_INIT;
    for (int64_t i = 0; i < SIDE * SIDE * SIDE; i++) {
        distance[i] = THING_UNSEEN;
        for (uint32_t k = SOFA; k <= THINGS; k++) {
            const double d = vec3_length(vec3_sub(thing_voxel_centre(&v.grid, i), middles[k - 1])) - RADIUS;
            if (d >= 2 * VOXEL) continue;
            id[i] = k;
            if (k != UNSEEN) distance[i] = (float)fmax(-1, d / (2 * VOXEL));
        }
    }
    assert_ok(thing_volume_write(&v, scratch_path("things/volume.exr"), &no_inputs, &err), err);
}

static void write_model(const char *name, const struct box *boxes, int count)
{
    struct solid_mesh mesh = make_boxes(boxes, count);
    struct err err = ERR_INIT;
    assert_ok(solid_mesh_write(&mesh, scratch_path(name), NULL, &err), err);
    solid_mesh_release(&mesh);
}

static int write_things(void **state)
{
    if (scratch_make(state)) return -1;
    mkdir(scratch_path("things"), 0777);
    write_list();
    write_volume();
    write_model("room.txt", room, 2);
    write_model("walled.txt", walled, 3);
    return 0;
}

static struct texture_thing edit_of(enum texture_thing_kind kind, const char *name, double x, double y, double turn)
{
    return (struct texture_thing){kind, (char *)name, (char *)name, {x, y, 0}, turn, (char *)"e.txt", 2};
}

static enum status try_read(struct light_things *t, const char *folder, const struct texture_map *map,
                            const char *after, struct err *err)
{
    return light_things_read(t, folder, map, false, scratch_path("room.txt"), scratch_path(after), NULL, err);
}

static struct light_things read_map(const struct texture_map *map)
{
    struct light_things t;
    struct err err = ERR_INIT;
    assert_ok(try_read(&t, scratch_path("things"), map, "room.txt", &err), err);
    return t;
}

static struct light_things read_edits(struct texture_thing *edits, int count)
{
    return read_map(&(struct texture_map){.things = edits, .thing_count = count});
}

static int triangles_of(uint32_t id)
{
    struct thing_volume v;
    struct thing_mesh m;
    struct err err = ERR_INIT;
    assert_ok(thing_volume_read(&v, scratch_path("things/volume.exr"), THINGS, NULL, &err), err);
    assert_ok(thing_mesh_make(&m, &v, id, &err), err);
    const int count = m.triangle_count;
    thing_mesh_release(&m);
    thing_volume_release(&v);
    return count;
}

/* The number of triangles whose corners are all on the ball of a thing, if its middle is there. They have the thing's
 * radiance on both sides, more of red where they face up, and face outwards. Things turn about the vertical alone. */
static int count_at(const struct thing_surfaces *s, uint32_t id, struct vec3 middle)
{
    int count = 0;
    for (int i = 0; i < s->count; i++) {
        const struct vec3 *p = s->triangles[i];
        bool on = true;
        for (int k = 0; k < 3; k++) on &= fabs(vec3_length(vec3_sub(p[k], middle)) - RADIUS) < 0.5 * VOXEL;
        if (!on) continue;
        const struct vec3 normal = vec3_normalize(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
        for (int side = 0; side < 2; side++) {
            const struct rgb r = s->radiance[i][side];
            assert_float_equal(r.r, id + TOP * fmax(normal.z, 0) * fmax(normal.z, 0), 1e-6);
            assert_float_equal(r.g, 0.5, 1e-9);
            assert_float_equal(r.b, 0.25 * (id - 1), 1e-9);
        }
        assert_true(vec3_dot(normal, vec3_sub(p[0], middle)) > 0);
        count++;
    }
    return count;
}

/* These surfaces are those of the things at their own places, and nothing else, but for `more` triangles. */
static void assert_things(const struct thing_surfaces *s, const uint32_t *ids, int count, int more)
{
    int sum = more;
    for (uint32_t id = SOFA; id <= THINGS; id++) {
        bool wanted = false;
        for (int k = 0; k < count; k++) wanted |= ids[k] == id;
        assert_int_equal(count_at(s, id, middles[id - 1]), wanted ? triangles_of(id) : 0);
        sum += wanted ? triangles_of(id) : 0;
    }
    assert_int_equal(s->count, sum);
}

static const uint32_t all[] = {SOFA, PICTURE, BIRD}; /* the lamp hangs from the ceiling */

static void balls_have_triangles(void **state)
{
    (void)state;
    for (uint32_t id = SOFA; id <= BIRD; id++) assert_true(triangles_of(id) > 100);
    assert_int_equal(triangles_of(UNSEEN), 0);
}

static void what_is_cleared_is_there_before_alone(void **state)
{
    (void)state;
    struct texture_thing edit = edit_of(TEXTURE_THING_CLEAR, "sofa", 0, 0, 0);
    struct light_things t = read_edits(&edit, 1);
    assert_true(t.changes);
    assert_things(&t.before, all, 3, 0);
    assert_things(&t.after, all + 1, 2, 0);
    light_things_release(&t);
    assert_true(!t.changes && !t.before.triangles && !t.after.radiance && !t.placed.fate);
    light_things_release(&t);
}

static void what_is_moved_is_at_its_new_place_after(void **state)
{
    (void)state;
    struct texture_thing edit = edit_of(TEXTURE_THING_MOVE, "bird", 0.75, -0.5, 30);
    struct light_things t = read_edits(&edit, 1);
    const struct vec3 to = vec3_add(middles[BIRD - 1], vec3_make(0.75, -0.5, 0));
    assert_true(t.changes);
    assert_things(&t.before, all, 3, 0);
    assert_int_equal(count_at(&t.before, BIRD, to), 0);
    assert_things(&t.after, all, 2, triangles_of(BIRD));
    assert_int_equal(count_at(&t.after, BIRD, to), triangles_of(BIRD));
    light_things_release(&t);
}

static void a_copy_is_there_beside_its_thing(void **state)
{
    (void)state;
    struct texture_thing edit = {
        TEXTURE_THING_MOVE, (char *)"twin", (char *)"bird", {0, -1.5, 0}, 0, (char *)"e.txt", 2};
    struct light_things t = read_edits(&edit, 1);
    const struct vec3 to = vec3_add(middles[BIRD - 1], vec3_make(0, -1.5, 0));
    assert_true(t.changes);
    assert_things(&t.before, all, 3, 0);
    assert_things(&t.after, all, 3, triangles_of(BIRD));
    assert_int_equal(count_at(&t.after, BIRD, to), triangles_of(BIRD));
    light_things_release(&t);
}

/* A zone over the whole room takes all that no statement keeps. The lamp is at the ceiling, so it is in neither. */
static void a_zone_takes_what_it_does_not_keep(void **state)
{
    (void)state;
    double square[4][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    struct texture_zone zone = {.low = -3, .high = 3, .corners = square, .corner_count = 4};
    struct texture_thing edit = edit_of(TEXTURE_THING_KEEP, "picture", 0, 0, 0);
    struct texture_map map = {.zones = &zone, .zone_count = 1, .things = &edit, .thing_count = 1};
    struct light_things t = read_map(&map);
    const uint32_t kept = PICTURE;
    assert_true(t.changes);
    assert_things(&t.before, all, 3, 0);
    assert_things(&t.after, &kept, 1, 0);
    light_things_release(&t);
}

static void what_hangs_from_the_ceiling_is_left_out_even_if_it_moves(void **state)
{
    (void)state;
    struct texture_thing edit = edit_of(TEXTURE_THING_MOVE, "lamp", 0.5, 0, 0);
    struct light_things t = read_edits(&edit, 1);
    assert_true(t.changes);
    assert_things(&t.before, all, 3, 0);
    assert_things(&t.after, all, 3, 0);
    light_things_release(&t);
}

static void assert_unchanged(const char *folder, const struct texture_map *map)
{
    struct light_things t;
    struct vec3 was;
    struct err err = ERR_INIT;
    assert_ok(try_read(&t, folder, map, "room.txt", &err), err);
    assert_true(!t.changes && !t.before.count && !t.after.count);
    assert_null(light_things_moved(&was, &t, middles[0]));
    light_things_release(&t);
}

/* Light is then gathered as without things, and costs as much. */
static void an_edit_that_changes_no_thing_has_no_surfaces(void **state)
{
    (void)state;
    double square[4][2] = {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}};
    struct texture_zone zone = {.low = -3, .high = 3, .corners = square, .corner_count = 4};
    struct texture_thing keep = edit_of(TEXTURE_THING_KEEP, "sofa", 0, 0, 0),
                         clear = edit_of(TEXTURE_THING_CLEAR, "sofa", 0, 0, 0);
    const char *folder = scratch_path("things");
    assert_unchanged(folder, &(struct texture_map){0});
    assert_unchanged(folder, &(struct texture_map){.things = &keep, .thing_count = 1});
    assert_unchanged(folder, &(struct texture_map){.zones = &zone, .zone_count = 1}); /* there is nothing in it */
    assert_unchanged(NULL, &(struct texture_map){.things = &clear, .thing_count = 1});
}

static void a_thing_that_does_not_fit_is_refused(void **state)
{
    (void)state;
    struct texture_thing edit = edit_of(TEXTURE_THING_MOVE, "bird", -0.8, 0, 0);
    const struct texture_map map = {.things = &edit, .thing_count = 1};
    struct light_things t;
    struct err err = ERR_INIT;
    assert_int_equal(try_read(&t, scratch_path("things"), &map, "walled.txt", &err), ST_DATA);
    assert_err(err, ST_DATA, "e.txt:2: bird would stand at least");
    assert_true(!t.changes && !t.before.count && !t.after.count);
    light_things_release(&t);
}

/* ------------------------------------------------------------------------------------------------------------ moved */

static void moved_places_are_found_where_they_were(void **state)
{
    (void)state;
    struct texture_thing edits[] = {edit_of(TEXTURE_THING_MOVE, "bird", 1, 0.25, 90),
                                    edit_of(TEXTURE_THING_MOVE, "sofa", -0.5, 0.25, -45)};
    struct light_things t = read_edits(edits, 2);
    assert_int_equal(t.placed.placed_count, 2);
    for (int k = 0; k < 2; k++) {
        const uint32_t id = k ? SOFA : BIRD;
        const struct vec3 from = middles[id - 1];
        for (int axis = 0; axis < 6; axis++) {
            const double sign = axis % 2 ? 1 : -1;
            const struct vec3 at =
                vec3_add(from, vec3_make(axis < 2 ? sign * RADIUS : 0, axis >= 2 && axis < 4 ? sign * RADIUS : 0,
                                         axis >= 4 ? sign * RADIUS : 0));
            struct vec3 was;
            const struct vec3 to = placed_thing_place(&t.placed.placed[k], at);
            assert_float_equal(
                vec3_length(vec3_sub(to, vec3_make(from.x + edits[k].by[0], from.y + edits[k].by[1], from.z))), RADIUS,
                1e-6);
            assert_ptr_equal(light_things_moved(&was, &t, to), &t.placed.placed[k]);
            assert_float_equal(vec3_length(vec3_sub(was, at)), 0, 1e-9);
        }
    }
    light_things_release(&t);
}

static void what_has_not_moved_to_a_place_is_not_found_there(void **state)
{
    (void)state;
    struct texture_thing edit = edit_of(TEXTURE_THING_MOVE, "bird", 1, 0.25, 90);
    struct light_things t = read_edits(&edit, 1);
    struct vec3 was;
    assert_null(light_things_moved(&was, &t, middles[BIRD - 1]));    /* its old place */
    assert_null(light_things_moved(&was, &t, middles[SOFA - 1]));    /* a thing that stays */
    assert_null(light_things_moved(&was, &t, vec3_make(0, 0.5, 0))); /* beside its new place */
    assert_null(light_things_moved(&was, &t, vec3_make(9, 9, 9)));
    light_things_release(&t);
}

static void the_things_of_a_scene_are_surfaces_but_what_hangs_from_the_ceiling(void **state)
{
    static const uint32_t shown[] = {SOFA, PICTURE, BIRD, UNSEEN};
    struct thing_surfaces s;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(thing_surfaces_read(&s, scratch_path("things"), NULL, &err), err);
    assert_things(&s, shown, 4, 0);
    const struct field_surfaces field = thing_surfaces_of_field(&s);
    assert_int_equal(field.triangles.count, s.count);
    assert_true(field.radiance == (const struct rgb(*)[2])s.radiance);
    thing_surfaces_release(&s);
    thing_surfaces_read(&s, scratch_path("nothing"), NULL, &err);
    assert_err(err, ST_IO, "things.txt");
    thing_surfaces_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_things_of_a_scene_are_surfaces_but_what_hangs_from_the_ceiling),
        cmocka_unit_test(balls_have_triangles),
        cmocka_unit_test(what_is_cleared_is_there_before_alone),
        cmocka_unit_test(what_is_moved_is_at_its_new_place_after),
        cmocka_unit_test(a_copy_is_there_beside_its_thing),
        cmocka_unit_test(a_zone_takes_what_it_does_not_keep),
        cmocka_unit_test(what_hangs_from_the_ceiling_is_left_out_even_if_it_moves),
        cmocka_unit_test(an_edit_that_changes_no_thing_has_no_surfaces),
        cmocka_unit_test(a_thing_that_does_not_fit_is_refused),
        cmocka_unit_test(moved_places_are_found_where_they_were),
        cmocka_unit_test(what_has_not_moved_to_a_place_is_not_found_there),
    };
    return cmocka_run_group_tests_name("light_things", tests, write_things, scratch_remove);
}
