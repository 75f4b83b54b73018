/* closing_walls.c - walls between the ends of others that few lines show. */
#include "stages/find_frame/closing_walls.h"

#include "common/base/array.h"
#include "tests/unit/scratch.h"

/* The outline of a room steps to the right by 1.2 at y = 0: a wall on x = 0 below, one on x = 1.2 above, both seen from
 * larger x, and between them the wall that is looked for, seen from smaller y. One more wall, on y = 0 too, is far
 * away. */
static struct frame_heading headings[2] = {{{1, 0, 0}, 0.001, 0.2}, {{0, 1, 0}, 0.001, 0.2}};
static const struct frame_wall outline[] = {{1, -1, 0, -4, -0.4, 4}, {1, -1, -1.2, 0.1, 4, 4}, {0, -1, 0, 7, 9, 3}};
enum { WALLS = sizeof outline / sizeof *outline };
static const double size = 2.5;

/* The foot of a part of the wall as one place shows it, the head of another part from another place. */
static const struct foot_line shown[] = {{0, 0, 0, false, 0, 0.1, 0.5, -2, 0.5}, {1, 0, 1, true, 0, 0.6, 1, -3, 1}};

static struct room_frame closed(const struct frame_wall *walls, int line_count, int sight_count)
{
    static const bool used[2];
    struct foot_line copy[2] = {shown[0], shown[1]};
    const struct foot_lines lines = {copy, line_count};
    struct frame_sights sights = {0};
    struct room_frame f = {.known = true,
                           .up = {0, 0, 1},
                           .headings = headings,
                           .floor = {true, 0, 0.01},
                           .ceiling = {true, 2.5, 0.01},
                           .heading_count = 2};
    struct err err = ERR_INIT;
    for (int k = 0; k < WALLS; k++) {
        assert_ok(array_append(&f.walls, (size_t)k, sizeof *f.walls, "walls", &err), err);
        f.walls[f.wall_count++] = walls[k];
    }
    for (int k = 0; k < sight_count; k++) /* each through every cell of the wall: from 2 before it to 2 behind it */
        for (int i = 0; i < 12; i++)
            assert_ok(
                frame_sights_add(&sights, k, vec3_make(0.05 + 0.1 * i, -2, 1.4), vec3_make(0.05 + 0.1 * i, 2, 1), &err),
                err);
    assert_ok(closing_walls_add(&f, &lines, used, &sights, size, &err), err);
    free(sights.list);
    return f;
}

static void two_lines_close_a_gap(void **state)
{
    (void)state;
    struct room_frame f = closed(outline, 2, 1);
    assert_int_equal(f.wall_count, WALLS + 1);
    const struct frame_wall *w = &f.walls[WALLS];
    assert_int_equal(w->heading, 0);
    assert_int_equal(w->side, -1);
    assert_int_equal(w->support, 2);
    assert_float_equal(w->offset, 0, WALL_ROW * size);
    assert_float_equal(w->from, 0, 1e-9);
    assert_float_equal(w->to, 1.2, 1e-9);
    free(f.walls);
}

static void one_place_or_a_view_through_closes_nothing(void **state)
{
    (void)state;
    struct room_frame f = closed(outline, 1, 0);
    assert_int_equal(f.wall_count, WALLS);
    free(f.walls);
    f = closed(outline, 2, 2);
    assert_int_equal(f.wall_count, WALLS);
    free(f.walls);
}

/* Where a wall meets the ends, lines beside it close nothing. */
static void ends_that_meet_a_wall_have_no_gap(void **state)
{
    (void)state;
    struct frame_wall walls[WALLS];
    memcpy(walls, outline, sizeof walls);
    walls[2] = (struct frame_wall){0, -1, 0.08, 0, 1.2, 3};
    struct room_frame f = closed(walls, 2, 0);
    assert_int_equal(f.wall_count, WALLS);
    free(f.walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_lines_close_a_gap),
        cmocka_unit_test(one_place_or_a_view_through_closes_nothing),
        cmocka_unit_test(ends_that_meet_a_wall_have_no_gap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
