/* field_openings.h - what lies behind an opening, from the reference images that lights.txt names for it. */
#ifndef REMODEL_GATHER_FIELD_OPENINGS_H
#define REMODEL_GATHER_FIELD_OPENINGS_H

#include "common/gather/model_field.h"

/* Vectors of the plane of x and y with which q = a x + b y has a = dual[0].q and b = dual[1].q. */
void field_dual(struct vec3 dual[2], struct vec3 x, struct vec3 y);

/* The colour of the first reference image that shows a unit direction, of the opening that a ray passes on its way out.
 * False: it passes none that has such an image. */
bool field_reference_look(float rgb[3], const struct model_field *f, struct vec3 from, struct vec3 direction);

void field_openings_release(struct model_field *f);

#endif
