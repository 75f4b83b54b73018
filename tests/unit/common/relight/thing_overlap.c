/* thing_overlap.c - things that would stand in each other: boxes whose overlap is known, and what an edit is told. */
#include "common/relight/thing_overlap.h"
#include "common/relight/placed_things.h"

#include "tests/unit/box_solids.h"

/* The room is from -2 to 2 in each direction, with its floor at -2. */
static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE};

enum { SIDE = 80, CHEST = 1, BED, CORNER, RUG, THINGS = RUG };
#define VOXEL (4.0 / SIDE)

static const char *const names[THINGS] = {"chest", "bed", "corner", "rug"};
/* The corner is a sofa about an empty square: two boxes. The rug is flat, but its voxels are coarse. */
static const struct {
    uint32_t id;
    struct vec3 low, high;
} blocks[] = {
    {RUG, {-1.6, -1.6, -2}, {1.7, 0.6, -2 + 4 * VOXEL}},
    {CHEST, {-1.5, -1.5, -2}, {-1, -1.2, -1.5}},
    {BED, {0, -1.5, -2}, {1.6, 0.5, -1.4}},
    {CORNER, {-1.8, 1, -2}, {0, 1.8, -1.2}},
    {CORNER, {-1.8, -0.5, -2}, {-1.2, 1, -1.2}},
};

static bool in_block(size_t k, struct vec3 p)
{
    const struct vec3 a = blocks[k].low, b = blocks[k].high;
    return p.x > a.x && p.x < b.x && p.y > a.y && p.y < b.y && p.z > a.z && p.z < b.z;
}

/* Blocks of solid voxels. Everything in the list is owned, so that it is released like one that was read. */
static struct placed_things furnish(void)
{
    static const double rug[][2] = {{-1.6, -1.6}, {1.7, -1.6}, {1.7, 0.6}, {-1.6, 0.6}};
    struct placed_things t = {.volume = {.grid = {{-2, -2, -2}, VOXEL, {SIDE, SIDE, SIDE}}}};
    struct err err = ERR_INIT;
    t.volume.id = calloc(SIDE * SIDE * SIDE, sizeof *t.volume.id);
    t.volume.distance = calloc(SIDE * SIDE * SIDE, sizeof *t.volume.distance);
    assert_true(t.volume.id && t.volume.distance);
    for (int64_t i = 0; i < SIDE * SIDE * SIDE; i++) {
        const struct vec3 p = thing_voxel_centre(&t.volume.grid, i);
        t.volume.distance[i] = THING_UNSEEN;
        for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++)
            if (in_block(k, p)) t.volume.id[i] = blocks[k].id, t.volume.distance[i] = -1;
    }
    for (uint32_t id = 1; id <= THINGS; id++) {
        struct thing thing = {.name = strdup(names[id - 1]),
                              .view = strdup("a"),
                              .support = THING_ON_FLOOR,
                              .low = {2, 2, 2},
                              .high = {-2, -2, -2},
                              .voxels = 9};
        for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) {
            if (blocks[k].id != id) continue;
            const struct vec3 a = blocks[k].low, b = blocks[k].high;
            thing.low = vec3_make(fmin(thing.low.x, a.x), fmin(thing.low.y, a.y), fmin(thing.low.z, a.z));
            thing.high = vec3_make(fmax(thing.high.x, b.x), fmax(thing.high.y, b.y), fmax(thing.high.z, b.z));
        }
        if (id == RUG) {
            thing.low = vec3_make(-1.6, -1.6, -2);
            thing.high = vec3_make(1.7, 0.6, -2 + VOXEL);
            assert_ok(flat_outline_init(&thing.outline, vec3_make(0, 0, 1), -2, 4, &err), err);
            for (int i = 0; i < 4; i++) flat_outline_put(&thing.outline, i, vec3_make(rug[i][0], rug[i][1], -2));
        }
        assert_ok(thing_list_add(&t.list, &thing, &err), err);
    }
    return t;
}

static struct placed_thing at(uint32_t id, double turn, double x, double y, double z)
{
    const double c = cos(turn * M_PI / 180), s = sin(turn * M_PI / 180);
    return (struct placed_thing){.id = id, .turn = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}, .shift = {x, y, z}};
}

/* The depth to which a thing that is shifted stands in another one at its old place. */
static double depth_in(uint32_t id, uint32_t other, double x, double y, double z)
{
    struct placed_things t = furnish();
    const struct placed_thing a = at(id, 0, x, y, z);
    struct err err = ERR_INIT;
    double depth;
    assert_ok(thing_overlap_depth(&depth, &t.volume, &a, NULL, other, &err), err);
    placed_things_release(&t);
    return depth;
}

