/* mark_candidates.h - proposes where to mark the edge of a lamp's cone. */
#ifndef REMODEL_MARK_CANDIDATES_H
#define REMODEL_MARK_CANDIDATES_H

#include "stages/fit_lights/fit_lights_params.h"
#include "stages/fit_lights/lit_scene.h"

/* Looks for the edge of the cone of each lamp of the scene whose beta is to be fitted, in the views that show its
 * surroundings, and writes lines across it, lit and unlit places as statements of scenes/NAME/lights.txt. Without such
 * a lamp, a file of an earlier run is removed. `notes`, `model`, `furnished`, `views`, `ids` and `prov` as for
 * observe(). */
enum status mark_candidates_write(const struct lit_scene *scene, const struct annotation_list *notes,
                                  const struct lit_model *model, const struct model_rays *furnished, const char *views,
                                  const char *ids, const struct fit_lights_params *params, const char *path,
                                  struct provenance *prov, struct err *err);

#endif
