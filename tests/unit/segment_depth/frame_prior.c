/* frame_prior.c - what a view is expected to see of a room that is known. */
#include "stages/segment_depth/frame_prior.h"
#include "tests/unit/scratch.h"

enum { W = 120, H = 100, CELL = 10, ACROSS = W / CELL, COUNT = ACROSS * (H / CELL) };

static struct segment segments[COUNT];

/* A grid of square segments. */
static struct segmentation grid(void)
{
    for (int i = 0; i < COUNT; i++) {
        const int x = i % ACROSS * CELL, y = i / ACROSS * CELL;
        segments[i] = (struct segment){.cx = x + CELL / 2.0,
                                       .cy = y + CELL / 2.0,
                                       .x0 = x,
                                       .y0 = y,
                                       .x1 = x + CELL - 1,
                                       .y1 = y + CELL - 1,
                                       .pixels = CELL * CELL};
    }
    return (struct segmentation){.width = W, .height = H, .count = COUNT, .segments = segments};
}

/* A room with y down: floor at y = 1, ceiling at y = -1.5, a wall at z = 4 from x = -2 to 3, one at x = 3 that begins
 * at z = 1, and one at z = 2 that is seen from behind. */
static struct frame_heading headings[2] = {{{1, 0, 0}, 0.001, 0.3}, {{0, 0, 1}, 0.001, 0.3}};
static struct frame_wall walls[3];

static struct room_frame room(void)
{
    struct room_frame f = {.known = true,
                           .up = {0, -1, 0},
                           .headings = headings,
                           .heading_count = 2,
                           .floor = {true, -1, 0.01},
                           .ceiling = {true, 1.5, 0.01},
                           .walls = walls,
                           .wall_count = 3};
    const struct vec3 z = frame_across(&f, 0), x = frame_across(&f, 1);
    walls[0] = (struct frame_wall){0, z.z > 0 ? -1 : 1, 4 * z.z, -2, 3, 5};
    walls[1] = (struct frame_wall){1, x.x > 0 ? -1 : 1, 3 * x.x, 1, 4, 5};
    walls[2] = (struct frame_wall){0, z.z > 0 ? 1 : -1, 2 * z.z, -9, 9, 5};
    return f;
}

static const struct view view = {.name = "v",
                                 .width = W,
                                 .height = H,
                                 .fx = 50,
                                 .fy = 50,
                                 .cx = 60,
                                 .cy = 50,
                                 .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

/* The true inverse depth at a pixel. */
static double truth(double u, double v)
{
    const double x = (u - 60) / 50, y = (v - 50) / 50;
    double inverse = fmax(y / 1, -y / 1.5); /* floor, ceiling */
    if (x > 0 && 3 / x >= 1 && 3 / x <= 4) inverse = fmax(inverse, x / 3);
    if (4 * x > -2 && 4 * x < 3) inverse = fmax(inverse, 0.25);
    return inverse;
}

static void segments_are_expected_on_what_their_rays_meet_first(void **state)
{
    (void)state;
    const struct segmentation s = grid();
    const struct room_frame f = room();
    struct plane_prior prior;
    struct err err = ERR_INIT;
    int known = 0;
    assert_ok(frame_prior_make(&prior, &f, &view, &s, &err), err);
    assert_int_equal(prior.count, 4);
    for (int i = 0; i < COUNT; i++) {
        const double u = segments[i].cx, v = segments[i].cy;
        if (prior.expected[i] < 0) continue;
        known++;
        assert_true(fabs(plane_at(prior.planes[prior.expected[i]], u, v) - truth(u, v)) < 1e-9);
    }
    assert_int_equal(known, COUNT);
    plane_prior_release(&prior);
}

/* Beyond the end of a wall nothing is known at the horizon. */
static void nothing_is_expected_where_nothing_is_known(void **state)
{
    (void)state;
    const struct segmentation s = grid();
    struct room_frame f = room();
    struct plane_prior prior;
    struct err err = ERR_INIT;
    f.floor.known = f.ceiling.known = false;
    f.wall_count = 1;
    assert_ok(frame_prior_make(&prior, &f, &view, &s, &err), err);
    assert_int_equal(prior.count, 1);
    for (int i = 0; i < COUNT; i++) {
        const double x = (segments[i].cx - 60) / 50 * 4;
        assert_int_equal(prior.expected[i], x > -2 && x < 3 ? 0 : -1);
    }
    plane_prior_release(&prior);
    assert_ok(frame_prior_make(&prior, NULL, &view, &s, &err), err);
    assert_int_equal(prior.count, 0);
    plane_prior_release(&prior);
    plane_prior_release(&prior);
}

/* The gain of a blank segment, when `part` of the others match. */
static double gain_of(double trust, double part)
{
    static double distinct[COUNT];
    const struct segmentation s = grid();
    const struct room_frame f = room();
    struct plane_prior prior;
    struct err err = ERR_INIT;
    for (int i = 0; i < COUNT; i++) distinct[i] = i > 0 && i <= part * COUNT;
    assert_ok(frame_prior_make(&prior, &f, &view, &s, &err), err);
    frame_prior_weigh(&prior, trust, distinct, &s);
    const double gain = (double)prior.gain[0];
    if (part > 0) assert_true(prior.gain[1] < prior.gain[0] || !(gain > 0));
    plane_prior_release(&prior);
    return gain;
}

static void the_prior_counts_where_pictures_say_little(void **state)
{
    (void)state;
    assert_true(gain_of(1, 0.1) > 0.5);
    assert_true(gain_of(1, 0.5) <= 0);
    assert_true(gain_of(0, 0.1) <= 0);
    assert_true(gain_of(0.5, 0.1) < gain_of(1, 0.1));
    assert_true(gain_of(0.5, 0.1) > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(segments_are_expected_on_what_their_rays_meet_first),
        cmocka_unit_test(nothing_is_expected_where_nothing_is_known),
        cmocka_unit_test(the_prior_counts_where_pictures_say_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
