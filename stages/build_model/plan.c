/* plan.c - see plan.h.
 *
 * Statements change the plan at once, but what depends on the whole (whether an opening lies in its wall, whether a
 * room's walls close) is checked when all of the script is there, and in an edit after each statement: only what
 * leaves a building is an edit. */
#include "stages/build_model/plan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "stages/build_model/solid.h"

/* A plan's lengths are taken for equal within LENGTH_EPS; walls within PARALLEL of each other (sine) do not cross. */
#define LENGTH_EPS 1e-6
#define PARALLEL   0.0872
#define DEGREE     (3.14159265358979323846 / 180)
#define THINNEST   0.001
#define TALLEST    1000.0

static const char *const END_NAMES[] = {"start", "end"};

void plan_release(struct plan *plan)
{
    if (!plan) return;
    for (int i = 0; i < plan->wall_count; i++) free(plan->walls[i].name);
    for (int i = 0; i < plan->opening_count; i++) free(plan->openings[i].name);
    for (int i = 0; i < plan->box_count; i++) free(plan->boxes[i].name);
    for (int i = 0; i < plan->room_count; i++) {
        free(plan->rooms[i].name);
        free(plan->rooms[i].walls);
        free(plan->rooms[i].edges);
        free(plan->rooms[i].edge_of);
    }
    free(plan->walls);
    free(plan->openings);
    free(plan->boxes);
    free(plan->rooms);
    free(plan->names);
    *plan = (struct plan){0};
}

void plan_begin(struct plan *plan, const struct model_axes *axes)
{
    *plan = (struct plan){0};
    if (!axes || axes->metric) {
        plan->thickness = 0.15;
        plan->glass = 0.02;
        plan->leaf = 0.04;
        if (!axes) plan->ceiling = 2.5;
    }
    if (axes && axes->ceiling > 0) plan->ceiling = axes->ceiling;
    if (axes && axes->thickness > 0) plan->thickness = axes->thickness;
}

/* ------------------------------------------------------------------------------------------------------------ names */

static size_t hash_name(const char *name)
{
    size_t h = 1469598103934665603u;
    for (; *name; name++) h = (h ^ (unsigned char)*name) * 1099511628211u;
    return h;
}

static struct plan_name *find_slot(const struct plan *plan, const char *name)
{
    const size_t mask = (size_t)plan->name_room - 1;
    size_t i = hash_name(name) & mask;
    while (plan->names[i].name && strcmp(plan->names[i].name, name)) i = (i + 1) & mask;
    return &plan->names[i];
}

static enum named find_name(const struct plan *plan, const char *name, int *at)
{
    const struct plan_name *n = plan->name_room ? find_slot(plan, name) : NULL;
    if (!n || !n->name) return NAMED_NONE;
    *at = n->at;
    return n->kind;
}

