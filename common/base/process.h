/* process.h - runs other programs (COLMAP, ffmpeg). */
#ifndef REMODEL_PROCESS_H
#define REMODEL_PROCESS_H

#include <stdio.h>

#include "common/base/err.h"

/* Runs a program and waits for it. argv[0] is looked up in PATH; no shell is involved, so any file name is safe. env:
 * more environment variables, "NAME=VALUE", up to a NULL; or NULL. Standard output and error are appended to `log`
 * (NULL: inherited); standard input is empty. *code gets the exit status, or 128 + signal. ST_IO: the program is not in
 * PATH (the error names its package, if known) or cannot be started. The child is killed when this process ends. */
enum status process_run(const char *const argv[], const char *const env[], const char *log, int *code, struct err *err);

/* The same, and calls tick(ctx) about 20 times a second in the calling thread, and once after the program has ended.
 * tick NULL: no calls. The end may be noticed 50 ms late. */
enum status process_run_watched(const char *const argv[], const char *const env[], const char *log,
                                void (*tick)(void *ctx), void *ctx, int *code, struct err *err);

/* A running program that reads its standard input from this process (ffmpeg). {0} is the empty state. */
struct process {
    long pid;
    FILE *input;
};
enum status process_start(struct process *p, const char *const argv[], const char *log, struct err *err);
/* Closes the input and waits. If the program ends before it has read everything, writes fail without a SIGPIPE, and
 * *code is not 0 here. Does nothing on {0}. */
enum status process_finish(struct process *p, int *code, struct err *err);
/* Kills the program, if it is running, and waits for it. Does nothing on {0}. */
void process_kill(struct process *p);

#endif
