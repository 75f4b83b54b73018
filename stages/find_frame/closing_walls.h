/* closing_walls.h - walls that few lines show, but that close a gap between the ends of others. */
#ifndef REMODEL_CLOSING_WALLS_H
#define REMODEL_CLOSING_WALLS_H

#include "stages/find_frame/wall_grid.h"

/* Adds walls to f, which has those that more lines show. used: of world lines, whether they lie on those. ST_NOMEM. */
enum status closing_walls_add(struct room_frame *f, const struct foot_lines *lines, const bool *used,
                              const struct frame_sights *seen, double size, struct err *err);

#endif
