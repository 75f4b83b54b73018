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
                                          eyes[k]};
        count++;
    }
    return count;
}

/* The walls that are left of one on y = 2 and one on y = 3. */
static struct room_frame left_of(const struct frame_wall *walls, const bool *sure, struct foot_line *lines, int count)
{
    const struct foot_lines all = {lines, count};
    struct room_frame f = {.known = true, .up = {0, 0, 1}, .headings = headings, .heading_count = 2, .wall_count = 2};
    struct err err = ERR_INIT;
    f.walls = calloc(2, sizeof *f.walls);
    assert_non_null(f.walls);
    memcpy(f.walls, walls, 2 * sizeof *walls);
    assert_ok(explained_walls_drop(&f, sure, &all, size, &err), err);
    return f;
}

static const struct frame_wall front_and_back[2] = {{0, SIDE, 2, 0, 3, 3}, {0, SIDE, 3, 0, 3, 3}};
static const bool unsure[2];

/* A sill halfway up to the cameras, which all stand 1 m before the wall, is cast twice as far. */
static void a_sill_is_no_wall_behind_its_wall(void **state)
{
    (void)state;
    static const double eyes[EYES] = {1, 1.01, 0.99};
    static const bool sure[2] = {false, true};
    struct foot_line lines[2 * EYES];
    const int feet = add_lines(lines, 0, eyes, 2, 1, false, 0, 3),
              count = add_lines(lines, feet, eyes, 2, 2, false, 0.75, 2.25);
    struct room_frame f = left_of(front_and_back, unsure, lines, count);
    assert_int_equal(f.wall_count, 1);
    assert_true(f.walls[0].offset == 2);
    free(f.walls);
    f = left_of(front_and_back, sure, lines, count);
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
    struct room_frame f = left_of(front_and_back, unsure, lines, count);
    assert_int_equal(f.wall_count, 2);
    free(f.walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sill_is_no_wall_behind_its_wall),
        cmocka_unit_test(a_wall_behind_another_one_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
