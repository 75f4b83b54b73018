/* plan_cells.c - the arrangement of lines in a rectangle.
 *
 * Each line cuts every cell through which it passes, so that two neighbours share whole edges. A corner nearer to a
 * line than a millionth of the plan counts as on it. Twins are found by sorting the edges by line and place. */
#include "stages/suggest_model/plan_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

enum { MAX_CORNERS = 64 }; /* of a cell, while it is cut */

struct polygon {
    double p[MAX_CORNERS][2];
    int line[MAX_CORNERS]; /* of the edge from corner k to k + 1 */
    int count;
};

void plan_cells_release(struct plan_cells *p)
{
    if (!p) return;
    free(p->cells);
    free(p->edges);
    *p = (struct plan_cells){0};
}

static enum status add_cell(struct plan_cells *p, const struct polygon *q, struct err *err)
{
    struct plan_cell cell = {.first = p->edge_count};
    for (int k = 0; k < q->count; k++) {
        const double *a = q->p[k], *b = q->p[(k + 1) % q->count];
        const double ax = a[0] - q->p[0][0], ay = a[1] - q->p[0][1], bx = b[0] - q->p[0][0], by = b[1] - q->p[0][1];
        const double part = 0.5 * (ax * by - ay * bx);
        cell.area += part;
        cell.middle[0] += part * (ax + bx) / 3;
        cell.middle[1] += part * (ay + by) / 3;
        if (array_append(&p->edges, (size_t)p->edge_count, sizeof *p->edges, "edges of a plan", err))
            return err->status;
        p->edges[p->edge_count++] =
            (struct cell_edge){{a[0], a[1]}, q->line[k], p->cell_count, cell.first + (k + 1) % q->count, -1};
    }
    for (int k = 0; k < 2; k++) cell.middle[k] = q->p[0][k] + (cell.area > 0 ? cell.middle[k] / cell.area : 0);
    if (array_append(&p->cells, (size_t)p->cell_count, sizeof *p->cells, "cells of a plan", err)) return err->status;
    p->cells[p->cell_count++] = cell;
    return ST_OK;
}

/* Cuts a polygon in two by line i; false: it lies on one side. */
static bool cut(const struct polygon *q, const struct wall_line *line, int i, double eps, struct polygon part[2])
{
    double d[MAX_CORNERS];
    bool in_front = false, behind = false;
    for (int k = 0; k < q->count; k++) {
        d[k] = line_across(line, q->p[k][0], q->p[k][1]);
        if (fabs(d[k]) < eps) d[k] = 0;
        in_front |= d[k] > 0;
        behind |= d[k] < 0;
    }
    if (!in_front || !behind || q->count + 2 > MAX_CORNERS) return false;
    for (int side = 0; side < 2; side++) {
        struct polygon *to = &part[side];
        const double sign = side ? -1 : 1;
        to->count = 0;
        for (int k = 0; k < q->count; k++) {
            const int n = (k + 1) % q->count;
            const double here = sign * d[k], next = sign * d[n];
            if (here >= 0) {
                memcpy(to->p[to->count], q->p[k], sizeof q->p[k]);
                to->line[to->count++] = here == 0 && next < 0 ? i : q->line[k];
            }
            if (here * next < 0) {
                const double t = here / (here - next);
                for (int c = 0; c < 2; c++) to->p[to->count][c] = q->p[k][c] + t * (q->p[n][c] - q->p[k][c]);
                to->line[to->count++] = here > 0 ? i : q->line[k];
            }
        }
    }
    return true;
}

struct place {
    int line, edge;
    double s;
    bool front; /* the edge's cell is in front of the line */
};

static int compare(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->line != y->line) return x->line < y->line ? -1 : 1;
    if (x->s != y->s) return x->s < y->s ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

static enum status find_twins(struct plan_cells *p, const struct wall_line *lines, double eps, struct err *err)
{
    struct place *places = malloc(((size_t)p->edge_count + 1) * sizeof *places);
    int count = 0;
    if (!places) return err_nomem(err, "edges of a plan", (size_t)p->edge_count * sizeof *places);
    for (int e = 0; e < p->edge_count; e++) {
        const struct cell_edge *edge = &p->edges[e];
        if (edge->line < 0) continue;
        const struct wall_line *l = &lines[edge->line];
        const double *a = edge->a, *b = cell_edge_end(p, e), *m = p->cells[edge->cell].middle;
        places[count++] = (struct place){edge->line, e, line_along(l, 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])),
                                         line_across(l, m[0], m[1]) > 0};
    }
    qsort(places, (size_t)count, sizeof *places, compare);
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k < count && places[k].line == places[i].line && places[k].s < places[i].s + eps; k++) {
            if (places[k].front == places[i].front || p->edges[places[i].edge].twin >= 0) continue;
            p->edges[places[i].edge].twin = places[k].edge;
            p->edges[places[k].edge].twin = places[i].edge;
        }
    free(places);
    return ST_OK;
}

enum status plan_cells_make(struct plan_cells *p, const double low[2], const double high[2],
                            const struct wall_line *lines, int line_count, struct err *err)
{
    const double eps = 1e-6 * (high[0] - low[0] + high[1] - low[1]);
    struct polygon *list = NULL;
    int count = 0;
    *p = (struct plan_cells){0};
    if (array_append(&list, 0, sizeof *list, "cells of a plan", err)) return err->status;
    list[count++] = (struct polygon){
        {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}, {-1, -1, -1, -1}, 4};
    for (int i = 0; i < line_count && !err->status; i++)
        for (int k = 0, before = count; k < before && !err->status; k++) {
            struct polygon part[2];
            if (!cut(&list[k], &lines[i], i, eps, part)) continue;
            if (array_append(&list, (size_t)count, sizeof *list, "cells of a plan", err)) break;
            list[k] = part[0];
            list[count++] = part[1];
        }
    for (int k = 0; k < count && !err->status; k++) add_cell(p, &list[k], err);
    free(list);
    if (!err->status) find_twins(p, lines, 10 * eps, err);
    if (err->status) plan_cells_release(p);
    return err->status;
}
