/* expand.h - planes of segments by local expansion moves. */
#ifndef REMODEL_EXPAND_H
#define REMODEL_EXPAND_H

#include "stages/segment_depth/plane_problem.h"

/* Lowers the energy of plane[], one plane per segment. Same result for any number of threads. */
enum status expand_planes(struct plane *plane, const struct plane_problem *p, struct err *err);

#endif
