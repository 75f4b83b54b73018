/* tour_clearance.h - how far a straight way is from a model's surfaces. */
#ifndef REMODEL_TOUR_CLEARANCE_H
#define REMODEL_TOUR_CLEARANCE_H

#include "common/light/model_rays.h"

/* The least distance between a segment and a triangle; 0 if they meet. from = to: a point. */
double segment_triangle_distance(struct vec3 from, struct vec3 to, const struct vec3 corner[3]);

/* Whether all points of a segment are outside of the model's solids, at least `clearance` (> 0) from their surfaces. */
bool tour_way_is_free(const struct model_rays *model, struct vec3 from, struct vec3 to, double clearance);

#endif
