/* process.h - runs another program (COLMAP, ffmpeg) and waits for it. */
#ifndef REMODEL_PROCESS_H
#define REMODEL_PROCESS_H

#include <stdio.h>

#include "common/base/err.h"

/* argv[0] is looked up in PATH; no shell is involved, so any file name is safe. Standard output and error are appended
 * to `log` (NULL: inherited); standard input is empty. *code gets the exit status, or 128 + signal. A program that is
 * not there is ST_IO and says which package holds it when that is known. If this process is interrupted the child is
 * ended with it. */
enum status process_run(const char *const argv[], const char *log, int *code, struct err *err);

/* As process_run, with an environment variable NAME=VALUE more. */
enum status process_run_env(const char *const argv[], const char *const env[], const char *log, int *code,
                            struct err *err);

/* A program that reads what this process writes to `input` (ffmpeg). */
struct process {
    long pid;
    FILE *input;
};
enum status process_start(struct process *p, const char *const argv[], const char *log, struct err *err);
/* Closes the input and waits. A program that ends early is not a SIGPIPE for the writer but *code != 0 here. {0} is the
 * empty state, and harmless. */
enum status process_finish(struct process *p, int *code, struct err *err);
/* Ends the program, if it still runs, and waits. */
void process_kill(struct process *p);

#endif
