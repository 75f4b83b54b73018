/* plan_checks.c - whether a plan describes a building.
 *
 * Once the rooms have their outlines (plan_rooms.c), walls must reach the walls that they meet, openings must lie in
 * their walls, floors and ceilings without overlapping, and everything must lie within the reach of the solids'
 * lattice. */
#include <math.h>

#include "stages/build_model/plan/plan_checks.h"
#include "stages/build_model/solid/solid.h"

static const char *const END_NAMES[] = {"start", "end"};

/* How high a wall may reach. */
static double wall_height(const struct plan *p, int wall)
{
    const struct plan_wall *w = &p->walls[wall];
    double top = w->top;
    for (int i = 0; i < p->room_count && !w->has_top; i++)
        for (int e = 0; !p->rooms[i].removed && e < p->rooms[i].edge_count; e++)
            top = fmax(top, plan_top_at(&p->rooms[i].lower, p->rooms[i].edges[e].outer));
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
    plan_wall_reach(p, other, reach);
    for (int side = 0; side < 2; side++) {
        int face;
        double corner[2];
        if (!plan_line_cross(plan_wall_face(w, side), plan_face_ahead(w, end, o, false, &face), corner)) continue;
        at[0] = fmin(at[0], plan_wall_s(o, corner));
        at[1] = fmax(at[1], plan_wall_s(o, corner));
    }
    if (!(at[0] >= reach[0] - LENGTH_EPS && at[1] <= reach[1] + LENGTH_EPS))
        return plan_error(
            c, w->line,
            "the %s of wall %s does not meet wall %s, which goes from %.9g to %.9g and would have to reach "
            "%.9g.",
            END_NAMES[end], w->name, o->name, reach[0], reach[1], at[0] < reach[0] ? at[0] : at[1]);
    for (int k = 0; k < p->opening_count; k++) {
        const struct plan_opening *q = &p->openings[k];
        if (!plan_opening_is_there(p, q) || q->wall != other || q->s[0] >= at[1] - LENGTH_EPS ||
            q->s[1] <= at[0] + LENGTH_EPS || q->z[0] >= wall_height(p, wall) || q->z[1] <= w->foot)
            continue;
        return plan_error(c, q->line,
                          "%s %s, from %.9g to %.9g on wall %s, overlaps wall %s, which meets it at %.9g to %.9g.",
                          plan_opening_word(q->kind), q->name, q->s[0], q->s[1], o->name, w->name, at[0], at[1]);
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
        plan_wall_span(p, i, span);
        if (!(span[1] - span[0] >= MIN_SIZE))
            return plan_error(c, w->line, "wall %s would be shorter than %g: from %.9g to %.9g.", w->name, MIN_SIZE,
                              span[0], span[1]);
        for (int e = 0; e < 2; e++)
            if (check_meeting(c, i, e)) return c->err->status;
    }
    return ST_OK;
}

