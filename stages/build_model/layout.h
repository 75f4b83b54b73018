/* layout.h - a plan as convex solids: walls cut at their openings, floors and ceilings, boxes, leaves, panes.
 *
 * Names of faces (docs/formats.md): wall/W/in out start end top bottom; KIND/O/left right sill head, the reveals of
 * a door, passage or window, left and right as one sees them from the wall's inside, door/O/leaf-in leaf-out;
 * glass/O/in out left right sill head, a body of its own; floor/R, floor/R/bottom, ceiling/R, ceiling/R/top, and
 * their sides floor/R/side; box/B/left right front back bottom top. Everything but glass is of the body "walls". */
#ifndef REMODEL_BUILD_MODEL_LAYOUT_H
#define REMODEL_BUILD_MODEL_LAYOUT_H

#include "stages/build_model/plan.h"
#include "stages/build_model/solid.h"

/* list is empty on entry; the caller releases it. The plan is checked. */
enum status layout_solids(struct solid_list *list, const struct plan *plan, struct err *err);

/* Does glass stand in the window (not in an interior one), and by which face of its wall. */
bool window_has_glass(const struct plan *plan, const struct plan_opening *o, int *side);

#endif
