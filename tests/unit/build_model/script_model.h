/* script_model.h - an independent interpreter of model scripts, for comparison with build_model.
 *
 * Computes where there is matter from the script alone (docs/model-script.md): walls between their faces and ends minus
 * openings, slabs under and above rooms, boxes, leaves, panes. Volumes are exact sums over the cells of the grid of all
 * planes. Anything angled, sloped or turned clears `exact`: then only names are tracked. Statements must be valid
 * (build_model accepted them). script_volume.h has the matter, script_textures.h what the faces show. */
#ifndef REMODEL_TESTS_SCRIPT_MODEL_H
#define REMODEL_TESTS_SCRIPT_MODEL_H

#include "tests/unit/scratch.h"

#include <math.h>

enum { MAX_ITEMS = 64, NAME_SIZE = 16, FACE_SIZE = 48, MAX_WORDS = 40 };

enum expected_kind { MODEL_FREE, MODEL_CORNER, MODEL_MEET };

struct expected_end {
    enum expected_kind kind;
    double s;
    int other;
};

struct expected_wall {
    char name[NAME_SIZE];
    bool gone, has_top, angled; /* angled: S is not x or y */
    int axis;                   /* along x or y */
    int start;                  /* its start is ends[start] */
    double in, out;             /* its faces, across */
    double foot, top;
    struct expected_end ends[2]; /* at low and at high S */
};

struct expected_hole {
    char name[NAME_SIZE];
    bool gone, interior, refilled;
    char fill; /* n, l, g, w: nothing, leaf, glass, wall */
    int wall;
    char kind; /* d, p, w */
    double s[2], z[2], thick;
};

struct expected_slot { /* an opening in a room's ceiling (s) or floor (h) */
    char name[NAME_SIZE];
    bool gone;
    int room;
    char kind, fill;
    double low[2], high[2], thick;
};

struct expected_box {
    char name[NAME_SIZE];
    bool gone;
    double low[3], high[3];
};

struct expected_room {
    char name[NAME_SIZE];
    bool gone;
    int walls[MAX_ITEMS], wall_count;
    double floor, ceiling, slab;
    /* from the walls, by expected_shape() */
    int edges[MAX_ITEMS], edge_count, edge_of[MAX_ITEMS]; /* edge_of: by index in walls */
    bool above[MAX_ITEMS];                                /* the room is at higher coordinates than the edge */
    double face[MAX_ITEMS], border[MAX_ITEMS];
};

/* A statement about textures. Rectangles: S and Z of a wall, X and Y of a floor or ceiling. */
struct expected_wish {
    enum { MODEL_STRETCH, MODEL_CROP, MODEL_COLOUR, MODEL_COPY, MODEL_GLOSS } kind;
    char face[FACE_SIZE], from[FACE_SIZE]; /* STRETCH and CROP: the item */
    double patch[4], target[4], colour[3];
    double ks;          /* GLOSS; 0: matt */
    bool whole, unsure; /* unsure: a rectangle is not known */
};

struct expected_zone { /* clutter that is cleared or kept in a rectangle, a room or all rooms */
    bool keep, all;
    int room;
    double low[3], high[3];
};

struct expected_lamp {
    char name[NAME_SIZE];
    double scale[3];
};

struct expected_object {
    char name[NAME_SIZE];
    bool gone;
    double x;
};

struct expected {
    double thickness, slab, glass, leaf, floor, ceiling;
    bool exact;
    struct expected_wall walls[MAX_ITEMS];
    struct expected_hole holes[MAX_ITEMS];
    struct expected_slot slots[MAX_ITEMS];
    struct expected_box boxes[MAX_ITEMS];
    struct expected_room rooms[MAX_ITEMS];
    int wall_count, hole_count, slot_count, box_count, room_count;
    struct expected_wish wishes[MAX_ITEMS];
    struct expected_zone zones[MAX_ITEMS];
    int wish_count, zone_count;
    struct expected_lamp lamps[MAX_ITEMS];
    struct expected_object objects[MAX_ITEMS];
    int lamp_count, object_count;
    double colour[3];                /* of new faces */
    const struct expected *unedited; /* NULL: this is the unedited model */
};

static inline void expected_begin(struct expected *t)
{
    *t = (struct expected){
        .thickness = 0.15, .glass = 0.02, .leaf = 0.04, .ceiling = 2.5, .exact = true, .colour = {0.75, 0.75, 0.75}};
}

