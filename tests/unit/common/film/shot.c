/* shot.c - tests of how the cameras of a move point and zoom. */
#include "common/film/shot.h"

#include "tests/unit/scratch.h"
#include "tests/unit/wall_scene.h"

/* The origin is not the world's. */
static struct shot_setup a_shot(void)
{
    return (struct shot_setup){
        .lens = {.name = "film", .width = 300, .height = 200, .fx = 240, .fy = 240, .cx = 150, .cy = 100},
        .up = {0, -1, 0},
        .origin = {1, 2, 3},
        .axis_x = {1, 0, 0},
        .axis_y = {0, 1, 0},
        .axis_z = {0, 0, 1},
        .low = {-1, -1},
        .high = {1, 1},
        .centroid = {1.5, 2.5, 13},
        .near_limit = 1,
        .median_depth = 10};
}

static struct subject_list subjects_of(struct subject *s, int count) { return (struct subject_list){s, count}; }

static struct shot_move make(const struct shot_setup *shot, enum camera_move move, const struct subject_list *subjects)
{
    struct shot_move m;
    struct err err = ERR_INIT;
    assert_ok(shot_move_make(&m, shot, move, subjects, &err), err);
    assert_int_equal(m.move, move);
    return m;
}

static void shot_and_world_coordinates_are_inverse(void **state)
{
    (void)state;
    struct shot_setup s = a_shot();
    s.axis_x = vec3_make(0, 0, -1);
    s.axis_y = vec3_make(0.6, 0.8, 0);
    s.axis_z = vec3_cross(s.axis_x, s.axis_y);
    const struct vec3 at = world_from_shot(&s, 2, 10, 5), back = shot_from_world(&s, at);
    assert_true(vec3_length(vec3_sub(back, vec3_make(2, 10, 5))) < 1e-12);
    assert_true(vec3_length(vec3_sub(at, vec3_make(1 + 6 + 4, 2 + 8 - 3, 3 - 2))) < 1e-12);
}

static void aimed_cameras_are_upright_and_point_at_the_target(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    for (int i = 0; i < 200; i++) {
        const struct vec3 at = vec3_make(sin(i), cos(2 * i), sin(3 * i)),
                          target = vec3_make(9 * sin(5 * i), 4 * cos(7 * i), 9 * cos(11 * i));
        const struct view v = shot_aim(&s, at, target, 77);
        assert_camera(&v);
        assert_true(v.fx == 77 && v.width == 300 && v.cx == 150 && v.center.x == at.x);
        assert_true(off_axis(&v, target) < 1e-9);
        const struct vec3 x = row_of(v.cam_from_world, 0), y = row_of(v.cam_from_world, 1),
                          z = row_of(v.cam_from_world, 2);
        assert_true(vec3_length(vec3_sub(vec3_cross(x, y), z)) < 1e-12); /* not mirrored */
        assert_true(fabs(vec3_dot(x, s.up)) < 1e-12 && vec3_dot(y, s.up) <= 0);
    }
}

static void degenerate_directions_still_give_a_camera(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    const struct vec3 at = vec3_make(4, 5, 6);
    struct view v = shot_aim(&s, at, at, 50); /* no direction: along the reference frame's z */
    assert_camera(&v);
    assert_true(vec3_length(vec3_sub(row_of(v.cam_from_world, 2), s.axis_z)) < 1e-12);
    for (int sign = -1; sign <= 1; sign += 2) { /* straight up and down: the reference frame's x points right */
        v = shot_aim(&s, at, vec3_make(4, 5 + sign * 7, 6), 50);
        assert_camera(&v);
        assert_true(vec3_length(vec3_sub(row_of(v.cam_from_world, 0), s.axis_x)) < 1e-12);
        assert_float_equal(row_of(v.cam_from_world, 2).y, sign, 1e-12);
        v = shot_aim(&s, at, vec3_make(4.001, 5 + sign * 7, 6), 50); /* nearly */
        assert_camera(&v);
        assert_true(off_axis(&v, vec3_make(4.001, 5 + sign * 7, 6)) < 1e-9);
    }
}

