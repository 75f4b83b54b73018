/* plan_edits.c - statements that change what is there: its place, size, heights and filling.
 *
 * A statement finds its item by name and changes its numbers, no more: ends of walls are kept as the walls that they
 * are joined to (plan.h), so neighbours follow a moved wall without being told, and openings, which are intervals
 * along their wall, move with it. What depends on the whole plan is checked after the statement (plan_checks.c), so
 * that an error names the statement that broke the building.
 *
 * adjust places a thing anew, by coordinates or in a photograph; a wall keeps its direction. move shifts it: a wall
 * along its normal, an opening along its wall and up, what lies in plan by x and y. change sets heights and
 * thicknesses, resize moves the sides of an opening outwards, fill, open and close set what is in it, remove hides
 * it: a removed wall keeps its line, where rooms and neighbours still end.
 *
 * Thickness. A side of a room has one thickness, so a change goes on to the walls that continue it on its line
 * around a room, and from those to theirs. */
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

enum status plan_read_adjust(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name) ||
        script_read_place(r, &s->place, 1u << PLACE_FROM_END | 1u << PLACE_FOOT | 1u << PLACE_TOP))
        return r->err->status;
    s->by_points = s->place.kind == PLACE_VIEW;
    return ST_OK;
}

enum status plan_apply_adjust(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    enum name_kind kind;
    int at;
    if (plan_find_solid(c, s->name, &kind, &at)) return c->err->status;
    const bool by_line = s->place.kind == PLACE_FOOT || s->place.kind == PLACE_TOP;
    if (by_line && kind != NAMED_WALL)
        return plan_statement_error(
            c, "%s is not a wall, which alone is placed by its line at the floor or the ceiling.", s->name);
    if (kind == NAMED_OPENING) {
        struct plan_opening *o = &plan->openings[at];
        if (plan_place_on_wall(c, o->wall, o->s, o->z)) return c->err->status;
        plan_set_foot_on_floor(c, &plan->walls[o->wall], o->kind, o->z);
        return ST_OK;
    }
    if (kind == NAMED_SLOT) {
        struct plan_slot *slot = &plan->slots[at];
        return plan_place_in_room(c, &plan->rooms[slot->room], slot->kind, slot->low, slot->high);
    }
    if (kind == NAMED_BOX) {
        struct plan_box *b = &plan->boxes[at];
        return plan_place_footprint(c, b->low[2], b->low, b->high);
    }
    if (s->place.kind == PLACE_FROM_END)
        return plan_statement_error(c, "%s is a wall; place it by coordinates or in a view.", s->name);
    struct plan_wall *w = &plan->walls[at];
    const struct plan_line in = plan_wall_face(w, SIDE_IN);
    if (s->place.kind == PLACE_COORDINATES) {
        /* a line through two points, parallel to the wall */
        const double *a = s->place.a;
        const double c0 = in.n[0] * a[0] + in.n[1] * a[1], c1 = in.n[0] * a[2] + in.n[1] * a[3];
        if (!(fabs(c0 - c1) <= LENGTH_EPS))
            return plan_statement_error(
                c,
                "the line from %.9g %.9g to %.9g %.9g is not parallel to wall %s; adjust keeps the "
                "direction of a wall.",
                a[0], a[1], a[2], a[3], s->name);
        w->c = c0;
        return ST_OK;
    }
    if (by_line) {
        struct placed_line line;
        double span[2];
        plan_wall_span(plan, at, span);
        const double z = s->place.kind == PLACE_TOP ? plan_wall_top(plan, at, span[0], span[1]) : w->foot;
        if (plan_place_line(c, s->name, z, w->d, false, &line)) return c->err->status;
        if (line.d[0] * w->d[0] + line.d[1] * w->d[1] < 0)
            return plan_statement_error(c, "%s shows wall %s from behind; draw the line in a photo of its inside.",
                                        s->place.view, s->name);
        log_note("wall %s: moved by %.3g", s->name, line.c - w->c);
        w->c = line.c;
        return ST_OK;
    }
    struct placed_wall placed;
    const struct place_direction kept = {.normal = in.n};
    if (place_wall(&placed, c->placer, &s->place, &kept, c->path, s->line, c->err)) return c->err->status;
    log_note("wall %s: moved by %.3g; %zu points, median distance from the wall %.3g", s->name, placed.c - w->c,
             placed.points, placed.spread);
    w->c = placed.c;
    return ST_OK;
}

static enum status move_footprint(struct plan_context *c, const char *what, double low[2], double high[2])
{
    const struct statement *s = c->s;
    if (s->value_count < 2)
        return plan_statement_error(c, "%s moves by two distances, in x and y: \"move %s by DX DY\".", what, s->name);
    for (int k = 0; k < 2; k++) {
        low[k] += s->values[k];
        high[k] += s->values[k];
    }
    return ST_OK;
}

