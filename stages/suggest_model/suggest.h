/* suggest.h - a first plan of rooms from oriented points and lines of sight.
 *
 * All in the model's frame (common/model/model_axes.h); walls are along its axes. A wall's face is a peak of the positions of
 * points that look along an axis. It is cut into cells: seen (points lie on it) or seen through (lines of sight go on
 * beyond it). The outermost faces that are seen bound the plan; two faces back to back that are seen all across a box
 * cut it in two, with a wall between; what is left are rooms. Openings are where walls are seen through. */
#ifndef REMODEL_SUGGEST_H
#define REMODEL_SUGGEST_H

#include <stdbool.h>

#include "stages/suggest_model/rays.h"
#include "stages/suggest_model/suggest_params.h"

/* Of walls whose other face nobody saw, where no one told it, as a part of the ceiling's height. */
#define WALL_THICKNESS 0.06

struct plan_wall {
    int axis;          /* of its normal: 0 x, 1 y */
    double face;       /* position of its inner face */
    double thickness;  /* 0: only one face was seen */
    bool guessed;      /* the thickness of a wall between rooms that was seen from one side */
    double begin, end; /* along the other axis */
    int sides[2];      /* walls that it ends at, at begin and end */
    int inward;        /* where the inside is along the axis: +1 or -1 */
};
struct plan_opening {
    int wall;
    double begin, end, foot, top;
    bool window; /* it does not reach the floor */
};
struct plan_room {
    int walls[4]; /* south, west, north, east: -y, -x, +y, +x */
    bool free;    /* cameras or floor are in it */
};
struct suggestion { /* walls 0..3 are the outer ones: south, west, north, east */
    double ceiling;
    struct plan_wall *walls; /* all owned */
    struct plan_opening *openings;
    struct plan_room *rooms;
    int wall_count, opening_count, room_count;
};

void suggestion_release(struct suggestion *s);

/* s is empty on entry; the caller releases it. cloud and views in the model's frame; ceiling 0: the height below which nearly all points of walls lie. ST_DATA: a side
 * of the plan has no wall. */
enum status suggest_plan(struct suggestion *s, const struct point_cloud *cloud, const struct view *views,
                         int view_count, double ceiling, const struct suggest_params *params, struct err *err);

#endif
