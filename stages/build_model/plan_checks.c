/* plan_checks.c - whether a plan describes a building, and the rooms' outlines.
 *
 * A room is a cycle of walls. Consecutive walls on one line are grouped into an edge; the lines through the middles of
 * the walls give an outline, whose orientation says which side of each wall faces the room. From these sides follow
 * the corners of the faces, the walls that two rooms share, and the border of the floor and ceiling slabs. Then walls
 * must reach the walls that they meet, openings must lie in their walls without overlapping, and everything must lie
 * within the reach of the solids' lattice. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "stages/build_model/plan_internal.h"
#include "stages/build_model/room_parts.h"
#include "stages/build_model/solid.h"

static const char *const END_NAMES[] = {"start", "end"};

struct plan_checker {
    struct plan *plan;
    const char *path;
    int line; /* of the edit's statement, which is blamed for any error; 0: the line that made the item is named */
    struct err *err;
};

/* own: line of the faulty item. */
static enum status plan_error(struct plan_checker *c, int own, const char *fmt, ...) PRINTF_LIKE(3, 4);
static enum status plan_error(struct plan_checker *c, int own, const char *fmt, ...)
{
    char text[1500];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(c->err, ST_DATA, "%s:%d: %s", c->path, c->line ? c->line : own, text);
}

/* How high a wall may reach. */
static double wall_height(const struct plan *p, int wall)
{
    const struct plan_wall *w = &p->walls[wall];
    double top = w->top;
    for (int i = 0; i < p->room_count && !w->has_top; i++)
        for (int e = 0; !p->rooms[i].removed && e < p->rooms[i].edge_count; e++)
            top = fmax(top, top_at(&p->rooms[i].lower, p->rooms[i].edges[e].outer));
    return top;
}

/* A wall's end must lie on the wall that it meets, and not over an opening of that wall. */
static enum status check_meeting(struct plan_checker *c, int wall, int end)
{
    const struct plan *p = c->plan;
    const struct plan_wall *w = &p->walls[wall];
    if (w->ends[end].kind == FREE_END) return ST_OK;
    const int other = w->ends[end].other;
    const struct plan_wall *o = &p->walls[other];
    if (o->removed) return ST_OK;
    for (int k = 0; k < 2; k++) /* a corner of both fits by itself */
        if (o->ends[k].kind != FREE_END && o->ends[k].other == wall) return ST_OK;
    double reach[2], at[2] = {HUGE_VAL, -HUGE_VAL};
    wall_reach(p, other, reach);
    for (int side = 0; side < 2; side++) {
        int face;
        double corner[2];
        if (!line_cross(wall_face(w, side), face_ahead(w, end, o, false, &face), corner)) continue;
        at[0] = fmin(at[0], wall_s(o, corner));
        at[1] = fmax(at[1], wall_s(o, corner));
    }
    if (!(at[0] >= reach[0] - LENGTH_EPS && at[1] <= reach[1] + LENGTH_EPS))
        return plan_error(
            c, w->line,
            "the %s of wall %s does not meet wall %s, which goes from %.9g to %.9g and would have to reach "
            "%.9g.",
            END_NAMES[end], w->name, o->name, reach[0], reach[1], at[0] < reach[0] ? at[0] : at[1]);
    for (int k = 0; k < p->opening_count; k++) {
        const struct plan_opening *q = &p->openings[k];
        if (!opening_is_there(p, q) || q->wall != other || q->s[0] >= at[1] - LENGTH_EPS ||
            q->s[1] <= at[0] + LENGTH_EPS || q->z[0] >= wall_height(p, wall) || q->z[1] <= w->foot)
            continue;
        return plan_error(c, q->line,
                          "%s %s, from %.9g to %.9g on wall %s, overlaps wall %s, which meets it at %.9g to %.9g.",
                          verb_name(q->kind), q->name, q->s[0], q->s[1], o->name, w->name, at[0], at[1]);
    }
    return ST_OK;
}

