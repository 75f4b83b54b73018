/* frame_floor.c - the floor of a room, by its lines and by where its sparse points end. */
#include "tests/unit/find_frame/line_room.h"

static const double size = 2.5;

enum { POINTS = 1000 };

/* Of POINTS points, `floor` are on the floor to `noise` (standard deviation, m), `below` anywhere up to a metre below
 * it, the others above it. */
static void add_points(struct line_room *r, struct sfm_point *points, int floor, int below, double noise)
{
    const struct rng rng = rng_make(3, "test", "points");
    const struct mat3 world_from_room = mat3_transpose(r->room_from_world);
    for (int i = 0; i < POINTS; i++) {
        const uint64_t key = (uint64_t)i;
        const double part = rng_uniform(&rng, key, 5), height = i < floor ? noise * room_normal(&rng, key, 0)
                                                                : i < floor + below
                                                                    ? -part
                                                                    : 0.3 + part * (ROOM_CEILING - ROOM_FLOOR - 0.3);
        const struct vec3 at =
            vec3_make(-2 + 5 * rng_uniform(&rng, key, 3), -2.5 + 3 * rng_uniform(&rng, key, 4), ROOM_FLOOR + height);
        points[i] = (struct sfm_point){.position = mat3_apply(world_from_room, at)};
    }
    r->set.model.points = points;
    r->set.model.point_count = POINTS;
}

/* The floor of a room that is seen from this many places. */
static struct frame_level floor_of(int stations, int floor, int below, double noise)
{
    static struct sfm_point points[POINTS];
    const struct line_room_spec spec = {.stations = stations, .heading = 10, .noise = 0.5};
    struct line_room r;
    struct room_frame f;
    struct err err = ERR_INIT;
    int *headings = line_room_headings(&f, &r, &spec);
    add_points(&r, points, floor, below, noise);
    assert_ok(levels_find_floor(&f, &r.lines, headings, &r.set, size, &err), err);
    const struct frame_level found = f.floor;
    free(headings);
    room_frame_release(&f);
    line_room_release(&r);
    return found;
}

static void the_floor_is_where_points_end_if_lines_do_not_say(void **state)
{
    (void)state;
    const struct frame_level end = floor_of(1, 60, 10, 0.005);
    assert_true(end.known);
    assert_true(fabs(end.height - ROOM_FLOOR) < 0.01);
    assert_true(end.error < 0.02);
}

static void points_that_fade_out_are_no_floor(void **state)
{
    (void)state;
    assert_false(floor_of(1, 0, 0, 0.005).known);
    assert_false(floor_of(1, 5, 60, 0.005).known);
}

/* The lines of the true floor, but what is seen goes on below: as edges of tables are. */
static void a_level_with_points_below_is_no_floor(void **state)
{
    (void)state;
    const struct frame_level clear = floor_of(5, 0, 20, 0.005), table = floor_of(5, 0, 400, 0.005);
    assert_true(clear.known);
    assert_true(fabs(clear.height - ROOM_FLOOR) < 0.02);
    assert_false(table.known && fabs(table.height - ROOM_FLOOR) < 0.1);
}

/* Half of the floor's own points lie below it. */
static void noise_of_points_on_the_floor_does_not_refute_it(void **state)
{
    (void)state;
    const struct frame_level found = floor_of(5, 300, 0, 0.06);
    assert_true(found.known);
    assert_true(fabs(found.height - ROOM_FLOOR) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_floor_is_where_points_end_if_lines_do_not_say),
        cmocka_unit_test(points_that_fade_out_are_no_floor),
        cmocka_unit_test(a_level_with_points_below_is_no_floor),
        cmocka_unit_test(noise_of_points_on_the_floor_does_not_refute_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
