/* process.c - exit codes, logs, unusual arguments, pipes, and children that are killed with their parent. */
#include "tests/unit/scratch.h"

#include <errno.h>
#include <signal.h>
#include <time.h>

#include "common/base/process.h"

static void exit_codes_and_signals_are_returned(void **state)
{
    static const struct {
        const char *script;
        int code;
    } cases[] = {{"exit 0", 0}, {"exit 3", 3}, {"kill -9 $$", 128 + SIGKILL}};

    (void)state;
    for (int i = 0; i < 3; i++) {
        const char *const argv[] = {"sh", "-c", cases[i].script, NULL};
        struct err err = ERR_INIT;
        int code = -1;
        assert_ok(process_run(argv, NULL, NULL, &code, &err), err);
        assert_int_equal(code, cases[i].code);
    }
}

static void arguments_bypass_the_shell(void **state)
{
    const char *const argv[] = {"printf", "%s|", "a b", "$HOME", "`id`", "'", "\"", "*", "", "#;&", NULL};
    struct err err = ERR_INIT;
    int code;
    const char *log = scratch_write("log", "before\n");

    (void)state;
    assert_ok(process_run(argv, NULL, log, &code, &err), err);
    assert_int_equal(code, 0);
    assert_file_text(log, "before\na b|$HOME|`id`|'|\"|*||#;&|"); /* appended */
}

static void both_outputs_go_to_the_log_and_input_is_empty(void **state)
{
    const char *const argv[] = {"sh", "-c", "echo out; echo err >&2; cat; echo end", NULL};
    struct err err = ERR_INIT;
    int code;

    (void)state;
    assert_ok(process_run(argv, NULL, scratch_path("log2"), &code, &err), err);
    assert_file_text(scratch_path("log2"), "out\nerr\nend\n");
}

static void environment_variables_are_added(void **state)
{
    const char *const argv[] = {"sh", "-c", "echo $REMODEL_A,$REMODEL_B,$REMODEL_AB", NULL};
    const char *const env[] = {"REMODEL_A=new", "REMODEL_B=b c", NULL};
    struct err err = ERR_INIT;
    int code;

    (void)state;
    setenv("REMODEL_A", "old", 1);
    setenv("REMODEL_AB", "kept", 1);
    assert_ok(process_run(argv, env, scratch_path("env"), &code, &err), err);
    assert_file_text(scratch_path("env"), "new,b c,kept\n");
    assert_string_equal(getenv("REMODEL_A"), "old");
}

static void missing_programs_name_their_package(void **state)
{
    const char *const colmap[] = {"colmap", NULL}, *const other[] = {"no-such-program", NULL},
                      *const path[] = {"./no-such-program", NULL};
    struct err e1 = ERR_INIT, e2 = ERR_INIT, e3 = ERR_INIT, e4 = ERR_INIT, e5 = ERR_INIT;
    struct process p;
    int code;
    char *old = strdup(getenv("PATH"));

    (void)state;
    setenv("PATH", scratch, 1);
    assert_int_equal(process_run(colmap, NULL, NULL, &code, &e1), ST_IO);
    assert_int_equal(process_run(other, NULL, NULL, &code, &e2), ST_IO);
    assert_int_equal(process_start(&p, other, NULL, &e3), ST_IO);
    assert_int_equal(process_finish(&p, &code, NULL), ST_OK); /* the empty state */
    process_kill(&p);
    assert_int_equal(process_run(path, NULL, NULL, &code, &e4), ST_IO);
    /* an executable file that is not a program */
    assert_int_equal(chmod(scratch_write("garbage", "\x01\x02"), 0755), 0);
    const char *const garbage[] = {"garbage", NULL};
    assert_int_equal(process_run(garbage, NULL, NULL, &code, &e5), ST_IO);
    setenv("PATH", old, 1);
    free(old);
    assert_err(e1, ST_IO, "the program colmap is not in PATH; install Debian's package colmap.");
    assert_err(e2, ST_IO, "the program no-such-program is not in PATH");
    assert_err(e3, ST_IO, "no-such-program");
    assert_err(e4, ST_IO, "./no-such-program");
    assert_err(e5, ST_IO, "Exec format error");
}

static void an_unwritable_log_is_an_error(void **state)
{
    const char *const argv[] = {"true", NULL};
    struct err err = ERR_INIT;
    int code;

    (void)state;
    assert_int_equal(process_run(argv, NULL, scratch_path("no/such/log"), &code, &err), ST_IO);
    assert_err(err, ST_IO, "cannot write");
}

