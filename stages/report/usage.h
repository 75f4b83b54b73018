/* usage.h - time, memory and warnings from the stages' logs.
 *
 * The log of a run is log/STAGE.ITEM.log. Its last line is "STAGE: used SECONDS s wall, SECONDS s cpu, MIB MiB peak";
 * warnings are lines "STAGE: warning: TEXT". All other lines are ignored. */
#ifndef REMODEL_USAGE_H
#define REMODEL_USAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

struct usage {
    char stage[64];
    double wall, cpu, mib; /* seconds, seconds, MiB at the peak */
};

struct stage_usage {  /* totals of a stage's logs */
    struct usage sum; /* wall and cpu: sums; mib: the maximum */
    int runs;         /* logs with a usage line */
    int unfinished;   /* logs without one: killed, or still running */
};

struct log_warning {
    char stage[64];
    char item[128]; /* of the first log with this warning */
    char *text;     /* owned */
    int count;      /* equal warnings in all logs of the stage */
};

struct usage_table {
    struct stage_usage *stages; /* in order of first appearance */
    int stage_count;
    struct log_warning *warnings;
    int warning_count, warnings_dropped; /* dropped: after the first 200 different ones */
};

/* line: without its line break. False, with *u unchanged: it is not a usage line (an invalid stage name, a number that
 * is negative, not finite or above 1e12, other words). */
bool usage_parse(struct usage *u, const char *line, size_t size);

/* Adds one log's text. name: STAGE.ITEM.log. */
enum status usage_add_log(struct usage_table *table, const char *name, const char *bytes, size_t size, struct err *err);
/* Adds all *.log of a folder in order of name, except those of the stage `except` (may be NULL). A missing folder adds
 * nothing. */
enum status usage_add_folder(struct usage_table *table, const char *folder, const char *except, struct err *err);
void usage_table_release(struct usage_table *table);

#endif
