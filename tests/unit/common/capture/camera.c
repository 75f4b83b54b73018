/* camera.c - camera models: closed forms, round trips up to the corners, and the end of the one-to-one range. */
#include "tests/unit/scratch.h"
#include <setjmp.h>

#include <math.h>

#include "common/base/rng.h"
#include "common/capture/camera.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance)) /* cmocka compares float only */

static const struct camera lenses[] = {
    {CAMERA_SIMPLE_PINHOLE, 640, 480, {500, 320, 240}},
    {CAMERA_PINHOLE, 640, 480, {500, 480, 310, 255.5}},
    {CAMERA_SIMPLE_RADIAL, 640, 480, {691, 320, 240, -0.1376}},
    {CAMERA_SIMPLE_RADIAL, 640, 480, {400, 320, 240, 0.3}},
    {CAMERA_RADIAL, 1600, 1202, {1679, 800, 601, -0.25, 0.06}},
    {CAMERA_OPENCV, 1536, 1024, {1380, 1375, 760, 503, -0.08, 0.09, 0.0011, -0.0007}},
    {CAMERA_OPENCV, 800, 600, {500, 510, 390, 320, -0.22, 0.04, -0.01, 0.02}},
    {CAMERA_FULL_OPENCV, 1920, 1080, {1100, 1090, 950, 545, 0.4, 0.1, 0.001, 0.0005, 0.02, 0.7, 0.15, 0.01}},
    {CAMERA_OPENCV_FISHEYE, 2000, 2000, {640, 640, 1000, 1000, 0.02, -0.004, 0.0005, -0.00002}},
    {CAMERA_OPENCV_FISHEYE, 1000, 800, {350, 352, 505, 396, -1.0 / 24, 1.0 / 1920, -1.0 / 322560, 1.0 / 92897280}},
    {CAMERA_FOV, 640, 480, {300, 310, 322, 238, 0.93}},
    {CAMERA_FOV, 640, 480, {600, 600, 320, 240, -1e-3}},
    {CAMERA_SIMPLE_RADIAL_FISHEYE, 1000, 800, {350, 505, 396, -0.03}},
    {CAMERA_RADIAL_FISHEYE, 1000, 800, {350, 505, 396, 0.02, -0.004}},
    {CAMERA_THIN_PRISM_FISHEYE,
     1000,
     800,
     {350, 352, 505, 396, 0.02, -0.004, 0.002, -0.001, 0.0005, -0.00002, 0.003, -0.002}},
};
enum { LENSES = sizeof lenses / sizeof *lenses };

static void model_names_are_those_of_colmap(void **state)
{
    (void)state;
    enum camera_model m = CAMERA_PINHOLE;
    for (int i = 0; i < CAMERA_MODEL_COUNT; i++) {
        assert_true(camera_model_from_name(camera_model_name((enum camera_model)i), &m));
        assert_int_equal(m, i);
    }
    assert_string_equal(camera_model_name(CAMERA_OPENCV_FISHEYE), "OPENCV_FISHEYE");
    assert_int_equal(camera_model_params(CAMERA_FULL_OPENCV), CAMERA_MAX_PARAMS);
    assert_false(camera_model_from_name("RAD_TAN_THIN_PRISM_FISHEYE", &m));
}

static void an_equisolid_lens_has_the_radius_of_its_closed_form(void **state)
{
    const struct camera c = camera_equisolid(1000, 800, 500, 505, 396);
    double u, v;
    (void)state;
    for (int i = 1; i <= 90; i++) {
        const double theta = i * M_PI / 180;
        assert_true(camera_project(&c, vec3_make(0.6 * sin(theta), 0.8 * sin(theta), cos(theta)), &u, &v));
        assert_near(u - 505, 0.6 * 1000 * sin(theta / 2), 1e-3);
        assert_near(v - 396, 0.8 * 1000 * sin(theta / 2), 1e-3);
    }
}

/* With 2 tan(omega / 2) = 1 the FOV model is equidistant, r = angle / omega, and in general
 * tan(omega r) = 2 tan(omega / 2) tan(angle). */
