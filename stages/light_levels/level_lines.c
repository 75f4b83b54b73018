/* level_lines.c - see level_lines.h.
 *
 * Marching squares: a level cuts the sides of a square of the grid where it lies between the values of their ends, at
 * the place of linear interpolation of logarithms. Cuts lie on edges of the grid, each of which two squares share, so
 * that a segment is a pair of edges, and segments that share an edge are joined. In a saddle the segments keep the
 * corners apart that are above the level. */
#include "stages/light_levels/level_lines.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { LABEL_EVERY = 400, LABEL_LEAST = 60, PATH_LEAST = 4 }; /* px of a path; squares */

/* Edges: 2 (y width + x) from point (x, y) to the right, that + 1 downwards. Each has at most two segments. */
struct lines {
    const struct level_grid *g;
    double level;
    int (*next)[2]; /* of each edge: the other edges of its segments; -1: none */
};

static int edge_of(const struct level_grid *g, int x, int y, bool down) { return 2 * (y * g->width + x) + down; }

static void join(struct lines *l, int a, int b)
{
    l->next[a][l->next[a][0] >= 0] = b;
    l->next[b][l->next[b][0] >= 0] = a;
}

static void cut_square(struct lines *l, int x, int y)
{
    const struct level_grid *g = l->g;
    const int corner[4] = {y * g->width + x, y * g->width + x + 1, (y + 1) * g->width + x + 1, (y + 1) * g->width + x};
    const int edges[4] = {edge_of(g, x, y, false), edge_of(g, x + 1, y, true), edge_of(g, x, y + 1, false),
                          edge_of(g, x, y, true)};
    int cuts[4], count = 0;
    for (int k = 0; k < 4; k++) {
        if (g->surface[corner[k]] < 0 || g->surface[corner[k]] != g->surface[corner[0]]) return;
        const double a = (double)g->values[corner[k]], b = (double)g->values[corner[(k + 1) % 4]];
        if ((a < l->level) != (b < l->level)) cuts[count++] = edges[k];
    }
    if (count == 2) join(l, cuts[0], cuts[1]);
    if (count != 4) return;
    const bool first = (double)g->values[corner[0]] >= l->level;
    join(l, cuts[0], cuts[first ? 3 : 1]);
    join(l, cuts[2], cuts[first ? 1 : 3]);
}

static void place_of(double at[2], const struct lines *l, int edge)
{
    const struct level_grid *g = l->g;
    const int point = edge / 2, other = point + (edge & 1 ? g->width : 1);
    const double a = log(fmax((double)g->values[point], 1e-30)), b = log(fmax((double)g->values[other], 1e-30));
    const double t = a == b ? 0.5 : fmin(1, fmax(0, (log(l->level) - a) / (b - a)));
    at[0] = g->step * (point % g->width + (edge & 1 ? 0 : t));
    const int row = point / g->width;
    at[1] = g->step * (row + (edge & 1 ? t : 0));
}

/* Takes the segment between two edges away. */
static void part(struct lines *l, int a, int b)
{
    for (int k = 0; k < 2; k++) {
        const int from = k ? b : a, to = k ? a : b;
        int *next = l->next[from];
        if (next[0] == to)
            next[0] = next[1];
        else if (next[1] != to)
            continue;
        next[1] = -1;
    }
}

static void take_path(struct lines *l, int from, double (*path)[2], level_line_fn *fn, void *ctx)
{
    int count = 0;
    for (int at = from; at >= 0;) {
        const int next = l->next[at][0];
        place_of(path[count++], l, at);
        if (next >= 0) part(l, at, next);
        at = next;
    }
    if (count >= PATH_LEAST) fn(ctx, (const double(*)[2])path, count);
}

enum status level_lines_find(const struct level_grid *g, double level, level_line_fn *fn, void *ctx, struct err *err)
{
    const int edges = 2 * g->width * g->height;
    struct lines l = {g, level, malloc(((size_t)edges + 1) * sizeof *l.next)};
    double(*path)[2] = malloc(((size_t)edges + 1) * sizeof *path);
    if (!l.next || !path) err_nomem(err, "isolines", (size_t)edges * sizeof *path);
    for (int i = 0; !err->status && i < edges; i++) l.next[i][0] = l.next[i][1] = -1;
    for (int y = 0; !err->status && y + 1 < g->height; y++)
        for (int x = 0; x + 1 < g->width; x++) cut_square(&l, x, y);
    for (int closed = 0; !err->status && closed < 2; closed++) /* paths with ends first, then rings */
        for (int i = 0; i < edges; i++)
            while (l.next[i][0] >= 0 && (closed || l.next[i][1] < 0)) take_path(&l, i, path, fn, ctx);
    free(l.next);
    free(path);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------------- SVG */

struct drawing {
    FILE *to;
    double level;
};

static void put_path(FILE *to, const char *class, const double (*at)[2], int count)
{
    fprintf(to, "<path class=\"%s\" d=\"", class);
    for (int i = 0; i < count; i++) fprintf(to, "%s%.4g %.4g", i == 0 ? "M" : i == 1 ? "L" : " ", at[i][0], at[i][1]);
    fputs("\"/>\n", to);
}

static void put_line(void *ctx, const double (*at)[2], int count)
{
    const struct drawing *d = ctx;
    double length = LABEL_EVERY - LABEL_LEAST;
    put_path(d->to, "under", at, count);
    put_path(d->to, "level", at, count);
    for (int i = 1; i < count; i++) {
        length += hypot(at[i][0] - at[i - 1][0], at[i][1] - at[i - 1][1]);
        if (length < LABEL_EVERY) continue;
        length = 0;
        fprintf(d->to, "<text class=\"number\" x=\"%.1f\" y=\"%.1f\">%g</text>\n", at[i][0], at[i][1] + 4, d->level);
    }
}

enum status level_lines_put(FILE *to, const struct level_grid *g, double level, struct err *err)
{
    struct drawing d = {to, level};
    return level_lines_find(g, level, put_line, &d, err);
}
