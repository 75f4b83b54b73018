/* textfile.c - records, quotes, numbers, and errors with file and line. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <sys/resource.h>

#include "common/base/textfile.h"

static struct textfile opened(const char *text)
{
    struct textfile t;
    struct err err = ERR_INIT;

    assert_ok(textfile_open(&t, scratch_write("t.txt", text), &err), err);
    return t;
}

static void records_are_read(void **state)
{
    struct textfile t = opened("# head\r\n\n  \t\n  7 a -0.5 two  words \r\n#8\nlast");
    struct err err = ERR_INIT;
    int64_t id;
    double x;
    char *word, *rest;

    (void)state;
    assert_true(textfile_next(&t));
    assert_int_equal(t.line, 4);
    assert_ok(textfile_int(&t, "id", 0, 9, &id, &err), err);
    assert_ok(textfile_word(&t, "model", &word, &err), err);
    assert_ok(textfile_double(&t, "x", &x, &err), err);
    assert_true(textfile_more(&t));
    assert_ok(textfile_rest(&t, "name", &rest, &err), err);
    assert_false(textfile_more(&t));
    assert_ok(textfile_end(&t, &err), err);
    assert_true(id == 7 && x == -0.5);
    assert_string_equal(word, "a");
    assert_string_equal(rest, "two  words");
    assert_true(textfile_next(&t)); /* without a line break at the end */
    assert_int_equal(t.line, 6);
    assert_ok(textfile_word(&t, "w", &word, &err), err);
    assert_string_equal(word, "last");
    assert_ok(textfile_end(&t, &err), err);
    assert_false(textfile_next(&t));
    assert_false(textfile_next(&t));
    assert_false(textfile_more(&t));
    textfile_release(&t);
    textfile_release(&t);
    textfile_release(NULL);
}

static void a_byte_order_mark_is_skipped(void **state)
{
    struct textfile t = opened("\xEF\xBB\xBFhead 1\n\xEF\xBB\xBFlate\n");
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(textfile_expect_line(&t, "head", &err), err);
    assert_int_equal(t.line, 1);
    assert_int_equal(textfile_expect_line(&t, "late", &err), ST_DATA); /* only before the text */
    assert_err(err, ST_DATA, ":2: found \"\\ufefflate\", wanted a line \"late ...\"");
    textfile_release(&t);
    t = opened("\xEF\xBB\xBF");
    assert_false(textfile_next(&t));
    textfile_release(&t);
}

static void a_product_that_was_cut_off_is_refused(void **state)
{
    static const struct {
        const char *text, *words; /* NULL: it is read */
    } cases[] = {
        {"# remodel sfm_import 0.1.0\n# a = 1\n1 2 3\n", NULL},
        {"# remodel sfm_import 0.1.0\n# a = 1\n1 2 3", "t.txt:3: found the end of the file, wanted a line break"},
        {"remodel-photo 2\n# remodel import_photos 0.1.0\nfile a", "t.txt:3: found the end of the file"},
        {"# remodel import_pho", "t.txt:1: found the end of the file"},
        {"1 2 3", NULL},                                                          /* of people */
        {"# remodel suggest_model 0.1.0\nremodel-script 1\nset ceiling 2", NULL}, /* people go on with it */
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct textfile t;
        struct err err = ERR_INIT;
        const bool failed = textfile_open(&t, scratch_write("t.txt", cases[i].text), &err);
        assert_int_equal(failed, cases[i].words != NULL);
        if (failed) assert_non_null(strstr(err.text, cases[i].words));
        textfile_release(&t);
    }
}

static void utf_16_is_refused_by_name(void **state)
{
    static const char text[] = "\xFF\xFEh\0i\0";
    struct textfile t;
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(textfile_open(&t, scratch_write_bytes("u.txt", text, sizeof text - 1), &err), ST_DATA);
    assert_err(err, ST_DATA, "u.txt:1: found \"a byte order mark of UTF-16\", wanted UTF-8");
}

static void raw_lines_include_blanks_and_comments(void **state)
{
    struct textfile t = opened("a\n\n#c\n");

    (void)state;
    assert_true(textfile_next_raw(&t));
    assert_true(textfile_next_raw(&t));
    assert_false(textfile_more(&t));
    assert_int_equal(t.line, 2);
    assert_true(textfile_next_raw(&t));
    assert_true(textfile_more(&t));
    assert_false(textfile_next_raw(&t)); /* the last line break does not begin a line */
    textfile_release(&t);
    t = opened("");
    assert_false(textfile_next_raw(&t));
    textfile_release(&t);
}