static void a_fov_lens_has_the_radius_of_its_closed_form(void **state)
{
    (void)state;
    const double omega = 2 * atan(0.5);
    const struct camera c = {CAMERA_FOV, 1000, 800, {500, 400, 505, 396, omega}};
    const struct camera d = {CAMERA_FOV, 1000, 800, {500, 400, 505, 396, 1.7}};
    double u, v;
    for (int i = 1; i < 90; i++) {
        const double theta = i * M_PI / 180;
        const struct vec3 p = vec3_make(0.6 * sin(theta), 0.8 * sin(theta), cos(theta));
        assert_true(camera_project(&c, p, &u, &v));
        assert_near(u - 505, 0.6 * 500 * theta / omega, 1e-10);
        assert_near(v - 396, 0.8 * 400 * theta / omega, 1e-10);
        assert_true(camera_project(&d, p, &u, &v));
        assert_near(tan(1.7 * hypot((u - 505) / 500, (v - 396) / 400)), 2 * tan(0.85) * tan(theta), 1e-9 * tan(theta));
    }
    assert_false(camera_unproject(&c, 505 + 500 * 1.01 * M_PI / 2 / omega, 396, &(struct vec3){0}));
    struct camera bad = c;
    struct err err = ERR_INIT;
    bad.params[4] = 3.2;
    assert_int_equal(camera_check(&bad, &err), ST_DATA);
    assert_non_null(strstr(err.text, "field is 3.2 radians"));
}

/* The other fisheyes are OPENCV_FISHEYE with fewer coefficients, or with more. */
static void fisheyes_agree_where_their_coefficients_do(void **state)
{
    (void)state;
    const struct camera opencv = {CAMERA_OPENCV_FISHEYE, 1000, 800, {350, 350, 505, 396, 0.02, -0.004}};
    const struct camera radial = {CAMERA_RADIAL_FISHEYE, 1000, 800, {350, 505, 396, 0.02, -0.004}};
    struct camera prism = {CAMERA_THIN_PRISM_FISHEYE, 1000, 800, {350, 350, 505, 396, 0.02, -0.004}};
    double u[3], v[3];
    for (int i = 0; i <= 100; i++) {
        const double theta = i * M_PI / 180;
        const struct vec3 p = vec3_make(0.6 * sin(theta), 0.8 * sin(theta), cos(theta));
        assert_true(camera_project(&opencv, p, &u[0], &v[0]));
        assert_true(camera_project(&radial, p, &u[1], &v[1]));
        assert_true(camera_project(&prism, p, &u[2], &v[2]));
        assert_true(u[0] == u[1] && v[0] == v[1] && u[0] == u[2] && v[0] == v[2]);
    }
    /* tangential and prism terms, by their formula in the direction from the axis times the angle */
    const double angle = 0.7, x = 0.6 * angle, y = 0.8 * angle, s = angle * angle;
    const double g = 1 + s * (0.02 + s * (-0.004 + s * (0.0005 + s * -0.00002)));
    const double more[] = {0.002, -0.001, 0.0005, -0.00002, 0.003, -0.005};
    memcpy(prism.params + 6, more, sizeof more);
    assert_true(camera_project(&prism, vec3_make(0.6 * sin(angle), 0.8 * sin(angle), cos(angle)), u, v));
    assert_near(*u, 505 + 350 * (x * g + 2 * 0.002 * x * y - 0.001 * (s + 2 * x * x) + 0.003 * s), 1e-10);
    assert_near(*v, 396 + 350 * (y * g + 0.002 * (s + 2 * y * y) - 2 * 0.001 * x * y - 0.005 * s), 1e-10);
}

static void a_camera_may_be_of_pictures_of_another_size(void **state)
{
    (void)state;
    for (int i = 0; i < LENSES; i++) {
        struct camera c = lenses[i];
        double u, v, u2, v2;
        assert_true(camera_resize(&c, 3 * c.width, 3 * c.height));
        assert_true(camera_project(&lenses[i], vec3_make(0.1, -0.2, 1), &u, &v));
        assert_true(camera_project(&c, vec3_make(0.1, -0.2, 1), &u2, &v2));
        assert_near(u2, 3 * u, 1e-9);
        assert_near(v2, 3 * v, 1e-9);
        assert_false(camera_resize(&c, c.height, c.width + 2));
        assert_int_equal(c.width, 3 * lenses[i].width);
    }
}