static enum status add_name(struct plan *plan, const char *name, enum named kind, int at, struct err *err)
{
    if (2 * (plan->name_count + 1) > plan->name_room) {
        const int room = plan->name_room ? 2 * plan->name_room : 64;
        struct plan larger = {.names = calloc((size_t)room, sizeof *plan->names), .name_room = room};
        if (!larger.names) return err_nomem(err, "names", (size_t)room * sizeof *plan->names);
        for (int i = 0; i < plan->name_room; i++)
            if (plan->names[i].name) *find_slot(&larger, plan->names[i].name) = plan->names[i];
        free(plan->names);
        plan->names = larger.names;
        plan->name_room = room;
    }
    *find_slot(plan, name) = (struct plan_name){name, kind, at};
    plan->name_count++;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- statements */

struct doer {
    struct plan *plan;
    const char *path;
    const struct statement *s;
    const struct placer *placer;
    struct err *err;
};

static enum status refuse(struct doer *d, const char *fmt, ...) PRINTF_LIKE(2, 3);
static enum status refuse(struct doer *d, const char *fmt, ...)
{
    char text[1500];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(d->err, ST_DATA, "%s:%d: %s", d->path, d->s->line, text);
}

static const char *kind_name(enum named kind)
{
    static const char *const names[] = {"nothing", "a wall", "an opening", "a box", "a room"};
    return names[kind];
}

static int name_line(const struct plan *plan, enum named kind, int at)
{
    return kind == NAMED_WALL      ? plan->walls[at].line
           : kind == NAMED_OPENING ? plan->openings[at].line
           : kind == NAMED_BOX     ? plan->boxes[at].line
                                   : plan->rooms[at].line;
}

static bool is_removed(const struct plan *plan, enum named kind, int at)
{
    return kind == NAMED_WALL      ? plan->walls[at].removed
           : kind == NAMED_OPENING ? plan->openings[at].removed
           : kind == NAMED_BOX     ? plan->boxes[at].removed
                                   : plan->rooms[at].removed;
}

static const char *known_name(const void *ctx, int i)
{
    const struct plan *plan = ctx;
    for (int k = 0; k < plan->name_room; k++)
        if (plan->names[k].name && i-- == 0) return plan->names[k].name;
    return NULL;
}

/* What a name stands for; it must be there, not removed, and one of `kinds` (bits of enum named). */
static enum status known(struct doer *d, const char *name, unsigned kinds, const char *wanted, enum named *kind,
                         int *at)
{
    *kind = find_name(d->plan, name, at);
    if (*kind == NAMED_NONE) {
        const char *near = d->plan->name_count < 2000 ? scan_nearest(name, known_name, d->plan) : NULL;
        if (near) return refuse(d, "found %s, which is not named before; did you mean %s?", name, near);
        return refuse(d, "found %s, which is not named before; wanted %s.", name, wanted);
    }
    if (is_removed(d->plan, *kind, *at)) return refuse(d, "%s was removed; nothing can be done to it.", name);
    if (!(kinds & (1u << *kind))) return refuse(d, "%s is %s; wanted %s.", name, kind_name(*kind), wanted);
    return ST_OK;
}

static enum status known_solid(struct doer *d, const char *name, enum named *kind, int *at)
{
    return known(d, name, 1u << NAMED_WALL | 1u << NAMED_OPENING | 1u << NAMED_BOX, "a wall, an opening or a box", kind,
                 at);
}

static enum status known_wall(struct doer *d, const char *name, int *wall)
{
    enum named kind;
    return known(d, name, 1u << NAMED_WALL, "a wall", &kind, wall);
}

static enum status new_name(struct doer *d, const char *name, char **kept)
{
    int at;
    const enum named kind = find_name(d->plan, name, &at);
    if (kind != NAMED_NONE)
        return refuse(d,
                      "the name %s is used already, for %s%s (line %d); faces are known by their names, so that each "
                      "thing needs one of its own.",
                      name, kind_name(kind), is_removed(d->plan, kind, at) ? " that was removed" : "",
                      name_line(d->plan, kind, at));
    *kept = strdup(name);
    return *kept ? ST_OK : err_nomem(d->err, "a name", strlen(name));
}

/* Room for one more at the end of an array, zeroed; NULL: no memory. */
static void *one_more(void *array, int *count, size_t size, struct err *err)
{
    char **items = array;
    if (!(*count & (*count - 1))) { /* powers of two are where it grows */
        const size_t bytes = (*count ? 2 * (size_t)*count : 1) * size;
        char *more = realloc(*items, bytes);
        if (!more) {
            err_nomem(err, "the plan", bytes);
            return NULL;
        }
        *items = more;
    }
    char *at = *items + (size_t)*count * size;
    memset(at, 0, size);
    ++*count;
    return at;
}

static enum status check_length(struct doer *d, const char *what, double value)
{
    if (value >= THINNEST && value <= TALLEST) return ST_OK;
    return refuse(d, "found %s %.9g, wanted %g to %g.", what, value, THINNEST, TALLEST);
}

static enum status do_set(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *p = d->plan;
    const struct {
        const char *name;
        double *value;
        bool length;
    } quantities[] = {{"thickness", &p->thickness, true}, {"slab", &p->slab, true},    {"glass", &p->glass, true},
                      {"leaf", &p->leaf, true},           {"floor", &p->floor, false}, {"ceiling", &p->ceiling, false}};
    for (size_t i = 0; i < sizeof quantities / sizeof *quantities; i++) {
        if (strcmp(quantities[i].name, s->name)) continue;
        if (quantities[i].length && check_length(d, s->name, s->values[0])) return d->err->status;
        if (fabs(s->values[0]) > TALLEST)
            return refuse(d, "found %s %.9g, wanted at most %g.", s->name, s->values[0], TALLEST);
        *quantities[i].value = s->values[0];
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ lines */

struct plan_line wall_face(const struct plan_wall *w, int side)
{
    /* 0 - x, not -x: no -0 in what is written */
    const struct plan_line in = {{w->d[1], 0 - w->d[0]}, w->c};
    return side == SIDE_IN ? in : (struct plan_line){{0 - in.n[0], 0 - in.n[1]}, w->thickness - w->c};
}

void wall_point(const struct plan_wall *w, double s, double off, double p[2])
{
    const double t = w->sign * (s + w->origin), k = w->c - off;
    p[0] = w->d[0] * t + w->d[1] * k;
    p[1] = w->d[1] * t - w->d[0] * k;
}

static double wall_s(const struct plan_wall *w, const double p[2])
{
    return w->sign * (w->d[0] * p[0] + w->d[1] * p[1]) - w->origin;
}

bool line_cross(struct plan_line a, struct plan_line b, double p[2])
{
    const double det = a.n[0] * b.n[1] - a.n[1] * b.n[0];
    if (!(fabs(det) > PARALLEL / 10)) return false;
    p[0] = (a.c * b.n[1] - b.c * a.n[1]) / det;
    p[1] = (a.n[0] * b.c - b.n[0] * a.c) / det;
    return true;
}

/* The other wall's near or far face as seen by a wall that comes with one of its ends: n points on, away from it. */
static struct plan_line face_ahead(const struct plan_wall *w, int end, const struct plan_wall *other, bool far,
                                   int *side)
{
    const double e[2] = {end == END_END ? w->d[0] : -w->d[0], end == END_END ? w->d[1] : -w->d[1]};
    struct plan_line in = wall_face(other, SIDE_IN);
    const bool looks_on = in.n[0] * e[0] + in.n[1] * e[1] > 0; /* the in face is the one farther on */
    *side = looks_on == far ? SIDE_IN : SIDE_OUT;
    struct plan_line l = wall_face(other, *side);
    if (l.n[0] * e[0] + l.n[1] * e[1] < 0) l = (struct plan_line){{-l.n[0], -l.n[1]}, -l.c};
    return l;
}

struct plan_line wall_cap(const struct plan *plan, int wall, int end, int *face_wall, int *face_side)
{
    const struct plan_wall *w = &plan->walls[wall];
    const struct wall_end *e = &w->ends[end];
    *face_wall = -1;
    *face_side = SIDE_IN;
    if (e->kind == FREE_END) {
        const double t = w->sign * (e->s + w->origin);
        return end == END_END ? (struct plan_line){{w->d[0], w->d[1]}, t}
                              : (struct plan_line){{-w->d[0], -w->d[1]}, -t};
    }
    const struct plan_line l = face_ahead(w, end, &plan->walls[e->other], e->kind == CORNER_END, face_side);
    if (e->kind == CORNER_END) *face_wall = e->other;
    return l;
}

/* Where a line across the wall cuts it, as S: the least and the most over its two faces. */
static void cut_range(const struct plan_wall *w, struct plan_line across, double range[2])
{
    double p[2] = {0, 0};
    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int side = 0; side < 2; side++) {
        if (!line_cross(wall_face(w, side), across, p)) continue;
        const double s = wall_s(w, p);
        range[0] = fmin(range[0], s);
        range[1] = fmax(range[1], s);
    }
}

void wall_span(const struct plan *plan, int wall, double span[2])
{
    const struct plan_wall *w = &plan->walls[wall];
    for (int end = 0; end < 2; end++) {
        const struct wall_end *e = &w->ends[end];
        const int upper = (end == END_END) == (w->sign > 0); /* which bound of S this end is */
        if (e->kind == FREE_END) {
            span[upper] = e->s;
            continue;
        }
        double range[2];
        int side;
        cut_range(w, face_ahead(w, end, &plan->walls[e->other], false, &side), range);
        span[upper] = (upper ? range[0] : range[1]) + 0.0; /* a -0 becomes 0 */
    }
}

void wall_reach(const struct plan *plan, int wall, double span[2])
{
    const struct plan_wall *w = &plan->walls[wall];
    for (int end = 0; end < 2; end++) {
        double range[2];
        int face_wall, face_side;
        const int upper = (end == END_END) == (w->sign > 0);
        cut_range(w, wall_cap(plan, wall, end, &face_wall, &face_side), range);
        span[upper] = range[upper] + 0.0; /* a -0 becomes 0 */
    }
}

void room_span(const struct plan *plan, const struct plan_room *room, int edge, int wall, double span[2])
{
    const struct plan_wall *w = &plan->walls[wall];
    const struct room_edge *e = &room->edges[edge],
                           *before = &room->edges[(edge + room->edge_count - 1) % room->edge_count];
    const double a = fmin(wall_s(w, e->corner), wall_s(w, before->corner));
    const double b = fmax(wall_s(w, e->corner), wall_s(w, before->corner));
    double reach[2];
    span[0] = fmin(a, fmin(wall_s(w, e->outer), wall_s(w, before->outer)));
    span[1] = fmax(b, fmax(wall_s(w, e->outer), wall_s(w, before->outer)));
    wall_reach(plan, wall, reach);
    span[0] = fmax(span[0], reach[0]);
    span[1] = fmin(span[1], reach[1]);
}

static double ceiling_at(const struct plan_room *r, const double p[2])
{
    return r->lower[0] + r->lower[1] * p[0] + r->lower[2] * p[1];
}

int room_edge_of(const struct plan_room *r, int wall)
{
    for (int i = 0; i < r->wall_count; i++)
        if (r->walls[i] == wall) return r->edge_of[i];
    return -1;
}

double plan_wall_top(const struct plan *plan, int wall, double s0, double s1)
{
    const struct plan_wall *w = &plan->walls[wall];
    double least = HUGE_VAL;
    if (w->has_top) return w->top;
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            double span[2];
            if (room_edge_of(r, wall) != e) continue;
            room_span(plan, r, e, wall, span);
            if (span[1] <= s0 || span[0] >= s1) continue;
            for (int k = 0; k < 4; k++) {
                double p[2];
                wall_point(w, k & 1 ? s1 : s0, k & 2 ? w->thickness : 0, p);
                least = fmin(least, ceiling_at(r, p));
            }
        }
    }
    return least < HUGE_VAL ? least : w->top;
}