static void input_is_piped_to_a_program(void **state)
{
    const char *const argv[] = {"wc", "-c", NULL};
    static char block[100000];
    struct process p = {0};
    struct err err = ERR_INIT;
    int code = -1;

    (void)state;
    assert_ok(process_start(&p, argv, scratch_path("count"), &err), err);
    for (int i = 0; i < 20; i++) assert_int_equal(fwrite(block, 1, sizeof block, p.input), sizeof block);
    assert_ok(process_finish(&p, &code, &err), err);
    assert_int_equal(code, 0);
    assert_file_text(scratch_path("count"), "2000000\n");
    assert_ok(process_finish(&p, &code, &err), err); /* idempotent */
}

static void a_reader_that_ends_early_is_a_failure(void **state)
{
    static const struct {
        const char *script;
        int code;
    } cases[] = {{"exit 5", 5}, {"head -c 10 >/dev/null", 128 + SIGPIPE}};
    static char block[1 << 20]; /* larger than a pipe's buffer */

    (void)state;
    for (int i = 0; i < 2; i++) {
        const char *const argv[] = {"sh", "-c", cases[i].script, NULL};
        struct process p = {0};
        struct err err = ERR_INIT;
        int code = -1;
        assert_ok(process_start(&p, argv, NULL, &err), err);
        for (int k = 0; k < 4; k++) fwrite(block, 1, sizeof block, p.input);
        assert_ok(process_finish(&p, &code, &err), err);
        assert_int_equal(code, cases[i].code);
    }
    struct sigaction now;
    sigaction(SIGPIPE, NULL, &now);
    assert_true(now.sa_handler == SIG_DFL); /* restored */
}

static void children_have_the_default_sigpipe(void **state)
{
    const char *const reader[] = {"cat", NULL}, *const argv[] = {"sh", "-c", "kill -PIPE $$; exit 0", NULL};
    struct process p = {0};
    struct err err = ERR_INIT;
    int code = -1;

    (void)state;
    assert_ok(process_start(&p, reader, NULL, &err), err); /* now SIGPIPE is ignored here */
    assert_ok(process_run(argv, NULL, NULL, &code, &err), err);
    assert_int_equal(code, 128 + SIGPIPE);
    process_kill(&p);
    process_kill(&p);
    assert_int_equal(p.pid, 0);
}

static bool runs(pid_t pid)
{
    char path[64], *text;

    snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
    text = scratch_read(path);
    const char *after = strrchr(text, ')');
    const bool running = after && after[1] == ' ' && after[2] != 'Z'; /* a zombie has ended */
    free(text);
    return running;
}

static int run_forever(void *ctx)
{
    const char *const argv[] = {"sh", "-c", "echo $$ > \"$0\"; exec sleep 100", ctx, NULL};
    struct err err = ERR_INIT;
    int code;

    return process_run(argv, NULL, NULL, &code, &err) != ST_OK;
}

static void children_are_killed_with_their_parent(void **state)
{
    static const int signals[] = {SIGTERM, SIGKILL};
    const struct timespec tick = {0, 10000000};

    (void)state;
    for (int s = 0; s < 2; s++) {
        char *path = strdup(scratch_path(s ? "pid1" : "pid0"));
        const pid_t parent = child_start(run_forever, path);
        pid_t child = 0;
        for (int i = 0; i < 1000 && child <= 0; i++) {
            char *text = scratch_read(path);
            if (strchr(text, '\n')) child = atoi(text);
            free(text);
            nanosleep(&tick, NULL);
        }
        assert_true(child > 0);
        assert_true(runs(child));
        kill(parent, signals[s]);
        assert_int_equal(child_wait(parent), 128 + signals[s]);
        for (int i = 0; i < 1000 && runs(child); i++) nanosleep(&tick, NULL);
        assert_false(runs(child));
        free(path);
    }
}

static void count_ticks(void *ctx) { ++*(int *)ctx; }

static void a_watched_program_is_watched_until_it_ends(void **state)
{
    (void)state;
    static const char *const argv[] = {"sh", "-c", "sleep 0.2; exit 3", NULL};
    struct err err = ERR_INIT;
    int code = 0, ticks = 0;
    assert_int_equal(process_run_watched(argv, NULL, NULL, count_ticks, &ticks, &code, &err), ST_OK);
    assert_int_equal(code, 3);
    assert_true(ticks >= 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_watched_program_is_watched_until_it_ends),
        cmocka_unit_test(exit_codes_and_signals_are_returned),
        cmocka_unit_test(arguments_bypass_the_shell),
        cmocka_unit_test(both_outputs_go_to_the_log_and_input_is_empty),
        cmocka_unit_test(environment_variables_are_added),
        cmocka_unit_test(missing_programs_name_their_package),
        cmocka_unit_test(an_unwritable_log_is_an_error),
        cmocka_unit_test(input_is_piped_to_a_program),
        cmocka_unit_test(a_reader_that_ends_early_is_a_failure),
        cmocka_unit_test(children_have_the_default_sigpipe),
        cmocka_unit_test(children_are_killed_with_their_parent),
    };

    return cmocka_run_group_tests_name("process", tests, scratch_make, scratch_remove);
}
