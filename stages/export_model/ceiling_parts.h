/* ceiling_parts.h - the parts of a room's outline over which each plane of its ceiling is the lower one. */
#ifndef REMODEL_EXPORT_CEILING_PARTS_H
#define REMODEL_EXPORT_CEILING_PARTS_H

#include "common/model/model_plan.h"

/* {0} is the empty state. */
struct ceiling_parts {
    double (*outline)[2]; /* the room's, counter-clockwise, with corners where the ridge crosses it; owned */
    int outline_count;
    double (*corners[2])[2]; /* of the part under each plane, counter-clockwise; owned */
    int counts[2];           /* 0: the plane is nowhere the lower one */
};

enum status ceiling_parts_make(struct ceiling_parts *parts, const struct model_room *room, struct err *err);
void ceiling_parts_release(struct ceiling_parts *parts);

#endif
