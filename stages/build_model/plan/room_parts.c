/* room_parts.c - convex polygons in plan.
 *
 * The outline of a room's slabs is cut into convex polygons along the lines of its walls: at a reflex corner the line
 * of the side before it is extended to the nearest side that it hits, which makes two polygons with fewer reflex
 * corners. A side keeps the line that it came from, so that equal planes have equal numbers.
 *
 * What remains of a convex polygon outside a convex part is again a few convex polygons: one beyond each side of the
 * part, within the sides before it. Repeated for every part, this gives the places that no room covers. */
#include "stages/build_model/plan/room_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

static struct plan_line line_reversed(struct plan_line l)
{
    return (struct plan_line){{0 - l.n[0], 0 - l.n[1]}, 0 - l.c};
}

static double ahead_of(const struct plan_line *l, const double p[2])
{
    const double d = l->n[0] * p[0] + l->n[1] * p[1] - l->c;
    return fabs(d) <= PART_EPS ? 0 : d;
}

static void crossing(struct part_corner *at, const struct part_corner *a, const struct part_corner *b,
                     const struct plan_line *l)
{
    const double da = ahead_of(l, a->p), db = ahead_of(l, b->p), t = da / (da - db);
    for (int k = 0; k < 2; k++) at->p[k] = a->p[k] + t * (b->p[k] - a->p[k]);
}

int part_clip(struct part_corner *out, const struct part_corner *in, int count, const struct part_corner *by)
{
    int made = 0;
    bool inside = false;
    for (int i = 0; i < count; i++) inside |= ahead_of(&by->line, in[i].p) < 0;
    for (int i = 0; inside && i < count; i++) {
        const struct part_corner *a = &in[(i + count - 1) % count], *b = &in[i];
        const double da = ahead_of(&by->line, a->p), db = ahead_of(&by->line, b->p);
        if (da > 0 && db <= 0) { /* comes in, along the cut */
            out[made] = *by;
            if (db == 0)
                memcpy(out[made].p, b->p, sizeof b->p);
            else
                crossing(&out[made], a, b, &by->line);
            made++;
            if (db == 0) continue;
        }
        if (db <= 0) out[made++] = *b;
        if (da < 0 && db > 0) { /* goes out, along its own side */
            out[made] = *b;
            crossing(&out[made], a, b, &by->line);
            made++;
        }
    }
    return made;
}

/* ------------------------------------------------------------------------------------------------- remainders */

struct outside {
    const struct room_part *parts;
    int part_count;
    part_visit *visit;
    void *ctx;
    struct err *err;
};

static enum status outside_from(const struct outside *o, const struct part_corner *in, int count, int part)
{
    if (part == o->part_count) return o->visit(o->ctx, in, count);
    const struct room_part *r = &o->parts[part];
    const size_t size = (size_t)count + (size_t)r->count + 2;
    struct part_corner *rest = malloc(2 * size * sizeof *rest), *beyond = rest + size;
    if (!rest) return err_nomem(o->err, "a polygon", 2 * size * sizeof *rest);
    memcpy(rest, in, (size_t)count * sizeof *rest);
    for (int k = 0; k < r->count && count && !o->err->status; k++) {
        struct part_corner by = r->corners[k];
        by.line = line_reversed(by.line);
        const int n = part_clip(beyond, rest, count, &by);
        if (n) outside_from(o, beyond, n, part + 1);
        by.line = r->corners[k].line;
        count = part_clip(beyond, rest, count, &by);
        memcpy(rest, beyond, (size_t)count * sizeof *rest);
    }
    free(rest);
    return o->err->status;
}

enum status parts_outside(const struct part_corner *in, int count, const struct room_part *parts, int part_count,
                          part_visit *visit, void *ctx, struct err *err)
{
    const struct outside o = {parts, part_count, visit, ctx, err};
    return outside_from(&o, in, count, 0);
}

/* ------------------------------------------------------------------------------------------------ a room's parts */

void room_parts_release(struct plan_room *room)
{
    for (int i = 0; i < room->part_count; i++) free(room->parts[i].corners);
    free(room->parts);
    room->parts = NULL;
    room->part_count = 0;
}

static enum status add_part(struct plan_room *r, const struct part_corner *c, int n, struct err *err)
{
    if (array_append(&r->parts, (size_t)r->part_count, sizeof *r->parts, "parts of a room", err)) return err->status;
    struct part_corner *corners = malloc((size_t)n * sizeof *corners);
    if (!corners) return err_nomem(err, "a part of a room", (size_t)n * sizeof *corners);
    memcpy(corners, c, (size_t)n * sizeof *corners);
    r->parts[r->part_count++] = (struct room_part){corners, n};
    return ST_OK;
}

