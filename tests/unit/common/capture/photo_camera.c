/* photo_camera.c - a photo's pixels as rays, from any of its views. */
#include "common/capture/photo_camera.h"

#include "tests/unit/scratch.h"

static char photo[] = "b", left[] = "b@0", right[] = "b@1";
/* One fisheye photo with two views, rotated by 30 degrees to either side. */
static struct lens lenses[] = {
    {left,
     photo,
     {CAMERA_OPENCV_FISHEYE, 400, 200, {100, 100, 200, 100, -0.04, 0, 0, 0}},
     {0.96592582628906831, 0, 0.25881904510252074, 0}},
    {right,
     photo,
     {CAMERA_OPENCV_FISHEYE, 400, 200, {100, 100, 200, 100, -0.04, 0, 0, 0}},
     {0.96592582628906831, 0, -0.25881904510252074, 0}},
};
static const struct lens_list list = {lenses, 2};

/* The views of a photo whose pose is a rotation about z and a translation. */
static void make_views(struct view views[2], struct pose *own)
{
    *own = (struct pose){{sqrt(0.5), 0, 0, sqrt(0.5)}, {1, -2, 0.5}};
    for (int i = 0; i < 2; i++) {
        const struct mat3 turn = mat3_from_quat(lenses[i].view_from_photo);
        views[i] = (struct view){.name = lenses[i].view,
                                 .width = 300,
                                 .height = 200,
                                 .fx = 90,
                                 .fy = 90,
                                 .cx = 150,
                                 .cy = 100,
                                 .cam_from_world = mat3_multiply(turn, mat3_from_quat(own->rotation)),
                                 .translation = mat3_apply(turn, own->translation),
                                 .center = pose_center(own)};
    }
}

static void every_view_gives_the_same_rays(void **state)
{
    (void)state;
    struct view views[2];
    struct pose own;
    make_views(views, &own);
    const struct camera_set set = {.views = views, .view_count = 2};
    static const char *const names[3] = {"b", "b@0", "b@1"};
    for (int i = 0; i < 3; i++) {
        struct photo_camera c;
        struct err err = ERR_INIT;
        assert_ok(photo_camera_find(&c, names[i], &set, &list, "f", 3, &err), err);
        assert_int_equal(c.view_idx, i == 2);
        for (int k = 0; k < 6; k++) {
            const struct vec3 p = {0.3 * k, 1 - 0.4 * k, 4};
            double u, v, wanted_u, wanted_v;
            struct vec3 ray;
            assert_true(camera_project(&lenses[0].camera, pose_apply(&own, p), &wanted_u, &wanted_v));
            assert_true(photo_camera_project(&c, p, &u, &v));
            assert_true(fabs(u - wanted_u) < 1e-9 && fabs(v - wanted_v) < 1e-9);
            assert_true(photo_camera_ray(&c, u, v, &ray));
            const struct vec3 to = vec3_normalize(vec3_sub(p, pose_center(&own)));
            assert_true(vec3_length(vec3_sub(ray, to)) < 1e-8);
        }
        struct vec3 ray;
        assert_false(photo_camera_ray(&c, -0.1, 5, &ray));
        assert_false(photo_camera_ray(&c, 5, 200.1, &ray));
    }
}

static void an_unknown_name_is_rejected_with_a_similar_one(void **state)
{
    (void)state;
    struct view views[2];
    struct pose own;
    make_views(views, &own);
    const struct camera_set set = {.views = views, .view_count = 2};
    struct photo_camera c;
    struct err err = ERR_INIT;
    assert_int_equal(photo_camera_find(&c, "b@3", &set, &list, "marks.txt", 7, &err), ST_DATA);
    assert_err(err, ST_DATA, "marks.txt:7: found \"b@3\"");
    assert_contains(err.text, "did you mean b");
}

/* Indices are of the set, also where lenses.txt lists other views, or lacks one. */
static void the_first_view_of_a_photo_stands_for_it(void **state)
{
    char v[][4] = {"a", "b@0", "b@1", "b@2", "c", "d"}, photos[][4] = {"a", "b", "d", "0"};
    struct view views[] = {{.name = v[0]}, {.name = v[2]}, {.name = v[3]}, {.name = v[4]}, {.name = v[5]}};
    const struct camera_set set = {.views = views, .view_count = 5}; /* without b@0 */
    struct lens own[] = {{.view = photos[3], .photo = photos[3]}, {.view = v[0], .photo = photos[0]},
                         {.view = v[1], .photo = photos[1]},      {.view = v[2], .photo = photos[1]},
                         {.view = v[3], .photo = photos[1]},      {.view = v[5], .photo = photos[2]}};
    const struct lens_list known = {own, 6}; /* without c */
    static const int wanted[] = {0, 1, 1, 3, 4};
    (void)state;
    for (int i = 0; i < 5; i++) assert_int_equal(photo_of_view(&set, &known, i), wanted[i]);
    assert_string_equal(photo_lens_of_view(&set, &known, 2)->photo, "b");
    assert_null(photo_lens_of_view(&set, &known, 3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_view_of_a_photo_stands_for_it),
        cmocka_unit_test(every_view_gives_the_same_rays),
        cmocka_unit_test(an_unknown_name_is_rejected_with_a_similar_one),
    };
    return cmocka_run_group_tests_name("photo_camera", tests, NULL, NULL);
}
