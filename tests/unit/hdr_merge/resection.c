/* resection.c - the pose of a camera from marked points: exact, with noise, ambiguous, and refused. */
#include "stages/hdr_merge/resection.h"

#include <math.h>

#include "common/base/rng.h"
#include "stages/hdr_merge/three_points.h"
#include "tests/unit/scratch.h"

static const struct camera dome = {
    CAMERA_OPENCV_FISHEYE, 960, 960, {340, 340, 480, 480, -1 / 24.0, 1 / 1920.0, -1 / 322560.0, 1 / 92897280.0}};
static const struct camera pinhole = {CAMERA_PINHOLE, 640, 480, {500, 500, 320, 240}};
static const struct camera radial = {CAMERA_SIMPLE_RADIAL, 640, 480, {500, 320, 240, -0.08}};

/* the corners of a window, 2 x 1.5 m, in the plane y = 0 */
static const struct vec3 window[4] = {{1.4, 0, 0.75}, {3.4, 0, 0.75}, {3.4, 0, 2.25}, {1.4, 0, 2.25}};

/* At `at`, aimed at `to`, rolled by a fifth of a radian. */
static struct pose looking(struct vec3 at, struct vec3 to)
{
    const struct vec3 z = vec3_normalize(vec3_sub(to, at));
    const struct vec3 up = {0.2, 0.1, 1};
    const struct vec3 x = vec3_normalize(vec3_cross(z, up)), y = vec3_cross(z, x);
    const struct mat3 turn = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    return (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, at), -1)};
}

static void mark_all(struct resection_mark *marks, const struct camera *lens, const struct pose *pose,
                     const struct vec3 *points, int count)
{
    for (int i = 0; i < count; i++) {
        marks[i].point = points[i];
        assert_true(camera_project(lens, pose_apply(pose, points[i]), &marks[i].x, &marks[i].y));
    }
}

static double centers_apart(const struct pose *a, const struct pose *b)
{
    return vec3_length(vec3_sub(pose_center(a), pose_center(b)));
}

static double degrees_apart(const struct pose *a, const struct pose *b)
{
    const struct mat3 turn = mat3_multiply(mat3_from_quat(a->rotation), mat3_transpose(mat3_from_quat(b->rotation)));
    const struct vec3 sine = {turn.m[2][1] - turn.m[1][2], turn.m[0][2] - turn.m[2][0], turn.m[1][0] - turn.m[0][1]};
    return atan2(vec3_length(sine), turn.m[0][0] + turn.m[1][1] + turn.m[2][2] - 1) * 180 / M_PI;
}

static double gaussian(const struct rng *rng, uint64_t item, uint64_t index)
{
    const double u = 1 - rng_uniform(rng, item, 2 * index), v = rng_uniform(rng, item, 2 * index + 1);
    return sqrt(-2 * log(u)) * cos(2 * M_PI * v);
}

static void three_rays_have_the_true_pose_among_their_solutions(void **state)
{
    const struct rng rng = rng_make(5, "test", "three points");
    (void)state;
    for (uint64_t n = 0; n < 2000; n++) {
        struct vec3 at[4], rays[3];
        struct pose poses[THREE_POINTS_MAX];
        double best = INFINITY;
        for (uint64_t i = 0; i < 4; i++)
            at[i] = vec3_make(6 * rng_uniform(&rng, n, 3 * i) - 3, 6 * rng_uniform(&rng, n, 3 * i + 1) - 3,
                              6 * rng_uniform(&rng, n, 3 * i + 2) - 3);
        const struct pose truth = looking(at[3], vec3_make(0.3, 0.2, 0.1));
        for (int i = 0; i < 3; i++) rays[i] = vec3_normalize(pose_apply(&truth, at[i]));
        const int count = three_points_poses(poses, rays, at);
        assert_in_range(count, 1, THREE_POINTS_MAX);
        for (int i = 0; i < count; i++)
            best = fmin(best, centers_apart(&poses[i], &truth) + degrees_apart(&poses[i], &truth));
        assert_true(best < 1e-3); /* double roots have half the digits */
    }
}