static double turn_at(const struct part_corner *c, int n, int i)
{
    const double *a = c[(i + n - 1) % n].p, *b = c[i].p, *d = c[(i + 1) % n].p;
    return (b[0] - a[0]) * (d[1] - b[1]) - (b[1] - a[1]) * (d[0] - b[0]);
}

/* Extends the side that ends at a reflex corner to the nearest side that it hits, at the point `at`; -1: none. */
static int extend_side(const struct part_corner *c, int n, int reflex, double at[2])
{
    const double *p = c[reflex].p;
    const struct plan_line line = c[reflex].line;
    const double d[2] = {-line.n[1], line.n[0]}; /* direction of the side, counter-clockwise */
    double nearest = HUGE_VAL;
    int hit = -1;
    for (int k = 0; k < n; k++) {
        const int before = (k + n - 1) % n;
        if (k == reflex || before == reflex) continue;
        const double *a = c[before].p, *e = c[k].p;
        const double ha = line.n[0] * a[0] + line.n[1] * a[1] - line.c,
                     he = line.n[0] * e[0] + line.n[1] * e[1] - line.c;
        if ((ha > 0) == (he > 0)) continue;
        const double t = ha / (ha - he);
        const double ahead = d[0] * (a[0] + t * (e[0] - a[0]) - p[0]) + d[1] * (a[1] + t * (e[1] - a[1]) - p[1]);
        if (ahead > 1e-9 && ahead < nearest) {
            nearest = ahead;
            hit = k;
        }
    }
    at[0] = p[0] + nearest * d[0];
    at[1] = p[1] + nearest * d[1];
    return hit;
}

static enum status cut_convex(struct plan_room *r, struct part_corner *c, int n, int depth, struct err *err)
{
    int reflex = 0;
    while (reflex < n && !(turn_at(c, n, reflex) < -1e-12)) reflex++;
    if (reflex == n) return add_part(r, c, n, err);
    const struct plan_line line = c[reflex].line;
    double at[2];
    const int hit = extend_side(c, n, reflex, at);
    struct part_corner *part = hit < 0 || depth > n + 64 ? NULL : calloc(2 * (size_t)n + 8, sizeof *part);
    if (!part)
        return err_set(err, ST_INTERNAL, "the floor of room %s could not be cut into convex parts; this is a bug.",
                       r->name);
    for (int half = 0; half < 2 && !err->status; half++) {
        int m = 0;
        /* half 0: from the reflex corner along the border to the side hit, and back along the cut; half 1: the rest */
        const int from = half == 0 ? reflex : hit, to = half == 0 ? hit : reflex;
        for (int k = from; k != to; k = (k + 1) % n) part[m++] = c[k];
        if (half == 0) {
            part[0].wall = PART_CUT; /* the cut ends at the reflex corner */
            part[m] = c[hit];        /* the side hit, up to the cut */
            memcpy(part[m++].p, at, sizeof at);
            part[0].line = line_reversed(line);
        } else {
            part[m] = c[reflex]; /* the side before the corner continues to the cut's other end */
            memcpy(part[m++].p, at, sizeof at);
        }
        /* drop corners that coincide with the one before */
        int kept = 0;
        for (int k = 0; k < m; k++) {
            const double *q = part[k].p, *prev = part[(k + m - 1) % m].p;
            if (hypot(q[0] - prev[0], q[1] - prev[1]) > 1e-9) part[kept++] = part[k];
        }
        if (kept >= 3) cut_convex(r, part, kept, depth + 1, err);
    }
    free(part);
    return err->status;
}

enum status room_parts_make(struct plan_room *r, const struct plan *p, struct err *err)
{
    struct part_corner *c = calloc((size_t)r->edge_count, sizeof *c);
    room_parts_release(r);
    if (!c) return err_nomem(err, "a room's corners", (size_t)r->edge_count * sizeof *c);
    for (int e = 0; e < r->edge_count; e++) {
        const struct room_edge *edge = &r->edges[e];
        const struct plan_wall *w = &p->walls[edge->wall];
        const double sign = edge->side == SIDE_IN ? -1 : 1; /* out of the room */
        memcpy(c[e].p, edge->outer, sizeof c[e].p);
        c[e].line = (struct plan_line){{sign * w->d[1], -sign * w->d[0]}, sign * edge->border};
        c[e].wall = edge->shared ? PART_MIDDLE : edge->wall;
        c[e].side = edge->side == SIDE_IN ? SIDE_OUT : SIDE_IN;
    }
    cut_convex(r, c, r->edge_count, 0, err);
    free(c);
    return err->status;
}