static enum status check_walls(struct plan_checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->wall_count; i++) {
        const struct plan_wall *w = &p->walls[i];
        double span[2];
        if (w->removed) continue;
        wall_span(p, i, span);
        if (!(span[1] - span[0] >= MIN_SIZE))
            return plan_error(c, w->line, "wall %s would be shorter than %g: from %.9g to %.9g.", w->name, MIN_SIZE,
                              span[0], span[1]);
        for (int e = 0; e < 2; e++)
            if (check_meeting(c, i, e)) return c->err->status;
    }
    return ST_OK;
}

static double cross2(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* The segments from a to b and from x to y have a point in common. */
static bool segments_meet(const double a[2], const double b[2], const double x[2], const double y[2])
{
    for (int k = 0; k < 2; k++)
        if (fmax(a[k], b[k]) < fmin(x[k], y[k]) || fmin(a[k], b[k]) > fmax(x[k], y[k])) return false;
    return cross2(a, b, x) * cross2(a, b, y) <= 0 && cross2(x, y, a) * cross2(x, y, b) <= 0;
}

static enum status check_openings(struct plan_checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->opening_count; i++) {
        const struct plan_opening *o = &p->openings[i];
        double span[2];
        if (o->removed) continue;
        const struct plan_wall *w = &p->walls[o->wall];
        wall_span(p, o->wall, span);
        if (!(o->s[1] - o->s[0] >= MIN_SIZE && o->z[1] - o->z[0] >= MIN_SIZE))
            return plan_error(c, o->line, "%s %s would be %.3g wide and %.3g high.", verb_name(o->kind), o->name,
                              o->s[1] - o->s[0], o->z[1] - o->z[0]);
        if (o->s[0] < span[0] - LENGTH_EPS || o->s[1] > span[1] + LENGTH_EPS)
            return plan_error(c, o->line,
                              "%s %s, from %.9g to %.9g, is outside its wall %s, which goes from %.9g to %.9g.",
                              verb_name(o->kind), o->name, o->s[0], o->s[1], w->name, span[0], span[1]);
        const double top = plan_wall_top(p, o->wall, o->s[0], o->s[1]);
        if (o->z[0] < w->foot - LENGTH_EPS || o->z[1] > top + LENGTH_EPS)
            return plan_error(
                c, o->line,
                "%s %s, from %.9g up to %.9g, is outside its wall %s, which goes from %.9g up to %.9g there.",
                verb_name(o->kind), o->name, o->z[0], o->z[1], w->name, w->foot, top);
        for (int k = 0; k < i; k++) {
            const struct plan_opening *q = &p->openings[k];
            if (q->wall == o->wall && !q->removed && q->s[0] < o->s[1] && q->s[1] > o->s[0] && q->z[0] < o->z[1] &&
                q->z[1] > o->z[0])
                return plan_error(c, o->line, "%s %s and %s %s, on wall %s, overlap.", verb_name(q->kind), q->name,
                                  verb_name(o->kind), o->name, w->name);
        }
        if (o->leaf > w->thickness)
            return plan_error(c, o->line, "%s %s is thicker than its wall %s.", verb_name(o->kind), o->name, w->name);
    }
    return ST_OK;
}

