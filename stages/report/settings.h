/* settings.h - the parameters that stages ran with, from their slices of the configuration: slice/STAGE.cfg.
 *
 * Of a key that occurs twice the last value counts, as in the stages. */
#ifndef REMODEL_SETTINGS_H
#define REMODEL_SETTINGS_H

#include <stdbool.h>

#include "common/base/err.h"

struct setting {
    char section[64], key[64], value[256];
    char default_value[256]; /* "" unless `known` */
    bool known;              /* there is a default */
    bool changed;            /* the value differs from it */
};

struct settings {
    struct setting *items; /* grouped by section, sections in order of first appearance */
    int count;
};

/* Adds all *.cfg of a folder, in order of name; a missing folder adds nothing. ST_IO; ST_DATA with file and line. */
enum status settings_add_folder(struct settings *s, const char *folder, struct err *err);
enum status settings_add_file(struct settings *s, const char *path, struct err *err);
/* Sets default_value, known and changed. Numbers are compared as numbers: 2 is 2.0. */
void settings_compare(struct settings *s, const struct settings *defaults);
void settings_release(struct settings *s);

#endif
