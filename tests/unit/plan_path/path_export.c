/* path_export.c - tests that exported paths project points to the same pixels as view_project(). */
#include "stages/plan_path/path_export.h"

#include "tests/unit/scratch.h"

#include <jansson.h>
#include <math.h>

#define NAME "dolly \"in\" \\ # \xc3\xa9 \xf0\x9f\x8e\xa5\n"

/* Cameras that move to the right and rotate about all axes; the lens changes if `zoom`. */
static void make_path(struct camera_path *p, const char *effect, int frames, bool zoom)
{
    struct err err = ERR_INIT;
    assert_ok(camera_path_init(p, effect, 24000.0 / 1001, frames, &err), err);
    for (int i = 0; i < frames; i++) {
        const double a = 0.05 * i + 0.3;
        struct view *v = &p->frames[i].camera;
        v->width = 320, v->height = 200, v->cx = 163.5, v->cy = 97.25;
        v->fx = 301.25 + (zoom ? 10.0 / 3 * i : 0), v->fy = v->fx * 0.96;
        const double n = sqrt(1 + a * a + 0.01 + 0.04);
        v->cam_from_world = mat3_from_quat((struct quat){1 / n, 0.1 / n, a / n, 0.2 / n});
        v->center = vec3_make(0.1 * i, 1.0 / 3, -2);
        v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
        p->frames[i].aperture = zoom ? 0.001 * i : 0;
        p->frames[i].focus = zoom && i ? 4 + i / 7.0 : 0;
    }
}

static json_t *load(const char *path)
{
    json_error_t why;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &why);
    if (!root) fail_msg("%s:%d: %s", path, why.line, why.text);
    return root;
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value)) fail_msg("%s is not a number", key);
    return json_number_value(value);
}

/* Projects a point using the exported frame alone: world_from_cam, camera looking along -z, y up. */
static void project(const json_t *frame, struct vec3 world, double *u, double *v)
{
    const json_t *rows = json_object_get(frame, "transform_matrix");
    const double d[3] = {world.x, world.y, world.z};
    double m[4][4], c[3] = {0};
    assert_int_equal(json_array_size(rows), 4);
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 4; k++) m[i][k] = json_number_value(json_array_get(json_array_get(rows, i), k));
    assert_true(m[3][0] == 0 && m[3][1] == 0 && m[3][2] == 0 && m[3][3] == 1);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) c[k] += m[i][k] * (d[i] - m[i][3]);
    *u = number(frame, "cx") + number(frame, "fl_x") * c[0] / -c[2];
    *v = number(frame, "cy") - number(frame, "fl_y") * c[1] / -c[2];
}

static void transforms_project_points_as_the_path_does(void **state)
{
    (void)state;
    for (int zoom = 0; zoom < 2; zoom++) {
        struct camera_path p = {0};
        struct err err = ERR_INIT;
        double worst = 0;
        make_path(&p, "establishing_dolly", 7, zoom);
        assert_ok(path_export_write(&p, scratch_path("move"), NULL, &err), err);
        json_t *root = load(scratch_path("move/transforms.json"));
        const json_t *frames = json_object_get(root, "frames");
        assert_true(number(root, "remodel_transforms") == 1 && number(root, "fps") == p.fps);
        assert_true(number(root, "w") == 320 && number(root, "h") == 200);
        assert_int_equal(json_array_size(frames), 7);
        /* fields before the frames apply to all of them: no lens there if it changes */
        if (zoom)
            assert_true(!json_object_get(root, "fl_x") && !json_object_get(root, "camera_angle_x"));
        else
            assert_true(number(root, "fl_x") == 301.25 && number(root, "cy") == 97.25 &&
                        fabs(320 / 2 / tan(number(root, "camera_angle_x") / 2) - 301.25) < 1e-9);
        for (int i = 0; i < 7; i++) {
            const json_t *f = json_array_get(frames, (size_t)i);
            const struct view *camera = &p.frames[i].camera;
            char file[32];
            snprintf(file, sizeof file, "frames/%s.exr", camera->name);
            assert_string_equal(json_string_value(json_object_get(f, "file_path")), file);
            assert_true(number(f, "time") == p.frames[i].time && number(f, "aperture") == p.frames[i].aperture &&
                        number(f, "focus") == p.frames[i].focus);
            assert_true(number(f, "fl_x") == camera->fx && number(f, "fl_y") == camera->fy);
            assert_true(number(f, "w") == 320 && number(f, "h") == 200);
            for (int k = 0; k < 27; k++) {
                const double z = 0.5 + 3 * (k / 9); /* near to far */
                const struct vec3 at = view_unproject(camera, 160.0 * (k % 3), 100.0 * (k / 3 % 3), z);
                double u, v, x, y;
                assert_true(view_project(camera, at, &u, &v) > 0);
                project(f, at, &x, &y);
                worst = fmax(worst, fmax(fabs(u - x), fabs(v - y)));
            }
        }
        if (!(worst < 1e-9)) fail_msg("%g px apart", worst);
        json_decref(root);
        camera_path_release(&p);
    }
}

