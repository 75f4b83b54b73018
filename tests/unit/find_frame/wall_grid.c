/* wall_grid.c - cells of the plan that lines show, and that views see through. */
#include "stages/find_frame/wall_grid.h"

#include "tests/unit/scratch.h"

/* Walls run along x, so that across is y; floor at 0, ceiling at 2.5. The wall is on y = 2, seen from smaller y. */
static struct frame_heading headings[1] = {{{1, 0, 0}, 0.001, 0.2}};
static const struct room_frame frame = {.known = true,
                                        .up = {0, 0, 1},
                                        .headings = headings,
                                        .floor = {true, 0, 0.01},
                                        .ceiling = {true, 2.5, 0.01},
                                        .heading_count = 1};
static const double size = 2.5;
enum { SIDE = -1, STATIONS = 3 };

/* Lines on the wall from x = 0 to 1, of three stations; feet and heads: bits of the stations that show them. */
static int wall_lines(struct foot_line *lines, int feet, int heads)
{
    int count = 0;
    for (int i = 0; i < 2 * STATIONS; i++) {
        const int station = i / 2;
        const bool head = i % 2;
        if (!((head ? heads : feet) >> station & 1)) continue;
        lines[count] = (struct foot_line){count, 0, station, head, 2, 0, 1, station * 0.3, 0.5};
        count++;
    }
    return count;
}

/* How many places and levels show the middle of the wall, if sights of that many stations cross it at a height. */
static int shown_at(int feet, int heads, int stations, double height)
{
    static const bool used[2 * STATIONS];
    struct foot_line list[2 * STATIONS];
    const struct foot_lines lines = {list, wall_lines(list, feet, heads)};
    struct frame_sights sights = {0};
    struct wall_grid g = {0};
    struct err err = ERR_INIT;
    for (int k = 0; k < stations; k++) { /* to behind the wall, so that it is crossed in the middle */
        const struct vec3 eye = {0.5, k * 0.3, 1.4}, at = {0.5, 2, height};
        assert_ok(frame_sights_add(&sights, k, eye, vec3_add(at, vec3_sub(at, eye)), &err), err);
    }
    assert_ok(wall_grid_fill(&g, &lines, used, 0, SIDE, size, &err), err);
    assert_in_range(g.along, 1, 64);
    const int row = (int)((2 - g.low) / (WALL_ROW * size)), k = (int)((0.5 - g.from) / (WALL_CELL * size));
    wall_grid_mark_through(&g, row, 0, SIDE, &frame, &sights, size);
    const int shown = __builtin_popcountll(wall_grid_shown(&g, true, row, k));
    wall_grid_release(&g);
    free(sights.list);
    return shown;
}

static void feet_and_heads_of_a_place_count_apart(void **state)
{
    (void)state;
    assert_int_equal(shown_at(7, 0, 0, 0), 3);
    assert_int_equal(shown_at(7, 5, 0, 0), 5);
    assert_int_equal(shown_at(0, 2, 0, 0), 1);
}

/* A wall with a window is seen through above 0.9 m; what has no foot, or no head, is none. */
static void what_is_seen_through_is_no_wall(void **state)
{
    (void)state;
    assert_int_equal(shown_at(7, 7, 2, 1.2), 6);
    assert_int_equal(shown_at(7, 7, 2, 0.4), 0);
    assert_int_equal(shown_at(7, 7, 1, 0.4), 6);
    assert_int_equal(shown_at(7, 0, 2, 1.2), 0);
    assert_int_equal(shown_at(0, 7, 2, 1.2), 0);
    assert_int_equal(shown_at(0, 7, 1, 1.2), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_and_heads_of_a_place_count_apart),
        cmocka_unit_test(what_is_seen_through_is_no_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
