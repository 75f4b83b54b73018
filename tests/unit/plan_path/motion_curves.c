/* motion_curves.c - tests of curves through keys: interpolation, smoothness, straight lines and rest. */
#include "stages/plan_path/motion_curves.h"

#include "tests/unit/scratch.h"

static double angle_between(struct quat a, struct quat b)
{
    const double d = fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z);
    const double c[] = {a.w - b.w, a.x - b.x, a.y - b.y, a.z - b.z}, e[] = {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
    double sum[2] = {0};
    for (int i = 0; i < 4; i++) sum[0] += c[i] * c[i], sum[1] += e[i] * e[i];
    return d > 0.5 ? 4 * asin(fmin(1, sqrt(fmin(sum[0], sum[1])) / 2)) : 2 * acos(d);
}

static struct quat rotation_about(double x, double y, double z, double angle)
{
    const double s = sin(angle / 2) / sqrt(x * x + y * y + z * z);
    return (struct quat){cos(angle / 2), s * x, s * y, s * z};
}

static void make(struct motion *m, int count)
{
    struct err err = ERR_INIT;
    assert_ok(motion_init(m, count, &err), err);
}

static void set(struct motion *m, int i, double time, struct vec3 position, struct quat rotation)
{
    m->distance.time[i] = time;
    m->position[i] = position;
    m->rotation[i] = rotation;
}

static struct vec3 position_at(const struct motion *m, double t)
{
    struct vec3 p;
    struct quat q;
    motion_at(m, t, &p, &q);
    return p;
}

static struct quat rotation_at(const struct motion *m, double t)
{
    struct vec3 p;
    struct quat q;
    motion_at(m, t, &p, &q);
    return q;
}

static const double times[] = {0, 0.7, 1, 2.5, 2.75, 4};

/* Six irregular keys with quaternions of either sign. */
static void make_irregular(struct motion *m, bool rest)
{
    make(m, 6);
    for (uint32_t i = 0; i < 6; i++) {
        double r[6];
        for (uint32_t k = 0; k < 6; k++) r[k] = 2 * sin(17.3 * (i + 1) + 5.1 * k) - 0.5;
        struct quat q = rotation_about(r[3], r[4], r[5] + 3, 1.1 * i);
        if (i % 2) q = (struct quat){-q.w, -q.x, -q.y, -q.z};
        set(m, (int)i, times[i], vec3_make(r[0], 3 * r[1], r[2]), q);
    }
    motion_fit(m, rest);
}

static void keys_are_passed_exactly(void **state)
{
    (void)state;
    struct motion m;
    make_irregular(&m, true);
    for (int i = 0; i < 6; i++) {
        const struct vec3 p = position_at(&m, times[i]);
        const struct quat q = rotation_at(&m, times[i]);
        assert_memory_equal(&p, &m.position[i], sizeof p);
        assert_memory_equal(&q, &m.rotation[i], sizeof q);
        /* and approached from both sides */
        for (int side = -1; side <= 1; side += 2) {
            assert_true(vec3_length(vec3_sub(position_at(&m, times[i] + side * 1e-9), p)) < 1e-7);
            assert_true(angle_between(rotation_at(&m, times[i] + side * 1e-9), q) < 1e-7);
        }
    }
    motion_release(&m);
}

/* Compares velocities on both sides of each key by differences, and the rates at both ends. */
static void velocity_is_continuous(void **state)
{
    (void)state;
    const double e = 1e-5;
    for (int rest = 0; rest < 2; rest++) {
        struct motion m;
        double worst = 0, worst_rotation = 0;
        make_irregular(&m, rest);
        for (int i = 1; i < 5; i++) {
            const struct vec3 p = m.position[i], a = position_at(&m, times[i] - e), b = position_at(&m, times[i] + e);
            worst = fmax(worst, vec3_length(vec3_sub(vec3_sub(b, p), vec3_sub(p, a))) / e);
            const struct quat l = rotation_at(&m, times[i] - e), r = rotation_at(&m, times[i] + e);
            /* the same rotation on both sides: from l to r is twice from l to the key */
            worst_rotation = fmax(worst_rotation, fabs(angle_between(l, r) - 2 * angle_between(l, m.rotation[i])) / e);
        }
        assert_true(worst < 0.01 && worst_rotation < 0.01); /* second differences: acceleration times e remains */
        struct vec3 v, w;
        for (int last = 0; last < 2; last++) {
            motion_rates(&m, last, &v, &w);
            const double t = last ? times[5] : 0, d = last ? -e : e;
            const struct vec3 measured = vec3_scale(vec3_sub(position_at(&m, t + d), position_at(&m, t)), 1 / d);
            assert_true(vec3_length(vec3_sub(v, measured)) < 0.01);
            assert_true(fabs(vec3_length(w) - angle_between(rotation_at(&m, t + d), rotation_at(&m, t)) / e) < 0.01);
            assert_true(!rest || (vec3_length(v) == 0 && vec3_length(w) == 0));
        }
        motion_release(&m);
    }
}

