/* search_rooms.c - rooms from the borders of the inside, and how their walls are joined.
 *
 * Each connected part of the inside has borders; each is walked edge by edge, and gives the walls that follow each
 * other round the room. A wall that stands in the room with a free end is passed on both sides in turn; such pairs do
 * not belong to the outline, and are taken out, repeatedly. What remains of the longest border is the room.
 *
 * Walls that follow each other are joined (wall_joins.c). A short wall between two that make a corner near it is left
 * out. A room is closed if all its walls are joined in turn, and its outline, and those in the middle of the walls and
 * behind them, do not cross themselves: then build_model can build it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/suggest_model/plan_search.h"
#include "stages/suggest_model/wall_joins.h"

static const double MAX_SHORT = 0.1,
                    MAX_SHIFT = 0.06; /* of a wall that is left out; of its corner; of the ceiling's height */

struct outline {
    struct wall_side *items; /* owned; wall -1: not found */
    int count;
    double area, middle[2];
};

/* The next edge on the border of the inside. */
static int next_border(const struct plan_search *p, int edge)
{
    int e = p->cells.edges[edge].next;
    for (int guard = 0; guard < p->cells.edge_count; guard++) {
        const int twin = p->cells.edges[e].twin;
        if (twin < 0 || p->labels[p->cells.edges[twin].cell] != CELL_INSIDE) break;
        e = p->cells.edges[twin].next;
    }
    return e;
}

static bool is_border(const struct plan_search *p, int e)
{
    const int twin = p->cells.edges[e].twin;
    return p->labels[p->cells.edges[e].cell] == CELL_INSIDE &&
           (twin < 0 || p->labels[p->cells.edges[twin].cell] != CELL_INSIDE);
}

/* Walks round a border from an edge on; marks its edges. */
static enum status walk_border(struct outline *o, const struct plan_search *p, int start, unsigned char *seen,
                               struct err *err)
{
    int e = start;
    const double *origin = p->cells.edges[start].a;
    do {
        const struct cell_edge *edge = &p->cells.edges[e];
        const double *a = edge->a, *b = cell_edge_end(&p->cells, e);
        const double part = 0.5 * ((a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]));
        const bool core = edge->twin >= 0 && p->labels[p->cells.edges[edge->twin].cell] == CELL_CORE;
        const struct wall_side item = {p->edge_walls[e], p->edge_sides[e]};
        const struct wall_side *last = o->count ? &o->items[o->count - 1] : NULL;
        o->area += part;
        for (int k = 0; k < 2; k++) o->middle[k] += part * (a[k] + b[k] + origin[k]) / 3;
        seen[e] = 1;
        if (!core && !(item.wall >= 0 && item.side == 2) &&
            !(last && last->wall == item.wall && last->side == item.side)) {
            if (array_append(&o->items, (size_t)o->count, sizeof *o->items, "walls of a room", err)) return err->status;
            o->items[o->count++] = item;
        }
        e = next_border(p, e);
    } while (e != start && !seen[e]);
    for (int k = 0; k < 2; k++) o->middle[k] = o->area != 0 ? o->middle[k] / o->area : origin[k];
    return ST_OK;
}

/* Removes an item; the next one takes its place. */
static void remove_item(struct outline *o, int i)
{
    memmove(o->items + i, o->items + i + 1, (size_t)(o->count - i - 1) * sizeof *o->items);
    o->count--;
}

/* The first item that is of the same wall as the one after it: of the same side of it, or of the other; -1: none. */
static int find_pair(const struct outline *o, bool same_side)
{
    for (int i = 0; i < o->count && o->count > 1; i++) {
        const struct wall_side *a = &o->items[i], *b = &o->items[(i + 1) % o->count];
        if (a->wall == b->wall && (a->side == b->side || a->wall < 0) == same_side) return i;
    }
    return -1;
}

/* Takes out repeated walls, and walls that are passed on both sides in turn. */
static void reduce(struct outline *o)
{
    for (int i;;) {
        if ((i = find_pair(o, true)) >= 0)
            remove_item(o, i);
        else if ((i = find_pair(o, false)) >= 0) {
            const int next = (i + 1) % o->count;
            remove_item(o, i > next ? i : next);
            remove_item(o, i > next ? next : i);
        } else
            return;
    }
}