/* A rectangle lies inside the faces of the room's walls. */
static bool in_room(const struct plan_room *r, const double low[2], const double high[2])
{
    const double c[4][2] = {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}};
    bool inside = false;
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].corner, *b = r->edges[e].corner;
        for (int k = 0; k < 4; k++)
            if (segments_meet(a, b, c[k], c[(k + 1) % 4])) return false;
        if ((a[1] > low[1]) != (b[1] > low[1]) && low[0] < a[0] + (low[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
        if (a[0] > low[0] && a[0] < high[0] && a[1] > low[1] && a[1] < high[1]) return false;
    }
    return inside;
}

static enum status check_slots(struct plan_checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->slot_count; i++) {
        const struct plan_slot *o = &p->slots[i];
        const struct plan_room *r = &p->rooms[o->room];
        const char *kind = verb_name(o->kind);
        if (o->removed || r->removed) continue;
        if (!(o->high[0] - o->low[0] >= MIN_SIZE && o->high[1] - o->low[1] >= MIN_SIZE))
            return plan_error(c, o->line, "%s %s would be %.3g x %.3g large.", kind, o->name, o->high[0] - o->low[0],
                              o->high[1] - o->low[1]);
        if (!in_room(r, o->low, o->high))
            return plan_error(c, o->line,
                              "%s %s, from %.9g %.9g to %.9g %.9g, does not lie between the walls of room %s.", kind,
                              o->name, o->low[0], o->low[1], o->high[0], o->high[1], r->name);
        for (int k = 0; k < i; k++) {
            const struct plan_slot *q = &p->slots[k];
            if (q->room == o->room && q->kind == o->kind && !q->removed && q->low[0] < o->high[0] &&
                q->high[0] > o->low[0] && q->low[1] < o->high[1] && q->high[1] > o->low[1])
                return plan_error(c, o->line, "%s %s and %s %s, in room %s, overlap.", kind, q->name, kind, o->name,
                                  r->name);
        }
        if (o->leaf > r->slab)
            return plan_error(c, o->line, "%s %s is thicker than the %s of room %s.", kind, o->name,
                              o->kind == VERB_HATCH ? "floor" : "ceiling", r->name);
    }
    return ST_OK;
}

static enum status check_boxes(struct plan_checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->box_count; i++) {
        const struct plan_box *b = &p->boxes[i];
        if (!b->removed && !(b->high[0] - b->low[0] >= MIN_SIZE && b->high[1] - b->low[1] >= MIN_SIZE &&
                             b->high[2] - b->low[2] >= MIN_SIZE))
            return plan_error(c, b->line, "box %s would be %.3g x %.3g x %.3g large.", b->name, b->high[0] - b->low[0],
                              b->high[1] - b->low[1], b->high[2] - b->low[2]);
    }
    return ST_OK;
}

static bool touch(const struct plan *p, int a, int b)
{
    for (int e = 0; e < 2; e++) {
        const struct wall_end *x = &p->walls[a].ends[e], *y = &p->walls[b].ends[e];
        if ((x->kind != FREE_END && x->other == b) || (y->kind != FREE_END && y->other == a)) return true;
    }
    return false;
}

/* Groups consecutive walls on one line into the room's edges. */
static enum status group_walls(struct plan_checker *c, struct plan_room *r)
{
    struct plan *p = c->plan;
    int *group = r->edge_of;
    int start = 0; /* a wall that is not on the line of the wall before it */
    while (start < r->wall_count && walls_on_one_line(&p->walls[r->walls[(start + r->wall_count - 1) % r->wall_count]],
                                                      &p->walls[r->walls[start]]))
        start++;
    r->edge_count = 0;
    for (int k = 0; k < r->wall_count && start < r->wall_count; k++) {
        const int i = (start + k) % r->wall_count, before = (i + r->wall_count - 1) % r->wall_count;
        if (k == 0 || !walls_on_one_line(&p->walls[r->walls[before]], &p->walls[r->walls[i]]))
            r->edges[r->edge_count++] = (struct room_edge){.wall = r->walls[i]};
        group[i] = r->edge_count - 1;
    }
    if (r->edge_count < 3) return plan_error(c, r->line, "the walls of room %s do not enclose it.", r->name);
    for (int e = 0; e < r->edge_count; e++) {
        const int f = (e + 1) % r->edge_count;
        const struct plan_wall *a = &p->walls[r->edges[e].wall], *b = &p->walls[r->edges[f].wall];
        bool met = false;
        if (!(fabs(a->d[0] * b->d[1] - a->d[1] * b->d[0]) > PARALLEL_SINE))
            return plan_error(c, r->line,
                              "walls %s and %s, which follow each other round room %s, are parallel and never meet.",
                              a->name, b->name, r->name);
        for (int i = 0; i < r->wall_count; i++)
            for (int k = 0; k < r->wall_count && group[i] == e; k++)
                met |= group[k] == f && touch(p, r->walls[i], r->walls[k]);
        if (!met)
            return plan_error(
                c, r->line,
                "walls %s and %s, which follow each other round room %s, do not meet: join them, or extend one to "
                "the other.",
                a->name, b->name, r->name);
    }
    return ST_OK;
}

