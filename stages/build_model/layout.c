/* layout.c - lays out a plan as convex solids.
 *
 * A wall is cut into columns at the sides of its openings and where a sloping ceiling begins, and a column into pieces
 * at the sills and heads. Where two openings share a side, the pieces beside it are cut at their heights too, so that
 * each reveal has its own name. All pieces of a wall get its planes by the same numbers, so that a plane stays one
 * plane. Ends lie in the planes of the walls that they are joined to: a corner includes the intersection of both.
 *
 * Floors and ceilings extend under the walls, to the middle of a wall between two rooms: they support the walls,
 * continue through doorways, and keep solids from touching in an edge alone. A room's polygon is cut into convex
 * polygons along the lines of its walls. */
#include "stages/build_model/layout.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"

enum { NAME_SIZE = 192 };
#define BODY "walls"
#define NEAR 1e-6 /* SOLID_STEP: positions closer than this are equal */

struct shape { /* half-spaces of a solid and their names, until add_shape() */
    struct half_space *h;
    char (*names)[NAME_SIZE];
    int count, capacity;
    bool no_memory;
};

static void shape_release(struct shape *s)
{
    free(s->h);
    free(s->names);
    *s = (struct shape){0};
}

static void add_side(struct shape *s, double x, double y, double z, double offset, const char *fmt, ...)
    PRINTF_LIKE(6, 7);
static void add_side(struct shape *s, double x, double y, double z, double offset, const char *fmt, ...)
{
    va_list args;
    if (s->count == s->capacity) {
        const int capacity = 2 * s->capacity + 8;
        struct half_space *h = realloc(s->h, (size_t)capacity * sizeof *h);
        if (h) s->h = h;
        char(*names)[NAME_SIZE] = h ? realloc(s->names, (size_t)capacity * sizeof *names) : NULL;
        if (names) s->names = names;
        s->no_memory |= !names;
        if (!names) return;
        s->capacity = capacity;
    }
    va_start(args, fmt);
    vsnprintf(s->names[s->count], NAME_SIZE, fmt, args);
    va_end(args);
    s->h[s->count++] = (struct half_space){{x, y, z}, offset, NULL};
}

/* Adds what the shape holds to the list and releases it. */
static enum status add_shape(struct solid_list *list, const char *body, struct shape *s, struct err *err)
{
    for (int i = 0; i < s->count; i++) s->h[i].name = s->names[i];
    const enum status st = s->no_memory ? err_nomem(err, "a solid", (size_t)s->capacity * sizeof *s->names)
                                        : solid_list_add(list, body, s->h, s->count, err);
    shape_release(s);
    return st;
}

/* ------------------------------------------------------------------------------------------------------------ walls */

struct top { /* of a wall's part: z = a[0] + a[1] x + a[2] y */
    double a[3];
};

struct span_top {
    double s[2];
    struct top top;
};

struct wall_parts { /* openings and ceilings sorted by wall */
    const struct plan *plan;
    const struct plan_opening **openings; /* of all walls, in order of wall, then of S */
    int *first;                           /* openings of wall w: first[w] .. first[w + 1] - 1 */
    struct span_top *tops;                /* ceilings of the rooms at each wall, in order of wall */
    int *filled;                          /* filled[first_top[w]]: how many of wall w's tops are set */
    int *first_top;
};

static int compare_openings(const void *a, const void *b)
{
    const struct plan_opening *x = *(const struct plan_opening *const *)a, *y = *(const struct plan_opening *const *)b;
    if (x->wall != y->wall) return x->wall - y->wall;
    if (x->s[0] != y->s[0]) return x->s[0] < y->s[0] ? -1 : 1;
    return x->z[0] < y->z[0] ? -1 : x->z[0] > y->z[0];
}

static void wall_parts_release(struct wall_parts *w)
{
    free(w->openings);
    free(w->first);
    free(w->tops);
    free(w->filled);
    free(w->first_top);
}