#define FIND_BY_NAME(what, field)                                                 \
    static inline int expected_##what(const struct expected *t, const char *name) \
    {                                                                             \
        for (int i = 0; i < t->what##_count; i++)                                 \
            if (!strcmp(t->field[i].name, name)) return i;                        \
        return -1;                                                                \
    }
FIND_BY_NAME(wall, walls)
FIND_BY_NAME(hole, holes)
FIND_BY_NAME(slot, slots)
FIND_BY_NAME(box, boxes)
FIND_BY_NAME(room, rooms)

static inline double expected_low(const struct expected_wall *w) { return fmin(w->in, w->out); }
static inline double expected_high(const struct expected_wall *w) { return fmax(w->in, w->out); }

/* The low or high end of the wall along S. */
static inline double expected_reach(const struct expected *t, const struct expected_wall *w, int high)
{
    const struct expected_end *e = &w->ends[high];
    if (e->kind == MODEL_FREE) return e->s;
    const struct expected_wall *o = &t->walls[e->other];
    return (e->kind == MODEL_CORNER) == (high == 1) ? expected_high(o) : expected_low(o);
}

/* ------------------------------------------------------------------------------------------------------ statements */

static inline double expected_option(char **words, int count, const char *name, double otherwise)
{
    for (int i = 0; i + 1 < count; i++)
        if (!strcmp(words[i], name)) return atof(words[i + 1]);
    return otherwise;
}

static inline bool expected_has_word(char **words, int count, const char *word)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(words[i], word)) return true;
    return false;
}

static inline void expected_copy_name(char name[NAME_SIZE], const char *word)
{
    assert_true(strlen(word) < NAME_SIZE);
    strcpy(name, word);
}

/* The end of the wall at low or high S, between its neighbours. */
static inline double expected_span(const struct expected *t, const struct expected_wall *w, int high)
{
    const struct expected_end *e = &w->ends[high];
    if (e->kind == MODEL_FREE) return e->s;
    return high ? expected_low(&t->walls[e->other]) : expected_high(&t->walls[e->other]);
}

static inline double expected_thickness(const struct expected *t, char fill)
{
    return fill == 'g' ? t->glass : fill == 'l' ? t->leaf : 0;
}

/* wall NAME parallel to WALL by D between WALL WALL */
static inline void expected_add_parallel(struct expected *t, char **w, int n)
{
    const struct expected_wall *o = &t->walls[expected_wall(t, w[4])];
    const int a = expected_wall(t, w[8]), b = expected_wall(t, w[9]);
    const bool a_lower = t->walls[a].in < t->walls[b].in;
    const double thickness = expected_option(w, n, "thickness", t->thickness);
    struct expected_wall *x = &t->walls[t->wall_count++];
    assert_true(t->wall_count < MAX_ITEMS);
    *x = (struct expected_wall){
        .axis = o->axis, .start = o->start, .angled = o->angled, .foot = expected_option(w, n, "foot", t->floor)};
    expected_copy_name(x->name, w[1]);
    x->has_top = expected_has_word(w, n, "top");
    x->top = expected_option(w, n, "top", t->ceiling);
    x->in = o->in + (o->out > o->in ? -atof(w[6]) : atof(w[6])); /* in front of it */
    x->out = x->in + (o->out > o->in ? thickness : -thickness);
    x->ends[0] = (struct expected_end){MODEL_MEET, 0, a_lower ? a : b};
    x->ends[1] = (struct expected_end){MODEL_MEET, 0, a_lower ? b : a};
}

static inline void expected_add_wall(struct expected *t, char **w, int n)
{
    if (!strcmp(w[2], "parallel")) {
        expected_add_parallel(t, w, n);
        return;
    }
    struct expected_wall *x = &t->walls[t->wall_count++];
    const double a[2] = {atof(w[3]), atof(w[4])}, b[2] = {atof(w[6]), atof(w[7])};
    const double thickness = expected_option(w, n, "thickness", t->thickness);
    assert_true(t->wall_count < MAX_ITEMS);
    *x = (struct expected_wall){.axis = fabs(a[0] - b[0]) < fabs(a[1] - b[1]),
                                .foot = expected_option(w, n, "foot", t->floor)};
    expected_copy_name(x->name, w[1]);
    x->angled = expected_has_word(w, n, "angled");
    if (x->angled) t->exact = false;
    x->has_top = expected_has_word(w, n, "top");
    x->top = expected_option(w, n, "top", t->ceiling);
    x->start = a[x->axis] > b[x->axis];
    x->in = a[!x->axis];
    /* the inside is to the right: below a wall that goes to +x, on the +x side of a wall that goes to +y */
    x->out = x->in + ((x->axis == 0) == (x->start == 0) ? thickness : -thickness);
    x->ends[x->start] = (struct expected_end){MODEL_FREE, a[x->axis], -1};
    x->ends[!x->start] = (struct expected_end){MODEL_FREE, b[x->axis], -1};
}

