/* The frames of a tour: where the camera is, where it looks, which viewpoints it blends; tours of one and two. */
#include "tests/unit/plan_tour/walk.h"

#include "stages/plan_tour/tour_picture.h"

static const struct box gap[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION_WITH_GAP};
static const struct place around[] = {{"p1", {-2, -1, 1.5}, 170}, {"p2", {0, 1.4, 1.5}, 0}, {"p3", {2, -1, 1.4}, 100}};

static void walk_around(struct walk *w)
{
    struct err err = ERR_INIT;
    walk_make(w, gap, 3, around, 3);
    assert_ok(walk_graph(w, &err), err);
    walk_along(w, (const int[]){0, 2}, 2);
}

static void every_frame_keeps_the_clearance(void **state)
{
    (void)state;
    struct walk w;
    walk_around(&w);
    assert_true(w.path.frame_count > 60);
    for (int f = 0; f < w.path.frame_count; f++) {
        const struct vec3 at = w.path.frames[f].camera.center;
        assert_true(model_rays_way_is_free(&w.rays, at, at, 0.199999));
        if (f) assert_true(model_rays_way_is_free(&w.rays, w.path.frames[f - 1].camera.center, at, 0.199999));
    }
    walk_release(&w);
}

static void orientation_is_continuous(void **state)
{
    (void)state;
    struct walk w;
    walk_around(&w);
    for (int f = 1; f < w.path.frame_count; f++) {
        const struct view *a = &w.path.frames[f - 1].camera, *b = &w.path.frames[f].camera;
        assert_true(angle_between(axis_of(a), axis_of(b)) <= w.params.turn / w.params.fps * M_PI / 180 + 1e-9);
        assert_true(vec3_length(vec3_sub(a->center, b->center)) <= w.params.speed / w.params.fps + 1e-9);
    }
    walk_release(&w);
}

static void a_tour_of_two_begins_and_ends_with_the_photos_axes(void **state)
{
    (void)state;
    struct walk w;
    walk_around(&w);
    const struct view *first = &w.path.frames[0].camera, *last = &w.path.frames[w.path.frame_count - 1].camera;
    assert_true(vec3_length(vec3_sub(first->center, around[0].at)) < 1e-9);
    assert_true(vec3_length(vec3_sub(last->center, around[2].at)) < 1e-9);
    assert_true(angle_between(axis_of(first), axis_of(&w.views[0])) < 1e-9);
    assert_true(angle_between(axis_of(last), axis_of(&w.views[2])) < 1e-9);
    walk_release(&w);
}

static void easing_takes_one_second_and_half_a_second(void **state)
{
    (void)state;
    /* a way of 4 m along +x; the photos look 20 degrees off it, which the fastest turn leaves time for */
    const struct box hall[] = {HALL_OUTSIDE, HALL_INSIDE};
    const struct place places[] = {{"p1", {-2, 0, 1.5}, 20}, {"p2", {2, 0, 1.5}, -20}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, hall, 2, places, 2);
    assert_ok(walk_graph(&w, &err), err);
    walk_along(&w, (const int[]){0, 1}, 2);
    const double times[] = {0, 1, 2, 4.5, 5, 6}, degrees[] = {20, 20, 0, 0, -20, -20}, x[] = {-2, -2, -1, 1.5, 2, 2};
    assert_int_equal(w.key_count, 6);
    for (int i = 0; i < 6; i++) {
        assert_float_equal(w.keys[i].time, times[i], 1e-9);
        assert_float_equal(w.keys[i].azimuth, degrees[i] * M_PI / 180, 1e-9);
        assert_float_equal(w.keys[i].at.x, x[i], 1e-9);
    }
    walk_release(&w);
}

static void a_leg_has_the_speed_of_the_stop_that_it_leads_to(void **state)
{
    (void)state;
    const struct box hall[] = {HALL_OUTSIDE, HALL_INSIDE};
    const struct place places[] = {{"p1", {-2, 0, 1.5}, 20}, {"p2", {2, 0, 1.5}, -20}};
    const struct tour_stop stops[] = {{.node = 0, .speed = 9}, {.node = 1, .speed = 0.5}, {.node = 0, .speed = 2}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, hall, 2, places, 2);
    assert_ok(walk_graph(&w, &err), err);
    assert_ok(tour_keys_make(&w.keys, &w.key_count, &w.g, stops, 3, &w.params, &err), err);
    /* 4 m at 0.5 m/s; back, the turns of 160 degrees take longer than walking 4 m at 2 m/s */
    assert_float_equal(w.keys[4].time, 1 + 8, 1e-9);
    assert_float_equal(w.keys[w.key_count - 1].time, 1 + 8 + 1 + 2 * 160 / w.params.turn + 1, 1e-9);
    walk_release(&w);
}

static void shares_of_a_pair_go_by_the_length_of_the_way(void **state)
{
    (void)state;
    struct walk w;
    walk_around(&w);
    int changes = 0;
    for (int f = 0; f < w.pairs.count; f++) {
        const struct viewpoint_pair *p = &w.pairs.list[f];
        const struct vec3 at = w.path.frames[f].camera.center;
        const bool on_second = !strcmp(p->photos[0], "p2");
        if (!strcmp(p->photos[0], "p3")) continue; /* the rest at the end */
        const struct vec3 a = around[on_second].at, b = around[on_second + 1].at;
        assert_string_equal(p->photos[0], around[on_second].photo);
        assert_string_equal(p->photos[1], around[on_second + 1].photo);
        assert_true(vec3_length(vec3_sub(at, vec3_add(a, vec3_scale(vec3_sub(b, a), p->t)))) < 1e-9);
        changes += f && strcmp(p->photos[0], w.pairs.list[f - 1].photos[0]) != 0;
    }
    assert_int_equal(changes, 1);
    assert_string_equal(w.pairs.list[w.pairs.count - 1].photos[1], "p3");
    walk_release(&w);
}

