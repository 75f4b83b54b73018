/* frame_room.h - floor, ceiling and walls of a room, from its straight edges. */
#ifndef REMODEL_FRAME_ROOM_H
#define REMODEL_FRAME_ROOM_H

#include "stages/find_frame/world_lines.h"

/* Sets floor, ceiling and walls of f, whose directions are known. size: world_lines_size(). */
enum status frame_room_find(struct room_frame *f, const struct world_lines *w, const struct camera_set *set,
                            double size, struct err *err);

#endif
