/* draft_shape.h - triangles that rays are traced against: furniture and objects in the draft of an edit. The module
 * that pages run has no Embree (common/light/ray_scene.h). */
#ifndef REMODEL_BUILD_MODEL_DRAFT_SHAPE_H
#define REMODEL_BUILD_MODEL_DRAFT_SHAPE_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/math/vec.h"

struct draft_node;

/* {0} is the empty state, which no ray meets; everything is owned. */
struct draft_shape {
    struct vec3 (*triangles)[3];
    struct draft_node *nodes;
    int count, node_count;
};

/* Takes the triangles over, which malloc() gave, and builds the search tree; a failure leaves the shape empty. */
enum status draft_shape_make(struct draft_shape *s, struct vec3 (*triangles)[3], int count, struct err *err);
void draft_shape_release(struct draft_shape *s);

/* The middle of the box around it; 0 of an empty shape. */
struct vec3 draft_shape_middle(const struct draft_shape *s);
/* The nearest triangle along a ray, from either side, nearer than *at. `way` has length 1. *normal faces the ray. */
bool draft_shape_meets(const struct draft_shape *s, struct vec3 from, struct vec3 way, double *at, struct vec3 *normal);

#endif
