/* edit_chain.h - applies script files to a plan: the model's, and edits, which may stand on other edits. */
#ifndef REMODEL_BUILD_MODEL_EDIT_CHAIN_H
#define REMODEL_BUILD_MODEL_EDIT_CHAIN_H

#include "common/base/provenance.h"
#include "stages/build_model/plan/plan.h"

/* All add the scripts to prov by their file names. placer: NULL if no views are known. ST_DATA with file and line. */

enum status edit_chain_apply_model(struct plan *plan, const char *path, const struct placer *placer,
                                   struct provenance *prov, struct err *err);

/* Applies the file of objects that all edits have, which holds statements `object` alone. ST_DATA: another
 * statement. */
enum status edit_chain_apply_objects(struct plan *plan, const char *path, struct provenance *prov, struct err *err);

/* Applies an edit after the one that its statement `base` names, in the same folder, and so on. ST_DATA: that
 * edit does not exist, or the edits go in a circle. */
enum status edit_chain_apply_edit(struct plan *plan, const char *path, const struct placer *placer,
                                  struct provenance *prov, struct err *err);

#endif
