/* foot_lines.h - where lines lie on a plan of the room if they are on its floor, or on its ceiling. */
#ifndef REMODEL_FOOT_LINES_H
#define REMODEL_FOOT_LINES_H

#include "common/capture/room_frame.h"
#include "stages/find_frame/world_lines.h"

/* A line on the plan: the foot or the head of what stands upright on it. */
struct foot_line {
    int line; /* index into the world's lines */
    int heading, station;
    bool head;               /* on the ceiling, not on the floor */
    double offset, from, to; /* of frame_wall, from < to */
    double eye, eye_place;   /* of the camera: offset, and place along the heading */
};

struct foot_lines {
    struct foot_line *lines; /* owned */
    int count;
};

/* Adds the lines of headings that may lie on a level plane of this height, below the cameras that see them, or above
 * (head). reach: farthest distance from the camera. */
enum status foot_lines_add(struct foot_lines *f, const struct world_lines *w, const int *headings,
                           const struct room_frame *frame, const struct camera_set *set, double height, bool head,
                           double reach, struct err *err);
void foot_lines_release(struct foot_lines *f);

/* How well lines of different stations fall on each other: the number of pairs of stations that share a cell of the
 * plan. unit: width of a cell across the lines. */
enum status foot_lines_pairs(double *pairs, const struct foot_lines *f, double unit, struct err *err);

#endif