/* ------------------------------------------------------------------------------------------------------------ walls */

static enum status set_wall_line(struct doer *d, struct plan_wall *w, const double a[2], const double b[2])
{
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > LENGTH_EPS)) return refuse(d, "wall %s would have no length.", d->s->name);
    w->d[0] = (b[0] - a[0]) / length;
    w->d[1] = (b[1] - a[1]) / length;
    if (!w->angled) {
        const int axis = fabs(w->d[1]) > fabs(w->d[0]);
        if (fabs(w->d[!axis]) * length > LENGTH_EPS)
            return refuse(d,
                          "wall %s from %.9g %.9g to %.9g %.9g is not along an axis; write angled behind it if it is "
                          "meant so.",
                          d->s->name, a[0], a[1], b[0], b[1]);
        w->d[axis] = w->d[axis] > 0 ? 1 : -1;
        w->d[!axis] = 0;
        w->sign = (int)w->d[axis];
        w->origin = 0;
    } else {
        w->sign = 1;
        w->origin = w->d[0] * a[0] + w->d[1] * a[1];
    }
    w->c = w->d[1] * a[0] - w->d[0] * a[1];
    w->ends[END_START] = (struct wall_end){FREE_END, wall_s(w, a), -1};
    w->ends[END_END] = (struct wall_end){FREE_END, wall_s(w, b), -1};
    return ST_OK;
}

static enum status place_new_wall(struct doer *d, struct plan_wall *w)
{
    const struct statement *s = d->s;
    if (s->place.kind == PLACE_COORDINATES) return set_wall_line(d, w, s->place.a, s->place.a + 2);
    struct placed_wall placed;
    if (place_wall(&placed, d->placer, &s->place, NULL, w->angled, d->path, s->line, d->err)) return d->err->status;
    /* left to right for who looks against n: d is n turned by 90 degrees counter-clockwise */
    const double dir[2] = {-placed.n[1], placed.n[0]};
    double ends[2][2];
    for (int i = 0; i < 2; i++) {
        const double t = dir[0] * placed.ends[i][0] + dir[1] * placed.ends[i][1];
        ends[i][0] = dir[0] * t + placed.n[0] * placed.c;
        ends[i][1] = dir[1] * t + placed.n[1] * placed.c;
    }
    if (set_wall_line(d, w, ends[0], ends[1])) return d->err->status;
    w->c = placed.c;
    log_note("wall %s: %zu points, half of them within %.3g of it", s->name, placed.points, placed.spread);
    return ST_OK;
}

static enum status do_wall(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *p = d->plan;
    struct plan_wall w = {.line = s->line, .angled = s->angled};
    if (new_name(d, s->name, &w.name)) return d->err->status;
    w.thickness = s->has_option[OPTION_THICKNESS] ? s->options[OPTION_THICKNESS] : p->thickness;
    w.foot = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : p->floor;
    w.top = s->has_option[OPTION_TOP] ? s->options[OPTION_TOP] : p->ceiling;
    w.has_top = s->has_option[OPTION_TOP];
    enum status st = ST_OK;
    if (!s->has_option[OPTION_THICKNESS] && w.thickness == 0)
        st = refuse(d, "how thick walls are is not known without a scale; write \"set thickness NUMBER\" before.");
    else if (!w.has_top && w.top == 0)
        st = refuse(d, "no ceiling was found; write \"set ceiling NUMBER\" before.");
    else
        st = check_length(d, "thickness", w.thickness);
    if (!st && !(w.top - w.foot >= THINNEST))
        st = refuse(d, "wall %s goes from %.9g up to %.9g, wanted a top above its foot.", s->name, w.foot, w.top);
    if (!st) st = place_new_wall(d, &w);
    struct plan_wall *at = st ? NULL : one_more(&p->walls, &p->wall_count, sizeof w, d->err);
    if (!at) {
        free(w.name);
        return d->err->status;
    }
    *at = w;
    return add_name(p, at->name, NAMED_WALL, p->wall_count - 1, d->err);
}

/* A rectangle on a wall: S and z, ascending. */
static enum status place_on_wall(struct doer *d, const struct plan_wall *w, double s[2], double z[2])
{
    const struct place *p = &d->s->place;
    if (p->kind == PLACE_COORDINATES) {
        s[0] = fmin(p->a[0], p->a[2]);
        s[1] = fmax(p->a[0], p->a[2]);
        z[0] = fmin(p->a[1], p->a[3]);
        z[1] = fmax(p->a[1], p->a[3]);
        return ST_OK;
    }
    /* the face that the camera sees is found by trying: from behind, a ray meets the in face from the wrong side */
    struct vec3 corners[2];
    const struct plan_line in = wall_face(w, SIDE_IN), out = wall_face(w, SIDE_OUT);
    struct err first = ERR_INIT;
    if (place_corners(corners, d->placer, p, vec3_make(in.n[0], in.n[1], 0), in.c, d->path, d->s->line, &first)) {
        struct err second = ERR_INIT;
        if (place_corners(corners, d->placer, p, vec3_make(out.n[0], out.n[1], 0), out.c, d->path, d->s->line, &second))
            return err_set(d->err, first.status, "%s", first.text);
    }
    for (int i = 0; i < 2; i++) {
        const double at[2] = {corners[i].x, corners[i].y};
        s[i] = wall_s(w, at);
        z[i] = corners[i].z;
    }
    if (s[0] > s[1]) {
        const double t = s[0];
        s[0] = s[1];
        s[1] = t;
    }
    if (z[0] > z[1]) {
        const double t = z[0];
        z[0] = z[1];
        z[1] = t;
    }
    return ST_OK;
}

/* Doors and passages stand on the floor whatever pixel was hit there. */
static void stand_on_floor(const struct doer *d, const struct plan_wall *w, enum verb kind, double z[2])
{
    if (kind != VERB_WINDOW && d->s->place.kind == PLACE_VIEW) z[0] = w->foot;
}

static enum status do_opening(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *p = d->plan;
    struct plan_opening o = {.line = s->line, .kind = s->verb, .interior = s->interior};
    if (known_wall(d, s->other, &o.wall)) return d->err->status;
    const struct plan_wall *w = &p->walls[o.wall];
    o.filled = s->verb == VERB_WINDOW ? !s->open : s->closed;
    if (place_on_wall(d, w, o.s, o.z)) return d->err->status;
    stand_on_floor(d, w, s->verb, o.z);
    if (new_name(d, s->name, &o.name)) return d->err->status;
    o.leaf = s->verb == VERB_WINDOW ? p->glass : p->leaf;
    if (o.filled && o.leaf == 0) {
        free(o.name);
        return refuse(d, "how thick %s is not known without a scale; write \"set %s NUMBER\" before.",
                      s->verb == VERB_WINDOW ? "glass is" : "a door's leaf is",
                      s->verb == VERB_WINDOW ? "glass" : "leaf");
    }
    struct plan_opening *at = one_more(&p->openings, &p->opening_count, sizeof o, d->err);
    if (!at) {
        free(o.name);
        return d->err->status;
    }
    *at = o;
    return add_name(p, at->name, NAMED_OPENING, p->opening_count - 1, d->err);
}