static void an_end_keeps_its_focal_length_or_a_size(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    struct shot_end end = {.target = {1, 2, 13}, .focal = 321};
    struct view v = shot_end_camera(&s, &end, vec3_make(5, 2, 3));
    assert_true(v.fx == 321 && off_axis(&v, end.target) < 1e-9);

    /* 2 units high, straight ahead: f h / z */
    struct subject square = upright_subject(1, 2, 13, 1, 1);
    end = (struct shot_end){.target = {1, 2, 13}, .size = 60};
    memcpy(end.corner, square.corner, sizeof end.corner);
    v = shot_end_camera(&s, &end, s.origin);
    assert_float_equal(v.fx, 60 * 10 / 2.0, 1e-9);
    v = shot_end_camera(&s, &end, vec3_make(1, 2, -7));
    assert_float_equal(v.fx, 60 * 20 / 2.0, 1e-9);
    for (int i = 0; i < 100; i++) {
        v = shot_end_camera(&s, &end, vec3_make(6 * sin(i), 5 * cos(3 * i), 4 * sin(7 * i)));
        assert_camera(&v);
        assert_float_equal(subject_size_in(&square, &v), 60, 1e-9);
    }
    /* behind the camera it has no size at any focal length */
    end.target = vec3_make(1, 2, -20);
    assert_true(shot_end_camera(&s, &end, s.origin).fx == 0);
}

static void establishing_moves_point_at_the_centroid(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    const struct vec3 at[2] = {{0, 2, 3}, {2, 2, 3}};
    struct shot_move m = make(&s, MOVE_ESTABLISHING_DOLLY, NULL);
    assert_false(m.on_axis);
    for (int i = 0; i <= 10; i++) {
        const struct view v = shot_camera(&s, &m, at, i / 10.0);
        assert_true(off_axis(&v, s.centroid) < 1e-9);
        assert_float_equal(v.fx, 240, 1e-9);
        assert_float_equal(v.center.x, 0.2 * i, 1e-12);
    }
    m = make(&s, MOVE_ESTABLISHING_DOLLY_OUT, NULL);
    assert_true(m.on_axis);
    for (int i = 0; i <= 10; i++) {
        const struct view v = shot_camera(&s, &m, at, i / 10.0);
        assert_true(off_axis(&v, s.centroid) < 1e-9);
        assert_float_equal(v.fx, 360 - 12 * i, 1e-9); /* from 1.5 f to f */
    }
}

static void dolly_out_is_dolly_in_reversed(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    struct subject face = upright_subject(2, 1, 9, 0.25, 0.5);
    const struct subject_list list = subjects_of(&face, 1);
    const struct vec3 lower = {2, 1.25, 9}; /* the middle of the lower half */
    const struct vec3 at[2] = {{0, 2, 3}, {2, 2, 5}}, back[2] = {at[1], at[0]};
    const struct shot_move in = make(&s, MOVE_DOLLY_IN, &list), out = make(&s, MOVE_DOLLY_OUT, &list);
    assert_false(in.on_axis || out.on_axis);
    for (int i = 0; i <= 10; i++) {
        const struct view a = shot_camera(&s, &in, at, i / 10.0), b = shot_camera(&s, &out, back, 1 - i / 10.0);
        assert_true(vec3_length(vec3_sub(a.center, b.center)) < 1e-12);
        assert_float_equal(a.fx, 240 + 12 * i, 1e-9);
        assert_float_equal(a.fx, b.fx, 1e-9);
    }
    const struct view first = shot_camera(&s, &in, at, 0), last = shot_camera(&s, &in, at, 1);
    assert_true(off_axis(&first, s.centroid) < 1e-9 && off_axis(&last, lower) < 1e-9);
    double u, w;
    view_project(&last, subject_center(&face), &u, &w);
    assert_true(w < last.cy && fabs(u - last.cx) < 1e-9); /* the face is above the frame's centre */
}

static void dolly_zoom_keeps_the_subjects_size(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    struct subject face = upright_subject(2, 1, 9, 0.5, 1);
    const struct subject_list list = subjects_of(&face, 1);
    const struct view at_origin = shot_aim(&s, s.origin, s.centroid, 240);
    const double promised = subject_size_in(&face, &at_origin);
    const struct vec3 at[2] = {{1, 2, 5}, {1, 2, -4}};
    for (int move = MOVE_DOLLY_ZOOM; move <= MOVE_DOLLY_ZOOM_IN; move++) {
        const struct shot_move m = make(&s, (enum camera_move)move, &list);
        double before = 0;
        assert_true(m.on_axis);
        for (int i = 0; i <= 50; i++) {
            const struct view v = shot_camera(&s, &m, at, i / 50.0);
            assert_float_equal(subject_size_in(&face, &v), promised, 1e-9);
            assert_true(off_axis(&v, s.centroid) < 1e-9);
            assert_true(v.fx > before); /* longer farther away */
            before = v.fx;
        }
    }
}

