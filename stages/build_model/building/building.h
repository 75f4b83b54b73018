/* building.h - from scripts to a model: the plan, the faces of its solids, and the text products of both. */
#ifndef REMODEL_BUILD_MODEL_BUILDING_H
#define REMODEL_BUILD_MODEL_BUILDING_H

#include "common/model/model_axes.h"
#include "common/model/solid_mesh.h"
#include "stages/build_model/plan/plan.h"
#include "stages/build_model/solid/unite.h"

/* Paths; NULL: none. base: model.txt of the unedited model. */
struct building_files {
    const char *script, *things, *edit, *base, *scene;
};

struct building { /* {0} is the empty state */
    struct plan plan;
    struct solid_list solids; /* has the names in `log` */
    struct solid_mesh mesh;
    struct unite_log log;
    struct solid_report report;
};

/* Applies the scripts and makes closed solids of the plan. placer may be NULL if no statement names a view. The files
 * are recorded in prov. A failure leaves in `b` how far it came: the plan holds what was applied before the statement
 * that was refused. ST_DATA with file and line. */
enum status building_make(struct building *b, const struct building_files *files, const struct model_axes *axes,
                          const struct placer *placer, struct provenance *prov, struct err *err);

/* Of an edit, with `base`: gives faces the ids that they have in it, and writes texture.txt and objects.txt. */
enum status building_write_edit(struct building *b, const struct building_files *files, const char *folder,
                                struct provenance *prov, struct err *err);
/* Writes plan.txt, merged.txt, then model.txt into a folder. */
enum status building_write(const struct building *b, const char *folder, struct provenance *prov, struct err *err);

void building_release(struct building *b);

#endif
