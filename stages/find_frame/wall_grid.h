/* wall_grid.h - a grid of the plan: which places show a line in which cell, and who sees through it.
 *
 * Rows run along a heading. A place (station) that shows a line at the floor and at the ceiling counts twice. */
#ifndef REMODEL_WALL_GRID_H
#define REMODEL_WALL_GRID_H

#include <stdint.h>

#include "stages/find_frame/foot_lines.h"

/* as parts of the scene's size */
#define WALL_ROW      0.008 /* width of a cell across the lines */
#define WALL_CELL     0.07  /* its length */
#define WALL_SHORTEST 0.14  /* length of a wall */

#define WALL_HEADS 0xaaaaaaaaaaaaaaaau /* the bits of lines on the ceiling; the others: on the floor */

/* The stations that see through a cell of a row: below the height of windows, and at any height below the ceiling. */
struct seen_through {
    uint64_t low, any;
};

struct wall_grid {
    double from, low; /* along and across, of cell 0 */
    int across, along;
    uint64_t *seen;               /* owned; of each cell: a bit for each station and level */
    struct seen_through *through; /* owned; of the cells of the row that was marked last */
};

/* What a view sees: a place, from that of the view. */
struct frame_sight {
    int station;
    struct vec3 eye, place;
};

struct frame_sights {
    struct frame_sight *list; /* owned */
    int count;
};

/* 1 or -1: the side of a line on which its camera is. */
static inline int foot_line_side(const struct foot_line *l) { return l->eye > l->offset ? 1 : -1; }

/* Counts the lines of a heading that are seen from a side, but for those that are used (by world line); without any,
 * seen is NULL. grid: empty; the caller releases it. ST_NOMEM. */
enum status wall_grid_fill(struct wall_grid *g, const struct foot_lines *lines, const bool *used, int heading, int side,
                           double size, struct err *err);
void wall_grid_release(struct wall_grid *g);

/* Marks the cells of a row that places see through. */
void wall_grid_mark_through(struct wall_grid *g, int row, int heading, int side, const struct room_frame *f,
                            const struct frame_sights *sights, double size);

/* The places and levels that show cell k of a row and of the two beside it. marked: none if two places see through it,
 * which is known of the row that was marked last. */
uint64_t wall_grid_shown(const struct wall_grid *g, bool marked, int row, int k);

/* Adds a sight from a view to a place. */
enum status frame_sights_add(struct frame_sights *s, int station, struct vec3 eye, struct vec3 place, struct err *err);
/* Adds the views' sights of the sparse points. stations: of each view, -1 if it has no line. */
enum status frame_sights_of_points(struct frame_sights *s, const int *stations, const struct camera_set *set,
                                   struct err *err);

#endif
