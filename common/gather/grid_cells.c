/* grid_cells.c - see grid_cells.h.
 *
 * A point on the border of a filled cell may be computed later, for a smaller cell beside it; then that value holds.
 * Each point that is filled belongs to one cell: to that of which it is not in the last column or row, except at the
 * end of the grid. */
#include "common/gather/grid_cells.h"

#include <stdint.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"

enum { POINT_OPEN, POINT_WANTED, POINT_COMPUTED };
enum { CHUNK = 64 };

void grid_cells_release(struct grid_cells *g)
{
    free(g->state);
    free(g->cells);
    free(g->next);
    free(g->flat);
    free(g->wanted);
    *g = (struct grid_cells){0};
}

static size_t point_at(const struct grid_cells *g, int x, int y) { return (size_t)y * (size_t)g->width + (size_t)x; }

static void corners_of(const struct grid_cells *g, const struct grid_cell *c, size_t corners[4])
{
    for (int k = 0; k < 4; k++) corners[k] = point_at(g, c->x[k & 1], c->y[k >> 1]);
}

/* Wants the corners of a cell, and keeps it for the next turn if there are points between them. */
static enum status add_cell(struct grid_cells *g, int x0, int x1, int y0, int y1, struct err *err)
{
    const struct grid_cell cell = {{x0, x1}, {y0, y1}};
    size_t corners[4];
    corners_of(g, &cell, corners);
    for (int k = 0; k < 4; k++)
        if (g->state[corners[k]] == POINT_OPEN) g->state[corners[k]] = POINT_WANTED;
    if (x1 - x0 <= 1 && y1 - y0 <= 1) return ST_OK;
    if (array_reserve(&g->next, &g->capacity, g->next_count + 1, sizeof *g->next, "cells of a grid", err))
        return err->status;
    g->next[g->next_count++] = cell;
    return ST_OK;
}

/* Makes the cells that were added the current ones, and lists the wanted points. */
static enum status take_next(struct grid_cells *g, struct err *err)
{
    const size_t points = (size_t)g->width * (size_t)g->height;
    free(g->cells);
    free(g->flat);
    g->cells = g->next;
    g->count = g->next_count;
    g->next = NULL;
    g->next_count = g->capacity = g->wanted_count = 0;
    for (size_t i = 0; i < points; i++)
        if (g->state[i] == POINT_WANTED) g->wanted[g->wanted_count++] = i;
    g->flat = malloc(g->count + 1);
    return g->flat ? ST_OK : err_nomem(err, "cells of a grid", g->count);
}

enum status grid_cells_start(struct grid_cells *g, int width, int height, int step, struct err *err)
{
    const size_t points = (size_t)width * (size_t)height;
    *g = (struct grid_cells){.width = width, .height = height};
    g->state = calloc(points + 1, 1);
    g->wanted = malloc((points + 1) * sizeof *g->wanted);
    if (!g->state || !g->wanted) return err_nomem(err, "points of a grid", points * (1 + sizeof *g->wanted));
    for (int y = 0; !err->status && (y < height - 1 || y == 0); y += step)
        for (int x = 0; !err->status && (x < width - 1 || x == 0); x += step)
            add_cell(g, x, x + step < width ? x + step : width - 1, y, y + step < height ? y + step : height - 1, err);
    return err->status ? err->status : take_next(g, err);
}

/* ---------------------------------------------------------------------------------------------------------- filling */

struct fill_job {
    struct grid_cells *g;
    const struct grid_fill *f;
};

static void test_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fill_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        size_t corners[4];
        corners_of(j->g, &j->g->cells[i], corners);
        j->g->flat[i] = j->f->is_flat(j->f->ctx, &j->g->cells[i], corners);
    }
}

static void fill_cell(const struct fill_job *j, const struct grid_cell *c)
{
    const struct grid_cells *g = j->g;
    const int right = c->x[1] == g->width - 1 ? c->x[1] : c->x[1] - 1;
    const int bottom = c->y[1] == g->height - 1 ? c->y[1] : c->y[1] - 1;
    const double wide = c->x[1] > c->x[0] ? c->x[1] - c->x[0] : 1, high = c->y[1] > c->y[0] ? c->y[1] - c->y[0] : 1;
    size_t corners[4];
    corners_of(g, c, corners);
    for (int y = c->y[0]; y <= bottom; y++)
        for (int x = c->x[0]; x <= right; x++) {
            const double u = (x - c->x[0]) / wide, v = (y - c->y[0]) / high;
            const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
            if (g->state[point_at(g, x, y)] == POINT_OPEN) j->f->fill(j->f->ctx, point_at(g, x, y), corners, weights);
        }
}

static void fill_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fill_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (j->g->flat[i]) fill_cell(j, &j->g->cells[i]);
}

static enum status cut(struct grid_cells *g, const struct grid_cell *c, struct err *err)
{
    const int x = (c->x[0] + c->x[1]) / 2, y = (c->y[0] + c->y[1]) / 2;
    const bool wide = c->x[1] - c->x[0] > 1, high = c->y[1] - c->y[0] > 1;
    const int xs[3] = {c->x[0], wide ? x : c->x[1], c->x[1]}, ys[3] = {c->y[0], high ? y : c->y[1], c->y[1]};
    for (int v = 0; v < 1 + high; v++)
        for (int u = 0; u < 1 + wide; u++)
            if (add_cell(g, xs[u], xs[u + 1], ys[v], ys[v + 1], err)) return err->status;
    return ST_OK;
}

enum status grid_cells_next(struct grid_cells *g, const struct grid_fill *f, struct err *err)
{
    struct fill_job j = {g, f};
    for (size_t i = 0; i < g->wanted_count; i++) g->state[g->wanted[i]] = POINT_COMPUTED;
    parallel_for(g->count, CHUNK, test_some, &j);
    parallel_for(g->count, CHUNK, fill_some, &j);
    for (size_t i = 0; !err->status && i < g->count; i++)
        if (!g->flat[i]) cut(g, &g->cells[i], err);
    return err->status ? err->status : take_next(g, err);
}
