/* frame_levels.h - heights of floor and ceiling, from lines. */
#ifndef REMODEL_FRAME_LEVELS_H
#define REMODEL_FRAME_LEVELS_H

#include "stages/find_frame/foot_lines.h"

/* Sets f->floor, known if lines of different places agree on one. headings: of each line, or -1. size:
 * world_lines_size(). */
enum status levels_floor_of_lines(struct room_frame *f, const struct world_lines *w, const int *headings,
                                  const struct camera_set *set, double size, struct err *err);
/* Sets f->floor, known if the sparse points end at one height at once, but not at the photos' lower edge. */
enum status levels_floor_of_points(struct room_frame *f, const struct camera_set *set, double size, struct err *err);
/* Sets f->ceiling, from lines above the walls whose feet are known. */
enum status levels_find_ceiling(struct room_frame *f, const struct world_lines *w, const int *headings,
                                const struct camera_set *set, double size, struct err *err);

#endif
