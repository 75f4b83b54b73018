/* open_walls.c - walls that cameras behind them look through. */
#include "stages/find_frame/open_walls.h"

#include "tests/unit/scratch.h"

/* Walls run along x, so that across is y; floor at 0, ceiling at 2.5. The wall is on y = 2, seen from smaller y. */
static struct frame_heading headings[1] = {{{1, 0, 0}, 0.001, 0.2}};
static const double size = 2.5;
enum { SIDE = -1, POINTS = 20 };

/* The wall that is left, 0 long if none is: from x = 0 to `to`, shown by `support` places. Cameras at y = eye see
 * `points` points, each twice, at the same distance on its other side, through the stretch from x = low to high. */
static struct frame_wall left_of(double to, int support, double eye, int points, double low, double high)
{
    struct frame_wall walls[1] = {{0, SIDE, 2, 0, to, support}};
    struct room_frame f = {.known = true,
                           .up = {0, 0, 1},
                           .headings = headings,
                           .floor = {true, 0, 0.01},
                           .ceiling = {true, 2.5, 0.01},
                           .heading_count = 1,
                           .walls = walls,
                           .wall_count = 1};
    struct frame_sights sights = {0};
    struct err err = ERR_INIT;
    for (int k = 0; k < 2 * points; k++) {
        const double x = low + (high - low) * (k / 2) / (points - 1);
        assert_ok(frame_sights_add(&sights, 0, vec3_make(x, eye, 1.4), vec3_make(x, 4 - eye, 1), &err), err);
    }
    assert_ok(open_walls_cut(&f, &sights, sights.count, size, &err), err);
    free(sights.list);
    return f.wall_count ? walls[0] : (struct frame_wall){0};
}

static void what_is_open_across_a_corridor_is_no_wall(void **state)
{
    (void)state;
    const struct frame_wall w = left_of(1, 3, 4, POINTS, 0.4, 0.6);
    assert_true(w.to - w.from == 0);
}

/* A tenth of the points at either end may be wrong. */
static void the_longer_part_beside_what_is_open_stays(void **state)
{
    (void)state;
    const struct frame_wall w = left_of(4, 3, 4, POINTS, 0.5, 1.45);
    assert_true(fabs(w.from - 1.35) < 0.06 && w.to == 4);
    const struct frame_wall v = left_of(4, 3, 4, POINTS, 2.5, 3.45);
    assert_true(v.from == 0 && fabs(v.to - 2.6) < 0.06);
}

static void few_points_sights_from_the_front_and_walls_that_many_show_cut_nothing(void **state)
{
    (void)state;
    assert_true(left_of(1, 3, 4, 5, 0.4, 0.6).to == 1);
    assert_true(left_of(1, 3, 0, POINTS, 0.4, 0.6).to == 1); /* they may look out by a window */
    assert_true(left_of(1, 4, 4, POINTS, 0.4, 0.6).to == 1);
    assert_true(left_of(1, 3, 2.1, POINTS, 0.4, 0.6).to == 1); /* too near to tell its sides apart */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_open_across_a_corridor_is_no_wall),
        cmocka_unit_test(the_longer_part_beside_what_is_open_stays),
        cmocka_unit_test(few_points_sights_from_the_front_and_walls_that_many_show_cut_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
