/* solid.h - convex solids as half-spaces with face names: what layout makes and unite puts together.
 *
 * Model frame, model units. Coordinates are taken to a lattice of a millionth of a unit (SOLID_STEP): a plane along
 * the axes lies on it exactly. An oblique plane has a normal of whole numbers, exact where its components are to each
 * other as whole numbers up to 2^22 are (45 degrees; a wall between corners with few digits), to 2^-22 of the largest
 * one otherwise. What is meant to be the same plane should be given by the same numbers (pieces of one wall take the
 * wall's planes, also on sloped and angled ones, and the opposite plane its negative); oblique planes that differ by no
 * more than two steps in normal and offset are taken as one. */
#ifndef REMODEL_BUILD_MODEL_SOLID_H
#define REMODEL_BUILD_MODEL_SOLID_H

#include "common/base/err.h"
#include "common/math/vec.h"

#define SOLID_STEP  1e-6
#define SOLID_REACH 1000.0 /* coordinates lie in -SOLID_REACH .. SOLID_REACH, in model units */

/* The points p with normal . p <= offset; normal points outwards, has any length but 0 (offset goes with it). */
struct half_space {
    struct vec3 normal;
    double offset;
    const char *name; /* of the face that lies in its plane */
};

/* What all its half-spaces have in common. A half-space that bounds nothing of it is allowed, and gives no face. */
struct solid {
    struct half_space *half_spaces;
    int count;
    const char *body; /* solids of the same body are united; "walls", "glass/sunny" */
};

struct solid_list {
    struct solid *solids; /* owned, with their half-spaces and all names; of faces that merge the earliest in this
                             order (solids, then half-spaces) gives its name */
    int count;
    int capacity; /* of solids */
    char **texts; /* owned: one copy of each name, a hash table */
    int text_count, text_capacity;
};

/* Adds a copy. ST_DATA: a number that is not finite, a normal of length 0, fewer than 4 half-spaces, an empty name. */
enum status solid_list_add(struct solid_list *list, const char *body, const struct half_space *half_spaces, int count,
                           struct err *err);

/* The faces of a box: names[0], [1] at low and high x, [2], [3] y, [4], [5] z. */
enum status solid_list_add_box(struct solid_list *list, const char *body, struct vec3 low, struct vec3 high,
                               const char *const names[6], struct err *err);

void solid_list_release(struct solid_list *list);

#endif
