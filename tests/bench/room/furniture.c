/* furniture.c - furniture of made rooms: kinds made of boxes, and where they stand.
 *
 * A kind is a table of boxes. The coordinates of a box are linear in the size of the piece, a share of it and metres:
 * {1, -0.2} is 20 cm before the end. x runs along the back, from left to right for a viewer in front of the piece who
 * looks north; y from the front to the back; z up.
 *
 * Pieces are placed one after another, at random until one fits: inside the room, apart from other pieces, not before
 * the doorway and, if the piece is tall, not before a window. An edit clears one free-standing piece and moves another
 * one to a free place. */
#include <stddef.h>

#include "tests/bench/room/made_room.h"

struct part {
    const char *name;
    double x0[2], x1[2], y0[2], y1[2], z0[2], z1[2];
    enum made_look look; /* LOOK_WOOD and LOOK_CLOTH: those of the piece */
};

enum place { AT_WALL, FREE };
enum { MAX_PARTS = 12 };

struct kind {
    const char *name;
    enum place place;
    int most;                           /* how many of them a room has */
    double wide[2], deep[2], high[2];   /* smallest, largest */
    const struct part parts[MAX_PARTS]; /* the last has no name */
};

#define ALL \
    {0, 0}, { 1, 0 }
#define LEG 0.06

/* four legs, IN from the edges, up to a height */
#define LEGS(in, ...)                                                                                 \
    {"leg1", {0, in}, {0, in + LEG}, {0, in}, {0, in + LEG}, {0, 0}, {__VA_ARGS__}, LOOK_WOOD},       \
        {"leg2", {1, -in - LEG}, {1, -in}, {0, in}, {0, in + LEG}, {0, 0}, {__VA_ARGS__}, LOOK_WOOD}, \
        {"leg3", {0, in}, {0, in + LEG}, {1, -in - LEG}, {1, -in}, {0, 0}, {__VA_ARGS__}, LOOK_WOOD}, \
    {                                                                                                 \
        "leg4", {1, -in - LEG}, {1, -in}, {1, -in - LEG}, {1, -in}, {0, 0}, {__VA_ARGS__}, LOOK_WOOD  \
    }

