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
    for (int i = 0; i < plan->slot_count; i++) free(plan->slots[i].name);
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
    free(plan->slots);
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

enum status check_length(struct plan_context *c, const char *what, double value)
{
    if (value >= MIN_SIZE && value <= MAX_SIZE) return ST_OK;
    return statement_error(c, "found %s %.9g, wanted %g to %g.", what, value, MIN_SIZE, MAX_SIZE);
}

double *default_value(struct plan *plan, enum plan_default which, const char **name)
{
    static const char *const names[DEFAULTS] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling"};
    double *const values[DEFAULTS] = {&plan->thickness, &plan->slab,  &plan->glass,
                                      &plan->leaf,      &plan->floor, &plan->ceiling};
    if (name) *name = names[which];
    return values[which];
}

/* The default value, which the statement uses. */
static double use(struct plan_context *c, enum plan_default which)
{
    c->used |= 1u << which;
    return *default_value(c->plan, which, NULL);
}

/* The option's value, or the default's. */
static double option_or(struct plan_context *c, enum option option, enum plan_default which)
{
    return c->s->has_option[option] ? c->s->options[option] : use(c, which);
}

static enum status apply_set(struct plan_context *c)
{
    const struct statement *s = c->s;
    for (int i = 0; i < DEFAULTS; i++) {
        const char *name;
        double *value = default_value(c->plan, (enum plan_default)i, &name);
        if (strcmp(name, s->name)) continue;
        if (i < DEFAULT_FLOOR && check_length(c, s->name, s->values[0])) return c->err->status;
        if (fabs(s->values[0]) > MAX_SIZE)
            return statement_error(c, "found %s %.9g, wanted at most %g.", s->name, s->values[0], MAX_SIZE);
        *value = s->values[0];
    }
    return ST_OK;
}

