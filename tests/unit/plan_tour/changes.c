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

static void walk_between(struct walk *w, const struct place *places, int count, const struct box *boxes, int box_count,
                         const struct tour_change *change)
{
    struct err err = ERR_INIT;
    walk_make(w, boxes, box_count, places, count);
    assert_ok(walk_graph(w, &err), err);
    assert_ok(tour_walk_find(&w->stops, &w->stop_count, &w->g, &w->rays, &plan, change, 1, w->params.speed, &err), err);
    if (!w->stop_count) return;
    assert_ok(tour_keys_make(&w->keys, &w->key_count, &w->g, w->stops, w->stop_count, &w->params, &err), err);
    assert_ok(tour_frames_make(&w->path, &w->pairs, w->keys, w->key_count, &w->g, &w->axes, &w->rays, &w->params, &err),
              err);
}

static void walk_around(struct walk *w, const struct box *boxes, int box_count, const struct tour_change *change)
{
    walk_between(w, around, 6, boxes, box_count, change);
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

/* From frame to frame: nobody walks faster than the pace, and the eyes turn only while the feet move. */
static void nobody_runs_or_spins(const struct walk *w)
{
    double on_the_spot = 0;
    for (int f = 1; f < w->path.frame_count; f++) {
        const struct view *a = &w->path.frames[f - 1].camera, *b = &w->path.frames[f].camera;
        const double speed = vec3_length(vec3_sub(b->center, a->center)) * w->params.fps;
        const double turn = angle_between(axis_of(a), axis_of(b)) * 180 / M_PI;
        assert_true(speed < 1.001 * w->params.speed);
        assert_true(turn * w->params.fps < 1.01 * w->params.turn);
        on_the_spot = speed < 0.05 ? on_the_spot + turn : 0;
        assert_true(on_the_spot < 1);
    }
}

/* Three viewpoints in a corner: once past them takes 6 s at the slowest pace. */
static void a_short_way_is_walked_there_and_back(void **state)
{
    (void)state;
    static const struct place corner[] = {
        {"a", {2.0, -1.7, 1.5}, 0}, {"b", {2.5, -1.5, 1.5}, 0}, {"c", {2.6, -0.5, 1.5}, 0}};
    const struct tour_change change = {.place = {-2.9, 1, 0.5}, .weight = 1};
    struct walk w;
    walk_between(&w, corner, 3, hall, 2, &change);
    const double seconds = w.keys[w.key_count - 1].time;
    assert_true(w.stop_count > 3);
    assert_true(seconds >= 20 && seconds <= 30);
    nobody_runs_or_spins(&w);
    walk_release(&w);
}

static void a_walk_has_a_walking_pace_and_no_spin(void **state)
{
    (void)state;
    const struct tour_change change = {.place = {0, 0, 0.5}, .weight = 1};
    struct walk w;
    walk_around(&w, hall, 2, &change);
    nobody_runs_or_spins(&w);
    walk_release(&w);
}

/* The middle of what is added is inside it: nobody sees that, but its sides. */
static void a_new_box_is_seen_by_its_sides(void **state)
{
    (void)state;
    const struct box boxed[] = {HALL_OUTSIDE, HALL_INSIDE, {"box/new", "new", {-0.4, -0.4, 0}, {0.4, 0.4, 0.8}, false}};
    struct tour_change change = {.place = {0, 0, 0.4}, .weight = 1};
    struct walk w;
    walk_between(&w, around, 5, boxed, 3, &change);
    assert_int_equal(w.stop_count, 0);
    walk_release(&w);
    change.parts[0] = vec3_make(0, -0.43, 0.4);
    change.parts[1] = vec3_make(0, 0.43, 0.4);
    change.part_count = 2;
    walk_between(&w, around, 5, boxed, 3, &change);
    assert_int_equal(w.stop_count, 5);
    walk_release(&w);
}

/* The largest eight, by weight, a little before their faces. */
static void the_largest_parts_of_a_change_are_kept(void **state)
{
    (void)state;
    struct vec3 parts[12][3];
    for (int i = 0; i < 12; i++) {
        const double size = 0.1 * (1 + (i * 5) % 12);
        parts[i][0] = vec3_make(3, -1, 1), parts[i][1] = vec3_make(3, -1 + size, 1),
        parts[i][2] = vec3_make(3, -1, 1 + size);
    }
    struct texture_face face = {.id = 1, .normal = {-1, 0, 0}, .offset = -3, .added = parts, .added_count = 12};
    const struct texture_map map = {.faces = &face, .face_count = 1};
    int count;
    struct tour_change *c = find(&count, &map, NULL);
    assert_int_equal(count, 1);
    assert_int_equal(c[0].part_count, TOUR_PARTS);
    for (int i = 0; i < TOUR_PARTS; i++) {
        const double size = 0.1 * (12 - i);
        assert_float_equal(c[0].part_weights[i], 0.5 * size * size, 1e-12);
        assert_float_equal(c[0].parts[i].y, -1 + size / 3, 1e-12);
        assert_float_equal(c[0].parts[i].x, 3 - 0.025, 1e-12);
    }
    free(c);
}

/* Before the partition are two viewpoints; one behind it sees the change through the gap. */
static void a_room_with_few_viewpoints_is_also_seen_from_the_next(void **state)
{
    (void)state;
    static const struct place few[] = {
        {"a", {-2.5, -1.5, 1.5}, 0}, {"b", {-2.5, 1.5, 1.5}, 0}, {"c", {1.5, 1.7, 1.5}, 0}};
    struct model_room_corner west[] = {{.x = -3, .y = -2}, {.x = 0, .y = -2}, {.x = 0, .y = 2}, {.x = -3, .y = 2}};
    struct model_room rooms = room;
    rooms.corners = west;
    const struct model_plan halves = {.rooms = &rooms, .room_count = 1};
    const struct tour_change change = {.place = {-1, 1.5, 0.5}, .weight = 1};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, parted, 3, few, 3);
    assert_ok(walk_graph(&w, &err), err);
    assert_ok(tour_walk_find(&w.stops, &w.stop_count, &w.g, &w.rays, &halves, &change, 1, w.params.speed, &err), err);
    bool there = false;
    for (int i = 0; i < w.stop_count; i++) there |= !strcmp(w.g.nodes[w.stops[i].node].photo, "c");
    assert_true(there);
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
        cmocka_unit_test(a_walk_has_a_walking_pace_and_no_spin),
        cmocka_unit_test(a_short_way_is_walked_there_and_back),
        cmocka_unit_test(a_new_box_is_seen_by_its_sides),
        cmocka_unit_test(the_largest_parts_of_a_change_are_kept),
        cmocka_unit_test(a_room_with_few_viewpoints_is_also_seen_from_the_next),
        cmocka_unit_test(viewpoints_behind_a_wall_are_passed_by),
        cmocka_unit_test(a_change_that_nobody_sees_makes_no_walk),
    };
    return cmocka_run_group_tests_name("changes", tests, NULL, NULL);
}