static void points_or_rays_on_a_line_have_no_pose(void **state)
{
    const struct vec3 line[3] = {{0, 0, 2}, {1, 0, 2}, {3, 0, 2}}, corner[3] = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
    const struct vec3 ahead = {0, 0, 1};
    struct pose poses[THREE_POINTS_MAX];
    struct vec3 rays[3];
    (void)state;
    for (int i = 0; i < 3; i++) rays[i] = vec3_normalize(corner[i]);
    assert_true(three_points_poses(poses, rays, corner) > 0);
    assert_int_equal(three_points_poses(poses, rays, line), 0);
    rays[2] = rays[1] = ahead;
    assert_int_equal(three_points_poses(poses, rays, corner), 0);
}

static void exact_marks_give_the_pose_through_any_lens(void **state)
{
    static const struct camera *const lenses[] = {&dome, &dome, &pinhole, &radial};
    static const struct vec3 from[] = {{2.2, 0.4, 1.3}, {2.9, -0.6, 1.8}, {1.2, 4, 1.1}, {3.1, -3.2, 1.9}};
    static const struct vec3 to[] = {{2.4, -5, 1.5}, {9, -0.5, 1}, {2.3, 0, 1.4}, {2.5, 0, 1.4}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct pose truth = looking(from[i], to[i]);
        struct resection_mark marks[4];
        struct resection r;
        struct err err = ERR_INIT;
        mark_all(marks, lenses[i], &truth, window, 4);
        assert_ok(resection_find(&r, lenses[i], marks, 4, 1, "sky", &err), err);
        assert_true(centers_apart(&r.poses[0].cam_from_world, &truth) < 1e-6);
        assert_true(degrees_apart(&r.poses[0].cam_from_world, &truth) < 1e-5);
        assert_true(r.poses[0].rms < 1e-5 && r.poses[0].max < 1e-4 && r.poses[0].error.x > 1e-4);
    }
}

static void points_behind_a_fisheye_count_like_others(void **state)
{
    /* just outside the window, aimed outwards: all corners are 92 to 94 degrees off the axis */
    const struct pose truth = looking(vec3_make(2.4, -0.05, 1.5), vec3_make(2.4, -5, 1.5));
    struct resection_mark marks[4];
    struct resection r;
    struct err err = ERR_INIT;
    (void)state;
    mark_all(marks, &dome, &truth, window, 4);
    for (int i = 0; i < 4; i++) assert_true(pose_apply(&truth, window[i]).z < 0);
    assert_ok(resection_find(&r, &dome, marks, 4, 1, "sky", &err), err);
    assert_true(centers_apart(&r.poses[0].cam_from_world, &truth) < 1e-6);
}

/* Draws noisy marks; counts how often the centre's coordinates are within their intervals, in percent. */
static double coverage(const struct vec3 *points, int count, double click)
{
    const struct rng rng = rng_make(7, "test", "noise");
    const struct pose truth = looking(vec3_make(2.0, 0.7, 1.3), vec3_make(2.4, -5, 1.5));
    const struct vec3 at = pose_center(&truth);
    int inside = 0;
    for (uint64_t n = 0; n < 400; n++) {
        struct resection_mark marks[8];
        struct resection r;
        struct err err = ERR_INIT;
        mark_all(marks, &dome, &truth, points, count);
        for (int i = 0; i < count; i++) {
            marks[i].x += gaussian(&rng, n, 2 * (uint64_t)i);
            marks[i].y += gaussian(&rng, n, 2 * (uint64_t)i + 1);
        }
        assert_ok(resection_find(&r, &dome, marks, count, click, "sky", &err), err);
        const struct vec3 found = pose_center(&r.poses[0].cam_from_world), e = r.poses[0].error;
        inside += fabs(found.x - at.x) < e.x;
        inside += fabs(found.y - at.y) < e.y;
        inside += fabs(found.z - at.z) < e.z;
        assert_true(vec3_length(vec3_sub(found, at)) < 0.03);
    }
    return inside / 12.0;
}

