/* frame_floor.c - the floor of a room, by its lines and by where its sparse points end. */
#include "tests/unit/find_frame/line_room.h"

static const double size = 2.5;

enum { POINTS = 1000 };

/* Of POINTS points, `floor` are on the floor to `noise` (standard deviation, m), `below` anywhere up to a metre below
 * it, the others above it. ring: 0, or how far all of them are from the first camera's vertical. */
static void add_points(struct line_room *r, struct sfm_point *points, int floor, int below, double noise, double ring)
{
    const struct rng rng = rng_make(3, "test", "points");
    const struct mat3 world_from_room = mat3_transpose(r->room_from_world);
    for (int i = 0; i < POINTS; i++) {
        const uint64_t key = (uint64_t)i;
        const double part = rng_uniform(&rng, key, 5), height = i < floor ? noise * room_normal(&rng, key, 0)
                                                                : i < floor + below
                                                                    ? -part
                                                                    : 0.3 + part * (ROOM_CEILING - ROOM_FLOOR - 0.3);
        const double x = rng_uniform(&rng, key, 3), y = rng_uniform(&rng, key, 4), turn = 2 * PI * x;
        const struct vec3 at = ring > 0 ? vec3_make(ring * cos(turn), ring * sin(turn), ROOM_FLOOR + height)
                                        : vec3_make(-2 + 5 * x, -2.5 + 3 * y, ROOM_FLOOR + height);
        points[i] = (struct sfm_point){.position = mat3_apply(world_from_room, at)};
    }
    r->set.model.points = points;
    r->set.model.point_count = POINTS;
}

/* The floor of a room that is seen from this many places. */
static struct frame_level floor_with(int stations, int floor, int below, double noise, double ring)
{
    static struct sfm_point points[POINTS];
    const struct line_room_spec spec = {.stations = stations, .heading = 10, .noise = 0.5};
    struct line_room r;
    struct room_frame f;
    struct err err = ERR_INIT;
    free(line_room_headings(&f, &r, &spec));
    add_points(&r, points, floor, below, noise, ring);
    assert_ok(frame_room_find(&f, &r.lines, &r.set, size, &err), err);
    const struct frame_level found = f.floor;
    room_frame_release(&f);
    line_room_release(&r);
    return found;
}

static struct frame_level floor_of(int stations, int floor, int below, double noise)
{
    return floor_with(stations, floor, below, noise, 0);
}

static void the_floor_is_where_points_end_if_lines_do_not_say(void **state)
{
    (void)state;
    const struct frame_level end = floor_of(1, 150, 10, 0.005);
    assert_true(end.known);
    assert_true(fabs(end.height - ROOM_FLOOR) < 0.01);
    assert_true(end.error < 0.02);
}

/* What stands 2 m away is seen down to the floor and below; what is nearer than the floor is low goes on below the
 * photos. */
static void points_that_end_at_the_lower_edge_of_photos_are_no_floor(void **state)
{
    (void)state;
    assert_true(floor_with(1, 150, 0, 0.005, 2).known);
    assert_false(floor_with(1, 150, 0, 0.005, 1.42).known);
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

/* Level edges at one height that are apart, as those of posters are. */
static void a_level_without_walls_is_no_floor(void **state)
{
    (void)state;
    const struct line_room_spec spec = {.stations = 2, .heading = 10, .posters = true};
    struct line_room r;
    struct room_frame f;
    struct err err = ERR_INIT;
    int *headings = line_room_headings(&f, &r, &spec);
    assert_ok(levels_floor_of_lines(&f, &r.lines, headings, &r.set, size, &err), err);
    assert_true(f.floor.known); /* by their lines alone */
    free(headings);
    assert_ok(frame_room_find(&f, &r.lines, &r.set, size, &err), err);
    assert_false(f.floor.known);
    room_frame_release(&f);
    line_room_release(&r);
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
        cmocka_unit_test(points_that_end_at_the_lower_edge_of_photos_are_no_floor),
        cmocka_unit_test(points_that_fade_out_are_no_floor),
        cmocka_unit_test(a_level_with_points_below_is_no_floor),
        cmocka_unit_test(a_level_without_walls_is_no_floor),
        cmocka_unit_test(noise_of_points_on_the_floor_does_not_refute_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