/* ----------------------------------------------------------------------------------------------------------- depths */

static void boxes_overlap_by_their_least_side(void **state)
{
    (void)state;
    /* the chest is 0.5 x 0.3 x 0.5, from -1.5; the bed begins at 0 */
    assert_float_equal(depth_in(CHEST, BED, 1.2, 0, 0), 0.2, VOXEL);   /* to -0.3 .. 0.2: out to the west */
    assert_float_equal(depth_in(CHEST, BED, 2, -0.1, 0), 0.2, VOXEL);  /* y to -1.6 .. -1.3: out to the south */
    assert_float_equal(depth_in(CHEST, BED, 2, 1, 0), 0.6, VOXEL);     /* in its middle: up */
    assert_float_equal(depth_in(CHEST, BED, 2, 1, 0.45), 0.15, VOXEL); /* from above */
    assert_float_equal(depth_in(BED, CHEST, -1.2, 0, 0), 0.2, VOXEL);  /* whichever of both is moved */
}

static void what_touches_does_not_overlap(void **state)
{
    (void)state;
    assert_true(depth_in(CHEST, BED, 1, 0, 0) == 0);        /* side by side */
    assert_true(depth_in(CHEST, BED, 1.1, 0, 0) == 0);      /* by two voxels: outlines are off by as much */
    assert_true(depth_in(CHEST, BED, 2, 1, 0.6) == 0);      /* on top */
    assert_true(depth_in(CHEST, CORNER, 0.2, 1, 0) == 0);   /* between its arms: in its box alone */
    assert_true(depth_in(CHEST, CORNER, -0.1, 1, 0) > 0.1); /* in one arm */
}

/* A corner of a box turned by 45 degrees, 0.3 within the side of another one. */
static void a_turned_box_overlaps_by_its_corner(void **state)
{
    struct placed_things t = furnish();
    struct err err = ERR_INIT;
    double depth;
    (void)state;
    /* the chest's corner (-1, -1.5) goes to the east-most place, (0.5, -2.5) / sqrt 2; it is brought to 0.3 in the
     * bed */
    const double corner[] = {0.5 * sqrt(0.5), -2.5 * sqrt(0.5)};
    const struct placed_thing a = at(CHEST, 45, 0.3 - corner[0], -0.5 - corner[1], 0);
    assert_ok(thing_overlap_depth(&depth, &t.volume, &a, NULL, BED, &err), err);
    assert_float_equal(depth, 0.3, 2 * VOXEL);
    placed_things_release(&t);
}

static void things_that_move_together_stay_apart(void **state)
{
    struct placed_things t = furnish();
    struct err err = ERR_INIT;
    double depth;
    (void)state;
    const struct placed_thing chest = at(CHEST, 30, 0.3, 0.2, 0), bed = at(BED, 30, 0.3, 0.2, 0),
                              there = at(BED, 0, -1, 0, 0);
    assert_ok(thing_overlap_depth(&depth, &t.volume, &chest, &bed, BED, &err), err);
    assert_true(depth == 0);
    const struct placed_thing beside = at(CHEST, 0, 0.2, 0, 0);
    assert_ok(thing_overlap_depth(&depth, &t.volume, &beside, &there, BED, &err), err); /* -1.3 .. -0.8 and -1 .. 0.6 */
    assert_float_equal(depth, 0.2, VOXEL);
    placed_things_release(&t);
}

/* Noise of depth puts a few voxels of a thing elsewhere; they are not an overlap. */
static void a_few_stray_voxels_do_not_count(void **state)
{
    struct placed_things t = furnish();
    struct err err = ERR_INIT;
    const struct placed_thing a = at(CHEST, 0, 0, 0.5, 0);
    double depth;
    (void)state;
    for (int side = 2; side <= 6; side += 4) {
        for (int k = 0; k < side * side * side; k++) {
            const struct vec3 p = vec3_make(-1.38 + VOXEL * (k % side), -0.91 + VOXEL * (k / side % side),
                                            -1.88 + VOXEL * (k / side / side));
            const int64_t i = thing_voxel_at(&t.volume.grid, p);
            t.volume.id[i] = BED;
            t.volume.distance[i] = -1;
        }
        assert_ok(thing_overlap_depth(&depth, &t.volume, &a, NULL, BED, &err), err);
        assert_int_equal(depth > 0, side > 2);
    }
    placed_things_release(&t);
}

/* ------------------------------------------------------------------------------------------------------------ edits */

