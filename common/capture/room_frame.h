/* room_frame.h - what the straight edges of all views say of a room: which way is up, along which directions walls run,
 * how high floor and ceiling lie, and where walls stand: out/SCENE/frame/frame.txt.
 *
 * Directions and places are in the world's frame and units. A wall stands upright on the plane across . X = offset,
 * where across = up x along and `along` is one of the headings; the room lies where side (across . X - offset) > 0. */
#ifndef REMODEL_ROOM_FRAME_H
#define REMODEL_ROOM_FRAME_H

#include <stdbool.h>

#include "common/capture/sfm_model.h"

struct frame_heading {
    struct vec3 along; /* unit, level */
    double error;      /* standard error, radians */
    double share;      /* of the length of all lines */
};

struct frame_level {
    bool known;
    double height; /* up . X of its points X */
    double error;  /* standard error */
};

struct frame_wall {
    int heading;             /* index into headings: the wall runs along it */
    int side;                /* 1 or -1 */
    double offset, from, to; /* across . X of the plane; along . X of its ends */
    int support;             /* places that show its foot or its head, at the best tenth of it */
};

struct room_frame {
    bool known; /* false: the lines have no common directions; all other fields are 0 */
    struct vec3 up;
    double up_error;                /* standard error, radians, in each of two directions */
    struct frame_heading *headings; /* owned; the first two are perpendicular */
    struct frame_level floor, ceiling;
    struct frame_wall *walls; /* owned */
    int heading_count, wall_count;
};

static inline struct vec3 frame_across(const struct room_frame *f, int heading)
{
    return vec3_cross(f->up, f->headings[heading].along);
}

/* f is empty after a failure. ST_DATA: directions that are not of unit length, or not level; a heading that a wall has
 * and the file does not. */
enum status room_frame_read(struct room_frame *f, const char *path, struct provenance *prov, struct err *err);
enum status room_frame_write(const struct room_frame *f, const char *path, const struct provenance *prov,
                             struct err *err);
void room_frame_release(struct room_frame *f);

/* How much the frame counts beside what photos match, 0 .. 1: in full where the median view observes few sparse points,
 * so that its photos hardly match, and not at all where it observes many. ST_NOMEM. */
enum status room_frame_trust(double *trust, const struct sfm_model *model, struct err *err);

#endif