static enum status wall_parts_make(struct wall_parts *w, const struct plan *p, struct err *err)
{
    const size_t walls = (size_t)p->wall_count;
    int uses = 0, n = 0;
    for (int i = 0; i < p->room_count; i++) uses += p->rooms[i].removed ? 0 : p->rooms[i].wall_count;
    *w = (struct wall_parts){.plan = p};
    w->openings = calloc((size_t)p->opening_count + 1, sizeof *w->openings);
    w->first = calloc(walls + 2, sizeof *w->first);
    w->tops = calloc((size_t)uses + 1, sizeof *w->tops);
    w->filled = calloc((size_t)uses + 1, sizeof *w->filled);
    w->first_top = calloc(walls + 2, sizeof *w->first_top);
    if (!w->openings || !w->first || !w->tops || !w->filled || !w->first_top) {
        wall_parts_release(w);
        return err_nomem(err, "the parts of walls", walls * sizeof *w->tops);
    }
    for (int i = 0; i < p->opening_count; i++) {
        const struct plan_opening *o = &p->openings[i];
        if (o->removed || p->walls[o->wall].removed) continue;
        w->openings[n++] = o;
        w->first[o->wall + 1]++;
    }
    if (n) qsort(w->openings, (size_t)n, sizeof *w->openings, compare_openings);
    /* count the tops, then store them in order of rooms */
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < p->room_count; i++) {
            const struct plan_room *r = &p->rooms[i];
            for (int k = 0; !r->removed && k < r->wall_count; k++) {
                const int wall = r->walls[k], e = r->edge_of[k];
                if (pass == 0) {
                    w->first_top[wall + 1]++;
                    continue;
                }
                const int at = w->first_top[wall] + w->filled[w->first_top[wall]]++;
                room_span(p, r, e, wall, w->tops[at].s);
                memcpy(w->tops[at].top.a, r->lower, sizeof r->lower);
            }
        }
        for (size_t i = 0; pass == 0 && i < walls; i++) w->first_top[i + 1] += w->first_top[i];
    }
    for (size_t i = 0; i < walls; i++) w->first[i + 1] += w->first[i];
    return ST_OK;
}

bool window_has_glass(const struct plan *plan, const struct plan_opening *o, int *side)
{
    unsigned sides = 0;
    if (o->kind != VERB_WINDOW || !o->filled || o->interior) return false;
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        for (int k = 0; !r->removed && k < r->wall_count; k++) {
            if (r->walls[k] != o->wall) continue;
            sides |= 1u << r->edges[r->edge_of[k]].side;
        }
    }
    *side = sides == 1u << SIDE_OUT ? SIDE_IN : SIDE_OUT;
    return sides != 3;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int unique(double *x, int count)
{
    int n = 0;
    if (count) qsort(x, (size_t)count, sizeof *x, compare_numbers);
    for (int i = 0; i < count; i++)
        if (n == 0 || x[i] - x[n - 1] > NEAR) x[n++] = x[i];
    return n;
}

struct column {
    const struct wall_parts *parts;
    int wall;
    bool first, last; /* reaches the wall's end at low, at high S */
    bool corner;      /* lies in a corner with another wall, beyond the wall's span */
    double s[2];
    double middle; /* S that decides which rooms are beside it */
};

/* Left or right as seen from inside: the side nearer to the wall's start is left. */
static const char *reveal_side(const struct plan_wall *w, int upper_bound_of_hole)
{
    return (w->sign > 0) == (upper_bound_of_hole == 1) ? "right" : "left";
}

/* Counts the openings next to the column at its low or `upper` side, and returns one that overlaps z0 .. z1 if any. */
static const struct plan_opening *beyond(const struct column *c, int upper, double z0, double z1, int *count)
{
    const struct wall_parts *w = c->parts;
    const struct plan_opening *found = NULL;
    *count = 0;
    for (int i = w->first[c->wall]; i < w->first[c->wall + 1]; i++) {
        const struct plan_opening *o = w->openings[i];
        if (fabs(o->s[!upper] - c->s[upper]) > NEAR) continue;
        ++*count;
        if (!found || (o->z[0] < z1 - NEAR && o->z[1] > z0 + NEAR)) found = o;
    }
    return found;
}

