/* ortho.h - orthogonal tiles of a VITA: their axes and matrices. */
#ifndef REMODEL_ORTHO_H
#define REMODEL_ORTHO_H

#include <stdbool.h>

#include "common/math/vec.h"

/* Right and down on a surface as one who faces it sees them: on a wall, down is towards the floor. Unit vectors. */
void ortho_axes(struct vec3 *right, struct vec3 *down, struct vec3 normal);

/* The matrix of a tile (atlas.h) whose pixel (0, 0) is at right left + down top, with texels of this side. */
void ortho_matrix(double matrix[3][4], struct vec3 right, struct vec3 down, double side, double left, double top);
/* The point of a plane that a pixel shows. */
struct vec3 ortho_point(const double matrix[3][4], double x, double y, struct vec3 normal, double offset);
/* Whether a tile looks along a normal. */
bool ortho_sees(const double matrix[3][4], struct vec3 normal);

#endif
