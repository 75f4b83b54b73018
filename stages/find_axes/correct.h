/* correct.h - axes turned so that they follow the edges that a user marked at corners of the floor. */
#ifndef REMODEL_CORRECT_H
#define REMODEL_CORRECT_H

#include "stages/find_axes/marks.h"

struct correction {
    int edges;   /* that were marked */
    double turn; /* by which the axes were turned, radians; 0: the edges agree with them as well as marks can tell */
};

/* axes: rows in the world, z up. *errors: standard errors of the turns about them, radians; where the edges that turn
 * them tell more, they become theirs. click: standard error of the marks, px. ST_DATA with file and line: an edge
 * without length, or that follows none of the axes. */
enum status correct_axes(struct mat3 *axes, struct vec3 *errors, struct correction *c, const struct mark_list *fix,
                         const struct mark_scene *scene, double click, struct err *err);

#endif