static void invalid_cameras_are_rejected_with_a_reason(void **state)
{
    (void)state;
    struct camera c = lenses[0];
    struct err err = ERR_INIT;
    assert_int_equal(camera_check(&c, &err), ST_OK);
    c.params[0] = 0;
    assert_int_equal(camera_check(&c, &err), ST_DATA);
    assert_non_null(strstr(err.text, "focal length is 0"));
    err = (struct err)ERR_INIT;
    c = lenses[5];
    c.params[6] = NAN;
    assert_int_equal(camera_check(&c, &err), ST_DATA);
    assert_non_null(strstr(err.text, "parameter 7 of the OPENCV camera"));
    err = (struct err)ERR_INIT;
    c = lenses[1];
    c.height = 0;
    assert_int_equal(camera_check(&c, &err), ST_DATA);
}

static void projection_follows_the_formulas(void **state)
{
    (void)state;
    double u, v, x = 0.21, y = -0.34, s = x * x + y * y;
    assert_true(camera_project(&lenses[1], vec3_make(0.42, -0.68, 2), &u, &v));
    assert_near(u, 500 * x + 310, 1e-12);
    assert_near(v, 480 * y + 255.5, 1e-12);

    const double *p = lenses[7].params;
    double g = (1 + p[4] * s + p[5] * s * s + p[8] * s * s * s) / (1 + p[9] * s + p[10] * s * s + p[11] * s * s * s);
    assert_true(camera_project(&lenses[7], vec3_make(x, y, 1), &u, &v));
    assert_near(u, p[0] * (x * g + 2 * p[6] * x * y + p[7] * (s + 2 * x * x)) + p[2], 1e-10);
    assert_near(v, p[1] * (y * g + p[6] * (s + 2 * y * y) + 2 * p[7] * x * y) + p[3], 1e-10);

    /* a fisheye without coefficients is equidistant: 100 degrees from the axis are still in the picture */
    struct camera f = {CAMERA_OPENCV_FISHEYE, 1000, 1000, {300, 300, 500, 500}};
    double t = 100 * M_PI / 180;
    assert_true(camera_project(&f, vec3_make(0, sin(t), cos(t)), &u, &v));
    assert_near(u, 500, 1e-10);
    assert_near(v, 500 + 300 * t, 1e-10);
    assert_true(camera_project(&f, vec3_make(0, 0, 7), &u, &v));
    assert_near(u, 500, 0);
    assert_false(camera_project(&f, vec3_make(0, 0, -1), &u, &v));
    assert_false(camera_project(&f, vec3_make(0, 0, 0), &u, &v));
    assert_false(camera_project(&lenses[0], vec3_make(1, 1, 0), &u, &v));
    assert_false(camera_project(&lenses[2], vec3_make(1, 1, -3), &u, &v));
    assert_false(camera_project(&lenses[0], vec3_make(1e300, 1, 1e-300), &u, &v));
}

static void every_pixel_of_every_model_round_trips(void **state)
{
    (void)state;
    enum { STEPS = 40 };
    double worst = 0;
    for (int i = 0; i < LENSES; i++)
        for (int a = 0; a <= STEPS; a++)
            for (int b = 0; b <= STEPS; b++) {
                double u = (double)lenses[i].width * a / STEPS, v = (double)lenses[i].height * b / STEPS, u2, v2;
                struct vec3 ray;
                if (!camera_unproject(&lenses[i], u, v, &ray)) {
                    /* the corners of the equisolid lens are beyond 180 degrees */
                    assert_true(camera_model_is_fisheye(lenses[i].model));
                    continue;
                }
                assert_near(vec3_length(ray), 1, 1e-14);
                assert_true(camera_project(&lenses[i], ray, &u2, &v2));
                worst = fmax(worst, hypot(u2 - u, v2 - v) / lenses[i].params[0]);
            }
    print_message("worst round trip: %.3g of the focal length\n", worst);
    assert_true(worst < 1e-10);
}

static void an_equisolid_fisheye_reaches_the_negative_axis(void **state)
{
    (void)state;
    const struct camera *c = &lenses[9];
    for (int degrees = 1; degrees < 179; degrees++)
        for (int side = 0; side < 8; side++) {
            double t = degrees * M_PI / 180, a = side * M_PI / 4, u, v;
            struct vec3 ray = vec3_make(cos(a) * sin(t), sin(a) * sin(t), cos(t)), back;
            assert_true(camera_project(c, ray, &u, &v));
            /* the series ends after t^9: the error is at most the next term */
            double r = hypot((u - 505) / 350, (v - 396) / 352), rest = pow(t, 11) / 4e10;
            assert_near(r, 2 * sin(t / 2), rest + 1e-12);
            assert_true(camera_unproject(c, u, v, &back));
            /* near 180 degrees the radius hardly changes with the angle, so the angle is less exact */
            assert_near(vec3_length(vec3_sub(back, ray)), 0, 1e-13 / cos(t / 2));
        }
}

