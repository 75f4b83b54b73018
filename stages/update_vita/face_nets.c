/* face_nets.c - see face_nets.h.
 *
 * Places. Light changes fastest near corners, where faces meet, so each edge has a row of samples close to it; between
 * them lies a lattice, whose points are whole multiples of the spacing, so that an edit elsewhere does not move them.
 *
 * Look-up. A grid of cells knows a triangle near the middle of each cell. From there, one walks towards the point:
 * across the side that has it on the outer side, until no side has. Delaunay triangulations allow no circle on this
 * way. */
#include "stages/update_vita/face_nets.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/light/frame.h"
#include "common/math/delaunay.h"
#include "common/math/numbers.h"

static const double INSET = 1.0 / 16; /* of the spacing: how far from an edge its row lies */
static const double CLEAR = 0.25;     /* of the spacing: nearer to an edge the lattice has no sample */
static const double CELL = 0.5;       /* of the spacing: a cell of hints */
enum { MAX_CELLS = 1 << 22 };

/* --------------------------------------------------------------------------------------------------------- polygons */

static void coordinates(double at[2], const struct face_net *f, struct vec3 p)
{
    at[0] = vec3_dot(f->u, p);
    at[1] = vec3_dot(f->v, p);
}

/* Calls visit for each edge of the loops of a face. */
typedef enum status edge_fn(void *ctx, struct vec3 a, struct vec3 b, struct err *err);
static enum status each_edge(const struct solid_mesh *m, int face, edge_fn *visit, void *ctx, struct err *err)
{
    for (int l = m->faces[face].loop; l < m->faces[face].loop + m->faces[face].loops; l++) {
        const int first = m->loops[l].half_edge;
        int h = first;
        do {
            const int next = m->half_edges[h].next;
            const struct vec3 from = m->vertices[m->half_edges[h].origin].p,
                              to = m->vertices[m->half_edges[next].origin].p;
            const enum status st = visit(ctx, from, to, err);
            if (st) return st;
            h = next;
        } while (h != first);
    }
    return ST_OK;
}

/* How a point lies to the edges of a face. */
struct inside {
    const struct face_net *net;
    double at[2], nearest; /* squared distance from the edges */
    bool in;
};

static enum status cross_edge(void *ctx, struct vec3 a, struct vec3 b, struct err *err)
{
    struct inside *s = ctx;
    double p[2], q[2];
    (void)err;
    coordinates(p, s->net, a);
    coordinates(q, s->net, b);
    if ((p[1] > s->at[1]) != (q[1] > s->at[1]) && s->at[0] < p[0] + (q[0] - p[0]) * (s->at[1] - p[1]) / (q[1] - p[1]))
        s->in = !s->in;
    const double dx = q[0] - p[0], dy = q[1] - p[1], length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? clamp(((s->at[0] - p[0]) * dx + (s->at[1] - p[1]) * dy) / length2, 0, 1) : 0;
    const double ex = s->at[0] - p[0] - t * dx, ey = s->at[1] - p[1] - t * dy;
    s->nearest = fmin(s->nearest, ex * ex + ey * ey);
    return ST_OK;
}

/* Whether a point of the face's plane is inside, at least `clear` from its edges. */
static bool is_inside(const struct face_nets *n, int face, double x, double y, double clear)
{
    struct inside s = {.net = &n->nets[face], .at = {x, y}, .nearest = INFINITY};
    each_edge(n->mesh, face, cross_edge, &s, NULL);
    return s.in && s.nearest >= clear * clear;
}

/* ---------------------------------------------------------------------------------------------------------- samples */

enum status face_nets_add(struct face_nets *n, int face, struct vec3 at, struct err *err)
{
    struct face_net *f = &n->nets[face];
    if (array_append(&n->samples, (size_t)n->sample_count, sizeof *n->samples, "samples", err) ||
        array_append(&f->samples, (size_t)f->count, sizeof *f->samples, "samples", err) ||
        array_append(&f->at, (size_t)f->count, sizeof *f->at, "samples", err))
        return err->status;
    coordinates(f->at[f->count], f, at);
    f->samples[f->count++] = n->sample_count;
    n->samples[n->sample_count++] = (struct net_sample){face, at};
    return ST_OK;
}

struct spread {
    struct face_nets *nets;
    int face;
    double low[2], high[2];
};

static enum status grow_box(void *ctx, struct vec3 a, struct vec3 b, struct err *err)
{
    struct spread *s = ctx;
    double at[2];
    (void)b, (void)err;
    coordinates(at, &s->nets->nets[s->face], a);
    for (int k = 0; k < 2; k++) {
        s->low[k] = fmin(s->low[k], at[k]);
        s->high[k] = fmax(s->high[k], at[k]);
    }
    return ST_OK;
}