static const struct kind kinds[] = {
    {"coffee-table",
     FREE,
     1,
     {0.9, 1.3},
     {0.55, 0.75},
     {0.38, 0.48},
     {{"top", ALL, ALL, {1, -0.04}, {1, 0}, LOOK_WOOD},
      LEGS(0.05, 1, -0.04),
      {"magazine", {0.15, 0}, {0.15, 0.3}, {0.3, 0}, {0.3, 0.22}, {1, 0}, {1, 0.03}, LOOK_PATTERN},
      {"vase", {0.75, 0}, {0.75, 0.1}, {0.5, 0}, {0.5, 0.1}, {1, 0}, {1, 0.24}, LOOK_CLAY}}},
    {"table",
     FREE,
     1,
     {1.2, 1.6},
     {0.75, 0.9},
     {0.72, 0.76},
     {{"top", ALL, ALL, {1, -0.04}, {1, 0}, LOOK_WOOD},
      LEGS(0.05, 1, -0.04),
      {"cloth", {0.3, 0}, {0.7, 0}, {0.2, 0}, {0.8, 0}, {1, 0}, {1, 0.008}, LOOK_PATTERN},
      {"bowl", {0.5, -0.12}, {0.5, 0.12}, {0.5, -0.12}, {0.5, 0.12}, {1, 0.008}, {1, 0.1}, LOOK_CLAY}}},
    {"chair",
     FREE,
     2,
     {0.44, 0.5},
     {0.46, 0.52},
     {0.86, 0.98},
     {{"seat", ALL, ALL, {0, 0.42}, {0, 0.48}, LOOK_CLOTH},
      LEGS(0.02, 0, 0.42),
      {"back", ALL, {1, -0.05}, {1, 0}, {0, 0.48}, {1, 0}, LOOK_CLOTH}}},
    {"armchair",
     FREE,
     1,
     {0.75, 0.9},
     {0.75, 0.85},
     {0.75, 0.9},
     {{"seat", {0, 0.14}, {1, -0.14}, {0, 0}, {1, -0.18}, {0, 0.06}, {0, 0.42}, LOOK_CLOTH},
      {"back", {0, 0.14}, {1, -0.14}, {1, -0.18}, {1, 0}, {0, 0.06}, {1, 0}, LOOK_CLOTH},
      {"left", {0, 0}, {0, 0.14}, ALL, {0, 0.06}, {0, 0.6}, LOOK_CLOTH},
      {"right", {1, -0.14}, {1, 0}, ALL, {0, 0.06}, {0, 0.6}, LOOK_CLOTH},
      {"cushion", {0.5, -0.2}, {0.5, 0.2}, {1, -0.32}, {1, -0.19}, {0, 0.42}, {0, 0.8}, LOOK_PATTERN}}},
    {"stool", FREE, 1, {0.36, 0.45}, {0.36, 0.45}, {0.42, 0.5}, {{"block", ALL, ALL, ALL, LOOK_WOOD}}},
    {"chest",
     FREE,
     1,
     {0.8, 1.1},
     {0.45, 0.55},
     {0.42, 0.5},
     {{"body", ALL, ALL, {0, 0}, {1, -0.06}, LOOK_WOOD},
      {"lid", {0, -0.02}, {1, 0.02}, {0, -0.02}, {1, 0.02}, {1, -0.06}, {1, 0}, LOOK_CLOTH}}},
    {"sofa",
     AT_WALL,
     1,
     {1.7, 2.3},
     {0.8, 0.95},
     {0.78, 0.9},
     {{"seat", {0, 0.17}, {1, -0.17}, {0, 0}, {1, -0.22}, {0, 0.08}, {0, 0.43}, LOOK_CLOTH},
      {"back", {0, 0.17}, {1, -0.17}, {1, -0.22}, {1, 0}, {0, 0.08}, {1, 0}, LOOK_CLOTH},
      {"left", {0, 0}, {0, 0.17}, ALL, {0, 0.08}, {0, 0.62}, LOOK_CLOTH},
      {"right", {1, -0.17}, {1, 0}, ALL, {0, 0.08}, {0, 0.62}, LOOK_CLOTH},
      {"cushion1", {0, 0.25}, {0, 0.67}, {1, -0.36}, {1, -0.23}, {0, 0.43}, {0, 0.82}, LOOK_PATTERN},
      {"cushion2", {1, -0.62}, {1, -0.22}, {1, -0.36}, {1, -0.23}, {0, 0.43}, {0, 0.8}, LOOK_LINEN}}},
    {"shelf",
     AT_WALL,
     1,
     {0.9, 1.6},
     {0.28, 0.34},
     {1.82, 2.0},
     {{"case", ALL, {0, 0.006}, {1, 0}, ALL, LOOK_WOOD},
      {"row1", {0, 0.04}, {1, -0.04}, {0, 0}, {0, 0.006}, {0, 0.06}, {0, 0.4}, LOOK_BOOKS},
      {"row2", {0, 0.04}, {1, -0.04}, {0, 0}, {0, 0.006}, {0, 0.46}, {0, 0.8}, LOOK_BOOKS},
      {"row3", {0, 0.04}, {1, -0.04}, {0, 0}, {0, 0.006}, {0, 0.86}, {0, 1.2}, LOOK_BOOKS},
      {"row4", {0, 0.04}, {1, -0.04}, {0, 0}, {0, 0.006}, {0, 1.26}, {0, 1.6}, LOOK_BOOKS}}},
    {"wardrobe",
     AT_WALL,
     1,
     {1.0, 1.5},
     {0.56, 0.62},
     {1.9, 2.1},
     {{"body", ALL, {0, 0.02}, {1, 0}, ALL, LOOK_WOOD},
      {"door1", {0, 0.02}, {0.5, -0.01}, {0, 0}, {0, 0.02}, {0, 0.08}, {1, -0.02}, LOOK_WOOD},
      {"door2", {0.5, 0.01}, {1, -0.02}, {0, 0}, {0, 0.02}, {0, 0.08}, {1, -0.02}, LOOK_WOOD},
      {"knob1", {0.5, -0.07}, {0.5, -0.04}, {0, -0.03}, {0, 0}, {0.5, 0}, {0.5, 0.12}, LOOK_DARK},
      {"knob2", {0.5, 0.04}, {0.5, 0.07}, {0, -0.03}, {0, 0}, {0.5, 0}, {0.5, 0.12}, LOOK_DARK}}},
    {"sideboard",
     AT_WALL,
     1,
     {1.2, 1.7},
     {0.4, 0.46},
     {0.72, 0.84},
     {{"body", ALL, ALL, {0, 0.08}, {1, 0}, LOOK_WOOD},
      {"foot", {0, 0.06}, {1, -0.06}, {0, 0.06}, {1, -0.02}, {0, 0}, {0, 0.08}, LOOK_DARK},
      {"record", {0.15, 0}, {0.15, 0.36}, {0.5, -0.14}, {0.5, 0.14}, {1, 0}, {1, 0.12}, LOOK_DARK},
      {"jug", {0.78, 0}, {0.78, 0.14}, {0.5, -0.07}, {0.5, 0.07}, {1, 0}, {1, 0.26}, LOOK_CLAY}}},
    {"bed",
     AT_WALL,
     1,
     {1.0, 1.6},
     {2.0, 2.1},
     {0.8, 1.0},
     {{"frame", ALL, {0, 0}, {1, -0.06}, {0, 0.1}, {0, 0.3}, LOOK_WOOD},
      {"head", ALL, {1, -0.06}, {1, 0}, {0, 0}, {1, 0}, LOOK_WOOD},
      {"mattress", {0, 0.03}, {1, -0.03}, {0, 0.03}, {1, -0.06}, {0, 0.3}, {0, 0.5}, LOOK_LINEN},
      {"blanket", {0, 0.01}, {1, -0.01}, {0, 0.01}, {0.6, 0}, {0, 0.32}, {0, 0.54}, LOOK_CLOTH},
      {"pillow", {0.12, 0}, {0.88, 0}, {1, -0.5}, {1, -0.1}, {0, 0.5}, {0, 0.62}, LOOK_PATTERN}}},
    {"desk",
     AT_WALL,
     1,
     {1.2, 1.5},
     {0.6, 0.7},
     {0.72, 0.76},
     {{"top", ALL, ALL, {1, -0.04}, {1, 0}, LOOK_WOOD},
      {"side", {0, 0.02}, {0, 0.06}, {0, 0.04}, {1, -0.04}, {0, 0}, {1, -0.04}, LOOK_WOOD},
      {"drawers", {1, -0.42}, {1, -0.02}, {0, 0.04}, {1, -0.04}, {0, 0}, {1, -0.04}, LOOK_WOOD},
      {"screen", {0.35, -0.27}, {0.35, 0.27}, {1, -0.2}, {1, -0.16}, {1, 0.08}, {1, 0.42}, LOOK_DARK},
      {"stand", {0.35, -0.1}, {0.35, 0.1}, {1, -0.24}, {1, -0.12}, {1, 0}, {1, 0.08}, LOOK_DARK},
      {"books", {0.75, 0}, {0.75, 0.2}, {1, -0.28}, {1, -0.06}, {1, 0}, {1, 0.24}, LOOK_BOOKS}}},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

#define TALL       0.7  /* height from which a piece must not stand before a window */
#define GAP        0.30 /* between a free piece and others */
#define WALL_GAP   0.10 /* between pieces at walls */
#define BACK       0.03 /* between a piece and its wall */
#define DOOR_SPACE 1.1  /* kept free on either side of a doorway */
#define TRIES      300

/* ------------------------------------------------------------------------------------------------------------ boxes */

static double at(const double linear[2], double size) { return linear[0] * size + linear[1]; }

int made_box_count(const struct made_piece *p)
{
    int n = 0;
    while (n < MAX_PARTS && kinds[p->kind].parts[n].name) n++;
    return n;
}

/* A place of the piece's own frame, from the middle of its footprint. */
static struct vec3 placed(const struct made_piece *p, double x, double y, double z)
{
    const double a = p->turn * M_PI / 180, c = cos(a), s = sin(a);
    return vec3_make(p->x + c * x - s * y, p->y + s * x + c * y, z);
}

struct made_box made_box_of(const struct made_piece *p, int k)
{
    const struct part *part = &kinds[p->kind].parts[k];
    const double x0 = at(part->x0, p->wide), x1 = at(part->x1, p->wide);
    const double y0 = at(part->y0, p->deep), y1 = at(part->y1, p->deep);
    const double z0 = at(part->z0, p->high), z1 = at(part->z1, p->high);
    struct made_box b = {.name = part->name, .turn = p->turn, .look = part->look};
    b.middle = placed(p, (x0 + x1 - p->wide) / 2, (y0 + y1 - p->deep) / 2, (z0 + z1) / 2);
    b.half = vec3_make((x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2);
    if (b.look == LOOK_WOOD) b.look = p->wood;
    if (b.look == LOOK_CLOTH) b.look = p->cloth;
    return b;
}

/* ----------------------------------------------------------------------------------------------------------- places */

bool made_piece_near(const struct made_piece *p, double x, double y, double margin)
{
    const double a = p->turn * M_PI / 180, c = cos(a), s = sin(a), dx = x - p->x, dy = y - p->y;
    return fabs(c * dx + s * dy) < p->wide / 2 + margin && fabs(c * dy - s * dx) < p->deep / 2 + margin;
}

static void corners_of(struct vec3 corner[4], const struct made_piece *p, double margin)
{
    const double x = p->wide / 2 + margin, y = p->deep / 2 + margin;
    corner[0] = placed(p, -x, -y, 0);
    corner[1] = placed(p, x, -y, 0);
    corner[2] = placed(p, x, y, 0);
    corner[3] = placed(p, -x, y, 0);
}

/* Whether an axis of p separates the corners from p. */
static bool separated(const struct made_piece *p, const struct vec3 corner[4], double margin)
{
    const double a = p->turn * M_PI / 180, c = cos(a), s = sin(a);
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        const double dx = corner[i].x - p->x, dy = corner[i].y - p->y, along[2] = {c * dx + s * dy, c * dy - s * dx};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], along[k]);
            high[k] = fmax(high[k], along[k]);
        }
    }
    const double half[2] = {p->wide / 2 + margin, p->deep / 2 + margin};
    return low[0] > half[0] || high[0] < -half[0] || low[1] > half[1] || high[1] < -half[1];
}

