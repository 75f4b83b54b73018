/* Other programs: exit statuses, logs, strange arguments, pipes, and children that end with their parent. */
#include "tests/unit/scratch.h"

#include <errno.h>
#include <signal.h>
#include <time.h>

#include "common/base/process.h"

static void exit_statuses(void **state)
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
        assert_ok(process_run(argv, NULL, &code, &err), err);
        assert_int_equal(code, cases[i].code);
    }
}

static void arguments_pass_no_shell(void **state)
{
    const char *const argv[] = {"printf", "%s|", "a b", "$HOME", "`id`", "'", "\"", "*", "", "#;&", NULL};
    struct err err = ERR_INIT;
    int code;
    const char *log = scratch_write("log", "before\n");

    (void)state;
    assert_ok(process_run(argv, log, &code, &err), err);
    assert_int_equal(code, 0);
    assert_file_text(log, "before\na b|$HOME|`id`|'|\"|*||#;&|"); /* appended */
}

static void both_outputs_go_to_the_log_and_input_is_empty(void **state)
{
    const char *const argv[] = {"sh", "-c", "echo out; echo err >&2; cat; echo end", NULL};
    struct err err = ERR_INIT;
    int code;

    (void)state;
    assert_ok(process_run(argv, scratch_path("log2"), &code, &err), err);
    assert_file_text(scratch_path("log2"), "out\nerr\nend\n");
}

static void environment(void **state)
{
    const char *const argv[] = {"sh", "-c", "echo $REMODEL_A,$REMODEL_B,$REMODEL_AB", NULL};
    const char *const env[] = {"REMODEL_A=new", "REMODEL_B=b c", NULL};
    struct err err = ERR_INIT;
    int code;

    (void)state;
    setenv("REMODEL_A", "old", 1);
    setenv("REMODEL_AB", "kept", 1);
    assert_ok(process_run_env(argv, env, scratch_path("env"), &code, &err), err);
    assert_file_text(scratch_path("env"), "new,b c,kept\n");
    assert_string_equal(getenv("REMODEL_A"), "old");
}

static void missing_programs(void **state)
{
    const char *const colmap[] = {"colmap", NULL}, *const other[] = {"no-such-program", NULL},
                      *const path[] = {"./no-such-program", NULL};
    struct err e1 = ERR_INIT, e2 = ERR_INIT, e3 = ERR_INIT, e4 = ERR_INIT, e5 = ERR_INIT;
    struct process p;
    int code;
    char *old = strdup(getenv("PATH"));

    (void)state;
    setenv("PATH", scratch, 1);
    assert_int_equal(process_run(colmap, NULL, &code, &e1), ST_IO);
    assert_int_equal(process_run(other, NULL, &code, &e2), ST_IO);
    assert_int_equal(process_start(&p, other, NULL, &e3), ST_IO);
    assert_int_equal(process_finish(&p, &code, NULL), ST_OK); /* the empty state is harmless */
    process_kill(&p);
    assert_int_equal(process_run(path, NULL, &code, &e4), ST_IO);
    /* a file that may be run but is no program */
    assert_int_equal(chmod(scratch_write("garbage", "\x01\x02"), 0755), 0);
    const char *const garbage[] = {"garbage", NULL};
    assert_int_equal(process_run(garbage, NULL, &code, &e5), ST_IO);
    setenv("PATH", old, 1);
    free(old);
    assert_err(e1, ST_IO, "the program colmap is not in PATH; install Debian's package colmap.");
    assert_err(e2, ST_IO, "the program no-such-program is not in PATH");
    assert_err(e3, ST_IO, "no-such-program");
    assert_err(e4, ST_IO, "./no-such-program");
    assert_err(e5, ST_IO, "Exec format error");
}

static void a_log_that_cannot_be_written(void **state)
{
    const char *const argv[] = {"true", NULL};
    struct err err = ERR_INIT;
    int code;

    (void)state;
    assert_int_equal(process_run(argv, scratch_path("no/such/log"), &code, &err), ST_IO);
    assert_err(err, ST_IO, "cannot write");
}

static void pipes(void **state)
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

static void readers_that_end_early(void **state)
{
    static const struct {
        const char *script;
        int code;
    } cases[] = {{"exit 5", 5}, {"head -c 10 >/dev/null", 128 + SIGPIPE}};
    static char block[1 << 20]; /* more than a pipe holds */

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
    assert_true(now.sa_handler == SIG_DFL); /* as it was */
}

static void children_have_the_default_sigpipe(void **state)
{
    const char *const reader[] = {"cat", NULL}, *const argv[] = {"sh", "-c", "kill -PIPE $$; exit 0", NULL};
    struct process p = {0};
    struct err err = ERR_INIT;
    int code = -1;

    (void)state;
    assert_ok(process_start(&p, reader, NULL, &err), err); /* SIGPIPE is ignored here now */
    assert_ok(process_run(argv, NULL, &code, &err), err);
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
    const bool running = after && after[1] == ' ' && after[2] != 'Z'; /* a zombie waits only to be noticed */
    free(text);
    return running;
}

static int run_forever(void *ctx)
{
    const char *const argv[] = {"sh", "-c", "echo $$ > \"$0\"; exec sleep 100", ctx, NULL};
    struct err err = ERR_INIT;
    int code;

    return process_run(argv, NULL, &code, &err) != ST_OK;
}

static void children_end_with_their_parent(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exit_statuses),
        cmocka_unit_test(arguments_pass_no_shell),
        cmocka_unit_test(both_outputs_go_to_the_log_and_input_is_empty),
        cmocka_unit_test(environment),
        cmocka_unit_test(missing_programs),
        cmocka_unit_test(a_log_that_cannot_be_written),
        cmocka_unit_test(pipes),
        cmocka_unit_test(readers_that_end_early),
        cmocka_unit_test(children_have_the_default_sigpipe),
        cmocka_unit_test(children_end_with_their_parent),
    };

    return cmocka_run_group_tests_name("process", tests, scratch_make, scratch_remove);
}