static bool square(const struct plan_wall *a, const struct plan_wall *b)
{
    return fabs(a->d[0] * b->d[0] + a->d[1] * b->d[1]) < 1e-12;
}

static void add_column_side(struct shape *sh, const struct column *c, int upper, double z0, double z1)
{
    const struct plan *p = c->parts->plan;
    const struct plan_wall *w = &p->walls[c->wall];
    int count;
    const int end = (upper == 1) == (w->sign > 0) ? END_END : END_START;
    if (upper ? c->last : c->first) {
        int face_wall, face_side;
        const struct plan_line cap = wall_cap(p, c->wall, end, &face_wall, &face_side);
        if (face_wall >= 0 && !p->walls[face_wall].removed)
            add_side(sh, cap.n[0], cap.n[1], 0, cap.c, "wall/%s/%s", p->walls[face_wall].name,
                     face_side == SIDE_IN ? "in" : "out");
        else
            add_side(sh, cap.n[0], cap.n[1], 0, cap.c, "wall/%s/%s", w->name, end == END_END ? "end" : "start");
        return;
    }
    const struct plan_opening *o = beyond(c, upper, z0, z1, &count);
    if (o && c->corner) { /* the reveal may be the face of the wall at that corner */
        int other, far;
        wall_cap(p, c->wall, !end, &other, &far);
        if (other >= 0 && !p->walls[other].removed && square(w, &p->walls[other])) {
            const struct plan_line face = wall_face(&p->walls[other], !far);
            add_side(sh, face.n[0], face.n[1], 0, face.c, "wall/%s/%s", p->walls[other].name,
                     far == SIDE_OUT ? "in" : "out");
            return;
        }
    }
    const double along = w->sign * (c->s[upper] + w->origin), out = end == END_END ? 1 : -1;
    if (o)
        add_side(sh, out * w->d[0], out * w->d[1], 0, out * along, "%s/%s/%s", verb_name(o->kind), o->name,
                 reveal_side(w, !upper));
    else
        add_side(sh, out * w->d[0], out * w->d[1], 0, out * along, "wall/%s/top",
                 w->name); /* a step of the top, where visible */
}

/* A piece of a column, from z0 (the head of `below`, or the wall's foot) up to the sill of `above`, or to z1 or the
 * top. cut: z0 is a cut inside the column. */
static enum status add_piece(struct solid_list *list, const struct column *c, double z0,
                             const struct plan_opening *below, double z1, const struct plan_opening *above,
                             const struct top *top, bool cut, struct err *err)
{
    const struct plan_wall *w = &c->parts->plan->walls[c->wall];
    const struct plan_line in = wall_face(w, SIDE_IN), out = wall_face(w, SIDE_OUT);
    struct shape s = {0};
    add_side(&s, in.n[0], in.n[1], 0, in.c, "wall/%s/in", w->name);
    add_side(&s, out.n[0], out.n[1], 0, out.c, "wall/%s/out", w->name);
    add_column_side(&s, c, 0, z0, z1);
    add_column_side(&s, c, 1, z0, z1);
    if (below)
        add_side(&s, 0, 0, -1, -z0, "%s/%s/head", verb_name(below->kind), below->name);
    else
        add_side(&s, 0, 0, -1, -z0, "wall/%s/%s", w->name, cut ? "cut" : "bottom");
    if (above)
        add_side(&s, 0, 0, 1, z1, "%s/%s/sill", verb_name(above->kind), above->name);
    else if (z1 < HUGE_VAL)
        add_side(&s, 0, 0, 1, z1, "wall/%s/cut", w->name);
    if (!above) add_side(&s, -top->a[1], -top->a[2], 1, top->a[0], "wall/%s/top", w->name);
    return add_shape(list, BODY, &s, err);
}

