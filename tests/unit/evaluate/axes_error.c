/* axes_error.c - errors of axes that are rotated by known angles. */
#include "stages/evaluate/model/axes_error.h"

#include "tests/unit/scratch.h"

static struct mat3 turn(double degrees, double x, double y, double z)
{
    double a = degrees * M_PI / 360;
    return mat3_from_quat((struct quat){cos(a), sin(a) * x, sin(a) * y, sin(a) * z});
}

static void known_rotations_are_measured(void **state)
{
    struct room_axes truth = {turn(23, 0, 0, 1), 0.8, 3.4}, found = truth;
    struct axes_errors e = axes_errors(&found, &truth);
    (void)state;
    assert_true(e.up < 1e-9 && e.all < 1e-6 && e.floor == 0 && e.ceiling == 0);

    for (int k = 0; k < 4; k++) { /* which wall is x does not matter */
        found = (struct room_axes){mat3_multiply(turn(90 * k + 5, 0, 0, 1), truth.axes), 0.75, 3.5};
        e = axes_errors(&found, &truth);
        assert_true(e.up < 1e-9 && fabs(e.all - 5) < 1e-9);
        assert_true(fabs(e.floor - 0.05) < 1e-12 && fabs(e.ceiling - 0.1) < 1e-12);
    }
    found.axes = mat3_multiply(turn(2, 1, 0, 0), truth.axes);
    e = axes_errors(&found, &truth);
    assert_true(fabs(e.up - 2) < 1e-9 && fabs(e.all - 2) < 1e-9);
    found.axes = mat3_multiply(turn(180, 1, 0, 0), truth.axes); /* upside down */
    e = axes_errors(&found, &truth);
    assert_true(fabs(e.up - 180) < 1e-6 && fabs(e.all - 180) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_rotations_are_measured)};
    return cmocka_run_group_tests_name("axes_error", tests, NULL, NULL);
}
