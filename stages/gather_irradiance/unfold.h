/* unfold.h - a hemicube unfolded as a cross: its top in the middle, a side at each of its edges.
 *
 * The picture has 2 n x 2 n pixels, n even, x to the right and y down, as somebody sees it who looks along the normal
 * from the point: the top fills the n x n pixels in the middle, a side n x n / 2 beside it, and the corners are empty.
 * Directions are in the frame of that look: x right, y down, z along the normal. */
#ifndef REMODEL_UNFOLD_H
#define REMODEL_UNFOLD_H

#include <stdbool.h>

#include "common/math/vec.h"

/* The direction of a pixel's centre, not of unit length. False: the pixel is in a corner, or outside. */
bool unfold_direction(struct vec3 *direction, int n, int x, int y);

/* The pixel of a direction above the surface (z > 0, any length); each has exactly one. */
void unfold_pixel(int *x, int *y, int n, struct vec3 direction);

/* The unit right and down of the picture for a unit normal: of a wall, down is down; of a floor or a ceiling, the
 * model's y axis points to the picture's top. */
void unfold_frame(struct vec3 *right, struct vec3 *down, struct vec3 normal);

#endif
