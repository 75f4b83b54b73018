/* frame_walls.c - floor, ceiling and walls of rooms whose lines are known. */
#include "tests/unit/find_frame/line_room.h"

static const double size = 2.5;

static void find(struct room_frame *f, struct line_room *r, const struct line_room_spec *spec)
{
    struct err err = ERR_INIT;
    free(line_room_headings(f, r, spec));
    assert_ok(frame_room_find(f, &r->lines, &r->set, size, &err), err);
    assert_true(f->floor.known && f->ceiling.known);
}

/* A wall of the room: on x = offset (axis 0) or y = offset (1), from `from` to `to` along the other axis; inside: on
 * which side the room is. */
struct true_wall {
    int axis, inside;
    double offset, from, to;
};

static const struct true_wall walls[] = {{0, 1, -2, -2.5, 1.5}, {0, -1, 3, -2.5, 0.5}, {1, 1, -2.5, -2, 3},
                                         {1, -1, 1.5, -2, 1.8}, {1, -1, 0.5, 1.8, 3},  {0, -1, 1.8, 0.5, 1.5}};

/* Whether a wall of the frame is a true one, to a tolerance; *covered: the part of it that it covers. */
static bool is_wall(const struct true_wall *t, const struct room_frame *f, const struct frame_wall *w,
                    const struct line_room *r, double tolerance, double *covered)
{
    const struct vec3 across = mat3_apply(r->room_from_world, frame_across(f, w->heading)),
                      along = mat3_apply(r->room_from_world, f->headings[w->heading].along);
    const double normal = t->axis ? across.y : across.x, run = t->axis ? along.x : along.y;
    if (fabs(normal) < 0.9) return false;
    const double a = w->from * run, b = w->to * run, from = fmin(a, b), to = fmax(a, b);
    *covered = (fmin(to, t->to) - fmax(from, t->from)) / (t->to - t->from);
    return fabs(w->offset * normal - t->offset) < tolerance && w->side * (normal > 0 ? 1 : -1) == t->inside &&
           *covered > 0;
}

static void floor_ceiling_and_walls_of_an_empty_room_are_found(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        const struct line_room_spec spec = {.seed = (uint64_t)k,
                                            .noise = k ? 0.7 : 0,
                                            .pose_error = k ? 0.05 : 0,
                                            .stray = k ? 0.5 : 0,
                                            .tilt = 4,
                                            .heading = 20 * k,
                                            .stations = 5};
        struct line_room r;
        struct room_frame f;
        int wrong = 0;
        find(&f, &r, &spec);
        assert_true(fabs(f.floor.height - ROOM_FLOOR) < (k ? 0.02 : 0.01));
        assert_true(fabs(f.ceiling.height - ROOM_CEILING) < (k ? 0.02 : 0.01));
        for (size_t t = 0; t < sizeof walls / sizeof *walls; t++) {
            double best = 0, covered;
            for (int i = 0; i < f.wall_count; i++)
                if (is_wall(&walls[t], &f, &f.walls[i], &r, 0.03, &covered) && covered > best) best = covered;
            assert_true(best > 0.9);
        }
        for (int i = 0; i < f.wall_count; i++) {
            double covered;
            bool is_true = false;
            for (size_t t = 0; t < sizeof walls / sizeof *walls; t++)
                is_true = is_true || is_wall(&walls[t], &f, &f.walls[i], &r, 0.03, &covered);
            wrong += !is_true;
        }
        assert_in_range(wrong, 0, 1);
        room_frame_release(&f);
        line_room_release(&r);
    }
}

/* Finds the ceiling of rooms with a moulding, and with edges `above` it. */
static void assert_ceilings(double above)
{
    for (int k = 0; k < 4; k++) {
        const struct line_room_spec spec = {
            .seed = (uint64_t)k, .noise = 0.1, .heading = 20 * k, .stations = 5, .moulding = 0.0125, .above = above};
        struct line_room r;
        struct room_frame f;
        find(&f, &r, &spec);
        assert_true(fabs(f.ceiling.height - ROOM_CEILING) < 0.006);
        room_frame_release(&f);
        line_room_release(&r);
    }
}

/* The edges of a moulding lie within the two steps in which heights are counted. */
static void the_highest_edge_of_a_moulding_is_the_ceiling(void **state)
{
    (void)state;
    assert_ceilings(0);
}

/* As many walls and places show them as the ceiling. */
static void a_few_lines_above_the_ceiling_are_not_it(void **state)
{
    (void)state;
    assert_ceilings(0.4);
}

/* Lines of one place fall on each other at no height. */
static void one_place_shows_no_walls(void **state)
{
    (void)state;
    const struct line_room_spec spec = {.stations = 1, .heading = 10};
    struct line_room r;
    struct room_frame f;
    struct err err = ERR_INIT;
    int *headings = line_room_headings(&f, &r, &spec);
    assert_ok(levels_floor_of_lines(&f, &r.lines, headings, &r.set, size, &err), err);
    assert_false(f.floor.known);
    free(headings);
    room_frame_release(&f);
    line_room_release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floor_ceiling_and_walls_of_an_empty_room_are_found),
        cmocka_unit_test(the_highest_edge_of_a_moulding_is_the_ceiling),
        cmocka_unit_test(a_few_lines_above_the_ceiling_are_not_it),
        cmocka_unit_test(one_place_shows_no_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
