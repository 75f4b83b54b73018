/* Views of rooms of boxes: ids, depth, distances from depth jumps, by analytic truth and in hard cases. */
#include "tests/unit/trace_ids/room.h"

#include "common/base/parallel.h"

static void a_closed_room_has_no_empty_pixel(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    for (int k = 0; k < 12; k++) {
        const struct view v = view_at(vec3_make(1.9 - 0.3 * k, 0.1 * k, -0.7), k * 0.5236, 0.2 * k, 203, 151, 60);
        struct seen s = see(&m, &v, 0);
        for (int i = 0; i < v.width * v.height; i++) {
            assert_int_not_equal(s.ids.id[i], 0);
            assert_true(s.ids.z[i] > 0 && s.ids.z[i] < 6.93f); /* the room's diagonal */
        }
        see_release(&s);
    }
    model_rays_release(&m);
}

static void depth_is_that_of_the_wall(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    const struct view v = view_at(vec3_make(0.3, 0, -1), 0, 0, 64, 48, 200);
    struct seen s = see(&m, &v, 0);
    for (int i = 0; i < 64 * 48; i++) {
        assert_int_equal(s.ids.id[i], id_of(&m, "in/5"));
        assert_float_equal(s.ids.z[i], 3, 1e-6);
    }
    /* the frame's border is where the view ends */
    assert_float_equal(s.ids.jump[0], 1, 1e-6);
    assert_float_equal(s.ids.jump[10 * 64 + 5], 6, 1e-6);
    assert_float_equal(s.ids.jump[24 * 64 + 32], 24, 1e-6);
    see_release(&s);
    model_rays_release(&m);
}

static void an_edge_that_faces_share_is_no_jump(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    const struct view v = view_at(vec3_make(0, 0, 0), 0.7854, 0, 200, 100, 80); /* at a corner */
    struct seen s = see(&m, &v, 0);
    assert_int_not_equal(s.ids.id[50 * 200 + 60], s.ids.id[50 * 200 + 140]);
    for (int x = 50; x < 150; x++) assert_true(s.ids.jump[50 * 200 + x] == VIEW_IDS_FAR);
    see_release(&s);
    model_rays_release(&m);
}

static void a_post_in_front_of_a_wall_has_jumps(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"post", "post", {-0.1, -2, 1}, {0.1, 2, 1.2}, false}};
    struct model_rays m = make_rays(boxes, 3);
    const struct view v = view_at(vec3_make(0, 0, 0), 0, 0, 200, 100, 100);
    struct seen s = see(&m, &v, 0);
    const float *row = s.ids.jump + 50 * 200;
    assert_int_equal(s.ids.id[50 * 200 + 100], id_of(&m, "post/4"));
    /* the post is at 90 <= x < 110 */
    assert_float_equal(s.ids.z[50 * 200 + 90], 1, 1e-6);
    assert_float_equal(s.ids.z[50 * 200 + 89], 2, 1e-6);
    assert_float_equal(row[90], 1, 1e-6);
    assert_float_equal(row[89], 1, 1e-6);
    assert_float_equal(row[84], 6, 1e-6);
    assert_float_equal(row[99], 10, 1e-6);
    see_release(&s);
    model_rays_release(&m);
}

static void a_camera_inside_a_wall_sees_nothing(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    const struct view v = view_at(vec3_make(0, 0, 2.5), 0, 0, 32, 32, 32);
    struct seen s = see(&m, &v, 1);
    assert_true(s.trace.in_solid);
    for (int i = 0; i < 32 * 32; i++) assert_true(s.ids.id[i] == 0 && s.ids.z[i] == 0 && s.ids.jump[i] == 0);
    see_release(&s);
    model_rays_release(&m);
}

static void a_camera_on_a_face_sees_nothing(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    const struct vec3 places[] = {{0.3, 0.2, 2}, {2, 2, 0.1}, {2, 2, 2}, {0.3, 0.2, 2 - 1e-9}};
    for (int k = 0; k < 4; k++) {
        const struct view v = view_at(places[k], 1, 0, 16, 16, 16);
        struct seen s = see(&m, &v, 1);
        assert_true(s.trace.in_solid);
        for (int i = 0; i < 16 * 16; i++) assert_int_equal(s.ids.id[i], 0);
        see_release(&s);
    }
    const struct view v = view_at(vec3_make(0.3, 0.2, 1.999), 1, 0, 16, 16, 16);
    struct seen s = see(&m, &v, 1);
    assert_false(s.trace.in_solid);
    see_release(&s);
    model_rays_release(&m);
}

static void a_view_along_an_edge_shows_both_faces(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    /* just off the edge of the walls +x and +y, along it */
    const struct view v = view_at(vec3_make(1.999, 1.999, -1.5), 0, 0, 101, 101, 50);
    struct seen s = see(&m, &v, 0);
    for (int i = 0; i < 101 * 101; i++) assert_true(s.ids.id[i] && s.ids.z[i] > 0);
    assert_int_equal(s.ids.id[20 * 101 + 90], id_of(&m, "in/1"));
    assert_int_equal(s.ids.id[90 * 101 + 20], id_of(&m, "in/3"));
    see_release(&s);
    model_rays_release(&m);
}

