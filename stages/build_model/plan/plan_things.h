/* plan_things.h - the names of a scene's things, which edits may clear, move and copy. */
#ifndef REMODEL_BUILD_MODEL_PLAN_THINGS_H
#define REMODEL_BUILD_MODEL_PLAN_THINGS_H

#include "common/base/provenance.h"
#include "stages/build_model/plan/plan.h"

/* Adds the things that a file names (common/model/thing_marks.h), after the script of the model and before edits.
 * ST_DATA: a name is used already, naming both lines. */
enum status plan_things_add(struct plan *plan, const char *path, struct provenance *prov, struct err *err);

#endif
