/* frame_room.c - floor, ceiling and walls of a room.
 *
 * The floor on which lines agree must carry a wall: lower edges of posters and tables are at one height, too. If none
 * stands on it, the floor is where the sparse points end. */
#include "stages/find_frame/frame_room.h"

#include <stdlib.h>

#include "stages/find_frame/frame_levels.h"
#include "stages/find_frame/frame_walls.h"
#include "stages/find_frame/line_directions.h"

#define REACH 3.0 /* of the scene's size: farthest line on floor or ceiling */

/* The walls that stand on a floor, if it is known. lines: those at its height. */
static enum status walls_on_floor(struct foot_lines *lines, struct room_frame *f, const struct world_lines *w,
                                  const int *headings, const struct camera_set *set, double size, struct err *err)
{
    if (f->floor.known && !foot_lines_add(lines, w, headings, f, set, f->floor.height, false, REACH * size, err))
        walls_find(f, lines, w, headings, set, size, err);
    return err->status;
}

enum status frame_room_find(struct room_frame *f, const struct world_lines *w, const struct camera_set *set,
                            double size, struct err *err)
{
    int *headings = malloc(((size_t)w->count + 1) * sizeof *headings);
    struct foot_lines lines = {0};
    if (!headings) return err_nomem(err, "headings of lines", (size_t)w->count * sizeof *headings);
    for (int i = 0; i < w->count; i++) headings[i] = line_heading(f, &w->lines[i]);
    if (!levels_floor_of_lines(f, w, headings, set, size, err)) walls_on_floor(&lines, f, w, headings, set, size, err);
    if (!err->status && !f->wall_count) {
        foot_lines_release(&lines);
        if (!levels_floor_of_points(f, set, size, err)) walls_on_floor(&lines, f, w, headings, set, size, err);
    }
    if (!err->status && f->floor.known && !levels_find_ceiling(f, w, headings, set, size, err) && f->ceiling.known &&
        !foot_lines_add(&lines, w, headings, f, set, f->ceiling.height, true, REACH * size, err))
        walls_find(f, &lines, w, headings, set, size, err);
    foot_lines_release(&lines);
    free(headings);
    return err->status;
}
