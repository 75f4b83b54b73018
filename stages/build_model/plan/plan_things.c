/* plan_things.c - statements about things, furniture that the photographs show. Only their names are known here; where
 * they are and whether they fit is found when pictures are drawn (common/relight/placed_things.c). */
#include "stages/build_model/plan/plan_things.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/model/thing_marks.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

void plan_things_release(struct plan *plan)
{
    for (int i = 0; i < plan->thing_count; i++) {
        free(plan->things[i].name);
        free(plan->things[i].script);
    }
    free(plan->things);
}

/* Remembers the statement for messages about the thing's place: products do not depend on the scene's folder. */
static enum status note_statement(const struct plan_context *c, struct plan_thing *t)
{
    free(t->script);
    t->said = c->s->line;
    t->script = strdup(path_file_name(c->path));
    return t->script ? ST_OK : err_nomem(c->err, "a script's name", strlen(c->path));
}

/* Adds a thing, of which the name is taken over. from: -1: it is itself. */
static enum status add_thing(struct plan *p, char *name, int line, int from, struct err *err)
{
    if (array_append(&p->things, (size_t)p->thing_count, sizeof *p->things, "things", err)) {
        free(name);
        return err->status;
    }
    const int at = p->thing_count++;
    p->things[at] = (struct plan_thing){.name = name, .line = line, .from = from < 0 ? at : from};
    return plan_add_name(p, name, NAMED_THING, at, err);
}

enum status plan_things_add(struct plan *plan, const char *path, struct provenance *prov, struct err *err)
{
    struct thing_marks marks = {0};
    thing_names_read(&marks, path, prov, err);
    for (int k = 0; !err->status && k < marks.name_count; k++) {
        const struct statement s = {.line = marks.lines[k]};
        struct plan_context c = {.plan = plan, .path = path, .s = &s, .err = err};
        char *name = NULL;
        if (!plan_copy_new_name(&c, marks.names[k], &name)) add_thing(plan, name, marks.lines[k], -1, err);
    }
    thing_marks_release(&marks);
    return err->status;
}

/* "as NAME by DX DY [UP]" after the name of a thing. */
enum status plan_read_thing_copy(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "\"texture\", or a thing", &s->name) || script_expect(r, "as") ||
        script_read_name(r, "a new name", &s->other) || script_expect(r, "by"))
        return r->err->status;
    while (s->value_count < 2 || (s->value_count < 3 && textfile_more(&r->t) && !script_next_is(r, "turn")))
        if (script_read_number(r, "a distance", &s->values[s->value_count++])) return r->err->status;
    return ST_OK;
}

static enum status shift(struct plan_context *c, struct plan_thing *t)
{
    const struct statement *s = c->s;
    if (note_statement(c, t)) return c->err->status;
    for (int k = 0; k < s->value_count; k++) t->by[k] += s->values[k];
    if (s->has_option[OPTION_TURN]) t->turn += s->options[OPTION_TURN];
    const bool stays = t->by[0] == 0 && t->by[1] == 0 && t->by[2] == 0 && t->turn == 0;
    if (t->state == PLAN_THING_LEFT && stays) return ST_OK; /* which is refused, as a statement that changes nothing */
    if (t->state != PLAN_THING_PLACED) t->state = PLAN_THING_MOVED;
    return ST_OK;
}

enum status plan_apply_thing_move(struct plan_context *c, int at)
{
    const struct statement *s = c->s;
    struct plan_thing *t = &c->plan->things[at];
    int room;
    if (!c->edit) return plan_statement_for_edits(c, "move THING");
    if (t->state == PLAN_THING_CLEARED)
        return plan_statement_error(c, "%s was cleared, so it cannot be moved.", s->name);
    if (!s->other && s->value_count < 2)
        return plan_statement_error(c, "a thing moves by two distances, in x and y: \"move %s by DX DY [UP]\".",
                                    s->name);
    if (!s->other) return shift(c, t);
    if (plan_find_room(c, s->other, &room) || note_statement(c, t)) return c->err->status;
    t->state = PLAN_THING_PLACED;
    t->by[0] = s->values[0];
    t->by[1] = s->values[1];
    t->by[2] = c->plan->rooms[room].floor;
    if (s->has_option[OPTION_TURN]) t->turn = s->options[OPTION_TURN];
    return ST_OK;
}

enum status plan_apply_thing_copy(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    enum name_kind kind;
    char *name = NULL;
    int at;
    if (plan_find_named(c, s->name, 1u << NAMED_THING, "\"texture\", or a thing of things.txt", &kind, &at) ||
        plan_copy_new_name(c, s->other, &name))
        return c->err->status;
    if (p->things[at].state == PLAN_THING_CLEARED) {
        free(name);
        return plan_statement_error(c, "%s was cleared before, so there is nothing to copy; copy it first.", s->name);
    }
    const struct plan_thing model = p->things[at]; /* the copy starts from where this one stands now */
    if (add_thing(p, name, s->line, model.from, c->err)) return c->err->status;
    struct plan_thing *t = &p->things[p->thing_count - 1];
    memcpy(t->by, model.by, sizeof t->by);
    t->turn = model.turn;
    t->state = model.state == PLAN_THING_PLACED ? PLAN_THING_PLACED : PLAN_THING_MOVED;
    return shift(c, t);
}

enum status plan_apply_thing_clear(struct plan_context *c, int at, bool keep)
{
    struct plan_thing *t = &c->plan->things[at];
    if (c->s->has_option[OPTION_FOOT] || c->s->has_option[OPTION_TOP])
        return plan_statement_error(c, "%s is a thing, which is cleared or kept whole; leave out foot and top.",
                                    c->s->name);
    if (keep && t->state != PLAN_THING_LEFT)
        return plan_statement_error(c, "%s was %s before, so it cannot be kept where it is.", c->s->name,
                                    t->state == PLAN_THING_CLEARED ? "cleared"
                                    : t->state == PLAN_THING_KEPT  ? "kept"
                                                                   : "moved");
    t->state = keep ? PLAN_THING_KEPT : PLAN_THING_CLEARED;
    return note_statement(c, t);
}
