/* depth_error.c - depth errors of a few pixels, counted by hand. */
#include "stages/evaluate/depth_error.h"

#include <math.h>

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
        cmocka_unit_test(merging_adds_the_counts),
        cmocka_unit_test(quantiles_are_precise_at_all_magnitudes),
    };
    return cmocka_run_group_tests_name("depth_error", tests, NULL, NULL);
}