/* A box's footprint: the corners, at the height `at` where a view shows them. */
static enum status place_footprint(struct doer *d, double at, double low[3], double high[3])
{
    const struct place *p = &d->s->place;
    double a[4];
    memcpy(a, p->a, sizeof a);
    if (p->kind == PLACE_VIEW) {
        struct vec3 corners[2];
        struct err above = ERR_INIT; /* seen from above, else, like a beam, from below */
        if (place_corners(corners, d->placer, p, vec3_make(0, 0, 1), at, d->path, d->s->line, &above) &&
            place_corners(corners, d->placer, p, vec3_make(0, 0, -1), -at, d->path, d->s->line, d->err))
            return d->err->status;
        for (int i = 0; i < 2; i++) {
            a[2 * i] = corners[i].x;
            a[2 * i + 1] = corners[i].y;
        }
    }
    for (int k = 0; k < 2; k++) {
        low[k] = fmin(a[k], a[2 + k]);
        high[k] = fmax(a[k], a[2 + k]);
    }
    return ST_OK;
}

static enum status do_box(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *p = d->plan;
    struct plan_box b = {.line = s->line, .turn = s->has_option[OPTION_TURN] ? s->options[OPTION_TURN] : 0};
    b.low[2] = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : p->floor;
    b.high[2] = s->has_option[OPTION_TOP] ? s->options[OPTION_TOP] : p->ceiling;
    if (!s->has_option[OPTION_TOP] && p->ceiling == 0)
        return refuse(d, "no ceiling was found, up to which box %s would go; write top NUMBER behind it.", s->name);
    const double at = s->has_option[OPTION_AT] ? s->options[OPTION_AT] : b.low[2];
    if (place_footprint(d, at, b.low, b.high) || new_name(d, s->name, &b.name)) return d->err->status;
    struct plan_box *kept = one_more(&p->boxes, &p->box_count, sizeof b, d->err);
    if (!kept) {
        free(b.name);
        return d->err->status;
    }
    *kept = b;
    return add_name(p, kept->name, NAMED_BOX, p->box_count - 1, d->err);
}

static enum status do_room(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *p = d->plan;
    struct plan_room r = {.line = s->line, .wall_count = s->name_count};
    r.floor = s->has_option[OPTION_FLOOR] ? s->options[OPTION_FLOOR] : p->floor;
    r.ceiling = s->has_option[OPTION_CEILING] ? s->options[OPTION_CEILING] : p->ceiling;
    if (r.ceiling == 0) return refuse(d, "no ceiling was found; write ceiling NUMBER behind the room.");
    if (!(r.ceiling - r.floor >= THINNEST))
        return refuse(d, "room %s goes from %.9g up to %.9g, wanted a ceiling above the floor.", s->name, r.floor,
                      r.ceiling);
    r.slab = p->slab > 0 ? p->slab : p->thickness;
    if (r.slab == 0)
        return refuse(d, "how thick floors are is not known without a scale; write \"set slab NUMBER\" before.");
    r.lower[0] = r.ceiling;
    r.walls = calloc((size_t)s->name_count, sizeof *r.walls);
    if (!r.walls) return err_nomem(d->err, "a room", (size_t)s->name_count * sizeof *r.walls);
    for (int i = 0; i < s->name_count && !d->err->status; i++) {
        known_wall(d, s->names[i], &r.walls[i]);
        for (int k = 0; k < i && !d->err->status; k++)
            if (r.walls[k] == r.walls[i]) refuse(d, "room %s names wall %s twice.", s->name, s->names[i]);
    }
    struct plan_room *at = NULL;
    if (!d->err->status && !new_name(d, s->name, &r.name)) at = one_more(&p->rooms, &p->room_count, sizeof r, d->err);
    if (!at) {
        free(r.walls);
        free(r.name);
        return d->err->status;
    }
    *at = r;
    return add_name(p, at->name, NAMED_ROOM, p->room_count - 1, d->err);
}

