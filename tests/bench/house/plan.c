/* plan.c - the rooms of a house: a rectangle that is cut again and again, large parts along a corridor; then walls on
 * the cuts, doors that lead everywhere, windows.
 *
 * Doors are the edges of a spanning tree over rooms that share enough of a wall, those of corridors first, and some
 * more that close loops. */
#include "tests/bench/house/house.h"

#define OUTER     0.30
#define NARROWEST 2.3  /* least width of a room */
#define LONGEST   2.8  /* most length of a room, in widths */
#define END       0.35 /* between an opening and a corner, from centre line to opening */
#define GAP       0.4  /* between two openings of a wall */

/* --- cuts --- */

static double width_of(struct rect r) { return r.x1 - r.x0; }
static double depth_of(struct rect r) { return r.y1 - r.y0; }

static void add_room(struct house *h, struct rect r, bool corridor)
{
    h->corridor[h->room_count] = corridor;
    h->cells[h->room_count++] = r;
}

/* The rectangle from a to b of the longer side. */
static struct rect part_of(struct rect r, bool along_x, double a, double b)
{
    return along_x ? (struct rect){r.x0 + a, r.y0, r.x0 + b, r.y1} : (struct rect){r.x0, r.y0 + a, r.x1, r.y0 + b};
}

static void cut(struct house *h, struct rect r, int rooms, struct dice *d)
{
    const bool along_x = width_of(r) >= depth_of(r);
    if (rooms == 1) {
        add_room(h, r, false);
        return;
    }
    /* a corridor along the longer side, with rooms on both of its sides */
    const double across = along_x ? depth_of(r) : width_of(r);
    if (rooms >= 5 && across > 7) {
        const double wide = dice_length(d, 1.2, 1.7), first = dice_length(d, 0.42, 0.58) * (across - wide);
        const int left = (rooms - 1) / 2;
        add_room(h, part_of(r, !along_x, first, first + wide), true);
        cut(h, part_of(r, !along_x, 0, first), left, d);
        cut(h, part_of(r, !along_x, first + wide, across), rooms - 1 - left, d);
        return;
    }
    const int left = rooms / 2 + (rooms % 2 && dice_chance(d, 0.5));
    const double length = along_x ? width_of(r) : depth_of(r);
    const double at = round(100 * length * left / rooms * dice_between(d, 0.88, 1.12)) / 100;
    cut(h, part_of(r, along_x, 0, at), left, d);
    cut(h, part_of(r, along_x, at, length), rooms - left, d);
}

static bool rooms_are_wide(const struct house *h)
{
    for (int i = 0; i < h->room_count; i++) {
        const double w = width_of(h->cells[i]), v = depth_of(h->cells[i]), least = fmin(w, v), most = fmax(w, v);
        if (!h->corridor[i] && (least < NARROWEST || most > LONGEST * least)) return false;
    }
    return true;
}

/* --- walls --- */

static void swap_walls(struct house_wall *a, struct house_wall *b)
{
    const struct house_wall w = *a;
    *a = *b;
    *b = w;
}

/* Adds a side of a room; sides that touch on one line become one wall. */
static void add_side(struct house *h, bool upright, double at, double from, double to)
{
    struct house_wall w = {.upright = upright, .at = at, .from = from, .to = to};
    for (int i = 0; i < h->wall_count; i++) {
        struct house_wall *v = &h->walls[i];
        if (v->upright != upright || fabs(v->at - at) > 1e-6 || v->from > w.to + 1e-6 || v->to < w.from - 1e-6)
            continue;
        w.from = fmin(w.from, v->from);
        w.to = fmax(w.to, v->to);
        swap_walls(v, &h->walls[--h->wall_count]);
        i = -1;
    }
    h->walls[h->wall_count++] = w;
}

static void draw_walls(struct house *h, struct dice *d)
{
    for (int i = 0; i < h->room_count; i++) {
        const struct rect r = h->cells[i];
        add_side(h, false, r.y0, r.x0, r.x1);
        add_side(h, false, r.y1, r.x0, r.x1);
        add_side(h, true, r.x0, r.y0, r.y1);
        add_side(h, true, r.x1, r.y0, r.y1);
    }
    for (int i = 0; i < h->wall_count; i++) {
        struct house_wall *w = &h->walls[i];
        w->outer = w->at < 1e-6 || w->at > (w->upright ? h->wide : h->deep) - 1e-6;
        w->thickness = w->outer ? OUTER : dice_length(d, 0.11, 0.18);
    }
}

