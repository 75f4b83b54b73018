/* frame_levels.h - heights of floor and ceiling, from lines and sparse points. */
#ifndef REMODEL_FRAME_LEVELS_H
#define REMODEL_FRAME_LEVELS_H

#include "stages/find_frame/foot_lines.h"

/* Sets f->floor, known if lines of different places agree on one. headings: of each line, or -1. size:
 * world_lines_size(). */
enum status levels_floor_of_lines(struct room_frame *f, const struct world_lines *w, const int *headings,
                                  const struct camera_set *set, double size, struct err *err);
/* Sets f->floor, known if many sparse points end at one height, of which photos show what lies below. */
enum status levels_floor_of_points(struct room_frame *f, const struct camera_set *set, double size, struct err *err);
/* Sets f->ceiling, from lines above the walls whose feet are known. */
enum status levels_find_ceiling(struct room_frame *f, const struct world_lines *w, const int *headings,
                                const struct camera_set *set, double size, struct err *err);

#endif
