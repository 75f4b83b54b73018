/* param.c - parameters are read, checked, printed and explained as declared. */
#include "tests/unit/scratch.h"

#include <locale.h>

#include "common/base/param.h"

#define SWEEP_PARAMS(X)                                              \
    X(planes, int, 128, 2, 4096, "", "planes, spaced evenly in 1/z") \
    X(gain, double, 1.0, -1, 10, "x", "photometric gain")            \
    X(metric, choice, "ad", 0, 0, "ad|census", "cost of a match")    \
    X(note, text, "", 0, 0, "", "free text")

struct sweep_params {
    SWEEP_PARAMS(PARAM_FIELD)
};
#define SWEEP_PARAMS_DEFAULT        \
    {                               \
        SWEEP_PARAMS(PARAM_DEFAULT) \
    }
#define PARAM_STRUCT struct sweep_params
static const struct param table[] = {SWEEP_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status read_text(struct sweep_params *p, const char *text, struct err *err)
{
    return params_read_file(table, p, "sweep", scratch_write("a.cfg", text), err);
}

static char *printed(const struct sweep_params *p)
{
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);

    assert_non_null(to);
    params_print(table, p, "sweep", to);
    fclose(to);
    return text;
}

static void the_section_of_the_stage_is_read(void **state)
{
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err err = ERR_INIT;

    (void)state;
    assert_ok(read_text(&p,
                        "\xef\xbb\xbf# comment\r\n[other]\nplanes = no number\nunknown = 1\n\n[sweep]\r\n"
                        "  planes=7\r\n\tgain = -0.25 ; with a comment\n; comment\nmetric : census\nnote = a # b = c\n"
                        "[other]\nplanes = 9\n[sweep]\n",
                        &err),
              err);
    assert_int_equal(p.planes, 7);
    assert_true(p.gain == -0.25);
    assert_string_equal(p.metric, "census");
    assert_string_equal(p.note, "a # b = c");
}

static void a_file_without_the_section_changes_nothing(void **state)
{
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err err = ERR_INIT;

    (void)state;
    assert_ok(read_text(&p, "[other]\nx = 1\n", &err), err);
    assert_ok(read_text(&p, "", &err), err);
    assert_int_equal(p.planes, 128);
}

static void invalid_files_are_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"[sweep]\nplaness = 3\n", "a.cfg:2: unknown parameter \"planess\"; did you mean planes?"},
        {"[sweep]\nzzzzzz = 3\n", "a.cfg:2: unknown parameter \"zzzzzz\"; --help lists them."},
        {"[sweep]\nplanes = 3\n\nplanes = 3\n", "a.cfg:4: planes is set twice, first in line 2"},
        {"[sweep]\nplanes = 1\n", "a.cfg:2: planes = \"1\", wanted an integer from 2 to 4096."},
        {"[sweep]\nplanes = 4097\n", "4096"},
        {"[sweep]\nplanes = 12x\n", "\"12x\""},
        {"[sweep]\nplanes = 12.5\n", "\"12.5\""},
        {"[sweep]\nplanes =\n", "\"\""},
        {"[sweep]\nplanes = 99999999999999999999\n", "integer"},
        {"[sweep]\n\ngain = 11\n", "a.cfg:3: gain = \"11\", wanted a number from -1 to 10 x."},
        {"[sweep]\ngain = nan\n", "\"nan\""},
        {"[sweep]\ngain = inf\n", "\"inf\""},
        {"[sweep]\ngain = 0,5\n", "\"0,5\""},
        {"[sweep]\ngain = 1 2\n", "\"1 2\""},
        {"[sweep]\nmetric = sad\n", "metric = \"sad\", wanted one of ad|census."},
        {"[sweep]\nmetric = ad|census\n", "one of"},
        {"[sweep]\nmetric =\n", "one of"},
        {"[sweep]\nplanes = 7\nwhat is this\n", "a.cfg:3: found \"what is this\", wanted [section], key = value"},
        {"[other\n", "a.cfg:1: found \"[other\""},
        {"planes = 3\n",
         "a.cfg:1: \"planes\" comes before the first [section]; move it below its stage's section, such as [sweep]."},
        {"[sweep]\nnote = a\033b\n", "a.cfg:2: note = \"a\\x1bb\""},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sweep_params p = SWEEP_PARAMS_DEFAULT;
        struct err err = ERR_INIT;
        assert_int_equal(read_text(&p, cases[i].text, &err), ST_USAGE);
        assert_err(err, ST_USAGE, cases[i].words);
    }
}

static void unusual_files_are_read(void **state)
{
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err none = ERR_INIT, nul = ERR_INIT, folder = ERR_INIT;

    (void)state;
    assert_int_equal(params_read_file(table, &p, "sweep", scratch_path("none.cfg"), &none), ST_USAGE);
    assert_err(none, ST_USAGE, "cannot open");
    assert_int_equal(params_read_file(table, &p, "sweep", scratch_write_bytes("nul.cfg", "[a]\n\0", 5), &nul),
                     ST_USAGE);
    assert_err(nul, ST_USAGE, "nul.cfg:2:");
    assert_int_equal(params_read_file(table, &p, "sweep", scratch, &folder), ST_USAGE);
    assert_err(folder, ST_USAGE, "Is a directory");
}

