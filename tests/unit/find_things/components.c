/* Connected surfaces of a volume: which there are, what marks make of them, how they grow. */
#include "stages/find_things/components.h"

#include "tests/unit/find_things/voxel_blocks.h"

enum { NX = 20, NY = 12, NZ = 10, VOXELS = NX * NY * NZ };

static const struct voxel_grid grid = {{0, 0, 0}, 0.1, {NX, NY, NZ}};
static const struct things_params params = {.min_views = 2, .min_weight = 0.8, .min_size = 0.25, .min_voxels = 8};
static const struct block small = {1, 1, 1, 2, 3, 3}, large = {10, 1, 1, 14, 3, 3};

static uint32_t ids[VOXELS];

/* What the views say of each voxel: in the blocks that `views` show a surface. */
struct volume {
    float sum[VOXELS], weight[VOXELS];
    uint8_t views[VOXELS];
};

static void show(struct volume *v, struct block b, int views)
{
    for (int64_t i = 0; i < VOXELS; i++)
        if (in_block(&b, &grid, i)) {
            v->sum[i] = -0.5f;
            v->weight[i] = 1;
            v->views[i] = (uint8_t)views;
        }
}

static int find(struct volume *v, const struct things_params *p, int views)
{
    const struct fused_volume f = {grid, v->sum, v->weight, v->views};
    struct err err = ERR_INIT;
    int count = -1;
    memset(ids, 0xa5, sizeof ids);
    assert_ok(components_find(ids, &count, &f, p, NZ * grid.voxel, views, &err), err);
    return count;
}

static void separate_blocks_are_two_surfaces_the_largest_first(void **state)
{
    (void)state;
    static struct volume v;
    show(&v, small, 2);
    show(&v, large, 3);
    assert_int_equal(find(&v, &params, 3), 2);
    assert_blocks(ids, &grid, (struct block[]){small, large}, (uint32_t[]){2, 1}, 2);
}

static void surfaces_of_one_size_keep_the_order_of_the_grid(void **state)
{
    (void)state;
    static struct volume v;
    const struct block a = {1, 1, 1, 3, 3, 3}, b = {1, 5, 1, 3, 7, 3}, c = {1, 1, 6, 3, 3, 8};
    show(&v, c, 2);
    show(&v, b, 2);
    show(&v, a, 2);
    assert_int_equal(find(&v, &params, 3), 3);
    assert_blocks(ids, &grid, (struct block[]){a, b, c}, (uint32_t[]){1, 2, 3}, 3);
}

static void voxels_that_share_a_corner_are_connected(void **state)
{
    (void)state;
    static struct volume v;
    const struct block a = {1, 1, 1, 3, 3, 3}, b = {4, 4, 4, 6, 6, 6};
    show(&v, a, 2);
    show(&v, b, 2);
    assert_int_equal(find(&v, &params, 3), 1);
    assert_blocks(ids, &grid, (struct block[]){a, b}, (uint32_t[]){1, 1}, 2);
}

/* The ends of a row of voxels are neighbours in memory, but not in space. */
static void surfaces_do_not_go_on_at_the_other_side_of_the_grid(void **state)
{
    (void)state;
    static struct volume v;
    const struct block a = {0, 1, 1, 1, 3, 3}, b = {NX - 3, 1, 1, NX - 1, 3, 3}, c = {8, NY - 2, 0, 12, NY - 1, 1},
                       d = {8, 0, 2, 12, 0, 4};
    show(&v, a, 2);
    show(&v, b, 2);
    show(&v, c, 2);
    show(&v, d, 2);
    assert_int_equal(find(&v, &params, 3), 4);
}

static void what_is_too_small_is_left_out(void **state)
{
    (void)state;
    static struct volume v;
    struct things_params p = params;
    show(&v, small, 2); /* 2 x 3 x 3 = 18 voxels, sqrt(22) = 4.69 voxels long */
    show(&v, large, 2); /* 5 x 3 x 3 = 45 voxels, sqrt(43) = 6.56 voxels long */
    p.min_voxels = 18;
    assert_int_equal(find(&v, &p, 2), 2);
    p.min_voxels = 19;
    assert_int_equal(find(&v, &p, 2), 1);
    assert_blocks(ids, &grid, &large, (uint32_t[]){1}, 1);
    p = params;
    p.min_size = 0.46; /* 4.6 voxels */
    assert_int_equal(find(&v, &p, 2), 2);
    p.min_size = 0.48;
    assert_int_equal(find(&v, &p, 2), 1);
    assert_blocks(ids, &grid, &large, (uint32_t[]){1}, 1);
    p.min_size = 0.66;
    assert_int_equal(find(&v, &p, 2), 0);
    assert_blocks(ids, &grid, NULL, NULL, 0);
}

