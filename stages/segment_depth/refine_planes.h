/* refine_planes.h - refinement of the segments' planes by local search. */
#ifndef REMODEL_REFINE_PLANES_H
#define REMODEL_REFINE_PLANES_H

#include "stages/segment_depth/plane_problem.h"

/* Lowers the energy of plane[], one plane per segment, in problem_passes() passes. Same result for any number of
 * threads. */
enum status refine_planes(struct plane *plane, const struct plane_problem *p, struct err *err);

#endif
