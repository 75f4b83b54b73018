/* correct.h - axes turned so that they follow the edges that a user marked at corners of the floor. */
#ifndef REMODEL_CORRECT_H
#define REMODEL_CORRECT_H

#include "stages/find_axes/marks.h"

/* axes: rows in the world, z up. *errors: standard errors of the turns about them, radians; where the edges tell more,
 * they become theirs. *turn: by how much the axes were turned, radians. click: standard error of the marks, px.
 * ST_DATA with file and line: an edge without length, or that follows none of the axes. */
enum status correct_axes(struct mat3 *axes, struct vec3 *errors, double *turn, const struct mark_list *fix,
                         const struct mark_scene *scene, double click, struct err *err);

#endif
