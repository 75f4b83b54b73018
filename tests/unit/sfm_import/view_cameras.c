/* view_cameras.c - from lens to views: photos that stay as they are, views inside their photo, wide lenses. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/sfm_import/view_cameras.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { BORDER = 400 };

/* The photo's pixel of a view's pixel. */
static bool photo_pixel(const struct camera *lens, const struct photo_view *v, double u, double w, double *pu,
                        double *pv)
{
    double fx, fy, cx, cy;
    camera_focal(&v->camera, &fx, &fy, &cx, &cy);
    struct vec3 ray = vec3_make((u - cx) / fx, (w - cy) / fy, 1);
    return camera_project(lens, mat3_apply(mat3_transpose(mat3_from_quat(v->view_from_photo)), ray), pu, pv);
}

/* The view's border is inside the photo. slack: its smallest distance from each side of the photo. */
static void check_inside(const struct camera *lens, const struct photo_view *v, double slack[4])
{
    for (int i = 0; i < 4; i++) slack[i] = 1e9;
    for (int side = 0; side < 4; side++)
        for (int i = 0; i <= BORDER; i++) {
            double t = (double)i / BORDER, u = side < 2 ? side : t, w = side < 2 ? t : side - 2, pu = -1, pv = -1;
            assert_true(photo_pixel(lens, v, u * v->camera.width, w * v->camera.height, &pu, &pv));
            assert_true(pu > -1e-3 && pv > -1e-3 && pu < lens->width + 1e-3 && pv < lens->height + 1e-3);
            slack[0] = fmin(slack[0], pu);
            slack[1] = fmin(slack[1], lens->width - pu);
            slack[2] = fmin(slack[2], pv);
            slack[3] = fmin(slack[3], lens->height - pv);
        }
}

static void a_small_pinhole_photo_keeps_its_camera(void **state)
{
    (void)state;
    static const struct camera lenses[] = {
        {CAMERA_PINHOLE, 1600, 1200, {1500, 1490.5, 811, 589.25}},
        {CAMERA_SIMPLE_PINHOLE, 1, 1, {1.5, 0.5, 0.5}},
    };
    for (int i = 0; i < 2; i++) {
        struct photo_view views[MAX_PHOTO_VIEWS];
        struct err err = ERR_INIT;
        int count = 0;
        assert_ok(view_cameras_of_photo(views, &count, &lenses[i], 2, 110, &err), err);
        assert_int_equal(count, 1);
        assert_int_equal(views[0].part, -1);
        const struct camera *c = &views[0].camera;
        assert_true(c->model == lenses[i].model && c->width == lenses[i].width && c->height == lenses[i].height);
        assert_memory_equal(c->params, lenses[i].params, sizeof c->params);
        assert_true(views[0].view_from_photo.w == 1);
    }
}

static void large_photos_are_scaled_down_with_their_aspect_ratio(void **state)
{
    (void)state;
    struct camera lens = {CAMERA_PINHOLE, 6000, 4000, {5000, 5000, 3000, 2000}};
    struct photo_view views[MAX_PHOTO_VIEWS];
    struct err err = ERR_INIT;
    double slack[4];
    int count = 0;
    assert_ok(view_cameras_of_photo(views, &count, &lens, 2, 110, &err), err);
    const struct camera *c = &views[0].camera;
    assert_true((double)c->width * c->height <= 2e6 && (double)c->width * c->height > 1.99e6);
    assert_near((double)c->width / c->height, 1.5, 0.002);
    assert_near(c->params[0] / c->width, 5.0 / 6, 1e-3);
    check_inside(&lens, &views[0], slack);
    for (int i = 0; i < 4; i++) assert_true(slack[i] < 3.5); /* less than a view's pixel is cut off */
    assert_ok(view_cameras_of_photo(views, &count, &lens, 0, 110, &err), err);
    assert_int_equal(views[0].camera.width, 6000); /* no limit */
    lens.model = CAMERA_OPENCV;                    /* without distortion the picture is the same */
    assert_ok(view_cameras_of_photo(views, &count, &lens, 0, 110, &err), err);
    assert_int_equal(views[0].camera.width, 6000);
    assert_int_equal(views[0].camera.height, 4000);
    assert_near(views[0].camera.params[2], 3000, 1e-6);
}

