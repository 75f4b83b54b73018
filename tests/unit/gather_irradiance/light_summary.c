/* light_summary.c - shares and errors of known points, the examples, the record read back, the picture of a
 * hemicube. */
#include "stages/gather_irradiance/light_summary.h"

#include <math.h>

#include "tests/unit/scratch.h"

#include "common/image/photo.h"
#include "stages/gather_irradiance/hemicube_picture.h"
#include "stages/gather_irradiance/unfold.h"

enum { POINTS = 6 };

/* Five points whose errors are 10, 20 ... 50 %, one of which is in the dark, and one that is none. */
static void make_points(struct gather_point *points, struct irradiance *e)
{
    for (int i = 0; i < POINTS; i++) {
        points[i] = (struct gather_point){{i, 0, 0}, {0, 0, i < 5}};
        e[i] = (struct irradiance){.value = rgb_grey(i == 2 ? 0 : 2), .error = rgb_grey(0.2 * (i + 1))};
        if (i == 2 || i == 5) continue;
        e[i].from[LIGHT_TEXTURE] = 0.75;
        e[i].from[LIGHT_LAMP] = 0.25;
    }
}

static void shares_errors_and_examples_are_those_of_lit_points(void **state)
{
    struct gather_point points[POINTS];
    struct irradiance e[POINTS];
    struct light_record r;
    struct err err = ERR_INIT;
    size_t chosen[LIGHT_EXAMPLES_MAX];
    (void)state;
    make_points(points, e);
    assert_ok(light_summarize(&r, chosen, points, e, POINTS, 3, &err), err);
    assert_int_equal(r.points, 5);
    assert_int_equal(r.dark, 1);
    assert_float_equal(r.from[LIGHT_TEXTURE], 0.75, 1e-12);
    assert_float_equal(r.from[LIGHT_LAMP], 0.25, 1e-12);
    assert_float_equal(r.error[2], 0.5, 1e-12);
    assert_int_equal(r.example_count, 3);
    assert_int_equal(chosen[0], 4); /* the least sure, one between, the surest */
    assert_int_equal(chosen[1], 3);
    assert_int_equal(chosen[2], 0);
    assert_ok(light_summarize(&r, NULL, points, e, 2, 9, &err), err); /* no more examples than points */
    assert_int_equal(r.example_count, 2);
    assert_ok(light_summarize(&r, NULL, points, e, 0, 3, &err), err);
    assert_int_equal(r.example_count, 0);
}

static void a_record_is_read_as_it_was_written(void **state)
{
    struct gather_point points[POINTS];
    struct irradiance e[POINTS];
    struct light_record r, back;
    struct err err = ERR_INIT;
    (void)state;
    make_points(points, e);
    assert_ok(light_summarize(&r, NULL, points, e, POINTS, 2, &err), err);
    r.level[0] = 0.5, r.level[1] = 4;
    assert_ok(light_record_write(&r, scratch_path("a.light.txt"), NULL, &err), err);
    assert_ok(light_record_read(&back, scratch_path("a.light.txt"), &err), err);
    assert_int_equal(back.points, 5);
    assert_int_equal(back.dark, 1);
    assert_int_equal(back.example_count, 2);
    assert_float_equal(back.level[1], 4, 0);
    for (int s = 0; s < LIGHT_SOURCES; s++) assert_float_equal(back.from[s], r.from[s], 1e-6);
    assert_float_equal(back.examples[0].point.at.x, 4, 0);
    assert_float_equal(back.examples[0].error, 0.5, 1e-4);
}

static void a_damaged_record_is_refused(void **state)
{
    static const char *const cases[][2] = {
        {"remodel-light-record 9\n", "version"},
        {"remodel-light-record 2\npoints -1 dark 0\n", ":2:"},
        {"remodel-light-record 2\npoints 3 dark 4\n", ":2:"},
        {"remodel-light-record 2\nerror 1 2\n", ":2:"},
        {"remodel-light-record 2\nshares none 2\n", "from 0 to"},
        {"remodel-light-record 2\nhemicube 2 0 0 0 0 0 1 1 1 1 0\n", ":2:"},
        {"remodel-light-record 2\nlevel 1 2 3\n", ":2:"},
        {"remodel-light-record 2\nglow 1\n", "glow"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct light_record r;
        struct err err = ERR_INIT;
        assert_int_equal(light_record_read(&r, scratch_write("bad.light.txt", cases[i][0]), &err), ST_DATA);
        if (!strstr(err.text, cases[i][1])) fail_msg("case %zu: %s", i, err.text);
    }
}

/* Light from the half with x > 0 only. */
static void look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                 const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    (void)ctx, (void)from, (void)normal;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1)
            seen[k] = (struct light_look){rgb_grey(direction[k].x > 0 ? 1 : 0), INFINITY, LIGHT_SKY, -1};
}

static void a_picture_shows_light_where_it_comes_from(void **state)
{
    const struct light_field field = {.look = look};
    struct photo p = {0};
    struct err err = ERR_INIT;
    struct vec3 right, down;
    enum { N = 32 };
    (void)state;
    unfold_frame(&right, &down, vec3_make(0, 0, 1));
    assert_ok(
        hemicube_picture_write(&field, (struct gather_point){{0, 0, 0}, {0, 0, 1}}, N, scratch_path("h.jpg"), &err),
        err);
    assert_ok(photo_read(&p, scratch_path("h.jpg"), &err), err);
    assert_int_equal(p.info.width, 2 * N);
    assert_int_equal(p.info.height, 2 * N);
    const int bright = right.x > 0 ? 3 * N / 2 + 8 : N / 2 - 8, dark = 2 * N - bright;
    assert_true(p.samples[3 * (N * 2 * N + bright)] > 150);
    assert_true(p.samples[3 * (N * 2 * N + dark)] < 40);
    assert_true(abs((int)p.samples[3 * (2 * 2 * N + 2)] - 110) < 12); /* a corner */
    photo_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_errors_and_examples_are_those_of_lit_points),
        cmocka_unit_test_setup_teardown(a_record_is_read_as_it_was_written, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(a_damaged_record_is_refused, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(a_picture_shows_light_where_it_comes_from, scratch_make, scratch_remove),
    };
    return cmocka_run_group_tests_name("light_summary", tests, NULL, NULL);
}
