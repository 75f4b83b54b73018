/* plan_file.h - text products beside the solids: plan.txt with positions of walls, openings and rooms, and merged.txt
 * with the face names that vanished; docs/formats.md. */
#ifndef REMODEL_BUILD_MODEL_PLAN_FILE_H
#define REMODEL_BUILD_MODEL_PLAN_FILE_H

#include "stages/build_model/plan/plan.h"
#include "stages/build_model/solid/unite.h"

enum status plan_write(const struct plan *plan, const char *path, const struct provenance *prov, struct err *err);
enum status plan_merged_write(const struct unite_log *log, const char *path, const struct provenance *prov,
                              struct err *err);

#endif