static void a_face_seen_at_89_9_degrees_has_its_depth(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    const double above = 2 * tan(0.1 * 3.14159265358979 / 180); /* at a distance of 2 */
    const struct view v = view_at(vec3_make(0, 2 - above, 0), 0, 0, 65, 65, 3000);
    struct seen s = see(&m, &v, 0);
    for (int i = 0; i < 65 * 65; i++) {
        const double t = (i / 65 + 0.5 - v.cy) / v.fy;
        const double floor = t > 0 ? above / t : 1e9;
        assert_float_equal(s.ids.z[i], fmin(2, floor), 1e-4);
        if (i / 65 >= 40 && i / 65 < 60 && i % 65 >= 8 && i % 65 < 57)
            assert_true(s.ids.jump[i] > 4); /* no jumps within */
    }
    see_release(&s);
    model_rays_release(&m);
}

static void a_face_of_1e_minus_6_area_is_found(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"mote", "mote", {0, 0, 1}, {0.001, 0.001, 1.001}, false}};
    struct model_rays m = make_rays(boxes, 3);
    const struct view v = view_at(vec3_make(0.0005, 0.0005, 0), 0, 0, 21, 21, 5000);
    struct seen s = see(&m, &v, 0);
    assert_int_equal(s.ids.id[10 * 21 + 10], id_of(&m, "mote/4"));
    assert_float_equal(s.ids.z[10 * 21 + 10], 1, 1e-6);
    assert_int_equal(s.ids.id[0], id_of(&m, "in/5"));
    see_release(&s);
    model_rays_release(&m);
}

static void coplanar_faces_have_no_jump(void **state)
{
    (void)state;
    /* two boxes side by side, whose fronts are in one plane and share no edge */
    const struct box boxes[] = {{"a", "a", {-1, -1, 1}, {0, 1, 2}, false}, {"b", "b", {0, -1, 1}, {1, 1, 2}, false}};
    struct model_rays m = make_rays(boxes, 2);
    const struct view v = view_at(vec3_make(0.2, 0.1, 0), 0.3, 0, 120, 80, 150);
    struct seen s = see(&m, &v, 0);
    int fronts = 0;
    for (int x = 35; x < 85; x++) {
        fronts |= s.ids.id[40 * 120 + x] == (uint32_t)id_of(&m, "a/4") ? 1 : 0;
        fronts |= s.ids.id[40 * 120 + x] == (uint32_t)id_of(&m, "b/4") ? 2 : 0;
        if (s.ids.id[40 * 120 + 35] && s.ids.id[40 * 120 + 85]) assert_true(s.ids.jump[40 * 120 + x] >= 32);
    }
    assert_true(fronts & 2);
    see_release(&s);
    model_rays_release(&m);
}

static void a_view_of_one_pixel_works(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays m = make_rays(boxes, 2);
    const struct view v = view_at(vec3_make(0, 0, 0), 0, 0, 1, 1, 1);
    struct seen s = see(&m, &v, 0);
    assert_int_equal(s.ids.id[0], id_of(&m, "in/5"));
    assert_float_equal(s.ids.z[0], 2, 1e-6);
    assert_float_equal(s.ids.jump[0], 1, 0);
    assert_float_equal(s.ids.clutter[0], 0, 0);
    see_release(&s);
    model_rays_release(&m);
}

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"post", "post", {-0.1, -2, 1}, {0.1, 2, 1.2}, false}};
    struct model_rays m = make_rays(boxes, 3);
    const struct view v = view_at(vec3_make(0.2, 0.3, -1), 0.3, 0.2, 131, 97, 70);
    struct seen s[2];
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k + 1);
        s[k] = see(&m, &v, 1.9);
    }
    const size_t bytes = (size_t)v.width * (size_t)v.height * 4;
    assert_memory_equal(s[0].ids.id, s[1].ids.id, bytes);
    assert_memory_equal(s[0].ids.z, s[1].ids.z, bytes);
    assert_memory_equal(s[0].ids.jump, s[1].ids.jump, bytes);
    assert_memory_equal(s[0].ids.clutter, s[1].ids.clutter, bytes);
    for (int k = 0; k < 2; k++) see_release(&s[k]);
    model_rays_release(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_room_has_no_empty_pixel),
        cmocka_unit_test(depth_is_that_of_the_wall),
        cmocka_unit_test(an_edge_that_faces_share_is_no_jump),
        cmocka_unit_test(a_post_in_front_of_a_wall_has_jumps),
        cmocka_unit_test(a_camera_inside_a_wall_sees_nothing),
        cmocka_unit_test(a_camera_on_a_face_sees_nothing),
        cmocka_unit_test(a_view_along_an_edge_shows_both_faces),
        cmocka_unit_test(a_face_seen_at_89_9_degrees_has_its_depth),
        cmocka_unit_test(a_face_of_1e_minus_6_area_is_found),
        cmocka_unit_test(coplanar_faces_have_no_jump),
        cmocka_unit_test(a_view_of_one_pixel_works),
        cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