/* Whether the footprints come nearer than a margin. */
static bool overlap(const struct made_piece *p, const struct made_piece *q, double margin)
{
    struct vec3 of_p[4], of_q[4];
    corners_of(of_p, p, margin);
    corners_of(of_q, q, margin);
    return !separated(p, of_q, 0) && !separated(q, of_p, 0);
}

static bool inside(const struct made_room *r, const struct made_piece *p, double margin)
{
    struct vec3 corner[4];
    corners_of(corner, p, margin);
    for (int i = 0; i < r->area_count; i++) {
        bool all = true;
        for (int k = 0; k < 4; k++) all = all && rect_holds(r->areas[i], corner[k].x, corner[k].y, 0);
        if (all) return true;
    }
    return false;
}

/* The space before an opening, on both sides of its wall, as the footprint of a piece. */
static struct made_piece space_before(const struct made_room *r, const struct made_opening *o)
{
    const struct made_wall *w = &r->walls[o->wall];
    const struct vec3 middle = made_wall_place(w, (o->s0 + o->s1) / 2, 0);
    const double space = o->window ? w->thickness / 2 + 0.6 : DOOR_SPACE + w->thickness / 2;
    return (struct made_piece){.x = middle.x,
                               .y = middle.y,
                               .turn = atan2(w->y1 - w->y0, w->x1 - w->x0) * 180 / M_PI,
                               .wide = o->s1 - o->s0 + 0.1,
                               .deep = 2 * space};
}

