/* open_walls.h - walls that few places show, and that cameras behind them look through. */
#ifndef REMODEL_OPEN_WALLS_H
#define REMODEL_OPEN_WALLS_H

#include "stages/find_frame/wall_grid.h"

/* Cuts out of the walls of f what is open in them, and drops those of which too little is left. sights: `points` of
 * sparse points, in order of the points. ST_NOMEM. */
enum status open_walls_cut(struct room_frame *f, const struct frame_sights *sights, int points, double size,
                           struct err *err);

#endif
