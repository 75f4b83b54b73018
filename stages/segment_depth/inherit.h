/* inherit.h - depth of border areas that no evidence holds apart from their surroundings. */
#ifndef REMODEL_INHERIT_H
#define REMODEL_INHERIT_H

#include "stages/segment_depth/plane_problem.h"

/* Replaces planes, and sets inherited[i] for the segments concerned. confidence: of each segment's plane.
 * cautious: another round follows; only areas that hardly touch any foreground move back, and none comes forward.
 * ST_NOMEM. */
enum status inherit_planes(struct plane *planes, bool *inherited, const double *confidence,
                           const struct plane_problem *p, bool cautious, struct err *err);

#endif
