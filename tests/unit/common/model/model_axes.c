/* model_axes.c - the model's frame: transforms, cameras, the file. */
#include "common/model/model_axes.h"

#include <string.h>

#include "tests/unit/scratch.h"

static struct model_axes example(void)
{
    const double s = sqrt(0.5);
    return (struct model_axes){.rotation = {s, 0, 0, s}, /* a quarter turn about z: x to y */
                               .translation = {1, 2, 3},
                               .scale = 2,
                               .metric = true,
                               .ceiling = 2.6,
                               .thickness = 0.1,
                               .tilt_error = 1.0 / 3,
                               .heading_error = 0.1,
                               .floor_error = 0.01,
                               .ceiling_error = 0.02,
                               .scale_error = 0.003};
}

static void assert_point(struct vec3 p, double x, double y, double z)
{
    assert_true(fabs(p.x - x) < 1e-12 && fabs(p.y - y) < 1e-12 && fabs(p.z - z) < 1e-12);
}

static void points_and_directions_are_transformed_and_restored(void **state)
{
    (void)state;
    const struct model_axes a = example();
    const struct vec3 p = {0.3, -4, 7};
    assert_point(model_from_world_point(&a, vec3_make(1, 0, 0)), 1, 4, 3);
    assert_point(model_from_world_direction(&a, vec3_make(1, 0, 0)), 0, 1, 0);
    assert_point(world_from_model_point(&a, model_from_world_point(&a, p)), 0.3, -4, 7);
    assert_point(world_from_model_direction(&a, model_from_world_direction(&a, p)), 0.3, -4, 7);
}

static void a_transformed_camera_has_the_same_picture(void **state)
{
    (void)state;
    const struct model_axes a = example();
    const struct pose pose = {{0.5, 0.5, -0.5, 0.5}, {0.2, -0.3, 1.5}};
    const struct view view = {.width = 20,
                              .height = 10,
                              .fx = 8,
                              .fy = 9,
                              .cx = 10,
                              .cy = 5,
                              .cam_from_world = mat3_from_quat(pose.rotation),
                              .translation = pose.translation,
                              .center = pose_center(&pose)};
    const struct view moved = model_from_world_view(&a, &view);
    for (int i = 0; i < 8; i++) {
        const struct vec3 p = {i & 1 ? 3 : -2, i & 2 ? 4 : 1, i & 4 ? 5 : -6}, q = model_from_world_point(&a, p);
        const struct vec3 before = pose_apply(&pose, p);
        const struct vec3 after = vec3_add(mat3_apply(moved.cam_from_world, q), moved.translation);
        assert_point(after, 2 * before.x, 2 * before.y, 2 * before.z); /* depths in model units */
        double u[2] = {0}, v[2] = {0};
        const double z = view_project(&view, p, &u[0], &v[0]);
        assert_float_equal(view_project(&moved, q, &u[1], &v[1]), 2 * z, 1e-12);
        if (z > 0) assert_true(fabs(u[0] - u[1]) < 1e-10 && fabs(v[0] - v[1]) < 1e-10);
    }
    const struct vec3 c = model_from_world_point(&a, view.center);
    assert_point(moved.center, c.x, c.y, c.z);
}

static void a_written_file_is_read_back_exactly(void **state)
{
    (void)state;
    struct model_axes a = example(), b;
    struct err err = ERR_INIT;
    const char *path = scratch_path("axes.txt");
    for (int k = 0; k < 3; k++) {
        if (k == 1) a.thickness = 0;
        if (k == 2) {
            a.metric = false;
            a.scale = 1;
            a.scale_error = a.ceiling = a.ceiling_error = 0;
        }
        assert_ok(model_axes_write(&a, path, NULL, &err), err);
        assert_ok(model_axes_read(&b, path, NULL, &err), err);
        assert_memory_equal(&a.rotation, &b.rotation, sizeof a.rotation);
        assert_memory_equal(&a.translation, &b.translation, sizeof a.translation);
        assert_true(a.scale == b.scale && a.metric == b.metric && a.ceiling == b.ceiling &&
                    a.thickness == b.thickness && a.tilt_error == b.tilt_error && a.heading_error == b.heading_error &&
                    a.floor_error == b.floor_error && a.ceiling_error == b.ceiling_error &&
                    a.scale_error == b.scale_error);
    }
}

#define HEAD  "remodel-axes 1\nrotation 1 0 0 0\ntranslation 0 0 0\n"
#define TAIL  "error tilt 0\nerror heading 0\nerror floor 0\n"
#define WHOLE HEAD "scale 1 unknown\nceiling none\nthickness none\n" TAIL "error ceiling none\nerror scale none\n"

static void errors_in_files_name_the_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"remodel-axes 2\n", ":1:"},
        {"remodel-axes 1\nrotation 1 1 0 0\n", ":2: found \"1.41421356\", wanted a quaternion of length 1"},
        {HEAD "scale 0 metres\n", ":4: found \"0\", wanted a scale above 0"},
        {HEAD "scale 2 unknown\n", ":4: found \"2\", wanted 1, as the scale is unknown"},
        {HEAD "scale 2 feet\n", ":4: found \"feet\", wanted \"metres\" or \"unknown\""},
        {HEAD "scale 1 unknown\nceiling -1\n", ":5: found \"-1\", wanted a length above 0, or none"},
        {HEAD "scale 1 unknown\nceiling nan\n", ":5: found \"nan\""},
        {HEAD "scale 1 unknown\nceiling 2\nthickness none\n" TAIL "error ceiling none\n", ":10: found \"none\""},
        {HEAD "scale 1 unknown\nceiling none\nthickness none\n" TAIL "error ceiling 1\n", ":10: found \"1\""},
        {HEAD "scale 1 unknown\nceiling none\nthickness none\nerror tilt -1\n", ":7: found \"-1\""},
        {WHOLE "more\n", ":12: found \"more\", wanted the end of the file"},
        {HEAD, "wanted a line \"scale ...\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct model_axes a;
        struct err err = ERR_INIT;
        const char *path = scratch_write("axes.txt", cases[i].text);
        assert_int_equal(model_axes_read(&a, path, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].words);
        assert_true(a.scale == 0);
    }
    struct model_axes a;
    struct err err = ERR_INIT;
    assert_ok(model_axes_read(&a, scratch_write("axes.txt", WHOLE), NULL, &err), err);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_and_directions_are_transformed_and_restored),
        cmocka_unit_test(a_transformed_camera_has_the_same_picture),
        cmocka_unit_test(a_written_file_is_read_back_exactly),
        cmocka_unit_test(errors_in_files_name_the_line),
    };
    return cmocka_run_group_tests_name("model_axes", tests, scratch_make, scratch_remove);
}