static void rays_beyond_the_fold_have_no_pixel(void **state)
{
    (void)state;
    /* r (1 - 0.2 r^2) increases up to r = sqrt(1 / 0.6), where it is 0.8606629658 */
    struct camera c = {CAMERA_SIMPLE_RADIAL, 640, 480, {300, 320, 240, -0.2}};
    double fold = sqrt(1 / 0.6), u, v;
    struct vec3 ray;
    assert_true(camera_project(&c, vec3_make(fold - 1e-9, 0, 1), &u, &v));
    assert_near(u, 320 + 300 * 0.8606629658, 1e-6);
    assert_false(camera_project(&c, vec3_make(fold + 1e-9, 0, 1), &u, &v));
    assert_false(
        camera_project(&c, vec3_make(2.2, 0.1, 1), &u, &v)); /* the polynomial would give a pixel inside the picture */
    assert_true(camera_unproject(&c, 320 + 300 * 0.86066, 240, &ray));
    assert_true(ray.x / ray.z < fold);
    assert_false(camera_unproject(&c, 320 + 300 * 0.86067, 240, &ray));

    /* a pole of the rational model at r^2 = 2 */
    struct camera full = {CAMERA_FULL_OPENCV, 640, 480, {300, 300, 320, 240, 0, 0, 0, 0, 0, -0.5, 0, 0}};
    assert_true(camera_project(&full, vec3_make(1.41, 0, 1), &u, &v));
    assert_false(camera_project(&full, vec3_make(1.42, 0, 1), &u, &v));
    assert_true(camera_unproject(&full, 1e6, 240, &ray));
    assert_true(ray.x / ray.z < sqrt(2));

    /* tangential terms alone fold where the Jacobian's determinant is 0: here at y = -1 / 6 p1 on the y axis */
    struct camera tangential = {CAMERA_OPENCV, 640, 480, {300, 300, 320, 240, 0, 0, 0.1, 0}};
    assert_true(camera_project(&tangential, vec3_make(0, -1.66, 1), &u, &v));
    assert_false(camera_project(&tangential, vec3_make(0, -1.67, 1), &u, &v));
    assert_false(camera_unproject(&tangential, 320, 240 - 300 * 0.9, &ray));
    assert_true(camera_unproject(&tangential, 320, 240 - 300 * 0.83, &ray));
}

/* For random coefficients, projection ends at the first fold found by dense sampling. */
static void folds_of_random_lenses_match_sampling(void **state)
{
    (void)state;
    struct rng rng = rng_make(7, "camera", "test");
    int folds = 0;
    for (uint64_t trial = 0; trial < 300; trial++) {
        struct camera c = {CAMERA_FULL_OPENCV, 640, 480, {300, 300, 320, 240}};
        for (int i = 0; i < 8; i++)
            if (i != 2 && i != 3) c.params[4 + i] = (rng_uniform(&rng, trial, (uint64_t)i) - 0.5) * (i % 4 ? 0.4 : 1);
        double u = 0, v = 0, last = -1, fold = 3;
        for (double r = 1e-4; r < 3; r += 1e-4) {
            double s = r * r, n = 1 + s * (c.params[4] + s * (c.params[5] + s * c.params[8])),
                   d = 1 + s * (c.params[9] + s * (c.params[10] + s * c.params[11]));
            if (!(d > 0) || r * n / d <= last) {
                fold = r;
                break;
            }
            last = r * n / d;
        }
        folds += fold < 3;
        if (!camera_project(&c, vec3_make(fold - 4e-4, 0, 1), &u, &v)) fail_msg("trial %d", (int)trial);
        assert_true(u > 320);
        if (fold < 3) assert_false(camera_project(&c, vec3_make(fold + 4e-4, 0, 1), &u, &v));
    }
    assert_true(folds > 50);
}

