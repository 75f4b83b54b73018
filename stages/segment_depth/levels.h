/* levels.h - table tops, seats and other level surfaces that stand before the solid model, found by what they match. */
#ifndef REMODEL_LEVELS_H
#define REMODEL_LEVELS_H

#include "stages/segment_depth/plane_problem.h"

/* Moves segments that match far better on a level plane above the floor than on their plane and on their face to it.
 * All arrays: of each segment; distinct: how distinctly it matches, 0 .. 1; found: set where a plane was. Nothing is
 * found if the view is expected to see no floor. Same result for any number of threads. ST_NOMEM. */
enum status levels_find(struct plane *planes, double *distinct, struct plane *found, const struct plane_problem *p,
                        struct err *err);

/* The largest inverse depth that furniture in a room may have, by the height of the camera above the floor; 0: the view
 * is expected to see no floor. */
double levels_nearest(const struct plane_problem *p);

#endif
