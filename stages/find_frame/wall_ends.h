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

/* Moves an end outwards to a place, but past no wall across it. */
void wall_end_grow(struct frame_wall *w, int end, double place, const struct room_frame *f);

#endif