enum status plan_read_move(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name)) return r->err->status;
    if (script_next_is(r, "to")) {
        s->value_count = 2;
        return script_expect(r, "to") || script_read_name(r, "a room", &s->other) || script_expect(r, "at") ||
                       script_read_number(r, "X", &s->values[0]) || script_read_number(r, "Y", &s->values[1])
                   ? r->err->status
                   : ST_OK;
    }
    if (script_expect(r, "by") || script_read_number(r, "a distance", &s->values[s->value_count++]))
        return r->err->status;
    while (s->value_count < 3 && textfile_more(&r->t) && !script_next_is(r, "turn"))
        if (script_read_number(r, "a distance", &s->values[s->value_count++])) return r->err->status;
    return ST_OK;
}

enum status plan_apply_move(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    enum name_kind kind;
    int at;
    if (plan_is_thing(plan, s->name, &at)) return plan_apply_thing_move(c, at);
    if (plan_find_solid(c, s->name, &kind, &at)) return c->err->status;
    if (s->other || s->has_option[OPTION_TURN])
        return plan_statement_error(c,
                                    "%s is not a thing. Only things move to a room, or turn while they move; a box is "
                                    "turned by \"change %s turn DEGREES\".",
                                    s->name, s->name);
    if (kind == NAMED_SLOT && s->value_count > 2)
        return plan_statement_error(c, "%s stays in its ceiling or floor: \"move %s by DX DY\".", s->name, s->name);
    if (kind == NAMED_SLOT) return move_footprint(c, s->name, plan->slots[at].low, plan->slots[at].high);
    if (kind == NAMED_BOX) {
        struct plan_box *b = &plan->boxes[at];
        if (move_footprint(c, "a box", b->low, b->high)) return c->err->status;
        b->low[2] += s->value_count > 2 ? s->values[2] : 0;
        b->high[2] += s->value_count > 2 ? s->values[2] : 0;
        return ST_OK;
    }
    if (kind == NAMED_WALL) {
        if (s->value_count != 1)
            return plan_statement_error(
                c,
                "a wall moves along its normal, away from its inside, by one distance: \"move %s by "
                "DISTANCE\"; extend moves its ends.",
                s->name);
        plan->walls[at].c -= s->values[0];
        return ST_OK;
    }
    if (s->value_count > 2)
        return plan_statement_error(c,
                                    "an opening moves along its wall, and up: \"move %s by DISTANCE [UP]\"; adjust and "
                                    "resize change its size.",
                                    s->name);
    for (int k = 0; k < 2; k++) {
        plan->openings[at].s[k] += s->values[0];
        plan->openings[at].z[k] += s->value_count > 1 ? s->values[1] : 0;
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------- sizes and heights */

/* A statement that has nothing but options must have one. */
enum status plan_read_changes(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name)) return r->err->status;
    return textfile_more(&r->t) ? ST_OK : script_usage_error(r, NULL);
}

/* ST_DATA: the statement has an option that is not in `known` (bits of enum option). */
static enum status check_options(struct plan_context *c, unsigned known, const char *wanted)
{
    for (int i = 0; i < OPTION_COUNT; i++)
        if (c->s->has_option[i] && !(known & 1u << i))
            return plan_statement_error(c, "found %s, which %s does not have; wanted %s.",
                                        script_option_name((enum option)i), c->s->name, wanted);
    return ST_OK;
}

static void set_if_given(const struct statement *s, enum option option, double *value)
{
    if (s->has_option[option]) *value = s->options[option];
}

/* Sets the thickness of a wall, and of the walls that continue it on its line round a room: a room's side has one. */
static void set_thickness(struct plan *plan, int wall, double thickness)
{
    plan->walls[wall].thickness = thickness;
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        bool listed = false;
        for (int k = 0; k < r->wall_count; k++) listed |= r->walls[k] == wall;
        for (int k = 0; k < r->wall_count && listed; k++) {
            const struct plan_wall *o = &plan->walls[r->walls[k]];
            if (o->thickness != thickness && plan_walls_on_one_line(o, &plan->walls[wall]))
                set_thickness(plan, r->walls[k], thickness);
        }
    }
}

static enum status change_wall(struct plan_context *c, int wall)
{
    const struct statement *s = c->s;
    struct plan_wall *w = &c->plan->walls[wall];
    if (check_options(c, 1u << OPTION_THICKNESS | 1u << OPTION_FOOT | 1u << OPTION_TOP, "thickness, foot or top"))
        return c->err->status;
    if (s->has_option[OPTION_THICKNESS]) {
        if (plan_check_length(c, "thickness", s->options[OPTION_THICKNESS])) return c->err->status;
        set_thickness(c->plan, wall, s->options[OPTION_THICKNESS]);
    }
    set_if_given(s, OPTION_FOOT, &w->foot);
    set_if_given(s, OPTION_TOP, &w->top);
    w->has_top |= s->has_option[OPTION_TOP];
    if (w->top - w->foot >= MIN_SIZE) return ST_OK;
    return plan_statement_error(c, "wall %s would go from %.9g up to %.9g, wanted a top above its foot.", s->name,
                                w->foot, w->top);
}

