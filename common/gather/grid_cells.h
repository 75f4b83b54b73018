/* grid_cells.h - a grid whose points are computed where neighbours differ, and interpolated where they are alike.
 *
 * The grid is cut into cells of `step` columns and rows. Their corners are computed. A cell whose corners are alike is
 * filled from them; another one is cut in four, down to cells without points between their corners. Which points are
 * computed depends on the values alone, not on threads. */
#ifndef REMODEL_GRID_CELLS_H
#define REMODEL_GRID_CELLS_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

/* From a corner's column and row to the opposite one's, both included. */
struct grid_cell {
    int x[2], y[2];
};

/* Filled by grid_cells_start(); everything is owned. */
struct grid_cells {
    int width, height;
    unsigned char *state; /* of each point: one of the enum in grid_cells.c */
    struct grid_cell *cells, *next;
    unsigned char *flat; /* of each cell: what `is_flat` said */
    size_t count, next_count, capacity;
    size_t *wanted; /* points to compute now, in order */
    size_t wanted_count;
};

/* What the caller knows of the values; both are called by several threads. */
struct grid_fill {
    const void *ctx;
    /* Whether all points of the cell follow from its corners: the points [0] and [1] of its first row, [2] and [3] of
     * its last one. */
    bool (*is_flat)(const void *ctx, const struct grid_cell *cell, const size_t corners[4]);
    /* Sets a point from the corners and their weights, which sum to 1. */
    void (*fill)(const void *ctx, size_t point, const size_t corners[4], const double weights[4]);
};

/* Lists the corners of all cells in g->wanted. step: 1 or more; with 1, all points are wanted. The caller releases g in
 * each case. ST_NOMEM. */
enum status grid_cells_start(struct grid_cells *g, int width, int height, int step, struct err *err);
/* The wanted points are computed: fills cells that are flat, cuts the others, and lists what is wanted next; nothing
 * when all points are set. ST_NOMEM. */
enum status grid_cells_next(struct grid_cells *g, const struct grid_fill *f, struct err *err);
void grid_cells_release(struct grid_cells *g);

#endif
