/* correct.h - rotates the axes to follow the edges that a user marked at corners of the floor. */
#ifndef REMODEL_CORRECT_H
#define REMODEL_CORRECT_H

#include "stages/find_axes/marks.h"

struct correction {
    int edges;   /* number of marked edges */
    double turn; /* of the axes, radians; 0: the axes agree with the edges within the marks' errors */
};

/* axes: rows in the world, z up. *errors: standard errors of the rotations about them, radians; lowered where corrected
 * axes have smaller errors. click: standard error of the marks, px. ST_DATA with file and line: an edge without length,
 * or not along any of the axes. */
enum status correct_axes(struct mat3 *axes, struct vec3 *errors, struct correction *c, const struct mark_list *fix,
                         const struct mark_scene *scene, double click, struct err *err);

/* The normal of the plane through the camera that a marked edge lies in. ST_DATA with file and line. */
enum status correct_edge_plane(struct vec3 *normal, const struct mark *edge, const struct mark_list *fix,
                               const struct mark_scene *scene, struct err *err);

#endif
