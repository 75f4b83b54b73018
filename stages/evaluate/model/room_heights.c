/* room_heights.c - see room_heights.h. */
#include "stages/evaluate/model/room_heights.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static bool between(double x, double a, double b) { return x >= fmin(a, b) && x <= fmax(a, b); }

struct room_height_errors room_heights_compare(const struct measured_parts *model, const struct measured_parts *truth)
{
    struct room_height_errors e = {0};
    for (int i = 0; i < model->count; i++) {
        const struct vec3 *found = model->parts[i].at;
        const struct vec3 *room = NULL;
        for (int k = 0; k < truth->count && !room; k++) {
            const struct vec3 *at = truth->parts[k].at;
            if (between(found[0].x, at[0].x, at[1].x) && between(found[0].y, at[0].y, at[1].y)) room = at;
        }
        e.outside += !room;
        if (!room) continue;
        e.rooms++;
        e.floor = fmax(e.floor, fabs(found[0].z - room[0].z));
        e.ceiling = fmax(e.ceiling, fabs(found[1].z - room[1].z));
    }
    return e;
}
