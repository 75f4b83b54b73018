/* check_scene.h - whether all files of a scene are as its ledger says: `make verify`. */
#ifndef REMODEL_CHECK_SCENE_H
#define REMODEL_CHECK_SCENE_H

#include "common/base/err.h"

/* Checks what is below `shared` and `own`, S and O, and what people gave: each file's bytes against the ledger, and
 * what products say that they were made of against these files. Prints a sentence for each fault, and a last line
 * with the numbers. ST_DATA: there are faults, or the ledger itself was changed. */
enum status scene_check(const char *shared, const char *own, struct err *err);

#endif
