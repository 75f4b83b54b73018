/* wall_joins.c - joins of walls.
 *
 * Two walls make a corner where both end, else one of them meets the other, which goes on. An end has one such
 * relation; where it has one already, the other wall meets it.
 *
 * build_model gives a corner to both walls: what is left of a wall between its corners must have a length. A corner
 * takes of a wall what the other one's two faces cut off. So where the border of a room steps by less than a wall is
 * thick, a wall beside the step must be thinner than the step. The thickness of walls that were seen from one side is a
 * guess; that of others is measured, and stays. */
#include "stages/suggest_model/wall_joins.h"

#include <math.h>

#include "common/math/numbers.h"

/* As fractions of the ceiling's height: */
static const double MAX_REACH = 0.25; /* how far an end may be moved to a corner */
static const double MIN_BEYOND = 0.1; /* a wall goes on if it reaches that far beyond a corner */
static const double MIN_LENGTH = 0.002, MIN_THIN = 0.01;
static const double THINNER = 0.7; /* times the thickness */
enum { ROUNDS = 12 };

struct wall_line wall_side_line(const struct suggested_wall *w, int side)
{
    if (side == 0) return w->line;
    return (struct wall_line){{-w->line.n[0], -w->line.n[1]}, w->thickness - w->line.at};
}

bool wall_joins_has(const struct suggestion *s, int a, int b)
{
    for (int e = 0; e < 2; e++) {
        if (s->walls[a].joins[e] && s->walls[a].others[e] == b) return true;
        if (s->walls[b].joins[e] && s->walls[b].others[e] == a) return true;
    }
    return false;
}

/* How far a wall reaches beyond a place, at its nearer end, which is *end. */
static double reach_beyond(const struct suggested_wall *w, const double at[2], int *end)
{
    const double s = line_along(&w->line, at[0], at[1]);
    *end = fabs(s - w->begin) > fabs(s - w->end);
    return *end ? w->end - s : s - w->begin;
}

static void meet(struct suggestion *s, int wall, int end, int other)
{
    struct suggested_wall *w = &s->walls[wall];
    if (w->joins[end] || (w->joins[!end] && w->others[!end] == other)) return;
    w->joins[end] = JOIN_MEETS;
    w->others[end] = other;
}

void wall_joins_add(struct suggestion *s, const struct wall_side *x, const struct wall_side *y)
{
    struct suggested_wall *a = &s->walls[x->wall], *b = &s->walls[y->wall];
    const struct wall_line la = wall_side_line(a, x->side), lb = wall_side_line(b, y->side);
    const double least = MIN_BEYOND * s->ceiling, most = MAX_REACH * s->ceiling;
    double at[2];
    int ends[2];
    if (wall_joins_has(s, x->wall, y->wall) || !line_cross(&la, &lb, at)) return;
    const double beyond[2] = {reach_beyond(a, at, &ends[0]), reach_beyond(b, at, &ends[1])};
    const bool goes_on[2] = {beyond[0] > least + b->thickness, beyond[1] > least + a->thickness};
    if (beyond[0] < -most || beyond[1] < -most || (goes_on[0] && goes_on[1])) return;
    if (goes_on[1])
        meet(s, x->wall, ends[0], y->wall);
    else if (goes_on[0])
        meet(s, y->wall, ends[1], x->wall);
    else if (!a->joins[ends[0]] && !b->joins[ends[1]]) {
        a->joins[ends[0]] = b->joins[ends[1]] = JOIN_CORNER;
        a->others[ends[0]] = y->wall;
        b->others[ends[1]] = x->wall;
    } else if (!a->joins[ends[0]])
        meet(s, x->wall, ends[0], y->wall);
    else
        meet(s, y->wall, ends[1], x->wall);
}

static double thickness_of(const struct suggested_wall *w, double thickness)
{
    return w->thickness > 0 ? w->thickness : thickness;
}

/* S of what two walls have in common at a corner or where one meets the other: least and most. */
static void cut_range(const struct suggested_wall *w, const struct suggested_wall *other, double thickness,
                      double range[2])
{
    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        struct wall_line a = w->line, b = other->line;
        double at[2];
        if (k & 1) a.at -= thickness_of(w, thickness);
        if (k & 2) b.at -= thickness_of(other, thickness);
        if (!line_cross(&a, &b, at)) continue;
        const double along = line_along(&w->line, at[0], at[1]);
        range[0] = fmin(range[0], along);
        range[1] = fmax(range[1], along);
    }
}

/* A wall from corner to corner: to their near sides, which is what is left of it, or to their far sides. */
static void span_of(const struct suggestion *s, const struct suggested_wall *w, double thickness, bool far,
                    double span[2])
{
    span[0] = w->begin;
    span[1] = w->end;
    for (int e = 0; e < 2; e++) {
        double range[2];
        if (!w->joins[e]) continue;
        cut_range(w, &s->walls[w->others[e]], thickness, range);
        span[e] = range[far ? e : !e];
    }
}

