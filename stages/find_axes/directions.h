/* directions.h - the three orthogonal directions of most of a scene's normals. */
#ifndef REMODEL_DIRECTIONS_H
#define REMODEL_DIRECTIONS_H

#include "common/capture/point_cloud.h"

struct directions {
    struct mat3 axes; /* rows: unit vectors in the world, right-handed */
    double part[3];   /* fraction of the normals within 10 degrees of the axis or its opposite */
};

/* min_part: fraction of the points that two of the axes must have. ST_DATA: there are no points, or no two axes. */
enum status directions_find(struct directions *d, const struct point_cloud *cloud, double min_part, struct err *err);

/* Sets d->part of given axes; 0 without points. */
void directions_count(struct directions *d, const struct point_cloud *cloud);

/* Standard errors of the rotations about the axes, from the normals, radians. origin: the middle of the scene. */
enum status direction_errors(struct vec3 *errors, const struct mat3 *axes, struct vec3 origin,
                             const struct point_cloud *cloud, struct err *err);

#endif
