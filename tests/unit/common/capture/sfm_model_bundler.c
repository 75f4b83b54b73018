/* sfm_model_bundler.c - models in Bundler's format: axes, errors. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/sfm_model.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* A point straight ahead and one up to the right have the same pixels in Bundler's axes and in ours. */
static void bundler_axes_become_colmap_axes(void **state)
{
    (void)state;
    /* camera 0 looks along Bundler's -z from (0, 0, 5): p = X + (0, 0, -5); camera 1 is not placed; camera 2 is rotated
     * by 90 degrees about y, so that it looks along +x from (-4, 0, 0) */
    const char *text = "# Bundle file v0.3\n3 2\n"
                       "100 -0.2 0.01\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n"
                       "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
                       "200 0 0\n0 0 1\n0 1 0\n-1 0 0\n0 0 -4\n"
                       "0 0 0\n10 20 30\n2 0 17 0 0 2 4 0 0\n"
                       "1 2 0.5\n255 255 0\n3 0 1 20.1376 40.2752 1 3 0 0 2 5 0 0\n";
    const char *const names[] = {"z.jpg", "lost.jpg", "a.jpg"};
    const int sizes[][2] = {{60, 100}, {60, 100}, {80, 40}};
    struct sfm_model m;
    struct err err = ERR_INIT;
    double u, v;
    assert_ok(sfm_model_read_bundler(&m, scratch_write("bundle.out", text), names, sizes, 3, &err), err);
    assert_int_equal(m.image_count, 2);
    assert_string_equal(m.images[0].name, "a.jpg");
    assert_string_equal(m.images[1].name, "z.jpg");
    const struct camera *z = &m.cameras[m.images[1].camera_idx].camera, *a = &m.cameras[m.images[0].camera_idx].camera;
    assert_int_equal(z->model, CAMERA_RADIAL);
    assert_int_equal(z->height, 100);

    /* X - C = (1, 2, -4.5) in Bundler's camera: plane coordinates x = 1 / 4.5, y = 2 / 4.5 upwards */
    double x = 1 / 4.5, y = 2 / 4.5, s = x * x + y * y, g = 1 - 0.2 * s + 0.01 * s * s;
    assert_true(camera_project(z, pose_apply(&m.images[1].cam_from_world, m.points[1].position), &u, &v));
    assert_near(u, 30 + 100 * g * x, 1e-12);
    assert_near(v, 50 - 100 * g * y, 1e-12);
    assert_near(m.images[1].observations[1].u, 30 + 20.1376, 1e-12);
    assert_near(m.images[1].observations[1].v, 50 - 40.2752, 1e-12);
    assert_int_equal(m.points[1].track_count, 2); /* without the camera that was not placed */

    /* the rotated camera: the origin is 4 ahead of it, in its centre; the other point at (1, 2, 0.5) is 5 ahead, 2 up,
     * and world z is to its right */
    assert_true(camera_project(a, pose_apply(&m.images[0].cam_from_world, m.points[0].position), &u, &v));
    assert_near(u, 40, 1e-12);
    assert_near(v, 20, 1e-12);
    assert_true(camera_project(a, pose_apply(&m.images[0].cam_from_world, m.points[1].position), &u, &v));
    assert_near(u, 40 + 200 * 0.5 / 5, 1e-12);
    assert_near(v, 20 - 200 * 2.0 / 5, 1e-12);
    struct vec3 center = pose_center(&m.images[0].cam_from_world);
    assert_near(vec3_length(vec3_sub(center, vec3_make(-4, 0, 0))), 0, 1e-12);
    assert_int_equal(m.points[0].track[0].image_idx, 1);

    /* it can be written and read in COLMAP's format */
    struct sfm_model back;
    assert_ok(sfm_model_write_text(&m, scratch, NULL, &err), err);
    assert_ok(sfm_model_read_text(&back, scratch, NULL, &err), err);
    assert_int_equal(back.point_count, 2);
    sfm_model_release(&m);
    sfm_model_release(&back);
}

static void errors_name_the_file_and_line(void **state)
{
    (void)state;
#define ONE_CAMERA "# Bundle file v0.3\n1 1\n100 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n"
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"# Bundle file v0.1\n1 0\n", "bundle.out:1: found another first line"},
        {"", "bundle.out:1"},
        {"# Bundle file v0.3\n2 0\n", "found 2 cameras, wanted 1"},
        {"# Bundle file v0.3\n1 0\n100 0\n", "bundle.out:3: found the end of the line"},
        {"# Bundle file v0.3\n1 0\n100 0 0\n1 0 0\n0 1 0\n0 0 2\n0 0 0\n", "no rotation for camera 0"},
        {"# Bundle file v0.3\n1 0\n-100 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n", "focal length is -100"},
        {"# Bundle file v0.3\n1 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n", "contains no camera that Bundler could place"},
        {ONE_CAMERA "0 0 0\n", "colour of a point"},
        {ONE_CAMERA "0 0 0\n0 0 300\n1 0 0 0 0\n", "found \"300\""},
        {ONE_CAMERA "0 0 0\n0 0 0\n1 1 0 0 0\n", "camera of a view"},
        {ONE_CAMERA "0 0 0\n0 0 0\n2 0 0 0 0\n", "end of the line"},
        {ONE_CAMERA "0 0 0\n0 0 0\n1 0 0 0 0\n1 2 3\n", "wanted the end of the file"},
    };
    const char *const names[] = {"a.jpg"};
    const int sizes[][2] = {{10, 10}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct sfm_model m;
        struct err err = ERR_INIT;
        assert_int_not_equal(
            sfm_model_read_bundler(&m, scratch_write("bundle.out", bad[i].text), names, sizes, 1, &err), ST_OK);
        assert_err(err, ST_DATA, bad[i].message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bundler_axes_become_colmap_axes),
        cmocka_unit_test(errors_name_the_file_and_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