static void a_view_is_the_largest_rectangle_without_blank_borders(void **state)
{
    (void)state;
    static const struct camera lenses[] = {
        {CAMERA_SIMPLE_RADIAL, 640, 480, {691, 320, 240, -0.1376}},
        {CAMERA_SIMPLE_RADIAL, 640, 480, {500, 300, 260, 0.25}},
        {CAMERA_RADIAL, 1200, 1600, {1300, 610, 790, -0.3, 0.1}},
        {CAMERA_OPENCV, 800, 600, {700, 710, 390, 320, -0.22, 0.04, -0.004, 0.006}},
        {CAMERA_FULL_OPENCV, 1920, 1080, {1100, 1090, 950, 545, 0.4, 0.1, 0.001, 0.0005, 0.02, 0.7, 0.15, 0.01}},
        {CAMERA_OPENCV_FISHEYE, 1000, 750, {600, 600, 500, 375, -0.03, 0.002, 0, 0}},
        {CAMERA_SIMPLE_RADIAL, 640, 480, {300, 320, 240, -0.2}}, /* the corners are beyond the fold */
    };
    for (size_t i = 0; i < sizeof lenses / sizeof *lenses; i++)
        for (int limit = 0; limit < 2; limit++) {
            struct photo_view views[MAX_PHOTO_VIEWS];
            struct err err = ERR_INIT;
            double slack[4], fx, fy, cx, cy;
            int count = 0;
            assert_ok(view_cameras_of_photo(views, &count, &lenses[i], limit ? 0.1 : 0, 125, &err), err);
            assert_int_equal(count, 1);
            check_inside(&lenses[i], &views[0], slack);
            const struct camera *c = &views[0].camera;
            camera_focal(&lenses[i], &fx, &fy, &cx, &cy);
            assert_near(c->params[0] / c->params[1], fx / fy, 1e-12);
            if (limit) assert_true(c->width * c->height <= 1e5);
            if (limit || i == 6) continue;
            assert_near(c->params[0], fx, 1e-9);
            for (int k = 0; k < 4; k++) assert_true(slack[k] < 1); /* and not smaller than necessary */
            double u, v;                                           /* the principal points correspond */
            assert_true(photo_pixel(&lenses[i], &views[0], c->params[2], c->params[3], &u, &v));
            assert_near(hypot(u - cx, v - cy), 0, 1e-9);
        }
}

static void the_field_of_view_is_measured_along_the_midlines(void **state)
{
    (void)state;
    struct camera pinhole = {CAMERA_PINHOLE, 200, 100, {100, 100, 100, 50}};
    struct camera fisheye = {CAMERA_OPENCV_FISHEYE, 1000, 800, {250, 250, 500, 400}};
    double h, v;
    view_lens_field(&pinhole, &h, &v);
    assert_near(h, M_PI / 2, 1e-12);
    assert_near(v, 2 * atan(0.5), 1e-12);
    view_lens_field(&fisheye, &h, &v);
    assert_near(h, 4, 1e-12); /* 229 degrees */
    assert_near(v, 3.2, 1e-12);
    fisheye.params[0] = 100; /* the picture is wider than the sphere: 180 degrees each side */
    view_lens_field(&fisheye, &h, &v);
    assert_near(h, 2 * M_PI, 1e-6);
}

