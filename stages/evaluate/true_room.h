/* true_room.h - where the rooms of a truth stand: z up, walls along x and y; floor and ceiling.
 *
 * TRUTH/scene.txt, a described scene (docs/scenes.md): its world is the truth's, and its lines
 *   room NAME X0 Y0 X1 Y1 Z0 Z1 ...
 * say how high floors (Z0) and ceilings (Z1) are; or TRUTH/scene-truth.txt, whose rooms stand in a frame of their own,
 * world = turn about z by yaw * room + t:
 *   yaw_degrees YAW
 *   t X Y Z
 *   NAME X0 Y0 Z0 X1 Y1 Z1              a room: a line of a name and six numbers
 * Other lines of either are left to who understands them. All rooms must have one floor and one ceiling: what is
 * compared is one room's. */
#ifndef REMODEL_TRUE_ROOM_H
#define REMODEL_TRUE_ROOM_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct true_room {
    bool known;  /* the truth has one of the files, with a room in it */
    bool framed; /* it is scene-truth.txt */
    struct mat3 room_from_world;
    struct vec3 origin; /* of the room's frame, in the world */
    double floor, ceiling;
};

/* No such file is no error. Adds what it reads to prov. ST_DATA with file and line: rooms without height, or that
 * differ in it. */
enum status true_room_read(struct true_room *room, const char *folder, struct provenance *prov, struct err *err);

/* One file of either kind; frame: it is a scene-truth.txt. */
enum status true_room_read_file(struct true_room *room, const char *path, bool frame, struct err *err);

#endif
