/* room_heights.h - errors of the floors and ceilings of a model's rooms. */
#ifndef REMODEL_ROOM_HEIGHTS_H
#define REMODEL_ROOM_HEIGHTS_H

#include "stages/evaluate/truth/wall_plan.h"

struct room_height_errors {
    double floor, ceiling; /* maximum over the rooms */
    int rooms;             /* compared */
    int outside;           /* rooms of the model whose middle is in no true room */
};

/* Both lists are in one frame (measured_plan.rooms). A room of the model is compared with the first true room that its
 * middle lies in, at that point. */
struct room_height_errors room_heights_compare(const struct measured_parts *model, const struct measured_parts *truth);

#endif