static inline int expected_corner_end(const struct expected *t, int a, int b)
{
    const struct expected_wall *w = &t->walls[a];
    for (int i = 0; i < 2; i++) {
        const int e = i ? !w->start : w->start;
        if (w->ends[e].kind != MODEL_FREE && w->ends[e].other == b) return e;
    }
    if (w->ends[0].kind != MODEL_FREE) return 1;
    if (w->ends[1].kind != MODEL_FREE) return 0;
    const double at = t->walls[b].in;
    return fabs(w->ends[w->start].s - at) <= fabs(w->ends[!w->start].s - at) ? w->start : !w->start;
}

static inline void expected_join(struct expected *t, char **w, int n)
{
    for (int i = 1; i + 1 < n; i++) {
        const int a = expected_wall(t, w[i]), b = expected_wall(t, w[i + 1]);
        const int x = expected_corner_end(t, a, b), y = expected_corner_end(t, b, a);
        t->walls[a].ends[x] = (struct expected_end){MODEL_CORNER, 0, b};
        t->walls[b].ends[y] = (struct expected_end){MODEL_CORNER, 0, a};
    }
}

static inline void expected_split(struct expected *t, char **w)
{
    const int old = expected_wall(t, w[1]), new = t->wall_count++;
    const double low = fmin(atof(w[3]), atof(w[5])), high = fmax(atof(w[3]), atof(w[5])), middle = (low + high) / 2;
    struct expected_wall *a = &t->walls[old], *b = &t->walls[new];
    assert_true(t->wall_count < MAX_ITEMS);
    *b = *a;
    expected_copy_name(b->name, w[7]);
    a->ends[!a->start] = (struct expected_end){MODEL_FREE, a->start ? high : low, -1};
    b->ends[a->start] = (struct expected_end){MODEL_FREE, a->start ? low : high, -1};
    for (int i = 0; i < t->hole_count; i++)
        if (t->holes[i].wall == old && (t->holes[i].s[0] > middle) == !a->start) t->holes[i].wall = new;
    for (int i = 0; i < t->wall_count; i++)
        for (int e = 0; e < 2; e++) {
            struct expected_wall *x = &t->walls[i];
            if (i == old || i == new || x->ends[e].kind == MODEL_FREE || x->ends[e].other != old) continue;
            if ((x->in > middle) == !a->start) x->ends[e].other = new;
        }
    for (int i = 0; i < t->room_count; i++) {
        struct expected_room *r = &t->rooms[i];
        int at = 0;
        while (at < r->wall_count && r->walls[at] != old) at++;
        if (at == r->wall_count) continue;
        assert_true(r->wall_count + 1 < MAX_ITEMS);
        memmove(r->walls + at + 1, r->walls + at, (size_t)(r->wall_count - at) * sizeof *r->walls);
        r->walls[at + 1] = new;
        r->wall_count++;
    }
}

static inline void expected_add_room(struct expected *t, char **w, int n)
{
    struct expected_room *r = &t->rooms[t->room_count++];
    assert_true(t->room_count < MAX_ITEMS);
    *r = (struct expected_room){.slab = t->slab > 0 ? t->slab : t->thickness};
    expected_copy_name(r->name, w[1]);
    r->floor = expected_option(w, n, "floor", t->floor);
    r->ceiling = expected_option(w, n, "ceiling", t->ceiling);
    for (int i = 2; i < n && strcmp(w[i], "floor") && strcmp(w[i], "ceiling"); i++)
        r->walls[r->wall_count++] = expected_wall(t, w[i]);
}

static inline void expected_rectangle(char **w, double s[2], double z[2])
{
    s[0] = fmin(atof(w[0]), atof(w[3]));
    s[1] = fmax(atof(w[0]), atof(w[3]));
    z[0] = fmin(atof(w[1]), atof(w[4]));
    z[1] = fmax(atof(w[1]), atof(w[4]));
}

