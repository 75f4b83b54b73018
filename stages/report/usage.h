/* usage.h - what the stages' logs say: time and memory used, and warnings.
 *
 * A stage's last line on stderr is "STAGE: used SECONDS s wall, SECONDS s cpu, MIB MiB peak"; its log stands in a
 * folder log/ as STAGE.ITEM.log. Warnings are lines "STAGE: warning: TEXT". Logs may hold anything: what is not such a line
 * is passed over. */
#ifndef REMODEL_USAGE_H
#define REMODEL_USAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

struct usage {
    char stage[64];
    double wall, cpu, mib; /* seconds, seconds, MiB at the peak */
};

struct stage_usage {  /* all logs of a stage together */
    struct usage sum; /* wall and cpu added, mib the largest */
    int runs;         /* logs that end with a usage line */
    int unfinished;   /* logs that do not: killed, or still running */
};

struct log_warning {
    char stage[64];
    char item[128]; /* of the first log that has it */
    char *text;     /* owned */
    int count;      /* equal warnings of a stage, over all its logs */
};

struct usage_table {
    struct stage_usage *stages; /* in order of first appearance */
    int stage_count;
    struct log_warning *warnings;
    int warning_count, warnings_dropped; /* beyond the first 200 different ones */
};

/* False if the line (without its line break) is not a usage line: an odd stage name, a number that is negative, not
 * finite or above 1e12, words more or fewer. */
bool usage_parse(struct usage *u, const char *line, size_t size);

/* Adds one log's text. name: STAGE.ITEM.log. */
enum status usage_add_log(struct usage_table *table, const char *name, const char *bytes, size_t size, struct err *err);
/* Adds all *.log of a folder in order of name, but for the logs of the stage `except` (NULL: none). A folder that is not there adds nothing. */
enum status usage_add_folder(struct usage_table *table, const char *folder, const char *except, struct err *err);
void usage_table_release(struct usage_table *table);

#endif