static void one_view_is_not_enough_unless_the_scene_has_no_other(void **state)
{
    (void)state;
    static struct volume v;
    show(&v, small, 1);
    show(&v, large, 2);
    assert_int_equal(find(&v, &params, 3), 1);
    assert_blocks(ids, &grid, &large, (uint32_t[]){1}, 1);
    assert_int_equal(find(&v, &params, 1), 2);
}

static void voxels_before_a_surface_or_of_little_weight_are_not_part_of_it(void **state)
{
    (void)state;
    static struct volume v;
    show(&v, large, 2);
    show(&v, small, 2);
    for (int64_t i = 0; i < VOXELS; i++) {
        if (in_block(&small, &grid, i)) v.weight[i] = 0.79f;
        if (in_block(&large, &grid, i) && i % NX == 14) v.sum[i] = 0.1f;
        if (in_block(&large, &grid, i) && i % NX == 13) v.sum[i] = 0;
    }
    assert_int_equal(find(&v, &params, 3), 1);
    assert_blocks(ids, &grid, (struct block[]){{10, 1, 1, 12, 3, 3}}, (uint32_t[]){1}, 1);
}

/* ------------------------------------------------------------------------------------------------------------ marks */

static void two_blocks(int *count)
{
    memset(ids, 0, sizeof ids);
    put_block(ids, &grid, large, 1);
    put_block(ids, &grid, small, 2);
    *count = 2;
}

static void mark(int *count, const struct thing_seed *seeds, int seed_count, uint32_t *named, int names)
{
    struct err err = ERR_INIT;
    for (int i = 0; i < names; i++) named[i] = 77;
    assert_ok(components_mark(ids, count, &grid, seeds, seed_count, named, names, &err), err);
}

static void a_mark_names_a_surface(void **state)
{
    (void)state;
    uint32_t named[1];
    int count;
    two_blocks(&count);
    mark(&count, &(struct thing_seed){0, voxel_of(&grid, 2, 2, 2)}, 1, named, 1);
    assert_int_equal(count, 2);
    assert_int_equal(named[0], 2); /* the largest first, whether it has a name or not */
    assert_blocks(ids, &grid, (struct block[]){small, large}, (uint32_t[]){2, 1}, 2);
}

static void two_marks_of_one_name_join(void **state)
{
    (void)state;
    const struct thing_seed seeds[] = {{0, voxel_of(&grid, 2, 2, 2)}, {0, voxel_of(&grid, 10, 2, 2)}};
    uint32_t named[1];
    int count;
    two_blocks(&count);
    mark(&count, seeds, 2, named, 1);
    assert_int_equal(count, 1);
    assert_int_equal(named[0], 1);
    assert_blocks(ids, &grid, (struct block[]){small, large}, (uint32_t[]){1, 1}, 2);
}

static void two_names_on_one_surface_split_it(void **state)
{
    (void)state;
    /* seven columns: 8 and 14 are the marked ones, 11 is as near to both and goes to the first */
    const struct block whole = {8, 1, 1, 14, 3, 3};
    const struct thing_seed seeds[] = {{1, voxel_of(&grid, 14, 2, 2)}, {0, voxel_of(&grid, 8, 2, 2)}};
    uint32_t named[2];
    int count = 2;
    memset(ids, 0, sizeof ids);
    put_block(ids, &grid, whole, 1);
    put_block(ids, &grid, small, 2);
    mark(&count, seeds, 2, named, 2);
    assert_int_equal(count, 3);
    assert_int_equal(named[1], 1); /* four columns, 36 voxels */
    assert_int_equal(named[0], 2); /* three, 27 */
    assert_blocks(ids, &grid, (struct block[]){small, {8, 1, 1, 10, 3, 3}, {11, 1, 1, 14, 3, 3}}, (uint32_t[]){3, 2, 1},
                  3);
}

