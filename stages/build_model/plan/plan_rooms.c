/* plan_rooms.c - the rooms' outlines.
 *
 * A room is a cycle of walls. Consecutive walls on one line are grouped into an edge; the lines through the middles of
 * the walls give an outline, whose orientation says which side of each wall faces the room. From these sides follow the
 * corners of the faces, the walls that two rooms share, the border of the floor and ceiling slabs, and the planes of a
 * ceiling that slopes between two walls. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "stages/build_model/plan/plan_checks.h"
#include "stages/build_model/plan/room_parts.h"

enum status plan_error(struct plan_checker *c, int own, const char *fmt, ...)
{
    char text[1500];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(c->err, ST_DATA, "%s:%d: %s", c->path, c->line ? c->line : own, text);
}

static double cross2(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool plan_segments_meet(const double a[2], const double b[2], const double x[2], const double y[2])
{
    for (int k = 0; k < 2; k++)
        if (fmax(a[k], b[k]) < fmin(x[k], y[k]) || fmin(a[k], b[k]) > fmax(x[k], y[k])) return false;
    return cross2(a, b, x) * cross2(a, b, y) <= 0 && cross2(x, y, a) * cross2(x, y, b) <= 0;
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
    while (start < r->wall_count &&
           plan_walls_on_one_line(&p->walls[r->walls[(start + r->wall_count - 1) % r->wall_count]],
                                  &p->walls[r->walls[start]]))
        start++;
    r->edge_count = 0;
    for (int k = 0; k < r->wall_count && start < r->wall_count; k++) {
        const int i = (start + k) % r->wall_count, before = (i + r->wall_count - 1) % r->wall_count;
        if (k == 0 || !plan_walls_on_one_line(&p->walls[r->walls[before]], &p->walls[r->walls[i]]))
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
        struct plan_line x = plan_wall_face(a, SIDE_IN), y = plan_wall_face(b, SIDE_IN);
        x.c -= off * a->thickness;
        y.c -= off * b->thickness;
        plan_line_cross(x, y, r->edges[e].corner);
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
        const struct plan_line in = plan_wall_face(&p->walls[edge->wall], SIDE_IN);
        edge->side = in.n[0] * (a[1] - b[1]) + in.n[1] * (b[0] - a[0]) > 0 ? SIDE_IN : SIDE_OUT;
    }
    for (int e = 0; e < r->edge_count; e++)
        plan_line_cross(
            plan_wall_face(&p->walls[r->edges[e].wall], r->edges[e].side),
            plan_wall_face(&p->walls[r->edges[(e + 1) % r->edge_count].wall], r->edges[(e + 1) % r->edge_count].side),
            r->edges[e].corner);
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].corner, *b = r->edges[e].corner;
        const struct plan_line face = plan_wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
        if (!(face.n[0] * (a[1] - b[1]) + face.n[1] * (b[0] - a[0]) > LENGTH_EPS))
            return plan_error(c, r->line, "room %s has no space in front of wall %s.", r->name,
                              p->walls[r->edges[e].wall].name);
        for (int f = e + 2; f < r->edge_count; f++) { /* edges that are not neighbours may not touch */
            if (e == 0 && f == r->edge_count - 1) continue;
            const double *x = r->edges[f - 1].corner, *y = r->edges[f].corner;
            if (plan_segments_meet(a, b, x, y))
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
    r->lower = plan_level_top(r->ceiling);
    if (r->shape == LEVEL_CEILING) return ST_OK;
    double at[2] = {0, 0}; /* of both walls along the normal of the first */
    struct plan_line first = {{0, 0}, 0};
    for (int i = 0; i < 2; i++)
        for (int e = 0; e < r->edge_count; e++) {
            if (plan_room_edge_of(r, r->slope_walls[i]) != e) continue;
            const struct plan_line face = plan_wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
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
        const struct plan_line face = plan_wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
        if (!(face.n[0] * (a[1] - b[1]) + face.n[1] * (b[0] - a[0]) > LENGTH_EPS))
            return plan_error(c, r->line, "the walls at the two ends of wall %s, in room %s, overlap.",
                              p->walls[r->edges[e].wall].name, r->name);
        for (int f = e + 2; f < r->edge_count; f++)
            if ((e || f < r->edge_count - 1) && plan_segments_meet(a, b, r->edges[f - 1].outer, r->edges[f].outer))
                return plan_error(c, r->line, "walls %s and %s of room %s overlap.", p->walls[r->edges[e].wall].name,
                                  p->walls[r->edges[f].wall].name, r->name);
    }
    return ST_OK;
}

enum status plan_check_rooms(struct plan_checker *c)
{
    struct plan *p = c->plan;
    unsigned char *sides = calloc((size_t)p->wall_count + 1, 1); /* bits: of each wall, the sides that face rooms */
    if (!sides) return err_nomem(c->err, "the sides of walls", (size_t)p->wall_count);
    for (int i = 0; i < p->room_count && !c->err->status; i++) {
        struct plan_room *r = &p->rooms[i];
        if (r->removed) continue;
        free(r->edges);
        free(r->edge_of);
        r->edges = calloc((size_t)r->wall_count, sizeof *r->edges);
        r->edge_of = calloc((size_t)r->wall_count, sizeof *r->edge_of);
        if (!r->edges || !r->edge_of) err_nomem(c->err, "a room's edges", (size_t)r->wall_count);
        if (!c->err->status && !group_walls(c, r) && !shape_room(c, r)) slope_room(c, r);
        for (int k = 0; !c->err->status && k < r->wall_count; k++)
            sides[r->walls[k]] |= (unsigned char)(1 << r->edges[r->edge_of[k]].side);
    }
    for (int i = 0; i < p->room_count && !c->err->status; i++) {
        struct plan_room *r = &p->rooms[i];
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            struct room_edge *edge = &r->edges[e];
            const struct plan_wall *w = &p->walls[edge->wall];
            edge->shared = sides[edge->wall] == 3;
            edge->border = w->c - (edge->shared ? 0.5 : edge->side == SIDE_IN ? 1 : 0) * w->thickness;
        }
        for (int e = 0; !r->removed && !c->err->status && e < r->edge_count; e++) {
            struct plan_line x = plan_wall_face(&p->walls[r->edges[e].wall], SIDE_IN);
            struct plan_line y = plan_wall_face(&p->walls[r->edges[(e + 1) % r->edge_count].wall], SIDE_IN);
            x.c = r->edges[e].border;
            y.c = r->edges[(e + 1) % r->edge_count].border;
            plan_line_cross(x, y, r->edges[e].outer);
            if (!(plan_top_at(&r->lower, r->edges[e].outer) - r->floor >= MIN_SIZE))
                plan_error(c, r->line, "the ceiling of room %s comes down to its floor.", r->name);
        }
        if (!r->removed && !c->err->status && !check_border(c, r)) room_parts_make(r, p, c->err);
    }
    free(sides);
    return c->err->status;
}
