/* outline.c - the shape of a made room: walls, windows, the doorway, lamps and the sun.
 *
 * A rectangle, an L (a rectangle without its north-east corner), or two rooms, one north of the other. Walls run
 * counter-clockwise, so the room is on their left. The two walls at the inner corner of an L are shortened and
 * lengthened by half of their thickness, so that they meet in full. */
#include <string.h>

#include "tests/bench/room/made_room.h"

#define THICK      0.30
#define THIN       0.16
#define END        0.45 /* between an opening and the end of its wall, as seen in the room */
#define WINDOW_GAP 0.5  /* between two openings of a wall */

double made_wall_length(const struct made_wall *w) { return hypot(w->x1 - w->x0, w->y1 - w->y0); }

struct vec3 made_wall_normal(const struct made_wall *w)
{
    const double length = made_wall_length(w);
    return vec3_make(-(w->y1 - w->y0) / length, (w->x1 - w->x0) / length, 0);
}

struct vec3 made_wall_place(const struct made_wall *w, double s, double before)
{
    const double part = s / made_wall_length(w);
    const struct vec3 on = vec3_make(w->x0 + part * (w->x1 - w->x0), w->y0 + part * (w->y1 - w->y0), 0);
    return vec3_add(on, vec3_scale(made_wall_normal(w), before));
}

int made_area_of(const struct made_room *r, double x, double y, double margin)
{
    for (int i = 0; i < r->area_count; i++)
        if (rect_holds(r->areas[i], x, y, margin)) return i;
    return -1;
}

static void add_wall(struct made_room *r, const char *name, double x0, double y0, double x1, double y1,
                     double thickness, enum made_look look)
{
    r->walls[r->wall_count++] = (struct made_wall){name, x0, y0, x1, y1, thickness, look};
}

static void add_area(struct made_room *r, double x0, double y0, double x1, double y1)
{
    r->areas[r->area_count++] = (struct rect){x0, y0, x1, y1};
}

static enum made_look draw_wall_look(struct dice *d)
{
    static const enum made_look looks[] = {LOOK_WALL, LOOK_WALL, LOOK_WALL2, LOOK_ACCENT};
    return looks[dice_choose(d, 4)];
}

static void draw_rectangle(struct made_room *r, struct dice *d)
{
    const double half = THICK / 2, w = r->wide, h = r->deep;
    add_wall(r, "south", 0, 0, w, 0, THICK, draw_wall_look(d));
    add_wall(r, "east", w, 0, w, h, THICK, draw_wall_look(d));
    add_wall(r, "north", w, h, 0, h, THICK, draw_wall_look(d));
    add_wall(r, "west", 0, h, 0, 0, THICK, draw_wall_look(d));
    if (r->shape == SHAPE_RECTANGLE) {
        add_area(r, half, half, w - half, h - half);
        return;
    }
    add_wall(r, "partition", w, r->divide, 0, r->divide, THIN, draw_wall_look(d));
    add_area(r, half, half, w - half, r->divide - THIN / 2);
    add_area(r, half, r->divide + THIN / 2, w - half, h - half);
}

/* step and jut: the walls at the inner corner, facing south and east */
static void draw_l(struct made_room *r, struct dice *d)
{
    const double half = THICK / 2, w = r->wide, h = r->deep;
    const double x = dice_length(d, 0.48 * w, 0.62 * w), y = dice_length(d, 0.48 * h, 0.62 * h);
    const enum made_look inner = draw_wall_look(d);
    add_wall(r, "south", 0, 0, w, 0, THICK, draw_wall_look(d));
    add_wall(r, "east", w, 0, w, y, THICK, draw_wall_look(d));
    add_wall(r, "step", w, y, x - half, y, THICK, inner);
    add_wall(r, "jut", x, y + half, x, h, THICK, inner);
    add_wall(r, "north", x, h, 0, h, THICK, draw_wall_look(d));
    add_wall(r, "west", 0, h, 0, 0, THICK, draw_wall_look(d));
    add_area(r, half, half, w - half, y - half);
    add_area(r, half, half, x - half, h - half);
}

static void draw_shape(struct made_room *r, struct dice *d)
{
    struct dice first = dice_make(r->seed, "shape", 0); /* however many attempts a shape takes */
    r->shape = (enum made_shape)dice_choose(&first, SHAPE_COUNT);
    r->ceiling = dice_length(d, 2.4, 3.0);
    r->wide = dice_length(d, 4.0, 6.2);
    r->deep = dice_length(d, 3.8, 5.2);
    if (r->shape == SHAPE_L) {
        r->wide = dice_length(d, 5.4, 7.0);
        r->deep = dice_length(d, 5.4, 6.6);
    } else if (r->shape == SHAPE_TWO_ROOMS) {
        r->divide = dice_length(d, 3.8, 4.6);
        r->deep = r->divide + dice_length(d, 3.7, 4.3);
    }
    if (r->shape == SHAPE_L)
        draw_l(r, d);
    else
        draw_rectangle(r, d);
}

/* --------------------------------------------------------------------------------------------------------- openings */

static bool is_outer(const struct made_wall *w)
{
    return strcmp(w->name, "step") && strcmp(w->name, "jut") && strcmp(w->name, "partition");
}

