/* depth_sigma.c - classes of confidence, and the uncertainty that follows from a segment's sigma. */
#include "common/layers/depth_sigma.h"

#include "tests/unit/scratch.h"

static void classes_are_divided_by_confidence(void **state)
{
    (void)state;
    assert_int_equal(depth_class(0), DEPTH_CLASS_INHERITED);
    assert_int_equal(depth_class(DEPTH_INHERITED - 1e-9), DEPTH_CLASS_INHERITED);
    assert_int_equal(depth_class(DEPTH_INHERITED), DEPTH_CLASS_UNSURE);
    assert_int_equal(depth_class(DEPTH_SURE), DEPTH_CLASS_SURE);
    assert_int_equal(depth_class(1), DEPTH_CLASS_SURE);
    assert_string_equal(depth_class_name(DEPTH_CLASS_SURE), "sure");
}

/* The estimator's sigma is a cautious tolerance, so every class makes it smaller, in proportion. */
static void uncertainty_is_proportional_to_sigma(void **state)
{
    (void)state;
    for (int c = 0; c <= 10; c++) {
        const struct depth_segment s = {.sigma = 0.02, .confidence = c / 10.0},
                                   wide = {.sigma = 0.06, .confidence = c / 10.0};
        assert_true(depth_width(&s) > 0 && depth_width(&s) < s.sigma);
        assert_float_equal(depth_width(&wide), 3 * depth_width(&s), 1e-12);
    }
    assert_true(depth_width(&(struct depth_segment){.sigma = 0, .confidence = 1}) == 0);
}

static void a_stated_deviation_wins(void **state)
{
    (void)state;
    const struct depth_segment unstated = {.sigma = 0.02, .confidence = 1},
                               stated = {.sigma = 0.02, .confidence = 1, .deviation = 0.3};
    assert_true(depth_sigma(&unstated) == depth_width(&unstated));
    assert_true(depth_sigma(&stated) == 0.3);
    assert_true(depth_width(&stated) == depth_width(&unstated));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(classes_are_divided_by_confidence),
        cmocka_unit_test(uncertainty_is_proportional_to_sigma),
        cmocka_unit_test(a_stated_deviation_wins),
    };
    return cmocka_run_group_tests_name("depth_sigma", tests, NULL, NULL);
}
