/* furnish.c - what stands and hangs in the rooms of a house, their lamps, and where photos are taken. */
#include <string.h>

#include "tests/bench/house/house.h"
#include "tests/bench/room/sight.h"

#define EYE   1.5
#define APART 0.25 /* least between two cameras of a room: houses have many */

/* The wall of the house on a side of a room. Each side has one; -1 would be a fault of the plan. */
static int wall_of(const struct house *h, struct rect r, int side)
{
    const bool upright = side == SIDE_EAST || side == SIDE_WEST;
    const double at = side == SIDE_SOUTH ? r.y0 : side == SIDE_NORTH ? r.y1 : side == SIDE_WEST ? r.x0 : r.x1;
    const double middle = upright ? (r.y0 + r.y1) / 2 : (r.x0 + r.x1) / 2;
    for (int i = 0; i < h->wall_count; i++) {
        const struct house_wall *w = &h->walls[i];
        if (w->upright == upright && fabs(w->at - at) < 1e-6 && middle > w->from && middle < w->to) return i;
    }
    return -1;
}

/* Adds an opening of a wall of the house to the room's wall; places of south and east walls run as the house's do. */
static void add_opening(struct made_room *r, struct rect cell, int side, bool window, double from, double to, double z0,
                        double z1)
{
    struct made_opening o = {.wall = side, .window = window, .z0 = z0, .z1 = z1};
    const double start = side == SIDE_SOUTH   ? cell.x0
                         : side == SIDE_EAST  ? cell.y0
                         : side == SIDE_NORTH ? -cell.x1
                                              : -cell.y1;
    const double a = side == SIDE_SOUTH || side == SIDE_EAST ? from - start : -to - start;
    if (r->opening_count >= MADE_OPENINGS) return;
    o.s0 = a;
    o.s1 = a + to - from;
    snprintf(o.name, sizeof o.name, "opening%d", r->opening_count + 1);
    r->openings[r->opening_count++] = o;
}

static void outline(struct made_room *r, const struct house *h, int room)
{
    static const char *const names[] = {"south", "east", "north", "west"};
    const struct rect c = h->cells[room];
    const double ends[4][4] = {
        {c.x0, c.y0, c.x1, c.y0}, {c.x1, c.y0, c.x1, c.y1}, {c.x1, c.y1, c.x0, c.y1}, {c.x0, c.y1, c.x0, c.y0}};
    double half[4];
    memset(r, 0, sizeof *r);
    r->seed = 64 * h->seed + room;
    snprintf(r->prefix, sizeof r->prefix, "r%d-", room + 1);
    r->shape = SHAPE_RECTANGLE;
    r->wide = h->wide;
    r->deep = h->deep;
    r->ceiling = h->ceiling;
    r->after.x = r->after.y = -100; /* no edit moves a piece */
    for (int k = 0; k < 4; k++) {
        const int wall = wall_of(h, c, k);
        const double thickness = h->walls[wall].thickness;
        half[k] = thickness / 2;
        r->walls[r->wall_count++] =
            (struct made_wall){names[k], ends[k][0], ends[k][1], ends[k][2], ends[k][3], thickness, LOOK_WALL};
        for (int i = 0; i < h->door_count; i++) {
            const struct house_door *d = &h->doors[i];
            if (d->wall == wall && (d->rooms[0] == room || d->rooms[1] == room))
                add_opening(r, c, k, false, d->from, d->to, 0, d->high);
        }
        for (int i = 0; i < h->window_count; i++)
            if (h->windows[i].wall == wall && h->windows[i].room == room)
                add_opening(r, c, k, true, h->windows[i].from, h->windows[i].to, h->windows[i].z0, h->windows[i].z1);
        for (int i = 0; i < h->bay_count; i++)
            if (h->bays[i].wall == wall && h->bays[i].room == room)
                add_opening(r, c, k, false, h->bays[i].from, h->bays[i].to, 0, h->ceiling - 0.2);
    }
    r->areas[r->area_count++] =
        (struct rect){c.x0 + half[SIDE_WEST], c.y0 + half[SIDE_SOUTH], c.x1 - half[SIDE_EAST], c.y1 - half[SIDE_NORTH]};
}

/* Where the ceiling is low, as a rectangle of the room. */
static struct rect below_slope(struct rect a, const struct house_slope *s)
{
    if (s->side == SIDE_SOUTH) a.y1 = a.y0 + s->deep;
    if (s->side == SIDE_NORTH) a.y0 = a.y1 - s->deep;
    if (s->side == SIDE_WEST) a.x1 = a.x0 + s->deep;
    if (s->side == SIDE_EAST) a.x0 = a.x1 - s->deep;
    return a;
}

static const struct house_slope *slope_of(const struct house *h, int room)
{
    for (int i = 0; i < h->slope_count; i++)
        if (h->slopes[i].room == room) return &h->slopes[i];
    return NULL;
}

