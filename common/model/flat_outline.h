/* flat_outline.h - the outline of what lies flat on a face of the model, such as a rug or a picture: a polygon in the
 * plane of the face, known exactly. */
#ifndef REMODEL_FLAT_OUTLINE_H
#define REMODEL_FLAT_OUTLINE_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/math/vec.h"

/* {0} is the empty state, of what is not flat; everything is owned. */
struct flat_outline {
    struct vec3 normal; /* of the face, unit: into the room; model frame */
    double offset;      /* normal . p of the face */
    int axes[2];        /* which two coordinates of a corner xy has: those that the plane is not across */
    double (*xy)[2];
    int count; /* of corners; 0: not flat */
};

/* Makes an outline with `count` corners at 0 of a plane. normal: unit. ST_NOMEM. */
enum status flat_outline_init(struct flat_outline *o, struct vec3 normal, double offset, int count, struct err *err);
/* Puts a corner at the place of the plane that is nearest to p. */
void flat_outline_put(struct flat_outline *o, int i, struct vec3 p);
enum status flat_outline_copy(struct flat_outline *to, const struct flat_outline *from, struct err *err);
void flat_outline_release(struct flat_outline *o);

struct vec3 flat_outline_corner(const struct flat_outline *o, int i);
double flat_outline_area(const struct flat_outline *o);
/* How far a point is before the face. */
double flat_outline_height(const struct flat_outline *o, struct vec3 p);
/* Whether the outline holds a point of its plane; of a point beside it, its place along the coordinate that xy
 * lacks. */
bool flat_outline_holds(const struct flat_outline *o, struct vec3 p);
/* Whether a ray meets the front of the outline; *t (may be NULL): where, in lengths of `way`. */
bool flat_outline_meets(double *t, const struct flat_outline *o, struct vec3 from, struct vec3 way);

#endif
