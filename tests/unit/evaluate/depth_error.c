/* depth_error.c - depth errors of a few pixels, counted by hand. */
#include "stages/evaluate/views/depth_error.h"
#include "stages/evaluate/views/sigma_error.h"

#include <math.h>

#include "common/base/rng.h"
#include "tests/unit/scratch.h"

static void assert_close(double a, double b) { assert_true(fabs(a - b) <= fabs(b) / 4096); }

static void pixels_and_quantiles_are_counted(void **state)
{
    /* f B = 10: disparities 5 5, 5 4, 5 2.5, 2 0.5, 5 none; the last pixel has no truth */
    static const float truth[] = {2, 2, 2, 5, 2, 0}, z[] = {2, 2.5f, 4, 20, 0, 1};
    static const uint8_t occluded[] = {0, 0, 1, 0, 0, 0};
    struct depth_errors e;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(depth_errors_init(&e, &err), err);
    depth_errors_add(&e, z, truth, occluded, 6, 10);
    assert_int_equal(e.all.pixels, 5);
    assert_int_equal(e.all.known, 4);
    assert_int_equal(e.all.within2, 1);
    assert_int_equal(e.all.bad1, 3); /* errors of 2.5 and 1.5 px, and the unknown one; exactly 1 px is not bad */
    assert_int_equal(e.all.bad2, 2);
    assert_int_equal(e.visible.pixels, 4);
    assert_int_equal(e.visible.known, 3);
    assert_int_equal(e.visible.bad1, 2);
    assert_int_equal(e.visible.bad2, 1);
    assert_close(quantiles_get(&e.all.errors, 0.25), 0); /* errors 0, 0.25, 1, 3 */
    assert_close(quantiles_get(&e.all.errors, 0.5), 0.25);
    assert_close(quantiles_get(&e.all.errors, 0.75), 1);
    assert_close(quantiles_get(&e.all.errors, 0.9), 3);
    assert_close(quantiles_get(&e.visible.errors, 0.5), 0.25); /* 0, 0.25, 3 */
    depth_errors_release(&e);
    depth_errors_release(&e);
}

static void errors_in_stated_deviations_are_counted_by_class(void **state)
{
    /* relative errors of 1/z: 0.1, 0.25, 0.5, 0; then no depth, no truth, no segment; then sigma 0 */
    static const float truth[] = {1, 2, 2, 4, 1, 0, 1, 1}, z[] = {0.9f, 2.5f, 3, 4, 0, 1, 1, 2};
    static const float sigma[] = {0.11f, 0.1f, 0.1f, 0, 1, 1, 1, 0};
    static const uint8_t classes[] = {DEPTH_CLASS_SURE, DEPTH_CLASS_SURE,   DEPTH_CLASS_SURE, DEPTH_CLASS_UNSURE,
                                      DEPTH_CLASS_SURE, DEPTH_CLASS_UNSURE, DEPTH_CLASSES,    DEPTH_CLASS_INHERITED};
    struct sigma_errors e;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(sigma_errors_init(&e, &err), err);
    sigma_errors_add(&e, z, truth, sigma, classes, 8);
    const struct sigma_tally *sure = &e.classes[DEPTH_CLASS_SURE], *unsure = &e.classes[DEPTH_CLASS_UNSURE],
                             *inherited = &e.classes[DEPTH_CLASS_INHERITED];
    assert_true(sure->within[0] == 1 && sure->within[1] == 1 && sure->within[2] == 2 && sure->errors.count == 3);
    assert_true(unsure->within[0] == 1 && unsure->within[2] == 1 && unsure->errors.count == 1);
    assert_true(inherited->within[2] == 0 && inherited->errors.count == 1);
    assert_close(quantiles_get(&sure->errors, 0.5), 2.5);
    assert_close(quantiles_get(&sure->errors, 1), 5);
    sigma_tally_merge(&e.classes[DEPTH_CLASS_UNSURE], sure);
    assert_true(unsure->within[0] == 2 && unsure->within[2] == 3 && unsure->errors.count == 4);
    sigma_errors_release(&e);
    sigma_errors_release(&e);
}