/* Whether both ends of an opening are before one area's wall, away from its corners and from other openings. */
static bool fits_wall(const struct made_room *r, const struct made_opening *o)
{
    const struct made_wall *w = &r->walls[o->wall];
    const struct vec3 a = made_wall_place(w, o->s0 - END, w->thickness / 2 + 0.01);
    const struct vec3 b = made_wall_place(w, o->s1 + END, w->thickness / 2 + 0.01);
    const int area = made_area_of(r, a.x, a.y, 0);
    if (area < 0 || !rect_holds(r->areas[area], b.x, b.y, 0)) return false;
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *other = &r->openings[i];
        if (other->wall == o->wall && o->s0 < other->s1 + WINDOW_GAP && other->s0 < o->s1 + WINDOW_GAP) return false;
    }
    return true;
}

static void add_doorway(struct made_room *r, struct dice *d)
{
    const int wall = r->wall_count - 1;
    const double width = dice_length(d, 0.9, 1.3), length = made_wall_length(&r->walls[wall]);
    const double s = dice_length(d, 0.9, length - 0.9 - width);
    r->openings[r->opening_count++] =
        (struct made_opening){"doorway", wall, false, s, s + width, 0, dice_length(d, 2.0, 2.15)};
}

/* A window into an area; false: none was found that fits. */
static bool add_window(struct made_room *r, int area, struct dice *d)
{
    static const char *const names[] = {"window1", "window2", "window3"};
    for (int i = 0; i < 100; i++) {
        struct made_opening o = {.window = true, .wall = dice_choose(d, r->wall_count)};
        const struct made_wall *w = &r->walls[o.wall];
        o.s0 = dice_length(d, END, made_wall_length(w) - END);
        o.s1 = o.s0 + dice_length(d, 1.0, 2.0);
        o.z0 = dice_length(d, 0.75, 1.0);
        o.z1 = dice_length(d, 2.0, fmin(2.3, r->ceiling - 0.2));
        const struct vec3 middle = made_wall_place(w, (o.s0 + o.s1) / 2, w->thickness / 2 + 0.01);
        if (!is_outer(w) || !rect_holds(r->areas[area], middle.x, middle.y, 0) || !fits_wall(r, &o)) continue;
        const int before = r->opening_count - (r->shape == SHAPE_TWO_ROOMS);
        snprintf(o.name, sizeof o.name, "%s", names[before]);
        r->openings[r->opening_count++] = o;
        return true;
    }
    return false;
}

static bool draw_openings(struct made_room *r, struct dice *d)
{
    const int wanted = 1 + dice_choose(d, 3);
    if (r->shape == SHAPE_TWO_ROOMS) add_doorway(r, d);
    for (int i = 0; i < r->area_count; i++)
        if (!add_window(r, i, d)) return false;
    for (int i = r->area_count; i < wanted; i++) add_window(r, dice_choose(d, r->area_count), d);
    return true;
}

#define GROWN 0.4 /* most that a side of a window moves outwards */

void made_larger_window(struct made_room *r)
{
    r->widened = 0;
    while (!r->openings[r->widened].window) r->widened++;
    const struct made_opening *before = &r->openings[r->widened];
    double low = END, high = made_wall_length(&r->walls[before->wall]) - END;
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *o = &r->openings[i];
        if (i == r->widened || o->wall != before->wall) continue;
        if (o->s0 > before->s1) high = fmin(high, o->s0 - WINDOW_GAP / 2);
        if (o->s1 < before->s0) low = fmax(low, o->s1 + WINDOW_GAP / 2);
    }
    r->larger = *before;
    r->larger.s0 = fmax(low, before->s0 - GROWN);
    r->larger.s1 = fmin(high, before->s1 + GROWN);
    r->larger.z0 = before->z0 - GROWN;
}

/* ------------------------------------------------------------------------------------------------------------ light */

static void draw_lamps(struct made_room *r, struct dice *d)
{
    for (int i = 0; i < r->area_count; i++) {
        const struct rect a = r->areas[i];
        struct made_lamp *lamp = &r->lamps[r->lamp_count++];
        const double warm = dice_between(d, 0.82, 0.95), power = dice_between(d, 14, 18);
        lamp->side = dice_length(d, 0.8, 1.1);
        lamp->x = dice_length(d, 0.42, 0.58) * (a.x1 - a.x0) + a.x0 - lamp->side / 2;
        lamp->y = dice_length(d, 0.42, 0.58) * (a.y1 - a.y0) + a.y0 - lamp->side / 2;
        lamp->radiance[0] = power;
        lamp->radiance[1] = 0.5 * (1 + warm) * power;
        lamp->radiance[2] = warm * power;
    }
}

/* The sun shines through the first window. */
static void draw_sun(struct made_room *r, struct dice *d)
{
    for (int i = 0; i < r->opening_count; i++) {
        if (!r->openings[i].window) continue;
        const struct vec3 in = made_wall_normal(&r->walls[r->openings[i].wall]);
        r->sun_azimuth = round(atan2(-in.y, -in.x) * 180 / M_PI + dice_between(d, -45, 45));
        r->sun_elevation = round(dice_between(d, 25, 45));
        return;
    }
}

/* Lamps of an L whose two areas overlap may do so, too. */
static bool lamps_overlap(const struct made_room *r)
{
    if (r->lamp_count < 2) return false;
    const struct made_lamp *a = &r->lamps[0], *b = &r->lamps[1];
    return a->x < b->x + b->side && b->x < a->x + a->side && a->y < b->y + b->side && b->y < a->y + a->side;
}

bool made_outline(struct made_room *r, int attempt)
{
    struct dice d = dice_make(r->seed, "outline", attempt);
    draw_shape(r, &d);
    if (!draw_openings(r, &d)) return false;
    draw_lamps(r, &d);
    draw_sun(r, &d);
    return !lamps_overlap(r);
}
