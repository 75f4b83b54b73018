/* err.c - errors, log lines, parsing of numbers, quoting, hashes. */
#include "tests/unit/scratch.h"

#include <errno.h>

#include "common/base/hash.h"
#include "common/base/log.h"
#include "common/base/scan.h"

static void the_first_error_is_kept(void **state)
{
    struct err err = ERR_INIT;

    (void)state;
    assert_int_equal(err_exit_code(&err), 0);
    assert_int_equal(err_context(&err, "nothing"), ST_OK);
    assert_string_equal(err.text, "");
    assert_int_equal(err_set(&err, ST_DATA, "a is %d.", 3), ST_DATA);
    assert_int_equal(err_set(&err, ST_USAGE, "later."), ST_DATA);
    assert_int_equal(err_context(&err, "%s", "views/a.exr"), ST_DATA);
    assert_string_equal(err.text, "views/a.exr: a is 3.");
    assert_int_equal(err_exit_code(&err), 1);
    assert_int_equal(err_set(NULL, ST_IO, "nobody listens."), ST_IO);
    assert_int_equal(err_exit_code(&(struct err){ST_USAGE, "x"}), 2);
}

static void errors_are_sentences(void **state)
{
    struct err io = ERR_INIT, memory = ERR_INIT;

    (void)state;
    errno = ENOENT;
    assert_int_equal(err_errno(&io, "open", "a b.txt"), ST_IO);
    assert_string_equal(io.text, "cannot open a b.txt: No such file or directory.");
    assert_int_equal(err_nomem(&memory, "a mask", 12), ST_NOMEM);
    assert_string_equal(memory.text, "not enough memory for a mask (12 bytes).");
}

static void truncated_text_ends_in_dots(void **state)
{
    static char long_text[5000];
    struct err err = ERR_INIT;

    (void)state;
    memset(long_text, 'x', sizeof long_text - 1);
    err_set(&err, ST_IO, "%s", long_text);
    assert_int_equal(strlen(err.text), sizeof err.text - 1);
    assert_string_equal(err.text + sizeof err.text - 4, "...");
    err_context(&err, "in front");
    assert_int_equal(strncmp(err.text, "in front: xxx", 13), 0);
    assert_string_equal(err.text + sizeof err.text - 4, "...");
    err_context(&err, "%s", long_text);
    assert_int_equal(strlen(err.text), sizeof err.text - 1);
}

static int talk(void *ctx)
{
    struct err err = ERR_INIT;

    (void)ctx;
    err_report(&err); /* nothing */
    log_note("before");
    log_set_name("rectify");
    log_note("%d views", 3);
    log_warn("view %s is dark", "a");
    err_set(&err, ST_IO, "no disk.");
    err_report(&err);
    return err_exit_code(&err);
}

static void log_lines_begin_with_the_stage(void **state)
{
    char *output;

    (void)state;
    assert_int_equal(child_run(talk, NULL, &output), 1);
    assert_string_equal(output, "remodel: before\nrectify: 3 views\nrectify: warning: view a is dark\n"
                                "rectify: error: no disk.\n");
    free(output);
}

static void numbers_are_parsed_strictly(void **state)
{
    static const char *const not_ints[] = {"",   "-", "+", " 1", "1 ", "1.0", "0x10", "1e3", "9223372036854775808",
                                           "--1"};
    static const char *const not_doubles[] = {"",      ".",  "-",  "nan", "inf", "1e999",
                                              "0x1p3", " 1", "1 ", "1,5", "1e",  "-infinity"};
    int64_t i = 7;
    double d = 7;

    (void)state;
    for (size_t k = 0; k < sizeof not_ints / sizeof *not_ints; k++)
        if (scan_int(not_ints[k], &i)) fail_msg("\"%s\" was read as an integer", not_ints[k]);
    for (size_t k = 0; k < sizeof not_doubles / sizeof *not_doubles; k++)
        if (scan_double(not_doubles[k], &d)) fail_msg("\"%s\" was read as a number", not_doubles[k]);
    assert_true(i == 7 && d == 7);
    assert_true(scan_int("-9223372036854775808", &i) && i == INT64_MIN);
    assert_true(scan_int("9223372036854775807", &i) && i == INT64_MAX);
    assert_true(scan_int("+007", &i) && i == 7);
    assert_true(scan_double("-.5e1", &d) && d == -5);
    assert_true(scan_double("5.", &d) && d == 5);
    assert_true(scan_double("1e-310", &d) && d > 0); /* subnormal */
    assert_true(scan_double("0.1", &d) && d == 0.1);
}

static void quoted_text_escapes_control_characters(void **state)
{
    char shown[SCAN_QUOTED];

    (void)state;
    assert_string_equal(scan_quote(shown, "a\tb\033[31m"), "\"a\\tb\\x1b[31m\"");
    assert_string_equal(scan_quote(shown, "1\xC2\xA0\xE2\x80\x8B\xEF\xBB\xBF\xC3\xA9"),
                        "\"1\\u00a0\\u200b\\ufeff\xC3\xA9\"");
    assert_string_equal(scan_quote(shown, "0123456789012345678901234567890123456789"),
                        "\"0123456789012345678901234567890123456789\"");
    assert_string_equal(scan_quote(shown, "01234567890123456789012345678901234567890"),
                        "\"0123456789012345678901234567890123456789\"...");
    /* 39 letters and a character of two bytes are 40 characters; the last one is kept whole */
    assert_string_equal(scan_quote(shown, "012345678901234567890123456789012345678\xc3\xa9x"),
                        "\"012345678901234567890123456789012345678\xc3\xa9\"...");
    static char controls[300];
    memset(controls, 1, sizeof controls - 1);
    assert_true(strlen(scan_quote(shown, controls)) < SCAN_QUOTED);
    memset(controls, 0x80, sizeof controls - 1);
    assert_true(strlen(scan_quote(shown, controls)) < SCAN_QUOTED);
}

static void files_are_hashed_with_xxh3(void **state)
{
    char hash[HASH_TEXT];
    struct err err = ERR_INIT, none = ERR_INIT, folder = ERR_INIT;
    static char megabytes[(1 << 21) + 5]; /* more than one block of the reader */

    (void)state;
    /* as printed by xxhsum -H2 */
    assert_ok(hash_file(hash, scratch_write("h", ""), &err), err);
    assert_string_equal(hash, "99aa06d3014798d86001c324468d497f");
    for (size_t i = 0; i < sizeof megabytes; i++) megabytes[i] = (char)(i * 7);
    assert_ok(hash_file(hash, scratch_write_bytes("h", megabytes, sizeof megabytes), &err), err);
    assert_string_equal(hash, "45c0512e8055d22e0a8c810c3b658f42");
    assert_int_equal(hash_file(hash, scratch_path("none"), &none), ST_IO);
    assert_err(none, ST_IO, "cannot open");
    assert_int_equal(hash_file(hash, scratch, &folder), ST_IO);
    assert_err(folder, ST_IO, "Is a directory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_error_is_kept),     cmocka_unit_test(errors_are_sentences),
        cmocka_unit_test(truncated_text_ends_in_dots), cmocka_unit_test(log_lines_begin_with_the_stage),
        cmocka_unit_test(numbers_are_parsed_strictly), cmocka_unit_test(quoted_text_escapes_control_characters),
        cmocka_unit_test(files_are_hashed_with_xxh3),
    };

    return cmocka_run_group_tests_name("err", tests, scratch_make, scratch_remove);
}
