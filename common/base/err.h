/* err.h - status codes, and errors as complete sentences.
 *
 * A function that can fail takes `struct err *` last and returns its status (0: success). Library code never prints or
 * exits: it sets the error, and the stage's main reports it once. The first error wins: later ones are ignored.
 * err_context() puts text in front of it.
 *
 * Test err->status to decide whether to continue; keep no separate status variable:
 *
 *     if (!a_read(&a, path, err) && !b_make(&b, &a, err)) b_write(&b, out, err);
 *     for (int i = 0; !err->status && i < n; i++) c_add(&c, i, err);
 *     a_release(&a);
 *     return err->status;
 *
 * So a caller passes an error that is not set yet, and never NULL where the function reads `err->status`. Whoever goes
 * on after a failure, as a reader of optional files, uses a struct err of its own. */
#ifndef REMODEL_ERR_H
#define REMODEL_ERR_H

#include <stddef.h>

#include "common/base/log.h"

enum status {
    ST_OK = 0,
    ST_USAGE,    /* invalid command line or configuration; exit code 2 */
    ST_IO,       /* a system call failed: open, read, write, spawn */
    ST_DATA,     /* invalid input data */
    ST_NOMEM,    /* out of memory */
    ST_INTERNAL, /* a bug in this program or in a library */
};

struct err {
    enum status status;
    char text[2048]; /* a sentence: file, line, what was found, what to do */
};

#define ERR_INIT  \
    {             \
        ST_OK, "" \
    }

/* Sets the error unless one is already set. Returns the status of the error now set (`status` if err is NULL). */
enum status err_set(struct err *err, enum status status, const char *fmt, ...) PRINTF_LIKE(3, 4);

/* Sets ST_IO: "cannot VERB PATH: REASON.", the reason from errno. */
enum status err_errno(struct err *err, const char *verb, const char *path);

/* Sets ST_NOMEM: "not enough memory for WHAT (N bytes)." */
enum status err_nomem(struct err *err, const char *what, size_t bytes);

/* Puts "PREFIX: " in front of the error, if one is set. Returns its status. */
enum status err_context(struct err *err, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* Prints "STAGE: error: SENTENCE" on stderr (STAGE is log_name()) if an error is set. */
void err_report(const struct err *err);

#ifdef __clang_analyzer__
/* The static analyser reads one file at a time: this tells it that these set an error. */
static inline enum status err_is_set(const struct err *err)
{
    if (err && !err->status) __builtin_unreachable();
    return err ? err->status : ST_INTERNAL;
}
#define err_set(err, ...)   ((void)(err_set)(err, __VA_ARGS__), err_is_set(err))
#define err_errno(err, ...) ((void)(err_errno)(err, __VA_ARGS__), err_is_set(err))
#define err_nomem(err, ...) ((void)(err_nomem)(err, __VA_ARGS__), err_is_set(err))
#endif

/* 0 without an error, 2 for ST_USAGE, 1 for all others. */
int err_exit_code(const struct err *err);

#endif
