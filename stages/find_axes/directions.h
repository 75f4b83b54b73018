/* directions.h - the three directions at right angles along which most of a scene's surfaces look. */
#ifndef REMODEL_DIRECTIONS_H
#define REMODEL_DIRECTIONS_H

#include "common/capture/point_cloud.h"

struct directions {
    struct mat3 axes; /* rows: unit vectors in the world, right-handed */
    double part[3];   /* of the points' normals, those within 10 degrees of the axis or its opposite */
};

/* least_part: of the points, that must look along each of two axes. ST_DATA: no point, or there are no such two. */
enum status find_directions(struct directions *d, const struct point_cloud *cloud, double least_part, struct err *err);

/* Standard errors of the turns about the axes that these normals leave, radians. origin: the middle of the scene. */
enum status direction_errors(struct vec3 *errors, const struct mat3 *axes, struct vec3 origin,
                             const struct point_cloud *cloud, struct err *err);

/* a turned by the length of w, radians, about w, in its target's axes; exactly orthogonal again. */
struct mat3 turned_by(struct mat3 a, struct vec3 w);
/* Of a symmetric matrix, where its eigenvalues tell anything; *unknown projects on the directions where they do not. */
struct mat3 inverse_of_known(struct mat3 a, struct mat3 *unknown);
/* Standard errors of least squares whose inverse information this is, from the gradients of blocks (blocks.h). */
struct vec3 sandwich(struct mat3 inverse, const struct vec3 *gradients, int count);

#endif
