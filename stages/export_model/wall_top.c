/* wall_top.c - the upper edge of a wall along its line.
 *
 * Overview. build_model lets a wall go up to the ceilings of the rooms beside it; plan.txt has only the lowest height.
 * The edge is found again from the rooms: an edge of a room that lies on one of the wall's two faces carries the room's
 * ceiling over its length, and beyond its ends by as much as the walls there are thick, since slabs extend under walls.
 * Where both faces have a room the higher ceiling counts; on one face, the nearest edge; where there is none, the
 * wall's own top.
 *
 * Mathematics. Over a wall along an axis each plane of a ceiling is a linear function of S, so the upper edge is
 * piecewise linear. Its corners are among the ends of edges, the middles between them, and the crossings of these
 * linear functions; between two neighbouring ones it is linear, and two points decide.
 *
 * plan.txt's `top` is the lowest of these functions at the wall's two ends, on both faces. A wall with another `top`
 * has one of its own, and keeps it. */
#include "stages/export_model/wall_top.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"

static const double on_face = 1e-6; /* model units; corners of rooms lie on faces of walls */

struct room_side { /* an edge of a room on a face of the wall */
    double s[2];   /* its ends, ascending */
    double beyond[2];
    int side, count;
    double line[2][2]; /* of each plane of the ceiling: z = line[k][0] + line[k][1] s; the lower one counts */
    double across[2];  /* what the other face adds to line[k][0] */
};

struct search {
    const struct model_plan *plan;
    const struct model_wall *wall;
    bool along_x;
    double faces[2]; /* across: of the inner and the outer face */
    struct room_side *sides;
    double *breaks;
    int side_count, break_count;
    struct err *err;
};

static double thickness_of(const struct model_plan *plan, const struct model_room_corner *corner)
{
    return corner->wall >= 0 ? plan->walls[corner->wall].thickness : 0;
}

/* Adds the edge of a room from its corner k - 1 to k if it lies on a face of the wall. */
static enum status add_side(struct search *s, const struct model_room *room, int k)
{
    const int n = room->corner_count;
    const struct model_room_corner *before = &room->corners[(k + n - 1) % n], *b = &room->corners[k],
                                   *after = &room->corners[(k + 1) % n];
    const double across[2] = {s->along_x ? before->y : before->x, s->along_x ? b->y : b->x};
    const double along[2] = {s->along_x ? before->x : before->y, s->along_x ? b->x : b->y};
    for (int side = 0; side < 2; side++) {
        if (fabs(across[0] - s->faces[side]) > on_face || fabs(across[1] - s->faces[side]) > on_face) continue;
        if (array_append(&s->sides, (size_t)s->side_count, sizeof *s->sides, "edges of rooms", s->err))
            return s->err->status;
        struct room_side *to = &s->sides[s->side_count++];
        const bool up = along[1] > along[0];
        *to = (struct room_side){.side = side, .count = room->ceilings};
        to->s[!up] = along[0];
        to->s[up] = along[1];
        to->beyond[!up] = thickness_of(s->plan, before);
        to->beyond[up] = thickness_of(s->plan, after);
        for (int c = 0; c < room->ceilings; c++) {
            const double *z = room->ceiling[c];
            to->line[c][0] = z[0] + z[s->along_x ? 2 : 1] * s->faces[side];
            to->line[c][1] = z[s->along_x ? 1 : 2];
            to->across[c] = z[s->along_x ? 2 : 1] * (s->faces[!side] - s->faces[side]);
        }
    }
    return ST_OK;
}

static double height_of(const struct room_side *side, double s)
{
    double z = INFINITY;
    for (int k = 0; k < side->count; k++) z = fmin(z, side->line[k][0] + side->line[k][1] * s);
    return z;
}

/* The height of the upper edge at S, which is not at a corner of it. */
static double edge_at(const struct search *search, double s)
{
    double top = -INFINITY;
    for (int side = 0; side < 2; side++) {
        const struct room_side *best = NULL;
        double least = INFINITY;
        for (int i = 0; i < search->side_count; i++) {
            const struct room_side *r = &search->sides[i];
            const double low = r->s[0] - s, high = s - r->s[1], off = fmax(0, fmax(low, high));
            if (r->side != side || off >= least || low > r->beyond[0] || high > r->beyond[1]) continue;
            least = off;
            best = r;
        }
        if (best) top = fmax(top, height_of(best, s));
    }
    return top > -INFINITY ? top : search->wall->top;
}

static enum status add_break(struct search *s, double at, const double reach[2])
{
    if (!(at > reach[0] && at < reach[1])) return ST_OK;
    if (array_append(&s->breaks, (size_t)s->break_count, sizeof *s->breaks, "corners", s->err)) return s->err->status;
    s->breaks[s->break_count++] = at;
    return ST_OK;
}

