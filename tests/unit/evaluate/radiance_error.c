/* radiance_error.c - errors of radiance, of irradiance at points and of hidden faces: known factors come back. */
#include "stages/evaluate/measure/radiance_error.h"

#include <math.h>

#include "stages/evaluate/light/irradiance_error.h"
#include "stages/evaluate/render/shell_error.h"
#include "tests/unit/scratch.h"

enum { COUNT = 200 };

static float found[3 * COUNT], truth[4 * COUNT];

/* truth = factor * found, channel by channel; every fourth pixel is outside. */
static struct radiance_pixels pixels_with(float factor)
{
    for (int i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++) {
            found[3 * i + c] = 0.1f + 0.01f * (float)((7 * i + 3 * c) % 50);
            truth[4 * i + c] = factor * found[3 * i + c];
        }
        truth[4 * i + 3] = i % 4 != 3;
    }
    return (struct radiance_pixels){found, truth, NULL, COUNT, 1, 0};
}

static void a_factor_is_found_and_is_the_error(void **state)
{
    (void)state;
    struct radiance_pixels p = pixels_with(2);
    struct quantiles ratios = {0};
    struct radiance_error e;
    struct err err = ERR_INIT;
    double rms;
    assert_ok(quantiles_init(&ratios, &err), err);
    radiance_ratios_add(&ratios, &p);
    assert_int_equal(ratios.count, 150);
    assert_true(fabs(quantiles_get(&ratios, 0.5) - 2) < 0.001);
    quantiles_release(&ratios);

    assert_ok(radiance_error_init(&e, &err), err);
    assert_false(radiance_error_rms(&e, &rms));
    radiance_error_add(&e, &p);
    assert_int_equal(e.pixels, 150);
    assert_true(radiance_error_rms(&e, &rms) && fabs(rms - 0.5) < 1e-6);
    assert_true(fabs(quantiles_get(&e.errors, 0.9) - 0.5) < 0.001);
    radiance_error_release(&e);

    assert_ok(radiance_error_init(&e, &err), err);
    p.scale = 2;
    radiance_error_add(&e, &p);
    assert_true(radiance_error_rms(&e, &rms) && rms < 1e-6);
    radiance_error_release(&e);

    assert_ok(radiance_error_init(&e, &err), err);
    p.scale = 1;
    p.clip = 0.1; /* nothing is below it */
    radiance_error_add(&e, &p);
    assert_true(radiance_error_rms(&e, &rms) && rms < 1e-6);
    radiance_error_release(&e);
}

static void hidden_and_seen_pixels_are_apart(void **state)
{
    (void)state;
    struct radiance_pixels p = pixels_with(1);
    uint32_t shell[COUNT], whole[COUNT];
    struct shell_error e;
    struct err err = ERR_INIT;
    double middle, rms;
    for (int i = 0; i < COUNT; i++) {
        shell[i] = i < 10 ? 0 : 1 + (uint32_t)(i >= 120); /* the outdoors, face 1, face 2 */
        whole[i] = i >= 120 ? 9 : shell[i];               /* furniture before face 2 */
        for (int c = 0; c < 3 && i >= 120; c++) found[3 * i + c] *= 1.5f;
        truth[4 * i + 3] = 1;
    }
    const struct shell_pixels pixels = {p, shell, whole};
    assert_ok(shell_error_init(&e, &err), err);
    assert_ok(shell_error_add(&e, &pixels, &err), err);
    assert_int_equal(e.all[SHELL_SEEN].pixels, 110);
    assert_int_equal(e.all[SHELL_HIDDEN].pixels, 80);
    assert_true(radiance_error_rms(&e.all[SHELL_SEEN], &rms) && rms == 0);
    assert_true(radiance_error_rms(&e.all[SHELL_HIDDEN], &rms) && fabs(rms - 0.5) < 1e-6);
    assert_true(shell_face_median(&e, 1, SHELL_SEEN, &middle) && middle == 0);
    assert_true(shell_face_median(&e, 2, SHELL_HIDDEN, &middle) && fabs(middle - 0.5) < 1e-6);
    assert_false(shell_face_median(&e, 2, SHELL_SEEN, &middle));
    assert_int_equal(e.face_count, 3);
    shell_error_release(&e);
}

static void points_find_their_partners(void **state)
{
    (void)state;
    struct irradiance_list t, f;
    struct irradiance_errors e;
    struct err err = ERR_INIT;
    int partner[5];
    double scale;
    const bool wanted[5] = {true, true, true, true, true}, first[5] = {true, false, false, false, false};
    assert_ok(irradiance_list_read(&t,
                                   scratch_write("t.txt",
                                                 "# points\n0 0 0 0 0 1 1 2 3\n1 0 0 0 0 1 2 2 2\n2 0 0 0 0 1 0 0 0\n"
                                                 "3 0 0 0 0 1 1 1 1\n4 0 0 0 0 1 1 1 1\n"),
                                   &err),
              err);
    /* the second is 5 mm off, the fourth has another normal, the fifth is 2 cm off; another point lies between */
    assert_ok(irradiance_list_read(
                  &f,
                  scratch_write("f.txt", "4.02 0 0 0 0 1 1 1 1\n3 0 0 0 1 0 1 1 1\n2 0 0 0 0 1 5 5 5\n"
                                         "1.005 0 0 0 0 1 1 1 1\n0 0 0 0 0 1 0.5 1 1.5\n1.009 0 0 0 0 1 9 9 9\n"),
                  &err),
              err);
    irradiance_partners(partner, &t, &f);
    static const int wanted_partners[5] = {4, 3, 2, -1, -1};
    assert_memory_equal(partner, wanted_partners, sizeof partner);
    assert_ok(irradiance_scale(&scale, &t, &f, partner, &err), err);
    assert_true(fabs(scale - 2) < 1e-12);
    assert_ok(irradiance_errors(&e, &t, &f, partner, wanted, 1, &err), err);
    assert_int_equal(e.points, 2); /* the third has no true light */
    assert_true(fabs(e.rms - 0.5) < 1e-12 && fabs(e.error50 - 0.5) < 1e-12);
    assert_ok(irradiance_errors(&e, &t, &f, partner, first, 2, &err), err);
    assert_true(e.points == 1 && e.rms < 1e-12);
    irradiance_list_release(&t);
    irradiance_list_release(&f);
}

static void damaged_points_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"0 0 0 0 0 1 1 1\n", ":1: "},
        {"\n0 0 0 0 0 1 1 1 1 1\n", ":2: found \"1\""},
        {"0 0 0 0 1 1 1 1 1\n", "wanted a normal of length 1"},
        {"0 0 0 0 0 1 1 -1 1\n", "irradiance, a number of at least 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct irradiance_list list;
        struct err err = ERR_INIT;
        assert_int_equal(irradiance_list_read(&list, scratch_write("p.txt", cases[i][0]), &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i][1]);
        assert_null(list.points);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_factor_is_found_and_is_the_error),
        cmocka_unit_test(hidden_and_seen_pixels_are_apart),
        cmocka_unit_test(points_find_their_partners),
        cmocka_unit_test(damaged_points_are_refused),
    };
    return cmocka_run_group_tests_name("radiance_error", tests, scratch_make, scratch_remove);
}
