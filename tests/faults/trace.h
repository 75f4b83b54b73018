/* trace.h - runs a program under ptrace(), counts the calls of the kernel that it makes after main() began, and makes
 * one of them fail, or kills the program there.
 *
 * Calls are seen where the kernel gets them, so that those inside the C library and in other libraries count as well.
 * Only files of interest count: not /proc, /sys, /dev, /etc, shared libraries, standard input, output and error. */
#ifndef REMODEL_FAULT_TRACE_H
#define REMODEL_FAULT_TRACE_H

#include <stdbool.h>
#include <stddef.h>

#include "tests/faults/page.h"

enum trace_call {
    CALL_NONE,
    CALL_OPEN,   /* for reading */
    CALL_CREATE, /* for writing */
    CALL_READ,
    CALL_WRITE,
    CALL_CLOSE,
    CALL_STAT,
    CALL_LIST, /* getdents64() */
    CALL_RENAME,
    CALL_FSYNC,
    CALL_MKDIR,
    CALL_COUNT,
};

/* What happens at a call. */
struct trace_fault {
    enum trace_call call;
    long at;        /* which of them, from 1 */
    int error;      /* errno that it returns */
    bool shorter;   /* or: a read or write of half the bytes */
    bool kill;      /* or: the program is killed */
    bool sticky;    /* all after it fail as well */
    bool temporary; /* only calls on files below the folder for temporary files count */
};

struct trace_run {
    char *const *argv;
    const char *folder;      /* to run it in */
    const char *shim;        /* the library that is loaded before all others */
    const char *errors;      /* file that standard error goes to */
    const char *temp;        /* folder for temporary files */
    struct fault_page *page; /* shared; fd is its file descriptor */
    int page_fd;
    int seconds; /* of computing, after which it is killed, or 15 times as long by the clock */
    struct trace_fault fault;
    /* called for each file that is opened for reading, if not NULL */
    void (*opened)(void *data, const char *path);
    void *data;
};

struct trace_result {
    long counts[CALL_COUNT];
    int code;       /* exit code, or -1 */
    int signal;     /* that ended it, or 0 */
    bool hung;      /* it was killed after the time was over */
    bool happened;  /* the fault */
    char path[512]; /* that it happened to */
    double seconds;
};

extern const char *const trace_call_names[CALL_COUNT];

/* False: it could not be traced; a message was printed. */
bool trace_program(struct trace_result *result, const struct trace_run *run);

#endif