/* --- openings --- */

/* Whether nothing of a wall is within GAP of a part of it. */
static bool is_free(const struct house *h, int wall, double from, double to)
{
    for (int i = 0; i < h->door_count; i++)
        if (h->doors[i].wall == wall && from < h->doors[i].to + GAP && to > h->doors[i].from - GAP) return false;
    for (int i = 0; i < h->window_count; i++)
        if (h->windows[i].wall == wall && from < h->windows[i].to + GAP && to > h->windows[i].from - GAP) return false;
    for (int i = 0; i < h->bay_count; i++)
        if (h->bays[i].wall == wall && from < h->bays[i].to + 1 && to > h->bays[i].from - 1) return false;
    return true;
}

/* The part of a wall that a room lies along. */
static bool along(const struct house *h, int wall, int room, double *from, double *to, int *side)
{
    const struct house_wall *w = &h->walls[wall];
    const struct rect r = h->cells[room];
    const double low = w->upright ? r.x0 : r.y0, high = w->upright ? r.x1 : r.y1;
    *from = fmax(w->from, w->upright ? r.y0 : r.x0);
    *to = fmin(w->to, w->upright ? r.y1 : r.x1);
    *side = fabs(low - w->at) < 1e-6 ? 1 : fabs(high - w->at) < 1e-6 ? -1 : 0;
    return *side && *to > *from + 1e-6;
}

/* A place for an opening on what two rooms share of a wall; false: none is free. */
static bool draw_place(const struct house *h, int wall, double from, double to, double wide, double place[2],
                       struct dice *d)
{
    for (int i = 0; i < 40 && to - from > wide + 2 * END; i++) {
        place[0] = dice_length(d, from + END, to - END - wide);
        place[1] = place[0] + wide;
        if (is_free(h, wall, place[0], place[1])) return true;
    }
    return false;
}

static bool add_door(struct house *h, int a, int b, bool may_close, struct dice *d)
{
    for (int i = 0; i < h->wall_count && h->door_count < HOUSE_DOORS; i++) {
        double from[2], to[2], place[2];
        int side[2];
        struct house_door door = {.wall = i, .rooms = {a, b}};
        if (!along(h, i, a, &from[0], &to[0], &side[0])) continue;
        if (b >= 0 && (!along(h, i, b, &from[1], &to[1], &side[1]) || side[0] == side[1])) continue;
        if (b < 0 && !h->walls[i].outer) continue;
        const double low = b < 0 ? from[0] : fmax(from[0], from[1]), high = b < 0 ? to[0] : fmin(to[0], to[1]);
        door.kind = b < 0 ? DOOR_CLOSED : (enum door_kind)dice_choose(d, may_close ? DOOR_KINDS : DOOR_CLOSED);
        const double wide = door.kind == DOOR_WIDE ? dice_length(d, 1.1, 1.9) : dice_length(d, 0.72, 0.95);
        if (!draw_place(h, i, low, high, wide, place, d)) continue;
        door.from = place[0];
        door.to = place[1];
        door.high = door.kind == DOOR_WIDE ? dice_length(d, 2.1, 2.3) : dice_length(d, 1.98, 2.12);
        h->doors[h->door_count++] = door;
        return true;
    }
    return false;
}

static int group_of(const int *group, int room)
{
    while (group[room] != room) room = group[room];
    return room;
}

/* First doors of corridors, then of all rooms, until every room can be reached; then some more. */
static bool draw_doors(struct house *h, struct dice *d)
{
    int group[HOUSE_ROOMS], groups = h->room_count;
    for (int i = 0; i < h->room_count; i++) group[i] = i;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < h->room_count; i++)
            for (int k = 0; k < i; k++) {
                if (group_of(group, i) == group_of(group, k)) continue;
                if (pass == 0 && !h->corridor[i] && !h->corridor[k]) continue;
                if (!add_door(h, i, k, false, d)) continue;
                group[group_of(group, i)] = group_of(group, k);
                groups--;
            }
    for (int i = 0; i < h->room_count; i++)
        for (int k = 0; k < i; k++)
            if (!h->corridor[i] && !h->corridor[k] && dice_chance(d, 0.12)) add_door(h, i, k, true, d);
    if (groups > 1) return false;
    for (int i = 0; i < h->room_count; i++) /* the door of the house, into a corridor if one ends at an outer wall */
        if ((h->corridor[i] || h->room_count < 5) && add_door(h, i, -1, true, d)) return true;
    return add_door(h, 0, -1, true, d);
}

