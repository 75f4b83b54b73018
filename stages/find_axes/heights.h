/* heights.h - the height of the floor, the level with the most upward normals, and of the ceiling, the highest level
 * with many downward normals. */
#ifndef REMODEL_HEIGHTS_H
#define REMODEL_HEIGHTS_H

#include "stages/find_axes/axes_params.h"
#include "stages/find_axes/planes.h"

struct height_level {
    double height;     /* above the origin, along axis z */
    double spread;     /* standard deviation of its points, robust */
    double error;      /* standard error of the height */
    size_t count;      /* number of its points; 0: there is no such level */
    size_t candidates; /* points with that normal, below (above) the origin */
    size_t beyond;     /* candidates clearly below the floor, or above the ceiling */
    bool of_edges;     /* straight edges show the level, not points */
};

/* axes: rows in the world, z up; origin: a camera's centre, above the floor and below the ceiling. side: 1 floor, -1
 * ceiling. tilt_error: standard errors of the rotations about x and y, radians. */
enum status height_find_level(struct height_level *level, int side, const struct mat3 *axes, struct vec3 origin,
                              struct vec3 tilt_error, const struct point_cloud *cloud, const struct axes_params *params,
                              struct err *err);

#endif