static enum status add_row(void *ctx, struct vec3 a, struct vec3 b, struct err *err)
{
    struct spread *s = ctx;
    struct face_nets *n = s->nets;
    const struct vec3 along = vec3_sub(b, a);
    const double length = vec3_length(along), inset = fmin(INSET * n->spacing, 0.25 * length);
    const int count = (int)ceil(length / n->spacing);
    if (!(length > 0)) return ST_OK;
    const struct vec3 in = vec3_normalize(vec3_cross(n->mesh->faces[s->face].normal, along));
    for (int k = 0; !err->status && k <= count; k++) {
        const double t = clamp((double)k / count, inset / length, 1 - inset / length);
        const struct vec3 p = vec3_add(a, vec3_add(vec3_scale(along, t), vec3_scale(in, inset)));
        double at[2];
        coordinates(at, &n->nets[s->face], p);
        if (is_inside(n, s->face, at[0], at[1], 0.5 * inset)) face_nets_add(n, s->face, p, err);
    }
    return err->status;
}

static enum status add_lattice(struct spread *s, struct err *err)
{
    struct face_nets *n = s->nets;
    const struct face_net *f = &n->nets[s->face];
    const struct solid_face *face = &n->mesh->faces[s->face];
    const double step = n->spacing;
    for (double y = ceil(s->low[1] / step); !err->status && y * step <= s->high[1]; y++)
        for (double x = ceil(s->low[0] / step); !err->status && x * step <= s->high[0]; x++)
            if (is_inside(n, s->face, x * step, y * step, CLEAR * step))
                face_nets_add(n, s->face,
                              vec3_add(vec3_scale(face->normal, face->offset),
                                       vec3_add(vec3_scale(f->u, x * step), vec3_scale(f->v, y * step))),
                              err);
    return err->status;
}

/* A face whose corners leave no room for rows has one sample, in the middle of a triangle of its corners. */
static enum status add_middle(struct spread *s, struct err *err)
{
    const struct solid_mesh *m = s->nets->mesh;
    const int h = m->loops[m->faces[s->face].loop].half_edge;
    const int next = m->half_edges[h].next, last = m->half_edges[h].prev;
    const struct vec3 sum =
        vec3_add(m->vertices[m->half_edges[h].origin].p,
                 vec3_add(m->vertices[m->half_edges[next].origin].p, m->vertices[m->half_edges[last].origin].p));
    return face_nets_add(s->nets, s->face, vec3_scale(sum, 1.0 / 3), err);
}

