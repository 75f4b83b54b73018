/* search_cells.c - which cells of the plan are inside.
 *
 * The lines of all faces cut the plan into cells. Each is labelled inside or outside, so that the labels minimise a sum
 * of costs [Cabral 2014], by a minimum cut:
 *   - a cell that is inside gains its area times the mean fraction of heights at which lines of sight pass, minus a
 *     threshold: what is seen through a window or over furniture is free at few heights;
 *   - a face asks for inside before it and outside behind it, by its length where a wall was seen;
 *   - a border between inside and outside costs its length, less where a face on it looks inwards. The border of the
 *     plan, where nothing is known, costs nothing.
 * Areas are in squares of the ceiling's height, lengths in heights. In [Cabral 2014] the outline of each room is a
 * shortest path; with cells, several rooms, walls between them and missing sides need no further rule.
 *
 * A wall between rooms is a strip of outside between two faces. Where one of them was not seen, but there is free space
 * behind the other, a line is added at the assumed thickness. Where a wall ends at an opening that reaches up to the
 * ceiling, a line is added across it, so that the strip has a border there. */
#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "stages/suggest_model/min_cut.h"
#include "stages/suggest_model/plan_search.h"

static const double MIN_FREE = 0.3;   /* fraction of heights: less is outside */
static const double UNKNOWN = 0.25;   /* times the loss of a cell that is less free: unseen is not outside */
static const double BORDER = 0.12;    /* cost of a border without a face, per height */
static const double FACE = 0.25;      /* cost of a face against which the labels speak, per height */
static const double CAMERA = 0.05;    /* gain of a cell with a camera */
static const double MIN_BEHIND = 0.3; /* of a face's length with free space behind it, and height of that length */
static const double BEHIND = 0.06;    /* how far behind the assumed wall, of the ceiling's height */
static const double APART = 0.03;     /* of equal lines, of the ceiling's height */
static const double SAMPLES = 0.02, RASTER = 0.01; /* of the ceiling's height */

void search_release(struct plan_search *p)
{
    if (!p) return;
    free(p->lines);
    free(p->front_of);
    plan_cells_release(&p->cells);
    free(p->labels);
    free(p->bodies);
    free(p->edge_walls);
    free(p->edge_sides);
    free(p->raster);
}

/* Whether another face lies behind this one within the thickness of a wall. */
static bool has_back(const struct plan_search *p, int face)
{
    const struct wall_line *l = &p->faces->faces[face].line;
    for (int i = 0; i < p->faces->count; i++) {
        const struct wall_line *o = &p->faces->faces[i].line;
        const double thickness = l->at + o->at;
        if (line_cosine(l, o) < -0.998 && thickness > 0 && thickness <= p->params->max_thickness * p->faces->height)
            return true;
    }
    return false;
}

/* Whether there is free space behind a face, as there is behind a wall between rooms. */
static bool is_free_behind(const struct plan_search *p, int face)
{
    const struct face_list *list = p->faces;
    const struct wall_face *f = &list->faces[face];
    int wall = 0, free_behind = 0;
    for (int k = 0; k < f->columns; k++) {
        double at[2];
        if (f->solid[k] < 0.5f) continue;
        line_point(&f->line, f->first + (k + 0.5) * list->cell, -(WALL_THICKNESS + BEHIND) * list->height, at);
        wall++;
        free_behind += free_space_at(p->space, at[0], at[1]) > MIN_FREE;
    }
    return free_behind >= MIN_BEHIND * wall && free_behind * list->cell >= MIN_BEHIND * list->height;
}

/* Adds a line across a face at S, unless there is one. */
static enum status add_across(struct plan_search *p, int face, double s, struct err *err)
{
    const struct wall_line *l = &p->faces->faces[face].line;
    const struct wall_line across = {{-l->n[1], l->n[0]}, s};
    for (int i = 0; i < p->line_count; i++) {
        const double cosine = line_cosine(&across, &p->lines[i]);
        if (fabs(cosine) > 0.998 && fabs(across.at - (cosine > 0 ? 1 : -1) * p->lines[i].at) < APART * p->faces->height)
            return ST_OK;
    }
    size_t capacity = (size_t)p->line_count, same = capacity;
    if (array_reserve(&p->lines, &capacity, capacity + 1, sizeof *p->lines, "lines of a plan", err) ||
        array_reserve(&p->front_of, &same, same + 1, sizeof *p->front_of, "lines of a plan", err))
        return err->status;
    p->front_of[p->line_count] = face;
    p->lines[p->line_count++] = across;
    return ST_OK;
}

/* Whether the columns beside one, in one direction, are wall over a length. */
static bool is_wall_beside(const struct wall_face *f, int column, int step, double length)
{
    int count = 0;
    for (int k = column + step; k >= 0 && k < f->columns && f->solid[k] > 0.5f; k += step) count++;
    return count >= length;
}