static void between_coincident_viewpoints_the_camera_turns_in_its_time(void **state)
{
    (void)state;
    const struct box hall[] = {HALL_OUTSIDE, HALL_INSIDE};
    const struct place places[] = {{"p1", {0, 0, 1.5}, 0}, {"p2", {0, 0, 1.5}, 180}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_make(&w, hall, 2, places, 2);
    assert_ok(walk_graph(&w, &err), err);
    assert_float_equal(w.g.weights[1], 1 + M_PI, 1e-5);
    walk_along(&w, (const int[]){0, 1}, 2);
    assert_float_equal(w.keys[w.key_count - 1].time, 2 * w.params.hold + 180 / w.params.turn, 1e-9);
    double most = 0;
    for (int f = 0; f < w.pairs.count; f++) {
        const struct viewpoint_pair *p = &w.pairs.list[f];
        const double turned = angle_between(axis_of(&w.path.frames[f].camera), vec3_make(1, 0, 0));
        assert_true(isfinite(turned) && p->t >= 0 && p->t <= 1);
        if (!strcmp(p->photos[0], "p1")) assert_float_equal(p->t, turned / M_PI, 1e-9);
        most = fmax(most, p->t);
    }
    assert_true(most > 0.9);
    walk_release(&w);
}

static void one_viewpoint_alone_gives_a_film_that_rests(void **state)
{
    (void)state;
    const struct box hall[] = {HALL_OUTSIDE, HALL_INSIDE};
    const struct model_plan plan = {0};
    struct err err = ERR_INIT;
    for (int hold = 0; hold < 2; hold++) {
        struct walk w;
        walk_make(&w, hall, 2, around, 1);
        w.params.hold = hold;
        assert_ok(walk_graph(&w, &err), err);
        assert_ok(tour_stops_find(&w.stops, &w.stop_count, &w.g, &plan, w.params.speed, NULL, NULL, &err), err);
        assert_int_equal(w.stop_count, 1);
        walk_along(&w, &w.stops[0].node, 1);
        assert_int_equal(w.path.frame_count, hold ? 31 : 1);
        for (int f = 0; f < w.path.frame_count; f++) {
            const struct viewpoint_pair *p = &w.pairs.list[f];
            assert_true(!strcmp(p->photos[0], "p1") && !strcmp(p->photos[1], "p1") && p->t == 0);
            assert_true(angle_between(axis_of(&w.path.frames[f].camera), axis_of(&w.views[0])) < 1e-9);
        }
        walk_release(&w);
    }
}

static int count_of(const char *text, const char *part)
{
    int n = 0;
    for (; (text = strstr(text, part)); text++) n++;
    return n;
}

static void the_picture_shows_rooms_stops_and_viewpoints(void **state)
{
    (void)state;
    struct model_room_corner corners[] = {{.x = -3, .y = -2}, {.x = 3, .y = -2}, {.x = 3, .y = 2}, {.x = -3, .y = 2}};
    struct model_room hall = {.name = (char *)"a < b & c", .corners = corners, .corner_count = 4};
    struct model_wall wall = {.name = (char *)"s", .normal = {0, 1}, .offset = -2, .thickness = 0.3, .span = {-3, 3}};
    const struct model_plan plan = {.rooms = &hall, .room_count = 1, .walls = &wall, .wall_count = 1};
    const struct tour_stop stops[] = {{.node = 0, .speed = 1}, {.node = 2, .speed = 1}};
    struct walk w;
    struct err err = ERR_INIT;
    walk_around(&w);
    w.g.nodes[1].usable = false;
    const char *file = scratch_path("plan.svg");
    assert_ok(tour_picture_write(&w.path, &w.g, stops, 2, &plan, &w.axes, file, &err), err);
    char *text = scratch_read(file);
    assert_int_equal(count_of(text, "<circle class=\"view\""), 2);
    assert_int_equal(count_of(text, "<circle class=\"left\""), 1);
    assert_int_equal(count_of(text, "<circle class=\"stop\""), 2);
    assert_int_equal(count_of(text, "<path class=\"look\""), 1 + (w.path.frame_count - 1) / 15);
    assert_contains(text, ">a &lt; b &amp; c</text>");
    /* 1000 px are 6 model units and 8 % on either side; the wall's body lies below its face */
    assert_contains(text, "<path class=\"wall\" d=\"M68.97 643.68L931.03 643.68L931.03 686.78L68.97 686.78Z\"/>");
    assert_lacks(text, "nan");
    assert_lacks(text, "inf");
    free(text);
    walk_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_frame_keeps_the_clearance),
        cmocka_unit_test(orientation_is_continuous),
        cmocka_unit_test(a_tour_of_two_begins_and_ends_with_the_photos_axes),
        cmocka_unit_test(easing_takes_one_second_and_half_a_second),
        cmocka_unit_test(a_leg_has_the_speed_of_the_stop_that_it_leads_to),
        cmocka_unit_test(shares_of_a_pair_go_by_the_length_of_the_way),
        cmocka_unit_test(between_coincident_viewpoints_the_camera_turns_in_its_time),
        cmocka_unit_test(one_viewpoint_alone_gives_a_film_that_rests),
        cmocka_unit_test(the_picture_shows_rooms_stops_and_viewpoints),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