static int compare_heights(const void *a, const void *b)
{
    const struct plan_opening *x = *(const struct plan_opening *const *)a, *y = *(const struct plan_opening *const *)b;
    return x->z[0] < y->z[0] ? -1 : x->z[0] > y->z[0];
}

/* Whether the top is above z somewhere over the column. */
static bool reaches(const struct column *c, const struct top *top, double z)
{
    const struct plan_wall *w = &c->parts->plan->walls[c->wall];
    for (int k = 0; k < 4; k++) {
        double p[2];
        wall_point(w, c->s[k & 1], k & 2 ? w->thickness : 0, p);
        if (top->a[0] + top->a[1] * p[0] + top->a[2] * p[1] > z + NEAR) return true;
    }
    return false;
}

/* Heights at which a column is cut because several openings share one of its sides: a piece for each reveal. */
static int shared_side_cuts(const struct column *c, double *cuts)
{
    const struct wall_parts *w = c->parts;
    int cut_count = 0;
    for (int upper = 0; upper < 2; upper++) {
        int count;
        beyond(c, upper, 0, 0, &count);
        for (int i = w->first[c->wall]; count > 1 && i < w->first[c->wall + 1]; i++) {
            const struct plan_opening *o = w->openings[i];
            if (fabs(o->s[!upper] - c->s[upper]) > NEAR) continue;
            cuts[cut_count++] = o->z[0];
            cuts[cut_count++] = o->z[1];
        }
    }
    return unique(cuts, cut_count);
}

static enum status add_column(struct solid_list *list, const struct column *c, const struct top *top,
                              const struct plan_opening **holes, double *cuts, struct err *err)
{
    const struct wall_parts *w = c->parts;
    const struct plan_wall *wall = &w->plan->walls[c->wall];
    int hole_count = 0;
    for (int i = w->first[c->wall]; i < w->first[c->wall + 1]; i++) {
        const struct plan_opening *o = w->openings[i];
        if (o->s[0] < c->s[1] - NEAR && o->s[1] > c->s[0] + NEAR) holes[hole_count++] = o;
    }
    if (hole_count) qsort(holes, (size_t)hole_count, sizeof *holes, compare_heights);
    const int cut_count = shared_side_cuts(c, cuts);
    double z = wall->foot;
    const struct plan_opening *below = NULL;
    enum status st = ST_OK;
    bool cut = false;
    for (int i = 0; i <= hole_count && !st; i++) {
        const struct plan_opening *above = i < hole_count ? holes[i] : NULL;
        const double to = above ? above->z[0] : HUGE_VAL;
        for (int k = 0; k < cut_count && !st; k++) {
            if (cuts[k] <= z + NEAR || cuts[k] >= to - NEAR || !reaches(c, top, cuts[k])) continue;
            st = add_piece(list, c, z, below, cuts[k], NULL, top, cut, err);
            z = cuts[k];
            below = NULL;
            cut = true;
        }
        if (!st && above) st = above->z[0] - z > NEAR ? add_piece(list, c, z, below, to, above, NULL, cut, err) : ST_OK;
        if (!st && !above && reaches(c, top, z)) st = add_piece(list, c, z, below, HUGE_VAL, NULL, top, cut, err);
        if (above) {
            z = above->z[1];
            below = above;
            cut = false;
        }
    }
    return st;
}

/* The different ceilings above a column; without a room the wall's own top. */
static int tops_above(const struct column *c, struct top *tops)
{
    const struct wall_parts *w = c->parts;
    const struct plan_wall *wall = &w->plan->walls[c->wall];
    int n = 0;
    for (int i = w->first_top[c->wall]; !wall->has_top && i < w->first_top[c->wall + 1]; i++) {
        if (c->middle < w->tops[i].s[0] || c->middle > w->tops[i].s[1]) continue;
        bool known = false;
        for (int k = 0; k < n; k++) known |= !memcmp(tops[k].a, w->tops[i].top.a, sizeof tops[k].a);
        if (!known) tops[n++] = w->tops[i].top;
    }
    if (!n) tops[n++] = (struct top){{wall->top, 0, 0}};
    return n;
}