/* The bridge between two arms is at one end: along the surface the tip of an arm is nearer to its own mark. */
static void a_surface_is_split_along_itself_not_through_the_air(void **state)
{
    (void)state;
    const struct block left = {4, 1, 1, 4, 10, 1}, right = {6, 1, 1, 6, 10, 1}, bridge = {5, 1, 1, 5, 1, 1};
    const struct thing_seed seeds[] = {{0, voxel_of(&grid, 4, 1, 1)}, {1, voxel_of(&grid, 6, 10, 1)}};
    uint32_t named[2];
    int count = 1;
    memset(ids, 0, sizeof ids);
    put_block(ids, &grid, left, 1);
    put_block(ids, &grid, right, 1);
    put_block(ids, &grid, bridge, 1);
    mark(&count, seeds, 2, named, 2);
    assert_int_equal(count, 2);
    assert_int_equal(ids[voxel_of(&grid, 4, 10, 1)], named[0]);
    assert_int_equal(ids[voxel_of(&grid, 6, 10, 1)], named[1]);
    assert_int_equal(ids[voxel_of(&grid, 6, 7, 1)], named[1]);
    assert_true(named[0] && named[1] && named[0] != named[1]);
}

static void one_name_joins_parts_of_surfaces_that_others_split(void **state)
{
    (void)state;
    const struct thing_seed seeds[] = {
        {0, voxel_of(&grid, 2, 2, 2)}, {0, voxel_of(&grid, 10, 2, 2)}, {1, voxel_of(&grid, 14, 2, 2)}};
    uint32_t named[2];
    int count;
    two_blocks(&count);
    mark(&count, seeds, 3, named, 2);
    assert_int_equal(count, 2);
    assert_true(named[0] == 1 && named[1] == 2);
    assert_blocks(ids, &grid, (struct block[]){small, {10, 1, 1, 12, 3, 3}, {13, 1, 1, 14, 3, 3}},
                  (uint32_t[]){1, 1, 2}, 3);
}

static void a_mark_on_nothing_names_nothing(void **state)
{
    (void)state;
    const struct thing_seed seeds[] = {{0, -1}, {1, voxel_of(&grid, 0, 0, 0)}, {2, voxel_of(&grid, 10, 1, 1)}};
    uint32_t named[4];
    int count;
    two_blocks(&count);
    mark(&count, seeds, 3, named, 4);
    assert_int_equal(count, 2);
    assert_int_equal(named[0], 0);
    assert_int_equal(named[1], 0);
    assert_int_equal(named[2], 1);
    assert_int_equal(named[3], 0); /* a name without marks */
    assert_blocks(ids, &grid, (struct block[]){small, large}, (uint32_t[]){2, 1}, 2);
}

static void without_marks_nothing_changes(void **state)
{
    (void)state;
    int count;
    two_blocks(&count);
    mark(&count, NULL, 0, NULL, 0);
    assert_int_equal(count, 2);
    assert_blocks(ids, &grid, (struct block[]){small, large}, (uint32_t[]){2, 1}, 2);
}

/* ----------------------------------------------------------------------------------------------------------- growth */

static int steps_between(int64_t a, int64_t b)
{
    return abs((int)(a % NX - b % NX)) + abs((int)(a / NX % NY - b / NX % NY)) + abs((int)(a / NX / NY - b / NX / NY));
}

static void a_surface_grows_by_as_many_voxels_as_asked_for(void **state)
{
    (void)state;
    const int64_t middle = voxel_of(&grid, 10, 6, 1);
    for (int steps = 0; steps < 5; steps++) {
        struct err err = ERR_INIT;
        memset(ids, 0, sizeof ids);
        ids[middle] = 3;
        assert_ok(components_grow(ids, &grid, steps, &err), err);
        for (int64_t i = 0; i < VOXELS; i++) assert_int_equal(ids[i], steps_between(i, middle) <= steps ? 3 : 0);
    }
}