static void add_window(struct house *h, int wall, int room, double from, double to, struct dice *d)
{
    struct house_window w = {.wall = wall, .room = room};
    const int kind = dice_choose(d, 6); /* 0: to the floor; 1: a strip below the ceiling; others: usual */
    double place[2];
    const double wide = kind == 0   ? dice_length(d, 0.9, 2)
                        : kind == 1 ? dice_length(d, 1.2, 2.4)
                                    : dice_length(d, 0.7, 1.9);
    if (h->window_count >= HOUSE_WINDOWS || !draw_place(h, wall, from, to, wide, place, d)) return;
    w.from = place[0];
    w.to = place[1];
    w.z0 = kind == 0 ? 0.05 : kind == 1 ? dice_length(d, 1.4, 1.6) : dice_length(d, 0.7, 1);
    w.z1 = dice_length(d, 2.05, h->ceiling - 0.2);
    h->windows[h->window_count++] = w;
}

static bool add_bay(struct house *h, int wall, int room, double from, double to, int side, struct dice *d)
{
    struct house_bay b = {.wall = wall, .room = room, .out = -side, .depth = dice_length(d, 0.5, 0.9)};
    double place[2];
    if (h->bay_count >= HOUSE_BAYS || !draw_place(h, wall, from + 0.3, to - 0.3, dice_length(d, 1.8, 2.6), place, d))
        return false;
    b.from = place[0];
    b.to = place[1];
    h->bays[h->bay_count++] = b;
    return true;
}

/* Each outer side of a room gets windows, a bay, or a ceiling that slopes to it. */
static void draw_windows(struct house *h, struct dice *d)
{
    for (int room = 0; room < h->room_count; room++) {
        bool sloped = false, lit = false;
        for (int i = 0; i < h->wall_count; i++) {
            const struct house_wall *w = &h->walls[i];
            double from, to;
            int side;
            if (!w->outer || !along(h, i, room, &from, &to, &side)) continue;
            if (h->corridor[room]) {
                add_window(h, i, room, from, to, d);
                continue;
            }
            const double inwards = w->upright ? width_of(h->cells[room]) : depth_of(h->cells[room]);
            if (lit && !sloped && h->slope_count < HOUSE_SLOPES && inwards > 3 && dice_chance(d, 0.4)) {
                const enum made_side s =
                    w->upright ? (side > 0 ? SIDE_WEST : SIDE_EAST) : (side > 0 ? SIDE_SOUTH : SIDE_NORTH);
                if (is_free(h, i, from, to)) {
                    h->slopes[h->slope_count++] =
                        (struct house_slope){room, s, dice_length(d, 1.4, 1.7), dice_length(d, 0.9, 1.4)};
                    sloped = true;
                    continue;
                }
            }
            lit = true;
            if (to - from > 3.4 && dice_chance(d, 0.15) && add_bay(h, i, room, from, to, side, d)) continue;
            add_window(h, i, room, from, to, d);
            if (to - from > 3.5 && dice_chance(d, 0.6)) add_window(h, i, room, from, to, d);
        }
    }
}

bool house_plan(struct house *h, int rooms, int attempt)
{
    struct dice d = dice_make(h->seed, "house", attempt);
    const double area = rooms * dice_between(&d, 13, 19) * (rooms >= 5 ? 1.12 : 1), ratio = dice_between(&d, 1.05, 1.5);
    h->room_count = h->wall_count = h->door_count = h->window_count = h->bay_count = h->slope_count = 0;
    h->wide = round(100 * sqrt(area * ratio)) / 100;
    h->deep = round(100 * area / h->wide) / 100;
    h->ceiling = dice_length(&d, 2.45, 2.9);
    cut(h, (struct rect){0, 0, h->wide, h->deep}, rooms, &d);
    if (!rooms_are_wide(h)) return false;
    draw_walls(h, &d);
    if (!draw_doors(h, &d)) return false;
    draw_windows(h, &d);
    return h->window_count > 0;
}