static void invalid_lines_are_located(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "t.txt:1: found the end of the file, wanted an id."},
        {"x", "t.txt:1: found \"x\", wanted an id, an integer from 0 to 9."},
        {"10", "found \"10\", wanted an id, an integer from 0 to 9."},
        {"-1", "found \"-1\""},
        {"1.5", "found \"1.5\""},
        {"3", "found the end of the line, wanted a size."},
        {"3 nan", "found \"nan\", wanted a size, a finite number."},
        {"3 1e400", "found \"1e400\""},
        {"3 1,5", "found \"1,5\""},
        {"3 1 \"abc", "found the end of the line, wanted the closing quote of a name."},
        {"3 1 \"abc\\", "found \"\\\", wanted \\\" or \\\\ inside the quotes of a name."},
        {"3 1 \"a\\nc\"", "found \"\\nc\"\", wanted \\\" or"},
        {"3 1 \"a\"b", "found \"b\", wanted a blank after the closing quote of a name."},
        {"3 1 a more \033", "found \"more \\x1b\", wanted the end of the line."},
        {"3 1 a 0123456789012345678901234567890123456789more",
         "found \"0123456789012345678901234567890123456789\"..., wanted the end of the line."},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct textfile t = opened(cases[i].text);
        struct err err = ERR_INIT;
        int64_t id;
        double x;
        char *word;
        t.line = 1;
        textfile_next(&t);
        t.line = 1;
        const bool failed = textfile_int(&t, "an id", 0, 9, &id, &err) || textfile_double(&t, "a size", &x, &err) ||
                            textfile_word(&t, "a name", &word, &err) || textfile_end(&t, &err);
        if (!failed) fail_msg("\"%s\" was read", cases[i].text);
        assert_err(err, ST_DATA, cases[i].words);
        textfile_release(&t);
    }
}

static void numbers_stay_within_their_range(void **state)
{
    static const struct {
        const char *text, *words; /* NULL: it is read */
    } cases[] = {
        {"0 0", NULL},
        {"1 1e300", NULL},
        {"1.5 0", "t.txt:1: found \"1.5\", wanted a share, a number from 0 to 1."},
        {"-0.5 0", "found \"-0.5\", wanted a share, a number from 0 to 1."},
        {"nan 0", "found \"nan\", wanted a share, a number from 0 to 1."},
        {"0 -2", "found \"-2\", wanted a length, a number of at least 0."},
        {"0 inf", "found \"inf\", wanted a length, a number of at least 0."},
        {"0", "found the end of the line, wanted a length."},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct textfile t = opened(cases[i].text);
        struct err err = ERR_INIT;
        double x;
        assert_true(textfile_next(&t));
        const bool failed =
            textfile_number(&t, "a share", 0, 1, &x, &err) || textfile_number(&t, "a length", 0, INFINITY, &x, &err);
        assert_int_equal(failed, cases[i].words != NULL);
        if (failed) assert_err(err, ST_DATA, cases[i].words);
        textfile_release(&t);
    }
}

static void expected_words_lines_and_ends_are_checked(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"size 3 of 4\n# a comment\n", NULL},
        {"", "t.txt: found an empty file, wanted a line \"size ...\"."},
        {"sizes 3 of 4\n", "t.txt:1: found \"sizes\", wanted a line \"size ...\"."},
        {"size 3 off 4\n", "t.txt:1: found \"off\", wanted \"of\"."},
        {"size 3\n", "t.txt:1: found the end of the line, wanted \"of\"."},
        {"size 5 of 4\n", "t.txt:1: found \"5\", wanted no more than there are."},
        {"size 3 of 4\n\nsize 2 of 4 \n", "t.txt:3: found \"size 2 of 4\", wanted the end of the file."},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct textfile t = opened(cases[i].text);
        struct err err = ERR_INIT;
        double part = 0, all = 0;
        const bool failed = textfile_expect_line(&t, "size", &err) || textfile_double(&t, "a part", &part, &err) ||
                            textfile_expect(&t, "of", &err) || textfile_double(&t, "a whole", &all, &err) ||
                            (part > all && textfile_wrong_number(&t, part, "no more than there are", &err)) ||
                            textfile_end(&t, &err) || textfile_end_of_file(&t, &err);
        assert_int_equal(failed, cases[i].words != NULL);
        if (failed) assert_err(err, ST_DATA, cases[i].words);
        textfile_release(&t);
    }
}

