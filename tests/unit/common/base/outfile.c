/* outfile.c - output files appear complete or not at all: commits, full disks, signals, concurrent writers. */
#include "tests/unit/scratch.h"

#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include "common/base/outfile.h"
#include "common/base/parallel.h"

static void commit_creates_the_file(void **state)
{
    struct outfile f = {0};
    struct err err = ERR_INIT;
    struct stat info;
    const char *path = scratch_path("c/d/e.txt"), *folder = scratch_path("c/d");
    const mode_t old = umask(027);

    (void)state;
    assert_ok(outfile_open(&f, path, &err), err);
    assert_int_equal(access(path, F_OK), -1);
    const char *name = strrchr(f.temp, '/') + 1;
    assert_int_equal(strncmp(name, ".e.txt.", 7), 0);
    assert_string_equal(name + strlen(name) - 4, ".tmp");
    fputs("words", f.fp);
    assert_ok(outfile_commit(&f, &err), err);
    umask(old);
    assert_null(f.fp);
    assert_null(f.path);
    assert_file_text(path, "words");
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    outfile_discard(&f); /* does nothing */
    outfile_discard(&f);
    outfile_discard(NULL);
    assert_int_equal(count_entries(folder), 1);
}

static void a_library_may_write_by_name(void **state)
{
    struct outfile f = {0};
    struct err err = ERR_INIT;

    (void)state;
    assert_ok(outfile_open(&f, scratch_path("by-name"), &err), err);
    assert_int_equal(unlink(f.temp), 0); /* and replaces the file */
    FILE *fp = fopen(f.temp, "wb");
    assert_non_null(fp);
    fputs("library", fp);
    fclose(fp);
    assert_ok(outfile_commit(&f, &err), err);
    assert_file_text(scratch_path("by-name"), "library");
}

static void discard_keeps_the_older_file(void **state)
{
    struct outfile f = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path("keep/old");

    (void)state;
    assert_ok(outfile_make_folders(scratch_path("keep"), &err), err);
    scratch_write("keep/old", "old");
    assert_ok(outfile_open(&f, path, &err), err);
    fputs("new", f.fp);
    outfile_discard(&f);
    assert_file_text(path, "old");
    assert_int_equal(count_entries(scratch_path("keep")), 1);
}

static void invalid_paths_are_refused(void **state)
{
    struct outfile f = {0};
    struct err null = ERR_INIT, folder = ERR_INIT, below = ERR_INIT, none = ERR_INIT;
    char name[300];

    (void)state;
    assert_int_equal(outfile_open(&f, "/dev/null", &null), ST_IO);
    assert_err(null, ST_IO, "not a regular file");
    assert_int_equal(outfile_open(&f, scratch, &folder), ST_IO);
    assert_err(folder, ST_IO, "not a regular file");
    scratch_write("file", "");
    assert_int_equal(outfile_open(&f, scratch_path("file/below"), &below), ST_IO);
    assert_err(below, ST_IO, "cannot make the folder");
    assert_null(f.fp);
    assert_int_equal(outfile_commit(&f, &none), ST_INTERNAL);

    /* a name of maximum length works, although the temporary name is cut */
    struct err err = ERR_INIT;
    memset(name, 'n', 255);
    name[255] = '\0';
    const char *path = scratch_path(name);
    assert_ok(outfile_open(&f, path, &err), err);
    assert_ok(outfile_commit(&f, &err), err);
    assert_int_equal(unlink(path), 0);
}

static void missing_folders_are_made(void **state)
{
    struct err err = ERR_INIT, blocked = ERR_INIT;

    (void)state;
    assert_ok(outfile_make_folders(scratch_path("m/n//o/"), &err), err);
    assert_ok(outfile_make_folders(scratch_path("m/n/o"), &err), err);
    assert_int_equal(access(scratch_path("m/n/o"), X_OK), 0);
    assert_ok(outfile_make_folders("/", &err), err);
    assert_ok(outfile_make_folders(".", &err), err);
    scratch_write("m/file", "");
    assert_int_equal(outfile_make_folders(scratch_path("m/file"), &blocked), ST_IO);
    assert_err(blocked, ST_IO, "cannot make the folder");
}