static enum status do_slope(struct doer *d)
{
    const struct statement *s = d->s;
    enum named kind;
    int at, walls[2];
    if (known(d, s->name, 1u << NAMED_ROOM, "a room", &kind, &at)) return d->err->status;
    struct plan_room *r = &d->plan->rooms[at];
    for (int i = 0; i < 2; i++) {
        if (known_wall(d, s->names[i], &walls[i])) return d->err->status;
        bool there = false;
        for (int k = 0; k < r->wall_count; k++) there |= r->walls[k] == walls[i];
        if (!there) return refuse(d, "wall %s is not of room %s.", s->names[i], s->name);
        if (!(s->values[i] - r->floor >= THINNEST))
            return refuse(d, "the ceiling of %s would be at %.9g at wall %s, not above the floor (%.9g).", s->name,
                          s->values[i], s->names[i], r->floor);
    }
    const struct plan_wall *a = &d->plan->walls[walls[0]], *b = &d->plan->walls[walls[1]];
    if (walls[0] == walls[1] || !(fabs(a->d[0] * b->d[1] - a->d[1] * b->d[0]) < 1e-9))
        return refuse(d, "a ceiling slopes from one wall to another that is parallel to it; %s and %s are not.",
                      s->names[0], s->names[1]);
    r->sloped = true;
    memcpy(r->slope_walls, walls, sizeof walls);
    memcpy(r->slope_heights, s->values, sizeof r->slope_heights);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------- walls with walls */

static double from_end(const struct plan *plan, int wall, int end, const double p[2])
{
    double range[2];
    int face_wall, face_side;
    const struct plan_wall *w = &plan->walls[wall];
    cut_range(w, wall_cap(plan, wall, end, &face_wall, &face_side), range);
    return fabs(wall_s(w, p) - 0.5 * (range[0] + range[1]));
}

/* The end of a that comes to b's corner: the one joined to b already, else the nearer free one. */
static enum status corner_end(struct doer *d, int a, int b, const double p[2], int *end)
{
    const struct plan *plan = d->plan;
    const struct plan_wall *w = &plan->walls[a];
    for (int e = 0; e < 2; e++)
        if (w->ends[e].kind != FREE_END && w->ends[e].other == b) {
            *end = e;
            return ST_OK;
        }
    const bool free0 = w->ends[0].kind == FREE_END, free1 = w->ends[1].kind == FREE_END;
    if (!free0 && !free1)
        return refuse(d, "walls %s and %s can't be joined: both ends of %s are joined already, to %s and %s.", w->name,
                      plan->walls[b].name, w->name, plan->walls[w->ends[0].other].name,
                      plan->walls[w->ends[1].other].name);
    *end = !free1 ? 0 : !free0 ? 1 : from_end(plan, a, 0, p) <= from_end(plan, a, 1, p) ? 0 : 1;
    return ST_OK;
}

static enum status check_crossing(struct doer *d, int a, int b, double p[2])
{
    const struct plan_wall *x = &d->plan->walls[a], *y = &d->plan->walls[b];
    if (a == b) return refuse(d, "wall %s can't be joined to itself.", x->name);
    if (fabs(x->d[0] * y->d[1] - x->d[1] * y->d[0]) > PARALLEL)
        return line_cross(wall_face(x, SIDE_IN), wall_face(y, SIDE_IN), p), ST_OK;
    return refuse(d, "walls %s and %s can't be joined: they are parallel, or nearly so, and never meet.", x->name,
                  y->name);
}

static enum status do_join(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *plan = d->plan;
    for (int i = 0; i + 1 < s->name_count; i++) {
        int walls[2], ends[2];
        double p[2];
        if (known_wall(d, s->names[i], &walls[0]) || known_wall(d, s->names[i + 1], &walls[1]) ||
            check_crossing(d, walls[0], walls[1], p) || corner_end(d, walls[0], walls[1], p, &ends[0]) ||
            corner_end(d, walls[1], walls[0], p, &ends[1]))
            return d->err->status;
        for (int k = 0; k < 2; k++) plan->walls[walls[k]].ends[ends[k]] = (struct wall_end){CORNER_END, 0, walls[!k]};
    }
    return ST_OK;
}

static enum status do_extend(struct doer *d)
{
    const struct statement *s = d->s;
    int wall, other;
    double p[2];
    if (known_wall(d, s->name, &wall)) return d->err->status;
    struct wall_end *e = &d->plan->walls[wall].ends[s->end];
    if (!s->other) {
        *e = (struct wall_end){FREE_END, s->values[0], -1};
        return ST_OK;
    }
    if (known_wall(d, s->other, &other) || check_crossing(d, wall, other, p)) return d->err->status;
    const struct wall_end *opposite = &d->plan->walls[wall].ends[!s->end];
    if (opposite->kind != FREE_END && opposite->other == other)
        return refuse(d, "wall %s can't be extended to %s: its other end is there already.", s->name, s->other);
    *e = (struct wall_end){MEET_END, 0, other};
    return ST_OK;
}

/* The rooms that list a wall list the new part of it beside it. */
static enum status add_to_rooms(struct doer *d, int wall, int part)
{
    struct plan *plan = d->plan;
    for (int i = 0; i < plan->room_count; i++) {
        struct plan_room *r = &plan->rooms[i];
        int at = 0;
        while (at < r->wall_count && r->walls[at] != wall) at++;
        if (at == r->wall_count) continue;
        int *more = realloc(r->walls, ((size_t)r->wall_count + 1) * sizeof *more);
        if (!more) return err_nomem(d->err, "a room", ((size_t)r->wall_count + 1) * sizeof *more);
        r->walls = more;
        /* the part with the end that the next wall joins comes last */
        const int next = r->walls[(at + 1) % r->wall_count];
        const struct plan_wall *p = &plan->walls[part], *n = &plan->walls[next];
        bool after = p->ends[END_END].kind != FREE_END && p->ends[END_END].other == next;
        for (int e = 0; e < 2; e++) after |= n->ends[e].kind != FREE_END && n->ends[e].other == part;
        const int where = after ? at + 1 : at;
        memmove(r->walls + where + 1, r->walls + where, (size_t)(r->wall_count - where) * sizeof *more);
        r->walls[where] = part;
        r->wall_count++;
    }
    return ST_OK;
}

static enum status do_split(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *plan = d->plan;
    int wall;
    double span[2];
    char *name = NULL;
    const double gap[2] = {fmin(s->values[0], s->values[1]), fmax(s->values[0], s->values[1])};
    if (known_wall(d, s->name, &wall)) return d->err->status;
    wall_span(plan, wall, span);
    if (!(gap[0] > span[0] + LENGTH_EPS && gap[1] < span[1] - LENGTH_EPS && gap[1] > gap[0] + LENGTH_EPS))
        return refuse(d, "the gap from %.9g to %.9g does not lie in wall %s, which goes from %.9g to %.9g.", gap[0],
                      gap[1], s->name, span[0], span[1]);
    for (int i = 0; i < plan->opening_count; i++) {
        const struct plan_opening *o = &plan->openings[i];
        if (o->wall == wall && !o->removed && o->s[0] < gap[1] && o->s[1] > gap[0])
            return refuse(d, "the gap from %.9g to %.9g cuts %s %s, from %.9g to %.9g; remove that first.", gap[0],
                          gap[1], verb_name(o->kind), o->name, o->s[0], o->s[1]);
    }
    if (new_name(d, s->other, &name)) return d->err->status;
    struct plan_wall *part = one_more(&plan->walls, &plan->wall_count, sizeof *part, d->err);
    if (!part) {
        free(name);
        return d->err->status;
    }
    const int new = plan->wall_count - 1;
    struct plan_wall *w = &plan->walls[wall];
    *part = *w;
    part->name = name;
    part->line = s->line;
    part->ends[END_START] = (struct wall_end){FREE_END, gap[w->sign > 0], -1};
    w->ends[END_END] = (struct wall_end){FREE_END, gap[w->sign < 0], -1};
    const bool new_above = w->sign > 0; /* the new part has the larger S */
    const double middle = 0.5 * (gap[0] + gap[1]);
    for (int i = 0; i < plan->opening_count; i++) {
        struct plan_opening *o = &plan->openings[i];
        if (o->wall == wall && (o->s[0] > middle) == new_above) o->wall = new;
    }
    for (int i = 0; i < plan->wall_count; i++)
        for (int e = 0; e < 2; e++) {
            struct plan_wall *x = &plan->walls[i];
            double p[2];
            if (i == wall || i == new || x->ends[e].kind == FREE_END || x->ends[e].other != wall) continue;
            if (line_cross(wall_face(x, SIDE_IN), wall_face(w, SIDE_IN), p) && (wall_s(w, p) > middle) == new_above)
                x->ends[e].other = new;
        }
    if (add_name(plan, part->name, NAMED_WALL, new, d->err)) return d->err->status;
    return add_to_rooms(d, wall, new);
}

/* ------------------------------------------------------------------------------------------------------------ edits */

static enum status do_adjust(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *plan = d->plan;
    enum named kind;
    int at;
    if (known_solid(d, s->name, &kind, &at)) return d->err->status;
    if (kind == NAMED_OPENING) {
        struct plan_opening *o = &plan->openings[at];
        if (place_on_wall(d, &plan->walls[o->wall], o->s, o->z)) return d->err->status;
        stand_on_floor(d, &plan->walls[o->wall], o->kind, o->z);
        return ST_OK;
    }
    if (kind == NAMED_BOX) {
        struct plan_box *b = &plan->boxes[at];
        return place_footprint(d, b->low[2], b->low, b->high);
    }
    struct plan_wall *w = &plan->walls[at];
    const struct plan_line in = wall_face(w, SIDE_IN);
    if (s->place.kind == PLACE_COORDINATES) {
        /* a line through two points: parallel to the wall */
        const double *a = s->place.a;
        const double c0 = in.n[0] * a[0] + in.n[1] * a[1], c1 = in.n[0] * a[2] + in.n[1] * a[3];
        if (!(fabs(c0 - c1) <= LENGTH_EPS))
            return refuse(d, "from %.9g %.9g to %.9g %.9g is not parallel to wall %s; a wall keeps its direction.",
                          a[0], a[1], a[2], a[3], s->name);
        w->c = c0;
        return ST_OK;
    }
    struct placed_wall placed;
    if (place_wall(&placed, d->placer, &s->place, in.n, false, d->path, s->line, d->err)) return d->err->status;
    log_note("wall %s: moved by %.3g; %zu points, half of them within %.3g of it", s->name, placed.c - w->c,
             placed.points, placed.spread);
    w->c = placed.c;
    return ST_OK;
}

static enum status do_move(struct doer *d)
{
    const struct statement *s = d->s;
    struct plan *plan = d->plan;
    enum named kind;
    int at;
    if (known_solid(d, s->name, &kind, &at)) return d->err->status;
    if (kind == NAMED_BOX) {
        if (s->value_count != 2)
            return refuse(d, "a box moves by two distances, in x and y: \"move %s by DX DY\".", s->name);
        for (int k = 0; k < 2; k++) {
            plan->boxes[at].low[k] += s->values[k];
            plan->boxes[at].high[k] += s->values[k];
        }
        return ST_OK;
    }
    if (s->value_count != 1)
        return refuse(d,
                      kind == NAMED_WALL ? "a wall moves along its normal, by one distance, away from its inside: "
                                           "\"move %s by DISTANCE\"; extend moves its ends."
                                         : "an opening moves along its wall, by one distance: \"move %s by "
                                           "DISTANCE\"; adjust changes its size.",
                      s->name);
    if (kind == NAMED_WALL) {
        plan->walls[at].c -= s->values[0];
        return ST_OK;
    }
    for (int k = 0; k < 2; k++) plan->openings[at].s[k] += s->values[0];
    return ST_OK;
}

static enum status do_fill(struct doer *d, bool fill)
{
    const struct statement *s = d->s;
    enum named kind;
    int at;
    if (known(d, s->name, 1u << NAMED_OPENING, "a door or a window", &kind, &at)) return d->err->status;
    struct plan_opening *o = &d->plan->openings[at];
    if (o->kind == VERB_PASSAGE)
        return refuse(d, "passage %s has no leaf that could be %s; a door has.", s->name, fill ? "closed" : "opened");
    if (o->filled == fill)
        return refuse(d, "%s %s is %s already.", verb_name(o->kind), s->name, fill ? "closed" : "open");
    const double leaf = o->kind == VERB_WINDOW ? d->plan->glass : d->plan->leaf;
    if (fill && leaf == 0)
        return refuse(d, "how thick it is is not known without a scale; write \"set %s NUMBER\" before.",
                      o->kind == VERB_WINDOW ? "glass" : "leaf");
    o->filled = fill;
    if (fill) o->leaf = leaf;
    return ST_OK;
}

static enum status do_remove(struct doer *d)
{
    struct plan *plan = d->plan;
    enum named kind;
    int at;
    if (known(d, d->s->name, ~0u, "anything", &kind, &at)) return d->err->status;
    switch (kind) {
    case NAMED_WALL:
        plan->walls[at].removed = true;
        for (int i = 0; i < plan->opening_count; i++)
            if (plan->openings[i].wall == at) plan->openings[i].removed = true;
        break;
    case NAMED_OPENING:
        plan->openings[at].removed = true;
        break;
    case NAMED_BOX:
        plan->boxes[at].removed = true;
        break;
    default:
        plan->rooms[at].removed = true;
    }
    return ST_OK;
}

static enum status apply_one(struct doer *d)
{
    switch (d->s->verb) {
    case VERB_SET:
        return do_set(d);
    case VERB_WALL:
        return do_wall(d);
    case VERB_ROOM:
        return do_room(d);
    case VERB_SLOPE:
        return do_slope(d);
    case VERB_DOOR:
    case VERB_PASSAGE:
    case VERB_WINDOW:
        return do_opening(d);
    case VERB_BOX:
        return do_box(d);
    case VERB_JOIN:
        return do_join(d);
    case VERB_EXTEND:
        return do_extend(d);
    case VERB_SPLIT:
        return do_split(d);
    case VERB_ADJUST:
        return do_adjust(d);
    case VERB_MOVE:
        return do_move(d);
    case VERB_OPEN:
        return do_fill(d, false);
    case VERB_CLOSE:
        return do_fill(d, true);
    default:
        return do_remove(d);
    }
}

/* ----------------------------------------------------------------------------------------------------------- checks */

struct checker {
    struct plan *plan;
    const char *path;
    int line; /* of the statement of an edit; 0: what is wrong is told with the line that made it */
    struct err *err;
};

static enum status wrong(struct checker *c, int own, const char *fmt, ...) PRINTF_LIKE(3, 4);
static enum status wrong(struct checker *c, int own, const char *fmt, ...)
{
    char text[1500];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(c->err, ST_DATA, "%s:%d: %s", c->path, c->line ? c->line : own, text);
}

static enum status check_walls(struct checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->wall_count; i++) {
        const struct plan_wall *w = &p->walls[i];
        double span[2], place[2];
        if (w->removed) continue;
        wall_span(p, i, span);
        if (!(span[1] - span[0] >= THINNEST))
            return wrong(c, w->line, "wall %s would be shorter than %g: from %.9g to %.9g.", w->name, THINNEST, span[0],
                         span[1]);
        for (int e = 0; e < 2; e++) {
            if (w->ends[e].kind == FREE_END) continue;
            const struct plan_wall *o = &p->walls[w->ends[e].other];
            if (o->removed) continue;
            bool mutual = false;
            for (int k = 0; k < 2; k++) mutual |= o->ends[k].kind != FREE_END && o->ends[k].other == i;
            if (mutual) continue;
            double reach[2], at[2] = {HUGE_VAL, -HUGE_VAL};
            wall_reach(p, w->ends[e].other, reach);
            for (int side = 0; side < 2; side++) {
                int face;
                if (!line_cross(wall_face(w, side), face_ahead(w, e, o, false, &face), place)) continue;
                at[0] = fmin(at[0], wall_s(o, place));
                at[1] = fmax(at[1], wall_s(o, place));
            }
            if (!(at[0] >= reach[0] - LENGTH_EPS && at[1] <= reach[1] + LENGTH_EPS))
                return wrong(c, w->line,
                             "the %s of wall %s does not meet wall %s, which goes from %.9g to %.9g and would "
                             "have to reach %.9g.",
                             END_NAMES[e], w->name, o->name, reach[0], reach[1], at[0] < reach[0] ? at[0] : at[1]);
            for (int k = 0; k < p->opening_count; k++) {
                const struct plan_opening *q = &p->openings[k];
                if (q->removed || q->wall != w->ends[e].other || q->s[0] >= at[1] - LENGTH_EPS ||
                    q->s[1] <= at[0] + LENGTH_EPS || q->z[0] >= w->top || q->z[1] <= w->foot)
                    continue;
                return wrong(c, q->line,
                             "%s %s, from %.9g to %.9g on wall %s, is where wall %s meets it (%.9g to %.9g).",
                             verb_name(q->kind), q->name, q->s[0], q->s[1], o->name, w->name, at[0], at[1]);
            }
        }
    }
    return ST_OK;
}

