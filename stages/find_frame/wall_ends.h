/* wall_ends.h - where walls of a frame end, and meet.
 *
 * An end is 1: `to`, or -1: `from`. */
#ifndef REMODEL_WALL_ENDS_H
#define REMODEL_WALL_ENDS_H

#include "common/capture/room_frame.h"

/* Where the planes of two walls cross: places along the one and along the other. False: they are nearly parallel. */
bool walls_cross(double *on_a, double *on_b, const struct room_frame *f, const struct frame_wall *a,
                 const struct frame_wall *b);

/* Moves an end to the wall across it that is nearest, if one is near. */
void wall_end_meet(struct frame_wall *w, int end, const struct room_frame *f, double size);

/* Whether the end may be moved to a place along the wall. */
bool wall_end_reaches(const struct frame_wall *w, int end, double place, double size);

/* Whether two walls, where they end, bound one room at a corner, seen from inside or around it. */
bool walls_make_corner(const struct room_frame *f, const struct frame_wall *a, int end_a, const struct frame_wall *b,
                       int end_b);

/* Whether no other wall passes or makes a corner where a wall ends: the outline of the room has a gap there. */
bool wall_end_is_loose(const struct room_frame *f, int wall, int end, double size);

/* Moves an end outwards to a place, but past no wall across it. */
void wall_end_grow(struct frame_wall *w, int end, double place, const struct room_frame *f);

#endif