/* ----------------------------------------------------------------------------------------------------- full disks */

/* Writes a megabyte over an older product where there is less space; returns 0 if all checks pass. */
static int write_too_much(const char *path, const char *reason)
{
    static char block[1 << 16];
    struct outfile f = {0};
    struct err err = ERR_INIT;

    if (outfile_open(&f, path, &err)) return 2;
    for (int i = 0; i < 16; i++) fwrite(block, 1, sizeof block, f.fp);
    if (outfile_commit(&f, &err) != ST_IO) return 3;
    printf("%s\n", err.text);
    if (f.fp || f.temp || !strstr(err.text, path) || (!strstr(err.text, reason) && !strstr(err.text, "may be full")))
        return 4;
    return 0;
}

static int over_the_file_limit(void *ctx)
{
    const struct rlimit limit = {100000, 100000};

    signal(SIGXFSZ, SIG_IGN);
    if (setrlimit(RLIMIT_FSIZE, &limit)) return 1;
    return write_too_much(ctx, "File too large");
}

static void a_file_size_limit_is_an_error(void **state)
{
    struct err err = ERR_INIT;
    char *output;

    (void)state;
    assert_ok(outfile_make_folders(scratch_path("limit"), &err), err);
    char *path = strdup(scratch_write("limit/old", "old"));
    const int code = child_run(over_the_file_limit, path, &output);
    if (code) fail_msg("exit %d: %s", code, output);
    assert_file_text(path, "old");
    assert_int_equal(count_entries(scratch_path("limit")), 1);
    free(path);
    free(output);
}

enum { CANNOT_MOUNT = 77 };

static int on_a_full_disk(void *ctx)
{
    char path[PATH_MAX];
    FILE *fp;

    if (unshare(CLONE_NEWNS) || mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) ||
        mount("tmpfs", ctx, "tmpfs", 0, "size=128k"))
        return CANNOT_MOUNT;
    snprintf(path, sizeof path, "%s/old", (const char *)ctx);
    if (!(fp = fopen(path, "w")) || fputs("old", fp) < 0 || fclose(fp)) return 1;
    const int code = write_too_much(path, "No space left on device");
    char *text = scratch_read(path);
    const int kept = !strcmp(text, "old") && count_entries(ctx) == 1;
    free(text);
    return code ? code : kept ? 0 : 5;
}

static void a_full_disk_is_an_error(void **state)
{
    struct err err = ERR_INIT;
    char *output;

    (void)state;
    assert_ok(outfile_make_folders(scratch_path("disk"), &err), err);
    char *folder = strdup(scratch_path("disk"));
    const int code = child_run(on_a_full_disk, folder, &output);
    free(folder);
    if (code == CANNOT_MOUNT) {
        free(output);
        print_message("a small tmpfs cannot be mounted here\n");
        skip();
    }
    if (code) fail_msg("exit %d: %s", code, output);
    free(output);
}

/* ----------------------------------------------------------------------------------------------- exits and signals */

struct writer {
    char *path;
    int tell[2];
    bool exits;
};

static int write_half(void *ctx)
{
    const struct writer *w = ctx;
    static struct outfile f; /* reachable at exit, so not a leak */
    struct err err = ERR_INIT;

    if (outfile_open(&f, w->path, &err)) return 1;
    fputs("half", f.fp);
    fflush(f.fp);
    if (write(w->tell[1], "x", 1) != 1) return 1;
    if (w->exits) {
        /* the exit of a forked child removes nothing of its parent's */
        const pid_t pid = fork();
        if (!pid) exit(0);
        waitpid(pid, NULL, 0);
        return access(f.temp, F_OK) ? 2 : 3; /* 3; then the exit removes the file */
    }
    for (;;) pause();
}

