/* patch_values.h - values of patches at any point of a face, between the middles of its patches. */
#ifndef REMODEL_PATCH_VALUES_H
#define REMODEL_PATCH_VALUES_H

#include "stages/light_levels/patches.h"

/* Bilinear between the middles of the four cells around the point, constant beyond the outermost ones; a cell without
 * a patch has the value of the nearest one. NAN: the face has no patches. */
double patch_values_at(const struct light_patches *p, const double *values, int face, struct vec3 at);

#endif
