/* err.h - statuses, and errors as complete sentences.
 *
 * A function that can fail returns `enum status` (0 is good) and takes `struct err *` last; callers chain with ||.
 * Library code never prints and never exits: it fills the error, and the stage's main reports it once. The first
 * error set is the one kept; err_context() puts words in front of it. */
#ifndef REMODEL_ERR_H
#define REMODEL_ERR_H

#include <stddef.h>

#include "common/base/log.h"

enum status {
    ST_OK = 0,
    ST_USAGE,    /* wrong command line or configuration: exit 2 */
    ST_IO,       /* the system said no: open, read, write, spawn */
    ST_DATA,     /* bytes that cannot be used as what they claim to be */
    ST_NOMEM,    /* no memory */
    ST_INTERNAL, /* a broken promise of this program or of a library */
};

struct err {
    enum status status;
    char text[2048]; /* a sentence: file, place, what was found, what to do */
};

#define ERR_INIT  \
    {             \
        ST_OK, "" \
    }

/* Sets the error if none is set yet; returns `status` (of the error that is kept). err may be NULL. */
enum status err_set(struct err *err, enum status status, const char *fmt, ...) PRINTF_LIKE(3, 4);

/* ST_IO with strerror(errno): "cannot VERB PATH: REASON." */
enum status err_errno(struct err *err, const char *verb, const char *path);

/* ST_NOMEM: "not enough memory for WHAT (N bytes)." */
enum status err_nomem(struct err *err, const char *what, size_t bytes);

/* Puts "PREFIX: " in front of an error that is set; returns err->status. */
enum status err_context(struct err *err, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* Prints "STAGE: error: SENTENCE" on stderr (log_name() is the stage); nothing if no error is set. */
void err_report(const struct err *err);

/* 0 if no error, 2 for ST_USAGE, otherwise 1. */
int err_exit_code(const struct err *err);

#endif