/* The place of an opening: from S Z to S Z, or at left|right D width W from Z to Z. */
static inline void expected_place(const struct expected *t, int wall, char **w, double s[2], double z[2])
{
    if (!strcmp(w[0], "from")) {
        expected_rectangle(w + 1, s, z);
        return;
    }
    const struct expected_wall *x = &t->walls[wall];
    const bool from_high = !strcmp(w[1], "right") == !x->start; /* its start is at the left */
    const double by = atof(w[2]), width = atof(w[4]), end = expected_span(t, x, from_high);
    s[0] = from_high ? end - by - width : end + by;
    s[1] = s[0] + width;
    z[0] = fmin(atof(w[6]), atof(w[8]));
    z[1] = fmax(atof(w[6]), atof(w[8]));
}

static inline void expected_add_slot(struct expected *t, char **w, int n)
{
    struct expected_slot *o = &t->slots[t->slot_count++];
    assert_true(t->slot_count < MAX_ITEMS);
    *o = (struct expected_slot){.kind = w[0][0], .room = expected_room(t, w[3])};
    expected_copy_name(o->name, w[1]);
    for (int k = 0; k < 2; k++) {
        o->low[k] = fmin(atof(w[5 + k]), atof(w[8 + k]));
        o->high[k] = fmax(atof(w[5 + k]), atof(w[8 + k]));
    }
    o->fill = o->kind == 's'                      ? (expected_has_word(w, n, "open") ? 'n' : 'g')
              : expected_has_word(w, n, "closed") ? 'l'
                                                  : 'n';
    o->thick = expected_thickness(t, o->fill);
}

static inline void expected_add_hole(struct expected *t, char **w, int n)
{
    struct expected_hole *h = &t->holes[t->hole_count++];
    assert_true(t->hole_count < MAX_ITEMS);
    *h = (struct expected_hole){.kind = w[0][0], .wall = expected_wall(t, w[3])};
    expected_copy_name(h->name, w[1]);
    expected_place(t, h->wall, w + 4, h->s, h->z);
    h->fill = h->kind == 'w'                      ? (expected_has_word(w, n, "open") ? 'n' : 'g')
              : expected_has_word(w, n, "closed") ? 'l'
                                                  : 'n';
    h->interior = expected_has_word(w, n, "interior");
    h->thick = expected_thickness(t, h->fill);
}

static inline void expected_add_box(struct expected *t, char **w, int n)
{
    struct expected_box *b = &t->boxes[t->box_count++];
    assert_true(t->box_count < MAX_ITEMS);
    *b = (struct expected_box){.gone = false};
    expected_copy_name(b->name, w[1]);
    for (int k = 0; k < 2; k++) {
        b->low[k] = fmin(atof(w[3 + k]), atof(w[6 + k]));
        b->high[k] = fmax(atof(w[3 + k]), atof(w[6 + k]));
    }
    b->low[2] = expected_option(w, n, "foot", t->floor);
    b->high[2] = expected_option(w, n, "top", t->ceiling);
    if (expected_option(w, n, "turn", 0) != 0) t->exact = false;
}

static inline void expected_adjust(struct expected *t, char **w)
{
    const int wall = expected_wall(t, w[1]), hole = expected_hole(t, w[1]), slot = expected_slot(t, w[1]);
    if (wall >= 0) {
        struct expected_wall *x = &t->walls[wall];
        const double by = atof(w[x->axis ? 3 : 4]) - x->in;
        x->in += by;
        x->out += by;
    } else if (hole >= 0) {
        expected_place(t, t->holes[hole].wall, w + 2, t->holes[hole].s, t->holes[hole].z);
    } else {
        double *const low = slot >= 0 ? t->slots[slot].low : t->boxes[expected_box(t, w[1])].low;
        double *const high = slot >= 0 ? t->slots[slot].high : t->boxes[expected_box(t, w[1])].high;
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(atof(w[3 + k]), atof(w[6 + k]));
            high[k] = fmax(atof(w[3 + k]), atof(w[6 + k]));
        }
    }
}