static enum status change_room(struct plan_context *c, struct plan_room *r)
{
    const struct statement *s = c->s;
    if (check_options(c, 1u << OPTION_CEILING, "ceiling")) return c->err->status;
    r->ceiling = s->options[OPTION_CEILING];
    r->shape = LEVEL_CEILING;
    if (r->ceiling - r->floor >= MIN_SIZE) return ST_OK;
    return plan_statement_error(c, "room %s would go from %.9g up to %.9g, wanted a ceiling above the floor.", s->name,
                                r->floor, r->ceiling);
}

enum status plan_apply_change(struct plan_context *c)
{
    const struct statement *s = c->s;
    enum name_kind kind;
    int at;
    if (plan_find_named(c, s->name, 1u << NAMED_WALL | 1u << NAMED_BOX | 1u << NAMED_ROOM, "a wall, a box or a room",
                        &kind, &at))
        return c->err->status;
    if (kind == NAMED_WALL) return change_wall(c, at);
    if (kind == NAMED_ROOM) return change_room(c, &c->plan->rooms[at]);
    struct plan_box *b = &c->plan->boxes[at];
    if (check_options(c, 1u << OPTION_FOOT | 1u << OPTION_TOP | 1u << OPTION_TURN, "foot, top or turn"))
        return c->err->status;
    set_if_given(s, OPTION_FOOT, &b->low[2]);
    set_if_given(s, OPTION_TOP, &b->high[2]);
    set_if_given(s, OPTION_TURN, &b->turn);
    return ST_OK; /* the plan's check refuses an empty box */
}

