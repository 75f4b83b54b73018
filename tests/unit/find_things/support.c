/* Boxes of things, and what they stand on or hang from, in a closed room. */
#include "stages/find_things/support.h"

#include <math.h>

#include "tests/unit/find_things/voxel_blocks.h"
#include "tests/unit/whole_room.h"

enum { N = 40, VOXELS = N * N * N }; /* the room, from -2 to 2 */

#define REACH 0.16

static const struct voxel_grid grid = {{-2, -2, -2}, 0.1, {N, N, N}};
static void measure(struct thing *things, const struct block *blocks, int count)
{
    static uint32_t ids[VOXELS];
    const struct thing_volume v = {grid, ids, NULL};
    memset(ids, 0, sizeof ids);
    memset(things, 0, (size_t)count * sizeof *things);
    for (int k = 0; k < count; k++) put_block(ids, &grid, blocks[k], (uint32_t)k + 1);
    things_measure(things, count, &v, &model, REACH);
}

static enum thing_support support_of(struct block b)
{
    struct thing t;
    measure(&t, &b, 1);
    return t.support;
}

static void a_box_is_around_all_voxels(void **state)
{
    (void)state;
    struct thing t[2];
    measure(t, (struct block[]){{5, 10, 15, 9, 19, 16}, {0, 0, 0, 0, 0, 0}}, 2);
    assert_int_equal(t[0].voxels, 5 * 10 * 2);
    assert_float_equal(t[0].low.x, -1.5, 1e-12);
    assert_float_equal(t[0].low.y, -1, 1e-12);
    assert_float_equal(t[0].low.z, -0.5, 1e-12);
    assert_float_equal(t[0].high.x, -1, 1e-12);
    assert_float_equal(t[0].high.y, 0, 1e-12);
    assert_float_equal(t[0].high.z, -0.3, 1e-12);
    assert_int_equal(t[1].voxels, 1);
    assert_float_equal(t[1].low.x, -2, 1e-12);
    assert_float_equal(t[1].high.z, -1.9, 1e-12);
}

static void support_is_what_is_next_to_a_thing(void **state)
{
    (void)state;
    const struct block on_floor = {15, 15, 0, 20, 20, 5}, on_ceiling = {15, 15, 36, 20, 20, 39},
                       floats = {15, 15, 15, 20, 20, 20};
    assert_int_equal(support_of(on_floor), THING_ON_FLOOR);
    assert_int_equal(support_of(on_ceiling), THING_ON_CEILING);
    assert_int_equal(support_of(floats), THING_ON_NONE);
    /* at each of the four walls */
    assert_int_equal(support_of((struct block){0, 15, 15, 1, 20, 20}), THING_ON_WALL);
    assert_int_equal(support_of((struct block){38, 15, 15, 39, 20, 20}), THING_ON_WALL);
    assert_int_equal(support_of((struct block){15, 0, 15, 20, 1, 20}), THING_ON_WALL);
    assert_int_equal(support_of((struct block){15, 38, 15, 20, 39, 20}), THING_ON_WALL);
}

/* Distances are from the centres of voxels: 0.15 from a wall is within reach, 0.25 is not; from the floor it is three
 * times as far. */
static void the_reach_is_larger_above_the_floor(void **state)
{
    (void)state;
    assert_int_equal(support_of((struct block){1, 15, 20, 3, 20, 25}), THING_ON_WALL);
    assert_int_equal(support_of((struct block){2, 15, 20, 4, 20, 25}), THING_ON_NONE);
    assert_int_equal(support_of((struct block){15, 15, 36, 20, 20, 38}), THING_ON_CEILING);
    assert_int_equal(support_of((struct block){15, 15, 34, 20, 20, 37}), THING_ON_NONE);
    assert_int_equal(support_of((struct block){15, 15, 4, 20, 20, 9}), THING_ON_FLOOR);
    /* beside a wall, at 0.65 and 0.25 above the floor */
    assert_int_equal(support_of((struct block){1, 15, 6, 3, 20, 9}), THING_ON_WALL);
    assert_int_equal(support_of((struct block){1, 15, 2, 3, 20, 9}), THING_ON_FLOOR);
}

/* Nine times as far as a wall, if there is nothing else. */
static void a_table_without_legs_stands_on_the_floor(void **state)
{
    (void)state;
    assert_int_equal(support_of((struct block){15, 15, 5, 20, 20, 9}), THING_ON_FLOOR);
    assert_int_equal(support_of((struct block){15, 15, 12, 20, 20, 14}), THING_ON_FLOOR);
    assert_int_equal(support_of((struct block){15, 15, 14, 20, 20, 16}), THING_ON_NONE);
}

static void of_several_supports_the_nearest_counts(void **state)
{
    (void)state;
    assert_int_equal(support_of((struct block){0, 15, 0, 3, 20, 39}), THING_ON_FLOOR); /* a cupboard */
    /* a radiator: 0.45 above the floor, 0.05 from the wall */
    assert_int_equal(support_of((struct block){0, 15, 4, 1, 20, 9}), THING_ON_WALL);
    /* a cupboard at the wall, nearly as high as the ceiling */
    assert_int_equal(support_of((struct block){0, 15, 25, 3, 20, 38}), THING_ON_WALL);
    /* a lamp of the ceiling, beside a wall */
    assert_int_equal(support_of((struct block){1, 15, 37, 3, 20, 39}), THING_ON_CEILING);
}

/* Its ends are nearer to the walls than its top is to the ceiling. */
static void a_beam_whose_ends_touch_walls_hangs_from_the_ceiling(void **state)
{
    (void)state;
    assert_int_equal(support_of((struct block){0, 15, 36, 39, 17, 38}), THING_ON_CEILING);
    assert_int_equal(support_of((struct block){0, 15, 36, 20, 17, 38}), THING_ON_CEILING); /* one end is free */
    /* too far below the ceiling: a curtain's rod */
    assert_int_equal(support_of((struct block){0, 15, 35, 39, 17, 37}), THING_ON_WALL);
    /* it must be more than three times as far above the floor as it is high: 2.95 and 1, 3.05 and 0.9 */
    assert_int_equal(support_of((struct block){0, 15, 29, 39, 17, 38}), THING_ON_WALL);
    assert_int_equal(support_of((struct block){0, 15, 30, 39, 17, 38}), THING_ON_CEILING);
}

static void the_floor_is_seen_from_inside_of_the_room_alone(void **state)
{
    (void)state;
    assert_float_equal(support_below(&model, vec3_make(0.3, 0.2, 0)), 2, 1e-6);
    assert_float_equal(support_below(&model, vec3_make(-1.9, 0.2, -1.5)), 0.5, 1e-6);
    assert_true(isinf(support_below(&model, vec3_make(0, 0, -2.5)))); /* inside of the slab */
    assert_true(isinf(support_below(&model, vec3_make(10, 0, 0))));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_around_all_voxels),
        cmocka_unit_test(support_is_what_is_next_to_a_thing),
        cmocka_unit_test(the_reach_is_larger_above_the_floor),
        cmocka_unit_test(a_table_without_legs_stands_on_the_floor),
        cmocka_unit_test(of_several_supports_the_nearest_counts),
        cmocka_unit_test(a_beam_whose_ends_touch_walls_hangs_from_the_ceiling),
        cmocka_unit_test(the_floor_is_seen_from_inside_of_the_room_alone),
    };
    return cmocka_run_group_tests_name("support", tests, make_model, release_model);
}