static inline void expected_move(struct expected *t, char **w, int n)
{
    const int wall = expected_wall(t, w[1]), hole = expected_hole(t, w[1]), slot = expected_slot(t, w[1]);
    const double by[3] = {atof(w[3]), n > 4 ? atof(w[4]) : 0, n > 5 ? atof(w[5]) : 0};
    if (wall >= 0) {
        struct expected_wall *x = &t->walls[wall];
        const double across = x->out > x->in ? by[0] : -by[0]; /* away from its inside */
        x->in += across;
        x->out += across;
        return;
    }
    for (int k = 0; k < 2 && hole >= 0; k++) {
        t->holes[hole].s[k] += by[0];
        t->holes[hole].z[k] += by[1];
    }
    struct expected_box *b = hole < 0 && slot < 0 ? &t->boxes[expected_box(t, w[1])] : NULL;
    for (int k = 0; k < (slot >= 0 ? 2 : 3) && hole < 0; k++) {
        *(b ? &b->low[k] : &t->slots[slot].low[k]) += by[k];
        *(b ? &b->high[k] : &t->slots[slot].high[k]) += by[k];
    }
}

static inline bool expected_same_line(const struct expected_wall *a, const struct expected_wall *b)
{
    return a->axis == b->axis && a->start == b->start && fabs(a->in - b->in) < 1e-6;
}

/* Of a wall and those that continue it round a room. */
static inline void expected_thicken(struct expected *t, int wall, double thickness)
{
    struct expected_wall *x = &t->walls[wall];
    x->out = x->in + (x->out > x->in ? thickness : -thickness);
    for (int i = 0; i < t->room_count; i++)
        for (int k = 0; k < t->rooms[i].wall_count; k++) {
            if (t->rooms[i].walls[k] != wall) continue;
            for (int o = 0; o < t->rooms[i].wall_count; o++) {
                const struct expected_wall *y = &t->walls[t->rooms[i].walls[o]];
                if (fabs(fabs(y->out - y->in) - thickness) > 1e-9 && expected_same_line(x, y))
                    expected_thicken(t, t->rooms[i].walls[o], thickness);
            }
        }
}

static inline void expected_change(struct expected *t, char **w, int n)
{
    const int wall = expected_wall(t, w[1]), box = expected_box(t, w[1]);
    if (wall >= 0) {
        struct expected_wall *x = &t->walls[wall];
        const double thickness = expected_option(w, n, "thickness", fabs(x->out - x->in));
        if (expected_has_word(w, n, "thickness")) expected_thicken(t, wall, thickness);
        x->foot = expected_option(w, n, "foot", x->foot);
        x->top = expected_option(w, n, "top", x->top);
        x->has_top |= expected_has_word(w, n, "top");
    } else if (box >= 0) {
        t->boxes[box].low[2] = expected_option(w, n, "foot", t->boxes[box].low[2]);
        t->boxes[box].high[2] = expected_option(w, n, "top", t->boxes[box].high[2]);
        if (expected_option(w, n, "turn", 0) != 0) t->exact = false;
    } else {
        t->rooms[expected_room(t, w[1])].ceiling = expected_option(w, n, "ceiling", 0);
    }
}

static inline void expected_resize(struct expected *t, char **w, int n)
{
    const int hole = expected_hole(t, w[1]), slot = expected_slot(t, w[1]);
    const double left = expected_option(w, n, "left", 0), right = expected_option(w, n, "right", 0);
    if (slot >= 0) {
        t->slots[slot].low[0] -= left;
        t->slots[slot].high[0] += right;
        t->slots[slot].low[1] -= expected_option(w, n, "front", 0);
        t->slots[slot].high[1] += expected_option(w, n, "back", 0);
        return;
    }
    struct expected_hole *h = &t->holes[hole];
    const bool left_is_low = !t->walls[h->wall].start;
    h->s[0] -= left_is_low ? left : right;
    h->s[1] += left_is_low ? right : left;
    h->z[0] -= expected_option(w, n, "bottom", 0);
    h->z[1] += expected_option(w, n, "top", 0);
}

/* open NAME, close NAME, fill NAME with WHAT */
static inline void expected_fill(struct expected *t, char **w)
{
    const int hole = expected_hole(t, w[1]), slot = expected_slot(t, w[1]);
    struct expected_hole *h = hole >= 0 ? &t->holes[hole] : NULL;
    const char kind = h ? h->kind : t->slots[slot].kind, own = kind == 'w' || kind == 's' ? 'g' : 'l';
    const char fill = w[0][0] == 'f' ? w[3][0] : w[0][0] == 'c' ? own : 'n';
    *(h ? &h->fill : &t->slots[slot].fill) = fill;
    *(h ? &h->thick : &t->slots[slot].thick) = expected_thickness(t, fill);
    if (!h || w[0][0] != 'f') return;
    h->refilled = true;
    h->interior = false;
}