static enum status spread_over(struct face_nets *n, int face, struct err *err)
{
    struct spread s = {n, face, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    struct face_net *f = &n->nets[face];
    frame_from_normal(n->mesh->faces[face].normal, &f->u, &f->v);
    if (!each_edge(n->mesh, face, grow_box, &s, err) && !add_lattice(&s, err))
        each_edge(n->mesh, face, add_row, &s, err);
    if (!err->status && !f->count) add_middle(&s, err);
    return err->status;
}

enum status face_nets_make(struct face_nets *n, const struct solid_mesh *mesh, const bool *wanted, double spacing,
                           struct err *err)
{
    *n = (struct face_nets){.mesh = mesh, .spacing = spacing};
    n->nets = calloc((size_t)mesh->face_count + 1, sizeof *n->nets);
    if (!n->nets) return err_nomem(err, "faces", (size_t)mesh->face_count * sizeof *n->nets);
    for (int i = 0; i < mesh->face_count; i++)
        if (wanted[i] && spread_over(n, i, err)) return err->status;
    return face_nets_connect(n, err);
}

static void disconnect(struct face_net *f)
{
    free(f->triangles);
    free(f->beside);
    free(f->hints);
    f->triangles = NULL, f->beside = NULL, f->hints = NULL;
    f->triangle_count = 0;
}

void face_nets_release(struct face_nets *n)
{
    if (!n) return;
    for (int i = 0; n->nets && i < n->mesh->face_count; i++) {
        disconnect(&n->nets[i]);
        free(n->nets[i].samples);
        free(n->nets[i].at);
    }
    free(n->nets);
    free(n->samples);
    *n = (struct face_nets){0};
}

/* ------------------------------------------------------------------------------------------------------ connections */

struct side {
    int low, high, triangle, corner;
};

static int by_ends(const void *a, const void *b)
{
    const struct side *s = a, *t = b;
    if (s->low != t->low) return s->low < t->low ? -1 : 1;
    if (s->high != t->high) return s->high < t->high ? -1 : 1;
    return s->triangle < t->triangle ? -1 : s->triangle > t->triangle;
}

static enum status find_beside(struct face_net *f, struct err *err)
{
    const size_t count = 3 * (size_t)f->triangle_count;
    struct side *sides = malloc((count + 1) * sizeof *sides);
    f->beside = malloc(((size_t)f->triangle_count + 1) * sizeof *f->beside);
    if (!sides || !f->beside) {
        free(sides);
        return err_nomem(err, "triangles", count * sizeof *sides);
    }
    for (int t = 0; t < f->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const int a = f->triangles[t][k], b = f->triangles[t][(k + 1) % 3];
            sides[3 * t + k] = (struct side){a < b ? a : b, a < b ? b : a, t, k};
            f->beside[t][k] = -1;
        }
    qsort(sides, count, sizeof *sides, by_ends);
    for (size_t i = 1; i < count; i++) {
        const struct side *s = &sides[i - 1], *t = &sides[i];
        if (s->low != t->low || s->high != t->high) continue;
        f->beside[s->triangle][s->corner] = t->triangle;
        f->beside[t->triangle][t->corner] = s->triangle;
    }
    free(sides);
    return ST_OK;
}

/* Twice the area of the triangle a, b, p: above 0 if p is to the left of a -> b. */
static double left_of(const double a[2], const double b[2], const double p[2])
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* The triangle that holds p, or the last one on the way to it. */
static int walk(const struct face_net *f, int t, const double p[2])
{
    for (int steps = 0; steps <= f->triangle_count; steps++) {
        int next = -1;
        double worst = 0;
        for (int k = 0; k < 3; k++) {
            const double side = left_of(f->at[f->triangles[t][k]], f->at[f->triangles[t][(k + 1) % 3]], p);
            if (!(side < worst) || f->beside[t][k] < 0) continue;
            worst = side;
            next = f->beside[t][k];
        }
        if (next < 0) return t;
        t = next;
    }
    return t;
}

static enum status make_hints(struct face_net *f, double spacing, struct err *err)
{
    double high[2] = {-INFINITY, -INFINITY}, cell = CELL * spacing;
    f->low[0] = f->low[1] = INFINITY;
    for (int i = 0; i < f->count; i++)
        for (int k = 0; k < 2; k++) {
            f->low[k] = fmin(f->low[k], f->at[i][k]);
            high[k] = fmax(high[k], f->at[i][k]);
        }
    f->hint_width = 1 + (int)fmin((high[0] - f->low[0]) / cell, sqrt(MAX_CELLS) - 1);
    f->hint_height = 1 + (int)fmin((high[1] - f->low[1]) / cell, sqrt(MAX_CELLS) - 1);
    f->hints = malloc((size_t)f->hint_width * (size_t)f->hint_height * sizeof *f->hints);
    if (!f->hints) return err_nomem(err, "cells", (size_t)f->hint_width * (size_t)f->hint_height * sizeof *f->hints);
    for (int y = 0, t = 0; y < f->hint_height; y++)
        for (int x = 0; x < f->hint_width; x++) {
            const double p[2] = {f->low[0] + (x + 0.5) * cell, f->low[1] + (y + 0.5) * cell};
            f->hints[y * f->hint_width + x] = t = walk(f, t, p);
        }
    return ST_OK;
}

enum status face_nets_connect(struct face_nets *n, struct err *err)
{
    for (int i = 0; i < n->mesh->face_count; i++) {
        struct face_net *f = &n->nets[i];
        disconnect(f);
        if (!f->count) continue;
        if (delaunay((const double(*)[2])f->at, f->count, &f->triangles, &f->triangle_count, err)) return err->status;
        if (f->triangle_count && (find_beside(f, err) || make_hints(f, n->spacing, err))) return err->status;
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- look-up */

/* Of few samples, or of some in a line, the nearest one counts. */
static void nearest_sample(struct net_weights *w, const struct face_net *f, const double p[2])
{
    double least = INFINITY;
    int best = 0;
    for (int i = 0; i < f->count; i++) {
        const double d = hypot(f->at[i][0] - p[0], f->at[i][1] - p[1]);
        if (!(d < least)) continue;
        least = d;
        best = i;
    }
    *w = (struct net_weights){{f->samples[best], f->samples[best], f->samples[best]}, {1, 0, 0}};
}

bool face_nets_find(const struct face_nets *n, int face, struct vec3 p, struct net_weights *w)
{
    const struct face_net *f = &n->nets[face];
    double at[2], sum = 0;
    if (!f->count) return false;
    coordinates(at, f, p);
    if (!f->triangle_count) {
        nearest_sample(w, f, at);
        return true;
    }
    const double cell = CELL * n->spacing;
    const int x = clamp_int((int)clamp((at[0] - f->low[0]) / cell, 0, 1e6), 0, f->hint_width - 1);
    const int y = clamp_int((int)clamp((at[1] - f->low[1]) / cell, 0, 1e6), 0, f->hint_height - 1);
    const int t = walk(f, f->hints[y * f->hint_width + x], at);
    for (int k = 0; k < 3; k++) {
        const int *c = f->triangles[t];
        w->sample[k] = f->samples[c[k]];
        w->weight[k] = fmax(0, left_of(f->at[c[(k + 1) % 3]], f->at[c[(k + 2) % 3]], at));
        sum += w->weight[k];
    }
    if (!(sum > 0)) {
        nearest_sample(w, f, at);
        return true;
    }
    for (int k = 0; k < 3; k++) w->weight[k] /= sum;
    return true;
}