static void undo(struct suggestion *s, int wall)
{
    struct suggested_wall *w = &s->walls[wall];
    for (int e = 0; e < 2; e++) {
        w->joins[e] = JOIN_NONE;
        w->others[e] = -1;
    }
    for (int i = 0; i < s->wall_count; i++)
        for (int e = 0; e < 2; e++)
            if (s->walls[i].joins[e] && s->walls[i].others[e] == wall) {
                s->walls[i].joins[e] = JOIN_NONE;
                s->walls[i].others[e] = -1;
            }
}

void wall_joins_fit(struct suggestion *s, double thickness)
{
    bool changed = true;
    for (int round = 0; changed && round < ROUNDS; round++) {
        changed = false;
        for (int i = 0; i < s->wall_count; i++) {
            const struct suggested_wall *w = &s->walls[i];
            double span[2];
            span_of(s, w, thickness, false, span);
            if (span[1] - span[0] >= MIN_LENGTH * s->ceiling) continue;
            for (int e = 0; e < 2; e++) {
                if (!w->joins[e] || s->walls[w->others[e]].between) continue;
                struct suggested_wall *other = &s->walls[w->others[e]];
                const double thin = THINNER * thickness_of(other, thickness);
                if (thin < MIN_THIN * s->ceiling) continue;
                other->thickness = thin;
                changed = true;
            }
        }
    }
    for (int i = 0; i < s->wall_count; i++) {
        double span[2];
        span_of(s, &s->walls[i], thickness, false, span);
        if (span[1] - span[0] < MIN_LENGTH * s->ceiling) undo(s, i);
    }
}

/* Ends that are joined to nothing move to where the wall was seen. */
static void trim_ends(struct suggestion *s)
{
    for (int i = 0; i < s->wall_count; i++) {
        struct suggested_wall *w = &s->walls[i];
        if (w->seen[1] <= w->seen[0]) continue;
        if (!w->joins[0]) w->begin = fmax(w->begin, w->seen[0]);
        if (!w->joins[1]) w->end = fmin(w->end, w->seen[1]);
    }
}

/* Whether a wall meets another one beyond the far sides of that one's corners. */
static bool is_unmet(const struct suggestion *s, int wall, int end, double thickness)
{
    const struct suggested_wall *w = &s->walls[wall], *other = &s->walls[w->others[end]];
    double reach[2], range[2];
    for (int e = 0; e < 2; e++) /* a corner of both fits by itself */
        if (other->joins[e] && other->others[e] == wall) return false;
    cut_range(other, w, thickness, range);
    span_of(s, other, thickness, true, reach);
    return !(range[0] >= reach[0] && range[1] <= reach[1]);
}

void wall_joins_drop_unmet(struct suggestion *s, double thickness)
{
    for (bool changed = true; changed;) { /* each round undoes a join: what it gave its wall, others may have met */
        changed = false;
        trim_ends(s);
        for (int i = 0; i < s->wall_count; i++)
            for (int e = 0; e < 2; e++) {
                if (!s->walls[i].joins[e] || !is_unmet(s, i, e, thickness)) continue;
                s->walls[i].joins[e] = JOIN_NONE;
                s->walls[i].others[e] = -1;
                changed = true;
            }
    }
}

/* --------------------------------------------------------------------------------------------------------- openings */

/* Cuts the part from low to high off an opening: the smaller side goes. */
static void cut_off(struct suggested_opening *o, double low, double high)
{
    if (o->end <= low || o->begin >= high) return;
    if (low - o->begin >= o->end - high)
        o->end = low;
    else
        o->begin = high;
}

static void cut_opening(const struct suggestion *s, struct suggested_opening *o, double thickness)
{
    double span[2];
    span_of(s, &s->walls[o->wall], thickness, false, span);
    o->begin = fmax(o->begin, span[0]);
    o->end = fmin(o->end, span[1]);
    o->foot = fmax(o->foot, 0);
    o->top = fmin(o->top, s->ceiling);
    for (int i = 0; i < s->wall_count; i++)
        for (int e = 0; e < 2; e++) {
            const struct suggested_wall *w = &s->walls[i];
            double range[2];
            if (w->joins[e] != JOIN_MEETS || w->others[e] != o->wall) continue;
            cut_range(&s->walls[o->wall], w, thickness, range);
            cut_off(o, range[0], range[1]);
        }
}

void wall_joins_cut_openings(struct suggestion *s, double thickness, double min_side)
{
    int kept = 0;
    for (int i = 0; i < s->opening_count; i++) {
        struct suggested_opening o = s->openings[i];
        bool hidden = false;
        cut_opening(s, &o, thickness);
        for (int k = 0; k < kept; k++) {
            const struct suggested_opening *q = &s->openings[k];
            hidden |= q->wall == o.wall && q->begin < o.end && q->end > o.begin && q->foot < o.top && q->top > o.foot;
        }
        if (!hidden && o.end - o.begin >= min_side && o.top - o.foot >= min_side) s->openings[kept++] = o;
    }
    s->opening_count = kept;
}
