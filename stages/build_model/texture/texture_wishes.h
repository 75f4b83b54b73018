/* texture_wishes.h - what a script says of textures, as rules of faces; used by texture_rules.c. */
#ifndef REMODEL_BUILD_MODEL_TEXTURE_WISHES_H
#define REMODEL_BUILD_MODEL_TEXTURE_WISHES_H

#include "common/texture/texture_map.h"
#include "stages/build_model/plan/plan.h"
#include "stages/build_model/texture/texture_planes.h"

struct texture_models {
    const struct solid_mesh *edited, *base;
    const struct plan *before, *plan; /* of the base, of the edited model */
};

/* ST_DATA with file and line: a statement names a face that the models do not have, or makes too many copies. */
enum status texture_wishes_check(const struct texture_models *m, struct err *err);

/* Adds the rules that statements make for a face: of the last statement first. *covered: they cover all of it.
 * base_face: its own place in the base, -1: none; `by` leads there. lit: for colours; copied. */
enum status texture_wishes_add(struct texture_face *to, bool *covered, const struct texture_models *m, int face,
                               int base_face, struct vec3 by, const int *lit, int lit_count, struct err *err);

/* The gloss that the last statement about a face gives it. */
void texture_wishes_gloss(struct texture_face *to, const struct texture_models *m, int face);

/* The lamps whose radiance statements change. */
enum status texture_lamps_add(struct texture_map *map, const struct plan *plan, struct err *err);

/* The footprints in which clutter is cleared or kept. */
enum status texture_zones_add(struct texture_map *map, const struct plan *plan, struct err *err);

/* The things that are cleared, kept, moved or copied. */
enum status texture_things_add(struct texture_map *map, const struct plan *plan, struct err *err);

/* Whether a face's name is of the item NAME: KIND/NAME or KIND/NAME/PART. */
bool texture_face_is_of(const char *face, const char *item);

/* The corners, in the plane of a face of the edited model, of a rectangle of S and Z on its wall, or of X and Y. */
void texture_place_quad(struct vec3 corners[4], const struct texture_models *m, const double place[4], int face);

/* Adds a rule; its array `lit` becomes the face's. */
enum status texture_face_add(struct texture_face *face, struct texture_rule rule, struct err *err);

#endif