/* ------------------------------------------------------------------------------------------------------ short walls */

/* Whether a short wall may be left out: the walls before and after it meet near it. */
static bool is_dispensable(const struct suggestion *s, const struct wall_side *before, const struct wall_side *x,
                           const struct wall_side *after)
{
    const struct suggested_wall *w = &s->walls[x->wall];
    double at[2];
    if (before->wall < 0 || after->wall < 0 || before->wall == after->wall || w->between) return false;
    const struct wall_line a = wall_side_line(&s->walls[before->wall], before->side),
                           b = wall_side_line(&s->walls[after->wall], after->side);
    if (w->end - w->begin > MAX_SHORT * s->ceiling || !line_cross(&a, &b, at)) return false;
    const double along = line_along(&w->line, at[0], at[1]), across = line_across(&w->line, at[0], at[1]);
    return fabs(across) < MAX_SHIFT * s->ceiling && along > w->begin - MAX_SHIFT * s->ceiling &&
           along < w->end + MAX_SHIFT * s->ceiling;
}

/* Takes short walls out of an outline where their neighbours make a corner; gone: of walls. */
static void drop_short(struct outline *o, const struct suggestion *s, bool *gone)
{
    for (int i = 0; i < o->count && o->count > 3;) {
        const struct wall_side *x = &o->items[i], *before = &o->items[(i + o->count - 1) % o->count];
        if (x->wall < 0 || !is_dispensable(s, before, x, &o->items[(i + 1) % o->count])) {
            i++;
            continue;
        }
        gone[x->wall] = true;
        remove_item(o, i);
    }
}

/* Removes walls; nothing may be joined to them, and no room have them. */
static void remove_walls(struct suggestion *s, const bool *gone, int *number)
{
    int kept = 0;
    for (int i = 0; i < s->wall_count; i++) {
        number[i] = gone[i] ? -1 : kept;
        if (!gone[i]) s->walls[kept++] = s->walls[i];
    }
    s->wall_count = kept;
    for (int i = 0; i < kept; i++)
        for (int e = 0; e < 2; e++)
            if (s->walls[i].others[e] >= 0) s->walls[i].others[e] = number[s->walls[i].others[e]];
    for (int i = 0; i < s->room_wall_count; i++) s->room_walls[i] = number[s->room_walls[i]];
    kept = 0;
    for (int i = 0; i < s->doubt_count; i++) {
        struct suggested_doubt d = s->doubts[i];
        if (d.wall >= 0 && gone[d.wall]) continue;
        if (d.wall >= 0) d.wall = number[d.wall];
        s->doubts[kept++] = d;
    }
    s->doubt_count = kept;
}

/* ------------------------------------------------------------------------------------------------------------ rooms */

static double cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Whether the bounds of two segments have nothing in common. */
static bool are_apart(const double a[2], const double b[2], const double c[2], const double d[2])
{
    for (int k = 0; k < 2; k++)
        if (fmax(a[k], b[k]) < fmin(c[k], d[k]) || fmin(a[k], b[k]) > fmax(c[k], d[k])) return true;
    return false;
}

/* Whether an outline crosses itself, or has an edge that runs backwards. The lines are those of its edges, the normals
 * point inside; corners has room for as many. */
static bool is_simple(const struct wall_line *lines, double (*corners)[2], int count)
{
    for (int i = 0; i < count; i++)
        if (!line_cross(&lines[i], &lines[(i + 1) % count], corners[i])) return false;
    for (int i = 0; i < count; i++) {
        const double *a = corners[(i + count - 1) % count], *b = corners[i]; /* the edge of line i, the inside left */
        if (!(line_along(&lines[i], a[0], a[1]) > line_along(&lines[i], b[0], b[1]) + 1e-6)) return false;
        for (int k = i + 2; k < count; k++) {
            const double *c = corners[k - 1], *d = corners[k];
            if ((i == 0 && k == count - 1) || are_apart(a, b, c, d)) continue;
            if (cross(a, b, c) * cross(a, b, d) <= 0 && cross(c, d, a) * cross(c, d, b) <= 0) return false;
        }
    }
    return true;
}