static void long_lines_are_read_or_refused(void **state)
{
    static char text[5000];
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err ok = ERR_INIT, long_value = ERR_INIT, long_line = ERR_INIT;

    (void)state;
    /* a comment of any length, and the longest possible value */
    const int n = sprintf(text, "#%02000d\n[sweep]\n", 0);
    sprintf(text + n, "note = %0255d\nplanes = 5\n", 7);
    assert_ok(read_text(&p, text, &ok), ok);
    assert_int_equal(strlen(p.note), 255);
    assert_int_equal(p.planes, 5);
    sprintf(text, "[sweep]\nnote = %0256d\n", 7);
    assert_int_equal(read_text(&p, text, &long_value), ST_USAGE);
    assert_err(long_value, ST_USAGE, "256 bytes, wanted at most 255");
    sprintf(text, "[sweep]\nplanes = 6\nnote = %01100d\n", 7);
    assert_int_equal(read_text(&p, text, &long_line), ST_USAGE);
    assert_err(long_line, ST_USAGE, "a.cfg:3: the line has 1107 bytes, wanted at most");
}

static void set_assigns_a_parameter(void **state)
{
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err err = ERR_INIT, e1 = ERR_INIT, e2 = ERR_INIT, e3 = ERR_INIT, e4 = ERR_INIT;

    (void)state;
    assert_ok(params_set(table, &p, "note=x=y", &err), err);
    assert_string_equal(p.note, "x=y");
    assert_ok(params_set(table, &p, "gain=-0", &err), err);
    assert_false(1 / p.gain < 0); /* -0 becomes 0 */
    assert_int_equal(params_set(table, &p, "planes", &e1), ST_USAGE);
    assert_err(e1, ST_USAGE, "--set \"planes\": wanted key=value.");
    assert_int_equal(params_set(table, &p, "plane=3", &e2), ST_USAGE);
    assert_err(e2, ST_USAGE, "did you mean planes?");
    assert_int_equal(params_set(table, &p, "planes=0", &e3), ST_USAGE);
    assert_err(e3, ST_USAGE, "--set planes = \"0\", wanted an integer from 2 to 4096.");
    assert_int_equal(params_set(table, &p, "note=a ; b", &e4), ST_USAGE);
    assert_err(e4, ST_USAGE, "wanted text without");
}

static void printed_parameters_read_back(void **state)
{
    struct sweep_params p = SWEEP_PARAMS_DEFAULT, q = SWEEP_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    char *text = printed(&p);

    (void)state;
    assert_string_equal(text, "[sweep]\nplanes = 128\ngain = 1\nmetric = ad\nnote =\n");
    free(text);
    p.planes = 3;
    p.gain = 1.0 / 3;
    strcpy(p.metric, "census");
    strcpy(p.note, "two words; [and] = more \"ones\"");
    text = printed(&p);
    assert_ok(read_text(&q, text, &err), err);
    assert_memory_equal(&p, &q, sizeof p);
    free(text);
}

static void numbers_ignore_the_locale(void **state)
{
    static const char *const commas[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"};
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    const char *set = NULL;

    (void)state;
    for (int i = 0; i < 3 && !set; i++) set = setlocale(LC_ALL, commas[i]);
    if (!set) {
        print_message("no locale with a decimal comma is installed here\n");
        skip();
    }
    assert_ok(params_set(table, &p, "gain=0.5", &err), err);
    char *text = printed(&p);
    setlocale(LC_ALL, "C");
    assert_true(p.gain == 0.5);
    assert_contains(text, "gain = 0.5\n");
    free(text);
}

static void help_lists_default_unit_and_range(void **state)
{
    const struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);

    (void)state;
    assert_non_null(to);
    params_help(table, &p, to);
    fclose(to);
    assert_contains(text, "planes, spaced evenly in 1/z\n");
    assert_contains(text, "default 128, from 2 to 4096\n");
    assert_contains(text, "default 1 x, from -1 to 10\n");
    assert_contains(text, "default \"ad\", one of ad|census\n");
    assert_contains(text, "default \"\"\n");
    free(text);
}

static void explained_parameters_read_back_as_the_defaults(void **state)
{
    struct sweep_params p = SWEEP_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);

    (void)state;
    assert_non_null(to);
    params_explain(table, &p, "sweep", to);
    fclose(to);
    assert_string_equal(text, "[sweep]\n# planes, spaced evenly in 1/z (from 2 to 4096)\nplanes = 128\n"
                              "# photometric gain (x, from -1 to 10)\ngain = 1\n"
                              "# cost of a match (one of ad|census)\nmetric = ad\n# free text\nnote =\n");
    p = (struct sweep_params){0};
    assert_ok(read_text(&p, text, &err), err);
    assert_int_equal(p.planes, 128);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_section_of_the_stage_is_read),
        cmocka_unit_test(a_file_without_the_section_changes_nothing),
        cmocka_unit_test(invalid_files_are_refused),
        cmocka_unit_test(unusual_files_are_read),
        cmocka_unit_test(long_lines_are_read_or_refused),
        cmocka_unit_test(set_assigns_a_parameter),
        cmocka_unit_test(printed_parameters_read_back),
        cmocka_unit_test(numbers_ignore_the_locale),
        cmocka_unit_test(help_lists_default_unit_and_range),
        cmocka_unit_test(explained_parameters_read_back_as_the_defaults),
    };

    return cmocka_run_group_tests_name("param", tests, scratch_make, scratch_remove);
}
