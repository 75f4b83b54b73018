/* opening_sight.h - what is seen through an opening in a wall of the room's model. */
#ifndef REMODEL_OPENING_SIGHT_H
#define REMODEL_OPENING_SIGHT_H

#include "common/model/model_plan.h"

struct opening_sight {
    const struct model_plan *plan;
    const struct model_wall *wall;
    int opening;
    struct vec3 corners[2]; /* on the wall's inner face: the lower one and the opposite upper one */
};

/* False: the opening's wall is along no axis. */
bool opening_sight_init(struct opening_sight *s, const struct model_plan *plan, int opening);
/* The distance of its opposite corners. */
double opening_sight_diagonal(const struct opening_sight *s);
/* A point of the opening on the wall's inner face; u, v: from 0 to 1, from the lower corner to the upper one. */
struct vec3 opening_sight_at(const struct opening_sight *s, double u, double v);
/* Whether a ray leaves the room through the opening, clear of its edges, and no other wall is before it. */
bool opening_sight_passes(const struct opening_sight *s, struct vec3 from, struct vec3 direction);

#endif
