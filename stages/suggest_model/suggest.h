/* suggest.h - suggests a plan of rooms from oriented points and lines of sight.
 *
 * Everything is in the model's frame (common/model/model_axes.h); walls are along its axes. */
#ifndef REMODEL_SUGGEST_H
#define REMODEL_SUGGEST_H

#include <stdbool.h>

#include "stages/suggest_model/rays.h"
#include "stages/suggest_model/suggest_params.h"

/* Assumed thickness of a wall of which one face was seen, as a fraction of the ceiling's height. */
#define WALL_THICKNESS 0.06

struct suggested_wall {
    int axis;          /* of its normal: 0 x, 1 y */
    double face;       /* position of its inner face */
    double thickness;  /* 0: only one face was seen */
    bool guessed;      /* a wall between rooms that was seen from one side: its thickness is assumed */
    double begin, end; /* along the other axis */
    int sides[2];      /* walls that it meets at begin and end; -1: an outer wall */
    int inward;        /* direction of its inside along the axis: +1 or -1 */
};
struct suggested_opening {
    int wall;
    double begin, end, foot, top;
    bool window; /* does not reach the floor */
};
struct suggested_room {
    int walls[4]; /* south, west, north, east: -y, -x, +y, +x */
    bool free;    /* contains cameras or floor */
};
struct suggestion { /* walls 0..3 are the outer ones: south, west, north, east */
    double ceiling;
    struct suggested_wall *walls; /* all owned */
    struct suggested_opening *openings;
    struct suggested_room *rooms;
    int wall_count, opening_count, room_count;
};

void suggest_release(struct suggestion *s);

/* s is empty on entry, and again after a failure; the caller releases it. cloud and views are in the model's frame;
 * ceiling 0: unknown, estimated from the points of walls. ST_DATA: there is no wall on a side of the plan. */
enum status suggest_plan(struct suggestion *s, const struct point_cloud *cloud, const struct view *views,
                         int view_count, double ceiling, const struct suggest_params *params, struct err *err);

#endif