static void a_line_stays_a_line_without_overshoot(void **state)
{
    (void)state;
    struct motion m;
    const struct vec3 direction = vec3_normalize(vec3_make(3, -2, 1));
    double before = 0;
    make(&m, 4); /* fast, then very slow */
    for (int i = 0; i < 4; i++)
        set(&m, i, i, vec3_scale(direction, (double[]){0, 5, 5.01, 6}[i]),
            rotation_about(0, 1, 0.5, (double[]){0, 2, 2.01, 4}[i]));
    motion_fit(&m, true);
    for (int i = 0; i <= 300; i++) {
        const struct vec3 p = position_at(&m, i / 100.0);
        const double s = vec3_dot(p, direction);
        assert_true(vec3_length(vec3_sub(p, vec3_scale(direction, s))) < 1e-12);
        assert_true(s >= before - 1e-12 && s <= 6 + 1e-12);
        before = s;
        const struct quat q = rotation_at(&m, i / 100.0); /* about one axis */
        assert_true(fabs(q.x) < 1e-12 && fabs(q.y - 2 * q.z) < 1e-12);
    }
    motion_release(&m);
}

static void constant_velocity_stays_constant(void **state)
{
    (void)state;
    struct motion m;
    make(&m, 6);
    for (int i = 0; i < 6; i++)
        set(&m, i, times[i], vec3_make(1 + 2 * times[i], 0.5 * times[i], 3), rotation_about(1, 2, 3, 0.4 * times[i]));
    motion_fit(&m, false);
    for (int i = 0; i <= 400; i++) {
        const double t = i / 100.0;
        assert_true(vec3_length(vec3_sub(position_at(&m, t), vec3_make(1 + 2 * t, 0.5 * t, 3))) < 1e-12);
        assert_true(angle_between(rotation_at(&m, t), rotation_about(1, 2, 3, 0.4 * t)) < 1e-12);
    }
    motion_release(&m);
}

static void nothing_moves_between_equal_keys(void **state)
{
    (void)state;
    struct motion m;
    const struct vec3 p[] = {{0, 0, 0}, {1, 1, 0}, {1, 1, 0}, {3, 0, 1}};
    make(&m, 4);
    for (int i = 0; i < 4; i++) set(&m, i, i, p[i], rotation_about(0, 1, 0, (i + 1) / 2)); /* 0 1 1 2 */
    motion_fit(&m, false);
    for (int i = 0; i <= 100; i++) {
        assert_true(vec3_length(vec3_sub(position_at(&m, 1 + i / 100.0), p[1])) == 0);
        assert_true(angle_between(rotation_at(&m, 1 + i / 100.0), m.rotation[1]) == 0);
    }
    for (int i = 0; i < 4; i++) set(&m, i, i, p[1], rotation_about(1, 0, 0, 0.3)); /* all keys equal */
    motion_fit(&m, false);
    for (int i = -10; i <= 40; i++) assert_true(vec3_length(vec3_sub(position_at(&m, i / 10.0), p[1])) == 0);
    motion_release(&m);
    make(&m, 1);
    set(&m, 0, 0, p[1], rotation_about(1, 0, 0, 0.3));
    motion_fit(&m, false);
    assert_true(vec3_length(vec3_sub(position_at(&m, 5), p[1])) == 0);
    motion_release(&m);
}