static void the_interval_holds_the_centre_in_95_of_100_cases(void **state)
{
    const struct vec3 eight[8] = {window[0],         window[1],         window[2],         window[3],
                                  {1.4, -0.3, 0.75}, {3.4, -0.3, 0.75}, {3.4, -0.3, 2.25}, {1.4, -0.3, 2.25}};
    (void)state;
    /* the noise is found from the marks alone */
    const double four = coverage(window, 4, 1e-3), all = coverage(eight, 8, 1e-3);
    assert_true(four > 92.5 && four < 97.5);
    assert_true(all > 92.5 && all < 97.5);
    /* the stated noise widens the interval where the marks agree by chance */
    assert_true(coverage(window, 4, 1) > four);
}

static void a_small_window_seen_from_the_front_is_ambiguous(void **state)
{
    /* 25 m away, 20 degrees aside: the pose on the other side fits nearly as well */
    const struct pose truth = looking(vec3_make(10.95, 23.5, 1.5), vec3_make(2.4, 0, 1.5));
    struct resection_mark marks[5];
    struct resection r;
    struct err err = ERR_INIT;
    (void)state;
    mark_all(marks, &pinhole, &truth, window, 4);
    for (int i = 0; i < 4; i++) marks[i].x += i % 2 ? 0.1 : -0.1;
    assert_ok(resection_find(&r, &pinhole, marks, 4, 1, "sky", &err), err);
    assert_true(r.count > 1);
    const struct vec3 a = pose_center(&r.poses[0].cam_from_world), b = pose_center(&r.poses[1].cam_from_world);
    assert_true((a.x - 2.4) * (b.x - 2.4) < 0); /* on both sides of the window's middle */
    assert_true(r.poses[0].rms <= r.poses[1].rms);

    /* a point off the wall decides */
    const struct vec3 lamp = {4, 3, 2.4};
    mark_all(&marks[4], &pinhole, &truth, &lamp, 1);
    assert_ok(resection_find(&r, &pinhole, marks, 5, 1, "sky", &err), err);
    assert_int_equal(r.count, 1);
    assert_true(centers_apart(&r.poses[0].cam_from_world, &truth) < 0.2);
}

static void three_marks_give_all_poses_that_explain_them(void **state)
{
    const struct pose truth = looking(vec3_make(2.9, 3, 1.8), vec3_make(2.4, 0, 1.5));
    struct resection_mark marks[3];
    struct resection r;
    struct err err = ERR_INIT;
    double best = INFINITY;
    (void)state;
    mark_all(marks, &pinhole, &truth, window, 3);
    assert_ok(resection_find(&r, &pinhole, marks, 3, 0.5, "sky", &err), err);
    assert_true(r.count > 1);
    for (int i = 0; i < r.count; i++) {
        best = fmin(best, centers_apart(&r.poses[i].cam_from_world, &truth));
        for (int k = 0; k < 3; k++) {
            double u, v;
            assert_true(camera_project(&pinhole, pose_apply(&r.poses[i].cam_from_world, window[k]), &u, &v));
            assert_true(hypot(u - marks[k].x, v - marks[k].y) < 2);
        }
    }
    assert_true(best < 1e-6);
}

