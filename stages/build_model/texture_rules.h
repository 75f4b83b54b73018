/* texture_rules.h - where the faces of an edited model take their texture (common/texture/texture_map.h), from the
 * models and the plans before and after the edit [Colburn 2014, 4.5.4]. */
#ifndef REMODEL_BUILD_MODEL_TEXTURE_RULES_H
#define REMODEL_BUILD_MODEL_TEXTURE_RULES_H

#include "common/model/solid_mesh.h"
#include "common/texture/texture_map.h"
#include "stages/build_model/plan.h"

/* The places of a plan's items, kept from before an edit. {0} is the empty state. */
struct plan_places {
    struct plan_wall *walls; /* copies, whose names belong to the plan; owned */
    struct plan_opening *openings;
    struct plan_slot *slots;
    struct plan_box *boxes;
    int wall_count, opening_count, slot_count, box_count;
};

enum status plan_places_keep(struct plan_places *places, const struct plan *plan, struct err *err);
void plan_places_release(struct plan_places *places);

/* Rules of each face of the edited model, whose ids are those of the base. before: places in the base; plan: in the
 * edited model. map is empty on entry; the caller releases it in each case. */
enum status texture_rules_make(struct texture_map *map, const struct solid_mesh *edited, const struct solid_mesh *base,
                               const struct plan_places *before, const struct plan *plan, struct err *err);

#endif
