/* Relative errors of light, by hand. */
#include "stages/evaluate/radiance_error.h"

#include <math.h>

#include "tests/unit/scratch.h"

static void relative_rms_by_hand(void **state)
{
    /* sum of squares 9 + 16 + 0 + 144 = 169; off by 0.1 and 0.5 in two places: 0.26 */
    static const float truth[] = {3, 4, 0, 0, 0, 12}, found[] = {3.1f, 4, 0, 0, 0.5f, 12};
    static const uint8_t mask[] = {7, 2};
    struct err err = ERR_INIT;
    double rms = 0;
    (void)state;
    assert_ok(relative_rms(&rms, found, truth, 2, NULL, 0, &err), err);
    assert_true(fabs(rms - sqrt(0.26 / 169)) < 1e-7);
    assert_ok(relative_rms(&rms, found, truth, 2, mask, 7, &err), err);
    assert_true(fabs(rms - 0.1 / 5) < 1e-7);
    assert_int_equal(relative_rms(&rms, found, truth, 2, mask, 9, &err), ST_DATA);
    assert_err(err, ST_DATA, "no true light");
}

static void darkness_has_no_relative_error(void **state)
{
    static const float black[] = {0, 0, 0}, found[] = {1, 1, 1};
    struct err err = ERR_INIT;
    double rms = 0;
    (void)state;
    assert_int_equal(relative_rms(&rms, found, black, 1, NULL, 0, &err), ST_DATA);
}

static void textures_by_kind(void **state)
{
    static const float truth[] = {1, 1, 1, 2, 2, 2, 5, 5, 5}, found[] = {1.1f, 1.1f, 1.1f, 1, 1, 1, 0, 0, 0};
    static const uint8_t kinds[] = {TEXEL_SEEN, TEXEL_HIDDEN, TEXEL_OUTSIDE};
    struct err err = ERR_INIT;
    double seen, hidden;
    (void)state;
    assert_ok(texture_errors(&seen, &hidden, found, truth, kinds, 3, &err), err);
    assert_true(fabs(seen - 0.1) < 1e-6 && fabs(hidden - 0.5) < 1e-6);
    assert_ok(texture_errors(&seen, &hidden, found, truth, kinds, 1, &err), err);
    assert_true(hidden == -1);
    assert_int_equal(texture_errors(&seen, &hidden, found + 6, truth + 6, kinds + 2, 1, &err), ST_DATA);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relative_rms_by_hand),
        cmocka_unit_test(darkness_has_no_relative_error),
        cmocka_unit_test(textures_by_kind),
    };
    return cmocka_run_group_tests_name("radiance_error", tests, NULL, NULL);
}