/* Whether one of the wall's openings has its low or upper side at s. */
static bool opens_at(const struct wall_parts *parts, int wall, int upper, double s)
{
    for (int i = parts->first[wall]; i < parts->first[wall + 1]; i++)
        if (fabs(parts->openings[i]->s[upper] - s) <= NEAR) return true;
    return false;
}

/* The limits of a wall's columns along S: its span, the sides of its openings and, where its ceilings differ from its
 * own top, the ends of rooms. */
static int column_limits(const struct wall_parts *parts, int wall, const double span[2], double *s)
{
    const struct plan_wall *w = &parts->plan->walls[wall];
    int n = 0, kept = 0;
    s[n++] = span[0];
    s[n++] = span[1];
    for (int i = parts->first[wall]; i < parts->first[wall + 1]; i++)
        for (int k = 0; k < 2; k++) s[n++] = parts->openings[i]->s[k];
    const struct top own = {{w->top, 0, 0}};
    bool level = true; /* the same height all along */
    for (int i = parts->first_top[wall]; i < parts->first_top[wall + 1]; i++)
        level &= !memcmp(parts->tops[i].top.a, own.a, sizeof own.a);
    for (int i = parts->first_top[wall]; i < parts->first_top[wall + 1] && !level && !w->has_top; i++)
        for (int k = 0; k < 2; k++) s[n++] = parts->tops[i].s[k];
    for (int i = 0; i < n; i++)
        if ((s[i] > span[0] + NEAR && s[i] < span[1] - NEAR) || i < 2) s[kept++] = s[i];
    return unique(s, kept);
}

static enum status add_wall(struct solid_list *list, const struct wall_parts *parts, int wall, struct err *err)
{
    const int openings = parts->first[wall + 1] - parts->first[wall];
    const int rooms = parts->first_top[wall + 1] - parts->first_top[wall];
    const size_t room = (size_t)(4 * openings + 2 * rooms) + 4;
    double *s = calloc(room, sizeof *s), *cuts = calloc(room, sizeof *cuts), span[2], reach[2];
    const struct plan_opening **holes = calloc(room, sizeof *holes);
    struct top *tops = calloc((size_t)rooms + 1, sizeof *tops);
    int kept = 0;
    enum status st = s && cuts && holes && tops ? ST_OK : err_nomem(err, "a wall's pieces", room * sizeof *s);
    if (!st) {
        wall_span(parts->plan, wall, span);
        wall_reach(parts->plan, wall, reach);
        kept = column_limits(parts, wall, span, s);
    }
    /* The first and the last column reach to the caps, unless an opening begins at the corner: then the corner is a
     * separate column. */
    const bool corner[2] = {!st && span[0] - reach[0] > NEAR && opens_at(parts, wall, 0, span[0]),
                            !st && reach[1] - span[1] > NEAR && opens_at(parts, wall, 1, span[1])};
    for (int i = corner[0] ? -1 : 0; i < kept - 1 + corner[1] && !st; i++) {
        struct column c = {parts, wall, i <= -corner[0], i >= kept - 2 + corner[1], i < 0 || i > kept - 2, {0, 0}, 0};
        /* a corner has the rooms of the column next to it */
        const int clear = i < 0 ? 0 : i > kept - 2 ? kept - 2 : i;
        c.middle = 0.5 * (s[clear] + s[clear + 1]);
        c.s[0] = i < 0 ? reach[0] : s[i];
        c.s[1] = i < kept - 1 ? s[i + 1] : reach[1];
        const int count = tops_above(&c, tops);
        for (int k = 0; k < count && !st; k++) st = add_column(list, &c, &tops[k], holes, cuts, err);
    }
    free(tops);
    free(holes);
    free(cuts);
    free(s);
    return st;
}