/* Corners of the lines through the walls, `off` thicknesses behind their in faces. */
static void room_corners(const struct plan *p, struct plan_room *r, double off)
{
    for (int e = 0; e < r->edge_count; e++) {
        const struct plan_wall *a = &p->walls[r->edges[e].wall], *b = &p->walls[r->edges[(e + 1) % r->edge_count].wall];
        struct plan_line x = wall_face(a, SIDE_IN), y = wall_face(b, SIDE_IN);
        x.c -= off * a->thickness;
        y.c -= off * b->thickness;
        line_cross(x, y, r->edges[e].corner);
    }
}

static double room_area(const struct plan_room *r)
{
    double twice = 0;
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[e].corner, *b = r->edges[(e + 1) % r->edge_count].corner;
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

static void reverse_edges(struct plan_room *r)
{
    for (int i = 0, k = r->edge_count - 1; i < k; i++, k--) {
        const struct room_edge e = r->edges[i];
        r->edges[i] = r->edges[k];
        r->edges[k] = e;
    }
    for (int i = 0; i < r->wall_count; i++) r->edge_of[i] = r->edge_count - 1 - r->edge_of[i];
}

/* Orders the edges counter-clockwise; finds the sides that face the room, and the corners. */
static enum status shape_room(struct plan_checker *c, struct plan_room *r)
{
    const struct plan *p = c->plan;
    room_corners(p, r, 0.5);
    if (room_area(r) < 0) {
        reverse_edges(r);
        room_corners(p, r, 0.5);
    }
    for (int e = 0; e < r->edge_count; e++) {
        struct room_edge *edge = &r->edges[e];
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].corner, *b = edge->corner;
        const struct plan_line in = wall_face(&p->walls[edge->wall], SIDE_IN);
        edge->side = in.n[0] * (a[1] - b[1]) + in.n[1] * (b[0] - a[0]) > 0 ? SIDE_IN : SIDE_OUT;
    }
    for (int e = 0; e < r->edge_count; e++)
        line_cross(wall_face(&p->walls[r->edges[e].wall], r->edges[e].side),
                   wall_face(&p->walls[r->edges[(e + 1) % r->edge_count].wall], r->edges[(e + 1) % r->edge_count].side),
                   r->edges[e].corner);
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].corner, *b = r->edges[e].corner;
        const struct plan_line face = wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
        if (!(face.n[0] * (a[1] - b[1]) + face.n[1] * (b[0] - a[0]) > LENGTH_EPS))
            return plan_error(c, r->line, "room %s has no space in front of wall %s.", r->name,
                              p->walls[r->edges[e].wall].name);
        for (int f = e + 2; f < r->edge_count; f++) { /* edges that are not neighbours may not touch */
            if (e == 0 && f == r->edge_count - 1) continue;
            const double *x = r->edges[f - 1].corner, *y = r->edges[f].corner;
            if (segments_meet(a, b, x, y))
                return plan_error(
                    c, r->line,
                    "walls %s and %s of room %s cross; list its walls in the order in which they go round it.",
                    p->walls[r->edges[e].wall].name, p->walls[r->edges[f].wall].name, r->name);
        }
    }
    return ST_OK;
}

/* Sets the plane that has the two heights at two positions along the line's normal. */
static void set_plane(struct plan_top *top, int i, struct plan_line line, const double at[2], const double heights[2])
{
    const double rise = (heights[1] - heights[0]) / (at[1] - at[0]);
    top->a[i][0] = heights[0] - rise * at[0];
    top->a[i][1] = rise * line.n[0] + 0.0; /* a -0 becomes 0 */
    top->a[i][2] = rise * line.n[1] + 0.0;
}