enum status fill_thickness(struct plan_context *c, enum filling fill, double *thickness)
{
    *thickness = 0;
    if (fill != FILL_LEAF && fill != FILL_GLASS) return ST_OK;
    *thickness = use(c, fill == FILL_GLASS ? DEFAULT_GLASS : DEFAULT_LEAF);
    if (*thickness > 0) return ST_OK;
    return statement_error(c, "the thickness of %s is unknown without a scale; write \"set %s NUMBER\" before.",
                           fill == FILL_GLASS ? "glass" : "a door's leaf", fill == FILL_GLASS ? "glass" : "leaf");
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

/* A wall parallel to another one, in front of it by the statement's distance, facing the same way, which meets the walls
 * at its two ends. */
static enum status place_parallel_wall(struct plan_context *c, struct plan_wall *w)
{
    const struct script_place *place = &c->s->place;
    int other, ends[2];
    double p[2][2];
    if (find_wall(c, place->wall, &other)) return c->err->status;
    const struct plan_wall *o = &c->plan->walls[other];
    memcpy(w->d, o->d, sizeof w->d);
    w->c = o->c + place->a[0];
    w->sign = o->sign;
    w->origin = o->origin;
    w->angled = o->angled;
    for (int i = 0; i < 2; i++) {
        if (find_wall(c, place->between[i], &ends[i])) return c->err->status;
        const struct plan_wall *e = &c->plan->walls[ends[i]];
        if (!(fabs(w->d[0] * e->d[1] - w->d[1] * e->d[0]) > PARALLEL_SINE) ||
            !line_cross(wall_face(w, SIDE_IN), wall_face(e, SIDE_IN), p[i]))
            return statement_error(c, "wall %s cannot end at wall %s: it is parallel to that, or nearly so.",
                                   c->s->name, place->between[i]);
    }
    if (ends[0] == ends[1])
        return statement_error(c, "wall %s lies between wall %s and itself; name a wall for each of its ends.",
                               c->s->name, place->between[0]);
    const double along = w->d[0] * (p[1][0] - p[0][0]) + w->d[1] * (p[1][1] - p[0][1]);
    w->ends[END_START] = (struct wall_end){MEET_END, 0, ends[along < 0]};
    w->ends[END_END] = (struct wall_end){MEET_END, 0, ends[along >= 0]};
    return ST_OK;
}

static enum status place_new_wall(struct plan_context *c, struct plan_wall *w)
{
    const struct statement *s = c->s;
    if (s->place.kind == PLACE_PARALLEL) return place_parallel_wall(c, w);
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
    w.thickness = option_or(c, OPTION_THICKNESS, DEFAULT_THICKNESS);
    w.foot = option_or(c, OPTION_FOOT, DEFAULT_FLOOR);
    w.top = option_or(c, OPTION_TOP, DEFAULT_CEILING);
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

/* Measured from an end of the wall, where its neighbour's near face is; left and right as seen from its inside. */
static enum status place_from_end(struct plan_context *c, int wall, double s[2], double z[2])
{
    const struct plan_wall *w = &c->plan->walls[wall];
    const double *a = c->s->place.a;
    double span[2];
    if (!(a[1] >= MIN_SIZE)) return statement_error(c, "found the width %.9g, wanted %g or more.", a[1], MIN_SIZE);
    wall_span(c->plan, wall, span);
    /* the start is at the left */
    const bool from_high = c->s->place.right == (w->sign > 0);
    s[0] = from_high ? span[1] - a[0] - a[1] : span[0] + a[0];
    s[1] = from_high ? span[1] - a[0] : span[0] + a[0] + a[1];
    z[0] = fmin(a[2], a[3]);
    z[1] = fmax(a[2], a[3]);
    return ST_OK;
}

enum status place_on_wall(struct plan_context *c, int wall, double s[2], double z[2])
{
    const struct script_place *p = &c->s->place;
    const struct plan_wall *w = &c->plan->walls[wall];
    if (p->kind == PLACE_FROM_END) return place_from_end(c, wall, s, z);
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

void set_foot_on_floor(const struct plan_context *c, const struct plan_wall *w, enum verb kind, double z[2])
{
    if (kind != VERB_WINDOW && c->s->place.kind == PLACE_VIEW) z[0] = w->foot;
}

static enum status apply_opening(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_opening o = {.line = s->line, .kind = s->verb, .interior = s->interior};
    if (find_wall(c, s->other, &o.wall)) return c->err->status;
    if (s->verb == VERB_WINDOW && !s->open) o.fill = FILL_GLASS;
    if (s->verb == VERB_DOOR && s->closed) o.fill = FILL_LEAF;
    if (place_on_wall(c, o.wall, o.s, o.z)) return c->err->status;
    set_foot_on_floor(c, &p->walls[o.wall], s->verb, o.z);
    if (fill_thickness(c, o.fill, &o.leaf) || copy_new_name(c, s->name, &o.name)) return c->err->status;
    if (array_append(&p->openings, (size_t)p->opening_count, sizeof o, "openings", c->err)) {
        free(o.name);
        return c->err->status;
    }
    p->openings[p->opening_count++] = o;
    return add_name(p, o.name, NAMED_OPENING, p->opening_count - 1, c->err);
}

/* A footprint in the plane z = a[0] + a[1] x + a[2] y, where a photograph shows it. */
static enum status place_in_plane(struct plan_context *c, const double plane[3], double low[2], double high[2])
{
    const struct script_place *p = &c->s->place;
    double a[4];
    if (p->kind == PLACE_FROM_END)
        return statement_error(c, "%s is in no wall; give its place by coordinates or in a view.", c->s->name);
    memcpy(a, p->a, sizeof a);
    if (p->kind == PLACE_VIEW) {
        struct vec3 corners[2];
        struct err above = ERR_INIT; /* seen from above, or from below, as a beam is */
        const double length = sqrt(1 + plane[1] * plane[1] + plane[2] * plane[2]);
        const struct vec3 up = vec3_scale(vec3_make(-plane[1], -plane[2], 1), 1 / length);
        const double d = plane[0] / length;
        if (place_corners(corners, c->placer, p, up, d, c->path, c->s->line, &above) &&
            place_corners(corners, c->placer, p, vec3_scale(up, -1), -d, c->path, c->s->line, c->err))
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

enum status place_footprint(struct plan_context *c, double at, double low[2], double high[2])
{
    return place_in_plane(c, (const double[3]){at, 0, 0}, low, high);
}

enum status place_in_room(struct plan_context *c, const struct plan_room *r, enum verb kind, double low[2],
                          double high[2])
{
    if (kind == VERB_HATCH) return place_footprint(c, r->floor, low, high);
    /* of a gable's planes, the one in which the footprint's middle is on the ceiling */
    enum status st = ST_OK;
    for (int i = 0; i < r->lower.count && !st; i++) {
        st = place_in_plane(c, r->lower.a[i], low, high);
        const double middle[2] = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
        const struct plan_top one = {{{r->lower.a[i][0], r->lower.a[i][1], r->lower.a[i][2]}}, 1};
        if (!st && top_at(&one, middle) <= top_at(&r->lower, middle) + LENGTH_EPS) break;
    }
    return st;
}

static enum status apply_slot(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_slot slot = {.line = s->line, .kind = s->verb};
    if (find_room(c, s->other, &slot.room)) return c->err->status;
    if (s->verb == VERB_SKYLIGHT && !s->open) slot.fill = FILL_GLASS;
    if (s->verb == VERB_HATCH && s->closed) slot.fill = FILL_LEAF;
    if (place_in_room(c, &p->rooms[slot.room], s->verb, slot.low, slot.high) ||
        fill_thickness(c, slot.fill, &slot.leaf) || copy_new_name(c, s->name, &slot.name))
        return c->err->status;
    if (array_append(&p->slots, (size_t)p->slot_count, sizeof slot, "openings in rooms", c->err)) {
        free(slot.name);
        return c->err->status;
    }
    p->slots[p->slot_count++] = slot;
    return add_name(p, slot.name, NAMED_SLOT, p->slot_count - 1, c->err);
}

static enum status apply_box(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_box b = {.line = s->line, .turn = s->has_option[OPTION_TURN] ? s->options[OPTION_TURN] : 0};
    b.low[2] = option_or(c, OPTION_FOOT, DEFAULT_FLOOR);
    b.high[2] = option_or(c, OPTION_TOP, DEFAULT_CEILING);
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
    r.floor = option_or(c, OPTION_FLOOR, DEFAULT_FLOOR);
    r.ceiling = option_or(c, OPTION_CEILING, DEFAULT_CEILING);
    if (r.ceiling == 0) return statement_error(c, "no ceiling was found; add \"ceiling NUMBER\" to the line.");
    if (!(r.ceiling - r.floor >= MIN_SIZE))
        return statement_error(c, "room %s goes from %.9g up to %.9g, wanted a ceiling above the floor.", s->name,
                               r.floor, r.ceiling);
    r.slab = use(c, p->slab > 0 ? DEFAULT_SLAB : DEFAULT_THICKNESS);
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

/* Slopes a ceiling in one plane, or in two that meet in a ridge. */
static enum status apply_slope(struct plan_context *c)
{
    const struct statement *s = c->s;
    int at, walls[2];
    if (find_room(c, s->name, &at)) return c->err->status;
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
    if (s->verb == VERB_GABLE && !(s->values[2] - fmax(s->values[0], s->values[1]) >= MIN_SIZE))
        return statement_error(c, "the ridge of %s would be at %.9g, wanted it above the ceiling at both walls.",
                               s->name, s->values[2]);
    if (s->has_option[OPTION_AT] && !(s->options[OPTION_AT] >= MIN_SIZE))
        return statement_error(c, "the ridge of %s would be %.9g from wall %s, wanted %g or more.", s->name,
                               s->options[OPTION_AT], s->names[0], MIN_SIZE);
    r->shape = s->verb == VERB_GABLE ? GABLE_CEILING : SLOPED_CEILING;
    memcpy(r->slope_walls, walls, sizeof walls);
    memcpy(r->slope_heights, s->values, sizeof r->slope_heights);
    r->ridge_at = s->has_option[OPTION_AT] ? s->options[OPTION_AT] : 0;
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
    case VERB_GABLE:
        return apply_slope(c);
    case VERB_DOOR:
    case VERB_PASSAGE:
    case VERB_WINDOW:
        return apply_opening(c);
    case VERB_SKYLIGHT:
    case VERB_HATCH:
        return apply_slot(c);
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
    case VERB_CHANGE:
        return apply_change(c);
    case VERB_RESIZE:
        return apply_resize(c);
    case VERB_OPEN:
    case VERB_CLOSE:
    case VERB_FILL:
        return apply_fill(c);
    default:
        return apply_remove(c);
    }
}

static enum status needs_views(struct plan_context *c)
{
    if (c->s->place.kind != PLACE_VIEW || c->placer) return ST_OK;
    return statement_error(c, "the statement names the view %s, but no views are known; give --views.",
                           c->s->place.view);
}

/* An edit's statement that changes nothing is a mistake. A default that is set must be used further down. */
struct edit_watch {
    char *before;
    int set_line[DEFAULTS]; /* of a default that no statement used yet; 0: none */
};

static enum status unused_default(struct plan_context *c, enum plan_default which, int line)
{
    const char *name;
    default_value(c->plan, which, &name);
    return err_set(c->err, ST_DATA,
                   "%s:%d: \"set %s\" changes nothing: no statement further down uses it, and it does not change what "
                   "there is%s.",
                   c->path, line, name,
                   which == DEFAULT_CEILING     ? "; to change a ceiling, write \"change ROOM ceiling Z\""
                   : which == DEFAULT_THICKNESS ? "; to change a wall, write \"change WALL thickness T\""
                                                : "");
}

static enum status watch_set(struct plan_context *c, struct edit_watch *w)
{
    for (int i = 0; i < DEFAULTS; i++) {
        const char *name;
        const double *value = default_value(c->plan, (enum plan_default)i, &name);
        if (strcmp(name, c->s->name)) continue;
        if (w->set_line[i]) return unused_default(c, (enum plan_default)i, w->set_line[i]);
        if (*value == c->s->values[0])
            return statement_error(c, "the statement changes nothing: %s is %.9g already.", name, *value);
        w->set_line[i] = c->s->line;
    }
    return ST_OK;
}

static enum status apply_watched(struct plan_context *c, struct edit_watch *w)
{
    char *after = NULL;
    if (c->s->verb == VERB_SET) return watch_set(c, w) ? c->err->status : apply_set(c);
    c->used = 0;
    if (apply_statement(c) || plan_check(c->plan, c->path, c->s->line, c->err) || plan_state(&after, c->plan, c->err))
        return c->err->status;
    for (int i = 0; i < DEFAULTS; i++)
        if (c->used & 1u << i) w->set_line[i] = 0;
    const bool same = !strcmp(w->before, after);
    free(w->before);
    w->before = after;
    return same ? statement_error(c, "the statement changes nothing: the plan is like that already.") : ST_OK;
}

static enum status apply_edit(struct plan_context *c, const struct script *script)
{
    struct edit_watch w = {0};
    enum status st = plan_state(&w.before, c->plan, c->err);
    for (int i = 0; i < script->count && !st; i++) {
        c->s = &script->statements[i];
        st = needs_views(c);
        if (!st) st = apply_watched(c, &w);
    }
    for (int i = 0; i < DEFAULTS && !st; i++)
        if (w.set_line[i]) st = unused_default(c, (enum plan_default)i, w.set_line[i]);
    free(w.before);
    return st;
}

enum status plan_apply(struct plan *plan, const struct script *script, bool edit, const struct placer *placer,
                       struct err *err)
{
    struct plan_context c = {.plan = plan, .path = script->path, .placer = placer, .err = err};
    if (edit) return apply_edit(&c, script);
    for (int i = 0; i < script->count; i++) {
        c.s = &script->statements[i];
        if (needs_views(&c) || apply_statement(&c)) return err->status;
    }
    return plan_check(plan, script->path, 0, err);
}
