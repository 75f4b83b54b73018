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

bool wall_end_reaches(const struct frame_wall *w, int end, double place, double size)
{
    const double beyond = end * (place - (end > 0 ? w->to : w->from));
    return beyond > -CORNER_BACK * size && beyond < CORNER_REACH * size;
}

bool walls_make_corner(const struct room_frame *f, const struct frame_wall *a, int end_a, const struct frame_wall *b,
                       int end_b)
{
    /* whether each lies on the side from which the other is seen; seen from around the corner, neither does */
    const double a_of_b = -end_a * b->side * vec3_dot(f->headings[a->heading].along, frame_across(f, b->heading)),
                 b_of_a = -end_b * a->side * vec3_dot(f->headings[b->heading].along, frame_across(f, a->heading));
    return (a_of_b > 0) == (b_of_a > 0);
}

bool wall_end_is_loose(const struct room_frame *f, int wall, int end, double size)
{
    const struct frame_wall *w = &f->walls[wall];
    for (int k = 0; k < f->wall_count; k++) {
        const struct frame_wall *o = &f->walls[k];
        double here, there;
        if (!walls_cross(&here, &there, f, w, o) || !wall_end_reaches(w, end, here, size)) continue;
        if (there > o->from + CORNER_REACH * size && there < o->to - CORNER_REACH * size) return false;
        for (int e = -1; e <= 1; e += 2)
            if (wall_end_reaches(o, e, there, size) && walls_make_corner(f, w, end, o, e)) return false;
    }
    return true;
}

void wall_end_meet(struct frame_wall *w, int end, const struct room_frame *f, double size)
{
    const double at = *end_of(w, end);
    double nearest = INFINITY, best = at;
    for (int k = 0; k < f->wall_count; k++) {
        const struct frame_wall *o = &f->walls[k];
        double meet, there;
        if (!walls_cross(&meet, &there, f, w, o)) continue;
        const double beyond = fabs(meet - at);
        if (!wall_end_reaches(w, end, meet, size)) continue;
        if (!(there > o->from - CORNER_REACH * size && there < o->to + CORNER_REACH * size)) continue;
        if (!(beyond < nearest)) continue;
        nearest = beyond;
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