static void quoted_words_read_back(void **state)
{
    static const char *const words[] = {"plain",     "",   "two words", "a\"b\\c",        "#1",
                                        "tab\there", "\"", "\\",        "\xc3\xa9\x01$'`"};
    char quoted[64], line[128];

    (void)state;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct err err = ERR_INIT;
        char *word;
        assert_ok(textfile_quote(words[i], quoted, sizeof quoted, &err), err);
        snprintf(line, sizeof line, "%s next\n", quoted);
        struct textfile t = opened(line);
        assert_true(textfile_next(&t));
        assert_ok(textfile_word(&t, "word", &word, &err), err);
        assert_string_equal(word, words[i]);
        assert_ok(textfile_word(&t, "word", &word, &err), err);
        assert_string_equal(word, "next");
        textfile_release(&t);
    }
    struct err line_break = ERR_INIT, room = ERR_INIT, ok = ERR_INIT;
    assert_int_equal(textfile_quote("a\nb", quoted, sizeof quoted, &line_break), ST_DATA);
    assert_err(line_break, ST_DATA, "the name \"a\\nb\" contains a line break");
    assert_ok(textfile_quote("a b", quoted, 6, &ok), ok); /* two quotes, three letters, NUL */
    assert_string_equal(quoted, "\"a b\"");
    assert_int_equal(textfile_quote("a b", quoted, 5, &room), ST_DATA);
    assert_err(room, ST_DATA, "longer than");
}

static void unreadable_files_are_errors(void **state)
{
    struct textfile t;
    struct err none = ERR_INIT, folder = ERR_INIT, nul = ERR_INIT;

    (void)state;
    assert_int_equal(textfile_open(&t, scratch_path("none"), &none), ST_IO);
    assert_err(none, ST_IO, "cannot open");
    assert_int_equal(textfile_open(&t, scratch, &folder), ST_IO);
    assert_err(folder, ST_IO, "Is a directory");
    assert_int_equal(textfile_open(&t, scratch_write_bytes("nul", "a\nb\0c\n", 6), &nul), ST_DATA);
    assert_err(nul, ST_DATA, "nul:2: found");
    assert_null(t.bytes);
}

static void pipes_are_read_to_the_end(void **state)
{
    struct textfile t;
    struct err err = ERR_INIT;
    int ends[2], lines = 0;
    char path[64];

    (void)state;
    assert_int_equal(pipe(ends), 0);
    fflush(NULL);
    const pid_t pid = fork();
    if (!pid) {
        FILE *fp = fdopen(ends[1], "w");
        for (int i = 0; i < 50000; i++) fprintf(fp, "%d\n", i); /* more than the first buffer */
        fclose(fp);
        _exit(0);
    }
    close(ends[1]);
    snprintf(path, sizeof path, "/proc/self/fd/%d", ends[0]);
    assert_ok(textfile_open(&t, path, &err), err);
    while (textfile_next(&t)) {
        int64_t i;
        assert_ok(textfile_int(&t, "i", lines, lines, &i, &err), err);
        lines++;
    }
    assert_int_equal(lines, 50000);
    assert_int_equal(child_wait(pid), 0);
    close(ends[0]);
    textfile_release(&t);
}

#ifndef __SANITIZE_ADDRESS__
enum { NO_LIMITS = 3 };

static int without_memory(void *ctx)
{
    const struct rlimit limit = {1u << 30, 1u << 30};
    struct rlimit kept;
    struct textfile t;
    struct err err = ERR_INIT;

    if (setrlimit(RLIMIT_AS, &limit) || getrlimit(RLIMIT_AS, &kept)) return 1;
    if (kept.rlim_cur != limit.rlim_cur) return NO_LIMITS;
    const enum status st = textfile_open(&t, ctx, &err);
    printf("%s", err.text);
    return st == ST_NOMEM && !t.path && !t.bytes ? 0 : 2;
}
#endif

static void a_file_too_large_for_memory_is_an_error(void **state)
{
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    print_message("the sanitizer needs more address space than this test leaves\n");
    skip();
#else
    char *output, *path = strdup(scratch_write("big", ""));
    assert_int_equal(truncate(path, (off_t)1 << 33), 0); /* sparse */
    const int code = child_run(without_memory, path, &output);
    if (code == NO_LIMITS) {
        print_message("the emulator sets no limit of memory\n");
        free(output);
        free(path);
        skip();
    }
    assert_int_equal(code, 0);
    assert_contains(output, "big: not enough memory for a file (8589934594 bytes).");
    free(output);
    free(path);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_are_read),
        cmocka_unit_test(a_byte_order_mark_is_skipped),
        cmocka_unit_test(utf_16_is_refused_by_name),
        cmocka_unit_test(a_product_that_was_cut_off_is_refused),
        cmocka_unit_test(raw_lines_include_blanks_and_comments),
        cmocka_unit_test(invalid_lines_are_located),
        cmocka_unit_test(numbers_stay_within_their_range),
        cmocka_unit_test(expected_words_lines_and_ends_are_checked),
        cmocka_unit_test(quoted_words_read_back),
        cmocka_unit_test(unreadable_files_are_errors),
        cmocka_unit_test(pipes_are_read_to_the_end),
        cmocka_unit_test(a_file_too_large_for_memory_is_an_error),
    };

    return cmocka_run_group_tests_name("textfile", tests, scratch_make, scratch_remove);
}
