/* cli.c - the command line: a stage's own options and the common ones. */
#include "tests/unit/scratch.h"

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/version.h"

#define TRY_PARAMS(X)                                   \
    X(near_z, double, 1, 0, 100, "m", "nearest depth")  \
    X(far_z, double, 10, 0, 100, "m", "farthest depth") \
    X(planes, int, 16, 1, 64, "", "planes between the two")

struct try_params {
    TRY_PARAMS(PARAM_FIELD)
};
#define TRY_PARAMS_DEFAULT        \
    {                             \
        TRY_PARAMS(PARAM_DEFAULT) \
    }
#define PARAM_STRUCT struct try_params
static const struct param try_table[] = {TRY_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status check(const void *values, struct err *err)
{
    const struct try_params *p = values;

    if (p->near_z < p->far_z) return ST_OK;
    return err_set(err, ST_USAGE, "near_z = %g must be less than far_z = %g.", p->near_z, p->far_z);
}

enum { MAX_ARGS = 16 };

/* A stage's main that prints its options. */
static int stage_main(void *ctx)
{
    char **argv = ctx;
    const char *out = NULL, *view = "none";
    struct cli_list exclude = {0};
    int count = 3, argc = 0;
    bool fast = false;
    const char *planes = NULL;
    struct try_params params = TRY_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Tries the command line."),
        CLI_STR("out", &out, CLI_REQUIRED, "file to write"),
        CLI_STR("view", &view, CLI_OPTIONAL, "view to work on"),
        CLI_LIST("exclude", &exclude, CLI_OPTIONAL, "file to leave out"),
        CLI_INT("count", &count, CLI_OPTIONAL, "how many"),
        CLI_FLAG("fast", &fast, "be quick"),
        CLI_PARAM("planes", &planes, "planes, as an option of its own"),
        CLI_PARAMS(try_table, &params, check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    while (argv[argc]) argc++;
    const enum cli_verdict verdict = cli_parse(argc, argv, "try", opts, &prov, &err);
    if (verdict == CLI_RUN) {
        printf("out=%s view=%s count=%d fast=%d threads=%d", out, view, count, fast, parallel_threads());
        for (int i = 0; i < exclude.count; i++) printf(" exclude=%s", exclude.items[i]);
        printf("\n%s %s\n%s", prov.stage, prov.version, prov.params);
        fflush(stdout);
    }
    err_report(&err);
    cli_list_release(&exclude);
    provenance_release(&prov);
    return err_exit_code(&err);
}

/* Runs the stage with the arguments up to a NULL. Returns its exit code and its output. */
static int try_args(char **output, ...)
{
    const char *argv[MAX_ARGS] = {"try"};
    va_list args;
    int n = 1;

    va_start(args, output);
    while ((argv[n] = va_arg(args, const char *))) n++;
    va_end(args);
    return child_run(stage_main, argv, output);
}

#define assert_try(code, part, ...)                                                          \
    do {                                                                                     \
        char *output_;                                                                       \
        const int code_ = try_args(&output_, __VA_ARGS__, NULL);                             \
        if (code_ != (code)) fail_msg("exit %d in place of %d: %s", code_, (code), output_); \
        assert_contains(output_, part);                                                      \
        free(output_);                                                                       \
    } while (0)

static void options_are_parsed(void **state)
{
    (void)state;
    assert_try(0, "out=a b view=none count=3 fast=0", "--out", "a b");
    assert_try(0, "out=--x view= count=-4 fast=1 threads=2 exclude=a exclude=b", "--exclude", "a", "--out=--x",
               "--view=", "--count", "-4", "--exclude=b", "--fast", "--threads=7", "--threads", "2");
}

static void usage_errors_name_the_option(void **state)
{
    (void)state;
    assert_try(2, "try: error: --out is missing: file to write.", "--fast");
    assert_try(2, "unknown option \"ouy\"; did you mean --out?", "--ouy", "x");
    assert_try(2, "unknown option \"treads\"; did you mean --threads?", "--treads=2");
    assert_try(2, "unknown option \"qqqqqqqqqqq\"; --help lists them.", "--qqqqqqqqqqq=2");
    assert_try(2, "--out needs a value", "--out");
    assert_try(2, "--out needs a value", "--out", "--fast");
    assert_try(2, "--fast takes no value.", "--out=x", "--fast=yes");
    assert_try(2, "--out is given twice; keep one.", "--out=x", "--out=x");
    assert_try(2, "--count \"4x\": wanted an integer.", "--out=x", "--count=4x");
    assert_try(2, "--threads -1: wanted 0", "--out=x", "--threads=-1");
    assert_try(2, "--threads \"two\": wanted an integer.", "--out=x", "--threads=two");
    assert_try(2, "unexpected argument \"x\"", "x");
    assert_try(2, "unexpected argument \"-h\"", "-h");
    assert_try(2, "unexpected argument \"--\"", "--");
}

static void help_version_and_config_are_printed(void **state)
{
    char *output;

    (void)state;
    assert_int_equal(try_args(&output, "--help", NULL), 0);
    assert_contains(output, "usage: try [OPTION]...\nTries the command line.\n");
    assert_contains(output, "  --out TEXT           file to write (required)\n");
    assert_contains(output, "--exclude TEXT...");
    assert_contains(output, "(repeatable)");
    assert_contains(output, "--print-config");
    assert_contains(output, "--threads N");
    assert_contains(output, "section [try]");
    assert_contains(output, "default 10 m, from 0 to 100");
    assert_lacks(output, "MiB peak"); /* only with CLI_RUN */
    free(output);

    assert_int_equal(try_args(&output, "--version", NULL), 0);
    assert_string_equal(output, "remodel try " REMODEL_VERSION "\n");
    free(output);

    /* works without the required option */
    assert_int_equal(try_args(&output, "--print-config", "--set", "planes=3", NULL), 0);
    assert_string_equal(output, "[try]\nnear_z = 1\nfar_z = 10\nplanes = 3\n");
    free(output);
}

static int help_on_a_full_disk(void *ctx)
{
    const int fd = open("/dev/full", O_WRONLY);

    if (fd < 0 || dup2(fd, STDOUT_FILENO) < 0) return 99;
    return stage_main(ctx);
}

static void failing_standard_output_is_an_error(void **state)
{
    const char *argv[] = {"try", "--print-config", NULL};
    char *output;

    (void)state;
    assert_int_equal(child_run(help_on_a_full_disk, argv, &output), 1);
    assert_contains(output, "try: error: cannot write standard output: No space left on device.");
    free(output);
}

static void set_wins_over_config_files(void **state)
{
    char a[PATH_MAX], b[PATH_MAX], bad[PATH_MAX];

    (void)state;
    strcpy(a, scratch_write("a.cfg", "[try]\nplanes = 1\nfar_z = 50\n[other]\nx = 1\n"));
    strcpy(b, scratch_write("b.cfg", "[try]\nplanes = 2\n"));
    strcpy(bad, scratch_write("bad.cfg", "[try]\nplane = 2\n"));
    assert_try(0, "try " REMODEL_VERSION "\n[try]\nnear_z = 3\nfar_z = 50\nplanes = 2\n", "--set", "near_z=2",
               "--config", a, "--out=x", "--config", b, "--set=near_z=3");
    assert_try(0, "planes = 1\n", "--out=x", "--config", b, "--config", a);
    assert_try(0, "planes = 64\n", "--out=x", "--set=planes=64", "--config", a);
    assert_try(2, "near_z = 60 must be less than far_z = 50.", "--out=x", "--config", a, "--set=near_z=60");
    assert_try(2, "bad.cfg:2: unknown parameter \"plane\"; did you mean planes?", "--out=x", "--config", bad);
    assert_try(2, "cannot open", "--out=x", "--config=none.cfg");
    assert_try(2, "did you mean planes?", "--out=x", "--set=planse=3");
}

static void an_option_can_set_a_parameter(void **state)
{
    char a[PATH_MAX];

    (void)state;
    strcpy(a, scratch_write("planes.cfg", "[try]\nplanes = 5\n"));
    /* it wins over config files and --set in any order, and is one of the effective parameters */
    assert_try(0, "planes = 7\n", "--out=x", "--planes=7");
    assert_try(0, "planes = 7\n", "--planes", "7", "--set=planes=6", "--config", a, "--out=x");
    assert_try(0, "planes = 5\n", "--out=x", "--config", a);
    assert_try(0, "[try]\nnear_z = 1\nfar_z = 10\nplanes = 9\n", "--print-config", "--planes=9");
    /* and is checked like one */
    assert_try(2, "planes", "--out=x", "--planes=65");
    assert_try(2, "planes", "--out=x", "--planes=few");
    assert_try(2, "planes", "--out=x", "--planes=");
    assert_try(2, "--planes is given twice; keep one.", "--out=x", "--planes=7", "--planes=7");
    assert_try(2, "--planes needs a value", "--out=x", "--planes");
    assert_try(2, "did you mean --planes?", "--out=x", "--plane=7");

    char lengthy[2000] = "--planes=";
    memset(lengthy + 9, '1', sizeof lengthy - 10);
    assert_try(2, "--planes: the value is longer than 255 bytes", "--out=x", lengthy);
}

static void the_last_line_reports_resource_use(void **state)
{
    char *output;
    double wall, cpu;
    long peak;
    char newline;

    (void)state;
    assert_int_equal(try_args(&output, "--out=x", NULL), 0);
    const char *line = strstr(output, "try: used ");
    if (!line) fail_msg("no last line in \"%s\"", output);
    assert_int_equal(sscanf(line, "try: used %lf s wall, %lf s cpu, %ld MiB peak%c", &wall, &cpu, &peak, &newline), 4);
    assert_int_equal(newline, '\n');
    assert_int_equal(strchr(line, '\n')[1], '\0');
    assert_true(wall >= 0 && wall < 60 && cpu >= 0 && peak > 0);
    free(output);
}

static int forking_main(void *ctx)
{
    const struct cli_opt opts[] = {CLI_END};
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    if (cli_parse(1, ctx, "forking", opts, &prov, &err) != CLI_RUN) return 1;
    const pid_t pid = fork();
    if (!pid) exit(0);
    waitpid(pid, NULL, 0);
    provenance_release(&prov);
    return 0;
}

static void forked_children_print_no_report(void **state)
{
    const char *argv[] = {"forking", NULL};
    char *output;

    (void)state;
    assert_int_equal(child_run(forking_main, argv, &output), 0);
    const char *first = strstr(output, "forking: used ");
    if (!first || strstr(first + 1, "forking: used ")) fail_msg("not one last line: \"%s\"", output);
    free(output);
}

/* Fails for a name that begins with "bad". */
static enum status make_one(void *ctx, int i, struct err *err)
{
    const struct cli_list *names = ctx;
    if (!strncmp(names->items[i], "bad", 3)) return err_set(err, ST_IO, "%s cannot be made.", names->items[i]);
    log_note("at work on %s", names->items[i]);
    return ST_OK;
}

static int making_main(void *ctx)
{
    char **argv = ctx;
    struct cli_list names = {0};
    const struct cli_opt opts[] = {CLI_LIST("name", &names, CLI_REQUIRED, "what to make"), CLI_END};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    int argc = 0;
    while (argv[argc]) argc++;
    if (cli_parse(argc, argv, "making", opts, &prov, &err) == CLI_RUN) cli_make_each(&names, make_one, &names, &err);
    err_report(&err);
    cli_list_release(&names);
    provenance_release(&prov);
    return err_exit_code(&err);
}

static void one_piece_is_made_without_further_words(void **state)
{
    const char *good[] = {"making", "--name=a", NULL}, *bad[] = {"making", "--name=bad", NULL};
    char *output;
    (void)state;
    assert_int_equal(child_run(making_main, good, &output), 0);
    assert_ptr_equal(strstr(output, "making: at work on a\nmaking: used "), output);
    assert_null(strstr(output, "made"));
    free(output);
    assert_int_equal(child_run(making_main, bad, &output), 1);
    assert_ptr_equal(strstr(output, "making: error: bad cannot be made.\nmaking: used "), output);
    assert_null(strstr(output, "failed"));
    free(output);
}

static void of_several_pieces_each_has_its_own_end(void **state)
{
    const char *argv[] = {"making", "--name=a", "--name=bad", "--name=c", NULL};
    static const char *const parts[] = {"making: at work on a\nmaking: used ",
                                        "\nmaking: made 1 of 3: a\n",
                                        "making: error: bad cannot be made.\nmaking: used ",
                                        "\nmaking: failed 2 of 3: bad\n",
                                        "making: at work on c\nmaking: used ",
                                        "\nmaking: made 3 of 3: c\n",
                                        "making: error: 1 of 3 failed; the reasons are above.\n"};
    char *output;
    (void)state;
    assert_int_equal(child_run(making_main, argv, &output), 1);
    const char *at = output;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        at = strstr(at, parts[i]);
        if (!at) fail_msg("no \"%s\" in its place in \"%s\"", parts[i], output);
    }
    free(output);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_are_parsed),
        cmocka_unit_test(usage_errors_name_the_option),
        cmocka_unit_test(help_version_and_config_are_printed),
        cmocka_unit_test(failing_standard_output_is_an_error),
        cmocka_unit_test(set_wins_over_config_files),
        cmocka_unit_test(an_option_can_set_a_parameter),
        cmocka_unit_test(the_last_line_reports_resource_use),
        cmocka_unit_test(forked_children_print_no_report),
        cmocka_unit_test(one_piece_is_made_without_further_words),
        cmocka_unit_test(of_several_pieces_each_has_its_own_end),
    };

    return cmocka_run_group_tests_name("cli", tests, scratch_make, scratch_remove);
}