/* Adds lines where walls between rooms end at openings that reach up to the ceiling. */
static enum status add_ends(struct plan_search *p, struct err *err)
{
    const double cell = p->faces->cell, least = p->params->min_opening * p->faces->height;
    for (int i = 0; i < p->faces->count && !err->status; i++) {
        const struct wall_face *f = &p->faces->faces[i];
        for (int k = 0, end; k < f->columns && !err->status; k = end) {
            for (end = k + 1; end < f->columns && (f->lintel[end] < 0) == (f->lintel[k] < 0);) end++;
            if (f->lintel[k] >= 0 || (end - k) * cell < least) continue;
            if (is_wall_beside(f, k, -1, least / cell)) add_across(p, i, f->first + k * cell, err);
            if (!err->status && is_wall_beside(f, end - 1, 1, least / cell))
                add_across(p, i, f->first + end * cell, err);
        }
    }
    return err->status;
}

static enum status gather_lines(struct plan_search *p, struct err *err)
{
    const int count = p->faces->count;
    p->lines = malloc((2 * (size_t)count + 1) * sizeof *p->lines);
    p->front_of = malloc((2 * (size_t)count + 1) * sizeof *p->front_of);
    if (!p->lines || !p->front_of) return err_nomem(err, "lines of a plan", 2 * (size_t)count * sizeof *p->lines);
    for (int i = 0; i < count; i++) {
        p->lines[i] = p->faces->faces[i].line;
        p->front_of[i] = -1;
    }
    p->line_count = count;
    for (int i = 0; i < count; i++) {
        const struct wall_line *l = &p->lines[i];
        if (has_back(p, i) || !is_free_behind(p, i)) continue;
        p->front_of[p->line_count] = i;
        p->lines[p->line_count++] = (struct wall_line){{-l->n[0], -l->n[1]}, WALL_THICKNESS * p->faces->height - l->at};
    }
    return add_ends(p, err);
}

/* Gives the border of the plan lines of its own, and its edges these lines. */
static enum status add_border(struct plan_search *p, struct err *err)
{
    const double at[4] = {p->faces->low[1], p->faces->low[0], -p->faces->high[1], -p->faces->high[0]};
    static const double NORMALS[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    size_t capacity = (size_t)p->line_count, same = capacity;
    if (array_reserve(&p->lines, &capacity, capacity + 4, sizeof *p->lines, "lines of a plan", err) ||
        array_reserve(&p->front_of, &same, same + 4, sizeof *p->front_of, "lines of a plan", err))
        return err->status;
    p->border = p->line_count;
    for (int k = 0; k < 4; k++) {
        p->lines[p->line_count] = (struct wall_line){{NORMALS[k][0], NORMALS[k][1]}, at[k]};
        p->front_of[p->line_count++] = -1;
    }
    for (int e = 0; e < p->cells.edge_count; e++) {
        struct cell_edge *edge = &p->cells.edges[e];
        const double *b = cell_edge_end(&p->cells, e), x = 0.5 * (edge->a[0] + b[0]), y = 0.5 * (edge->a[1] + b[1]);
        int best = p->border;
        if (edge->line >= 0) continue;
        for (int k = p->border; k < p->line_count; k++)
            if (fabs(line_across(&p->lines[k], x, y)) < fabs(line_across(&p->lines[best], x, y))) best = k;
        edge->line = best;
    }
    return ST_OK;
}

static bool is_in_cell(const struct plan_cells *cells, int cell, double x, double y)
{
    const int first = cells->cells[cell].first;
    int e = first;
    do {
        const double *a = cells->edges[e].a, *b = cell_edge_end(cells, e);
        if ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) < 0) return false;
        e = cells->edges[e].next;
    } while (e != first);
    return true;
}

static void cell_bounds(const struct plan_cells *cells, int cell, double low[2], double high[2])
{
    const int first = cells->cells[cell].first;
    int e = first;
    low[0] = low[1] = HUGE_VAL;
    high[0] = high[1] = -HUGE_VAL;
    do {
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], cells->edges[e].a[k]);
            high[k] = fmax(high[k], cells->edges[e].a[k]);
        }
        e = cells->edges[e].next;
    } while (e != first);
}

/* The mean of the free space over a cell, sampled at places a small distance apart. */
static double mean_free(const struct plan_search *p, int cell)
{
    double low[2], high[2], step[2], sum = 0;
    int count[2], inside = 0;
    cell_bounds(&p->cells, cell, low, high);
    for (int k = 0; k < 2; k++) {
        count[k] = (int)((high[k] - low[k]) / (SAMPLES * p->faces->height)) + 4;
        step[k] = (high[k] - low[k]) / count[k];
    }
    for (int i = 0; i < count[0]; i++)
        for (int j = 0; j < count[1]; j++) {
            const double x = low[0] + (i + 0.5) * step[0], y = low[1] + (j + 0.5) * step[1];
            if (!is_in_cell(&p->cells, cell, x, y)) continue;
            sum += free_space_at(p->space, x, y);
            inside++;
        }
    return inside ? sum / inside : 0;
}

