/* room_parts.h - convex polygons in plan: the parts of a room's outline, cuts along lines, remainders. */
#ifndef REMODEL_BUILD_MODEL_ROOM_PARTS_H
#define REMODEL_BUILD_MODEL_ROOM_PARTS_H

#include "stages/build_model/plan/plan.h"

#define PART_EPS 2e-6 /* a corner closer than this to a line is on it: two steps of the solids' lattice */

/* Cuts the outline of the room's slabs, whose edges must be known, into room->parts. ST_NOMEM. */
enum status room_parts_make(struct plan_room *room, const struct plan *plan, struct err *err);
void room_parts_release(struct plan_room *room);

/* The part of a convex polygon where n p <= c of the line; the new side has the line and the label of `by`, whose p is
 * not used. out has room for count + 1 corners. Returns their number; 0: nothing is left. */
int part_clip(struct part_corner *out, const struct part_corner *in, int count, const struct part_corner *by);

/* Called for each polygon; a status other than ST_OK ends the walk and is returned. */
typedef enum status part_visit(void *ctx, const struct part_corner *c, int count);

/* Visits convex polygons that make up the polygon where it is in none of the parts. Sides along the parts have the
 * labels of the parts' sides. */
enum status parts_outside(const struct part_corner *in, int count, const struct room_part *parts, int part_count,
                          part_visit *visit, void *ctx, struct err *err);

#endif
