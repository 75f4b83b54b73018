/* settings.h - the parameters that stages ran with, from their slices of the configuration: slice/STAGE.cfg.
 *
 * A key given twice counts as given last, as the stages read it. */
#ifndef REMODEL_SETTINGS_H
#define REMODEL_SETTINGS_H

#include <stdbool.h>

#include "common/base/err.h"

struct setting {
    char section[64], key[64], value[256];
    char usual[256]; /* the default, if it is known */
    bool known, changed;
};

struct settings {
    struct setting *items; /* sections together, in order of first appearance */
    int count;
};

/* Adds all *.cfg of a folder, in order of name. A folder that is not there adds nothing. */
enum status settings_add_folder(struct settings *s, const char *folder, struct err *err);
enum status settings_add_file(struct settings *s, const char *path, struct err *err);
/* Fills usual, known and changed from the defaults' sections and keys. Numbers are compared as numbers. */
void settings_compare(struct settings *s, const struct settings *defaults);
void settings_release(struct settings *s);

#endif