static void marks_that_cannot_be_used_are_refused(void **state)
{
    const struct pose truth = looking(vec3_make(2.2, 3, 1.3), vec3_make(2.4, 0, 1.5));
    const struct vec3 line[4] = {{1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {4, 0, 1}};
    const struct camera narrow = {CAMERA_SIMPLE_RADIAL, 640, 480, {500, 320, 240, -0.5}};
    struct resection_mark marks[4];
    struct resection r;
    struct err err = ERR_INIT;
    (void)state;
    mark_all(marks, &pinhole, &truth, window, 4);
    assert_int_equal(resection_find(&r, &pinhole, marks, 2, 1, "sky", &err), ST_DATA);
    assert_err(err, ST_DATA, "image sky has 2 marks, wanted 3 to 64");
    err = (struct err)ERR_INIT;
    marks[2].x = 630;
    marks[2].y = 470;
    assert_int_equal(resection_find(&r, &narrow, marks, 4, 1, "sky", &err), ST_DATA);
    assert_err(err, ST_DATA, "image sky has a mark at 630, 470, where its lens has no ray.");
    err = (struct err)ERR_INIT;
    mark_all(marks, &pinhole, &truth, line, 4);
    assert_int_equal(resection_find(&r, &pinhole, marks, 4, 1, "sky", &err), ST_DATA);
    assert_err(err, ST_DATA, "on a line");
}

/* Whatever is marked, no figure is infinite or undefined. */
static void random_marks_give_finite_poses_or_an_error(void **state)
{
    const struct rng rng = rng_make(11, "test", "random marks");
    static const double sizes[] = {1e-300, 1e-3, 1, 1e6, 1e200};
    int found = 0;
    (void)state;
    for (uint64_t n = 0; n < 400; n++) {
        const int count = 3 + (int)(n % 6);
        struct resection_mark marks[8];
        struct resection r;
        struct err err = ERR_INIT;
        for (int i = 0; i < count; i++) {
            double v[5];
            for (int k = 0; k < 5; k++) v[k] = rng_uniform(&rng, n, (uint64_t)(5 * i + k));
            const double size = sizes[n / 6 % 5];
            marks[i] =
                (struct resection_mark){960 * v[0], 960 * v[1], {size * v[2], size * v[3], n % 4 ? size * v[4] : 0}};
            if (i && n % 7 == 0) marks[i].x = marks[0].x, marks[i].y = marks[0].y;
        }
        if (resection_find(&r, &dome, marks, count, 1, "sky", &err)) {
            assert_err(err, ST_DATA, "image sky");
            assert_int_equal(r.count, 0);
            continue;
        }
        found++;
        for (int i = 0; i < r.count; i++) {
            const struct resection_pose *p = &r.poses[i];
            const struct vec3 at = pose_center(&p->cam_from_world);
            assert_true(isfinite(at.x + at.y + at.z + p->rms + p->max + p->degrees));
            assert_true(isfinite(p->error.x + p->error.y + p->error.z + p->turn_error) && p->worst < count);
        }
    }
    assert_true(found > 100);
}

static void wrong_corners_do_not_fit(void **state)
{
    const struct pose truth = looking(vec3_make(2.2, 0.8, 1.3), vec3_make(2.4, -5, 1.5));
    const struct vec3 swapped[4] = {window[1], window[0], window[2], window[3]};
    struct resection_mark marks[4];
    struct resection r;
    struct err err = ERR_INIT;
    (void)state;
    mark_all(marks, &dome, &truth, window, 4);
    for (int i = 0; i < 4; i++) marks[i].point = swapped[i];
    if (!resection_find(&r, &dome, marks, 4, 1, "sky", &err)) assert_true(r.poses[0].degrees > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_rays_have_the_true_pose_among_their_solutions),
        cmocka_unit_test(points_or_rays_on_a_line_have_no_pose),
        cmocka_unit_test(exact_marks_give_the_pose_through_any_lens),
        cmocka_unit_test(points_behind_a_fisheye_count_like_others),
        cmocka_unit_test(the_interval_holds_the_centre_in_95_of_100_cases),
        cmocka_unit_test(a_small_window_seen_from_the_front_is_ambiguous),
        cmocka_unit_test(three_marks_give_all_poses_that_explain_them),
        cmocka_unit_test(marks_that_cannot_be_used_are_refused),
        cmocka_unit_test(random_marks_give_finite_poses_or_an_error),
        cmocka_unit_test(wrong_corners_do_not_fit),
    };
    return cmocka_run_group_tests_name("resection", tests, NULL, NULL);
}
