/* cli.h - the command line every stage has: its own options, and
 *   --help --version --print-config --explain-config --threads N --config FILE --set key=value
 *
 * Config files are read in the order given, then every --set; later wins. A stage's section carries its name. */
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

struct cli_list { /* of an option that may be given several times; items point into argv, the array is owned */
    const char **items;
    int count;
};
void cli_list_release(struct cli_list *list);

struct cli_opt {
    enum cli_kind kind;
    const char *name; /* without the dashes */
    void *value;
    bool required;
    const char *help;
    const struct param *table;                                 /* CLI_PARAMS */
    enum status (*check)(const void *values, struct err *err); /* CLI_PARAMS: relations between parameters, or NULL */
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
/* A parameter that has an option of its own: --NAME VALUE is the last --set NAME=VALUE. */
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

/* CLI_RUN: go on; CLI_DONE: help, version or the config was printed, exit 0; CLI_FAILED: ST_USAGE is set (and the
 * caller reports it). Sets the log's name, the number of threads (common/base/parallel.h) and the provenance's stage,
 * version and effective parameters; arranges that the process's last line on stderr is
 *   STAGE: used SECONDS s wall, SECONDS s cpu, MIB MiB peak
 * which the report reads. An unknown option is answered with the nearest known one. */
enum cli_verdict cli_parse(int argc, char **argv, const char *stage, const struct cli_opt *opts,
                           struct provenance *prov, struct err *err);

#endif