static bool keeps_openings(const struct made_room *r, const struct made_piece *p)
{
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_piece space = space_before(r, &r->openings[i]);
        if (r->openings[i].window && p->high < TALL) continue;
        if (overlap(&space, p, 0)) return false;
    }
    return true;
}

static double gap_of(const struct made_piece *p, const struct made_piece *q)
{
    return kinds[p->kind].place == FREE || kinds[q->kind].place == FREE ? GAP : WALL_GAP;
}

/* Whether a piece may stand there, whatever piece `self` does. */
static bool fits(const struct made_room *r, const struct made_piece *p, int self)
{
    const double margin = kinds[p->kind].place == FREE ? GAP : 0;
    if (!inside(r, p, margin) || !keeps_openings(r, p)) return false;
    for (int i = 0; i < r->piece_count; i++)
        if (i != self && overlap(p, &r->pieces[i], gap_of(p, &r->pieces[i]) / 2)) return false;
    return true;
}

/* A place at a wall: a side of an area, with no area behind it. */
static bool draw_at_wall(const struct made_room *r, struct made_piece *p, struct dice *d)
{
    const struct rect a = r->areas[dice_choose(d, r->area_count)];
    const int side = dice_choose(d, 4); /* the back faces north, west, south, east */
    const double half = p->wide / 2, off = p->deep / 2 + BACK;
    p->turn = 90 * side;
    if (side % 2) {
        p->x = side == 1 ? a.x0 + off : a.x1 - off;
        p->y = dice_length(d, a.y0 + half, a.y1 - half);
    } else {
        p->x = dice_length(d, a.x0 + half, a.x1 - half);
        p->y = side == 0 ? a.y1 - off : a.y0 + off;
    }
    for (int k = -1; k <= 1; k++) {
        const struct vec3 behind = placed(p, 0.9 * k * half, off + 0.05, 0);
        if (made_area_of(r, behind.x, behind.y, 0) >= 0) return false;
    }
    return true;
}