/* Normal errors of a known deviation: the three shares and the factor follow. */
static void shares_of_normal_errors_are_found(void **state)
{
    enum { COUNT = 200000 };
    static float z[COUNT], truth[COUNT], sigma[COUNT];
    static uint8_t classes[COUNT];
    const struct rng rng = rng_make(4, "depth_error", "test");
    struct sigma_errors e;
    struct err err = ERR_INIT;
    (void)state;
    for (uint64_t i = 0; i < COUNT; i++) {
        const double a = rng_uniform(&rng, i, 0), b = rng_uniform(&rng, i, 1);
        const double off = sqrt(-2 * log(1 - a)) * cos(2 * 3.14159265358979323846 * b);
        truth[i] = 3;
        sigma[i] = 0.01f;
        z[i] = (float)(3 * (1 + 0.02 * off)); /* twice what is stated */
        classes[i] = DEPTH_CLASS_SURE;
    }
    assert_ok(sigma_errors_init(&e, &err), err);
    sigma_errors_add(&e, z, truth, sigma, classes, COUNT);
    const struct sigma_tally *t = &e.classes[DEPTH_CLASS_SURE];
    assert_float_equal(quantiles_get(&t->errors, 0.6827), 2, 0.02);
    assert_float_equal((double)t->within[1] / COUNT, 0.6827, 0.005);
    assert_float_equal((double)t->within[0] / COUNT, 0.3829, 0.005);
    sigma_errors_release(&e);
}

static void merging_adds_the_counts(void **state)
{
    static const float truth[] = {1, 1, 4, 4}, z[] = {1.5f, 0, 5, 4};
    struct depth_errors a, b, both;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(depth_errors_init(&a, &err), err);
    assert_ok(depth_errors_init(&b, &err), err);
    assert_ok(depth_errors_init(&both, &err), err);
    depth_errors_add(&a, z, truth, NULL, 2, 3);
    depth_errors_add(&b, z + 2, truth + 2, NULL, 2, 3);
    depth_errors_add(&both, z, truth, NULL, 4, 3);
    depth_errors_merge(&a, &b);
    assert_int_equal(a.all.pixels, both.all.pixels);
    assert_int_equal(a.all.known, both.all.known);
    assert_int_equal(a.all.bad1, both.all.bad1);
    assert_int_equal(a.visible.bad2, both.visible.bad2);
    for (int k = 1; k <= 10; k++)
        assert_true(quantiles_get(&a.all.errors, k / 10.0) == quantiles_get(&both.all.errors, k / 10.0));
    depth_errors_release(&a);
    depth_errors_release(&b);
    depth_errors_release(&both);
}

static void quantiles_are_precise_at_all_magnitudes(void **state)
{
    struct quantiles q;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(quantiles_init(&q, &err), err);
    for (int i = 1000; i >= 1; i--) quantiles_add(&q, (float)i * 1e-6f);
    assert_close(quantiles_get(&q, 0.9), 900e-6);
    assert_close(quantiles_get(&q, 0.001), 1e-6);
    assert_close(quantiles_get(&q, 1), 1000e-6);
    quantiles_add(&q, 1e30f);
    assert_close(quantiles_get(&q, 1), 1e30);
    for (int i = 0; i < 3000; i++) quantiles_add(&q, 0);
    assert_true(quantiles_get(&q, 0.5) == 0);
    quantiles_release(&q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_and_quantiles_are_counted),
        cmocka_unit_test(errors_in_stated_deviations_are_counted_by_class),
        cmocka_unit_test(shares_of_normal_errors_are_found),
        cmocka_unit_test(merging_adds_the_counts),
        cmocka_unit_test(quantiles_are_precise_at_all_magnitudes),
    };
    return cmocka_run_group_tests_name("depth_error", tests, NULL, NULL);
}
