/* bracket_list.c - brackets.txt and exposures.txt: reading and errors. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/import_photos/bracket_list.h"
#include "stages/import_photos/exposure_list.h"

static void views_are_read_with_their_photos(void **state)
{
    struct bracket_list list;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(bracket_list_read(&list,
                                scratch_write("brackets.txt", "# two views\n\nhall a.jpg \"b c.jpg\" d.png\r\n"
                                                              "  room-2 e.jpg\n"),
                                &err),
              err);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.lines[0].view, "hall");
    assert_int_equal(list.lines[0].count, 3);
    assert_string_equal(list.lines[0].files[1], "b c.jpg");
    assert_int_equal(list.lines[0].line, 3);
    assert_string_equal(list.lines[1].files[0], "e.jpg");
    bracket_list_release(&list);
    bracket_list_release(&list);
    bracket_list_release(NULL);
}

static void errors_in_brackets_txt_name_the_line(void **state)
{
    static const char *const cases[][2] = {
        {"", "contains no view"},
        {"# nothing\n", "contains no view"},
        {"hall\n", ":1: found the end of the line, wanted the file name of a photo."},
        {"a x.jpg\nb\n", ":2: found the end"},
        {"a x.jpg\na y.jpg\n", ":2: found \"a\", wanted each view once (it is also in line 1)."},
        {"a x.jpg\n\nb y.jpg x.jpg\n", ":3: found \"x.jpg\", wanted each photo once (it is also in line 1)."},
        {"a x.jpg x.jpg\n", ":1: found \"x.jpg\", wanted each photo once"},
        {"-a x.jpg\n", "wanted a view's name of at most 100 letters"},
        {"a/b x.jpg\n", "wanted a view's name"},
        {"\"\" x.jpg\n", "wanted a view's name"},
        {"list x.jpg\n", "this one is reserved"},
        {"a \"x.jpg\n", "closing quote"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct bracket_list list;
        struct err err = ERR_INIT;
        const char *path = scratch_write("brackets.txt", cases[i][0]);
        assert_int_equal(bracket_list_read(&list, path, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i][1]);
        assert_contains(err.text, path);
        assert_null(list.lines);
    }
}

static void exposures_are_read_with_optional_numbers(void **state)
{
    struct exposure_list list;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(exposure_list_read(&list,
                                 scratch_write("exposures.txt", "# file seconds f-number iso factor\n"
                                                                "a.jpg 0.5\n\"b c.jpg\" 0.004 8 100\n"
                                                                "d.jpg 0.00025 8 100 1000\ne.jpg 2 0 0 4\n* 0 0 100\n"),
                                 &err),
              err);
    assert_int_equal(list.count, 5);
    const double values[] = {0.5, 0.004 * 100 / 64, 0.00025 * 100 / 64000, 0.5, 0};
    for (int i = 0; i < 5; i++) assert_true(fabs(exposure_value(&list.lines[i].exposure) - values[i]) <= 1e-15);
    assert_string_equal(list.lines[1].file, "b c.jpg");
    assert_int_equal(list.lines[3].line, 5);
    exposure_list_release(&list);
    exposure_list_release(&list);
    exposure_list_release(NULL);
    assert_true(fabs(exposure_value(&(struct exposure){0, 8, 100, 1}) - 0) <= 0);

    assert_ok(exposure_list_read(&list, scratch_write("exposures.txt", "# none\n"), &err), err);
    assert_int_equal(list.count, 0);
    exposure_list_release(&list);
}

static void errors_in_exposures_txt_name_the_line(void **state)
{
    static const char *const cases[][2] = {
        {"a.jpg\n", ":1: found the end of the line, wanted an exposure time in seconds"},
        {"a.jpg 1/60\n", ":1: found \"1/60\", wanted an exposure time in seconds"},
        {"a.jpg 0\n", "wanted an exposure time in seconds, a number from 1e-09"},
        {"a.jpg -1\n", "wanted an exposure time"},
        {"a.jpg nan\n", "wanted an exposure time"},
        {"a.jpg 1 8\n", "wanted an ISO value"},
        {"a.jpg 1 -8 100\n", "wanted an f-number"},
        {"a.jpg 1 8 100 0\n", "wanted a neutral density factor"},
        {"a.jpg 1 8 100 2 3\n", "wanted the end of the line"},
        {"a.jpg 1\nb.jpg 1\na.jpg 2\n", ":3: found \"a.jpg\", wanted each photo once (it is also in line 1)."},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct exposure_list list;
        struct err err = ERR_INIT;
        const char *path = scratch_write("exposures.txt", cases[i][0]);
        assert_int_equal(exposure_list_read(&list, path, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i][1]);
        assert_contains(err.text, path);
        assert_null(list.lines);
    }
    struct exposure_list list;
    struct err err = ERR_INIT;
    assert_int_equal(exposure_list_read(&list, scratch_path("no-such.txt"), &err), ST_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_read_with_their_photos),
        cmocka_unit_test(errors_in_brackets_txt_name_the_line),
        cmocka_unit_test(exposures_are_read_with_optional_numbers),
        cmocka_unit_test(errors_in_exposures_txt_name_the_line),
    };
    return cmocka_run_group_tests_name("bracket_list", tests, scratch_make, scratch_remove);
}
