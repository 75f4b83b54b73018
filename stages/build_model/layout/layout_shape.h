/* layout_shape.h - what the files that lay out a plan share: a solid's half-spaces with their names, and its floors,
 * ceilings and boxes. */
#ifndef REMODEL_BUILD_MODEL_LAYOUT_SHAPE_H
#define REMODEL_BUILD_MODEL_LAYOUT_SHAPE_H

#include "stages/build_model/plan/plan.h"
#include "stages/build_model/solid/solid.h"

enum { NAME_SIZE = 192 };
#define BODY "walls"
#define NEAR 1e-6 /* SOLID_STEP: positions closer than this are equal */

struct shape { /* half-spaces of a solid and their names, until shape_add() */
    struct half_space *h;
    char (*names)[NAME_SIZE];
    int count, capacity;
    bool no_memory;
};

void shape_release(struct shape *s);

/* Adds the half-space of the points p with (x, y, z) p <= offset; fmt: the name of its face. */
void shape_add_side(struct shape *s, double x, double y, double z, double offset, const char *fmt, ...)
    PRINTF_LIKE(6, 7);

/* Adds what the shape holds to the list and releases it. */
enum status shape_add(struct solid_list *list, const char *body, struct shape *s, struct err *err);

/* Left or right as seen from inside: the side nearer to the wall's start is left. */
const char *shape_reveal_side(const struct plan_wall *w, int upper_bound_of_hole);

/* layout_walls.c */

enum status layout_add_walls(struct solid_list *list, const struct plan *plan, struct err *err);

/* layout_slabs.c */

enum status layout_add_room(struct solid_list *list, const struct plan *p, const struct plan_room *r, struct err *err);
/* What fills an opening in a ceiling or floor. */
enum status layout_add_slot(struct solid_list *list, const struct plan *p, const struct plan_slot *o, struct err *err);
enum status layout_add_box(struct solid_list *list, const struct plan_box *b, struct err *err);

#endif