static enum status check_openings(struct checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->opening_count; i++) {
        const struct plan_opening *o = &p->openings[i];
        double span[2];
        if (o->removed) continue;
        const struct plan_wall *w = &p->walls[o->wall];
        wall_span(p, o->wall, span);
        if (!(o->s[1] - o->s[0] >= THINNEST && o->z[1] - o->z[0] >= THINNEST))
            return wrong(c, o->line, "%s %s would be %.3g wide and %.3g high.", verb_name(o->kind), o->name,
                         o->s[1] - o->s[0], o->z[1] - o->z[0]);
        if (o->s[0] < span[0] - LENGTH_EPS || o->s[1] > span[1] + LENGTH_EPS)
            return wrong(c, o->line,
                         "%s %s, from %.9g to %.9g, is outside of its wall %s, which goes from %.9g to %.9g.",
                         verb_name(o->kind), o->name, o->s[0], o->s[1], w->name, span[0], span[1]);
        const double top = plan_wall_top(p, o->wall, o->s[0], o->s[1]);
        if (o->z[0] < w->foot - LENGTH_EPS || o->z[1] > top + LENGTH_EPS)
            return wrong(
                c, o->line,
                "%s %s, from %.9g up to %.9g, is outside of its wall %s, which goes from %.9g up to %.9g there.",
                verb_name(o->kind), o->name, o->z[0], o->z[1], w->name, w->foot, top);
        for (int k = 0; k < i; k++) {
            const struct plan_opening *q = &p->openings[k];
            if (q->wall == o->wall && !q->removed && q->s[0] < o->s[1] && q->s[1] > o->s[0] && q->z[0] < o->z[1] &&
                q->z[1] > o->z[0])
                return wrong(c, o->line, "%s %s and %s %s, on wall %s, are in each other.", verb_name(q->kind), q->name,
                             verb_name(o->kind), o->name, w->name);
        }
        if (o->filled && o->leaf > w->thickness)
            return wrong(c, o->line, "%s %s is thicker than its wall %s.", verb_name(o->kind), o->name, w->name);
    }
    for (int i = 0; i < p->box_count; i++) {
        const struct plan_box *b = &p->boxes[i];
        if (!b->removed && !(b->high[0] - b->low[0] >= THINNEST && b->high[1] - b->low[1] >= THINNEST &&
                             b->high[2] - b->low[2] >= THINNEST))
            return wrong(c, b->line, "box %s would be %.3g x %.3g x %.3g large.", b->name, b->high[0] - b->low[0],
                         b->high[1] - b->low[1], b->high[2] - b->low[2]);
    }
    return ST_OK;
}

