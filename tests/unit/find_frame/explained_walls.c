/* explained_walls.c - walls behind others, whose lines may be edges on those. */
#include "stages/find_frame/explained_walls.h"

#include "tests/unit/scratch.h"

/* Walls run along x, so that across is y; rooms are at smaller y. */
static struct frame_heading headings[2] = {{{1, 0, 0}, 0.001, 0.2}, {{0, 1, 0}, 0.001, 0.2}};
static const double size = 2.5;
enum { SIDE = -1, EYES = 3 };

/* Lines on the wall y = at, as three cameras show them that stand at these y; cast: times the distance at which their
 * height makes them fall on the plan. */
static int add_lines(struct foot_line *lines, int count, const double *eyes, double at, double cast, bool head,
                     double from, double to)
{
    for (int k = 0; k < EYES; k++) {
        const double place = 1.5; /* of the cameras along x */
        lines[count] = (struct foot_line){count,
                                          0,
                                          k,
                                          head,
                                          eyes[k] + cast * (at - eyes[k]),
                                          place + cast * (from - place),
                                          place + cast * (to - place),
                                          eyes[k],
                                          place};
        count++;
    }
    return count;
}

/* The walls that are left. sure: NULL: none is. */
static struct room_frame left_of(const struct frame_wall *walls, int wall_count, const bool *sure,
                                 struct foot_line *lines, int count)
{
    static const bool unsure[3];
    const struct foot_lines all = {lines, count};
    struct room_frame f = {
        .known = true, .up = {0, 0, 1}, .headings = headings, .heading_count = 2, .wall_count = wall_count};
    struct err err = ERR_INIT;
    f.walls = calloc((size_t)wall_count, sizeof *f.walls);
    assert_non_null(f.walls);
    memcpy(f.walls, walls, (size_t)wall_count * sizeof *walls);
    assert_ok(explained_walls_drop(&f, sure ? sure : unsure, &all, size, &err), err);
    return f;
}

static const struct frame_wall front_and_back[2] = {{0, SIDE, 2, 0, 3, 3}, {0, SIDE, 3, 0, 3, 3}};

/* A sill halfway up to the cameras, which all stand 1 m before the wall, is cast twice as far. */
static void a_sill_is_no_wall_behind_its_wall(void **state)
{
    (void)state;
    static const double eyes[EYES] = {1, 1.01, 0.99};
    static const bool sure[2] = {false, true};
    struct foot_line lines[2 * EYES];
    const int feet = add_lines(lines, 0, eyes, 2, 1, false, 0, 3),
              count = add_lines(lines, feet, eyes, 2, 2, false, 0.75, 2.25);
    struct room_frame f = left_of(front_and_back, 2, NULL, lines, count);
    assert_int_equal(f.wall_count, 1);
    assert_true(f.walls[0].offset == 2);
    free(f.walls);
    f = left_of(front_and_back, 2, sure, lines, count);
    assert_int_equal(f.wall_count, 2);
    free(f.walls);
}

/* From different distances, the foot of a wall 1 m behind another one fits no height of that one. */
static void a_wall_behind_another_one_is_kept(void **state)
{
    (void)state;
    static const double eyes[EYES] = {-2, 0, 1.5};
    struct foot_line lines[2 * EYES];
    const int feet = add_lines(lines, 0, eyes, 2, 1, false, 0, 3),
              count = add_lines(lines, feet, eyes, 3, 1, false, 0, 3);
    struct room_frame f = left_of(front_and_back, 2, NULL, lines, count);
    assert_int_equal(f.wall_count, 2);
    free(f.walls);
}

/* The heads of doors on a wall that goes on from 1 to 3, of which only the part from 0 to 1 was found: it grows, but
 * not past a wall across it. */
static void heads_of_doors_show_how_far_a_wall_goes_on(void **state)
{
    (void)state;
    static const double eyes[EYES] = {1, 1.01, 0.99};
    struct foot_line lines[EYES];
    const int count = add_lines(lines, 0, eyes, 2, 2, true, 0.9, 3);
    for (int k = 0; k < 2; k++) {
        /* the wall across is on x = 2.5, seen from smaller x: across = up x along = -x */
        const struct frame_wall walls[3] = {
            {0, SIDE, 2, 0, 1, 3}, {0, SIDE, 3, 0.3, 4.5, 3}, {1, 1, -2.5, k ? 0 : 5, 9, 3}};
        struct room_frame f = left_of(walls, 3, NULL, lines, count);
        assert_int_equal(f.wall_count, 2);
        assert_float_equal(f.walls[0].from, 0, 1e-12);
        assert_float_equal(f.walls[0].to, k ? 2.5 : 3, 1e-9);
        free(f.walls);
    }
    const struct frame_wall apart[2] = {{0, SIDE, 2, 0, 0.8, 3}, {0, SIDE, 3, 0.3, 4.5, 3}};
    struct room_frame f = left_of(apart, 2, NULL, lines, count);
    assert_int_equal(f.wall_count, 2);
    assert_true(f.walls[0].to == 0.8);
    free(f.walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sill_is_no_wall_behind_its_wall),
        cmocka_unit_test(a_wall_behind_another_one_is_kept),
        cmocka_unit_test(heads_of_doors_show_how_far_a_wall_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
