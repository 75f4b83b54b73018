/* line_directions.h - the directions that the lines of all views share: up, and headings of walls. */
#ifndef REMODEL_LINE_DIRECTIONS_H
#define REMODEL_LINE_DIRECTIONS_H

#include "common/capture/room_frame.h"
#include "stages/find_frame/frame_params.h"
#include "stages/find_frame/world_lines.h"

/* Fills up, headings and their errors of f, which is empty on entry. mean_up: up as the cameras were held. f->known
 * stays false if too few lines agree. Same result for any order of threads. ST_NOMEM. */
enum status line_directions_find(struct room_frame *f, const struct world_lines *w, struct vec3 mean_up,
                                 const struct frame_params *params, struct err *err);

/* The heading that a line runs along: its index, or -1. */
int line_heading(const struct room_frame *f, const struct world_line *l);

#endif
