/* placed_things.c - which things an edit takes from their places, where it puts them, and what does not fit there. */
#include "common/relight/placed_things.h"

#include "stages/render_model/clutter_filter.h"

#include "tests/unit/box_solids.h"

/* Of the boxes, ROOM_INSIDE has its floor at -2 and its walls at -2 and 2; a step of 0.5 covers its western half. */
static const struct box plain[] = {ROOM_OUTSIDE, ROOM_INSIDE};
static const struct box stepped[] = {
    ROOM_OUTSIDE, ROOM_INSIDE, {"step", "step", {-2.5, -2.5, -2.5}, {-0.25, 2.5, -1.5}, false}};
static const struct box thin[] = {
    ROOM_OUTSIDE, ROOM_INSIDE, {"new", "new", {-1.3, -1, -2.5}, {-1.15, 2.5, 2.5}, false}};
static const struct box walled[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"new", "new", {-1.5, -1, -2.5}, {-1, 2.5, 2.5}, false}};

enum { SOFA = 1, PICTURE, LAMP, BIRD };

static const struct provenance no_inputs = {.stage = "test", .version = "1"};

/* What no test here looks at: voxels, views, radiance; and nothing lies flat. */
#define SEEN \
    10, 1, (char *)"a", {0, 0, 9, 9}, {0}, {{0}}, { .count = 0 }

static void write_list(void)
{
    static const struct thing things[] = {
        {(char *)"sofa", THING_ON_FLOOR, {0.2, -0.4, -2}, {1.4, 0.4, -1.2}, SEEN},
        {(char *)"picture", THING_ON_WALL, {1.9, -0.5, -0.5}, {2, 0.5, 0.5}, SEEN},
        {(char *)"lamp", THING_ON_CEILING, {0.3, 0.5, 1}, {0.7, 0.9, 2}, SEEN},
        {(char *)"bird", THING_ON_NONE, {0.5, 1.5, 0}, {0.7, 1.7, 0.2}, SEEN},
        /* its outline reaches below the floor */
        {(char *)"mat", THING_ON_FLOOR, {-1, 1, -2.2}, {-0.5, 1.5, -1.7}, SEEN},
    };
    struct thing_list list = {(struct thing *)things, 5};
    struct err err = ERR_INIT;
    assert_ok(thing_list_write(&list, scratch_path("things/things.txt"), &no_inputs, &err), err);
}

/* Three voxels next to each other along y, in the room's southern corner, are of each thing. */
static void write_volume(void)
{
    static uint32_t id[8 * 8 * 8];
    static float distance[8 * 8 * 8];
    struct thing_volume volume = {{{-2, -2, -2}, 0.5, {8, 8, 8}}, id, distance};
    struct err err = ERR_INIT;
    for (uint32_t k = SOFA; k <= BIRD; k++)
        for (int y = 0; y < 3; y++) id[8 * y + (int)k] = k;
    for (int y = 4; y < 8; y++) { /* the sofa's margin, in a wall */
        id[8 * y + SOFA] = SOFA;
        distance[8 * y + SOFA] = 1;
    }
    assert_ok(thing_volume_write(&volume, scratch_path("things/volume.exr"), &no_inputs, &err), err);
}

static struct vec3 in_voxel(uint32_t k) { return vec3_make(-2 + 0.5 * (k + 0.5), -1.75, -1.75); }

static int write_things(void **state)
{
    if (scratch_make(state)) return -1;
    mkdir(scratch_path("things"), 0777);
    write_list();
    write_volume();
    return 0;
}

static enum status try_read(struct placed_things *t, const struct texture_thing *edits, int count,
                            const struct box *before, int before_count, const struct box *after, int after_count,
                            struct err *err)
{
    const struct texture_map map = {.things = (struct texture_thing *)edits, .thing_count = count};
    struct model_rays models[2] = {make_rays(before, before_count), make_rays(after, after_count)};
    placed_things_read(t, scratch_path("things"), &map, &models[0], &models[1], NULL, err);
    for (int k = 0; k < 2; k++) model_rays_release(&models[k]);
    return err->status;
}

