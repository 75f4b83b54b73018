/* scratch.h - shared by unit tests: a scratch folder with files, more assertions, child processes with their output. */
#ifndef REMODEL_TESTS_SCRATCH_H
#define REMODEL_TESTS_SCRATCH_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/err.h"
#include "tests/scratch_name.h"

static char scratch[256]; /* the folder */

static inline int scratch_make(void **state)
{
    (void)state;
    return scratch_name(scratch, sizeof scratch, "test") && mkdtemp(scratch) ? 0 : -1;
}

static inline int scratch_remove_one(const char *path, const struct stat *info, int type, struct FTW *at)
{
    (void)info, (void)type, (void)at;
    return remove(path);
}

static inline int scratch_remove(void **state)
{
    (void)state;
    return nftw(scratch, scratch_remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* "SCRATCH/NAME"; the last eight results stay valid. */
static inline const char *scratch_path(const char *name)
{
    static char paths[8][PATH_MAX];
    static int next;
    char *path = paths[next++ % 8];

    snprintf(path, PATH_MAX, "%s/%s", scratch, name);
    return path;
}

static inline const char *scratch_write_bytes(const char *name, const void *bytes, size_t size)
{
    const char *path = scratch_path(name);
    FILE *fp = fopen(path, "wb");

    assert_non_null(fp);
    assert_int_equal(fwrite(bytes, 1, size, fp), size);
    assert_int_equal(fclose(fp), 0);
    return path;
}

static inline const char *scratch_write(const char *name, const char *text)
{
    return scratch_write_bytes(name, text, strlen(text));
}

/* The text of a file, "(no file)" if it does not exist. The caller frees it. */
static inline char *scratch_read(const char *path)
{
    FILE *fp = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0;

    if (!fp) return strdup("(no file)");
    if (getdelim(&text, &size, '\0', fp) < 0) {
        free(text);
        text = strdup("");
    }
    fclose(fp);
    return text;
}

static inline void assert_file_text(const char *path, const char *wanted)
{
    char *text = scratch_read(path);

    assert_string_equal(text, wanted);
    free(text);
}

/* The number of entries of a folder, dot files included. */
static inline int count_entries(const char *folder)
{
    DIR *dir = opendir(folder);
    const struct dirent *e;
    int n = 0;

    assert_non_null(dir);
    while ((e = readdir(dir))) n += strcmp(e->d_name, ".") && strcmp(e->d_name, "..");
    closedir(dir);
    return n;
}

#define assert_contains(text, part)                                           \
    do {                                                                      \
        if (!strstr(text, part)) fail_msg("no \"%s\" in \"%s\"", part, text); \
    } while (0)

#define assert_lacks(text, part)                                          \
    do {                                                                  \
        if (strstr(text, part)) fail_msg("\"%s\" in \"%s\"", part, text); \
    } while (0)

/* The error has this status, contains `part`, and ends like a sentence. */
#define assert_err(err, wanted_status, part)                                                                 \
    do {                                                                                                     \
        if ((err).status != (wanted_status))                                                                 \
            fail_msg("status %d, wanted %d: %s", (err).status, (wanted_status), (err).text);                 \
        assert_contains((err).text, part);                                                                   \
        if (!strchr(".?", (err).text[strlen((err).text) - 1])) fail_msg("no full stop: \"%s\"", (err).text); \
    } while (0)

#define assert_ok(call, err)                                               \
    do {                                                                   \
        if ((call) != ST_OK) fail_msg("%s failed: %s", #call, (err).text); \
    } while (0)

/* A child does not look for leaks at its exit: it would wait for locks that threads of its parent had at its start. */
static int scratch_in_child;
#ifdef __SANITIZE_ADDRESS__
int __lsan_is_turned_off(void); /* the sanitizer asks this */
__attribute__((weak, used)) int __lsan_is_turned_off(void) { return scratch_in_child; }
#endif

/* Starts fn(ctx) in a child, which exits with its result. Its stdout and stderr go to the scratch file "output". */
static inline pid_t child_start(int (*fn)(void *ctx), void *ctx)
{
    const char *output = scratch_path("output");

    fflush(NULL);
    const pid_t pid = fork();
    if (!pid) {
        const int fd = open(output, O_WRONLY | O_CREAT | O_TRUNC, 0666);
        if (fd < 0 || dup2(fd, STDOUT_FILENO) < 0 || dup2(fd, STDERR_FILENO) < 0) _exit(99);
        scratch_in_child = 1;
        exit(fn(ctx));
    }
    return pid;
}

/* Waits for a child. Returns its exit code, or 128 + signal. */
static inline int child_wait(pid_t pid)
{
    int status = 0;

    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/* Runs fn(ctx) in a child. Returns its exit code, or 128 + signal if it was killed. *output gets what it printed; the
 * caller frees it. */
static inline int child_run(int (*fn)(void *ctx), void *ctx, char **output)
{
    const int code = child_wait(child_start(fn, ctx));

    *output = scratch_read(scratch_path("output"));
    return code;
}

#endif
