/* camera_alignment.c - known similarities are found; errors are those computed by hand. */
#include "common/capture/camera_alignment.h"

#include "tests/unit/scratch.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { COUNT = 4 };

static struct quat turn(double degrees, double x, double y, double z)
{
    double a = degrees * M_PI / 360;
    return (struct quat){cos(a), sin(a) * x, sin(a) * y, sin(a) * z};
}

static struct pose pose_at(struct vec3 center, struct quat rotation)
{
    return (struct pose){rotation, vec3_scale(mat3_apply(mat3_from_quat(rotation), center), -1)};
}

/* The camera after the similarity s, r, t of its world. */
static struct pose moved(const struct pose *p, double s, struct mat3 r, struct vec3 t)
{
    struct vec3 center = vec3_add(vec3_scale(mat3_apply(r, pose_center(p)), s), t);
    struct mat3 cam = mat3_multiply(mat3_from_quat(p->rotation), mat3_transpose(r));
    return pose_at(center, quat_from_mat3(cam));
}

static void a_known_similarity_is_found(void **state)
{
    static const struct vec3 centers[COUNT] = {{0, 0, 0}, {1, 0.2, 0}, {2, -0.1, 0.3}, {3, 0.5, -0.4}};
    struct mat3 r = mat3_from_quat(turn(120, 0.6, 0, 0.8));
    struct pose found[COUNT], truth[COUNT];
    struct similarity a;
    struct camera_errors e;
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        found[i] = pose_at(centers[i], turn(10 * i, 0, 1, 0));
        truth[i] = moved(&found[i], 2.5, r, vec3_make(7, -3, 1));
    }
    for (int count = 2; count <= COUNT; count++) { /* two are on a line: their rotations decide */
        assert_ok(camera_alignment_find(&a, found, truth, count, &err), err);
        assert_near(a.scale, 2.5, 1e-9);
        for (int i = 0; i < 9; i++) assert_near(a.rotation.m[i / 3][i % 3], r.m[i / 3][i % 3], 1e-9);
        assert_near(a.translation.x, 7, 1e-9);
        assert_ok(camera_errors_measure(&e, &a, found, truth, count, &err), err);
        assert_near(e.center_max, 0, 1e-9);
        assert_near(e.rotation_max, 0, 1e-6);
    }
}

/* A square with one diagonal longer by a tenth and the other one shorter by a tenth: no similarity improves it, so the
 * error of every centre is 0.1. */
static void a_sheared_square_has_known_errors(void **state)
{
    static const struct vec3 from[COUNT] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    static const struct vec3 to[COUNT] = {{1.1, 0, 0}, {-1.1, 0, 0}, {0, 0.9, 0}, {0, -0.9, 0}};
    struct pose found[COUNT], truth[COUNT];
    struct similarity a;
    struct camera_errors e;
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        found[i] = pose_at(from[i], turn(i == 2 ? 3 : i == 1 ? 1 : 0, 1, 0, 0));
        truth[i] = pose_at(to[i], turn(0, 1, 0, 0));
    }
    assert_ok(camera_alignment_find(&a, found, truth, COUNT, &err), err);
    assert_near(a.scale, 1, 1e-12);
    assert_ok(camera_errors_measure(&e, &a, found, truth, COUNT, &err), err);
    assert_near(e.center_median, 0.1, 1e-9);
    assert_near(e.center_max, 0.1, 1e-9);
    assert_near(e.rotation_max, 3, 1e-9);
    assert_near(e.rotation_median, 0.5, 1e-9); /* of 0 0 1 3 */
}

/* A mirrored scene is aligned by a rotation, not a reflection: the third term of the trace is negative. */
static void a_mirrored_scene_is_aligned_by_a_rotation(void **state)
{
    static const struct vec3 from[COUNT] = {{3, 0, 0}, {0, 2, 0}, {0, 0, 1}, {-3, -2, -1}};
    struct pose found[COUNT], truth[COUNT];
    struct similarity a;
    struct err err = ERR_INIT;
    double det = 0;
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        found[i] = pose_at(from[i], turn(0, 1, 0, 0));
        truth[i] = pose_at(vec3_make(from[i].x, from[i].y, -from[i].z), turn(0, 1, 0, 0));
    }
    assert_ok(camera_alignment_find(&a, found, truth, COUNT, &err), err);
    for (int i = 0; i < 3; i++)
        det += a.rotation.m[0][i] * (a.rotation.m[1][(i + 1) % 3] * a.rotation.m[2][(i + 2) % 3] -
                                     a.rotation.m[1][(i + 2) % 3] * a.rotation.m[2][(i + 1) % 3]);
    assert_near(det, 1, 1e-12);
    assert_true(a.scale > 0 && a.scale < 1);
}

static void coincident_cameras_have_no_scale(void **state)
{
    struct pose found[2] = {pose_at(vec3_make(1, 2, 3), turn(0, 1, 0, 0)),
                            pose_at(vec3_make(1, 2, 3), turn(9, 1, 0, 0))};
    struct pose truth[2] = {found[0], pose_at(vec3_make(4, 4, 4), turn(9, 1, 0, 0))};
    struct similarity a;
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(camera_alignment_find(&a, found, truth, 1, &err), ST_DATA);
    assert_err(err, ST_DATA, "there is no scale");
    assert_int_equal(camera_alignment_find(&a, found, truth, 2, &err), ST_DATA);
    assert_int_equal(camera_alignment_find(&a, truth, found, 2, &err), ST_DATA);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_known_similarity_is_found),
        cmocka_unit_test(a_sheared_square_has_known_errors),
        cmocka_unit_test(a_mirrored_scene_is_aligned_by_a_rotation),
        cmocka_unit_test(coincident_cameras_have_no_scale),
    };
    return cmocka_run_group_tests_name("camera_alignment", tests, NULL, NULL);
}
