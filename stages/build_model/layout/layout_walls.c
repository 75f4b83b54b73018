/* layout_walls.c - walls as convex solids.
 *
 * A wall is cut into columns at the sides of its openings and where a sloping ceiling begins, and a column into pieces
 * at the sills and heads. Where two openings share a side, the pieces beside it are cut at their heights too, so that
 * each reveal has its own name. All pieces of a wall get its planes by the same numbers, so that a plane stays one
 * plane. Ends lie in the planes of the walls that they are joined to: a corner includes the intersection of both.
 *
 * A wall that rooms list goes up to their ceilings. Any other wall goes up to the ceilings of the rooms in which it
 * stands. It is cut into columns along the outlines of these rooms. A column outside all rooms has the wall's own
 * top. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/layout/layout_shape.h"
#include "stages/build_model/plan/room_parts.h"

struct span_top {
    double s[2];
    const struct plan_top *top;
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
        if (!plan_opening_is_there(p, o)) continue;
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
                plan_room_span(p, r, e, wall, w->tops[at].s);
                w->tops[at].top = &r->lower;
            }
        }
        for (size_t i = 0; pass == 0 && i < walls; i++) w->first_top[i + 1] += w->first_top[i];
    }
    for (size_t i = 0; i < walls; i++) w->first[i + 1] += w->first[i];
    return ST_OK;
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

static bool same_top(const struct plan_top *a, const struct plan_top *b)
{
    return a->count == b->count && !memcmp(a->a, b->a, (size_t)a->count * sizeof *a->a);
}

struct column {
    const struct wall_parts *parts;
    int wall;
    bool first, last; /* reaches the wall's end at low, at high S */
    bool corner;      /* lies in a corner with another wall, beyond the wall's span */
    double s[2];
    double middle; /* S that decides which rooms are beside it */
    /* the part of the column that is being added: its outline, and its top */
    const struct part_corner *outline;
    int corners;
    const struct plan_top *top;
};

enum { COLUMN_SIDE = -3 }; /* label of an outline's sides that are the column's own, in part_corner's wall */

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

/* The line of a column's low or upper side, n outwards. */
static struct plan_line column_line(const struct column *c, int upper, int *face_wall, int *face_side)
{
    const struct plan_wall *w = &c->parts->plan->walls[c->wall];
    const int end = (upper == 1) == (w->sign > 0) ? END_END : END_START;
    if (upper ? c->last : c->first) return plan_wall_cap(c->parts->plan, c->wall, end, face_wall, face_side);
    const double along = w->sign * (c->s[upper] + w->origin), out = end == END_END ? 1 : -1;
    *face_wall = -1;
    return (struct plan_line){{out * w->d[0], out * w->d[1]}, out * along};
}

static void add_column_side(struct shape *sh, const struct column *c, int upper, double z0, double z1)
{
    const struct plan *p = c->parts->plan;
    const struct plan_wall *w = &p->walls[c->wall];
    int count, face_wall, face_side;
    const int end = (upper == 1) == (w->sign > 0) ? END_END : END_START;
    const struct plan_line cap = column_line(c, upper, &face_wall, &face_side);
    if (upper ? c->last : c->first) {
        if (face_wall >= 0 && !p->walls[face_wall].removed)
            shape_add_side(sh, cap.n[0], cap.n[1], 0, cap.c, "wall/%s/%s", p->walls[face_wall].name,
                           face_side == SIDE_IN ? "in" : "out");
        else
            shape_add_side(sh, cap.n[0], cap.n[1], 0, cap.c, "wall/%s/%s", w->name, end == END_END ? "end" : "start");
        return;
    }
    const struct plan_opening *o = beyond(c, upper, z0, z1, &count);
    if (o && c->corner) { /* the reveal may be the face of the wall at that corner */
        int other, far;
        plan_wall_cap(p, c->wall, !end, &other, &far);
        if (other >= 0 && !p->walls[other].removed && square(w, &p->walls[other])) {
            const struct plan_line face = plan_wall_face(&p->walls[other], !far);
            shape_add_side(sh, face.n[0], face.n[1], 0, face.c, "wall/%s/%s", p->walls[other].name,
                           far == SIDE_OUT ? "in" : "out");
            return;
        }
    }
    if (o)
        shape_add_side(sh, cap.n[0], cap.n[1], 0, cap.c, "%s/%s/%s", plan_opening_word(o->kind), o->name,
                       shape_reveal_side(w, !upper));
    else
        shape_add_side(sh, cap.n[0], cap.n[1], 0, cap.c, "wall/%s/top", w->name); /* a step of the top, where visible */
}

/* A piece of a column, from z0 (the head of `below`, or the wall's foot) up to the sill of `above`, or to z1 or the
 * top. cut: z0 is a cut inside the column. */
