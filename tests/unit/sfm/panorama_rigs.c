/* panorama_rigs.c - views of a panorama get one centre and their known turns, and points follow. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/panorama_name.h"
#include "common/math/numbers.h"
#include "stages/sfm/panorama_rigs.h"

enum { PANORAMAS = 3, IMAGES = PANORAMAS * PANORAMA_VIEWS, POINTS = 60, SIDE = 400 };

static struct sfm_image images[IMAGES];
static struct sfm_observation observations[IMAGES][POINTS];
static struct sfm_point points[POINTS];
static struct sfm_track tracks[POINTS][IMAGES];
static struct sfm_camera lens = {
    1, {.model = CAMERA_PINHOLE, .width = SIDE, .height = SIDE, .params = {200, 200, 200, 200}}};

static const struct vec3 centres[PANORAMAS] = {{0, 0, 0}, {0.8, 0.1, 0.2}, {1.5, -0.1, -0.3}};

static struct quat turn_about(struct vec3 axis, double angle)
{
    const struct vec3 a = vec3_scale(vec3_normalize(axis), sin(angle / 2));
    return (struct quat){cos(angle / 2), a.x, a.y, a.z};
}

static struct pose pose_at(struct quat rotation, struct vec3 centre)
{
    return (struct pose){rotation, vec3_scale(mat3_apply(mat3_from_quat(rotation), centre), -1)};
}

/* The true pose of a view: of its panorama, turned to the right. */
static struct pose true_pose(int panorama, int view)
{
    const struct quat upright = turn_about(vec3_make(0.1, 1, -0.2), 0.4 * panorama);
    const struct quat turn = turn_about(vec3_make(0, 1, 0), -view * PANORAMA_STEP * DEGREE);
    return pose_at(quat_multiply(turn, upright), centres[panorama]);
}

/* The true model; with every view off by about `turn` radians and `shift`, one of them by far. */
static struct sfm_model make(double turn, double shift)
{
    for (int k = 0; k < POINTS; k++) {
        const double a = 2.4 * k, r = 3 + 0.5 * sin(7.0 * k);
        points[k] = (struct sfm_point){
            .id = k + 1, .position = {r * cos(a), 1.2 * sin(3.1 * k), r * sin(a)}, .track = tracks[k]};
    }
    for (int i = 0; i < IMAGES; i++) {
        static char names[IMAGES][32];
        const struct pose pose = true_pose(i / PANORAMA_VIEWS, i % PANORAMA_VIEWS);
        struct sfm_image *image = &images[i];
        snprintf(names[i], sizeof names[i], "p%d_yaw%03d.png", i / PANORAMA_VIEWS, i % PANORAMA_VIEWS * PANORAMA_STEP);
        *image = (struct sfm_image){.id = i + 1, .name = names[i], .observations = observations[i]};
        for (int k = 0; k < POINTS; k++) {
            struct sfm_observation o = {.point_id = k + 1};
            if (!camera_project(&lens.camera, pose_apply(&pose, points[k].position), &o.u, &o.v) || o.u < 0 ||
                o.v < 0 || o.u >= SIDE || o.v >= SIDE)
                continue;
            tracks[k][points[k].track_count++] = (struct sfm_track){i, image->observation_count};
            observations[i][image->observation_count++] = o;
        }
        const double sign = i % 2 ? 1 : -1, far = i == 2 ? 50 : 1;
        const struct vec3 off = vec3_make(sign * shift, sin(5.0 * i) * shift, cos(3.0 * i) * shift);
        image->cam_from_world =
            pose_at(quat_multiply(turn_about(vec3_make(sin(2.0 * i), 1, cos(i)), sign * turn * far), pose.rotation),
                    vec3_add(pose_center(&pose), vec3_scale(off, far)));
    }
    return (struct sfm_model){&lens, images, points, 1, IMAGES, POINTS};
}

static void true_poses_stay(void **state)
{
    struct sfm_model m = make(0, 0);
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(panorama_rigs_join(&m, &err), err);
    for (int i = 0; i < IMAGES; i++) {
        const struct pose wanted = true_pose(i / PANORAMA_VIEWS, i % PANORAMA_VIEWS);
        assert_true(quat_angle(images[i].cam_from_world.rotation, wanted.rotation) < 1e-6);
        assert_true(vec3_length(vec3_sub(pose_center(&images[i].cam_from_world), centres[i / PANORAMA_VIEWS])) < 1e-9);
    }
}

static void views_that_are_off_get_one_centre(void **state)
{
    const double turn = 0.3 * DEGREE, shift = 0.02;
    struct sfm_model m = make(turn, shift);
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(panorama_rigs_join(&m, &err), err);
    for (int i = 0; i < IMAGES; i++) {
        const int first = i / PANORAMA_VIEWS * PANORAMA_VIEWS;
        const struct pose wanted = true_pose(i / PANORAMA_VIEWS, i % PANORAMA_VIEWS);
        const struct vec3 centre = pose_center(&images[i].cam_from_world);
        assert_true(vec3_length(vec3_sub(centre, pose_center(&images[first].cam_from_world))) < 1e-9);
        /* the one that is far off does not count */
        assert_true(quat_angle(images[i].cam_from_world.rotation, wanted.rotation) < turn);
        assert_true(vec3_length(vec3_sub(centre, centres[i / PANORAMA_VIEWS])) < 1.5 * shift);
    }
    for (int k = 0; k < POINTS; k++) {
        const double a = 2.4 * k, r = 3 + 0.5 * sin(7.0 * k);
        const struct vec3 wanted = {r * cos(a), 1.2 * sin(3.1 * k), r * sin(a)};
        if (points[k].track_count > 3 && !(vec3_length(vec3_sub(points[k].position, wanted)) < 0.4))
            fail_msg("point %d is off by %g", k, vec3_length(vec3_sub(points[k].position, wanted)));
    }
}

static void other_photos_stay(void **state)
{
    static char name[] = "photo.jpg";
    struct sfm_model m = make(0.01, 0.02);
    struct err err = ERR_INIT;
    (void)state;
    images[4].name = name;
    const struct pose before = images[4].cam_from_world;
    assert_ok(panorama_rigs_join(&m, &err), err);
    assert_memory_equal(&before, &images[4].cam_from_world, sizeof before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(true_poses_stay),
        cmocka_unit_test(views_that_are_off_get_one_centre),
        cmocka_unit_test(other_photos_stay),
    };
    return cmocka_run_group_tests_name("panorama_rigs", tests, NULL, NULL);
}