static bool same_line(const struct plan_wall *a, const struct plan_wall *b)
{
    const double turn = a->d[0] * b->d[0] + a->d[1] * b->d[1];
    return turn > 1 - 1e-12 && fabs(a->c - b->c) < LENGTH_EPS;
}

static bool touch(const struct plan *p, int a, int b)
{
    for (int e = 0; e < 2; e++) {
        const struct wall_end *x = &p->walls[a].ends[e], *y = &p->walls[b].ends[e];
        if ((x->kind != FREE_END && x->other == b) || (y->kind != FREE_END && y->other == a)) return true;
    }
    return false;
}

/* Walls of one line in a row become an edge. */
static enum status group_walls(struct checker *c, struct plan_room *r)
{
    struct plan *p = c->plan;
    int *group = r->edge_of;
    int start = 0; /* a wall that does not go on the line of the one before */
    while (start < r->wall_count &&
           same_line(&p->walls[r->walls[(start + r->wall_count - 1) % r->wall_count]], &p->walls[r->walls[start]]))
        start++;
    r->edge_count = 0;
    for (int k = 0; k < r->wall_count && start < r->wall_count; k++) {
        const int i = (start + k) % r->wall_count, before = (i + r->wall_count - 1) % r->wall_count;
        if (k == 0 || !same_line(&p->walls[r->walls[before]], &p->walls[r->walls[i]]))
            r->edges[r->edge_count++] = (struct room_edge){.wall = r->walls[i]};
        group[i] = r->edge_count - 1;
    }
    if (r->edge_count < 3) return wrong(c, r->line, "the walls of room %s do not go round it.", r->name);
    for (int e = 0; e < r->edge_count; e++) {
        const int f = (e + 1) % r->edge_count;
        const struct plan_wall *a = &p->walls[r->edges[e].wall], *b = &p->walls[r->edges[f].wall];
        bool met = false;
        if (!(fabs(a->d[0] * b->d[1] - a->d[1] * b->d[0]) > PARALLEL))
            return wrong(c, r->line, "walls %s and %s, which follow each other round room %s, are parallel and apart.",
                         a->name, b->name, r->name);
        for (int i = 0; i < r->wall_count; i++)
            for (int k = 0; k < r->wall_count && group[i] == e; k++)
                met |= group[k] == f && touch(p, r->walls[i], r->walls[k]);
        if (!met)
            return wrong(
                c, r->line,
                "walls %s and %s, which follow each other round room %s, do not meet: join them, or extend one to "
                "the other.",
                a->name, b->name, r->name);
    }
    return ST_OK;
}

static double cross2(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* From a to b and from x to y; those of one line meet only where they have a point in common. */
static bool segments_meet(const double a[2], const double b[2], const double x[2], const double y[2])
{
    for (int k = 0; k < 2; k++)
        if (fmax(a[k], b[k]) < fmin(x[k], y[k]) || fmin(a[k], b[k]) > fmax(x[k], y[k])) return false;
    return cross2(a, b, x) * cross2(a, b, y) <= 0 && cross2(x, y, a) * cross2(x, y, b) <= 0;
}

/* Corners by lines through the walls, `off` behind their in faces. */
static void room_corners(const struct plan *p, struct plan_room *r, double off)
{
    for (int e = 0; e < r->edge_count; e++) {
        const struct plan_wall *a = &p->walls[r->edges[e].wall], *b = &p->walls[r->edges[(e + 1) % r->edge_count].wall];
        struct plan_line x = wall_face(a, SIDE_IN), y = wall_face(b, SIDE_IN);
        x.c -= off * a->thickness;
        y.c -= off * b->thickness;
        line_cross(x, y, r->edges[e].corner);
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

/* The sides that face the room, and its corners; counter-clockwise. */
static enum status shape_room(struct checker *c, struct plan_room *r)
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
        const struct plan_line in = wall_face(&p->walls[edge->wall], SIDE_IN);
        edge->side = in.n[0] * (a[1] - b[1]) + in.n[1] * (b[0] - a[0]) > 0 ? SIDE_IN : SIDE_OUT;
    }
    for (int e = 0; e < r->edge_count; e++)
        line_cross(wall_face(&p->walls[r->edges[e].wall], r->edges[e].side),
                   wall_face(&p->walls[r->edges[(e + 1) % r->edge_count].wall], r->edges[(e + 1) % r->edge_count].side),
                   r->edges[e].corner);
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].corner, *b = r->edges[e].corner;
        const struct plan_line face = wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
        if (!(face.n[0] * (a[1] - b[1]) + face.n[1] * (b[0] - a[0]) > LENGTH_EPS))
            return wrong(c, r->line, "room %s has no room before wall %s.", r->name, p->walls[r->edges[e].wall].name);
        for (int f = e + 2; f < r->edge_count; f++) { /* edges that are no neighbours may not touch */
            if (e == 0 && f == r->edge_count - 1) continue;
            const double *x = r->edges[f - 1].corner, *y = r->edges[f].corner;
            if (segments_meet(a, b, x, y))
                return wrong(c, r->line,
                             "walls %s and %s cross each other in room %s; name its walls in the order in "
                             "which they go round it.",
                             p->walls[r->edges[e].wall].name, p->walls[r->edges[f].wall].name, r->name);
        }
    }
    return ST_OK;
}

