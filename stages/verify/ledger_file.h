/* ledger_file.h - the ledger of a scene, S/log/ledger.txt: what its runs made, and what people gave them.
 *
 *   remodel-ledger 1
 *   HASH MAKER PATH     one line for each file, by path; MAKER: a stage, "scene" for a file of scenes/NAME, or "photo"
 *   end HASH            of all lines before it: the ledger itself may have been changed */
#ifndef REMODEL_LEDGER_FILE_H
#define REMODEL_LEDGER_FILE_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/base/hash.h"

#define LEDGER_SCENE "scene"
#define LEDGER_PHOTO "photo"

struct ledger_entry {
    char hash[HASH_TEXT], maker[32];
    char *path; /* owned */
};

struct ledger {
    struct ledger_entry *entries; /* owned */
    int count;
};

enum status ledger_append(struct ledger *l, const char *hash, const char *maker, const char *path, struct err *err);
/* By path; entries of one path keep their order. ST_NOMEM. */
enum status ledger_sort(struct ledger *l, struct err *err);
const struct ledger_entry *ledger_find(const struct ledger *l, const char *path); /* of a sorted one; NULL: not found */
bool ledger_is_given(const struct ledger_entry *e);                               /* by people, not made by a stage */

/* Reads the ledger of a folder; one that is missing is empty. ST_DATA: it was changed, or is of another version. */
enum status ledger_read(struct ledger *l, const char *path, struct err *err);
/* Adds the lines "HASH STAGE PATH" that a process wrote (common/base/ledger.h). A last line without its end is left
 * out: the process was killed while it wrote, before the product appeared. */
enum status ledger_add_lines(struct ledger *l, const char *path, struct err *err);
enum status ledger_write(const struct ledger *l, const char *path, struct err *err);
void ledger_release(struct ledger *l);

#endif
