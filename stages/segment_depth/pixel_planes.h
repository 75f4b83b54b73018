/* pixel_planes.h - the segment whose plane each pixel lies on: depth finer than segments. */
#ifndef REMODEL_PIXEL_PLANES_H
#define REMODEL_PIXEL_PLANES_H

#include "stages/segment_depth/plane_problem.h"

/* Chooses for each pixel among the planes of its own segment and of those around it. label: w * h, the segment that
 * each pixel belongs to from now on; -1 where the view has no pixel. A segment may lose all of its pixels. Pixels of
 * segments whose depth is given keep it. Same result for any number of threads. ST_NOMEM. */
enum status pixel_planes_choose(int *label, const struct plane *planes, const struct plane_problem *p, struct err *err);

#endif