static inline void expected_remove(struct expected *t, const char *name)
{
    const int wall = expected_wall(t, name), hole = expected_hole(t, name), box = expected_box(t, name),
              room = expected_room(t, name);
    if (wall >= 0) {
        t->walls[wall].gone = true;
        for (int i = 0; i < t->hole_count; i++)
            if (t->holes[i].wall == wall) t->holes[i].gone = true;
    } else if (hole >= 0) {
        t->holes[hole].gone = true;
    } else if (expected_slot(t, name) >= 0) {
        t->slots[expected_slot(t, name)].gone = true;
    } else if (box >= 0) {
        t->boxes[box].gone = true;
    } else {
        t->rooms[room].gone = true;
    }
}

/* A place on a wall's face, a floor or a ceiling: S and Z, or X and Y. Returns the number of its words. *unsure: it is
 * on an angled wall, or measured from the end of a wall that may end at one. */
static inline int expected_face_place(const struct expected *t, const char *face, char **w, double rect[4],
                                      bool *unsure)
{
    char item[NAME_SIZE] = "";
    double s[2] = {0, 0}, z[2] = {0, 0};
    if (!strncmp(face, "wall/", 5)) {
        snprintf(item, sizeof item, "%.*s", (int)strcspn(face + 5, "/"), face + 5);
        const int wall = expected_wall(t, item);
        expected_place(t, wall, w, s, z);
        *unsure |= t->walls[wall].angled || (!strcmp(w[0], "at") && !t->exact);
    } else {
        expected_rectangle(w + 1, s, z);
    }
    memcpy(rect, (const double[]){s[0], z[0], s[1], z[1]}, 4 * sizeof *rect);
    return strcmp(w[0], "at") ? 6 : 9;
}

static inline void expected_add_wish(struct expected *t, char **w, int n)
{
    struct expected_wish *x = &t->wishes[t->wish_count++];
    assert_true(t->wish_count < MAX_ITEMS);
    *x = (struct expected_wish){.kind = MODEL_COLOUR};
    snprintf(x->face, sizeof x->face, "%s", w[1]);
    if (w[0][0] == 't') {
        x->kind = !strcmp(w[2], "stretch") ? MODEL_STRETCH : MODEL_CROP;
    } else if (!strcmp(w[0], "material")) {
        x->kind = MODEL_GLOSS;
        x->ks = strcmp(w[2], "matt") ? atof(w[3]) : 0;
    } else if (!strcmp(w[0], "paint")) { /* paint FACE [PLACE] R G B */
        x->whole = n == 5;
        const int at = x->whole ? 2 : 2 + expected_face_place(t, x->face, w + 2, x->target, &x->unsure);
        for (int c = 0; c < 3; c++) x->colour[c] = atof(w[at + c]);
    } else if (!strcmp(w[0], "colour")) {
        x->whole = true;
        for (int c = 0; c < 3; c++) x->colour[c] = atof(w[2 + c]);
    } else { /* copy texture FACE PLACE to FACE [PLACE] */
        x->kind = MODEL_COPY;
        snprintf(x->from, sizeof x->from, "%s", w[2]);
        const int to = 3 + expected_face_place(t->unedited, w[2], w + 3, x->patch, &x->unsure);
        snprintf(x->face, sizeof x->face, "%s", w[to + 1]);
        x->whole = n == to + 2;
        if (!x->whole) expected_face_place(t, x->face, w + to + 2, x->target, &x->unsure);
    }
}

static inline void expected_add_zone(struct expected *t, char **w, int n)
{
    struct expected_zone *z = &t->zones[t->zone_count++];
    assert_true(t->zone_count < MAX_ITEMS);
    *z = (struct expected_zone){.keep = w[0][0] == 'k', .all = !strcmp(w[1], "all"), .room = expected_room(t, w[1])};
    z->low[2] = expected_option(w, n, "foot", -HUGE_VAL);
    z->high[2] = expected_option(w, n, "top", HUGE_VAL);
    if (strcmp(w[1], "from")) return;
    for (int k = 0; k < 2; k++) {
        z->low[k] = fmin(atof(w[2 + k]), atof(w[5 + k]));
        z->high[k] = fmax(atof(w[2 + k]), atof(w[5 + k]));
    }
}

