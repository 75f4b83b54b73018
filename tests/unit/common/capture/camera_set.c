/* camera_set.c - rectified views: their order, their names, and depth along the axis. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/camera_set.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void write_set(const char *camera, const char *name)
{
    char cameras[256], images[512];
    snprintf(cameras, sizeof cameras, "1 PINHOLE 640 480 500 510 320 240\n2 %s\n", camera);
    snprintf(images, sizeof images,
             "1 1 0 0 0 0 0 0 1 a-1.exr\n5 6 3\n"
             "2 0.70710678118654757 0 0.70710678118654757 0 1 2 3 2 %s\n7 8 3\n"
             "3 1 0 0 0 0 0 0 1 b@0.exr\n\n",
             name);
    scratch_write("cameras.txt", cameras);
    scratch_write("images.txt", images);
    scratch_write("points3D.txt", "3 0 0 4 9 9 9 0.5 1 0 2 0\n");
}

/* "a-1.exr" comes before "a.exr", but a before a-1. */
static void views_are_in_order_of_name(void **state)
{
    (void)state;
    struct camera_set set;
    struct err err = ERR_INIT;
    write_set("SIMPLE_PINHOLE 100 100 50 50 50", "a.exr");
    assert_ok(camera_set_read(&set, scratch, NULL, &err), err);
    assert_int_equal(set.view_count, 3);
    assert_string_equal(set.views[0].name, "a");
    assert_string_equal(set.views[1].name, "a-1");
    assert_string_equal(set.views[2].name, "b@0");
    for (int i = 0; i < 3; i++) assert_int_equal(camera_set_find(&set, set.views[i].name), i);
    assert_int_equal(camera_set_find(&set, "b"), -1);
    assert_int_equal(camera_set_find(&set, "a.exr"), -1);
    assert_true(set.views[0].fx == 50 && set.views[0].fy == 50 && set.views[1].fy == 510);
    /* the model has the same order */
    assert_string_equal(set.model.images[0].name, "a.exr");
    assert_int_equal(set.model.points[0].track[0].image_idx, 1);
    assert_int_equal(set.model.points[0].track[1].image_idx, 0);
    camera_set_release(&set);
    camera_set_release(&set);
    camera_set_release(NULL);
}

static void depth_is_along_the_axis(void **state)
{
    (void)state;
    struct camera_set set;
    struct err err = ERR_INIT;
    double u = -1, v = -1;
    write_set("SIMPLE_PINHOLE 100 100 50 50 50", "a.exr");
    assert_ok(camera_set_read(&set, scratch, NULL, &err), err);
    /* rotation by 90 degrees about y maps world (x, y, z) to (z, y, -x), then + (1, 2, 3) */
    assert_near(view_project(&set.views[0], vec3_make(-2, 0, 4), &u, &v), 5, 1e-12);
    assert_near(u, 50 + 50 * 5 / 5.0, 1e-12);
    assert_near(v, 50 + 50 * 2 / 5.0, 1e-12);
    struct vec3 p = view_unproject(&set.views[0], u, v, 5);
    assert_near(vec3_length(vec3_sub(p, vec3_make(-2, 0, 4))), 0, 1e-12);
    u = v = -1;
    assert_true(view_project(&set.views[0], vec3_make(10, 0, 0), &u, &v) < 0);
    assert_true(u == -1 && v == -1);
    struct vec3 c = set.views[0].center;
    assert_near(view_project(&set.views[0], c, &u, &v), 0, 1e-12);
    camera_set_release(&set);
}

static void images_that_are_not_views_are_rejected(void **state)
{
    (void)state;
    struct camera_set set;
    struct err err = ERR_INIT;
    write_set("SIMPLE_RADIAL 100 100 50 50 50 0.1", "a.exr");
    assert_int_equal(camera_set_read(&set, scratch, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "found a SIMPLE_RADIAL camera for image \"a.exr\"");
    err = (struct err)ERR_INIT;
    write_set("SIMPLE_PINHOLE 100 100 50 50 50", "a.jpg");
    assert_int_equal(camera_set_read(&set, scratch, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "found image \"a.jpg\", wanted a name like VIEW.exr");
    assert_null(set.views);
    assert_null(set.model.images);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_in_order_of_name),
        cmocka_unit_test(depth_is_along_the_axis),
        cmocka_unit_test(images_that_are_not_views_are_rejected),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
