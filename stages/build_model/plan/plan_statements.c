/* plan_statements.c - statements that make walls and rooms, and the defaults that set gives them.
 *
 * A wall is a line with a direction, from left to right for a viewer inside the room; its in face is on the line.
 * Three ways to place it: two points, a rectangle on a photograph (place.c), or parallel to another wall at a
 * distance between two walls. Walls run along an axis unless they are `angled`, because most do, and because a slip
 * of the hand in a coordinate would otherwise tilt a wall by a little.
 *
 * S, the coordinate along a wall, is x or y of the model for a wall along an axis, whichever way it runs, and the
 * distance from its first point for an angled one.
 *
 * Defaults are those of the last `set` before the statement. Which of them a statement used is noted (plan_context),
 * so that a `set` that nothing uses can be refused. Without a scale lengths of homes mean nothing, so thickness and
 * ceiling are unknown until they are set, and the error says so. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

enum status plan_check_length(struct plan_context *c, const char *what, double value)
{
    if (value >= MIN_SIZE && value <= MAX_SIZE) return ST_OK;
    return plan_statement_error(c, "found %s %.9g, wanted %g to %g.", what, value, MIN_SIZE, MAX_SIZE);
}

double *plan_default_value(struct plan *plan, enum plan_default which, const char **name)
{
    static const char *const names[DEFAULTS] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling"};
    double *const values[DEFAULTS] = {&plan->thickness, &plan->slab,  &plan->glass,
                                      &plan->leaf,      &plan->floor, &plan->ceiling};
    if (name) *name = names[which];
    return values[which];
}

double plan_use_default(struct plan_context *c, enum plan_default which)
{
    c->used |= 1u << which;
    return *plan_default_value(c->plan, which, NULL);
}

double plan_option_or_default(struct plan_context *c, enum option option, enum plan_default which)
{
    return c->s->has_option[option] ? c->s->options[option] : plan_use_default(c, which);
}

enum status plan_read_set(struct script_reader *r, struct statement *s)
{
    static const char *const QUANTITIES[] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling", "colour", NULL};
    char *word;
    int i = 0;
    if (textfile_word(&r->t, "a quantity", &word, r->err)) return r->err->status;
    while (QUANTITIES[i] && strcmp(QUANTITIES[i], word)) i++;
    if (!QUANTITIES[i]) return script_usage_error(r, word);
    s->name = QUANTITIES[i];
    if (!strcmp(s->name, "colour")) return script_read_colour(r, s);
    s->value_count = 1;
    return script_read_number(r, s->name, &s->values[0]);
}

enum status plan_apply_set(struct plan_context *c)
{
    const struct statement *s = c->s;
    if (!strcmp(s->name, "colour")) {
        if (!c->edit) return plan_statement_for_edits(c, "set colour");
        memcpy(c->plan->colour, s->values, sizeof c->plan->colour);
    }
    for (int i = 0; i < DEFAULTS; i++) {
        const char *name;
        double *value = plan_default_value(c->plan, (enum plan_default)i, &name);
        if (strcmp(name, s->name)) continue;
        if (i < DEFAULT_FLOOR && plan_check_length(c, s->name, s->values[0])) return c->err->status;
        if (fabs(s->values[0]) > MAX_SIZE)
            return plan_statement_error(c, "found %s %.9g, wanted at most %g.", s->name, s->values[0], MAX_SIZE);
        *value = s->values[0];
        c->set |= 1u << i;
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ walls */

