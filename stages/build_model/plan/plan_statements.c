/* plan_statements.c - statements that make rooms, and the defaults that set gives to walls and rooms.
 *
 * Defaults are those of the last `set` before the statement. Which of them a statement used is noted (plan_context),
 * so that a `set` that nothing uses can be refused. Without a scale lengths of homes mean nothing, so thickness and
 * ceiling are unknown until they are set, and the error says so. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
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