static inline void expected_set_lamp(struct expected *t, char **w)
{
    int i = 0;
    while (i < t->lamp_count && strcmp(t->lamps[i].name, w[1])) i++;
    if (i == t->lamp_count) snprintf(t->lamps[t->lamp_count++].name, NAME_SIZE, "%s", w[1]);
    for (int c = 0; c < 3; c++) t->lamps[i].scale[c] = strcmp(w[2], "off") ? atof(w[3 + c]) : 0;
}

/* object NAME FILE at X ..., or remove object NAME */
static inline void expected_set_object(struct expected *t, const char *name, double x, bool gone)
{
    int i = 0;
    while (i < t->object_count && strcmp(t->objects[i].name, name)) i++;
    if (i == t->object_count) snprintf(t->objects[t->object_count++].name, NAME_SIZE, "%s", name);
    t->objects[i].gone = gone;
    t->objects[i].x = x;
}

/* Applies one valid statement. */
static inline void expected_apply(struct expected *t, const char *line)
{
    char text[512], *w[MAX_WORDS], *rest = text;
    int n = 0;
    snprintf(text, sizeof text, "%s", line);
    for (char *word; n < MAX_WORDS && (word = strtok_r(rest, " \n", &rest));) w[n++] = word;
    if (n < 2) return;
    if (!strcmp(w[0], "set")) {
        double *const values[] = {&t->thickness, &t->slab, &t->glass, &t->leaf, &t->floor, &t->ceiling};
        static const char *const names[] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling"};
        for (int i = 0; i < 6; i++)
            if (!strcmp(names[i], w[1])) *values[i] = atof(w[2]);
        for (int c = 0; c < 3 && !strcmp(w[1], "colour"); c++) t->colour[c] = atof(w[2 + c]);
    } else if (!strcmp(w[0], "texture") || !strcmp(w[0], "colour") || !strcmp(w[0], "copy") || !strcmp(w[0], "paint") ||
               !strcmp(w[0], "material")) {
        expected_add_wish(t, w, n);
    } else if (!strcmp(w[0], "lamp")) {
        expected_set_lamp(t, w);
    } else if (!strcmp(w[0], "object")) {
        expected_set_object(t, w[1], atof(w[4]), false);
    } else if (!strcmp(w[0], "remove") && n == 3) {
        expected_set_object(t, w[2], 0, true);
    } else if (!strcmp(w[0], "clear") || !strcmp(w[0], "keep")) {
        expected_add_zone(t, w, n);
    } else if (!strcmp(w[0], "wall")) {
        expected_add_wall(t, w, n);
    } else if (!strcmp(w[0], "join")) {
        expected_join(t, w, n);
    } else if (!strcmp(w[0], "extend")) {
        struct expected_wall *x = &t->walls[expected_wall(t, w[1])];
        const int other = expected_wall(t, w[4]), e = strcmp(w[2], "start") ? !x->start : x->start;
        x->ends[e] = (struct expected_end){other < 0 ? MODEL_FREE : MODEL_MEET, atof(w[4]), other};
    } else if (!strcmp(w[0], "split")) {
        expected_split(t, w);
    } else if (!strcmp(w[0], "room")) {
        expected_add_room(t, w, n);
    } else if (!strcmp(w[0], "slope") || !strcmp(w[0], "gable")) {
        t->exact = false;
    } else if (!strcmp(w[0], "box")) {
        expected_add_box(t, w, n);
    } else if (!strcmp(w[0], "adjust")) {
        expected_adjust(t, w);
    } else if (!strcmp(w[0], "move")) {
        expected_move(t, w, n);
    } else if (!strcmp(w[0], "change")) {
        expected_change(t, w, n);
    } else if (!strcmp(w[0], "resize")) {
        expected_resize(t, w, n);
    } else if (!strcmp(w[0], "open") || !strcmp(w[0], "close") || !strcmp(w[0], "fill")) {
        expected_fill(t, w);
    } else if (!strcmp(w[0], "skylight") || !strcmp(w[0], "hatch")) {
        expected_add_slot(t, w, n);
    } else if (!strcmp(w[0], "remove")) {
        expected_remove(t, w[1]);
    } else {
        expected_add_hole(t, w, n);
    }
}

#endif
