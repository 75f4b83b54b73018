/* script.h - reads model scripts: walls, rooms, openings and boxes as a person writes them, and edits of a model.
 *
 * scenes/NAME/model.txt and scenes/NAME/edits/E.txt; docs/model-script.md describes the language. */
#ifndef REMODEL_BUILD_MODEL_SCRIPT_H
#define REMODEL_BUILD_MODEL_SCRIPT_H

#include "common/base/err.h"
#include "stages/build_model/script/statement.h"

struct script {
    char *path;       /* as messages name it; owned */
    const char *base; /* the edit that this one stands on; NULL: none */
    int base_line;
    char *words; /* all names; owned */
    struct statement *statements;
    int count;
};

/* The caller releases the script, which a failure leaves empty. ST_DATA with file and line for an invalid
 * statement: an unknown word (with a guess at what was meant), a name with characters other than letters, digits, `_`
 * and `-`, a number beyond 1e6, a rectangle without area, an option that the statement does not have or has twice. */
enum status script_read(struct script *script, const char *path, struct err *err);
void script_release(struct script *script);

#endif
