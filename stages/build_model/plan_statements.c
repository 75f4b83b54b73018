/* plan_statements.c - what each statement of a model script does to the plan.
 *
 * A statement changes the plan at once. What depends on the whole plan (whether an opening lies in its wall, whether a
 * room's walls close) is checked once the script is read, and in an edit after each statement, so that the statement
 * which breaks the building is named. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "stages/build_model/plan_internal.h"
#include "stages/build_model/room_parts.h"

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
        room_parts_release(&plan->rooms[i]);
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

static enum status check_length(struct plan_context *c, const char *what, double value)
{
    if (value >= MIN_SIZE && value <= MAX_SIZE) return ST_OK;
    return statement_error(c, "found %s %.9g, wanted %g to %g.", what, value, MIN_SIZE, MAX_SIZE);
}

static enum status apply_set(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    const struct {
        const char *name;
        double *value;
        bool length;
    } quantities[] = {{"thickness", &p->thickness, true}, {"slab", &p->slab, true},    {"glass", &p->glass, true},
                      {"leaf", &p->leaf, true},           {"floor", &p->floor, false}, {"ceiling", &p->ceiling, false}};
    for (size_t i = 0; i < sizeof quantities / sizeof *quantities; i++) {
        if (strcmp(quantities[i].name, s->name)) continue;
        if (quantities[i].length && check_length(c, s->name, s->values[0])) return c->err->status;
        if (fabs(s->values[0]) > MAX_SIZE)
            return statement_error(c, "found %s %.9g, wanted at most %g.", s->name, s->values[0], MAX_SIZE);
        *quantities[i].value = s->values[0];
    }
    return ST_OK;
}
/* ------------------------------------------------------------------------------------------------------------ walls */

