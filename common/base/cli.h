/* cli.h - the command line of a stage: its own options, and those of every stage:
 *   --help --version --print-config --explain-config --threads N --config FILE --set key=value
 *
 * Config files are read in the order given, then every --set; the last value wins. A stage reads the config section of
 * its own name. */
#ifndef REMODEL_CLI_H
#define REMODEL_CLI_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/base/param.h"
#include "common/base/provenance.h"

enum cli_kind {
    CLI_KIND_END,
    CLI_KIND_ABOUT,
    CLI_KIND_STR,
    CLI_KIND_LIST,
    CLI_KIND_INT,
    CLI_KIND_FLAG,
    CLI_KIND_PARAM,
    CLI_KIND_PARAMS
};

struct cli_list { /* values of a repeatable option; items point into argv, the array is owned */
    const char **items;
    int count;
};
void cli_list_release(struct cli_list *list);

struct cli_opt {
    enum cli_kind kind;
    const char *name; /* without dashes */
    void *value;
    bool required;
    const char *help;
    const struct param *table; /* CLI_PARAMS */
    enum status (*check)(const void *values,
                         struct err *err); /* CLI_PARAMS: checks relations between parameters; or NULL */
};

#define CLI_REQUIRED true
#define CLI_OPTIONAL false
#define CLI_ABOUT(text)                                     \
    {                                                       \
        CLI_KIND_ABOUT, NULL, NULL, false, text, NULL, NULL \
    } /* first line of --help */
#define CLI_STR(name, ptr, required, help)                  \
    {                                                       \
        CLI_KIND_STR, name, ptr, required, help, NULL, NULL \
    } /* const char ** */
#define CLI_LIST(name, ptr, required, help)                  \
    {                                                        \
        CLI_KIND_LIST, name, ptr, required, help, NULL, NULL \
    } /* struct cli_list * */
#define CLI_INT(name, ptr, required, help)                  \
    {                                                       \
        CLI_KIND_INT, name, ptr, required, help, NULL, NULL \
    } /* int * */
#define CLI_FLAG(name, ptr, help)                         \
    {                                                     \
        CLI_KIND_FLAG, name, ptr, false, help, NULL, NULL \
    } /* bool * */
/* A parameter with an option of its own: --NAME VALUE means --set NAME=VALUE, applied last. */
#define CLI_PARAM(name, ptr, help)                         \
    {                                                      \
        CLI_KIND_PARAM, name, ptr, false, help, NULL, NULL \
    }
#define CLI_PARAMS(table, ptr, check)                         \
    {                                                         \
        CLI_KIND_PARAMS, NULL, ptr, false, NULL, table, check \
    }
#define CLI_END                                           \
    {                                                     \
        CLI_KIND_END, NULL, NULL, false, NULL, NULL, NULL \
    }

enum cli_verdict { CLI_RUN, CLI_DONE, CLI_FAILED };

/* CLI_RUN: continue. CLI_DONE: help, version or the configuration was printed; exit 0. CLI_FAILED: err is set, usually
 * to ST_USAGE; the caller reports it. The error about an unknown option suggests the nearest known one.
 *
 * Sets the log's name, the number of threads (common/base/parallel.h), and the provenance's stage, version and
 * effective parameters. With CLI_RUN, the last line on stderr will be
 *   STAGE: used SECONDS s wall, SECONDS s cpu, MIB MiB peak
 * which stages/report reads. */
enum cli_verdict cli_parse(int argc, char **argv, const char *stage, const struct cli_opt *opts,
                           struct provenance *prov, struct err *err);

/* Makes piece i of a stage's work: those that the i-th names of its options describe. */
typedef enum status cli_make_one(void *ctx, int i, struct err *err);

/* Makes the pieces called `names` in order. If there are several, one that fails does not keep the others from being
 * made: its error is reported, and err is set at the end. After each of several, "STAGE: used ..." says what it took,
 * and a line "STAGE: made 2 of 7: NAME", or "failed", ends its part of the log: common/run/run_lines.sh goes by it. */
enum status cli_make_each(const struct cli_list *names, cli_make_one *make, void *ctx, struct err *err);

#endif