static struct placed_things read_in(const struct texture_thing *edits, int count, const struct box *boxes,
                                    int box_count)
{
    struct placed_things t;
    struct err err = ERR_INIT;
    assert_ok(try_read(&t, edits, count, boxes, box_count, boxes, box_count, &err), err);
    return t;
}

static struct texture_thing edit_of(enum texture_thing_kind kind, const char *name, double x, double y, double z,
                                    double turn)
{
    return (struct texture_thing){kind, (char *)name, (char *)name, {x, y, z}, turn, (char *)"e.txt", 2};
}

static void refused_in(const struct texture_thing *edit, const struct box *after, int count, const char *words)
{
    struct placed_things t;
    struct err err = ERR_INIT;
    assert_int_equal(try_read(&t, edit, 1, plain, 2, after, count, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
    assert_true(!t.fate && !t.placed && !t.placed_count && !t.list.count && !t.volume.id);
}

static void move_refused(const char *name, double x, double y, double z, double turn, const char *words)
{
    const struct texture_thing edit = edit_of(TEXTURE_THING_MOVE, name, x, y, z, turn);
    refused_in(&edit, plain, 2, words);
}

static void move_allowed(const char *name, double x, double y, double z, double turn)
{
    const struct texture_thing edit = edit_of(TEXTURE_THING_MOVE, name, x, y, z, turn);
    struct placed_things t = read_in(&edit, 1, plain, 2);
    assert_int_equal(t.placed_count, 1);
    placed_things_release(&t);
}

/* Where the placed thing has a point of the photographs' room. */
static struct vec3 placed_at(const struct placed_thing *p, double x, double y, double z)
{
    return vec3_add(mat3_apply(p->turn, vec3_make(x, y, z)), p->shift);
}

static void assert_at(struct vec3 p, double x, double y, double z)
{
    assert_float_equal(vec3_length(vec3_sub(p, vec3_make(x, y, z))), 0, 1e-5); /* the list has six digits */
}

/* ------------------------------------------------------------------------------------------------------------ fates */

static void an_edit_without_things_reads_nothing(void **state)
{
    struct placed_things t;
    struct texture_map map = {0};
    struct err err = ERR_INIT;
    (void)state;
    for (int k = 0; k < 2; k++) {
        assert_ok(placed_things_read(&t, NULL, k ? &map : NULL, NULL, NULL, NULL, &err), err);
        const struct clutter_filter filter = clutter_filter_of(&t, k ? &map : NULL);
        assert_false(clutter_filter_is_needed(&filter));
        assert_false(clutter_filter_drops(&filter, in_voxel(SOFA)));
        placed_things_release(&t);
    }
}

static void each_thing_stays_is_kept_or_is_gone(void **state)
{
    const struct texture_thing edits[] = {
        edit_of(TEXTURE_THING_CLEAR, "sofa", 0, 0, 0, 0),
        edit_of(TEXTURE_THING_KEEP, "picture", 0, 0, 0, 0),
        {TEXTURE_THING_MOVE, (char *)"second", (char *)"lamp", {-1, 0, 0}, 0, (char *)"e.txt", 2}, /* a copy */
        edit_of(TEXTURE_THING_MOVE, "bird", 0, -1, 0, 0),
    };
    struct placed_things t = read_in(edits, 4, plain, 2);
    (void)state;
    assert_int_equal(t.fate[0], THING_STAYS);
    assert_int_equal(t.fate[SOFA], THING_IS_GONE);
    assert_int_equal(t.fate[PICTURE], THING_IS_KEPT);
    assert_int_equal(t.fate[LAMP], THING_STAYS);
    assert_int_equal(t.fate[BIRD], THING_IS_GONE);
    assert_int_equal(t.placed_count, 2);
    assert_int_equal(t.placed[0].id, LAMP);
    assert_int_equal(t.placed[1].id, BIRD);
    placed_things_release(&t);
    placed_things_release(&t);
    placed_things_release(NULL);
}

static void a_filter_drops_what_is_gone_and_what_zones_clear(void **state)
{
    const struct texture_thing edits[] = {edit_of(TEXTURE_THING_CLEAR, "sofa", 0, 0, 0, 0),
                                          edit_of(TEXTURE_THING_KEEP, "picture", 0, 0, 0, 0)};
    double square[4][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    struct texture_zone zone = {.low = -3, .high = 3, .corners = square, .corner_count = 4};
    const struct texture_map map = {.zones = &zone, .zone_count = 1};
    struct placed_things t = read_in(edits, 2, plain, 2);
    struct clutter_filter filter = clutter_filter_of(&t, NULL);
    const struct vec3 of_none = vec3_make(1, 1, 1), outside = vec3_make(-9, 0, 0);
    (void)state;
    assert_true(clutter_filter_is_needed(&filter));
    assert_true(clutter_filter_drops(&filter, in_voxel(SOFA)));
    assert_false(clutter_filter_drops(&filter, in_voxel(PICTURE)) || clutter_filter_drops(&filter, in_voxel(LAMP)));
    assert_false(clutter_filter_drops(&filter, of_none) || clutter_filter_drops(&filter, outside));
    filter = clutter_filter_of(&t, &map);
    assert_true(clutter_filter_drops(&filter, in_voxel(SOFA)) && clutter_filter_drops(&filter, in_voxel(LAMP)));
    assert_true(clutter_filter_drops(&filter, of_none));
    assert_false(clutter_filter_drops(&filter, in_voxel(PICTURE)) || clutter_filter_drops(&filter, outside));
    filter.only = SOFA; /* as a thing at its new place is drawn */
    assert_false(clutter_filter_drops(&filter, in_voxel(SOFA)));
    assert_true(clutter_filter_drops(&filter, in_voxel(PICTURE)) && clutter_filter_drops(&filter, of_none));
    placed_things_release(&t);
}

/* The volume reaches from -2 to 2, so 0.85 of its height is at 1.4. Lamps and beams are the room's own, and their depth
 * is never sure. */
static void a_zone_leaves_what_is_of_no_thing_at_the_ceiling(void **state)
{
    const struct texture_thing edit = edit_of(TEXTURE_THING_CLEAR, "sofa", 0, 0, 0, 0);
    double square[4][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    struct texture_zone zone = {.low = -3, .high = 3, .corners = square, .corner_count = 4};
    const struct texture_map map = {.zones = &zone, .zone_count = 1};
    struct placed_things t = read_in(&edit, 1, plain, 2);
    const struct clutter_filter filter = clutter_filter_of(&t, &map);
    (void)state;
    assert_true(clutter_filter_drops(&filter, vec3_make(1, 1, 1.35)));
    assert_false(clutter_filter_drops(&filter, vec3_make(1, 1, 1.45)));
    assert_false(clutter_filter_drops(&filter, vec3_make(1, 1, 2.5)));
    t.volume.id[thing_voxel_at(&t.volume.grid, vec3_make(1, 1, 1.75))] = SOFA; /* that thing is gone at any height */
    assert_true(clutter_filter_drops(&filter, vec3_make(1, 1, 1.75)));
    placed_things_release(&t);
}

static void a_zone_clears_things_of_which_it_holds_more_than_half(void **state)
{
    double square[4][2] = {{-2, -2}, {2, -2}, {2, 0}, {-2, 0}};
    struct texture_zone zone = {.low = -3, .high = 3, .corners = square, .corner_count = 4};
    struct texture_thing edits[] = {edit_of(TEXTURE_THING_KEEP, "sofa", 0, 0, 0, 0),
                                    edit_of(TEXTURE_THING_CLEAR, "lamp", 0, 0, 0, 0)};
    struct texture_map map = {.zones = &zone, .zone_count = 1, .things = edits};
    struct model_rays model = make_rays(plain, 2);
    struct placed_things t;
    struct err err = ERR_INIT;
    (void)state;
    for (int voxels = 0; voxels <= 3; voxels++)
        for (map.thing_count = 0; map.thing_count <= 2; map.thing_count += 2) {
            square[2][1] = square[3][1] = -2 + 0.5 * voxels;
            square[0][1] = square[1][1] = voxels ? -2 : -3; /* an area beside the things */
            assert_ok(placed_things_read(&t, scratch_path("things"), &map, &model, &model, NULL, &err), err);
            const enum thing_fate fate = voxels > 1 ? THING_IS_GONE : voxels ? THING_IS_KEPT : THING_STAYS;
            /* statements about a thing come before zones */
            assert_int_equal(t.fate[SOFA], map.thing_count ? THING_IS_KEPT : fate);
            /* it hangs from the ceiling, so no zone takes it */
            assert_int_equal(t.fate[LAMP], map.thing_count ? THING_IS_GONE : voxels ? THING_IS_KEPT : THING_STAYS);
            assert_int_equal(t.fate[PICTURE], fate);
            assert_int_equal(t.fate[0], THING_STAYS);
            placed_things_release(&t);
        }
    map.thing_count = 0;
    assert_ok(placed_things_read(&t, NULL, &map, &model, &model, NULL, &err), err);
    assert_null(t.fate);
    model_rays_release(&model);
}

static void zones_alone_need_a_filter_too(void **state)
{
    struct texture_zone zone = {.high = 1};
    struct texture_map map = {.zones = &zone};
    struct placed_things none = {0};
    (void)state;
    struct clutter_filter filter = clutter_filter_of(&none, &map);
    assert_false(clutter_filter_is_needed(&filter));
    map.zone_count = 1;
    assert_true(clutter_filter_is_needed(&filter));
}

/* ------------------------------------------------------------------------------------------------------------ places
 * */

static void a_moved_thing_is_shifted_and_turned_about_its_middle(void **state)
{
    const struct texture_thing edits[] = {edit_of(TEXTURE_THING_MOVE, "sofa", -1, 0.5, 0, 0),
                                          edit_of(TEXTURE_THING_MOVE, "bird", -1, -1, 0.25, 90)};
    struct placed_things t = read_in(edits, 2, plain, 2);
    (void)state;
    assert_at(placed_at(&t.placed[0], 0.2, -0.4, -2), -0.8, 0.1, -2);
    assert_at(placed_at(&t.placed[0], 1.4, 0.4, -1.2), 0.4, 0.9, -1.2);
    /* from above counter-clockwise: what was to the east is to the north */
    assert_at(placed_at(&t.placed[1], 0.6, 1.6, 0.1), -0.4, 0.6, 0.35);
    assert_at(placed_at(&t.placed[1], 0.7, 1.6, 0.2), -0.4, 0.7, 0.45);
    placed_things_release(&t);
}

static void a_placed_thing_has_its_middle_at_a_point_of_the_floor(void **state)
{
    struct texture_thing edit = edit_of(TEXTURE_THING_PLACE, "sofa", -1, 0.25, -1.5, 90);
    struct placed_things t = read_in(&edit, 1, stepped, 3);
    (void)state;
    assert_at(placed_at(&t.placed[0], 0.8, 0, -2), -1, 0.25, -1.5);
    assert_at(placed_at(&t.placed[0], 1.4, 0, -1.2), -1, 0.85, -0.7);
    placed_things_release(&t);
    /* what stood on no floor stays as high above it */
    edit = edit_of(TEXTURE_THING_PLACE, "bird", -1, -1, -1.5, 0);
    t = read_in(&edit, 1, stepped, 3);
    assert_at(placed_at(&t.placed[0], 0.6, 1.6, 0), -1, -1, 0.5);
    placed_things_release(&t);
}

static void its_camera_sees_a_point_where_the_moved_point_is(void **state)
{
    const struct texture_thing edits[] = {edit_of(TEXTURE_THING_MOVE, "sofa", -0.75, 0.5, 0.1, 35),
                                          edit_of(TEXTURE_THING_PLACE, "sofa", -1, -0.5, -2, -120)};
    const struct view camera = view_at(vec3_make(0.3, -0.4, -3), 0.2, -0.1, 160, 120, 130);
    struct placed_things t = read_in(edits, 2, plain, 2);
    (void)state;
    assert_int_equal(t.placed_count, 2);
    for (int i = 0; i < 2; i++) {
        const double turn = edits[i].turn * M_PI / 180, *by = edits[i].by;
        const double to[2][2] = {{0.8 + by[0], by[1]}, {by[0], by[1]}}, up = i ? 0 : by[2];
        const struct view moved = placed_thing_camera(&t.placed[i], &camera);
        assert_true(moved.width == camera.width && moved.fx == camera.fx && moved.cy == camera.cy);
        assert_float_equal(vec3_length(vec3_add(mat3_apply(moved.cam_from_world, moved.center), moved.translation)), 0,
                           1e-12);
        for (int k = 0; k < 8; k++) {
            const struct vec3 p = vec3_make(k & 1 ? 1.4 : 0.2, k & 2 ? 0.4 : -0.4, k & 4 ? -1.2 : -2);
            const double x = p.x - 0.8, y = p.y; /* from the footprint's middle */
            const struct vec3 q =
                vec3_make(to[i][0] + cos(turn) * x - sin(turn) * y, to[i][1] + sin(turn) * x + cos(turn) * y, p.z + up);
            double u[2], v[2];
            const double z = view_project(&camera, q, &u[0], &v[0]);
            assert_float_equal(view_project(&moved, p, &u[1], &v[1]), z, 1e-5);
            assert_float_equal(u[0], u[1], 1e-3);
            assert_float_equal(v[0], v[1], 1e-3);
        }
    }
    placed_things_release(&t);
}

/* --------------------------------------------------------------------------------------------------------- refusals */

static void a_thing_does_not_stand_in_a_wall(void **state)
{
    const struct texture_thing
        moved = edit_of(TEXTURE_THING_MOVE, "sofa", -2.05, 0.5, 0, 0),
        placed = edit_of(TEXTURE_THING_PLACE, "sofa", -1.25, 0.5, -2, 0),
        across = edit_of(TEXTURE_THING_MOVE, "sofa", -1.9, 0.5, 0, 0),
        copy = {TEXTURE_THING_MOVE, (char *)"twin", (char *)"sofa", {0.9, 0, 0}, 0, (char *)"e.txt", 2};
    (void)state;
    /* nine tenths of the sofa, which is 1.2 long, reach to 2.24 */
    move_refused("sofa", 0.9, 0, 0, 0, "e.txt:2: sofa would stand at least 0.24 deep in a wall, a box or a floor");
    refused_in(&copy, plain, 2, "e.txt:2: twin would stand at least 0.24 deep");
    move_refused("bird", 1.6, 0, 0, 0, "e.txt:2: bird would stand at least 0.29 deep");
    move_refused("sofa", 0.2, 1.55, 0, 90, "e.txt:2: sofa would stand at least 0.09 deep"); /* turned it is too long */
    move_allowed("sofa", 0.2, 1.55, 0, 0);
    /* there is a wall in the edited model alone */
    refused_in(&moved, walled, 3, "e.txt:2: sofa would stand at least 0.17 deep");
    refused_in(&placed, walled, 3, "e.txt:2: sofa would stand at least 0.17 deep");
    /* both ends of the sofa are free of this one */
    refused_in(&across, thin, 3, "deep in a wall");
    move_refused("sofa", 0, 0, -0.5, 0, "e.txt:2: sofa would be 0.5 too far into the floor that it stands on");
}

static void outlines_may_touch_a_wall(void **state)
{
    (void)state;
    move_allowed("sofa", 0.64, 0, 0, 0); /* its box reaches to 2.04, nine tenths of it to 1.98 */
    move_allowed("mat", 0.5, 0, 0, 30);
    move_refused("mat", -1.2, 0, 0, 0, "e.txt:2: mat would stand at least");
}

static void what_stood_on_the_floor_stands_on_a_floor(void **state)
{
    const struct texture_thing on_step = edit_of(TEXTURE_THING_MOVE, "sofa", -1.8, 0, 0.5, 0);
    struct placed_things t;
    struct err err = ERR_INIT;
    (void)state;
    move_refused("sofa", 0, 0, 0.5, 0, "e.txt:2: sofa would be 0.5 away from the floor that it stands on");
    move_refused("sofa", 10, 0, 0, 0, "e.txt:2: sofa stood on the floor, but there is no floor at its new place");
    move_allowed("sofa", 0, 0, 0.1, 0); /* within 0.03 of the model's height, which is 6 */
    assert_ok(try_read(&t, &on_step, 1, plain, 2, stepped, 3, &err), err);
    placed_things_release(&t);
}

static void what_hung_on_a_wall_or_the_ceiling_hangs_there_again(void **state)
{
    const struct texture_thing north = edit_of(TEXTURE_THING_PLACE, "picture", 0, 1.95, -2, 90);
    struct placed_things t = read_in(&north, 1, plain, 2);
    (void)state;
    assert_at(placed_at(&t.placed[0], 2, 0.5, 0), -0.5, 2, 0);
    placed_things_release(&t);
    move_refused("picture", -1, 0, 0, 0, "e.txt:2: picture would be 1 away from the wall that it hangs on");
    move_refused("picture", 0, 0, 0, 180, "e.txt:2: picture would be 3.9 away from the wall");
    move_allowed("picture", 0, 1, 1, 0);
    move_refused("lamp", 0, 0, -0.75, 0, "e.txt:2: lamp would be 0.75 away from the ceiling that it hangs on");
    move_allowed("lamp", -1, -1, 0, 45);
    move_allowed("bird", 0, 0, -1, 0); /* it hung in the air */
}

static void unknown_things_are_named_with_their_nearest(void **state)
{
    static const enum texture_thing_kind kinds[] = {TEXTURE_THING_CLEAR, TEXTURE_THING_KEEP, TEXTURE_THING_MOVE,
                                                    TEXTURE_THING_PLACE};
    (void)state;
    for (int k = 0; k < 4; k++) {
        const struct texture_thing edit = edit_of(kinds[k], "sofaa", 0, 0, 0, 0);
        refused_in(&edit, plain, 2,
                   "e.txt:2: the edit changes sofaa, but no thing of that name was found; the nearest is sofa.");
    }
    const struct texture_thing edit = edit_of(TEXTURE_THING_CLEAR, "wardrobe", 0, 0, 0, 0);
    refused_in(&edit, plain, 2, "e.txt:2: the edit changes wardrobe, but no thing of that name was found. ");
}

static void the_folder_of_things_must_be_given_and_there(void **state)
{
    const struct texture_thing edit = edit_of(TEXTURE_THING_CLEAR, "sofa", 0, 0, 0, 0);
    const struct texture_map map = {.things = (struct texture_thing *)&edit, .thing_count = 1};
    struct model_rays model = make_rays(plain, 2);
    struct placed_things t;
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(placed_things_read(&t, NULL, &map, &model, &model, NULL, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "the edit changes the thing sofa, but --things is missing");
    assert_null(t.fate);
    err = (struct err)ERR_INIT;
    assert_int_not_equal(placed_things_read(&t, scratch_path("nowhere"), &map, &model, &model, NULL, &err), ST_OK);
    assert_contains(err.text, "nowhere/things.txt");
    assert_null(t.fate);
    model_rays_release(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edit_without_things_reads_nothing),
        cmocka_unit_test(each_thing_stays_is_kept_or_is_gone),
        cmocka_unit_test(a_filter_drops_what_is_gone_and_what_zones_clear),
        cmocka_unit_test(a_zone_leaves_what_is_of_no_thing_at_the_ceiling),
        cmocka_unit_test(a_zone_clears_things_of_which_it_holds_more_than_half),
        cmocka_unit_test(zones_alone_need_a_filter_too),
        cmocka_unit_test(a_moved_thing_is_shifted_and_turned_about_its_middle),
        cmocka_unit_test(a_placed_thing_has_its_middle_at_a_point_of_the_floor),
        cmocka_unit_test(its_camera_sees_a_point_where_the_moved_point_is),
        cmocka_unit_test(a_thing_does_not_stand_in_a_wall),
        cmocka_unit_test(outlines_may_touch_a_wall),
        cmocka_unit_test(what_stood_on_the_floor_stands_on_a_floor),
        cmocka_unit_test(what_hung_on_a_wall_or_the_ceiling_hangs_there_again),
        cmocka_unit_test(unknown_things_are_named_with_their_nearest),
        cmocka_unit_test(the_folder_of_things_must_be_given_and_there),
    };
    return cmocka_run_group_tests(tests, write_things, scratch_remove);
}
