/* The walk around what an edit changed: which places count, past which viewpoints it goes, where the camera looks. */
#include "tests/unit/plan_tour/walk.h"

#include "stages/plan_tour/tour_changes.h"
#include "stages/plan_tour/tour_walk.h"

static const struct box hall[] = {HALL_OUTSIDE, HALL_INSIDE};
static const struct box parted[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION_WITH_GAP};
static const struct place around[] = {{"a", {-2.5, -1.5, 1.5}, 0}, {"b", {-2.5, 1.5, 1.5}, 0},
                                      {"c", {0.2, 1.6, 1.5}, 0},   {"d", {2.5, 1.5, 1.5}, 0},
                                      {"e", {2.5, -1.5, 1.5}, 0},  {"f", {0, 0.1, 1.5}, 0}};

static struct model_room_corner corners[] = {
    {.x = -3, .y = -2}, {.x = 3, .y = -2}, {.x = 3, .y = 2}, {.x = -3, .y = 2}};
static struct model_room room = {
    .name = (char *)"hall", .ceiling = {{2.5, 0, 0}}, .ceilings = 1, .corners = corners, .corner_count = 4};
static const struct model_plan plan = {.rooms = &room, .room_count = 1};

static struct tour_change *find(int *count, const struct texture_map *map, const struct thing_list *things)
{
    struct tour_change *changes;
    struct err err = ERR_INIT;
    assert_ok(tour_changes_find(&changes, count, map, things, &plan, &err), err);
    return changes;
}

/* Half a square metre of new wall in the hall, and twice that on the house's outer side. */
static void a_part_of_a_face_counts_for_the_room_that_it_bounds(void **state)
{
    (void)state;
    struct vec3 inner[1][3] = {{{3, 0, 1}, {3, 1, 1}, {3, 0, 2}}},
                outer[1][3] = {{{3.3, 0, 0}, {3.3, 2, 0}, {3.3, 0, 2}}};
    struct texture_face faces[] = {{.id = 1, .normal = {-1, 0, 0}, .offset = -3, .added = inner, .added_count = 1},
                                   {.id = 2, .normal = {1, 0, 0}, .offset = 3.3, .added = outer, .added_count = 1}};
    const struct texture_map map = {.faces = faces, .face_count = 2};
    int count;
    struct tour_change *c = find(&count, &map, NULL);
    assert_int_equal(count, 1);
    assert_int_equal(c[0].room, 0);
    assert_float_equal(c[0].weight, 0.5, 1e-12);
    assert_float_equal(c[0].place.y, 1.0 / 3, 1e-12);
    free(c);
}

/* The sill of a window lies in the wall, where no room is. */
static void what_is_in_a_wall_counts_for_the_room_beside_it(void **state)
{
    (void)state;
    struct vec3 sill[1][3] = {{{3, 0, 1}, {3.3, 1, 1}, {3, 1, 1}}};
    struct texture_face face = {.id = 1, .normal = {0, 0, 1}, .offset = 1, .added = sill, .added_count = 1};
    const struct texture_map map = {.faces = &face, .face_count = 1};
    int count;
    struct tour_change *c = find(&count, &map, NULL);
    assert_int_equal(count, 1);
    free(c);
}

static void a_moved_thing_counts_where_it_was_and_where_it_is(void **state)
{
    (void)state;
    struct thing sofa = {.name = (char *)"sofa", .low = {-2, -1, 0}, .high = {-1, 1, 1}};
    const struct thing_list things = {&sofa, 1};
    struct texture_thing edits[] = {
        {.kind = TEXTURE_THING_MOVE, .name = (char *)"sofa", .from = (char *)"sofa", .by = {3, 0, 0}},
        {.kind = TEXTURE_THING_CLEAR, .name = (char *)"rug", .from = (char *)"rug"}};
    const struct texture_map map = {.things = edits, .thing_count = 2};
    int count;
    struct tour_change *c = find(&count, &map, &things);
    assert_int_equal(count, 1);
    assert_float_equal(c[0].place.x, 0, 1e-12); /* half way between -1.5 and 1.5 */
    free(c);
    c = find(&count, &map, NULL); /* nobody knows where they are */
    assert_int_equal(count, 0);
    free(c);
}