static enum status set_wall_line(struct plan_context *c, struct plan_wall *w, const double a[2], const double b[2])
{
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > LENGTH_EPS)) return statement_error(c, "wall %s would have no length.", c->s->name);
    w->d[0] = (b[0] - a[0]) / length;
    w->d[1] = (b[1] - a[1]) / length;
    if (!w->angled) {
        const int axis = fabs(w->d[1]) > fabs(w->d[0]);
        if (fabs(w->d[!axis]) * length > LENGTH_EPS)
            return statement_error(
                c,
                "wall %s from %.9g %.9g to %.9g %.9g is not along an axis; add the word angled if that is "
                "intended.",
                c->s->name, a[0], a[1], b[0], b[1]);
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

static enum status place_new_wall(struct plan_context *c, struct plan_wall *w)
{
    const struct statement *s = c->s;
    if (s->place.kind == PLACE_COORDINATES) return set_wall_line(c, w, s->place.a, s->place.a + 2);
    struct placed_wall placed;
    if (place_wall(&placed, c->placer, &s->place, NULL, w->angled, c->path, s->line, c->err)) return c->err->status;
    /* left to right for a viewer looking against n: n turned by 90 degrees counter-clockwise */
    const double dir[2] = {-placed.n[1], placed.n[0]};
    double ends[2][2];
    for (int i = 0; i < 2; i++) {
        const double t = dir[0] * placed.ends[i][0] + dir[1] * placed.ends[i][1];
        ends[i][0] = dir[0] * t + placed.n[0] * placed.c;
        ends[i][1] = dir[1] * t + placed.n[1] * placed.c;
    }
    if (set_wall_line(c, w, ends[0], ends[1])) return c->err->status;
    w->c = placed.c;
    log_note("wall %s: %zu points, median distance from the wall %.3g", s->name, placed.points, placed.spread);
    return ST_OK;
}

static enum status apply_wall(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_wall w = {.line = s->line, .angled = s->angled};
    if (copy_new_name(c, s->name, &w.name)) return c->err->status;
    w.thickness = s->has_option[OPTION_THICKNESS] ? s->options[OPTION_THICKNESS] : p->thickness;
    w.foot = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : p->floor;
    w.top = s->has_option[OPTION_TOP] ? s->options[OPTION_TOP] : p->ceiling;
    w.has_top = s->has_option[OPTION_TOP];
    enum status st = ST_OK;
    if (!s->has_option[OPTION_THICKNESS] && w.thickness == 0)
        st = statement_error(
            c, "the thickness of walls is unknown without a scale; write \"set thickness NUMBER\" before.");
    else if (!w.has_top && w.top == 0)
        st = statement_error(c, "no ceiling was found; write \"set ceiling NUMBER\" before.");
    else
        st = check_length(c, "thickness", w.thickness);
    if (!st && !(w.top - w.foot >= MIN_SIZE))
        st = statement_error(c, "wall %s goes from %.9g up to %.9g, wanted a top above its foot.", s->name, w.foot,
                             w.top);
    if (!st) st = place_new_wall(c, &w);
    if (!st) st = array_append(&p->walls, (size_t)p->wall_count, sizeof w, "walls", c->err);
    if (st) {
        free(w.name);
        return st;
    }
    p->walls[p->wall_count++] = w;
    return add_name(p, w.name, NAMED_WALL, p->wall_count - 1, c->err);
}

/* The statement's rectangle on a wall as S and z, ascending. */
static enum status place_on_wall(struct plan_context *c, const struct plan_wall *w, double s[2], double z[2])
{
    const struct script_place *p = &c->s->place;
    if (p->kind == PLACE_COORDINATES) {
        s[0] = fmin(p->a[0], p->a[2]);
        s[1] = fmax(p->a[0], p->a[2]);
        z[0] = fmin(p->a[1], p->a[3]);
        z[1] = fmax(p->a[1], p->a[3]);
        return ST_OK;
    }
    /* the camera sees one of the faces: from behind, a ray meets the in face from the wrong side */
    struct vec3 corners[2];
    const struct plan_line in = wall_face(w, SIDE_IN), out = wall_face(w, SIDE_OUT);
    struct err first = ERR_INIT;
    if (place_corners(corners, c->placer, p, vec3_make(in.n[0], in.n[1], 0), in.c, c->path, c->s->line, &first)) {
        struct err second = ERR_INIT;
        if (place_corners(corners, c->placer, p, vec3_make(out.n[0], out.n[1], 0), out.c, c->path, c->s->line, &second))
            return err_set(c->err, first.status, "%s", first.text);
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

/* Doors and passages drawn in a photograph begin at the floor, whichever pixel was clicked. */
static void set_foot_on_floor(const struct plan_context *c, const struct plan_wall *w, enum verb kind, double z[2])
{
    if (kind != VERB_WINDOW && c->s->place.kind == PLACE_VIEW) z[0] = w->foot;
}

static enum status apply_opening(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_opening o = {.line = s->line, .kind = s->verb, .interior = s->interior};
    if (find_wall(c, s->other, &o.wall)) return c->err->status;
    const struct plan_wall *w = &p->walls[o.wall];
    o.filled = s->verb == VERB_WINDOW ? !s->open : s->closed;
    if (place_on_wall(c, w, o.s, o.z)) return c->err->status;
    set_foot_on_floor(c, w, s->verb, o.z);
    if (copy_new_name(c, s->name, &o.name)) return c->err->status;
    o.leaf = s->verb == VERB_WINDOW ? p->glass : p->leaf;
    if (o.filled && o.leaf == 0) {
        free(o.name);
        return statement_error(c, "the thickness of %s is unknown without a scale; write \"set %s NUMBER\" before.",
                               s->verb == VERB_WINDOW ? "glass" : "a door's leaf",
                               s->verb == VERB_WINDOW ? "glass" : "leaf");
    }
    if (array_append(&p->openings, (size_t)p->opening_count, sizeof o, "openings", c->err)) {
        free(o.name);
        return c->err->status;
    }
    p->openings[p->opening_count++] = o;
    return add_name(p, o.name, NAMED_OPENING, p->opening_count - 1, c->err);
}

/* A box's footprint. at: height of the corners that a photograph shows. */
static enum status place_footprint(struct plan_context *c, double at, double low[3], double high[3])
{
    const struct script_place *p = &c->s->place;
    double a[4];
    memcpy(a, p->a, sizeof a);
    if (p->kind == PLACE_VIEW) {
        struct vec3 corners[2];
        struct err above = ERR_INIT; /* seen from above, or from below, as a beam is */
        if (place_corners(corners, c->placer, p, vec3_make(0, 0, 1), at, c->path, c->s->line, &above) &&
            place_corners(corners, c->placer, p, vec3_make(0, 0, -1), -at, c->path, c->s->line, c->err))
            return c->err->status;
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

static enum status apply_box(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_box b = {.line = s->line, .turn = s->has_option[OPTION_TURN] ? s->options[OPTION_TURN] : 0};
    b.low[2] = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : p->floor;
    b.high[2] = s->has_option[OPTION_TOP] ? s->options[OPTION_TOP] : p->ceiling;
    if (!s->has_option[OPTION_TOP] && p->ceiling == 0)
        return statement_error(c, "box %s has no top, because no ceiling was found; add \"top NUMBER\" to the line.",
                               s->name);
    const double at = s->has_option[OPTION_AT] ? s->options[OPTION_AT] : b.low[2];
    if (place_footprint(c, at, b.low, b.high) || copy_new_name(c, s->name, &b.name)) return c->err->status;
    if (array_append(&p->boxes, (size_t)p->box_count, sizeof b, "boxes", c->err)) {
        free(b.name);
        return c->err->status;
    }
    p->boxes[p->box_count++] = b;
    return add_name(p, b.name, NAMED_BOX, p->box_count - 1, c->err);
}

static enum status apply_room(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_room r = {.line = s->line, .wall_count = s->name_count};
    r.floor = s->has_option[OPTION_FLOOR] ? s->options[OPTION_FLOOR] : p->floor;
    r.ceiling = s->has_option[OPTION_CEILING] ? s->options[OPTION_CEILING] : p->ceiling;
    if (r.ceiling == 0) return statement_error(c, "no ceiling was found; add \"ceiling NUMBER\" to the line.");
    if (!(r.ceiling - r.floor >= MIN_SIZE))
        return statement_error(c, "room %s goes from %.9g up to %.9g, wanted a ceiling above the floor.", s->name,
                               r.floor, r.ceiling);
    r.slab = p->slab > 0 ? p->slab : p->thickness;
    if (r.slab == 0)
        return statement_error(c,
                               "the thickness of floors is unknown without a scale; write \"set slab NUMBER\" before.");
    r.lower = level_top(r.ceiling);
    r.walls = calloc((size_t)s->name_count, sizeof *r.walls);
    if (!r.walls) return err_nomem(c->err, "a room", (size_t)s->name_count * sizeof *r.walls);
    for (int i = 0; i < s->name_count && !c->err->status; i++) {
        find_wall(c, s->names[i], &r.walls[i]);
        for (int k = 0; k < i && !c->err->status; k++)
            if (r.walls[k] == r.walls[i]) statement_error(c, "room %s names wall %s twice.", s->name, s->names[i]);
    }
    if (c->err->status || copy_new_name(c, s->name, &r.name) ||
        array_append(&p->rooms, (size_t)p->room_count, sizeof r, "rooms", c->err)) {
        free(r.walls);
        free(r.name);
        return c->err->status;
    }
    p->rooms[p->room_count++] = r;
    return add_name(p, r.name, NAMED_ROOM, p->room_count - 1, c->err);
}

static enum status apply_slope(struct plan_context *c)
{
    const struct statement *s = c->s;
    enum name_kind kind;
    int at, walls[2];
    if (find_named(c, s->name, 1u << NAMED_ROOM, "a room", &kind, &at)) return c->err->status;
    struct plan_room *r = &c->plan->rooms[at];
    for (int i = 0; i < 2; i++) {
        if (find_wall(c, s->names[i], &walls[i])) return c->err->status;
        bool listed = false;
        for (int k = 0; k < r->wall_count; k++) listed |= r->walls[k] == walls[i];
        if (!listed) return statement_error(c, "wall %s does not belong to room %s.", s->names[i], s->name);
        if (!(s->values[i] - r->floor >= MIN_SIZE))
            return statement_error(c, "the ceiling of %s would be at %.9g at wall %s, not above the floor (%.9g).",
                                   s->name, s->values[i], s->names[i], r->floor);
    }
    const struct plan_wall *a = &c->plan->walls[walls[0]], *b = &c->plan->walls[walls[1]];
    if (walls[0] == walls[1] || !(fabs(a->d[0] * b->d[1] - a->d[1] * b->d[0]) < 1e-9))
        return statement_error(c, "a ceiling slopes between two parallel walls, but %s and %s are not parallel.",
                               s->names[0], s->names[1]);
    r->sloped = true;
    memcpy(r->slope_walls, walls, sizeof walls);
    memcpy(r->slope_heights, s->values, sizeof r->slope_heights);
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------- joins and extensions */

static double distance_from_end(const struct plan *plan, int wall, int end, const double p[2])
{
    double range[2];
    int face_wall, face_side;
    const struct plan_wall *w = &plan->walls[wall];
    cut_range(w, wall_cap(plan, wall, end, &face_wall, &face_side), range);
    return fabs(wall_s(w, p) - 0.5 * (range[0] + range[1]));
}

/* The end of a that forms the corner with b: one already joined to b, else the nearer free one. */
static enum status corner_end(struct plan_context *c, int a, int b, const double p[2], int *end)
{
    const struct plan *plan = c->plan;
    const struct plan_wall *w = &plan->walls[a];
    for (int e = 0; e < 2; e++)
        if (w->ends[e].kind != FREE_END && w->ends[e].other == b) {
            *end = e;
            return ST_OK;
        }
    const bool free0 = w->ends[0].kind == FREE_END, free1 = w->ends[1].kind == FREE_END;
    if (!free0 && !free1)
        return statement_error(c, "walls %s and %s cannot be joined: both ends of %s are joined already, to %s and %s.",
                               w->name, plan->walls[b].name, w->name, plan->walls[w->ends[0].other].name,
                               plan->walls[w->ends[1].other].name);
    *end = !free1 ? 0 : !free0 ? 1 : distance_from_end(plan, a, 0, p) <= distance_from_end(plan, a, 1, p) ? 0 : 1;
    return ST_OK;
}

static enum status check_crossing(struct plan_context *c, int a, int b, double p[2])
{
    const struct plan_wall *x = &c->plan->walls[a], *y = &c->plan->walls[b];
    if (a == b) return statement_error(c, "wall %s cannot be joined to itself.", x->name);
    if (fabs(x->d[0] * y->d[1] - x->d[1] * y->d[0]) > PARALLEL_SINE)
        return line_cross(wall_face(x, SIDE_IN), wall_face(y, SIDE_IN), p), ST_OK;
    return statement_error(c, "walls %s and %s cannot be joined: they are parallel, or nearly so.", x->name, y->name);
}

static enum status apply_join(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    for (int i = 0; i + 1 < s->name_count; i++) {
        int walls[2], ends[2];
        double p[2];
        if (find_wall(c, s->names[i], &walls[0]) || find_wall(c, s->names[i + 1], &walls[1]) ||
            check_crossing(c, walls[0], walls[1], p) || corner_end(c, walls[0], walls[1], p, &ends[0]) ||
            corner_end(c, walls[1], walls[0], p, &ends[1]))
            return c->err->status;
        for (int k = 0; k < 2; k++) plan->walls[walls[k]].ends[ends[k]] = (struct wall_end){CORNER_END, 0, walls[!k]};
    }
    return ST_OK;
}

static enum status apply_extend(struct plan_context *c)
{
    const struct statement *s = c->s;
    int wall, other;
    double p[2];
    if (find_wall(c, s->name, &wall)) return c->err->status;
    struct wall_end *e = &c->plan->walls[wall].ends[s->end];
    if (!s->other) {
        *e = (struct wall_end){FREE_END, s->values[0], -1};
        return ST_OK;
    }
    if (find_wall(c, s->other, &other) || check_crossing(c, wall, other, p)) return c->err->status;
    const struct wall_end *opposite = &c->plan->walls[wall].ends[!s->end];
    if (opposite->kind != FREE_END && opposite->other == other)
        return statement_error(c, "wall %s cannot be extended to %s: its other end is there already.", s->name,
                               s->other);
    *e = (struct wall_end){MEET_END, 0, other};
    return ST_OK;
}

/* Lists the new part of a split wall beside the old part in every room that has the wall. */
static enum status add_to_rooms(struct plan_context *c, int wall, int part)
{
    struct plan *plan = c->plan;
    for (int i = 0; i < plan->room_count; i++) {
        struct plan_room *r = &plan->rooms[i];
        int at = 0;
        while (at < r->wall_count && r->walls[at] != wall) at++;
        if (at == r->wall_count) continue;
        int *more = realloc(r->walls, ((size_t)r->wall_count + 1) * sizeof *more);
        if (!more) return err_nomem(c->err, "a room", ((size_t)r->wall_count + 1) * sizeof *more);
        r->walls = more;
        /* the part that the room's next wall joins comes second */
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

static enum status apply_split(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    int wall;
    double span[2];
    char *name = NULL;
    const double gap[2] = {fmin(s->values[0], s->values[1]), fmax(s->values[0], s->values[1])};
    if (find_wall(c, s->name, &wall)) return c->err->status;
    wall_span(plan, wall, span);
    if (!(gap[0] > span[0] + LENGTH_EPS && gap[1] < span[1] - LENGTH_EPS && gap[1] > gap[0] + LENGTH_EPS))
        return statement_error(c, "the gap from %.9g to %.9g does not lie in wall %s, which goes from %.9g to %.9g.",
                               gap[0], gap[1], s->name, span[0], span[1]);
    for (int i = 0; i < plan->opening_count; i++) {
        const struct plan_opening *o = &plan->openings[i];
        if (o->wall == wall && !o->removed && o->s[0] < gap[1] && o->s[1] > gap[0])
            return statement_error(c, "the gap from %.9g to %.9g cuts %s %s, from %.9g to %.9g; remove that first.",
                                   gap[0], gap[1], verb_name(o->kind), o->name, o->s[0], o->s[1]);
    }
    if (copy_new_name(c, s->other, &name)) return c->err->status;
    if (array_append(&plan->walls, (size_t)plan->wall_count, sizeof *plan->walls, "walls", c->err)) {
        free(name);
        return c->err->status;
    }
    const int new = plan->wall_count++;
    struct plan_wall *w = &plan->walls[wall], *part = &plan->walls[new];
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
    if (add_name(plan, part->name, NAMED_WALL, new, c->err)) return c->err->status;
    return add_to_rooms(c, wall, new);
}

/* ------------------------------------------------------------------------------------------------------------ edits */

static enum status apply_adjust(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    enum name_kind kind;
    int at;
    if (find_solid(c, s->name, &kind, &at)) return c->err->status;
    if (kind == NAMED_OPENING) {
        struct plan_opening *o = &plan->openings[at];
        if (place_on_wall(c, &plan->walls[o->wall], o->s, o->z)) return c->err->status;
        set_foot_on_floor(c, &plan->walls[o->wall], o->kind, o->z);
        return ST_OK;
    }
    if (kind == NAMED_BOX) {
        struct plan_box *b = &plan->boxes[at];
        return place_footprint(c, b->low[2], b->low, b->high);
    }
    struct plan_wall *w = &plan->walls[at];
    const struct plan_line in = wall_face(w, SIDE_IN);
    if (s->place.kind == PLACE_COORDINATES) {
        /* a line through two points, parallel to the wall */
        const double *a = s->place.a;
        const double c0 = in.n[0] * a[0] + in.n[1] * a[1], c1 = in.n[0] * a[2] + in.n[1] * a[3];
        if (!(fabs(c0 - c1) <= LENGTH_EPS))
            return statement_error(c,
                                   "the line from %.9g %.9g to %.9g %.9g is not parallel to wall %s; adjust keeps the "
                                   "direction of a wall.",
                                   a[0], a[1], a[2], a[3], s->name);
        w->c = c0;
        return ST_OK;
    }
    struct placed_wall placed;
    if (place_wall(&placed, c->placer, &s->place, in.n, false, c->path, s->line, c->err)) return c->err->status;
    log_note("wall %s: moved by %.3g; %zu points, median distance from the wall %.3g", s->name, placed.c - w->c,
             placed.points, placed.spread);
    w->c = placed.c;
    return ST_OK;
}

static enum status apply_move(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    enum name_kind kind;
    int at;
    if (find_solid(c, s->name, &kind, &at)) return c->err->status;
    if (kind == NAMED_BOX) {
        if (s->value_count != 2)
            return statement_error(c, "a box moves by two distances, in x and y: \"move %s by DX DY\".", s->name);
        for (int k = 0; k < 2; k++) {
            plan->boxes[at].low[k] += s->values[k];
            plan->boxes[at].high[k] += s->values[k];
        }
        return ST_OK;
    }
    if (s->value_count != 1)
        return statement_error(c,
                               kind == NAMED_WALL
                                   ? "a wall moves along its normal, away from its inside, by one distance: "
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

static enum status apply_fill(struct plan_context *c, bool fill)
{
    const struct statement *s = c->s;
    enum name_kind kind;
    int at;
    if (find_named(c, s->name, 1u << NAMED_OPENING, "a door or a window", &kind, &at)) return c->err->status;
    struct plan_opening *o = &c->plan->openings[at];
    if (o->kind == VERB_PASSAGE)
        return statement_error(c, "passage %s has no leaf that could be %s; declare a door instead.", s->name,
                               fill ? "closed" : "opened");
    if (o->filled == fill)
        return statement_error(c, "%s %s is %s already.", verb_name(o->kind), s->name, fill ? "closed" : "open");
    const double leaf = o->kind == VERB_WINDOW ? c->plan->glass : c->plan->leaf;
    if (fill && leaf == 0)
        return statement_error(c, "the thickness of %s is unknown without a scale; write \"set %s NUMBER\" before.",
                               o->kind == VERB_WINDOW ? "glass" : "a door's leaf",
                               o->kind == VERB_WINDOW ? "glass" : "leaf");
    o->filled = fill;
    if (fill) o->leaf = leaf;
    return ST_OK;
}

static enum status apply_remove(struct plan_context *c)
{
    struct plan *plan = c->plan;
    enum name_kind kind;
    int at;
    if (find_named(c, c->s->name, ~0u, "anything", &kind, &at)) return c->err->status;
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

static enum status apply_statement(struct plan_context *c)
{
    switch (c->s->verb) {
    case VERB_SET:
        return apply_set(c);
    case VERB_WALL:
        return apply_wall(c);
    case VERB_ROOM:
        return apply_room(c);
    case VERB_SLOPE:
        return apply_slope(c);
    case VERB_DOOR:
    case VERB_PASSAGE:
    case VERB_WINDOW:
        return apply_opening(c);
    case VERB_BOX:
        return apply_box(c);
    case VERB_JOIN:
        return apply_join(c);
    case VERB_EXTEND:
        return apply_extend(c);
    case VERB_SPLIT:
        return apply_split(c);
    case VERB_ADJUST:
        return apply_adjust(c);
    case VERB_MOVE:
        return apply_move(c);
    case VERB_OPEN:
        return apply_fill(c, false);
    case VERB_CLOSE:
        return apply_fill(c, true);
    default:
        return apply_remove(c);
    }
}

enum status plan_apply(struct plan *plan, const struct script *script, bool edit, const struct placer *placer,
                       struct err *err)
{
    struct plan_context c = {plan, script->path, NULL, placer, err};
    for (int i = 0; i < script->count; i++) {
        c.s = &script->statements[i];
        const struct statement *s = c.s;
        if (s->place.kind == PLACE_VIEW && !placer)
            return statement_error(&c, "the statement names the view %s, but no views are known; give --views.",
                                   s->place.view);
        if (apply_statement(&c)) return err->status;
        if (edit && plan_check(plan, script->path, s->line, err)) return err->status;
    }
    return edit ? ST_OK : plan_check(plan, script->path, 0, err);
}