/* ---------------------------------------------------------------------------------------------- leaves and panes */

/* A slab that fills an opening, from `a` to `b` behind the wall's in face. */
static enum status add_filling(struct solid_list *list, const struct plan *p, const struct plan_opening *o, double a,
                               double b, bool glass, struct err *err)
{
    const struct plan_wall *w = &p->walls[o->wall];
    const struct plan_line in = wall_face(w, SIDE_IN);
    const char *kind = glass ? "glass" : verb_name(o->kind), *leaf = glass ? "" : "leaf-";
    char body[NAME_SIZE];
    struct shape s = {0};
    snprintf(body, sizeof body, glass ? "glass/%s" : BODY "%.0s", o->name);
    add_side(&s, in.n[0], in.n[1], 0, in.c - a, "%s/%s/%sin", kind, o->name, leaf);
    add_side(&s, -in.n[0], -in.n[1], 0, b - in.c, "%s/%s/%sout", kind, o->name, leaf);
    for (int k = 0; k < 2; k++) {
        const double along = w->sign * (o->s[k] + w->origin), out = (k == 1) == (w->sign > 0) ? 1 : -1;
        add_side(&s, out * w->d[0], out * w->d[1], 0, out * along, "%s/%s/%s", kind, o->name, reveal_side(w, k));
    }
    add_side(&s, 0, 0, -1, -o->z[0], "%s/%s/sill", kind, o->name);
    add_side(&s, 0, 0, 1, o->z[1], "%s/%s/head", kind, o->name);
    return add_shape(list, body, &s, err);
}

static enum status add_leaf(struct solid_list *list, const struct plan *p, const struct plan_opening *o,
                            struct err *err)
{
    const double middle = 0.5 * p->walls[o->wall].thickness;
    return add_filling(list, p, o, middle - 0.5 * o->leaf, middle + 0.5 * o->leaf, false, err);
}

static enum status add_pane(struct solid_list *list, const struct plan *p, const struct plan_opening *o, int side,
                            struct err *err)
{
    const double t = p->walls[o->wall].thickness;
    return side == SIDE_OUT ? add_filling(list, p, o, t - o->leaf, t, true, err)
                            : add_filling(list, p, o, 0, o->leaf, true, err);
}

/* ---------------------------------------------------------------------------------------------- floors and ceilings */

struct slab_corner {
    double p[2];
    struct plan_line line; /* of the polygon's side that ends here, n outwards */
    int wall, side;        /* the wall face that this side lies in; wall -1: a cut, -2: the middle of a wall */
};

static double turn_at(const struct slab_corner *c, int n, int i)
{
    const double *a = c[(i + n - 1) % n].p, *b = c[i].p, *d = c[(i + 1) % n].p;
    return (b[0] - a[0]) * (d[1] - b[1]) - (b[1] - a[1]) * (d[0] - b[0]);
}

struct slabs {
    struct solid_list *list;
    const struct plan *plan;
    const struct plan_room *room;
    struct err *err;
};

static void slab_sides(struct shape *s, const struct slabs *b, const struct slab_corner *c, int n, const char *what)
{
    const struct plan *p = b->plan;
    for (int i = 0; i < n; i++)
        if (c[i].wall >= 0 && !p->walls[c[i].wall].removed)
            add_side(s, c[i].line.n[0], c[i].line.n[1], 0, c[i].line.c, "wall/%s/%s", p->walls[c[i].wall].name,
                     c[i].side == SIDE_IN ? "in" : "out");
        else
            add_side(s, c[i].line.n[0], c[i].line.n[1], 0, c[i].line.c, "%s/%s/side", what, b->room->name);
}