static enum status make_raster(struct plan_search *p, struct err *err)
{
    p->edge = RASTER * p->faces->height;
    for (int k = 0; k < 2; k++) p->size[k] = (int)((p->faces->high[k] - p->faces->low[k]) / p->edge) + 1;
    const size_t count = (size_t)p->size[0] * (size_t)p->size[1];
    p->raster = malloc(count * sizeof *p->raster);
    if (!p->raster) return err_nomem(err, "a plan", count * sizeof *p->raster);
    for (size_t i = 0; i < count; i++) p->raster[i] = -1;
    for (int c = 0; c < p->cells.cell_count; c++) {
        double low[2], high[2];
        int from[2], to[2];
        cell_bounds(&p->cells, c, low, high);
        for (int k = 0; k < 2; k++) {
            from[k] = clamp_int((int)((low[k] - p->faces->low[k]) / p->edge), 0, p->size[k] - 1);
            to[k] = clamp_int((int)((high[k] - p->faces->low[k]) / p->edge), 0, p->size[k] - 1);
        }
        for (int y = from[1]; y <= to[1]; y++)
            for (int x = from[0]; x <= to[0]; x++)
                if (is_in_cell(&p->cells, c, p->faces->low[0] + (x + 0.5) * p->edge,
                               p->faces->low[1] + (y + 0.5) * p->edge))
                    p->raster[(size_t)y * (size_t)p->size[0] + (size_t)x] = c;
    }
    return ST_OK;
}

/* Costs of labels of cells: index 0 if inside, 1 if outside. seen: all false. */
static enum status add_costs(struct cut_graph *g, const struct plan_search *p, double (*costs)[2], bool *seen,
                             struct err *err)
{
    const double h = p->faces->height;
    for (int c = 0; c < p->cells.cell_count; c++) {
        const double gain = p->cells.cells[c].area / (h * h) * (mean_free(p, c) - MIN_FREE);
        costs[c][gain > 0] += gain > 0 ? gain : -UNKNOWN * gain;
    }
    for (int v = 0; v < p->sights->view_count; v++) {
        const int c = search_cell_at(p, p->sights->views[v].center.x, p->sights->views[v].center.y);
        if (c >= 0 && !seen[c]) costs[c][1] += CAMERA;
        if (c >= 0) seen[c] = true;
    }
    for (int e = 0; e < p->cells.edge_count && !err->status; e++) {
        const struct cell_edge *edge = &p->cells.edges[e];
        double span[2];
        if (!search_is_front(p, e)) continue;
        search_edge_span(p, e, span);
        const double length = (span[1] - span[0]) / h, solid = search_solid(p, edge->line, span[0], span[1]);
        costs[edge->cell][1] += FACE * length * solid;
        if (edge->twin < 0) continue;
        const int behind = p->cells.edges[edge->twin].cell;
        costs[behind][0] += FACE * length * solid;
        cut_graph_pair(g, edge->cell, behind, BORDER * length * (1 - solid), BORDER * length, err);
    }
    for (int c = 0; c < p->cells.cell_count && !err->status; c++) cut_graph_node(g, c, costs[c][0], costs[c][1], err);
    return err->status;
}

enum status search_cells(struct plan_search *p, struct err *err)
{
    struct cut_graph g = {0};
    if (gather_lines(p, err) ||
        plan_cells_make(&p->cells, p->faces->low, p->faces->high, p->lines, p->line_count, err) || add_border(p, err))
        return err->status;
    const size_t cells = (size_t)p->cells.cell_count, edges = (size_t)p->cells.edge_count;
    double(*costs)[2] = calloc(cells, sizeof *costs);
    bool *inside = calloc(cells, sizeof *inside);
    p->labels = calloc(cells, 1);
    p->bodies = malloc(cells * sizeof *p->bodies);
    p->edge_walls = malloc(edges * sizeof *p->edge_walls);
    p->edge_sides = calloc(edges, sizeof *p->edge_sides);
    if (!costs || !inside || !p->labels || !p->bodies || !p->edge_walls || !p->edge_sides)
        err_nomem(err, "cells of a plan", cells * sizeof *costs);
    if (!err->status && !make_raster(p, err) && !cut_graph_init(&g, p->cells.cell_count, err) &&
        !add_costs(&g, p, costs, inside, err)) {
        cut_graph_solve(&g, inside);
        for (size_t c = 0; c < cells; c++) {
            p->labels[c] = inside[c] ? CELL_INSIDE : CELL_OUTSIDE;
            p->bodies[c] = -1;
        }
        for (size_t e = 0; e < edges; e++) p->edge_walls[e] = -1;
    }
    cut_graph_release(&g);
    free(inside);
    free(costs);
    return err->status;
}
