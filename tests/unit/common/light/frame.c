/* Directions about an axis, and the inline functions they are made of. */
#include "tests/unit/common/light/near.h"

#include "common/base/rng.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"

static void cosine_and_sine_agree_with_libm(void **state)
{
    (void)state;
    for (int i = 0; i <= 10000; i++) {
        const double turns = i / 10000.0;
        double c, s;
        fast_cos_sin(turns, &c, &s);
        assert_true(fabs(c - cos(2 * PI * turns)) < 1e-13 && fabs(s - sin(2 * PI * turns)) < 1e-13);
        f64x4 c4, s4;
        fast_cos_sin4((f64x4){0.3, 0.7, turns, 0.1}, &c4, &s4);
        assert_true(c4[2] == c && s4[2] == s);
    }
}

static void frames_are_orthonormal_and_right_handed(void **state)
{
    (void)state;
    const struct rng rng = rng_make(1, "test", "frame");
    for (uint64_t i = 0; i < 1000; i++) {
        struct vec3 z = {2 * rng_uniform(&rng, i, 0) - 1, 2 * rng_uniform(&rng, i, 1) - 1,
                         2 * rng_uniform(&rng, i, 2) - 1};
        struct vec3 x, y;
        if (i < 2) z = vec3_make(0, 0, i ? -1 : 1);
        if (i >= 2 && i < 20) z.z *= 1e-12;
        z = vec3_normalize(z);
        frame_from_normal(z, &x, &y);
        assert_near(vec3_length(x), 1, 1e-12);
        assert_near(vec3_length(y), 1, 1e-12);
        assert_true(fabs(vec3_dot(x, y)) < 1e-12 && fabs(vec3_dot(x, z)) < 1e-12 && fabs(vec3_dot(y, z)) < 1e-12);
        assert_near(vec3_dot(vec3_cross(x, y), z), 1, 1e-12);
        const struct vec3 d = frame_direction(z, 0.6, 0.8, rng_uniform(&rng, i, 3));
        assert_near(vec3_length(d), 1, 1e-12);
        assert_near(vec3_dot(d, z), 0.8, 1e-12);
    }
}

static void comparisons_with_nan_give_the_second_argument(void **state)
{
    (void)state;
    assert_true(fast_min(NAN, 2) == 2 && fast_max(NAN, 2) == 2 && isnan(fast_min(2, NAN)) && isnan(fast_max(2, NAN)));
    assert_true(fast_min(1, 2) == 1 && fast_max(1, 2) == 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cosine_and_sine_agree_with_libm),
        cmocka_unit_test(frames_are_orthonormal_and_right_handed),
        cmocka_unit_test(comparisons_with_nan_give_the_second_argument),
    };
    return cmocka_run_group_tests_name("light frame", tests, NULL, NULL);
}
