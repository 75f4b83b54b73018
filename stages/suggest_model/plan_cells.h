/* plan_cells.h - the plan cut into convex cells along lines. */
#ifndef REMODEL_PLAN_CELLS_H
#define REMODEL_PLAN_CELLS_H

#include "common/base/err.h"
#include "stages/suggest_model/wall_line.h"

/* An edge of a cell, counter-clockwise round it: the cell lies to its left. */
struct cell_edge {
    double a[2];    /* where it begins; it ends where the next one begins */
    int line;       /* -1: the border of the plan */
    int cell, next; /* next: edge of the same cell */
    int twin;       /* the same edge of the neighbour, in the opposite direction; -1: none */
};
struct plan_cell {
    int first; /* edge */
    double middle[2], area;
};
struct plan_cells {
    struct plan_cell *cells; /* both owned */
    struct cell_edge *edges;
    int cell_count, edge_count;
};

/* Cuts the rectangle from low to high along all lines. The caller releases the result, which a failure leaves empty. */
enum status plan_cells_make(struct plan_cells *p, const double low[2], const double high[2],
                            const struct wall_line *lines, int line_count, struct err *err);
void plan_cells_release(struct plan_cells *p);

static inline const double *cell_edge_end(const struct plan_cells *p, int edge)
{
    return p->edges[p->edges[edge].next].a;
}

#endif