/* Tall pieces do not fit below a ceiling that slopes. */
static void drop_tall(struct made_room *r, const struct house_slope *s)
{
    const struct rect low = below_slope(r->areas[0], s);
    int kept = 0;
    for (int i = 0; i < r->piece_count; i++) {
        const struct made_piece *p = &r->pieces[i];
        const double reach = hypot(p->wide, p->deep) / 2;
        const bool near =
            p->x + reach > low.x0 && p->x - reach < low.x1 && p->y + reach > low.y0 && p->y - reach < low.y1;
        if (!near || p->high < s->knee - 0.1) r->pieces[kept++] = *p;
    }
    r->piece_count = kept;
}

static void hang_lamp(struct made_room *r, const struct house_slope *s, struct dice *d)
{
    struct rect a = r->areas[0];
    struct made_lamp *lamp = &r->lamps[r->lamp_count++];
    const double warm = dice_between(d, 0.82, 0.95), power = dice_between(d, 14, 18);
    if (s && s->side == SIDE_SOUTH) a.y0 += s->deep;
    if (s && s->side == SIDE_NORTH) a.y1 -= s->deep;
    if (s && s->side == SIDE_WEST) a.x0 += s->deep;
    if (s && s->side == SIDE_EAST) a.x1 -= s->deep;
    lamp->side = fmin(dice_length(d, 0.7, 1.1), 0.5 * fmin(a.x1 - a.x0, a.y1 - a.y0));
    lamp->x = (a.x0 + a.x1 - lamp->side) / 2;
    lamp->y = (a.y0 + a.y1 - lamp->side) / 2;
    lamp->radiance[0] = power;
    lamp->radiance[1] = 0.5 * (1 + warm) * power;
    lamp->radiance[2] = warm * power;
}

static void add_photo(struct made_room *r, struct vec3 at, struct vec3 look_at)
{
    if (r->photo_count < MADE_PHOTOS) r->photos[r->photo_count++] = photo_looking(at, look_at);
}

/* From both rooms of each door that is not closed through it: these photos connect the rooms. */
static int photograph_doors(struct house *h, int most)
{
    int count = 0;
    for (int i = 0; i < h->door_count && count + 2 <= most; i++) {
        const struct house_door *d = &h->doors[i];
        const struct house_wall *w = &h->walls[d->wall];
        if (d->kind == DOOR_CLOSED || d->rooms[1] < 0) continue;
        const double s = round(100 * (d->from + d->to) / 2) / 100;
        for (int k = 0; k < 2; k++) {
            const struct rect c = h->cells[d->rooms[k]];
            const double middle = w->upright ? (c.x0 + c.x1) / 2 : (c.y0 + c.y1) / 2;
            const double room = w->upright ? c.x1 - c.x0 : c.y1 - c.y0, before = fmin(0.95, room - w->thickness - 0.35);
            const double way = middle > w->at ? 1 : -1, at = w->at + way * round(100 * before) / 100;
            const double to = w->at - way * 2;
            add_photo(&h->rooms[d->rooms[k]], w->upright ? vec3_make(at, s, EYE) : vec3_make(s, at, EYE),
                      w->upright ? vec3_make(to, s, 1.15) : vec3_make(s, to, 1.15));
            count++;
        }
    }
    return count;
}

int house_furnish(struct house *h, int views)
{
    double area = 0, done = 0;
    int photos, taken;
    for (int i = 0; i < h->room_count; i++) {
        struct made_room *r = &h->rooms[i];
        struct dice d = dice_make(64 * h->seed + i, "lamp", 0);
        const struct house_slope *s = slope_of(h, i);
        outline(r, h, i);
        r->blank = dice_chance(&d, 0.25);
        /* what fits: unlike a room alone, one of a house may have little in it */
        if (!h->corridor[i]) made_furniture(r, 0);
        r->after = (struct made_piece){.x = -100, .y = -100};
        if (s) drop_tall(r, s);
        made_pictures(r, 0);
        if (r->areas[0].x1 - r->areas[0].x0 < 2.6 || r->areas[0].y1 - r->areas[0].y0 < 2.4) r->rug_count = 0;
        hang_lamp(r, s, &d);
        area += (h->cells[i].x1 - h->cells[i].x0) * (h->cells[i].y1 - h->cells[i].y0);
    }
    photos = taken = photograph_doors(h, views);
    /* the rest by area */
    for (int i = 0; i < h->room_count; i++) {
        struct made_room *r = &h->rooms[i];
        done += (h->cells[i].x1 - h->cells[i].x0) * (h->cells[i].y1 - h->cells[i].y0);
        const int wanted = (int)round((views - taken) * done / area) - (photos - taken), before = r->photo_count;
        if (wanted > 0) photos += made_photos_of_area(r, before + wanted, APART) - before;
    }
    return photos;
}
