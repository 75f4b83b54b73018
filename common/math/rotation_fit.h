/* rotation_fit.h - least squares of small rotations, and their standard errors. */
#ifndef REMODEL_ROTATION_FIT_H
#define REMODEL_ROTATION_FIT_H

#include "common/math/vec.h"

/* a rotated by the length of w, radians, about w, in its target's frame, and orthogonalized. */
struct mat3 rotation_turn(struct mat3 a, struct vec3 w);
/* Pseudo-inverse of a symmetric matrix; *unknown: projection to the directions of negligible eigenvalues. */
struct mat3 rotation_inverse_of_known(struct mat3 a, struct mat3 *unknown);
/* Standard errors of least squares: the sandwich estimator, from the inverse information and the gradients of groups of
 * observations whose errors go together. */
struct vec3 rotation_sandwich(struct mat3 inverse, const struct vec3 *gradients, int count);

#endif