static enum status add_piece(struct solid_list *list, const struct column *c, double z0,
                             const struct plan_opening *below, double z1, const struct plan_opening *above, bool cut,
                             struct err *err)
{
    const struct plan_wall *w = &c->parts->plan->walls[c->wall];
    const struct plan_line in = plan_wall_face(w, SIDE_IN), out = plan_wall_face(w, SIDE_OUT);
    struct shape s = {0};
    shape_add_side(&s, in.n[0], in.n[1], 0, in.c, "wall/%s/in", w->name);
    shape_add_side(&s, out.n[0], out.n[1], 0, out.c, "wall/%s/out", w->name);
    add_column_side(&s, c, 0, z0, z1);
    add_column_side(&s, c, 1, z0, z1);
    for (int i = 0; i < c->corners; i++) { /* a cut along a room's outline is a step of the top, where visible */
        const struct part_corner *o = &c->outline[i];
        if (o->wall != COLUMN_SIDE)
            shape_add_side(&s, o->line.n[0], o->line.n[1], 0, o->line.c, "wall/%s/top", w->name);
    }
    if (below)
        shape_add_side(&s, 0, 0, -1, -z0, "%s/%s/head", plan_opening_word(below->kind), below->name);
    else
        shape_add_side(&s, 0, 0, -1, -z0, "wall/%s/%s", w->name, cut ? "cut" : "bottom");
    if (above)
        shape_add_side(&s, 0, 0, 1, z1, "%s/%s/sill", plan_opening_word(above->kind), above->name);
    else if (z1 < HUGE_VAL)
        shape_add_side(&s, 0, 0, 1, z1, "wall/%s/cut", w->name);
    for (int i = 0; !above && i < c->top->count; i++) {
        const double *a = c->top->a[i];
        shape_add_side(&s, -a[1], -a[2], 1, a[0], "wall/%s/top", w->name);
    }
    return shape_add(list, BODY, &s, err);
}

static int compare_heights(const void *a, const void *b)
{
    const struct plan_opening *x = *(const struct plan_opening *const *)a, *y = *(const struct plan_opening *const *)b;
    return x->z[0] < y->z[0] ? -1 : x->z[0] > y->z[0];
}

/* Whether the top is above z somewhere over the column. */
static bool reaches(const struct column *c, double z)
{
    double high = -HUGE_VAL;
    for (int i = 0; i < c->top->count; i++) { /* of the lowest plane's highest corner */
        const struct plan_top one = {{{c->top->a[i][0], c->top->a[i][1], c->top->a[i][2]}}, 1};
        double most = -HUGE_VAL;
        for (int k = 0; k < c->corners; k++) most = fmax(most, plan_top_at(&one, c->outline[k].p));
        high = i ? fmin(high, most) : most;
    }
    return high > z + NEAR;
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

static enum status add_column(struct solid_list *list, const struct column *c, const struct plan_opening **holes,
                              double *cuts, struct err *err)
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
    bool cut = false;
    for (int i = 0; i <= hole_count && !err->status; i++) {
        const struct plan_opening *above = i < hole_count ? holes[i] : NULL;
        const double to = above ? above->z[0] : HUGE_VAL;
        for (int k = 0; k < cut_count && !err->status; k++) {
            if (cuts[k] <= z + NEAR || cuts[k] >= to - NEAR || !reaches(c, cuts[k])) continue;
            add_piece(list, c, z, below, cuts[k], NULL, cut, err);
            z = cuts[k];
            below = NULL;
            cut = true;
        }
        if (!err->status && above && above->z[0] - z > NEAR) add_piece(list, c, z, below, to, above, cut, err);
        if (!err->status && !above && reaches(c, z)) add_piece(list, c, z, below, HUGE_VAL, NULL, cut, err);
        if (above) {
            z = above->z[1];
            below = above;
            cut = false;
        }
    }
    return err->status;
}

/* The different ceilings of the wall's rooms above a column. */
static int tops_above(const struct column *c, const struct plan_top **tops)
{
    const struct wall_parts *w = c->parts;
    int n = 0;
    for (int i = w->first_top[c->wall]; !w->plan->walls[c->wall].has_top && i < w->first_top[c->wall + 1]; i++) {
        if (c->middle < w->tops[i].s[0] || c->middle > w->tops[i].s[1]) continue;
        bool known = false;
        for (int k = 0; k < n; k++) known |= same_top(tops[k], w->tops[i].top);
        if (!known) tops[n++] = w->tops[i].top;
    }
    return n;
}

/* A wall's column while it is cut along the outlines of rooms. */
struct cutting {
    struct solid_list *list;
    struct column *column;
    const struct plan_opening **holes;
    double *cuts;
    struct err *err;
};

static enum status add_cut_column(void *ctx, const struct part_corner *outline, int corners)
{
    struct cutting *t = ctx;
    t->column->outline = outline;
    t->column->corners = corners;
    return add_column(t->list, t->column, t->holes, t->cuts, t->err);
}

/* The part of the column in one part of a room. */
static enum status add_in_part(struct cutting *t, const struct part_corner quad[4], const struct room_part *part)
{
    const size_t size = (size_t)part->count + 5;
    struct part_corner *in = malloc(2 * size * sizeof *in), *cut = in + size;
    if (!in) return err_nomem(t->err, "a wall's outline", 2 * size * sizeof *in);
    int n = 4;
    memcpy(in, quad, 4 * sizeof *in);
    for (int i = 0; i < part->count && n; i++) {
        n = part_clip(cut, in, n, &part->corners[i]);
        memcpy(in, cut, (size_t)n * sizeof *in);
    }
    if (n) add_cut_column(t, in, n);
    free(in);
    return t->err->status;
}