/* Moves the sides of an opening outwards by the given distances. */
enum status plan_apply_resize(struct plan_context *c)
{
    const struct statement *s = c->s;
    const double *by = s->options; /* 0 where no option is given */
    enum name_kind kind;
    int at;
    if (plan_find_named(c, s->name, 1u << NAMED_OPENING | 1u << NAMED_SLOT, "an opening", &kind, &at))
        return c->err->status;
    if (kind == NAMED_SLOT) {
        struct plan_slot *slot = &c->plan->slots[at];
        if (check_options(c, 1u << OPTION_LEFT | 1u << OPTION_RIGHT | 1u << OPTION_FRONT | 1u << OPTION_BACK,
                          "left, right, front or back"))
            return c->err->status;
        slot->low[0] -= by[OPTION_LEFT];
        slot->high[0] += by[OPTION_RIGHT];
        slot->low[1] -= by[OPTION_FRONT];
        slot->high[1] += by[OPTION_BACK];
        return ST_OK;
    }
    struct plan_opening *o = &c->plan->openings[at];
    const bool left_is_low = c->plan->walls[o->wall].sign > 0; /* the wall's start is at the left */
    if (check_options(c, 1u << OPTION_LEFT | 1u << OPTION_RIGHT | 1u << OPTION_BOTTOM | 1u << OPTION_TOP,
                      "left, right, bottom or top"))
        return c->err->status;
    o->s[0] -= by[left_is_low ? OPTION_LEFT : OPTION_RIGHT];
    o->s[1] += by[left_is_low ? OPTION_RIGHT : OPTION_LEFT];
    o->z[0] -= by[OPTION_BOTTOM];
    o->z[1] += by[OPTION_TOP];
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- filling */

struct filled { /* what an opening, or one in a room, is filled with */
    const char *kind;
    enum filling *fill, own; /* own: a window's glass, a door's leaf; FILL_NOTHING: a passage */
    double *leaf;
};

/* The opening that the statement names. *of: it, if it is in a wall, else NULL. */
static enum status find_filled(struct plan_context *c, struct filled *f, struct plan_opening **of)
{
    enum name_kind kind;
    int at;
    if (plan_find_named(c, c->s->name, 1u << NAMED_OPENING | 1u << NAMED_SLOT, "a door or a window", &kind, &at))
        return c->err->status;
    struct plan_opening *o = *of = kind == NAMED_OPENING ? &c->plan->openings[at] : NULL;
    struct plan_slot *slot = kind == NAMED_SLOT ? &c->plan->slots[at] : NULL;
    const enum opening_kind is = o ? o->kind : slot->kind;
    *f = (struct filled){plan_opening_word(is), o ? &o->fill : &slot->fill,
                         is == OPENING_WINDOW || is == OPENING_SKYLIGHT ? FILL_GLASS
                         : is == OPENING_PASSAGE                        ? FILL_NOTHING
                                                                        : FILL_LEAF,
                         o ? &o->leaf : &slot->leaf};
    return ST_OK;
}

/* Opens or closes what the opening has of its own. */
static enum status open_or_close(struct plan_context *c, bool closing)
{
    const char *name = c->s->name;
    struct plan_opening *o = NULL;
    struct filled f = {0};
    if (find_filled(c, &f, &o)) return c->err->status;
    if (o && o->interior)
        return plan_statement_error(c, "window %s is interior and has no glass; fill it with glass or nothing.", name);
    if (f.own == FILL_NOTHING)
        return plan_statement_error(c, "%s %s has no leaf that could be %s; declare a door, or fill it with a leaf.",
                                    f.kind, name, closing ? "closed" : "opened");
    if ((*f.fill != FILL_NOTHING) == closing)
        return plan_statement_error(c, "%s %s is %s already.", f.kind, name, closing ? "closed" : "open");
    const enum filling wanted = closing ? f.own : FILL_NOTHING;
    if (plan_fill_thickness(c, wanted, f.leaf)) return c->err->status;
    *f.fill = wanted;
    return ST_OK;
}

enum status plan_read_named(struct script_reader *r, struct statement *s)
{
    return script_read_name(r, "a name", &s->name);
}

enum status plan_apply_open(struct plan_context *c) { return open_or_close(c, false); }

enum status plan_apply_close(struct plan_context *c) { return open_or_close(c, true); }

enum status plan_read_fill(struct script_reader *r, struct statement *s)
{
    char *word;
    int f = 0;
    if (script_read_name(r, "a name", &s->name) || script_expect(r, "with") ||
        textfile_word(&r->t, "leaf, glass, wall or nothing", &word, r->err))
        return r->err->status;
    while (f < FILL_COUNT && strcmp(script_filling_name((enum filling)f), word)) f++;
    if (f == FILL_COUNT) return script_usage_error(r, word);
    s->filling = (enum filling)f;
    return ST_OK;
}

enum status plan_apply_fill(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan_opening *o = NULL;
    struct filled f = {0};
    if (find_filled(c, &f, &o)) return c->err->status;
    if (*f.fill == s->filling)
        return plan_statement_error(c, "%s %s is filled with %s already.", f.kind, s->name,
                                    script_filling_name(s->filling));
    if (plan_fill_thickness(c, s->filling, f.leaf)) return c->err->status;
    *f.fill = s->filling;
    if (o) {
        o->refilled = true;
        o->interior = false;
    }
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------- removing, and bases */

enum status plan_read_remove(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name)) return r->err->status;
    if (strcmp(s->name, "object") || !textfile_more(&r->t)) return ST_OK;
    s->of_object = true;
    return script_read_name(r, "the name of an object", &s->name);
}

enum status plan_apply_remove(struct plan_context *c)
{
    struct plan *plan = c->plan;
    enum name_kind kind;
    int at;
    if (c->s->of_object) return plan_remove_object(c);
    if (plan_is_thing(plan, c->s->name, &at))
        return plan_statement_error(c, "%s is a thing, which is left out by \"clear %s\".", c->s->name, c->s->name);
    if (plan_find_named(c, c->s->name, ~0u, "anything", &kind, &at)) return c->err->status;
    switch (kind) {
    case NAMED_WALL:
        plan->walls[at].removed = true;
        for (int i = 0; i < plan->opening_count; i++)
            if (plan->openings[i].wall == at) plan->openings[i].removed = true;
        break;
    case NAMED_OPENING:
        plan->openings[at].removed = true;
        break;
    case NAMED_SLOT:
        plan->slots[at].removed = true;
        break;
    case NAMED_BOX:
        plan->boxes[at].removed = true;
        break;
    default:
        plan->rooms[at].removed = true;
        for (int i = 0; i < plan->slot_count; i++)
            if (plan->slots[i].room == at) plan->slots[i].removed = true;
    }
    return ST_OK;
}

enum status plan_read_base(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name)) return r->err->status;
    if (r->count > 1) return textfile_error(&r->t, r->err, "base", "\"base EDIT\" as the first statement, once");
    if (!strcmp(s->name, "none"))
        return textfile_error(&r->t, r->err, "none", "the name of another edit: \"none\" is the word for no edit");
    r->base = s->name;
    r->base_line = s->line;
    return ST_OK;
}

/* The statements of that edit were applied before (edit_chain.c). */
enum status plan_apply_base(struct plan_context *c)
{
    char *base = strdup(c->s->name);
    if (!base) return err_nomem(c->err, "a name", strlen(c->s->name) + 1);
    free(c->plan->base);
    c->plan->base = base;
    return ST_OK;
}