static void a_cleared_room_counts(void **state)
{
    (void)state;
    double square[4][2] = {{-3, -2}, {3, -2}, {3, 2}, {-3, 2}};
    struct texture_zone zone = {.low = 0, .high = 2.5, .corners = square, .corner_count = 4};
    const struct texture_map map = {.zones = &zone, .zone_count = 1};
    int count;
    struct tour_change *c = find(&count, &map, NULL);
    assert_int_equal(count, 1);
    assert_float_equal(c[0].weight, 24, 1e-12);
    zone.keep = true;
    free(c);
    c = find(&count, &map, NULL);
    assert_int_equal(count, 0);
    free(c);
}

static void walk_around(struct walk *w, const struct box *boxes, int box_count, const struct tour_change *change)
{
    struct err err = ERR_INIT;
    walk_make(w, boxes, box_count, around, 6);
    assert_ok(walk_graph(w, &err), err);
    assert_ok(tour_walk_find(&w->stops, &w->stop_count, &w->g, &w->rays, &plan, change, 1, w->params.speed, &err), err);
    if (!w->stop_count) return;
    assert_ok(tour_keys_make(&w->keys, &w->key_count, &w->g, w->stops, w->stop_count, &w->params, &err), err);
    assert_ok(tour_frames_make(&w->path, &w->pairs, w->keys, w->key_count, &w->g, &w->axes, &w->rays, &w->params, &err),
              err);
}

/* f is too near to the middle of the floor, where the change is. */
static void the_camera_walks_around_the_change_and_looks_at_it(void **state)
{
    (void)state;
    const struct tour_change change = {.place = {0, 0, 0.5}, .weight = 1};
    struct walk w;
    walk_around(&w, hall, 2, &change);
    assert_int_equal(w.stop_count, 5);
    for (int i = 0; i < 5; i++) assert_string_not_equal(w.g.nodes[w.stops[i].node].photo, "f");
    for (int f = 0; f < w.path.frame_count; f++) {
        const struct view *v = &w.path.frames[f].camera;
        struct vec3 way = vec3_sub(change.place, v->center), axis = axis_of(v);
        way.z = axis.z = 0;
        assert_true(angle_between(way, axis) < 45 * M_PI / 180); /* azimuths between viewpoints are linear in time */
        if (!f) continue;
        const struct view *last = &w.path.frames[f - 1].camera;
        assert_true(angle_between(axis_of(last), axis_of(v)) * w.params.fps < 1.01 * w.params.turn * M_PI / 180);
    }
    walk_release(&w);
}

static void a_walk_takes_20_to_30_seconds(void **state)
{
    (void)state;
    const struct tour_change change = {.place = {0, 0, 0.5}, .weight = 1};
    struct walk w;
    walk_around(&w, hall, 2, &change);
    const double seconds = w.keys[w.key_count - 1].time - 2 * w.params.hold;
    assert_true(seconds >= 19.9 && seconds <= 30);
    for (int i = 0; i < w.stop_count; i++)
        assert_true(w.stops[i].passes == (i > 0 && i + 1 < w.stop_count) && w.stops[i].speed <= w.params.speed);
    walk_release(&w);
}

static void viewpoints_behind_a_wall_are_passed_by(void **state)
{
    (void)state;
    const struct tour_change change = {.place = {-1.5, 0, 0.5}, .weight = 1};
    struct walk w;
    walk_around(&w, parted, 3, &change);
    assert_true(w.stop_count >= 2);
    for (int i = 0; i < w.stop_count; i++) {
        const char *photo = w.g.nodes[w.stops[i].node].photo;
        assert_true(strcmp(photo, "d") && strcmp(photo, "e"));
    }
    walk_release(&w);
}

static void a_change_that_nobody_sees_makes_no_walk(void **state)
{
    (void)state;
    const struct tour_change change = {.place = {0, 0, -1}, .weight = 1}; /* below the floor */
    struct walk w;
    walk_around(&w, hall, 2, &change);
    assert_int_equal(w.stop_count, 0);
    walk_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_of_a_face_counts_for_the_room_that_it_bounds),
        cmocka_unit_test(what_is_in_a_wall_counts_for_the_room_beside_it),
        cmocka_unit_test(a_moved_thing_counts_where_it_was_and_where_it_is),
        cmocka_unit_test(a_cleared_room_counts),
        cmocka_unit_test(the_camera_walks_around_the_change_and_looks_at_it),
        cmocka_unit_test(a_walk_takes_20_to_30_seconds),
        cmocka_unit_test(viewpoints_behind_a_wall_are_passed_by),
        cmocka_unit_test(a_change_that_nobody_sees_makes_no_walk),
    };
    return cmocka_run_group_tests_name("changes", tests, NULL, NULL);
}