static enum status add_slabs(const struct slabs *b, const struct slab_corner *c, int n)
{
    const struct plan_room *r = b->room;
    const double *l = r->lower;
    struct shape floor = {0}, ceiling = {0};
    slab_sides(&floor, b, c, n, "floor");
    add_side(&floor, 0, 0, 1, r->floor, "floor/%s", r->name);
    add_side(&floor, 0, 0, -1, r->slab - r->floor, "floor/%s/bottom", r->name);
    slab_sides(&ceiling, b, c, n, "ceiling");
    add_side(&ceiling, l[1], l[2], -1, -l[0], "ceiling/%s", r->name);
    add_side(&ceiling, -l[1], -l[2], 1, l[0] + r->slab, "ceiling/%s/top", r->name);
    if (!add_shape(b->list, BODY, &floor, b->err)) add_shape(b->list, BODY, &ceiling, b->err);
    shape_release(&ceiling);
    return b->err->status;
}

/* Extends the side that ends at a reflex corner to the nearest side that it hits, at the point `at`; -1: none. */
static int extend_side(const struct slab_corner *c, int n, int reflex, double at[2])
{
    const double *p = c[reflex].p;
    const struct plan_line line = c[reflex].line;
    const double d[2] = {-line.n[1], line.n[0]}; /* direction of the side, counter-clockwise */
    double nearest = HUGE_VAL;
    int hit = -1;
    for (int k = 0; k < n; k++) {
        const int before = (k + n - 1) % n;
        if (k == reflex || before == reflex) continue;
        const double *a = c[before].p, *e = c[k].p;
        const double ha = line.n[0] * a[0] + line.n[1] * a[1] - line.c,
                     he = line.n[0] * e[0] + line.n[1] * e[1] - line.c;
        if ((ha > 0) == (he > 0)) continue;
        const double t = ha / (ha - he);
        const double ahead = d[0] * (a[0] + t * (e[0] - a[0]) - p[0]) + d[1] * (a[1] + t * (e[1] - a[1]) - p[1]);
        if (ahead > 1e-9 && ahead < nearest) {
            nearest = ahead;
            hit = k;
        }
    }
    at[0] = p[0] + nearest * d[0];
    at[1] = p[1] + nearest * d[1];
    return hit;
}

/* Cuts the polygon into convex parts. At a reflex corner the line of the side before it is extended to the nearest side
 * that it hits, which makes two polygons with fewer reflex corners. */
static enum status cut_convex(const struct slabs *b, struct slab_corner *c, int n, int depth)
{
    int reflex = 0;
    while (reflex < n && !(turn_at(c, n, reflex) < -1e-12)) reflex++;
    if (reflex == n) return add_slabs(b, c, n);
    const struct plan_line line = c[reflex].line;
    double at[2];
    const int hit = extend_side(c, n, reflex, at);
    struct slab_corner *part = hit < 0 || depth > n + 64 ? NULL : calloc(2 * (size_t)n + 8, sizeof *part);
    if (!part)
        return err_set(b->err, ST_INTERNAL, "the floor of room %s could not be cut into convex parts; this is a bug.",
                       b->room->name);
    enum status st = ST_OK;
    for (int half = 0; half < 2 && !st; half++) {
        int m = 0;
        /* half 0: from the reflex corner along the border to the side hit, and back along the cut; half 1: the rest */
        const int from = half == 0 ? reflex : hit, to = half == 0 ? hit : reflex;
        for (int k = from; k != to; k = (k + 1) % n) part[m++] = c[k];
        if (half == 0) {
            part[0].wall = -1; /* the cut ends at the reflex corner */
            part[m] = c[hit];  /* the side hit, up to the cut */
            memcpy(part[m++].p, at, sizeof at);
            part[0].line = (struct plan_line){{-line.n[0], -line.n[1]}, -line.c};
        } else {
            part[m] = c[reflex]; /* the side before the corner continues to the cut's other end */
            memcpy(part[m++].p, at, sizeof at);
        }
        /* drop corners that coincide with the one before */
        int kept = 0;
        for (int k = 0; k < m; k++) {
            const double *q = part[k].p, *prev = part[(k + m - 1) % m].p;
            if (hypot(q[0] - prev[0], q[1] - prev[1]) > 1e-9) part[kept++] = part[k];
        }
        if (kept >= 3) st = cut_convex(b, part, kept, depth + 1);
    }
    free(part);
    return st;
}

