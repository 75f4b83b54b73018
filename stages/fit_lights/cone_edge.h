/* cone_edge.h - where the edge of a lamp's cone meets the model, and the lamp's own outline, as curves in space. */
#ifndef REMODEL_FIT_LIGHTS_CONE_EDGE_H
#define REMODEL_FIT_LIGHTS_CONE_EDGE_H

#include "common/gather/light_list.h"
#include "common/light/model_rays.h"

enum { CURVE_POINTS = 720 };

struct curve_point {
    struct vec3 at, normal; /* of its surface, towards the lamp; of the lamp's outline the lamp's normal */
    bool joins;             /* the curve goes on from here to the next point, the first after the last */
};

/* The rest of the points, beyond `count`, is undefined. */
struct curve {
    struct curve_point points[CURVE_POINTS];
    int count;
};

/* The first surface on a ray from a lamp's centre, and its id (ray_hit). False: none, or its back. */
bool cone_edge_ray(struct curve_point *p, const struct lamp *l, struct vec3 direction, const struct model_rays *model,
                   unsigned *face);

/* The first surfaces on rays from the lamp's centre at the angle beta from its normal, evenly around it. Points on two
 * surfaces, one of which hides the other, are not joined. Empty if beta is 90 degrees: the cone has no edge. */
void cone_edge_find(struct curve *c, const struct lamp *l, const struct model_rays *model);

void cone_outline(struct curve *c, const struct lamp *l);

#endif