/* The text between two strings; the caller frees it. */
static char *between(const char *text, const char *before, const char *after)
{
    const char *from = strstr(text, before);
    assert_non_null(from);
    from += strlen(before);
    const char *to = strstr(from, after);
    assert_non_null(to);
    return strndup(from, (size_t)(to - from));
}

/* The value of one of the script's constants, which are JSON. */
static json_t *constant(const char *script, const char *before, const char *after)
{
    json_error_t why;
    char *text = between(script, before, after);
    json_t *value = json_loads(text, JSON_DECODE_ANY, &why);
    if (!value) fail_msg("%s%s: %s", before, text, why.text);
    free(text);
    return value;
}

static void the_script_has_the_same_frames(void **state)
{
    const struct provenance prov = {.stage = "plan_path", .version = "0"};
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    (void)state;
    make_path(&p, NAME, 5, true);
    assert_ok(path_export_write(&p, scratch_path("script"), &prov, &err), err);
    json_t *root = load(scratch_path("script/transforms.json"));
    char *text = scratch_read(scratch_path("script/blender.py"));
    json_t *name = constant(text, "\nNAME = ", "\n"), *fps = constant(text, "\nFPS = ", "\n");
    json_t *frames = constant(text, "\nFRAMES = ", "\n\n");
    assert_string_equal(json_string_value(name), NAME);
    assert_string_equal(json_string_value(json_object_get(root, "effect")), NAME);
    assert_string_equal(json_string_value(json_object_get(json_object_get(root, "made_by"), "stage")), "plan_path");
    assert_true(json_real_value(fps) == p.fps);
    assert_true(json_equal(frames, json_object_get(root, "frames")));
    assert_contains(text, "\n# remodel plan_path 0\n");
    assert_true(text[strlen(text) - 1] == '\n');
    json_decref(frames);
    json_decref(fps);
    json_decref(name);
    json_decref(root);
    free(text);
    camera_path_release(&p);
}

static void a_path_of_one_frame_is_exported(void **state)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    (void)state;
    make_path(&p, "", 1, true);
    assert_ok(path_export_write(&p, scratch_path("one"), NULL, &err), err);
    json_t *root = load(scratch_path("one/transforms.json"));
    assert_int_equal(json_array_size(json_object_get(root, "frames")), 1);
    assert_true(number(root, "fl_x") == 301.25);
    json_decref(root);
    camera_path_release(&p);
}

static void the_same_path_gives_the_same_bytes(void **state)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    (void)state;
    make_path(&p, "e", 3, true);
    assert_ok(path_export_write(&p, scratch_path("a"), NULL, &err), err);
    assert_ok(path_export_write(&p, scratch_path("b"), NULL, &err), err);
    for (int i = 0; i < 2; i++) {
        char *text = scratch_read(scratch_path(i ? "a/blender.py" : "a/transforms.json"));
        assert_file_text(scratch_path(i ? "b/blender.py" : "b/transforms.json"), text);
        free(text);
    }
    camera_path_release(&p);
}

static void values_that_json_cannot_express_are_refused(void **state)
{
    struct camera_path p = {0}, none = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(path_export_write(&none, scratch_path("none"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "without frames");
    make_path(&p, "e", 3, false);
    p.frames[1].camera.cam_from_world.m[1][2] = NAN;
    err = (struct err)ERR_INIT;
    assert_int_equal(path_export_write(&p, scratch_path("none"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "frame 0002 of the path e");
    camera_path_release(&p);
    make_path(&p, "e\xff", 3, false);
    err = (struct err)ERR_INIT;
    assert_int_equal(path_export_write(&p, scratch_path("none"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "not UTF-8");
    camera_path_release(&p);
    assert_int_equal(access(scratch_path("none"), F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_project_points_as_the_path_does),
        cmocka_unit_test(the_script_has_the_same_frames),
        cmocka_unit_test(a_path_of_one_frame_is_exported),
        cmocka_unit_test(the_same_path_gives_the_same_bytes),
        cmocka_unit_test(values_that_json_cannot_express_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
