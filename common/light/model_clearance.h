/* model_clearance.h - how far points and straight ways are from the surfaces of a solid model. Panes of glass are
 * solids like others, if the model was read with them. */
#ifndef REMODEL_MODEL_CLEARANCE_H
#define REMODEL_MODEL_CLEARANCE_H

#include "common/light/model_rays.h"

/* The least distance between a segment and a triangle; 0 if they meet. from = to: a point. */
double clearance_of_triangle(struct vec3 from, struct vec3 to, const struct vec3 corner[3]);

/* Whether a point is inside a solid, or nearer than `margin` to a surface. */
bool model_rays_inside(const struct model_rays *m, struct vec3 p, double margin);
/* The same with a margin of a millionth of the model's size: a camera there is on a surface, and sees nothing. */
bool model_rays_enclose(const struct model_rays *m, struct vec3 p);
/* How far the next surface is in a direction of length 1; INFINITY: there is none. front (may be NULL): set to whether
 * it faces the point, and left alone without a surface; from inside of a solid it does not. */
double model_rays_gap(const struct model_rays *m, struct vec3 from, struct vec3 direction, bool *front);
/* Whether all points of a segment are outside of the solids, and at least `margin` (> 0) from their surfaces. */
bool model_rays_way_is_free(const struct model_rays *m, struct vec3 from, struct vec3 to, double margin);

#endif