static enum status check_openings(struct plan_checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->opening_count; i++) {
        const struct plan_opening *o = &p->openings[i];
        double span[2];
        if (o->removed) continue;
        const struct plan_wall *w = &p->walls[o->wall];
        plan_wall_span(p, o->wall, span);
        if (!(o->s[1] - o->s[0] >= MIN_SIZE && o->z[1] - o->z[0] >= MIN_SIZE))
            return plan_error(c, o->line, "%s %s would be %.3g wide and %.3g high.", plan_opening_word(o->kind),
                              o->name, o->s[1] - o->s[0], o->z[1] - o->z[0]);
        if (o->s[0] < span[0] - LENGTH_EPS || o->s[1] > span[1] + LENGTH_EPS)
            return plan_error(c, o->line,
                              "%s %s, from %.9g to %.9g, is outside its wall %s, which goes from %.9g to %.9g.",
                              plan_opening_word(o->kind), o->name, o->s[0], o->s[1], w->name, span[0], span[1]);
        const double top = plan_wall_top(p, o->wall, o->s[0], o->s[1]);
        if (o->z[0] < w->foot - LENGTH_EPS || o->z[1] > top + LENGTH_EPS)
            return plan_error(
                c, o->line,
                "%s %s, from %.9g up to %.9g, is outside its wall %s, which goes from %.9g up to %.9g there.",
                plan_opening_word(o->kind), o->name, o->z[0], o->z[1], w->name, w->foot, top);
        for (int k = 0; k < i; k++) {
            const struct plan_opening *q = &p->openings[k];
            if (q->wall == o->wall && !q->removed && q->s[0] < o->s[1] && q->s[1] > o->s[0] && q->z[0] < o->z[1] &&
                q->z[1] > o->z[0])
                return plan_error(c, o->line, "%s %s and %s %s, on wall %s, overlap.", plan_opening_word(q->kind),
                                  q->name, plan_opening_word(o->kind), o->name, w->name);
        }
        if (o->leaf > w->thickness)
            return plan_error(c, o->line, "%s %s is thicker than its wall %s.", plan_opening_word(o->kind), o->name,
                              w->name);
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
            if (plan_segments_meet(a, b, c[k], c[(k + 1) % 4])) return false;
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
        const char *kind = plan_opening_word(o->kind);
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
                              o->kind == OPENING_HATCH ? "floor" : "ceiling", r->name);
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
        plan_wall_reach(p, i, reach);
        for (int k = 0; k < 4; k++) plan_wall_point(w, reach[k & 1], k & 2 ? w->thickness : 0, at + 2 + 2 * k);
        if (check_within(c, w->line, "wall", w->name, at, 10)) return c->err->status;
    }
    for (int i = 0; i < p->room_count; i++) {
        const struct plan_room *r = &p->rooms[i];
        const double ridge = r->shape == GABLE_CEILING ? r->slope_heights[2] + r->slab : 0;
        if (!r->removed && check_within(c, r->line, "the ridge of room", r->name, &ridge, 1)) return c->err->status;
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            const double *corner = r->edges[e].outer;
            const double at[4] = {corner[0], corner[1], r->floor - r->slab, plan_top_at(&r->lower, corner) + r->slab};
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

/* Whether a point is in a room, between its walls, floor and ceiling, or on one of these. */
static bool is_in_room(const struct plan_room *r, const double at[3])
{
    const double slack = 1e-6 * (1 + fabs(r->ceiling - r->floor));
    bool inside = false;
    if (r->removed || !r->edge_count || at[2] < r->floor - slack || at[2] > plan_top_at(&r->lower, at) + slack)
        return false;
    for (int i = 0, k = r->edge_count - 1; i < r->edge_count; k = i++) {
        const double *a = r->edges[i].corner, *b = r->edges[k].corner;
        if ((a[1] > at[1]) != (b[1] > at[1]) && at[0] < a[0] + (at[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

/* Planned lamps hang in rooms; a statement that walls one in is blamed. */
static enum status check_lamps(struct plan_checker *c)
{
    for (int i = 0; i < c->plan->lamp_count; i++) {
        const struct plan_lamp *l = &c->plan->lamps[i];
        bool inside = false;
        if (!l->file || !(l->scale[0] + l->scale[1] + l->scale[2] > 0)) continue;
        for (int k = 0; k < c->plan->room_count && !inside; k++) inside = is_in_room(&c->plan->rooms[k], l->placed.at);
        if (!inside)
            return plan_error(c, l->line,
                              "the lamp %s at %.9g %.9g %.9g is in no room: inside a wall, a floor or a "
                              "ceiling, or outdoors; give another place, in the model's frame.",
                              l->name, l->placed.at[0], l->placed.at[1], l->placed.at[2]);
    }
    return ST_OK;
}

enum status plan_check(struct plan *plan, const char *path, int line, struct err *err)
{
    struct plan_checker c = {plan, path, line, err};
    if (plan_check_rooms(&c) || check_walls(&c) || check_openings(&c) || check_slots(&c) || check_boxes(&c) ||
        check_reach(&c) || check_lamps(&c))
        return err->status;
    return ST_OK;
}
