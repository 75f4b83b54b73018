/* furniture_sweep.h - tables, seats and fronts of furniture before the faces of the solid model, by what they match. */
#ifndef REMODEL_FURNITURE_SWEEP_H
#define REMODEL_FURNITURE_SWEEP_H

#include "stages/segment_depth/plane_problem.h"

/* Moves segments that match far better on a plane before their face, parallel to the floor or to a wall, than on their
 * plane and on their face. All arrays: of each segment; distinct: how distinctly it matches, 0 .. 1; found, all zero
 * on entry: the planes of those that were moved; largest: those of the largest surfaces. p->prior: the faces. Nothing
 * is found if the view is expected to see no floor. Same result for any number of threads. ST_NOMEM. */
enum status furniture_sweep_find(struct plane *planes, double *distinct, struct plane *found,
                                 struct furniture_planes *largest, const struct plane_problem *p, struct err *err);

/* The same of segments that took one of p->furniture since, and match better there than on their face. planes: of the
 * problem's solution. */
void furniture_sweep_extend(double *distinct, struct plane *found, const struct plane *planes,
                            const struct plane_problem *p);

/* The largest inverse depth that furniture in a room may have, by the height of the camera above the floor; 0: the view
 * is expected to see no floor. */
double furniture_sweep_nearest(const struct plane_problem *p);

#endif