/* The planes of the ceiling's lower face. */
static enum status slope_room(struct plan_checker *c, struct plan_room *r)
{
    const struct plan *p = c->plan;
    r->lower = level_top(r->ceiling);
    if (r->shape == LEVEL_CEILING) return ST_OK;
    double at[2] = {0, 0}; /* of both walls along the normal of the first */
    struct plan_line first = {{0, 0}, 0};
    for (int i = 0; i < 2; i++)
        for (int e = 0; e < r->edge_count; e++) {
            if (room_edge_of(r, r->slope_walls[i]) != e) continue;
            const struct plan_line face = wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
            if (i == 0) first = face;
            at[i] = face.n[0] * first.n[0] + face.n[1] * first.n[1] > 0 ? face.c : -face.c;
        }
    if (!(fabs(at[1] - at[0]) > MIN_SIZE))
        return plan_error(c, r->line, "the ceiling of room %s has no width to slope over.", r->name);
    if (r->shape == SLOPED_CEILING) {
        set_plane(&r->lower, 0, first, at, r->slope_heights);
        return ST_OK;
    }
    const double width = fabs(at[1] - at[0]), ridge = r->ridge_at > 0 ? r->ridge_at : 0.5 * width;
    if (!(width - ridge >= MIN_SIZE))
        return plan_error(c, r->line, "the ridge of room %s, %.9g from wall %s, is not between its walls, %.9g apart.",
                          r->name, ridge, p->walls[r->slope_walls[0]].name, width);
    const double middle = at[0] + (at[1] > at[0] ? ridge : -ridge);
    set_plane(&r->lower, 0, first, (const double[2]){at[0], middle},
              (const double[2]){r->slope_heights[0], r->slope_heights[2]});
    set_plane(&r->lower, 1, first, (const double[2]){middle, at[1]},
              (const double[2]){r->slope_heights[2], r->slope_heights[1]});
    r->lower.count = 2;
    return ST_OK;
}

/* The border of the slabs, behind the walls, must not cross itself. It does where walls are thicker than the gap
 * between two parts of the room: they overlap. */
static enum status check_border(struct plan_checker *c, const struct plan_room *r)
{
    const struct plan *p = c->plan;
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].outer, *b = r->edges[e].outer;
        const struct plan_line face = wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
        if (!(face.n[0] * (a[1] - b[1]) + face.n[1] * (b[0] - a[0]) > LENGTH_EPS))
            return plan_error(c, r->line, "the walls at the two ends of wall %s, in room %s, overlap.",
                              p->walls[r->edges[e].wall].name, r->name);
        for (int f = e + 2; f < r->edge_count; f++)
            if ((e || f < r->edge_count - 1) && segments_meet(a, b, r->edges[f - 1].outer, r->edges[f].outer))
                return plan_error(c, r->line, "walls %s and %s of room %s overlap.", p->walls[r->edges[e].wall].name,
                                  p->walls[r->edges[f].wall].name, r->name);
    }
    return ST_OK;
}