/* Whether the outline can be built: it and those behind its walls are simple. */
static enum status check_outline(bool *closed, const struct suggestion *s, const struct outline *o, double thickness,
                                 struct err *err)
{
    struct wall_line *lines = malloc((size_t)o->count * sizeof *lines);
    double(*corners)[2] = malloc((size_t)o->count * sizeof *corners);
    *closed = false;
    if (!lines || !corners) err_nomem(err, "a room", (size_t)o->count * sizeof *lines);
    if (!err->status) {
        *closed = o->count >= 3;
        for (int i = 0; i < o->count && *closed; i++) {
            const int next = o->items[(i + 1) % o->count].wall;
            *closed = o->items[i].wall >= 0 && next >= 0 && wall_joins_has(s, o->items[i].wall, next);
            for (int k = 0; k < i && *closed; k++) *closed = o->items[k].wall != o->items[i].wall;
        }
        for (int part = 0; part < 3 && *closed; part++) { /* inner faces, middles, outer faces */
            for (int i = 0; i < o->count; i++) {
                const struct suggested_wall *w = &s->walls[o->items[i].wall];
                lines[i] = wall_side_line(w, o->items[i].side);
                lines[i].at -= 0.5 * part * (w->thickness > 0 ? (w->between ? 0.5 : 1) * w->thickness : thickness);
            }
            *closed = is_simple(lines, corners, o->count);
        }
    }
    free(lines);
    free(corners);
    return err->status;
}

static enum status add_room(struct suggestion *s, const struct outline *o, double thickness, struct err *err)
{
    struct suggested_room room = {s->room_wall_count, 0, false, {o->middle[0], o->middle[1]}, o->area};
    if (check_outline(&room.closed, s, o, thickness, err)) return err->status;
    for (int i = 0; i < o->count; i++) {
        if (o->items[i].wall < 0) continue;
        if (array_append(&s->room_walls, (size_t)s->room_wall_count, sizeof *s->room_walls, "walls of a room", err))
            return err->status;
        s->room_walls[s->room_wall_count++] = o->items[i].wall;
        room.count++;
    }
    if (array_append(&s->rooms, (size_t)s->room_count, sizeof *s->rooms, "rooms", err)) return err->status;
    s->rooms[s->room_count++] = room;
    return ST_OK;
}

enum status search_rooms(struct suggestion *s, struct plan_search *p, double thickness, struct err *err)
{
    unsigned char *seen = calloc((size_t)p->cells.edge_count, 1);
    struct outline *outlines = NULL;
    int count = 0;
    bool *gone = calloc((size_t)s->wall_count + 1, sizeof *gone);
    int *number = malloc(((size_t)s->wall_count + 1) * sizeof *number);
    if (!seen || !gone || !number) err_nomem(err, "edges of a plan", (size_t)p->cells.edge_count);
    for (int e = 0; e < p->cells.edge_count && !err->status; e++) {
        if (seen[e] || !is_border(p, e)) continue;
        if (array_append(&outlines, (size_t)count, sizeof *outlines, "borders of rooms", err)) break;
        outlines[count] = (struct outline){0};
        walk_border(&outlines[count++], p, e, seen, err);
    }
    for (int i = 0; i < count && !err->status; i++) {
        drop_short(&outlines[i], s, gone);
        for (int k = 0; k < outlines[i].count; k++) {
            const struct wall_side *a = &outlines[i].items[k], *b = &outlines[i].items[(k + 1) % outlines[i].count];
            if (a->wall >= 0 && b->wall >= 0 && a->wall != b->wall) wall_joins_add(s, a, b);
        }
    }
    if (!err->status) {
        wall_joins_fit(s, thickness);
        wall_joins_drop_unmet(s, thickness);
    }
    for (int i = 0; i < count && !err->status; i++) {
        reduce(&outlines[i]);
        if (outlines[i].area > 0) add_room(s, &outlines[i], thickness, err);
    }
    if (!err->status) remove_walls(s, gone, number);
    free(gone);
    free(number);
    for (int i = 0; i < count; i++) free(outlines[i].items);
    free(outlines);
    free(seen);
    return err->status;
}
