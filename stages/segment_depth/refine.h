/* refine.h - from a label a segment to a plane a segment. */
#ifndef REMODEL_REFINE_H
#define REMODEL_REFINE_H

#include "stages/segment_depth/plane_problem.h"

/* Improves plane[] (on entry: constant 1/z) in passes: a segment tries its neighbours' planes, a plane fitted to those that
 * look alike and agree in depth, a constant depth, and small changes, and keeps what has the least energy: matching cost,
 * sparse points (which hold the depth range too), borders that meet, and a price for being slanted.
 * The same for any number of threads. */
enum status refine_planes(struct plane *plane, const struct plane_problem *p, struct err *err);

#endif
