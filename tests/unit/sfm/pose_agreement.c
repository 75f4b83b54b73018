/* pose_agreement.c - cameras around points in space: matches agree with true poses, and each wrong convention is
 * named. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/sfm/pose_agreement.h"

enum { POSES = 8, POINTS = 60, MATCHES = (POSES - 1) * POINTS };
#define ROOM 0.005

static double next(void)
{
    static uint64_t state = 7;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 40) / (1 << 24) - 0.5;
}

static struct mat3 turn_about(double x, double y, double z)
{
    const double n = sqrt(1 + x * x + y * y + z * z);
    return mat3_from_quat((struct quat){1 / n, x / n, y / n, z / n});
}

/* Cameras on a curved path that look at points 4 to 8 away, turned a little, and the rays of neighbours. */
static void make(struct pose *poses, struct pose_match *matches)
{
    struct vec3 points[POINTS];
    for (int i = 0; i < POINTS; i++) points[i] = vec3_make(4 * next(), 3 * next(), 6 + 4 * next());
    for (int k = 0; k < POSES; k++) {
        const struct mat3 r = turn_about(0.1 * next() + 0.05, 0.3 * next(), 0.2 * next() + 0.1);
        const struct vec3 c = vec3_make(0.5 * k - 2, 0.4 * sin(k), 0.3 * cos(2 * k) + 0.5);
        poses[k] = (struct pose){quat_from_mat3(r), vec3_scale(mat3_apply(r, c), -1)};
    }
    for (int i = 0; i < MATCHES; i++) {
        const int k = i / POINTS;
        matches[i] = (struct pose_match){.first = k, .second = k + 1, .room = ROOM};
        for (int s = 0; s < 2; s++) matches[i].rays[s] = vec3_normalize(pose_apply(&poses[k + s], points[i % POINTS]));
    }
}

static void true_poses_agree(void **state)
{
    struct pose poses[POSES];
    struct pose_match matches[MATCHES];
    struct pose_agreement a;
    struct err err = ERR_INIT;
    (void)state;
    make(poses, matches);
    assert_ok(pose_agreement_measure(&a, poses, POSES, matches, MATCHES, &err), err);
    assert_true(a.share == 1 && !a.reading);
    /* wrong matches do not: rays beside the points by more than the room, and points behind */
    for (int i = 0; i < MATCHES; i += 2) matches[i].rays[1] = vec3_normalize(vec3_make(next(), next(), 1));
    assert_ok(pose_agreement_measure(&a, poses, POSES, matches, MATCHES, &err), err);
    assert_true(a.share >= 0.5 && a.share < 0.53);
}

/* Cameras that only turn: rays are the same. */
static void turns_agree(void **state)
{
    struct pose poses[POSES];
    struct pose_match matches[MATCHES];
    struct pose_agreement a;
    struct err err = ERR_INIT;
    (void)state;
    make(poses, matches);
    for (int i = 0; i < MATCHES; i++) {
        struct pose_match *m = &matches[i];
        const struct vec3 world = mat3_apply(mat3_transpose(mat3_from_quat(poses[m->first].rotation)), m->rays[0]);
        m->rays[1] = mat3_apply(mat3_from_quat(poses[m->second].rotation), world);
    }
    for (int k = 0; k < POSES; k++) poses[k].translation = vec3_make(0, 0, 0);
    assert_ok(pose_agreement_measure(&a, poses, POSES, matches, MATCHES, &err), err);
    assert_true(a.share == 1);
}

static struct pose changed(const struct pose *p, int way)
{
    const struct mat3 r = mat3_from_quat(p->rotation), back = mat3_transpose(r);
    const struct vec3 t = p->translation, c = pose_center(p);
    const struct mat3 opengl = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    struct mat3 s = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    switch (way) {
    case 0:
        return (struct pose){quat_from_mat3(back), c};
    case 1:
        return (struct pose){quat_from_mat3(mat3_multiply(opengl, r)), mat3_apply(opengl, t)};
    case 2:
        return (struct pose){quat_from_mat3(mat3_multiply(back, opengl)), c};
    case 3:
        return (struct pose){quat_from_mat3(r), c};
    case 4:
        return (struct pose){quat_from_mat3(back), t};
    default:
        s.m[way - 5][way - 5] = -1;
        return (struct pose){quat_from_mat3(mat3_multiply(s, mat3_multiply(r, s))), mat3_apply(s, t)};
    }
}

static void wrong_conventions_are_named(void **state)
{
    static const char *const words[] = {"from camera to world (",
                                        "axes of OpenGL, y up and z backward (",
                                        "camera to world with camera axes of OpenGL",
                                        "centre in place",
                                        "rotations from camera to world beside",
                                        "mirrored in x",
                                        "mirrored in y",
                                        "mirrored in z"};
    struct pose poses[POSES], given[POSES];
    struct pose_match matches[MATCHES];
    (void)state;
    make(poses, matches);
    for (int way = 0; way < 8; way++) {
        struct pose_agreement a;
        struct err err = ERR_INIT;
        for (int k = 0; k < POSES; k++) given[k] = changed(&poses[k], way);
        assert_ok(pose_agreement_measure(&a, given, POSES, matches, MATCHES, &err), err);
        if (a.share >= AGREE_LEAST || a.best < 1 - 1e-12 || !a.reading || !strstr(a.reading, words[way]))
            fail_msg("%s: %g of the matches agree, %g if read %s", words[way], a.share, a.best,
                     a.reading ? a.reading : "otherwise");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(true_poses_agree),
        cmocka_unit_test(turns_agree),
        cmocka_unit_test(wrong_conventions_are_named),
    };
    return cmocka_run_group_tests_name("pose_agreement", tests, NULL, NULL);
}
