/* param.h - parameters of stages, each declared once.
 *
 * A stage lists its parameters in one X macro. The struct, the defaults, the config reader, --help, --print-config,
 * configs/default.cfg and the provenance come from that list:
 *
 *   // name, type, default, min, max, unit, help
 *   #define SWEEP_PARAMS(X) \
 *       X(planes, int,    128,  2, 4096, "",          "planes, spaced evenly in 1/z") \
 *       X(width,  double, 0.5,  0, 10,   "m",         "width of the tape")            \
 *       X(metric, choice, "ad", 0, 0,    "ad|census", "matching cost")                \
 *       X(note,   text,   "",   0, 0,    "",          "free text")
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

enum param_kind { PARAM_int, PARAM_double, PARAM_text, PARAM_choice };

#define PARAM_C_int    int
#define PARAM_C_double double
#define PARAM_C_text   param_text
#define PARAM_C_choice param_text

#define PARAM_FIELD(name, type, value, min, max, unit, help)   PARAM_C_##type name;
#define PARAM_DEFAULT(name, type, value, min, max, unit, help) .name = value,
/* A row of a table. Where the table is defined, PARAM_STRUCT must be the struct. */
#define PARAM_ROW(name, type, value, min, max, unit, help) \
    {#name, PARAM_##type, offsetof(PARAM_STRUCT, name), min, max, unit, help},
#define PARAM_END                            \
    {                                        \
        NULL, PARAM_int, 0, 0, 0, NULL, NULL \
    }

struct param {
    const char *name;
    enum param_kind kind;
    size_t offset;    /* of the value in the stage's struct */
    double min, max;  /* inclusive; numbers only */
    const char *unit; /* for a choice: the choices, "auto|yes|no" */
    const char *help; /* a noun phrase */
};

/* Reads [section] of an INI file into `values` and ignores other sections. ST_USAGE, with file and line: an unknown
 * key, a key set twice, a value that is not a finite number or is out of range. */
enum status params_read_file(const struct param *table, void *values, const char *section, const char *path,
                             struct err *err);

/* Sets one parameter from "key=value", the argument of --set. */
enum status params_set(const struct param *table, void *values, const char *assignment, struct err *err);

/* Prints "[section]", then a line "key = value" per parameter in the table's order. The text is canonical: equal
 * parameters give equal bytes (a double is the shortest decimal number that reads back the same). */
void params_print(const struct param *table, const void *values, const char *section, FILE *to);

/* Prints a section of configs/default.cfg: "[section]", then each parameter below a comment with its help, unit and
 * range. */
void params_explain(const struct param *table, const void *values, const char *section, FILE *to);

/* Prints the parameters for --help: name, help, default (from `values`), unit, range. */
void params_help(const struct param *table, const void *values, FILE *to);

#endif