static void draw_free(const struct made_room *r, struct made_piece *p, struct dice *d)
{
    const struct rect a = r->areas[dice_choose(d, r->area_count)];
    p->x = dice_length(d, a.x0, a.x1);
    p->y = dice_length(d, a.y0, a.y1);
    p->turn = 90 * dice_choose(d, 4);
    if (dice_chance(d, 0.4)) p->turn += round(dice_between(d, -35, 35));
}

static struct made_piece draw_size(int kind, struct dice *d)
{
    const struct kind *k = &kinds[kind];
    return (struct made_piece){.kind = kind,
                               .wide = dice_length(d, k->wide[0], k->wide[1]),
                               .deep = dice_length(d, k->deep[0], k->deep[1]),
                               .high = dice_length(d, k->high[0], k->high[1]),
                               .wood = dice_chance(d, 0.5) ? LOOK_WOOD : LOOK_WOOD2,
                               .cloth = dice_chance(d, 0.5) ? LOOK_CLOTH : LOOK_CLOTH2};
}

static int count_of(const struct made_room *r, int kind)
{
    int n = 0;
    for (int i = 0; i < r->piece_count; i++) n += r->pieces[i].kind == kind;
    return n;
}

/* Adds a piece of a kind, if there is a place for it. */
static void add_piece(struct made_room *r, int kind, struct dice *d)
{
    const int before = count_of(r, kind);
    if (before >= kinds[kind].most) return;
    for (int i = 0; i < TRIES; i++) {
        struct made_piece p = draw_size(kind, d);
        if (kinds[kind].place == FREE)
            draw_free(r, &p, d);
        else if (!draw_at_wall(r, &p, d))
            continue;
        if (!fits(r, &p, -1)) continue;
        snprintf(p.name, sizeof p.name, before ? "%s%d" : "%s", kinds[kind].name, before + 1);
        r->pieces[r->piece_count++] = p;
        return;
    }
}

static int draw_kind(enum place place, struct dice *d)
{
    int kind;
    do kind = dice_choose(d, KINDS);
    while (kinds[kind].place != place);
    return kind;
}

static int count_free(const struct made_room *r)
{
    int n = 0;
    for (int i = 0; i < r->piece_count; i++) n += kinds[r->pieces[i].kind].place == FREE;
    return n;
}

/* ------------------------------------------------------------------------------------------------------------ edits */

/* A piece that stands free, other than one; -1: none was drawn. */
static int draw_free_piece(const struct made_room *r, int other, struct dice *d)
{
    for (int i = 0; i < TRIES; i++) {
        const int k = dice_choose(d, r->piece_count);
        if (k != other && kinds[r->pieces[k].kind].place == FREE) return k;
    }
    return -1;
}

