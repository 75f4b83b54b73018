/* texture_rules.h - where the faces of an edited model take their texture (common/texture/texture_map.h), from the
 * models and the plans before and after the edit [Colburn 2014, 4.5.4]. */
#ifndef REMODEL_BUILD_MODEL_TEXTURE_RULES_H
#define REMODEL_BUILD_MODEL_TEXTURE_RULES_H

#include "common/model/solid_mesh.h"
#include "common/texture/texture_map.h"
#include "stages/build_model/plan/plan.h"

/* Rules of each face of the edited model, whose ids are those of the base. plan: of the edited model; an edit was
 * applied to it. map is empty on entry; the caller releases it in each case. */
enum status texture_rules_make(struct texture_map *map, const struct solid_mesh *edited, const struct solid_mesh *base,
                               const struct plan *plan, struct err *err);

#endif
