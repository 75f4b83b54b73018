/* sky_standard.h - how the luminance of a sky varies with direction: the standard general sky of the CIE, and every
 * other sky of its form.
 *
 * Directions are unit vectors, z up. Luminances are relative: sky_luminance.h gives them a level. */
#ifndef REMODEL_SKY_STANDARD_H
#define REMODEL_SKY_STANDARD_H

#include <stdbool.h>

#include "common/math/vec.h"

/* Types of the standard's table: 1 is the overcast sky, 5 the uniform one, 12 the clear sky of standard turbidity. 16
 * is the traditional overcast sky of Moon and Spencer, three times as bright at the zenith as at the horizon. */
enum { SKY_OVERCAST = 1, SKY_UNIFORM = 5, SKY_CLEAR = 12, SKY_TYPES = 15, SKY_TRADITIONAL = 16 };

/* At an angle z from the zenith and chi from the sun: (1 + a exp(b / cos z)) (1 + c (exp(d chi) - beside) + e cos^2
 * chi), not below 0; or (1 + 2 cos z) / 3 if `traditional`. */
struct sky_shape {
    double a, b, c, d, e, beside;
    bool traditional;
};

struct sky_shape sky_standard_shape(int type);
bool sky_standard_needs_sun(int type); /* the indicatrix is not the same everywhere */

/* Relative luminance; below the horizon it is that of the horizon. */
double sky_shape_luminance(const struct sky_shape *s, struct vec3 direction, struct vec3 to_sun);
/* Luminance of a standard sky in a unit direction, not normalised. */
double sky_standard(int type, struct vec3 direction, struct vec3 to_sun);

/* The horizontal illuminance of a whole sky. */
double sky_shape_illuminance(const struct sky_shape *s, struct vec3 to_sun);

#endif