/* The ceiling's lower face. */
static enum status slope_room(struct checker *c, struct plan_room *r)
{
    const struct plan *p = c->plan;
    r->lower[0] = r->ceiling;
    r->lower[1] = r->lower[2] = 0;
    if (!r->sloped) return ST_OK;
    double at[2] = {0, 0};
    struct plan_line first = {{0, 0}, 0};
    for (int i = 0; i < 2; i++)
        for (int e = 0; e < r->edge_count; e++) {
            if (room_edge_of(r, r->slope_walls[i]) != e) continue;
            const struct plan_line face = wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
            if (i == 0) first = face;
            at[i] = face.n[0] * first.n[0] + face.n[1] * first.n[1] > 0 ? face.c : -face.c;
        }
    if (!(fabs(at[1] - at[0]) > THINNEST))
        return wrong(c, r->line, "the ceiling of room %s has no width to slope over.", r->name);
    const double rise = (r->slope_heights[1] - r->slope_heights[0]) / (at[1] - at[0]);
    r->lower[0] = r->slope_heights[0] - rise * at[0];
    r->lower[1] = rise * first.n[0];
    r->lower[2] = rise * first.n[1];
    return ST_OK;
}

/* The slabs' border, behind the walls' thickness, goes round the room as its inside does: walls that are thicker than
 * what is between two parts of a room are in each other. */
static enum status check_border(struct checker *c, const struct plan_room *r)
{
    const struct plan *p = c->plan;
    for (int e = 0; e < r->edge_count; e++) {
        const double *a = r->edges[(e + r->edge_count - 1) % r->edge_count].outer, *b = r->edges[e].outer;
        const struct plan_line face = wall_face(&p->walls[r->edges[e].wall], r->edges[e].side);
        if (!(face.n[0] * (a[1] - b[1]) + face.n[1] * (b[0] - a[0]) > LENGTH_EPS))
            return wrong(c, r->line, "the walls at both ends of %s, in room %s, are in each other.",
                         p->walls[r->edges[e].wall].name, r->name);
        for (int f = e + 2; f < r->edge_count; f++)
            if ((e || f < r->edge_count - 1) && segments_meet(a, b, r->edges[f - 1].outer, r->edges[f].outer))
                return wrong(c, r->line, "walls %s and %s of room %s are in each other.",
                             p->walls[r->edges[e].wall].name, p->walls[r->edges[f].wall].name, r->name);
    }
    return ST_OK;
}

static enum status check_rooms(struct checker *c)
{
    struct plan *p = c->plan;
    unsigned char *sides = calloc((size_t)p->wall_count + 1, 1); /* of each wall that face rooms */
    if (!sides) return err_nomem(c->err, "walls' sides", (size_t)p->wall_count);
    enum status st = ST_OK;
    for (int i = 0; i < p->room_count && !st; i++) {
        struct plan_room *r = &p->rooms[i];
        if (r->removed) continue;
        free(r->edges);
        free(r->edge_of);
        r->edges = calloc((size_t)r->wall_count, sizeof *r->edges);
        r->edge_of = calloc((size_t)r->wall_count, sizeof *r->edge_of);
        st = r->edges && r->edge_of ? group_walls(c, r) : err_nomem(c->err, "a room's edges", (size_t)r->wall_count);
        if (!st) st = shape_room(c, r);
        if (!st) st = slope_room(c, r);
        for (int k = 0; !st && k < r->wall_count; k++)
            sides[r->walls[k]] |= (unsigned char)(1 << r->edges[r->edge_of[k]].side);
    }
    for (int i = 0; i < p->room_count && !st; i++) {
        struct plan_room *r = &p->rooms[i];
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            struct room_edge *edge = &r->edges[e];
            const struct plan_wall *w = &p->walls[edge->wall];
            edge->shared = sides[edge->wall] == 3;
            edge->border = w->c - (edge->shared ? 0.5 : edge->side == SIDE_IN ? 1 : 0) * w->thickness;
        }
        for (int e = 0; !r->removed && !st && e < r->edge_count; e++) {
            struct plan_line x = wall_face(&p->walls[r->edges[e].wall], SIDE_IN);
            struct plan_line y = wall_face(&p->walls[r->edges[(e + 1) % r->edge_count].wall], SIDE_IN);
            x.c = r->edges[e].border;
            y.c = r->edges[(e + 1) % r->edge_count].border;
            line_cross(x, y, r->edges[e].outer);
            if (!(ceiling_at(r, r->edges[e].outer) - r->floor >= THINNEST))
                st = wrong(c, r->line, "the ceiling of room %s comes down to its floor.", r->name);
        }
        if (!r->removed && !st) st = check_border(c, r);
    }
    free(sides);
    return st;
}

static enum status check_within(struct checker *c, int own, const char *what, const char *name, const double *values,
                                int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(values[i]) <= SOLID_REACH))
            return wrong(c, own, "%s %s reaches to %.9g; a model lies within %g units of the origin.", what, name,
                         values[i], SOLID_REACH);
    return ST_OK;
}

/* Solids have coordinates of so many digits and no more. */
static enum status check_reach(struct checker *c)
{
    const struct plan *p = c->plan;
    for (int i = 0; i < p->wall_count; i++) {
        const struct plan_wall *w = &p->walls[i];
        double at[10] = {w->foot, w->top}, reach[2];
        if (w->removed) continue;
        wall_reach(p, i, reach);
        for (int k = 0; k < 4; k++) wall_point(w, reach[k & 1], k & 2 ? w->thickness : 0, at + 2 + 2 * k);
        if (check_within(c, w->line, "wall", w->name, at, 10)) return c->err->status;
    }
    for (int i = 0; i < p->room_count; i++) {
        const struct plan_room *r = &p->rooms[i];
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            const double *corner = r->edges[e].outer;
            const double at[4] = {corner[0], corner[1], r->floor - r->slab, ceiling_at(r, corner) + r->slab};
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

static enum status plan_check(struct plan *plan, const char *path, int line, struct err *err)
{
    struct checker c = {plan, path, line, err};
    if (check_rooms(&c) || check_walls(&c) || check_openings(&c) || check_reach(&c)) return err->status;
    return ST_OK;
}

enum status plan_apply(struct plan *plan, const struct script *script, bool edit, const struct placer *placer,
                       struct err *err)
{
    struct doer d = {plan, script->path, NULL, placer, err};
    for (int i = 0; i < script->count; i++) {
        d.s = &script->statements[i];
        const struct statement *s = d.s;
        if (s->place.kind == PLACE_VIEW && !placer)
            return refuse(&d, "it names the view %s, but no views are known to this run; give --views.", s->place.view);
        if (apply_one(&d)) return err->status;
        if (edit && plan_check(plan, script->path, s->line, err)) return err->status;
    }
    return edit ? ST_OK : plan_check(plan, script->path, 0, err);
}