/* Where two linear functions of two edges, or of one, cross. */
static enum status add_crossings(struct search *s, const struct room_side *a, const struct room_side *b,
                                 const double reach[2])
{
    for (int i = 0; i < a->count; i++)
        for (int k = 0; k < b->count; k++) {
            const double slope = a->line[i][1] - b->line[k][1];
            if (slope != 0 && add_break(s, (b->line[k][0] - a->line[i][0]) / slope, reach)) return s->err->status;
        }
    return ST_OK;
}

static enum status find_breaks(struct search *s, const double reach[2])
{
    for (int i = 0; !s->err->status && i < s->side_count; i++) {
        const struct room_side *a = &s->sides[i];
        for (int e = 0; !s->err->status && e < 2; e++)
            if (!add_break(s, a->s[e], reach)) add_break(s, a->s[e] + (e ? a->beyond[e] : -a->beyond[e]), reach);
        for (int k = i; !s->err->status && k < s->side_count; k++)
            if (!add_crossings(s, a, &s->sides[k], reach) && !add_break(s, (a->s[1] + s->sides[k].s[0]) / 2, reach))
                add_break(s, (a->s[0] + s->sides[k].s[1]) / 2, reach);
    }
    if (!s->err->status) sort_doubles(s->breaks, (size_t)s->break_count);
    return s->err->status;
}

/* Adds a corner, unless it is where the last one is; a last one between two others on a line is dropped. */
static void add_corner(double (*top)[2], int *count, double s, double z)
{
    static const double same = 1e-9;
    double(*last)[2] = top + *count - 1;
    if (*count && fabs(last[0][0] - s) < same && fabs(last[0][1] - z) < same) return;
    if (*count > 1) {
        const double *a = last[-1], *b = last[0];
        const double turn = (b[0] - a[0]) * (z - b[1]) - (b[1] - a[1]) * (s - b[0]);
        if (fabs(turn) < same * (1 + hypot(s - a[0], z - a[1]))) --*count;
    }
    top[*count][0] = s;
    top[*count][1] = z;
    ++*count;
}

/* Corners of the upper edge: two for each stretch between breaks. */
static enum status find_corners(double (**top)[2], int *count, struct search *s, const double reach[2])
{
    *top = malloc((2 * (size_t)s->break_count + 2) * sizeof **top);
    if (!*top) return err_nomem(s->err, "a wall's upper edge", 2 * (size_t)s->break_count * sizeof **top);
    for (int i = 0; i <= s->break_count; i++) {
        const double from = i ? s->breaks[i - 1] : reach[0], to = i < s->break_count ? s->breaks[i] : reach[1];
        if (!(to - from > on_face)) continue;
        const double a = edge_at(s, from + (to - from) / 3), b = edge_at(s, to - (to - from) / 3);
        add_corner(*top, count, from, 2 * a - b);
        add_corner(*top, count, to, 2 * b - a);
    }
    return ST_OK;
}

/* What plan.txt has as the top of a wall that goes up to its ceilings. */
static double plan_top(const struct search *search)
{
    double top = INFINITY;
    for (int i = 0; i < search->side_count; i++) {
        const struct room_side *r = &search->sides[i];
        const double low = fmin(search->wall->span[0], search->wall->span[1]),
                     high = fmax(search->wall->span[0], search->wall->span[1]);
        if (r->s[1] + r->beyond[1] <= low || r->s[0] - r->beyond[0] >= high) continue;
        for (int k = 0; k < r->count; k++)
            for (int end = 0; end < 2; end++) {
                const double z = r->line[k][0] + r->line[k][1] * (end ? high : low);
                top = fmin(top, fmin(z, z + r->across[k]));
            }
    }
    return top;
}

enum status wall_top_find(double (**top)[2], int *count, const struct model_plan *plan, int wall, const double reach[2],
                          struct err *err)
{
    const struct model_wall *w = &plan->walls[wall];
    struct search s = {.plan = plan, .wall = w, .along_x = fabs(w->normal[1]) > fabs(w->normal[0]), .err = err};
    const double n = s.along_x ? w->normal[1] : w->normal[0];
    bool level = true;
    *top = NULL;
    *count = 0;
    s.faces[0] = n * w->offset;
    s.faces[1] = n * (w->offset - w->thickness);
    for (int r = 0; !err->status && r < plan->room_count; r++)
        for (int k = 0; !err->status && k < plan->rooms[r].corner_count; k++) add_side(&s, &plan->rooms[r], k);
    if (!err->status && fabs(plan_top(&s) - w->top) <= on_face && !find_breaks(&s, reach))
        find_corners(top, count, &s, reach);
    for (int i = 0; i < *count; i++) level = level && fabs((*top)[i][1] - w->top) <= on_face;
    if (err->status || level) *count = 0;
    free(s.sides);
    free(s.breaks);
    return err->status;
}
