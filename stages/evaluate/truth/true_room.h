/* true_room.h - the frame of a truth's rooms (z up, walls along x and y), and the height of their floor and ceiling.
 *
 * The source is TRUTH/scene.txt, a described scene (docs/scenes.md), whose rooms are in the truth's world; floors
 * are Z0 and ceilings Z1 of its lines
 *   room NAME X0 Y0 X1 Y1 Z0 Z1 ...
 * or TRUTH/scene-truth.txt, whose rooms have a frame of their own, world = rotation about z by yaw * room + t:
 *   yaw_degrees YAW
 *   t X Y Z
 *   NAME X0 Y0 Z0 X1 Y1 Z1              a room: a line of a name and six numbers
 * Other lines are ignored. Rooms may have different floors and ceilings. */
#ifndef REMODEL_TRUE_ROOM_H
#define REMODEL_TRUE_ROOM_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct true_heights {
    double floor, ceiling;
};

struct true_room {
    bool known;  /* one of the files exists and has a room */
    bool framed; /* the file is scene-truth.txt */
    struct mat3 room_from_world;
    struct vec3 origin;           /* of the room's frame, in the world */
    struct true_heights *heights; /* of the rooms, each pair once; owned */
    int count;
};

/* `known` is false if neither file exists. Adds the file it reads to prov. ST_DATA with file and line: a damaged
 * line, or a room without height. The caller releases the room. */
enum status true_room_read(struct true_room *room, const char *folder, struct provenance *prov, struct err *err);

/* Reads one file; frame: it is a scene-truth.txt. */
enum status true_room_read_file(struct true_room *room, const char *path, bool frame, struct err *err);
void true_room_release(struct true_room *room);

#endif
