/* layout.h - lays out a plan as convex solids: walls cut at their openings, floors and ceilings, boxes, leaves, panes.
 *
 * Names of faces (docs/formats.md): wall/W/in out start end top bottom; KIND/O/left right sill head, the reveals of
 * a door, passage or window, left and right as seen from the wall's inside, and KIND/O/leaf-in leaf-out;
 * glass/O/in out left right sill head, a separate body; KIND/O/left right front back, the reveals of a skylight or
 * hatch, and its leaf-in leaf-out; glass/O/in out left right front back; floor/R, floor/R/bottom, ceiling/R,
 * ceiling/R/top, and their sides floor/R/side; box/B/left right front back bottom top. Everything except glass belongs
 * to the body "walls". */
#ifndef REMODEL_BUILD_MODEL_LAYOUT_H
#define REMODEL_BUILD_MODEL_LAYOUT_H

#include "stages/build_model/plan/plan.h"
#include "stages/build_model/solid/solid.h"

/* list is empty on entry, and again after a failure; the caller releases it. The plan must have been checked. */
enum status layout_solids(struct solid_list *list, const struct plan *plan, struct err *err);

/* Whether a leaf or glass is in the opening, and where: from off[0] to off[1] behind the wall's in face. A window's
 * glass is flush with the outer face; a window between rooms and an interior one have none, unless they were filled. */
bool layout_opening_filling(const struct plan *plan, const struct plan_opening *o, double off[2]);

#endif
