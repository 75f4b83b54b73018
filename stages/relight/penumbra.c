/* penumbra.c - see penumbra.h.
 *
 * Overview. Where the photograph has the edge of a patch of sun that the edit takes away, the relit picture L q should
 * be smooth. So the logarithm of the photograph is compared with that of 1 / q across the edge, for shifts and widths
 * of the latter, and the pair that explains the photograph best moves the quotient. Old edges are found in
 * penumbra_edges.c, and fitted in penumbra_fit.c.
 *
 * Result. A pixel near an edge takes the quotient of the place t' in place of its own t: that of the vector v that
 * minimises sum w (v . n - (t' - t))^2 over the points beside it, so that at a corner both edges move. Beyond the
 * penumbra the quotient is flat across the edge, and the shift fades. Where the edit leaves a part of the old edge,
 * that part is in the light before and after alike and moves with the quotient. */
#include "stages/relight/penumbra.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "stages/relight/penumbra_fit.h"

enum { FADE = 8 /* px over which a shift fades beyond the penumbra */ };
static const double LEAST_PART = 0.05; /* of a move that is believed: less is none */
static const double STIFF = 0.01;      /* of the weights: what holds a shift along an edge */
static const double SPLAT = 3;         /* px: standard deviation of a point's weight along the edge */

/* What the edges around a pixel say of where its quotient is: sums of weights w times n n^T, n u, 1, for edges with the
 * normal n across which it is u away. */
struct flow {
    float xx, xy, yy, x, y, weight, along;
};

struct move {
    const struct old_edges *edges;
    float (*source)[4]; /* log quotients before they are moved */
    struct flow *flow;
};

/* Adds what a point of an edge says of the pixels around it. */
static void splat(struct move *s, const struct edge_point *p)
{
    const int at_x = p->pixel % s->edges->width, at_y = p->pixel / s->edges->width;
    const double flat = p->half + fabs(p->shift) + 2, reach = flat + FADE;
    const int r = (int)ceil(hypot(reach, 2.5 * SPLAT));
    for (int y = clamp_int(at_y - r, 0, s->edges->height); y < clamp_int(at_y + r + 1, 0, s->edges->height); y++)
        for (int x = clamp_int(at_x - r, 0, s->edges->width); x < clamp_int(at_x + r + 1, 0, s->edges->width); x++) {
            const size_t i = (size_t)y * (size_t)s->edges->width + (size_t)x;
            const double t = (x - p->x) * p->nx + (y - p->y) * p->ny, along = (y - p->y) * p->nx - (x - p->x) * p->ny;
            if (s->edges->surface[i] != s->edges->surface[p->pixel] || fabs(t) > reach || fabs(along) > 2.5 * SPLAT)
                continue;
            const double by_along = exp(-along * along / (2 * SPLAT * SPLAT));
            const double fade = clamp((reach - fabs(t)) / FADE, 0, 1), off = t / p->half;
            const double weight = p->part * by_along / (1 + off * off);
            const double by = fade * fade * (3 - 2 * fade) * (penumbra_fit_moved(p, t, p->shift, p->steeper) - t);
            struct flow *f = &s->flow[i];
            f->xx += (float)(weight * p->nx * p->nx);
            f->xy += (float)(weight * p->nx * p->ny);
            f->yy += (float)(weight * p->ny * p->ny);
            f->x += (float)(weight * by * p->nx);
            f->y += (float)(weight * by * p->ny);
            f->weight += (float)weight;
            f->along += (float)(p->part * by_along);
        }
}

/* The shift that agrees best with all edges: at a corner, with that of both. */
static void find_shift(double by[2], const struct flow *f)
{
    const double least = STIFF * (double)f->weight, xx = (double)f->xx + least, yy = (double)f->yy + least;
    const double xy = (double)f->xy, determinant = xx * yy - xy * xy;
    const double part = fmin(1, (double)f->along / SPLAT) / determinant;
    by[0] = part * (yy * (double)f->x - xy * (double)f->y);
    by[1] = part * (xx * (double)f->y - xy * (double)f->x);
}

/* Weights of four values in a row at u between the middle ones: cubic, for a penumbra is a few pixels wide and a linear
 * mean would widen it. */
