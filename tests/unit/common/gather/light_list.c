/* light_list.c - lights.txt: what is read is what was written; damaged lines are refused with file and line. */
#include "common/gather/light_list.h"

#include <math.h>

#include "tests/unit/scratch.h"

#define HEAD "remodel-lights 1\n"
#define DISK "disk spot 1 2 3 0 0 -1 0.25 10 9 8 30 1.5\n"

static void lamps_and_openings_are_read(void **state)
{
    (void)state;
    struct light_list l;
    struct err err = ERR_INIT;
    assert_ok(
        light_list_read(&l,
                        scratch_write("lights.txt", HEAD
                                      "# a comment\n" DISK "quad panel 0 0 2.5 0.5 0 0 0 -0.25 0 16 15 14 90 0 bound\n"
                                      "opening window-1 0 1 1.5 0 0.5 0 0 0 0.75 reference lri_1 \"a b\"\n"
                                      "opening bare 0 1 1.5 0 0.5 0 0 0 0.75\n"),
                        NULL, &err),
        err);
    assert_int_equal(l.lamp_count, 2);
    assert_string_equal(l.lamps[0].name, "spot");
    assert_true(l.lamps[0].shape == LAMP_DISK && l.lamps[0].radius == 0.25 && !l.lamps[0].bound);
    assert_true(fabs(l.lamps[0].beta - acos(-1) / 6) < 1e-15 && l.lamps[0].exponent == 1.5);
    assert_true(fabs(vec3_length(l.lamps[0].x) - 0.25) < 1e-15 && fabs(vec3_length(l.lamps[0].y) - 0.25) < 1e-15);
    assert_true(fabs(vec3_cross(l.lamps[0].x, l.lamps[0].y).z + 0.0625) < 1e-15);
    assert_true(l.lamps[1].shape == LAMP_QUAD && l.lamps[1].bound && l.lamps[1].normal.z == -1);
    assert_true(l.lamps[1].beta == acos(0) && l.lamps[1].radiance.g == 15);
    assert_int_equal(l.opening_count, 2);
    assert_int_equal(l.openings[0].reference_count, 2);
    assert_string_equal(l.openings[0].references[1], "a b");
    assert_true(l.openings[0].normal.x == 1 && l.openings[1].reference_count == 0);
    light_list_release(&l);
    assert_null(l.lamps);
}

static bool same_vector(struct vec3 a, struct vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static void what_is_written_is_read_back(void **state)
{
    (void)state;
    const struct vec3 n = vec3_normalize(vec3_make(0.1, -0.2, -0.97));
    char *references[] = {(char *)"lri 1", (char *)"lri_2"};
    struct lamp lamps[] = {
        {.name = (char *)"a b",
         .shape = LAMP_DISK,
         .centre = {1.0 / 3, 2, 3},
         .normal = n,
         .radius = 0.1,
         .radiance = {260.1, 235, 195},
         .beta = 38 * acos(-1) / 180,
         .exponent = 1.0 / 3,
         .bound = true},
        {.name = (char *)"q", .shape = LAMP_QUAD, .x = {0.1, 0, 0.3}, .y = {0, -1.0 / 7, 0}, .beta = acos(0)}};
    struct daylight opening = {
        .name = (char *)"w", .x = {1, 0, 0}, .y = {0, 0, 2}, .references = references, .reference_count = 2};
    const struct light_list written = {lamps, &opening, 2, 1};
    struct light_list l;
    struct err err = ERR_INIT;
    assert_ok(light_list_write(&written, scratch_path("written.txt"), NULL, &err), err);
    assert_ok(light_list_read(&l, scratch_path("written.txt"), NULL, &err), err);
    assert_string_equal(l.lamps[0].name, "a b");
    assert_true(same_vector(l.lamps[0].centre, lamps[0].centre) && same_vector(l.lamps[0].normal, n));
    assert_true(l.lamps[0].radiance.r == 260.1 && l.lamps[0].exponent == 1.0 / 3 && l.lamps[0].bound);
    assert_true(fabs(l.lamps[0].beta - lamps[0].beta) < 1e-15);
    assert_true(same_vector(l.lamps[1].x, lamps[1].x) && same_vector(l.lamps[1].y, lamps[1].y) && !l.lamps[1].bound);
    assert_true(l.lamps[1].beta == acos(0));
    assert_string_equal(l.openings[0].references[0], "lri 1");
    assert_true(l.openings[0].normal.y == -1);
    light_list_release(&l);
}

static void damaged_lines_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *wanted;
    } cases[] = {
        {"remodel-plan 1\n", "remodel-lights"},
        {"remodel-lights 2\n", "version"},
        {HEAD "lamp a 0 0 0\n", "disk, quad or opening"},
        {HEAD DISK DISK, "a name that no line above has"},
        {HEAD DISK "opening spot 0 0 0 1 0 0 0 1 0\n", "a name that no line above has"},
        {HEAD "disk a 0 0 0 0 0 -2 0.1 1 1 1 30 0\n", "length 1"},
        {HEAD "disk a 0 0 0 0 0 0 0.1 1 1 1 30 0\n", "length 1"},
        {HEAD "disk a 0 0 0 0 0 -1 0 1 1 1 30 0\n", "a radius above 0"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 -1 1 30 0\n", "a radiance, a number from 0 to 1e+30"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 1 1 90.5 0\n", "in degrees, a number from 0 to 90"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 1 1 -1 0\n", "in degrees, a number from 0 to 90"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 1 1 30 -1\n", "the exponent, a number from 0"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 1 nan 30 0\n", "a radiance"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 1 1 30 0 bond\n", "bound"},
        {HEAD "disk a 0 0 0 0 0 -1 0.1 1 1 1 30 0 bound 3\n", "end of the line"},
        {HEAD "disk a 0 0 2e9 0 0 -1 0.1 1 1 1 30 0\n", "at most 1e9"},
        {HEAD "quad a 0 0 0 1 0 0 2 0 0 1 1 1 90 0\n", "two directions"},
        {HEAD "quad a 0 0 0 1 0 0 0 0 0 1 1 1 90 0\n", "two directions"},
        {HEAD "opening a 0 0 0 1 0 0 0 1\n", "second half edge"},
        {HEAD "opening a\rb 0 0 0 1 0 0 0 1 0\n", "without a line break"},
        {HEAD "opening a 0 0 0 1 0 0 0 1 0 reference\n", "lighting reference image"},
        {HEAD "opening a 0 0 0 1 0 0 0 1 0 lri_1\n", "reference"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct light_list l;
        struct err err = ERR_INIT;
        const char *path = scratch_write("bad.txt", cases[i].text);
        assert_int_equal(light_list_read(&l, path, NULL, &err), ST_DATA);
        assert_non_null(strstr(err.text, path));
        if (!strstr(err.text, cases[i].wanted)) fail_msg("case %zu says: %s", i, err.text);
        assert_null(l.lamps);
        assert_null(l.openings);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_and_openings_are_read),
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(damaged_lines_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