static void a_fisheye_becomes_five_views(void **state)
{
    (void)state;
    struct camera lens = {CAMERA_OPENCV_FISHEYE,
                          2000,
                          2000,
                          {640, 640, 1000, 1000, -1.0 / 24, 1.0 / 1920, -1.0 / 322560, 1.0 / 92897280}};
    struct photo_view views[MAX_PHOTO_VIEWS];
    struct err err = ERR_INIT;
    int count = 0;
    assert_ok(view_cameras_of_photo(views, &count, &lens, 0, 110, &err), err);
    assert_int_equal(count, 5);
    static const double forward[5][3] = {{0, 0, 1}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
    for (int k = 0; k < 5; k++) {
        const struct camera *c = &views[k].camera;
        assert_int_equal(views[k].part, k);
        assert_int_equal(c->width, 1280);
        assert_int_equal(c->height, 1280);
        assert_true(c->params[0] == 640 && c->params[1] == 640 && c->params[2] == 640 && c->params[3] == 640);
        struct vec3 z = mat3_apply(mat3_transpose(mat3_from_quat(views[k].view_from_photo)), vec3_make(0, 0, 1));
        assert_near(vec3_length(vec3_sub(z, vec3_make(forward[k][0], forward[k][1], forward[k][2]))), 0, 1e-12);
    }
    /* view 3 is up in the picture: its centre is above the photo's centre, and its lower border is view 0's upper
     * border */
    double u, v, u2 = 0, v2 = 0;
    assert_true(photo_pixel(&lens, &views[3], 640, 640, &u, &v));
    assert_true(v < 1000 - 640 && fabs(u - 1000) < 1e-6);
    assert_true(photo_pixel(&lens, &views[3], 300, 1280, &u, &v) && photo_pixel(&lens, &views[0], 300, 0, &u2, &v2));
    assert_near(hypot(u - u2, v - v2), 0, 1e-6);
    assert_true(photo_pixel(&lens, &views[1], 1280, 300, &u, &v) && photo_pixel(&lens, &views[0], 0, 300, &u2, &v2));
    assert_near(hypot(u - u2, v - v2), 0, 1e-6);

    /* the limit holds for each view; a strip has no views up and down */
    assert_ok(view_cameras_of_photo(views, &count, &lens, 0.5, 110, &err), err);
    assert_int_equal(views[0].camera.width, 707);
    struct camera wide = {CAMERA_OPENCV_FISHEYE, 1600, 200, {700, 700, 800, 100}};
    assert_ok(view_cameras_of_photo(views, &count, &wide, 0, 110, &err), err);
    for (int k = 0; k < count; k++) assert_true(views[k].part < 3);
}

static void a_lens_that_leaves_no_picture_is_rejected(void **state)
{
    (void)state;
    struct camera lens = {CAMERA_SIMPLE_PINHOLE, 100, 100, {50, 400, 50}}; /* its axis is far outside the photo */
    struct camera tiny = {CAMERA_SIMPLE_RADIAL, 2, 2, {1e-3, 1, 1, 0.1}};
    struct photo_view views[MAX_PHOTO_VIEWS];
    struct err err = ERR_INIT;
    int count = 0;
    lens.model = CAMERA_SIMPLE_RADIAL;
    lens.params[3] = -0.9; /* and no pixel has a ray */
    assert_int_equal(view_cameras_of_photo(views, &count, &lens, 2, 110, &err), ST_DATA);
    assert_err(err, ST_DATA, "SIMPLE_RADIAL lens of 100 x 100 px leaves no picture");
    err = (struct err)ERR_INIT;
    assert_int_equal(view_cameras_of_photo(views, &count, &tiny, 2, 110, &err), ST_DATA);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_small_pinhole_photo_keeps_its_camera),
        cmocka_unit_test(large_photos_are_scaled_down_with_their_aspect_ratio),
        cmocka_unit_test(a_view_is_the_largest_rectangle_without_blank_borders),
        cmocka_unit_test(the_field_of_view_is_measured_along_the_midlines),
        cmocka_unit_test(a_fisheye_becomes_five_views),
        cmocka_unit_test(a_lens_that_leaves_no_picture_is_rejected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
