/* param.h - parameters, each declared once.
 *
 * A stage lists its parameters in one X macro; the struct, the defaults, the config reader, --help, --print-config and
 * the provenance come from that list:
 *
 *   #define SWEEP_PARAMS(X) \
 *       X(planes, int,    128,  2, 4096, "",         "planes, spaced evenly in 1/z") \
 *       X(gain,   double, 1.0,  0, 10,   "",         "photometric gain")             \
 *       X(metric, choice, "ad", 0, 0,    "ad|census", "cost of a match")             \
 *       X(note,   text,   "",   0, 0,    "",         "free text")
 *   struct sweep_params { SWEEP_PARAMS(PARAM_FIELD) };
 *   #define SWEEP_PARAMS_DEFAULT { SWEEP_PARAMS(PARAM_DEFAULT) }
 *   extern const struct param sweep_param_table[];
 *   // and in one .c file:
 *   #define PARAM_STRUCT struct sweep_params
 *   const struct param sweep_param_table[] = { SWEEP_PARAMS(PARAM_ROW) PARAM_END };
 *   #undef PARAM_STRUCT */
#ifndef REMODEL_PARAM_H
#define REMODEL_PARAM_H

#include <stddef.h>
#include <stdio.h>

#include "common/base/err.h"

#define PARAM_TEXT_SIZE 256
typedef char param_text[PARAM_TEXT_SIZE];

enum param_kind { PARAM_int, PARAM_double, PARAM_text, PARAM_choice, PARAM_renamed };

#define PARAM_C_int    int
#define PARAM_C_double double
#define PARAM_C_text   param_text
#define PARAM_C_choice param_text

#define PARAM_FIELD(name, type, value, least, most, unit, help)   PARAM_C_##type name;
#define PARAM_DEFAULT(name, type, value, least, most, unit, help) .name = value,
/* a row of a table; PARAM_STRUCT must be #defined to the struct where the table is written */
#define PARAM_ROW(name, type, value, least, most, unit, help) \
    {#name, PARAM_##type, offsetof(PARAM_STRUCT, name), least, most, unit, help},
/* a row for a name that a parameter no longer has; whoever gives it is refused and told the new name */
#define PARAM_RENAMED(old, now) {#old, PARAM_renamed, 0, 0, 0, "", #now},
#define PARAM_END                            \
    {                                        \
        NULL, PARAM_int, 0, 0, 0, NULL, NULL \
    }

struct param {
    const char *name;
    enum param_kind kind;
    size_t offset;      /* of the value in the stage's struct */
    double least, most; /* inclusive; numbers only */
    const char *unit;   /* for a choice: its words, "auto|yes|no" */
    const char *help;   /* of a renamed parameter: its new name */
};

/* Reads the section [section] of an INI file into `values`; other sections are left to their stages. Unknown keys, a
 * key given twice, values that are no number, not finite or out of range are ST_USAGE with file and line. */
enum status params_read_file(const struct param *table, void *values, const char *section, const char *path,
                             struct err *err);

/* "key=value", as --set gives it. */
enum status params_set(const struct param *table, void *values, const char *assignment, struct err *err);

/* "[section]", then "key = value" lines in the table's order: canonical, so that equal parameters give equal bytes
 * (doubles as the shortest decimal number that reads back the same). An empty table prints the section line alone. */
void params_print(const struct param *table, const void *values, const char *section, FILE *to);

/* The section of configs/default.cfg: "[section]", then each parameter with a comment that holds its help, unit and range. */
void params_explain(const struct param *table, const void *values, const char *section, FILE *to);

/* The lines of --help: name, default (what values holds), range, unit, help. */
void params_help(const struct param *table, const void *values, FILE *to);

#endif
