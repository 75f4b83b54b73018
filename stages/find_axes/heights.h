/* heights.h - the height of the floor: the level on which most points that look up lie; and that of the ceiling, the
 * highest level with a good part of the points that look down. */
#ifndef REMODEL_HEIGHTS_H
#define REMODEL_HEIGHTS_H

#include "stages/find_axes/axes_params.h"
#include "stages/find_axes/planes.h"

struct level {
    double height; /* above the origin, along axis z */
    double spread; /* standard deviation of its points, robust */
    double error;  /* standard error of the height */
    size_t count;  /* of its points; 0: there is none */
    size_t asked;  /* points that look that way, below (above) the origin */
    size_t beyond; /* of them, those clearly below the floor, or above the ceiling */
};

/* axes: rows in the world, z up; origin: among the cameras, below which the floor is, and above which the ceiling is.
 * side: 1 floor, -1 ceiling. tilt_error: of turns about x and y, radians. */
enum status find_level(struct level *level, int side, const struct mat3 *axes, struct vec3 origin,
                       struct vec3 tilt_error, const struct point_cloud *cloud, const struct axes_params *params,
                       struct err *err);

#endif
