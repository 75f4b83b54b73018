/* plan_search.h - the search for a plan: the cells of the plan, which of them are inside, and the walls between. */
#ifndef REMODEL_PLAN_SEARCH_H
#define REMODEL_PLAN_SEARCH_H

#include "stages/suggest_model/free_space.h"
#include "stages/suggest_model/plan_cells.h"
#include "stages/suggest_model/suggest.h"

/* What a cell is: BODY is inside a wall between rooms, or in a doorway of one; CORE a small rest between such walls. */
enum { CELL_OUTSIDE, CELL_INSIDE, CELL_BODY, CELL_CORE };

struct plan_search {
    const struct face_list *faces;
    const struct free_space *space;
    const struct sights *sights;
    const struct suggest_params *params;
    struct wall_line *lines; /* owned; the faces', then assumed other faces of walls, and lines across their ends */
    int *front_of;           /* owned; of lines: the face that an assumed one belongs to, -1: it is a face */
    int line_count, border;  /* border: the first of four lines, those of the plan's border */
    struct plan_cells cells;
    unsigned char *labels; /* owned, as what follows; of cells */
    int *bodies;           /* of cells: the wall whose body it is, -1 none */
    int *edge_walls;       /* of edges of inside cells: the wall on it, -1 none */
    int *edge_sides;       /* likewise: 0 the wall's inside, 1 its other face, 2 an end of it */
    double edge;           /* of the raster, which says in which cell a place is */
    int size[2];
    int *raster;
};

void search_release(struct plan_search *p);

/* Labels the cells, all outside or inside. p has faces, space, sights and params. */
enum status search_cells(struct plan_search *p, struct err *err);
/* Adds walls to the suggestion, and doubts; labels bodies and cores, and fills edge_walls. */
enum status search_walls(struct suggestion *s, struct plan_search *p, struct err *err);
/* Adds rooms to the suggestion, and joins its walls. thickness: of walls of which one face was seen. */
enum status search_rooms(struct suggestion *s, struct plan_search *p, double thickness, struct err *err);

/* The cell at a place, -1 outside of the bounds. */
static inline int search_cell_at(const struct plan_search *p, double x, double y)
{
    const double u = (x - p->faces->low[0]) / p->edge, v = (y - p->faces->low[1]) / p->edge;
    if (!(u >= 0 && v >= 0 && u < p->size[0] && v < p->size[1])) return -1;
    return p->raster[(size_t)v * (size_t)p->size[0] + (size_t)u];
}
static inline int search_label_at(const struct plan_search *p, double x, double y)
{
    const int cell = search_cell_at(p, x, y);
    return cell < 0 ? CELL_OUTSIDE : p->labels[cell];
}
/* How much of a line from S begin to end a face shows, 0 .. 1. */
static inline double search_solid(const struct plan_search *p, int line, double begin, double end)
{
    return line < p->faces->count ? face_solid(p->faces, &p->faces->faces[line], begin, end) : 0;
}
/* S of an edge's ends, in ascending order. */
static inline void search_edge_span(const struct plan_search *p, int edge, double span[2])
{
    const struct cell_edge *e = &p->cells.edges[edge];
    const struct wall_line *l = &p->lines[e->line];
    const double *b = cell_edge_end(&p->cells, edge);
    const double s0 = line_along(l, e->a[0], e->a[1]), s1 = line_along(l, b[0], b[1]);
    span[0] = s0 < s1 ? s0 : s1;
    span[1] = s0 < s1 ? s1 : s0;
}
/* Whether the edge's cell is in front of its line. */
static inline bool search_is_front(const struct plan_search *p, int edge)
{
    const struct cell_edge *e = &p->cells.edges[edge];
    const double *m = p->cells.cells[e->cell].middle;
    return line_across(&p->lines[e->line], m[0], m[1]) > 0;
}

#endif