/* For either sign of the quaternions, the rotation is no longer than the angle between the keys. */
static void rotations_take_the_shorter_way(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        struct motion m;
        make(&m, 2);
        struct quat to = rotation_about(0.2, 1, -0.4, 3.0);
        to = (struct quat){sign * to.w, sign * to.x, sign * to.y, sign * to.z};
        set(&m, 0, 0, vec3_make(0, 0, 0), (struct quat){1, 0, 0, 0});
        set(&m, 1, 1, vec3_make(0, 0, 0), to);
        motion_fit(&m, false);
        for (int i = 0; i <= 20; i++)
            assert_true(fabs(angle_between(rotation_at(&m, i / 20.0), m.rotation[0]) - 3.0 * i / 20) < 1e-9);
        motion_release(&m);
    }
}

static void two_keys_at_rest_ease(void **state)
{
    (void)state;
    struct motion m;
    make(&m, 2);
    set(&m, 0, 0, vec3_make(0, 0, 0), rotation_about(0, 0, 1, 0));
    set(&m, 1, 2, vec3_make(8, 0, 0), rotation_about(0, 0, 1, 1));
    motion_fit(&m, true);
    for (int i = 0; i <= 20; i++) {
        const double t = i / 20.0, s = t * t * (3 - 2 * t);
        assert_true(fabs(position_at(&m, 2 * t).x - 8 * s) < 1e-12);
        assert_true(fabs(angle_between(rotation_at(&m, 2 * t), m.rotation[0]) - s) < 1e-9);
    }
    motion_release(&m);
}

static void numbers_stay_between_their_keys(void **state)
{
    (void)state;
    static const double value[] = {3, 3, 9, 9.001, 2, -1e9};
    for (int rest = 0; rest < 2; rest++) {
        struct curve c;
        struct err err = ERR_INIT;
        assert_ok(curve_init(&c, 6, &err), err);
        for (int i = 0; i < 6; i++) c.time[i] = times[i], c.value[i] = value[i];
        curve_fit(&c, rest);
        for (int i = 0; i < 6; i++) assert_true(curve_at(&c, times[i]) == value[i]);
        assert_true(curve_at(&c, -1) == 3 && curve_at(&c, 9) == -1e9 && curve_at(&c, 0.3) == 3);
        for (int i = 0; i < 5; i++)
            for (int k = 0; k <= 50; k++) {
                const double v = curve_at(&c, times[i] + (times[i + 1] - times[i]) * k / 50);
                assert_true(v >= fmin(value[i], value[i + 1]) && v <= fmax(value[i], value[i + 1]));
            }
        for (int i = 1; i < 4; i++) { /* no kink */
            const double e = 1e-6, jump = curve_at(&c, times[i] - e) + curve_at(&c, times[i] + e) - 2 * value[i];
            assert_true(fabs(jump) < 1e-9);
        }
        curve_release(&c);
    }
}

static void huge_and_tiny_keys_give_finite_values(void **state)
{
    (void)state;
    static const double size[] = {1e9, 1e-9, 1e-300, 0};
    for (int k = 0; k < 4; k++) {
        struct motion m;
        make(&m, 4);
        for (int i = 0; i < 4; i++)
            set(&m, i, i * 1e5, vec3_make(i % 2 ? size[k] : -size[k], size[k] * i, 1e9),
                rotation_about(1, i, 0, i % 2 ? M_PI : size[k] * 1e-9));
        motion_fit(&m, k % 2);
        for (int i = 0; i <= 90; i++) {
            const struct vec3 p = position_at(&m, i * 1e5 / 30);
            const struct quat q = rotation_at(&m, i * 1e5 / 30);
            assert_true(isfinite(vec3_length(p)));
            assert_true(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-12);
        }
        motion_release(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_are_passed_exactly),
        cmocka_unit_test(velocity_is_continuous),
        cmocka_unit_test(a_line_stays_a_line_without_overshoot),
        cmocka_unit_test(constant_velocity_stays_constant),
        cmocka_unit_test(nothing_moves_between_equal_keys),
        cmocka_unit_test(rotations_take_the_shorter_way),
        cmocka_unit_test(two_keys_at_rest_ease),
        cmocka_unit_test(numbers_stay_between_their_keys),
        cmocka_unit_test(huge_and_tiny_keys_give_finite_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