/* A column of a wall that no room lists: under the ceiling of each room in which it stands, and elsewhere up to the
 * wall's own top. */
static enum status add_free_column(struct cutting *t, const struct part_corner quad[4])
{
    const struct plan *p = t->column->parts->plan;
    const struct plan_top own = plan_level_top(p->walls[t->column->wall].top);
    struct room_part *all = NULL;
    int count = 0;
    for (int i = 0; i < p->room_count && !t->err->status; i++) {
        const struct plan_room *r = &p->rooms[i];
        t->column->top = &r->lower;
        for (int k = 0; k < r->part_count && !r->removed && !t->err->status; k++) {
            if (array_append(&all, (size_t)count, sizeof *all, "parts of rooms", t->err)) break;
            all[count++] = r->parts[k];
            add_in_part(t, quad, &r->parts[k]);
        }
    }
    t->column->top = &own;
    if (!t->err->status) parts_outside(quad, 4, all, count, add_cut_column, t, t->err);
    free(all);
    return t->err->status;
}

/* The column's outline, counter-clockwise from its lower end. */
static void column_outline(const struct column *c, struct part_corner quad[4])
{
    const struct plan_wall *w = &c->parts->plan->walls[c->wall];
    int wall, side;
    const bool up = w->sign > 0; /* S grows from start to end, so the out face comes before the end's side */
    const struct plan_line lines[4] = {column_line(c, !up, &wall, &side), plan_wall_face(w, SIDE_IN),
                                       column_line(c, up, &wall, &side), plan_wall_face(w, SIDE_OUT)};
    for (int i = 0; i < 4; i++) {
        quad[i] = (struct part_corner){.line = lines[i], .wall = COLUMN_SIDE};
        plan_line_cross(lines[i], lines[(i + 1) % 4], quad[i].p);
    }
}

static enum status add_whole_column(struct cutting *t, const struct plan_top **tops)
{
    struct column *c = t->column;
    const struct plan_wall *w = &c->parts->plan->walls[c->wall];
    struct part_corner quad[4];
    column_outline(c, quad);
    const int count = tops_above(c, tops);
    if (!count && !w->has_top) return add_free_column(t, quad);
    const struct plan_top own = plan_level_top(w->top);
    for (int k = 0; k < (count ? count : 1) && !t->err->status; k++) {
        c->top = count ? tops[k] : &own;
        add_cut_column(t, quad, 4);
    }
    return t->err->status;
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
    const struct plan_top own = plan_level_top(w->top);
    bool level = true; /* the same height all along, also where it stands in other rooms */
    for (int i = 0; i < parts->plan->room_count; i++)
        level &= parts->plan->rooms[i].removed || same_top(&parts->plan->rooms[i].lower, &own);
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
    const struct plan_top **tops = calloc((size_t)rooms + 1, sizeof *tops);
    int kept = 0;
    if (!s || !cuts || !holes || !tops) err_nomem(err, "a wall's pieces", room * sizeof *s);
    if (!err->status) {
        plan_wall_span(parts->plan, wall, span);
        plan_wall_reach(parts->plan, wall, reach);
        kept = column_limits(parts, wall, span, s);
    }
    /* The first and the last column reach to the caps, unless an opening begins at the corner: then the corner is a
     * separate column. */
    const bool corner[2] = {!err->status && span[0] - reach[0] > NEAR && opens_at(parts, wall, 0, span[0]),
                            !err->status && reach[1] - span[1] > NEAR && opens_at(parts, wall, 1, span[1])};
    for (int i = corner[0] ? -1 : 0; i < kept - 1 + corner[1] && !err->status; i++) {
        struct column c = {.parts = parts,
                           .wall = wall,
                           .first = i <= -corner[0],
                           .last = i >= kept - 2 + corner[1],
                           .corner = i < 0 || i > kept - 2};
        struct cutting t = {list, &c, holes, cuts, err};
        /* a corner has the rooms of the column next to it */
        const int clear = i < 0 ? 0 : i > kept - 2 ? kept - 2 : i;
        c.middle = 0.5 * (s[clear] + s[clear + 1]);
        c.s[0] = i < 0 ? reach[0] : s[i];
        c.s[1] = i < kept - 1 ? s[i + 1] : reach[1];
        add_whole_column(&t, tops);
    }
    free(tops);
    free(holes);
    free(cuts);
    free(s);
    return err->status;
}

enum status layout_add_walls(struct solid_list *list, const struct plan *plan, struct err *err)
{
    struct wall_parts parts;
    if (wall_parts_make(&parts, plan, err)) return err->status;
    for (int i = 0; i < plan->wall_count && !err->status; i++)
        if (!plan->walls[i].removed) add_wall(list, &parts, i, err);
    wall_parts_release(&parts);
    return err->status;
}
