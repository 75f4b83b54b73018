/* solid.h - convex solids as half-spaces with face names: layout makes them, unite unites them.
 *
 * Model frame, model units. Coordinates are rounded to a lattice of a millionth of a unit (SOLID_STEP): a plane along
 * the axes lies on it exactly. An oblique plane gets an integer normal: exact where the ratios of its components are
 * those of integers up to 2^22 (45 degrees; a wall between corners with few digits), otherwise rounded to 2^-22 of the
 * largest component. Pass equal planes by equal numbers (all pieces of a wall use the wall's planes, also where it is
 * sloped or angled, and an opposite plane is the negative); oblique planes that differ by at most two steps in normal
 * and offset are taken as one. */
#ifndef REMODEL_BUILD_MODEL_SOLID_H
#define REMODEL_BUILD_MODEL_SOLID_H

#include "common/base/err.h"
#include "common/math/vec.h"

#define SOLID_STEP  1e-6
#define SOLID_REACH 1000.0 /* coordinates lie in -SOLID_REACH .. SOLID_REACH, in model units */

/* The points p with normal . p <= offset; normal points outwards and has any length but 0, which scales offset too. */
struct half_space {
    struct vec3 normal;
    double offset;
    const char *name; /* of the face that lies in its plane */
};

/* The intersection of its half-spaces. A redundant half-space is allowed and makes no face. */
struct solid {
    struct half_space *half_spaces;
    int count;
    const char *body; /* solids of one body are united: "walls", "glass/sunny" */
};

struct solid_list {
    struct solid *solids; /* owned, with half-spaces and names; a merged face gets the name that comes first in this
                             order (of solids, then of half-spaces) */
    int count;
    char **texts; /* owned: a hash table with one copy of each name */
    int text_count, text_capacity;
};

/* Adds a copy. ST_DATA: a number that is not finite, a normal of length 0, fewer than 4 half-spaces, an empty name. */
enum status solid_list_add(struct solid_list *list, const char *body, const struct half_space *half_spaces, int count,
                           struct err *err);

void solid_list_release(struct solid_list *list);

#endif
