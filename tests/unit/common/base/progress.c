/* progress.c - plain lines in a log, one redrawn line on a terminal, any number of threads. */
#include "tests/unit/scratch.h"

#include <pty.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"

static void add_one(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    progress_add(ctx, (int64_t)(end - begin));
}

/* Pretends that the step started and was last drawn `seconds` ago. */
static void age(struct progress *p, double seconds)
{
    p->started -= seconds;
    p->drawn -= seconds;
}

static int in_a_log(void *ctx)
{
    struct progress p = {0};

    (void)ctx;
    log_set_name("sweep");
    progress_start(&p, "quick step", 10, "views");
    progress_add(&p, 10);
    progress_end(&p); /* too short for a line */
    progress_start(&p, "plane sweep", 1000, "planes");
    progress_add(&p, 1);   /* no line yet */
    age(&p, 1995);         /* ages leave room for delays on a busy machine */
    progress_add(&p, 199); /* prints a line: 200 in about 2000 s */
    progress_add(&p, 100); /* no line: too soon */
    parallel_set_threads(4);
    parallel_for(700, 1, add_one, &p);
    age(&p, 6000);
    progress_end(&p); /* the last line */
    progress_end(&p);
    const bool counted = atomic_load(&p.done) == 1000;
    progress_start(&p, "short step", 10, "views");
    progress_add(&p, 10);
    age(&p, 111);
    progress_end(&p);
    return p.terminal || !counted;
}

static void a_log_gets_plain_lines(void **state)
{
    char *output;

    (void)state;
    assert_int_equal(child_run(in_a_log, NULL, &output), 0);
    char *last = strstr(output, "sweep: short step 10/10 views, 0.0");
    assert_non_null(last);
    assert_contains(last, ", 1 min 5"); /* 51 s or a little more */
    *last = '\0';
    assert_string_equal(output, "sweep: plane sweep 200/1000 planes, 0.1 planes/s, 2 h 13 min left\n"
                                "sweep: plane sweep 1000/1000 planes, 0.125 planes/s, 2 h 13 min\n");
    free(output);
}

static void a_terminal_line_is_redrawn(void **state)
{
    char output[4096];
    size_t n = 0;
    ssize_t got;
    int master;

    (void)state;
    fflush(NULL);
    const pid_t pid = forkpty(&master, NULL, NULL, NULL);
    if (pid < 0) {
        print_message("no pseudo terminal can be had here\n");
        skip();
    }
    if (!pid) {
        struct progress p = {0};
        log_set_name("sweep");
        progress_start(&p, "step", 4, "views");
        age(&p, 5985);
        progress_add(&p, 1);
        log_note("a word");
        age(&p, 5985);
        progress_add(&p, 1);
        progress_end(&p);
        _exit(p.terminal ? 0 : 1);
    }
    while (n < sizeof output - 1 && (got = read(master, output + n, sizeof output - 1 - n)) > 0) n += (size_t)got;
    output[n] = '\0';
    assert_int_equal(child_wait(pid), 0);
    close(master);
    assert_string_equal(output, "\r\033[Ksweep: step 1/4 views, 0.000167 views/s, 4 h 59 min left"
                                "\r\033[Ksweep: a word\r\n"
                                "\r\033[Ksweep: step 2/4 views, 0.000167 views/s, 3 h 19 min left"
                                "\r\033[Ksweep: step 2/4 views, 0.000167 views/s, 3 h 19 min\r\n");
}

static void a_total_of_0_is_accepted(void **state)
{
    struct progress p = {0};

    (void)state;
    progress_end(&p); /* never started */
    progress_start(&p, "step", 0, "views");
    progress_add(&p, 5);
    progress_end(&p);
    assert_int_equal(atomic_load(&p.done), 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_log_gets_plain_lines),
        cmocka_unit_test(a_terminal_line_is_redrawn),
        cmocka_unit_test(a_total_of_0_is_accepted),
    };

    return cmocka_run_group_tests_name("progress", tests, scratch_make, scratch_remove);
}
