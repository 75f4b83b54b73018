/* texture_wishes.h - what a script says of textures, as rules of faces; used by texture_rules.c. */
#ifndef REMODEL_BUILD_MODEL_TEXTURE_WISHES_H
#define REMODEL_BUILD_MODEL_TEXTURE_WISHES_H

#include "stages/build_model/texture_rules.h"

/* A plane with axes: u x v = n; seen from outside u points to the right and v up where the plane is upright. */
struct plane_axes {
    struct vec3 u, v, n;
    double offset;
};
struct plane_axes plane_axes_of(const struct solid_face *f);
struct vec3 plane_axes_point(const struct plane_axes *axes, double u, double v);

struct texture_models {
    const struct solid_mesh *edited, *base;
    const struct plan_places *before;
    const struct plan *plan;
};

/* ST_DATA with file and line: a statement names a face that the models do not have, or makes too many copies. */
enum status texture_wishes_check(const struct texture_models *m, struct err *err);

/* Adds the rules that statements make for a face: of the last statement first. *covered: they cover all of it.
 * base_face: its own place in the base, -1: none; `by` leads there. lit: for colours; copied. */
enum status texture_wishes_add(struct texture_face *to, bool *covered, const struct texture_models *m, int face,
                               int base_face, struct vec3 by, const int *lit, int lit_count, struct err *err);

/* The footprints in which clutter is cleared or kept. */
enum status texture_zones_add(struct texture_map *map, const struct plan *plan, struct err *err);

/* Adds a rule; its array `lit` becomes the face's. */
enum status texture_face_add(struct texture_face *face, struct texture_rule rule, struct err *err);

#endif