static void surfaces_meet_halfway_and_do_not_cover_each_other(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    const int64_t a = voxel_of(&grid, 4, 6, 5), b = voxel_of(&grid, 9, 6, 5);
    memset(ids, 0, sizeof ids);
    ids[a] = 1;
    ids[b] = 2;
    assert_ok(components_grow(ids, &grid, 4, &err), err);
    for (int64_t i = 0; i < VOXELS; i++) {
        const int to_a = steps_between(i, a), to_b = steps_between(i, b);
        if (to_a <= 4 && to_a < to_b) assert_int_equal(ids[i], 1);
        if (to_b <= 4 && to_b < to_a) assert_int_equal(ids[i], 2);
        if (to_a > 4 && to_b > 4) assert_int_equal(ids[i], 0);
    }
}

static void a_full_grid_stays_as_it_is(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    for (int i = 0; i < VOXELS; i++) ids[i] = 1 + (uint32_t)i % 2;
    assert_ok(components_grow(ids, &grid, 3, &err), err);
    for (int i = 0; i < VOXELS; i++) assert_int_equal(ids[i], 1 + (uint32_t)i % 2);
}

static void a_thing_that_stands_reaches_down_to_its_floor(void **state)
{
    (void)state;
    const struct block top = {2, 2, 6, 5, 5, 7}, hanging = {12, 2, 6, 15, 5, 7};
    const int lowest[] = {0, 2, -1};
    memset(ids, 0, sizeof ids);
    put_block(ids, &grid, top, 1);
    put_block(ids, &grid, hanging, 2);
    components_stand(ids, &grid, lowest);
    assert_blocks(ids, &grid, (struct block[]){{2, 2, 2, 5, 5, 7}, hanging}, (uint32_t[]){1, 2}, 2);
    components_stand(ids, &grid, (const int[]){0, 0, -1}); /* the lowest slice of the grid too */
    assert_blocks(ids, &grid, (struct block[]){{2, 2, 0, 5, 5, 7}, hanging}, (uint32_t[]){1, 2}, 2);
}

static void a_thing_does_not_reach_through_another(void **state)
{
    (void)state;
    const struct block table = {2, 2, 8, 7, 5, 8}, hamper = {3, 3, 3, 4, 4, 4};
    const int lowest[] = {0, 1, -1};
    memset(ids, 0, sizeof ids);
    put_block(ids, &grid, table, 1);
    put_block(ids, &grid, hamper, 2);
    components_stand(ids, &grid, lowest);
    /* the columns of the hamper: the table down to it, nothing below it */
    assert_blocks(ids, &grid, (struct block[]){{2, 2, 1, 7, 5, 8}, {3, 3, 1, 4, 4, 2}, hamper}, (uint32_t[]){1, 0, 2},
                  3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(separate_blocks_are_two_surfaces_the_largest_first),
        cmocka_unit_test(surfaces_of_one_size_keep_the_order_of_the_grid),
        cmocka_unit_test(voxels_that_share_a_corner_are_connected),
        cmocka_unit_test(surfaces_do_not_go_on_at_the_other_side_of_the_grid),
        cmocka_unit_test(what_is_too_small_is_left_out),
        cmocka_unit_test(one_view_is_not_enough_unless_the_scene_has_no_other),
        cmocka_unit_test(voxels_before_a_surface_or_of_little_weight_are_not_part_of_it),
        cmocka_unit_test(a_mark_names_a_surface),
        cmocka_unit_test(two_marks_of_one_name_join),
        cmocka_unit_test(two_names_on_one_surface_split_it),
        cmocka_unit_test(a_surface_is_split_along_itself_not_through_the_air),
        cmocka_unit_test(one_name_joins_parts_of_surfaces_that_others_split),
        cmocka_unit_test(a_mark_on_nothing_names_nothing),
        cmocka_unit_test(without_marks_nothing_changes),
        cmocka_unit_test(a_surface_grows_by_as_many_voxels_as_asked_for),
        cmocka_unit_test(surfaces_meet_halfway_and_do_not_cover_each_other),
        cmocka_unit_test(a_full_grid_stays_as_it_is),
        cmocka_unit_test(a_thing_that_stands_reaches_down_to_its_floor),
        cmocka_unit_test(a_thing_does_not_reach_through_another),
    };
    return cmocka_run_group_tests_name("components", tests, NULL, NULL);
}