static int write_things(void **state)
{
    static const struct provenance no_inputs = {.stage = "test", .version = "1"};
    struct err err = ERR_INIT;
    if (scratch_make(state)) return -1;
    struct placed_things t = furnish();
    mkdir(scratch_path("things"), 0777);
    assert_ok(thing_list_write(&t.list, scratch_path("things/things.txt"), &no_inputs, &err), err);
    assert_ok(thing_volume_write(&t.volume, scratch_path("things/volume.exr"), &no_inputs, &err), err);
    placed_things_release(&t);
    return 0;
}

static struct texture_thing said(enum texture_thing_kind kind, const char *name, const char *from, double x, double y,
                                 int line)
{
    return (struct texture_thing){kind, (char *)name, (char *)from, {x, y, 0}, 0, (char *)"e.txt", line};
}

/* words, where: of the error; NULL: there is none. */
static void edit(const struct texture_thing *things, int count, const char *words, const char *where)
{
    const struct texture_map map = {.things = (struct texture_thing *)things, .thing_count = count};
    struct model_rays model = make_rays(room, 2);
    struct placed_things t;
    struct err err = ERR_INIT;
    placed_things_read(&t, scratch_path("things"), &map, &model, &model, NULL, &err);
    if (words) {
        assert_err(err, ST_DATA, words);
        assert_contains(err.text, where);
        assert_true(!t.placed && !t.volume.id);
    } else {
        assert_ok(err.status, err);
        placed_things_release(&t);
    }
    model_rays_release(&model);
}

static void an_edit_is_refused_with_both_names_and_the_depth(void **state)
{
    const struct texture_thing into_bed = said(TEXTURE_THING_MOVE, "chest", "chest", 1.2, 0, 4),
                               twin = said(TEXTURE_THING_MOVE, "twin", "chest", 0.2, 0, 7);
    (void)state;
    edit(&into_bed, 1, "e.txt:4: chest would stand 0.", " deep in bed. Move it by that much or more, or clear");
    edit(&twin, 1, "e.txt:7: twin would stand 0.",
         " deep in chest. Move it by that much or more, or clear"); /* a copy in what it is a copy of */
}

static void what_is_gone_is_in_nobodys_way(void **state)
{
    const struct texture_thing chest = said(TEXTURE_THING_MOVE, "chest", "chest", 1.2, 0, 4),
                               clear = said(TEXTURE_THING_CLEAR, "bed", "bed", 0, 0, 5),
                               away = said(TEXTURE_THING_MOVE, "bed", "bed", 0.3, 0, 5),
                               keep = said(TEXTURE_THING_KEEP, "bed", "bed", 0, 0, 5);
    (void)state;
    edit((const struct texture_thing[]){chest, clear}, 2, NULL, NULL); /* also if it goes later */
    edit((const struct texture_thing[]){clear, chest}, 2, NULL, NULL);
    edit((const struct texture_thing[]){chest, away}, 2, NULL, NULL);
    edit((const struct texture_thing[]){keep, chest}, 2, "e.txt:4: chest would stand 0.",
         " deep in bed. Move it by that much or more, or clear");
}

static void nothing_stands_in_a_rug(void **state)
{
    const struct texture_thing chest = said(TEXTURE_THING_MOVE, "chest", "chest", 0.2, 0, 4),
                               rug = said(TEXTURE_THING_MOVE, "rug", "rug", 0.1, 0, 4);
    (void)state;
    edit(&chest, 1, NULL, NULL);
    edit(&rug, 1, NULL, NULL);
}

static void things_at_new_places_are_in_each_others_way(void **state)
{
    const struct texture_thing bed = said(TEXTURE_THING_MOVE, "bed", "bed", -0.8, 0, 2),
                               chest = said(TEXTURE_THING_MOVE, "chest", "chest", 0.4, 0, 3);
    (void)state;
    edit((const struct texture_thing[]){bed, chest}, 2, "e.txt:3: chest would stand 0.",
         " deep in bed. Move it by that much or more, or clear");
    edit((const struct texture_thing[]){chest, bed}, 2, "e.txt:2: bed would stand 0.",
         " deep in chest. Move it by that much or more, or clear");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_overlap_by_their_least_side),
        cmocka_unit_test(what_touches_does_not_overlap),
        cmocka_unit_test(a_turned_box_overlaps_by_its_corner),
        cmocka_unit_test(things_that_move_together_stay_apart),
        cmocka_unit_test(a_few_stray_voxels_do_not_count),
        cmocka_unit_test(an_edit_is_refused_with_both_names_and_the_depth),
        cmocka_unit_test(what_is_gone_is_in_nobodys_way),
        cmocka_unit_test(nothing_stands_in_a_rug),
        cmocka_unit_test(things_at_new_places_are_in_each_others_way),
    };
    return cmocka_run_group_tests(tests, write_things, scratch_remove);
}