static enum status add_room(struct solid_list *list, const struct plan *p, const struct plan_room *r, struct err *err)
{
    const struct slabs b = {list, p, r, err};
    struct slab_corner *c = calloc((size_t)r->edge_count, sizeof *c);
    if (!c) return err_nomem(err, "a room's corners", (size_t)r->edge_count * sizeof *c);
    for (int e = 0; e < r->edge_count; e++) {
        const struct room_edge *edge = &r->edges[e];
        const struct plan_wall *w = &p->walls[edge->wall];
        const double sign = edge->side == SIDE_IN ? -1 : 1; /* out of the room */
        memcpy(c[e].p, edge->outer, sizeof c[e].p);
        c[e].line = (struct plan_line){{sign * w->d[1], -sign * w->d[0]}, sign * edge->border};
        c[e].wall = edge->shared ? -2 : edge->wall;
        c[e].side = edge->side == SIDE_IN ? SIDE_OUT : SIDE_IN;
    }
    const enum status st = cut_convex(&b, c, r->edge_count, 0);
    free(c);
    return st;
}

/* ------------------------------------------------------------------------------------------------------------ boxes */

static enum status add_box(struct solid_list *list, const struct plan_box *b, struct err *err)
{
    static const char *const names[4] = {"left", "right", "front", "back"};
    const double turn = fmod(b->turn, 360) * DEGREE;
    double c = cos(turn), s = sin(turn);
    if (fmod(b->turn, 90) == 0) c = round(c), s = round(s);
    const double middle[2] = {0.5 * (b->low[0] + b->high[0]), 0.5 * (b->low[1] + b->high[1])};
    struct shape sh = {0};
    for (int k = 0; k < 4; k++) {
        const int axis = k / 2, out = k % 2 ? 1 : -1;
        const double n[2] = {axis ? -out * s : out * c, axis ? out * c : out * s};
        const double offset = b->turn == 0 ? (k % 2 ? b->high[axis] : -b->low[axis])
                                           : n[0] * middle[0] + n[1] * middle[1] + 0.5 * (b->high[axis] - b->low[axis]);
        add_side(&sh, n[0], n[1], 0, offset, "box/%s/%s", b->name, names[k]);
    }
    add_side(&sh, 0, 0, -1, -b->low[2], "box/%s/bottom", b->name);
    add_side(&sh, 0, 0, 1, b->high[2], "box/%s/top", b->name);
    return add_shape(list, BODY, &sh, err);
}

enum status layout_solids(struct solid_list *list, const struct plan *plan, struct err *err)
{
    struct wall_parts parts;
    *list = (struct solid_list){0};
    enum status st = wall_parts_make(&parts, plan, err);
    if (st) return st;
    for (int i = 0; i < plan->wall_count && !st; i++)
        if (!plan->walls[i].removed) st = add_wall(list, &parts, i, err);
    for (int i = 0; i < plan->room_count && !st; i++)
        if (!plan->rooms[i].removed) st = add_room(list, plan, &plan->rooms[i], err);
    for (int i = 0; i < plan->box_count && !st; i++)
        if (!plan->boxes[i].removed) st = add_box(list, &plan->boxes[i], err);
    for (int i = 0; i < plan->opening_count && !st; i++) {
        const struct plan_opening *o = &plan->openings[i];
        int side;
        if (o->removed || !o->filled || plan->walls[o->wall].removed) continue;
        if (o->kind == VERB_DOOR)
            st = add_leaf(list, plan, o, err);
        else if (window_has_glass(plan, o, &side))
            st = add_pane(list, plan, o, side, err);
    }
    wall_parts_release(&parts);
    if (st) solid_list_release(list);
    return st;
}