static enum status set_wall_line(struct plan_context *c, struct plan_wall *w, const double a[2], const double b[2])
{
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > LENGTH_EPS)) return plan_statement_error(c, "wall %s would have no length.", c->s->name);
    w->d[0] = (b[0] - a[0]) / length;
    w->d[1] = (b[1] - a[1]) / length;
    if (!w->angled) {
        const int axis = fabs(w->d[1]) > fabs(w->d[0]);
        if (fabs(w->d[!axis]) * length > LENGTH_EPS)
            return plan_statement_error(
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
    w->ends[END_START] = (struct wall_end){FREE_END, plan_wall_s(w, a), -1};
    w->ends[END_END] = (struct wall_end){FREE_END, plan_wall_s(w, b), -1};
    return ST_OK;
}

/* A wall parallel to another one, in front of it by the statement's distance, facing the same way, which meets the
 * walls at its two ends. */
static enum status place_parallel_wall(struct plan_context *c, struct plan_wall *w)
{
    const struct script_place *place = &c->s->place;
    int other, ends[2];
    double p[2][2];
    if (plan_find_wall(c, place->wall, &other)) return c->err->status;
    const struct plan_wall *o = &c->plan->walls[other];
    memcpy(w->d, o->d, sizeof w->d);
    w->c = o->c + place->a[0];
    w->sign = o->sign;
    w->origin = o->origin;
    w->angled = o->angled;
    for (int i = 0; i < 2; i++) {
        if (plan_find_wall(c, place->between[i], &ends[i])) return c->err->status;
        const struct plan_wall *e = &c->plan->walls[ends[i]];
        if (!(fabs(w->d[0] * e->d[1] - w->d[1] * e->d[0]) > PARALLEL_SINE) ||
            !plan_line_cross(plan_wall_face(w, SIDE_IN), plan_wall_face(e, SIDE_IN), p[i]))
            return plan_statement_error(c, "wall %s cannot end at wall %s: it is parallel to that, or nearly so.",
                                        c->s->name, place->between[i]);
    }
    if (ends[0] == ends[1])
        return plan_statement_error(c, "wall %s lies between wall %s and itself; name a wall for each of its ends.",
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

enum status plan_read_wall(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name) || script_read_place(r, &s->place, 1u << PLACE_PARALLEL))
        return r->err->status;
    s->by_points = s->place.kind == PLACE_VIEW;
    return ST_OK;
}

enum status plan_apply_wall(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_wall w = {.line = s->line, .angled = s->has_option[OPTION_ANGLED]};
    if (plan_copy_new_name(c, s->name, &w.name)) return c->err->status;
    w.thickness = plan_option_or_default(c, OPTION_THICKNESS, DEFAULT_THICKNESS);
    w.foot = plan_option_or_default(c, OPTION_FOOT, DEFAULT_FLOOR);
    w.top = plan_option_or_default(c, OPTION_TOP, DEFAULT_CEILING);
    w.has_top = s->has_option[OPTION_TOP];
    if (!s->has_option[OPTION_THICKNESS] && w.thickness == 0)
        plan_statement_error(
            c, "the thickness of walls is unknown without a scale; write \"set thickness NUMBER\" before.");
    else if (!w.has_top && w.top == 0)
        plan_statement_error(c, "no ceiling was found; write \"set ceiling NUMBER\" before.");
    else
        plan_check_length(c, "thickness", w.thickness);
    if (!c->err->status && !(w.top - w.foot >= MIN_SIZE))
        plan_statement_error(c, "wall %s goes from %.9g up to %.9g, wanted a top above its foot.", s->name, w.foot,
                             w.top);
    if (!c->err->status && !place_new_wall(c, &w))
        array_append(&p->walls, (size_t)p->wall_count, sizeof w, "walls", c->err);
    if (c->err->status) {
        free(w.name);
        return c->err->status;
    }
    p->walls[p->wall_count++] = w;
    return plan_add_name(p, w.name, NAMED_WALL, p->wall_count - 1, c->err);
}

/* ------------------------------------------------------------------------------------------------------------ rooms */

enum status plan_read_room(struct script_reader *r, struct statement *s)
{
    return script_read_name(r, "a name", &s->name) || script_read_list(r, s, 3) ? r->err->status : ST_OK;
}

enum status plan_apply_room(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_room r = {.line = s->line, .wall_count = s->name_count};
    r.floor = plan_option_or_default(c, OPTION_FLOOR, DEFAULT_FLOOR);
    r.ceiling = plan_option_or_default(c, OPTION_CEILING, DEFAULT_CEILING);
    if (r.ceiling == 0) return plan_statement_error(c, "no ceiling was found; add \"ceiling NUMBER\" to the line.");
    if (!(r.ceiling - r.floor >= MIN_SIZE))
        return plan_statement_error(c, "room %s goes from %.9g up to %.9g, wanted a ceiling above the floor.", s->name,
                                    r.floor, r.ceiling);
    r.slab = plan_use_default(c, p->slab > 0 ? DEFAULT_SLAB : DEFAULT_THICKNESS);
    if (r.slab == 0)
        return plan_statement_error(
            c, "the thickness of floors is unknown without a scale; write \"set slab NUMBER\" before.");
    r.lower = plan_level_top(r.ceiling);
    r.walls = calloc((size_t)s->name_count, sizeof *r.walls);
    if (!r.walls) return err_nomem(c->err, "a room", (size_t)s->name_count * sizeof *r.walls);
    for (int i = 0; i < s->name_count && !c->err->status; i++) {
        plan_find_wall(c, s->names[i], &r.walls[i]);
        for (int k = 0; k < i && !c->err->status; k++)
            if (r.walls[k] == r.walls[i]) plan_statement_error(c, "room %s names wall %s twice.", s->name, s->names[i]);
    }
    if (c->err->status || plan_copy_new_name(c, s->name, &r.name) ||
        array_append(&p->rooms, (size_t)p->room_count, sizeof r, "rooms", c->err)) {
        free(r.walls);
        free(r.name);
        return c->err->status;
    }
    p->rooms[p->room_count++] = r;
    return plan_add_name(p, r.name, NAMED_ROOM, p->room_count - 1, c->err);
}

enum status plan_read_slope(struct script_reader *r, struct statement *s)
{
    s->names = calloc(2, sizeof *s->names);
    if (!s->names) return err_nomem(r->err, "names of walls", 2 * sizeof *s->names);
    s->name_count = 2;
    if (script_read_name(r, "a room", &s->name) || script_expect(r, "from") ||
        script_read_name(r, "a wall", &s->names[0]) || script_read_number(r, "the height there", &s->values[0]) ||
        script_expect(r, "to") || script_read_name(r, "a wall", &s->names[1]) ||
        script_read_number(r, "the height there", &s->values[1]))
        return r->err->status;
    return ST_OK;
}

enum status plan_read_gable(struct script_reader *r, struct statement *s)
{
    return plan_read_slope(r, s) || script_expect(r, "ridge") ||
                   script_read_number(r, "the ridge's height", &s->values[2])
               ? r->err->status
               : ST_OK;
}

/* Slopes a ceiling in one plane, or in two that meet in a ridge. */
static enum status slope_ceiling(struct plan_context *c, bool gable)
{
    const struct statement *s = c->s;
    int at, walls[2];
    if (plan_find_room(c, s->name, &at)) return c->err->status;
    struct plan_room *r = &c->plan->rooms[at];
    for (int i = 0; i < 2; i++) {
        if (plan_find_wall(c, s->names[i], &walls[i])) return c->err->status;
        bool listed = false;
        for (int k = 0; k < r->wall_count; k++) listed |= r->walls[k] == walls[i];
        if (!listed) return plan_statement_error(c, "wall %s does not belong to room %s.", s->names[i], s->name);
        if (!(s->values[i] - r->floor >= MIN_SIZE))
            return plan_statement_error(c, "the ceiling of %s would be at %.9g at wall %s, not above the floor (%.9g).",
                                        s->name, s->values[i], s->names[i], r->floor);
    }
    const struct plan_wall *a = &c->plan->walls[walls[0]], *b = &c->plan->walls[walls[1]];
    if (walls[0] == walls[1] || !(fabs(a->d[0] * b->d[1] - a->d[1] * b->d[0]) < 1e-9))
        return plan_statement_error(c, "a ceiling slopes between two parallel walls, but %s and %s are not parallel.",
                                    s->names[0], s->names[1]);
    if (gable && !(s->values[2] - fmax(s->values[0], s->values[1]) >= MIN_SIZE))
        return plan_statement_error(c, "the ridge of %s would be at %.9g, wanted it above the ceiling at both walls.",
                                    s->name, s->values[2]);
    if (s->has_option[OPTION_AT] && !(s->options[OPTION_AT] >= MIN_SIZE))
        return plan_statement_error(c, "the ridge of %s would be %.9g from wall %s, wanted %g or more.", s->name,
                                    s->options[OPTION_AT], s->names[0], MIN_SIZE);
    r->shape = gable ? GABLE_CEILING : SLOPED_CEILING;
    memcpy(r->slope_walls, walls, sizeof walls);
    memcpy(r->slope_heights, s->values, sizeof r->slope_heights);
    r->ridge_at = s->has_option[OPTION_AT] ? s->options[OPTION_AT] : 0;
    return ST_OK;
}

enum status plan_apply_slope(struct plan_context *c) { return slope_ceiling(c, false); }

enum status plan_apply_gable(struct plan_context *c) { return slope_ceiling(c, true); }
