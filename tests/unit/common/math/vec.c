/* vec.c - rotations, quaternions and eigenvectors against their definitions. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/math/vec.h"

static const struct mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static void assert_mat3(struct mat3 a, struct mat3 b, double tolerance)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_true(fabs(a.m[i][j] - b.m[i][j]) <= tolerance);
}

static struct quat about(struct vec3 axis, double angle)
{
    struct vec3 n = vec3_scale(vec3_normalize(axis), sin(angle / 2));
    return (struct quat){cos(angle / 2), n.x, n.y, n.z};
}

static void a_quaternion_rotates_about_its_axis(void **state)
{
    (void)state;
    struct mat3 quarter = mat3_from_quat(about(vec3_make(0, 0, 1), acos(-1) / 2)); /* x to y, y to -x */
    assert_mat3(quarter, (struct mat3){{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, 1e-15);
    struct vec3 v = mat3_apply(quarter, vec3_make(1, 2, 3));
    assert_true(fabs(v.x + 2) < 1e-15 && fabs(v.y - 1) < 1e-15 && v.z == 3);
}

/* All axes and angles up to a half turn, where w vanishes and the largest component is the divisor. */
static void quaternions_survive_the_round_trip(void **state)
{
    (void)state;
    const double angles[] = {0, 1e-9, 0.1, 1, 2, 3, 3.14159, acos(-1), -1, -3};
    for (int x = -2; x <= 2; x++) {
        for (int y = -2; y <= 2; y++) {
            for (int z = -2; z <= 2; z++) {
                if (!x && !y && !z) continue;
                for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
                    struct mat3 r = mat3_from_quat(about(vec3_make(x, y, z), angles[i]));
                    struct quat q = quat_from_mat3(r);
                    assert_true(q.w >= 0);
                    assert_true(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 2e-15);
                    assert_mat3(mat3_from_quat(q), r, 4e-15);
                    assert_mat3(mat3_multiply(r, mat3_transpose(r)), identity, 4e-15);
                }
            }
        }
    }
}

static void a_rotation_between_two_is_the_shorter_one(void **state)
{
    (void)state;
    const double angles[] = {0, 1e-12, 1e-7, 3e-6, 0.1, 2, 3.1, acos(-1)};
    const struct vec3 axis = vec3_make(1, -2, 0.5);
    const struct quat a = about(vec3_make(3, 1, -1), 1.2);
    const struct mat3 from = mat3_from_quat(a);
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        const struct quat b = quat_from_mat3(mat3_multiply(mat3_from_quat(about(axis, angles[i])), from));
        assert_true(fabs(quat_angle(a, b) - angles[i]) < 1e-15 * (1 + angles[i]) * 4);
        for (int k = 0; k < 6; k++) {
            const double t = k % 3 / 2.0;
            const struct quat to = k < 3 ? b : (struct quat){-b.w, -b.x, -b.y, -b.z}, q = quat_slerp(a, to, t);
            assert_true(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 2e-15);
            if (i == 7 && k % 3 == 1) continue; /* at half a turn both ways are as short */
            assert_mat3(mat3_from_quat(q), mat3_multiply(mat3_from_quat(about(axis, t * angles[i])), from), 4e-15);
        }
    }
    const struct quat third = quat_slerp(about(axis, 0.3), about(axis, 1.2), 1.0 / 3); /* at constant speed */
    assert_mat3(mat3_from_quat(third), mat3_from_quat(about(axis, 0.6)), 4e-15);
}

static void products_are_right_handed(void **state)
{
    (void)state;
    struct vec3 z = vec3_cross(vec3_make(1, 0, 0), vec3_make(0, 1, 0));
    assert_true(z.x == 0 && z.y == 0 && z.z == 1);
    struct vec3 zero = vec3_normalize(vec3_make(0, 0, 0));
    assert_true(zero.x == 0 && zero.y == 0 && zero.z == 0);
    assert_true(fabs(vec3_length(vec3_normalize(vec3_make(3, -4, 12))) - 1) < 1e-15);
}

static void check_eigen(struct mat3 a, double scale)
{
    double values[3];
    struct mat3 v;
    mat3_eigen_symmetric(a, values, &v);
    assert_true(values[0] <= values[1] && values[1] <= values[2]);
    assert_mat3(mat3_multiply(v, mat3_transpose(v)), identity, 1e-14);
    for (int i = 0; i < 3; i++) {
        struct vec3 row = vec3_make(v.m[i][0], v.m[i][1], v.m[i][2]);
        struct vec3 rest = vec3_sub(mat3_apply(a, row), vec3_scale(row, values[i]));
        assert_true(vec3_length(rest) <= 1e-14 * scale);
        double largest = fabs(row.x) >= fabs(row.y) ? row.x : row.y;
        if (fabs(row.z) > fabs(largest)) largest = row.z;
        assert_true(largest > 0);
    }
}

static void eigenvectors_match_their_definition(void **state)
{
    (void)state;
    double values[3];
    struct mat3 v, zero = {{{0}}};
    /* eigenvalues 1, 3 (the plane's) and 5 */
    mat3_eigen_symmetric((struct mat3){{{2, 1, 0}, {1, 2, 0}, {0, 0, 5}}}, values, &v);
    assert_true(fabs(values[0] - 1) < 1e-15 && fabs(values[1] - 3) < 1e-15 && values[2] == 5);
    assert_true(fabs(v.m[1][0] - sqrt(0.5)) < 1e-15 && fabs(v.m[1][1] - sqrt(0.5)) < 1e-15);

    check_eigen(zero, 1);
    check_eigen(identity, 1);
    check_eigen((struct mat3){{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, 3); /* rank 1 */
    check_eigen((struct mat3){{{1e-12, 1e-13, 0}, {1e-13, 1e12, 3}, {0, 3, 1}}}, 1e12);
    for (uint64_t k = 0; k < 500; k++) {
        struct mat3 a;
        double scale = pow(10, (double)(k % 41) - 20);
        for (int i = 0; i < 3; i++)
            for (int j = i; j < 3; j++)
                a.m[i][j] = a.m[j][i] = scale * sin((double)(9 * k + 3 * (uint64_t)i + (uint64_t)j) * 12.9898);
        check_eigen(a, scale * 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quaternion_rotates_about_its_axis),
        cmocka_unit_test(quaternions_survive_the_round_trip),
        cmocka_unit_test(a_rotation_between_two_is_the_shorter_one),
        cmocka_unit_test(products_are_right_handed),
        cmocka_unit_test(eigenvectors_match_their_definition),
    };
    return cmocka_run_group_tests_name("vec", tests, NULL, NULL);
}
