/* tour_changes.h - the places that an edit changed, one for each room. */
#ifndef REMODEL_TOUR_CHANGES_H
#define REMODEL_TOUR_CHANGES_H

#include "common/model/model_plan.h"
#include "common/model/thing_list.h"
#include "common/texture/texture_map.h"

enum { TOUR_PARTS = 8 };

struct tour_change {
    int room;          /* index into the plan's rooms */
    struct vec3 place; /* the middle of what changed there, model frame */
    double weight;     /* how much: square model units */
    /* Places a little before the largest faces that changed, by which one sees the change: the middle of a new box or
     * wall is inside it. The largest first; none: only the middle counts. */
    struct vec3 parts[TOUR_PARTS];
    double part_weights[TOUR_PARTS];
    int part_count;
};

/* *changes: malloc'ed, the largest first. things (may be NULL): where the things of the map are. ST_NOMEM. */
enum status tour_changes_find(struct tour_change **changes, int *count, const struct texture_map *map,
                              const struct thing_list *things, const struct model_plan *plan, struct err *err);

#endif
