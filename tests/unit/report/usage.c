/* usage.c - usage lines and warnings are read from logs; similar lines are not. */
#include "stages/report/usage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static bool parses(const char *line)
{
    struct usage u = {"untouched", -1, -1, -1};
    bool parsed = usage_parse(&u, line, strlen(line));
    if (!parsed) assert_string_equal(u.stage, "untouched");
    return parsed;
}

static void a_usage_line_is_parsed(void **state)
{
    struct usage u;
    const char *line = "segment_depth: used 12.50 s wall, 24.9 s cpu, 812 MiB peak";
    (void)state;
    assert_true(usage_parse(&u, line, strlen(line)));
    assert_string_equal(u.stage, "segment_depth");
    assert_float_equal(u.wall, 12.5, 1e-12);
    assert_float_equal(u.cpu, 24.9, 1e-12);
    assert_float_equal(u.mib, 812, 1e-12);
}

static void other_lines_are_refused(void **state)
{
    static const char *const LINES[] = {
        "",
        ": used 1 s wall, 1 s cpu, 1 MiB peak",
        "used 1 s wall, 1 s cpu, 1 MiB peak",
        "a b: used 1 s wall, 1 s cpu, 1 MiB peak",
        "<b>: used 1 s wall, 1 s cpu, 1 MiB peak",
        "a: used -1 s wall, 1 s cpu, 1 MiB peak",
        "a: used nan s wall, 1 s cpu, 1 MiB peak",
        "a: used 1 s wall, inf s cpu, 1 MiB peak",
        "a: used 1e400 s wall, 1 s cpu, 1 MiB peak",
        "a: used 1e13 s wall, 1 s cpu, 1 MiB peak",
        "a: used  1 s wall, 1 s cpu, 1 MiB peak",
        "a: used 1 s wall, 1 s cpu, 1 MiB peak.",
        "a: used 1 s wall, 1 s cpu, 1 MiB",
        "a: used 1 s wall, 1 s cpu",
        "a: used s wall, s cpu, MiB peak",
        "a: warning: b: used 1 s wall, 1 s cpu, 1 MiB peak",
    };
    char longest[400];
    struct usage u;
    (void)state;
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) assert_false(parses(LINES[i]));
    memset(longest, 'a', sizeof longest);
    snprintf(longest + 64, sizeof longest - 64, ": used 1 s wall, 1 s cpu, 1 MiB peak");
    assert_false(parses(longest)); /* a name of 64 letters */
    memset(longest, '1', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    assert_false(parses(longest));
    assert_false(usage_parse(&u, "a: used 1 s wall,\0 1 s cpu, 1 MiB peak", 38));
}

static void add(struct usage_table *t, const char *name, const char *text)
{
    struct err err = ERR_INIT;
    assert_int_equal(usage_add_log(t, name, text, strlen(text), &err), ST_OK);
}

static void runs_are_summed_and_the_largest_peak_kept(void **state)
{
    struct usage_table t = {0};
    (void)state;
    add(&t, "rectify.a.exr.log", "rectify: note\nrectify: used 1 s wall, 2 s cpu, 30 MiB peak\n");
    add(&t, "rectify.b.exr.log", "rectify: used 2 s wall, 3 s cpu, 20 MiB peak\r\n");
    add(&t, "rectify.c.exr.log", "rectify: error: no.");
    add(&t, "sfm.sfm.log",
        "rectify: used 100 s wall, 100 s cpu, 100 MiB peak\nsfm: used 5 s wall, 6 s cpu, 7 MiB peak");
    add(&t, "..log", "x: used 1 s wall, 1 s cpu, 1 MiB peak");
    assert_int_equal(t.stage_count, 2);
    assert_int_equal(t.stages[0].runs, 2);
    assert_int_equal(t.stages[0].unfinished, 1);
    assert_float_equal(t.stages[0].sum.wall, 3, 1e-12);
    assert_float_equal(t.stages[0].sum.cpu, 5, 1e-12);
    assert_float_equal(t.stages[0].sum.mib, 30, 1e-12);
    assert_float_equal(t.stages[1].sum.wall, 5, 1e-12); /* the last usage line counts */
    usage_table_release(&t);
    usage_table_release(&t);
    assert_int_equal(t.stage_count, 0);
}

static void warnings_are_collected_once(void **state)
{
    struct usage_table t = {0};
    char name[64], text[128], large[3000];
    (void)state;
    add(&t, "rectify.IMG_1.exr.log", "rectify: warning: dark <photo>\nnot a: warning: line\nrectify: warning\n");
    add(&t, "rectify.IMG_2.exr.log", "rectify: warning: dark <photo>\nrectify: warning: another\n");
    assert_int_equal(t.warning_count, 2);
    assert_string_equal(t.warnings[0].text, "dark <photo>");
    assert_string_equal(t.warnings[0].item, "IMG_1.exr");
    assert_int_equal(t.warnings[0].count, 2);
    for (int i = 0; i < 300; i++) {
        snprintf(name, sizeof name, "x.%d.log", i);
        snprintf(text, sizeof text, "x: warning: number %d\n", i);
        add(&t, name, text);
    }
    assert_int_equal(t.warning_count, 200);
    assert_int_equal(t.warnings_dropped, 102);
    usage_table_release(&t);

    memset(large, 'w', sizeof large - 1);
    large[sizeof large - 1] = 0;
    memcpy(large, "x: warning: ", 12);
    add(&t, "x.log", large);
    assert_int_equal(strlen(t.warnings[0].text), 1000);
    usage_table_release(&t);
}

static void a_missing_folder_adds_nothing(void **state)
{
    struct usage_table t = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(usage_add_folder(&t, "tests/unit/report/no-such-folder", NULL, &err), ST_OK);
    assert_int_equal(t.stage_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_usage_line_is_parsed),
        cmocka_unit_test(other_lines_are_refused),
        cmocka_unit_test(runs_are_summed_and_the_largest_peak_kept),
        cmocka_unit_test(warnings_are_collected_once),
        cmocka_unit_test(a_missing_folder_adds_nothing),
    };
    return cmocka_run_group_tests_name("usage", tests, NULL, NULL);
}
