/* frame_walls.h - walls, from lines on floor and ceiling. */
#ifndef REMODEL_FRAME_WALLS_H
#define REMODEL_FRAME_WALLS_H

#include "stages/find_frame/foot_lines.h"

/* Replaces f->walls. Same walls for the same lines, whatever their order. ST_NOMEM. */
enum status walls_find(struct room_frame *f, const struct foot_lines *lines, const struct world_lines *w,
                       const int *headings, const struct camera_set *set, double size, struct err *err);

#endif
