/* wall_top.h - the upper edge of a wall along its line, where ceilings beside it slope or differ in height. */
#ifndef REMODEL_EXPORT_WALL_TOP_H
#define REMODEL_EXPORT_WALL_TOP_H

#include "common/model/model_plan.h"

/* *top: S and z of the corners of the upper edge of a wall along an axis, from low to high S, over reach[0] to
 * reach[1]. *count 0: the edge is level, at the wall's `top`. The caller frees *top. ST_NOMEM. */
enum status wall_top_find(double (**top)[2], int *count, const struct model_plan *plan, int wall, const double reach[2],
                          struct err *err);

#endif
