/* irradiance_ratio.c - errors of the ratio of irradiance after an edit to before: known ratios and factors. */
#include "stages/evaluate/light/irradiance_ratio.h"

#include <math.h>
#include <string.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { PIXELS = 4 };

struct made { /* irradiance before and after, true and found; the true light halves everywhere */
    float before[3 * PIXELS], after[3 * PIXELS], true_before[3 * PIXELS], true_after[3 * PIXELS];
    uint8_t known[PIXELS];
};

static struct made exact(void)
{
    struct made m;
    for (int i = 0; i < 3 * PIXELS; i++) {
        m.true_before[i] = m.before[i] = (float)(1 + i);
        m.true_after[i] = m.after[i] = (float)(1 + i) / 2;
    }
    memset(m.known, 1, sizeof m.known);
    return m;
}

static struct ratio_error measure(const struct made *m, const uint8_t *mask)
{
    struct ratio_error e;
    struct err err = ERR_INIT;
    const struct ratio_pixels p = {m->before, m->after, m->known, m->true_before, m->true_after, mask, PIXELS};
    assert_int_equal(ratio_error_init(&e, &err), ST_OK);
    ratio_error_add(&e, &p);
    return e;
}

static void exact_pictures_in_any_unit_have_no_error(void **state)
{
    (void)state;
    struct made m = exact();
    for (int i = 0; i < 3 * PIXELS; i++) m.before[i] *= 7, m.after[i] *= 7;
    struct ratio_error e = measure(&m, NULL);
    assert_int_equal(e.pixels, PIXELS);
    assert_int_equal(e.missing, 0);
    assert_float_equal(sqrt(e.square / e.reference), 0, 1e-6);
    assert_float_equal(sqrt(e.change / e.reference), 1, 1e-12); /* before is twice after */
    assert_float_equal(quantiles_get(&e.errors, 1), 0, 1e-6);
    ratio_error_release(&e);
}

static void a_wrong_ratio_has_its_relative_error(void **state)
{
    (void)state;
    struct made m = exact();
    for (int i = 0; i < 3 * PIXELS; i++) m.after[i] *= 1.25f;
    struct ratio_error e = measure(&m, NULL);
    assert_float_equal(sqrt(e.square / e.reference), 0.25, 1e-6);
    assert_float_equal(quantiles_get(&e.errors, 0.5), 0.25, 1e-3);
    ratio_error_release(&e);
}

/* A found ratio of 1 is wrong by the change itself. */
static void no_relighting_is_off_by_the_change(void **state)
{
    (void)state;
    struct made m = exact();
    memcpy(m.after, m.before, sizeof m.after);
    struct ratio_error e = measure(&m, NULL);
    assert_true(e.square == e.change);
    ratio_error_release(&e);
}

static void pixels_without_a_true_ratio_do_not_count(void **state)
{
    (void)state;
    static const uint8_t mask[PIXELS] = {1, 1, 1, 0};
    struct made m = exact();
    for (int c = 0; c < 3; c++) m.true_after[c] = 0;  /* the surface is gone */
    for (int c = 3; c < 6; c++) m.true_before[c] = 0; /* no light before */
    struct ratio_error e = measure(&m, mask);
    assert_int_equal(e.pixels, 1);
    assert_int_equal(e.missing, 0);
    ratio_error_release(&e);
}

static void pixels_without_a_found_ratio_are_missing(void **state)
{
    (void)state;
    struct made m = exact();
    m.known[0] = 0;
    for (int c = 3; c < 6; c++) m.before[c] = 0;
    struct ratio_error e = measure(&m, NULL);
    assert_int_equal(e.pixels, 2);
    assert_int_equal(e.missing, 2);
    ratio_error_release(&e);
}

static void a_channel_without_light_takes_the_ratio_of_luminance(void **state)
{
    (void)state;
    struct made m = exact();
    for (int i = 0; i < PIXELS; i++) m.before[3 * i + 2] = m.after[3 * i + 2] = 0;
    struct ratio_error e = measure(&m, NULL);
    assert_int_equal(e.pixels, PIXELS);
    assert_float_equal(sqrt(e.square / e.reference), 0, 1e-6);
    ratio_error_release(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_pictures_in_any_unit_have_no_error),
        cmocka_unit_test(a_wrong_ratio_has_its_relative_error),
        cmocka_unit_test(no_relighting_is_off_by_the_change),
        cmocka_unit_test(pixels_without_a_true_ratio_do_not_count),
        cmocka_unit_test(pixels_without_a_found_ratio_are_missing),
        cmocka_unit_test(a_channel_without_light_takes_the_ratio_of_luminance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