/* A piece that goes, and a place for one that moves: by decimetres, so that its old place is seen. */
static bool draw_edit(struct made_room *r, struct dice *d)
{
    r->cleared = draw_free_piece(r, -1, d);
    r->moved = draw_free_piece(r, r->cleared, d);
    if (r->cleared < 0 || r->moved < 0) return false;
    const struct made_piece *p = &r->pieces[r->moved];
    r->turned = dice_chance(d, 0.5) ? 0 : 5 * round(dice_between(d, 3, 12));
    for (int i = 0; i < TRIES; i++) {
        const double way = dice_between(d, -M_PI, M_PI), far = dice_between(d, 0.4, 1.0);
        r->after = *p;
        r->after.x += round(100 * far * cos(way)) / 100;
        r->after.y += round(100 * far * sin(way)) / 100;
        r->after.turn += r->turned;
        if (fits(r, &r->after, r->moved)) return true;
    }
    return false;
}

/* Large things at walls first, then free ones, which are smaller. */
bool made_furniture(struct made_room *r, int attempt)
{
    struct dice d = dice_make(r->seed, "furniture", attempt);
    const int at_walls = 3 + dice_choose(&d, 2) + (r->shape != SHAPE_RECTANGLE), free = 2 + dice_choose(&d, 2);
    for (int i = 0; r->piece_count < at_walls && i < 20; i++) add_piece(r, draw_kind(AT_WALL, &d), &d);
    for (int i = 0; count_free(r) < free && i < 20; i++) add_piece(r, draw_kind(FREE, &d), &d);
    return r->piece_count >= 4 && count_free(r) >= 2 && draw_edit(r, &d);
}

/* -------------------------------------------------------------------------------------------------- flat decoration */

/* Whether a picture hides behind tall furniture, or overlaps an opening or a picture. */
static bool picture_fits(const struct made_room *r, const struct made_picture *p)
{
    const struct made_wall *w = &r->walls[p->wall];
    const double s0 = p->s - p->wide, s1 = p->s;
    for (int k = 0; k <= 4; k++) {
        const struct vec3 front = made_wall_place(w, s0 + k * (s1 - s0) / 4, w->thickness / 2 + 0.2);
        if (made_area_of(r, front.x, front.y, 0.12) < 0) return false;
        for (int i = 0; i < r->piece_count; i++)
            if (r->pieces[i].high > p->z && made_piece_near(&r->pieces[i], front.x, front.y, 0.1)) return false;
    }
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *o = &r->openings[i];
        if (o->wall == p->wall && s0 < o->s1 + 0.1 && o->s0 < s1 + 0.1) return false;
    }
    for (int i = 0; i < r->picture_count; i++) {
        const struct made_picture *q = &r->pictures[i];
        if (q->wall == p->wall && s0 < q->s + 0.15 && q->s - q->wide < s1 + 0.15) return false;
    }
    return true;
}

static void draw_rug(struct made_room *r, struct dice *d)
{
    const struct rect a = r->areas[dice_choose(d, r->area_count)];
    const double w = dice_length(d, 1.4, 2.2), h = dice_length(d, 1.2, 1.6);
    const double x = dice_length(d, a.x0 + 0.5, a.x1 - 0.5 - w), y = dice_length(d, a.y0 + 0.5, a.y1 - 0.5 - h);
    r->rugs[r->rug_count++] = (struct rect){x, y, x + w, y + h};
}

/* Pictures hang on the side of a wall that its normal points to. */
bool made_on_picture(const struct made_room *r, int wall, double s, double z, double margin)
{
    for (int i = 0; i < r->picture_count; i++) {
        const struct made_picture *p = &r->pictures[i];
        if (p->wall == wall && s > p->s - p->wide - margin && s < p->s + margin && z > p->z - margin &&
            z < p->z + p->high + margin)
            return true;
    }
    return false;
}

bool made_pictures(struct made_room *r, int attempt)
{
    struct dice d = dice_make(r->seed, "pictures", attempt);
    const int wanted = 7 + dice_choose(&d, MADE_PICTURES - 7);
    for (int i = 0; r->picture_count < wanted && i < TRIES; i++) {
        struct made_picture p = {.wall = i % r->wall_count};
        p.s = dice_length(&d, 0, made_wall_length(&r->walls[p.wall]));
        p.z = dice_length(&d, 1.0, 1.3);
        p.wide = dice_length(&d, 0.45, 1.4);
        p.high = dice_length(&d, 0.45, 0.85);
        p.seed = 100 + r->picture_count + 20 * r->seed;
        if (picture_fits(r, &p)) r->pictures[r->picture_count++] = p;
    }
    if (dice_chance(&d, 0.7)) draw_rug(r, &d);
    return r->picture_count >= 7;
}