/* Starts a writer, ends it by `sig` (0: it exits), and returns the number of files left in its folder. */
static int left_behind(const char *folder, int sig, int *code)
{
    struct writer w = {.exits = sig == 0};
    struct err err = ERR_INIT;
    char path[PATH_MAX], byte;

    assert_ok(outfile_make_folders(scratch_path(folder), &err), err);
    snprintf(path, sizeof path, "%s/%s/product", scratch, folder);
    w.path = path;
    assert_int_equal(pipe(w.tell), 0);
    const pid_t pid = child_start(write_half, &w);
    close(w.tell[1]);
    assert_int_equal(read(w.tell[0], &byte, 1), 1);
    close(w.tell[0]);
    if (sig) kill(pid, sig);
    *code = child_wait(pid);
    assert_int_equal(access(path, F_OK), -1);
    return count_entries(scratch_path(folder));
}

static void exits_and_signals_remove_temporary_files(void **state)
{
    static const int polite[] = {SIGINT, SIGTERM, SIGHUP, SIGABRT};
    int code;

    (void)state;
    assert_int_equal(left_behind("exit", 0, &code), 0);
    assert_int_equal(code, 3);
    for (size_t i = 0; i < sizeof polite / sizeof *polite; i++) {
        char folder[32];
        snprintf(folder, sizeof folder, "signal%d", polite[i]);
        assert_int_equal(left_behind(folder, polite[i], &code), 0);
        assert_int_equal(code, 128 + polite[i]); /* the signal ended it */
    }
    assert_int_equal(left_behind("kill", SIGKILL, &code), 1); /* a dot file, which is no product */
    assert_int_equal(code, 128 + SIGKILL);
}

/* --------------------------------------------------------------------------------------------- concurrent writers */

static void write_many(void *ctx, size_t begin, size_t end, int thread)
{
    int *failed = ctx;

    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct outfile f = {0};
        struct err err = ERR_INIT;
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%s/many/%zu", scratch, i % 10); /* ten names, so that several writers share one */
        if (outfile_open(&f, path, &err)) {
            failed[i] = 1;
            continue;
        }
        for (int k = 0; k < 2000; k++) fprintf(f.fp, "%zu\n", i);
        if (i % 3 == 0)
            outfile_discard(&f);
        else
            failed[i] = outfile_commit(&f, &err) != ST_OK;
    }
}

static void concurrent_writers_do_not_mix(void **state)
{
    int failed[200] = {0};

    (void)state;
    parallel_set_threads(8);
    parallel_for(200, 1, write_many, failed);
    parallel_set_threads(0);
    for (int i = 0; i < 200; i++)
        if (failed[i]) fail_msg("writer %d failed", i);
    assert_int_equal(count_entries(scratch_path("many")), 10);
    for (int i = 0; i < 10; i++) { /* each product is complete and by a single writer */
        char name[32];
        snprintf(name, sizeof name, "many/%d", i);
        FILE *fp = fopen(scratch_path(name), "r");
        int writer, first = -1, lines = 0;
        assert_non_null(fp);
        while (fscanf(fp, "%d", &writer) == 1) {
            if (first < 0) first = writer;
            assert_int_equal(writer, first);
            lines++;
        }
        fclose(fp);
        assert_int_equal(lines, 2000);
        assert_int_equal(first % 10, i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commit_creates_the_file),       cmocka_unit_test(a_library_may_write_by_name),
        cmocka_unit_test(discard_keeps_the_older_file),  cmocka_unit_test(invalid_paths_are_refused),
        cmocka_unit_test(missing_folders_are_made),      cmocka_unit_test(a_file_size_limit_is_an_error),
        cmocka_unit_test(a_full_disk_is_an_error),       cmocka_unit_test(exits_and_signals_remove_temporary_files),
        cmocka_unit_test(concurrent_writers_do_not_mix),
    };

    return cmocka_run_group_tests_name("outfile", tests, scratch_make, scratch_remove);
}
