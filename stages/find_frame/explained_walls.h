/* explained_walls.h - walls of which all lines may lie on another wall in front of them.
 *
 * A line on a wall above its foot, such as a sill, is cast behind it, and that of two places falls on each other where
 * both stand equally far from the wall. */
#ifndef REMODEL_EXPLAINED_WALLS_H
#define REMODEL_EXPLAINED_WALLS_H

#include "stages/find_frame/foot_lines.h"

/* Drops walls of f whose lines may lie on others, but for those that are sure; the others may grow. ST_NOMEM. */
enum status explained_walls_drop(struct room_frame *f, const bool *sure, const struct foot_lines *lines, double size,
                                 struct err *err);

#endif