static enum status check_rooms(struct plan_checker *c)
{
    struct plan *p = c->plan;
    unsigned char *sides = calloc((size_t)p->wall_count + 1, 1); /* bits: of each wall, the sides that face rooms */
    if (!sides) return err_nomem(c->err, "the sides of walls", (size_t)p->wall_count);
    enum status st = ST_OK;
    for (int i = 0; i < p->room_count && !st; i++) {
        struct plan_room *r = &p->rooms[i];
        if (r->removed) continue;
        free(r->edges);
        free(r->edge_of);
        r->edges = calloc((size_t)r->wall_count, sizeof *r->edges);
        r->edge_of = calloc((size_t)r->wall_count, sizeof *r->edge_of);
        st = r->edges && r->edge_of ? group_walls(c, r) : err_nomem(c->err, "a room's edges", (size_t)r->wall_count);
        if (!st) st = shape_room(c, r);
        if (!st) st = slope_room(c, r);
        for (int k = 0; !st && k < r->wall_count; k++)
            sides[r->walls[k]] |= (unsigned char)(1 << r->edges[r->edge_of[k]].side);
    }
    for (int i = 0; i < p->room_count && !st; i++) {
        struct plan_room *r = &p->rooms[i];
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            struct room_edge *edge = &r->edges[e];
            const struct plan_wall *w = &p->walls[edge->wall];
            edge->shared = sides[edge->wall] == 3;
            edge->border = w->c - (edge->shared ? 0.5 : edge->side == SIDE_IN ? 1 : 0) * w->thickness;
        }
        for (int e = 0; !r->removed && !st && e < r->edge_count; e++) {
            struct plan_line x = wall_face(&p->walls[r->edges[e].wall], SIDE_IN);
            struct plan_line y = wall_face(&p->walls[r->edges[(e + 1) % r->edge_count].wall], SIDE_IN);
            x.c = r->edges[e].border;
            y.c = r->edges[(e + 1) % r->edge_count].border;
            line_cross(x, y, r->edges[e].outer);
            if (!(top_at(&r->lower, r->edges[e].outer) - r->floor >= MIN_SIZE))
                st = plan_error(c, r->line, "the ceiling of room %s comes down to its floor.", r->name);
        }
        if (!r->removed && !st) st = check_border(c, r);
        if (!r->removed && !st) st = room_parts_make(r, p, c->err);
    }
    free(sides);
    return st;
}

static enum status check_within(struct plan_checker *c, int own, const char *what, const char *name,
                                const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(values[i]) <= SOLID_REACH))
            return plan_error(c, own, "%s %s reaches to %.9g; a model lies within %g units of the origin.", what, name,
                              values[i], SOLID_REACH);
    return ST_OK;
}

/* The solids' lattice of coordinates is bounded. */
static enum status check_reach(struct plan_checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->wall_count; i++) {
        const struct plan_wall *w = &p->walls[i];
        double at[10] = {w->foot, w->top}, reach[2];
        if (w->removed) continue;
        wall_reach(p, i, reach);
        for (int k = 0; k < 4; k++) wall_point(w, reach[k & 1], k & 2 ? w->thickness : 0, at + 2 + 2 * k);
        if (check_within(c, w->line, "wall", w->name, at, 10)) return c->err->status;
    }
    for (int i = 0; i < p->room_count; i++) {
        const struct plan_room *r = &p->rooms[i];
        const double ridge = r->shape == GABLE_CEILING ? r->slope_heights[2] + r->slab : 0;
        if (!r->removed && check_within(c, r->line, "the ridge of room", r->name, &ridge, 1)) return c->err->status;
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            const double *corner = r->edges[e].outer;
            const double at[4] = {corner[0], corner[1], r->floor - r->slab, top_at(&r->lower, corner) + r->slab};
            if (check_within(c, r->line, "room", r->name, at, 4)) return c->err->status;
        }
    }
    for (int i = 0; i < p->box_count; i++) {
        const struct plan_box *b = &p->boxes[i];
        const double turned = b->turn == 0 ? 0 : hypot(b->high[0] - b->low[0], b->high[1] - b->low[1]);
        const double at[6] = {b->low[0] - turned,  b->low[1] - turned,  b->low[2],
                              b->high[0] + turned, b->high[1] + turned, b->high[2]};
        if (!b->removed && check_within(c, b->line, "box", b->name, at, 6)) return c->err->status;
    }
    return ST_OK;
}

enum status plan_check(struct plan *plan, const char *path, int line, struct err *err)
{
    struct plan_checker c = {plan, path, line, err};
    if (check_rooms(&c) || check_walls(&c) || check_openings(&c) || check_slots(&c) || check_boxes(&c) ||
        check_reach(&c))
        return err->status;
    return ST_OK;
}
