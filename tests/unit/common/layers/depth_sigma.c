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
        assert_true(depth_sigma(&s) > 0 && depth_sigma(&s) < s.sigma);
        assert_float_equal(depth_sigma(&wide), 3 * depth_sigma(&s), 1e-12);
    }
    assert_true(depth_sigma(&(struct depth_segment){.sigma = 0, .confidence = 1}) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(classes_are_divided_by_confidence),
        cmocka_unit_test(uncertainty_is_proportional_to_sigma),
    };
    return cmocka_run_group_tests_name("depth_sigma", tests, NULL, NULL);
}