static void pixels_far_outside_give_a_ray_or_fail(void **state)
{
    (void)state;
    for (int i = 0; i < LENSES; i++)
        for (double far = 1e3; far < 1e300; far *= 1e3) {
            struct vec3 ray = {0, 0, 0};
            double u, v;
            if (camera_unproject(&lenses[i], far, -far, &ray)) {
                assert_near(vec3_length(ray), 1, 1e-12);
                if (camera_project(&lenses[i], ray, &u, &v)) assert_true(isfinite(u) && isfinite(v));
            }
        }
}

static void a_pose_maps_its_centre_to_the_origin(void **state)
{
    (void)state;
    double h = sqrt(0.5);
    struct pose p = {{h, 0, h, 0}, {1, 2, 3}}; /* rotated by 90 degrees about y: world z is camera x */
    struct vec3 c = pose_apply(&p, vec3_make(0, 0, 5)), o = pose_apply(&p, pose_center(&p));
    assert_near(c.x, 6, 1e-12);
    assert_near(c.y, 2, 1e-12);
    assert_near(c.z, 3, 1e-12);
    assert_near(vec3_length(o), 0, 1e-12);
}

/* d_point and d_params against central differences of camera_project(). */
static void derivatives_are_the_limits_of_differences(void **state)
{
    (void)state;
    static const struct vec3 points[] = {{0.3, -0.2, 2}, {-0.7, 0.5, 1.8}, {0, 0, 3}, {1e-7, 0, 3}, {0.05, 0.6, 1}};
    for (size_t i = 0; i < LENSES; i++)
        for (size_t k = 0; k < sizeof points / sizeof *points; k++) {
            const struct camera *c = &lenses[i];
            double at[2], d_point[2][3], d_params[2][CAMERA_MAX_PARAMS], low[2] = {0}, high[2] = {0};
            assert_true(camera_project_derivatives(c, points[k], at, d_point, d_params));
            assert_true(camera_project(c, points[k], &low[0], &low[1]));
            assert_true(at[0] == low[0] && at[1] == low[1]);
            for (int n = 0; n < 3 + camera_model_params(c->model); n++) {
                struct camera less = *c, more = *c;
                struct vec3 before = points[k], after = points[k];
                double *from[3] = {&before.x, &before.y, &before.z}, *to[3] = {&after.x, &after.y, &after.z};
                const double step = 1e-5 * (n < 3 ? 1 : fmax(1, fabs(c->params[n - 3])));
                *(n < 3 ? from[n] : &less.params[n - 3]) -= step;
                *(n < 3 ? to[n] : &more.params[n - 3]) += step;
                assert_true(camera_project(&less, before, &low[0], &low[1]));
                assert_true(camera_project(&more, after, &high[0], &high[1]));
                for (int j = 0; j < 2; j++) {
                    const double difference = (high[j] - low[j]) / (2 * step);
                    assert_near(n < 3 ? d_point[j][n] : d_params[j][n - 3], difference, 1e-5 * (1 + fabs(difference)));
                }
            }
        }
    double at[2], d_point[2][3], d_params[2][CAMERA_MAX_PARAMS];
    assert_false(camera_project_derivatives(&lenses[0], vec3_make(0, 0, -1), at, d_point, d_params));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(model_names_are_those_of_colmap),
        cmocka_unit_test(a_fov_lens_has_the_radius_of_its_closed_form),
        cmocka_unit_test(fisheyes_agree_where_their_coefficients_do),
        cmocka_unit_test(a_camera_may_be_of_pictures_of_another_size),
        cmocka_unit_test(invalid_cameras_are_rejected_with_a_reason),
        cmocka_unit_test(projection_follows_the_formulas),
        cmocka_unit_test(every_pixel_of_every_model_round_trips),
        cmocka_unit_test(an_equisolid_fisheye_reaches_the_negative_axis),
        cmocka_unit_test(rays_beyond_the_fold_have_no_pixel),
        cmocka_unit_test(folds_of_random_lenses_match_sampling),
        cmocka_unit_test(pixels_far_outside_give_a_ray_or_fail),
        cmocka_unit_test(an_equisolid_lens_has_the_radius_of_its_closed_form),
        cmocka_unit_test(a_pose_maps_its_centre_to_the_origin),
        cmocka_unit_test(derivatives_are_the_limits_of_differences),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
