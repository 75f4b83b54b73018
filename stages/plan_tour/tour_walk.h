/* tour_walk.h - a walk around what an edit changed. */
#ifndef REMODEL_TOUR_WALK_H
#define REMODEL_TOUR_WALK_H

#include "common/light/model_rays.h"
#include "stages/plan_tour/tour_changes.h"
#include "stages/plan_tour/tour_graph.h"

/* The stops of a walk around the largest changes, with the eyes on them, 20 to 30 seconds in all where the photographs
 * leave room for that. *stops is malloc'ed; *count 0: too few viewpoints see a change. ST_NOMEM. */
enum status tour_walk_find(struct tour_stop **stops, int *count, const struct tour_graph *g,
                           const struct model_rays *model, const struct model_plan *plan,
                           const struct tour_change *changes, int change_count, double speed, struct err *err);

#endif