static void dolly_ends_at_the_second_subject_in_the_size_of_the_first(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    struct subject two[2] = {upright_subject(-1, 2, 8, 0.4, 0.5), upright_subject(4, 3, 15, 1, 1.5)};
    const struct subject_list list = subjects_of(two, 2);
    const struct shot_move m = make(&s, MOVE_DOLLY, &list);
    const struct view first_at_origin = shot_aim(&s, s.origin, subject_center(&two[0]), 360);
    const double promised = subject_size_in(&two[0], &first_at_origin);
    const struct vec3 at[2] = {{0, 2, 4}, {3, 2, 2}};
    const struct view first = shot_camera(&s, &m, at, 0), last = shot_camera(&s, &m, at, 1),
                      middle = shot_camera(&s, &m, at, 0.5);
    assert_float_equal(subject_size_in(&two[0], &first), promised, 1e-9);
    assert_float_equal(subject_size_in(&two[1], &last), promised, 1e-9);
    assert_true(off_axis(&first, vec3_make(-1, 2, 8)) < 1e-9 && off_axis(&last, vec3_make(4, 3, 15)) < 1e-9);
    assert_true(off_axis(&middle, vec3_make(1.5, 2.5, 11.5)) < 1e-9);
    assert_float_equal(middle.fx, 0.5 * (first.fx + last.fx), 1e-9);
    assert_true(vec3_length(vec3_sub(middle.center, vec3_make(1.5, 2, 3))) < 1e-12);

    /* 3 units high, straight ahead at depth 10 */
    const struct view facing = shot_end_camera(&s, &m.end[1], vec3_make(4, 3, 5));
    assert_float_equal(facing.fx, promised * 10 / 3, 1e-9);
}

static void missing_subjects_and_subjects_behind_the_camera_are_errors(void **state)
{
    (void)state;
    const struct shot_setup s = a_shot();
    struct subject one[2] = {upright_subject(1, 2, -9, 0.5, 1), upright_subject(1, 2, 9, 0.5, 1)};
    struct shot_move m;
    for (int move = 0; move < MOVE_COUNT; move++)
        for (int count = 0; count < film_move_subjects((enum camera_move)move); count++) {
            const struct subject_list few = subjects_of(one + 1, count);
            struct err err = ERR_INIT;
            char words[32];
            snprintf(words, sizeof words, "needs %d subjects", film_move_subjects((enum camera_move)move));
            assert_int_equal(shot_move_make(&m, &s, (enum camera_move)move, count ? &few : NULL, &err), ST_DATA);
            assert_err(err, ST_DATA, words);
        }
    /* the camera points at the centroid, so the subject is behind it */
    const struct subject_list behind = subjects_of(one, 2);
    for (int move = MOVE_DOLLY_ZOOM; move <= MOVE_DOLLY_ZOOM_IN; move++) {
        struct err err = ERR_INIT;
        assert_int_equal(shot_move_make(&m, &s, (enum camera_move)move, &behind, &err), ST_DATA);
        assert_err(err, ST_DATA, "the subject in view view is not in front");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shot_and_world_coordinates_are_inverse),
        cmocka_unit_test(aimed_cameras_are_upright_and_point_at_the_target),
        cmocka_unit_test(degenerate_directions_still_give_a_camera),
        cmocka_unit_test(an_end_keeps_its_focal_length_or_a_size),
        cmocka_unit_test(establishing_moves_point_at_the_centroid),
        cmocka_unit_test(dolly_out_is_dolly_in_reversed),
        cmocka_unit_test(dolly_zoom_keeps_the_subjects_size),
        cmocka_unit_test(dolly_ends_at_the_second_subject_in_the_size_of_the_first),
        cmocka_unit_test(missing_subjects_and_subjects_behind_the_camera_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
