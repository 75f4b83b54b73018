/* wall_ends.c - see wall_ends.h. */
#include "stages/find_frame/wall_ends.h"

#include <math.h>

/* as parts of the scene's size */
#define CORNER_REACH 0.25 /* beyond a wall's end, to the wall across it */
#define CORNER_BACK  0.08 /* before its end */

bool walls_cross(double *on_a, double *on_b, const struct room_frame *f, const struct frame_wall *a,
                 const struct frame_wall *b)
{
    const struct vec3 along_a = f->headings[a->heading].along, across_a = frame_across(f, a->heading),
                      along_b = f->headings[b->heading].along, across_b = frame_across(f, b->heading);
    const double turn = vec3_dot(along_a, across_b);
    if (!(fabs(turn) > 0.7)) return false;
    *on_a = (b->offset - a->offset * vec3_dot(across_a, across_b)) / turn;
    *on_b = a->offset * vec3_dot(across_a, along_b) + *on_a * vec3_dot(along_a, along_b);
    return true;
}

static double *end_of(struct frame_wall *w, int end) { return end > 0 ? &w->to : &w->from; }

void wall_end_meet(struct frame_wall *w, int end, const struct room_frame *f, double size)
{
    const double at = *end_of(w, end);
    double nearest = INFINITY, best = at;
    for (int k = 0; k < f->wall_count; k++) {
        const struct frame_wall *o = &f->walls[k];
        double meet, there;
        if (!walls_cross(&meet, &there, f, w, o)) continue;
        const double beyond = end * (meet - at);
        if (!(beyond > -CORNER_BACK * size && beyond < CORNER_REACH * size)) continue;
        if (!(there > o->from - CORNER_REACH * size && there < o->to + CORNER_REACH * size)) continue;
        if (!(fabs(beyond) < nearest)) continue;
        nearest = fabs(beyond);
        best = meet;
    }
    *end_of(w, end) = best;
}

void wall_end_grow(struct frame_wall *w, int end, double place, const struct room_frame *f)
{
    double *at = end_of(w, end);
    for (int k = 0; k < f->wall_count; k++) {
        const struct frame_wall *o = &f->walls[k];
        double here, there;
        if (walls_cross(&here, &there, f, w, o) && there > o->from && there < o->to && end * (here - *at) > 0 &&
            end * (place - here) > 0)
            place = here;
    }
    if (end * (place - *at) > 0) *at = place;
}