static void weigh(double w[4], double u, bool is_cubic)
{
    const double v = 1 - u;
    const double cubic[4] = {-0.5 * u * v * v, v + 0.5 * u * v * (3 * v - 1), u + 0.5 * u * v * (3 * u - 1),
                             -0.5 * v * u * u};
    for (int k = 0; k < 4; k++) w[k] = is_cubic ? cubic[k] : k == 1 ? v : k == 2 ? u : 0;
}

/* The log quotient at a place; false: not all of the pixels that it is made of are of the surface. */
static bool read_quotient(double to[3], const struct move *s, int surface, double x, double y, bool is_cubic)
{
    const int left = (int)floor(x), top = (int)floor(y);
    double wx[4], wy[4];
    weigh(wx, x - left, is_cubic);
    weigh(wy, y - top, is_cubic);
    for (int c = 0; c < 3; c++) to[c] = 0;
    for (int k = 0; k < 16; k++) {
        const int at_x = left + k % 4 - 1, at_y = top + k / 4 - 1;
        const double w = wx[k % 4] * wy[k / 4];
        if (w == 0) continue;
        if (at_x < 0 || at_y < 0 || at_x >= s->edges->width || at_y >= s->edges->height) return false;
        const size_t i = (size_t)at_y * (size_t)s->edges->width + (size_t)at_x;
        if (s->edges->surface[i] != surface) return false;
        for (int c = 0; c < 3; c++) to[c] += w * (double)s->source[i][c];
    }
    return true;
}

/* Takes the quotient from beside the pixel. */
static void move_pixel(const struct move *s, int x, int y)
{
    const size_t i = (size_t)y * (size_t)s->edges->width + (size_t)x;
    double q[3], by[2];
    if (!(s->flow[i].weight > 0)) return;
    find_shift(by, &s->flow[i]);
    if (by[0] == 0 && by[1] == 0) return;
    if (!read_quotient(q, s, s->edges->surface[i], x + by[0], y + by[1], true) &&
        !read_quotient(q, s, s->edges->surface[i], x + by[0], y + by[1], false))
        return;
    for (int c = 0; c < 3; c++) s->edges->quotient[i][c] = (float)exp(q[c]);
}

static void move_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct move *s = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < s->edges->width; x++) move_pixel(s, x, (int)y);
}

static enum status move_all(struct move *s, struct err *err)
{
    const size_t n = (size_t)s->edges->width * (size_t)s->edges->height;
    s->source = calloc(n + 1, sizeof *s->source);
    s->flow = calloc(n + 1, sizeof *s->flow);
    if (!s->source || !s->flow) return err_nomem(err, "edges of light", 2 * n * sizeof *s->flow);
    for (size_t i = 0; i < n; i++)
        for (int c = 0; s->edges->surface[i] >= 0 && c < 3; c++) s->source[i][c] = logf(s->edges->quotient[i][c]);
    for (size_t k = 0; k < s->edges->count; k++)
        if (s->edges->points[k].part > LEAST_PART) splat(s, &s->edges->points[k]);
    parallel_for((size_t)s->edges->height, 8, move_rows, s);
    return ST_OK;
}

static enum status move_quotients(const struct old_edges *edges, struct err *err)
{
    struct move s = {.edges = edges};
    move_all(&s, err);
    free(s.source);
    free(s.flow);
    return err->status;
}

static void count_fits(struct penumbra_stats *stats, const struct old_edges *s)
{
    double squares = 0;
    *stats = (struct penumbra_stats){.points = (int)s->count};
    for (size_t k = 0; k < s->count; k++) {
        if (!(s->points[k].part > 0.5)) continue;
        stats->fitted++;
        squares += s->points[k].shift * s->points[k].shift;
    }
    if (stats->fitted) stats->shift = sqrt(squares / stats->fitted);
}

enum status penumbra_fit(float (*quotient)[4], struct penumbra_stats *stats, const float (*matt)[3],
                         const struct irradiance *before, const struct pixels *p, const struct relight_params *params,
                         struct err *err)
{
    struct old_edges s = {0};
    *stats = (struct penumbra_stats){0};
    if (!params->penumbra) return ST_OK;
    if (!penumbra_edges_find(&s, quotient, matt, before, p, err) && s.count &&
        !penumbra_fit_points(&s, params->penumbra, err)) {
        count_fits(stats, &s);
        if (stats->fitted) move_quotients(&s, err);
    }
    penumbra_edges_release(&s);
    return err->status;
}
