/* given_path.c - a film's cameras come back from transforms.json and COLMAP's text; what cannot be a film is named. */
#include "stages/plan_path/given_path.h"

#include <math.h>

#include "stages/plan_path/path_export.h"
#include "tests/unit/scratch.h"

enum { FRAMES = 12 };

/* One point in front of the cameras of make_path(). */
static struct sfm_point point = {.id = 1};
static const struct camera_set scene = {.model = {.points = &point, .point_count = 1}};

static void make_path(struct camera_path *p)
{
    struct err err = ERR_INIT;
    assert_ok(camera_path_init(p, "test", 25, FRAMES, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        const double a = 0.05 * i + 0.3, n = sqrt(1 + a * a + 0.01 + 0.04);
        struct view *v = &p->frames[i].camera;
        v->width = 320, v->height = 200, v->cx = 163.5, v->cy = 97.25, v->fx = 301.25 + i, v->fy = v->fx * 0.96;
        v->cam_from_world = mat3_from_quat((struct quat){1 / n, 0.1 / n, a / n, 0.2 / n});
        v->center = vec3_make(0.1 * i, 1.0 / 3, -2);
        v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
        p->frames[i].aperture = i ? 0.001 * i : 0;
        p->frames[i].focus = i ? 4 + i / 7.0 : 0;
    }
    point.position = view_unproject(&p->frames[0].camera, 160, 100, 50);
}

static void assert_same(const struct camera_path *a, const struct camera_path *b, bool with_lens)
{
    assert_int_equal(a->frame_count, b->frame_count);
    for (int i = 0; i < a->frame_count; i++) {
        const struct view *v = &a->frames[i].camera, *w = &b->frames[i].camera;
        assert_true(v->width == w->width && v->height == w->height && v->fx == w->fx && v->fy == w->fy);
        assert_true(v->cx == w->cx && v->cy == w->cy);
        assert_true(vec3_length(vec3_sub(v->center, w->center)) < 1e-12);
        assert_true(vec3_length(vec3_sub(v->translation, w->translation)) < 1e-12);
        for (int k = 0; k < 9; k++)
            assert_true(fabs(v->cam_from_world.m[k / 3][k % 3] - w->cam_from_world.m[k / 3][k % 3]) < 1e-12);
        assert_true(a->frames[i].time == b->frames[i].time);
        if (!with_lens) continue;
        assert_true(a->frames[i].aperture == b->frames[i].aperture && a->frames[i].focus == b->frames[i].focus);
    }
}

static void exported_paths_come_back(void **state)
{
    (void)state;
    struct camera_path path = {0}, again = {0};
    struct err err = ERR_INIT;
    make_path(&path);
    assert_ok(path_export_write(&path, scratch_path("move"), NULL, &err), err);
    assert_ok(camera_path_write(&path, scratch_path("move"), NULL, &err), err);
    assert_ok(given_path_read(&again, scratch_path("move/transforms.json"), "test", 25, &scene, NULL, &err), err);
    assert_same(&path, &again, true);
    camera_path_release(&again);
    assert_ok(given_path_read(&again, scratch_path("move/path"), "test", 25, &scene, NULL, &err), err);
    assert_same(&path, &again, false);
    camera_path_release(&again);
    camera_path_release(&path);
}

/* OpenGL's axes: this camera looks along -z, and its y axis is up. */
static void axes_are_those_of_opengl(void **state)
{
    (void)state;
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    struct sfm_point ahead = {.id = 1, .position = {1, 2, -10}};
    const struct camera_set set = {.model = {.points = &ahead, .point_count = 1}};
    const char *file =
        scratch_write("a.json", "{\"w\": 101, \"h\": 81, \"camera_angle_x\": 1.5707963267948966, \"frames\": ["
                                "{\"transform_matrix\": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]},"
                                "{\"transform_matrix\": [[1,0,0,1],[0,1,0,2],[0,0,1,4],[0,0,0,1]]}]}");
    double u, v;
    assert_ok(given_path_read(&path, file, "a", 25, &set, NULL, &err), err);
    const struct view *c = &path.frames[0].camera;
    assert_true(c->width == 100 && c->height == 80); /* even: the last column and row are gone */
    assert_true(fabs(c->fx - 50.5) < 1e-9 && c->cx == 50.5 && c->cy == 40.5);
    assert_true(fabs(view_project(c, vec3_make(2, 3, -7), &u, &v) - 10) < 1e-12);
    assert_true(fabs(u - 55.55) < 1e-9 && fabs(v - 35.45) < 1e-9); /* to the right of the middle, and above it */
    assert_true(path.frames[1].time == 0.04);
    camera_path_release(&path);
}

/* Names of a model without leading zeros. */
static void numbers_order_the_frames_of_a_model(void **state)
{
    (void)state;
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    point.position = vec3_make(0, 0, 10);
    assert_int_equal(mkdir(scratch_path("model"), 0777), 0);
    scratch_write("model/cameras.txt", "1 SIMPLE_PINHOLE 64 48 60 32 24\n");
    scratch_write("model/images.txt",
                  "1 1 0 0 0 0 0 10 1 10.png\n\n2 1 0 0 0 0 0 9 1 9.png\n\n3 1 0 0 0 0 0 2 1 2.png\n\n");
    assert_ok(given_path_read(&path, scratch_path("model"), "model", 25, &scene, NULL, &err), err);
    assert_int_equal(path.frame_count, 3);
    assert_true(path.frames[0].camera.center.z == -2 && path.frames[1].camera.center.z == -9);
    assert_true(path.frames[2].camera.center.z == -10 && path.frames[2].camera.fy == 60);
    camera_path_release(&path);
}

#define POSE "\"transform_matrix\": [[1,0,0,0],[0,-1,0,0],[0,0,-1,0],[0,0,0,1]]"

static void what_cannot_be_a_film_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *text, *what;
    } files[] = {
        {"", "x.json:"},
        {"{\"frames\": []}", "x.json has no list \"frames\""},
        {"{\"w\": 64, \"h\": 48, \"frames\": [{" POSE "}, {" POSE "}]}", "x.json: frame 1 has no focal length"},
        {"{\"fl_x\": 60, \"frames\": [{" POSE "}, {" POSE "}]}", "x.json: frame 1 has no size; wanted w and h"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"frames\": [{" POSE "}, {}]}",
         "frame 2: its transform_matrix is missing"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"frames\": [{" POSE "}, {\"w\": 66, " POSE "}]}",
         "frame 2: found a size of 66 x 48, wanted 64 x 48"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"k1\": 0.1, \"frames\": [{" POSE "}, {" POSE "}]}",
         "frame 1: found a lens with distortion"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"frames\": [{" POSE "}]}", "found a single camera"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"aperture\": 1, \"frames\": [{" POSE "}, {" POSE "}]}",
         "found aperture 1 and focus 0"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"camera_model\": \"EQUIRECTANGULAR\", \"frames\": [{" POSE "}]}",
         "found a panorama"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"frames\": [{\"transform_matrix\": "
         "[[1,0,0,0],[0,2,0,0],[0,0,1,0],[0,0,0,1]]}]}",
         "found a pose that is not a rotation"},
        {"{\"fl_x\": 60, \"w\": 64, \"h\": 48, \"frames\": [{\"transform_matrix\": "
         "[[1,0,0,0],[0,1,0,0],[0,0,1,-50],[0,0,0,1]]}, {\"transform_matrix\": "
         "[[1,0,0,0],[0,1,0,0],[0,0,1,-50],[0,0,0,1]]}]}",
         "found no camera that looks at the scene"},
    };
    point.position = vec3_make(0, 0, 10);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct camera_path path = {0};
        struct err err = ERR_INIT;
        const char *file = scratch_write("x.json", files[i].text);
        assert_int_equal(given_path_read(&path, file, "x", 25, &scene, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, files[i].what);
        assert_null(path.frames);
    }
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    assert_int_equal(mkdir(scratch_path("bent"), 0777), 0);
    scratch_write("bent/cameras.txt", "1 RADIAL 64 48 60 32 24 0.1 0\n");
    scratch_write("bent/images.txt", "1 1 0 0 0 0 0 10 1 a.png\n\n2 1 0 0 0 0 0 9 1 b.png\n\n");
    assert_int_equal(given_path_read(&path, scratch_path("bent"), "x", 25, &scene, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "image a.png: found a camera of the model RADIAL, wanted PINHOLE");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exported_paths_come_back),
        cmocka_unit_test(axes_are_those_of_opengl),
        cmocka_unit_test(numbers_order_the_frames_of_a_model),
        cmocka_unit_test(what_cannot_be_a_film_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
