/* plan_apply.c - applies the statements of a script to a plan.
 *
 * Each statement has a function in the table of verbs, which changes the plan at once. What depends on the whole plan
 * (whether an opening lies in its wall, whether a room's walls close) is checked once the script is read, and in an
 * edit after each statement, so that the statement which breaks the building is named. An edit's statement must also
 * change something: the plan as a text is compared with what it was before. */
#include <stdlib.h>
#include <string.h>

#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/plan/room_parts.h"

static void unedited_release(struct plan *unedited)
{
    if (!unedited) return;
    free(unedited->walls);
    free(unedited->openings);
    free(unedited->slots);
    free(unedited->boxes);
    free(unedited->rooms);
    free(unedited->names);
    free(unedited->things);
    free(unedited);
}

void plan_release(struct plan *plan)
{
    if (!plan) return;
    unedited_release(plan->unedited);
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
    free(plan->base);
    plan_wishes_release(plan);
    plan_lights_release(plan);
    plan_things_release(plan);
    *plan = (struct plan){0};
}

void plan_begin(struct plan *plan, const struct model_axes *axes)
{
    *plan = (struct plan){.colour = {-1, -1, -1}};
    if (!axes || axes->metric) {
        plan->thickness = 0.15;
        plan->glass = 0.02;
        plan->leaf = 0.04;
        if (!axes) plan->ceiling = 2.5;
    }
    if (axes && axes->ceiling > 0) plan->ceiling = axes->ceiling;
    if (axes && axes->thickness > 0) plan->thickness = axes->thickness;
}

static enum status needs_views(struct plan_context *c)
{
    const struct statement *s = c->s;
    const char *view = s->place.view ? s->place.view : s->target.view ? s->target.view : NULL;
    if (s->corner_count) view = s->corners[0].view;
    if (!view || c->placer) return ST_OK;
    return plan_statement_error(c, "the statement names the view %s, but no views are known; give --views.", view);
}

/* An edit's statement that changes nothing is a mistake. A default that is set must be used further down. */
struct edit_watch {
    char *before;
    int set_line[DEFAULTS]; /* of a default that no statement used yet; 0: none */
};

static enum status unused_default(struct plan_context *c, enum plan_default which, int line)
{
    const char *name;
    plan_default_value(c->plan, which, &name);
    return err_set(c->err, ST_DATA,
                   "%s:%d: \"set %s\" changes nothing: no statement further down uses it, and it does not change what "
                   "there is%s.",
                   c->path, line, name,
                   which == DEFAULT_CEILING     ? "; to change a ceiling, write \"change ROOM ceiling Z\""
                   : which == DEFAULT_THICKNESS ? "; to change a wall, write \"change WALL thickness T\""
                                                : "");
}

/* before: the defaults before the statement set some of them. */
static enum status watch_set(struct plan_context *c, struct edit_watch *w, const double before[DEFAULTS])
{
    for (int i = 0; i < DEFAULTS; i++) {
        const char *name;
        const double value = *plan_default_value(c->plan, (enum plan_default)i, &name);
        if (!(c->set & 1u << i)) continue;
        if (w->set_line[i]) return unused_default(c, (enum plan_default)i, w->set_line[i]);
        if (value == before[i])
            return plan_statement_error(c, "the statement changes nothing: %s is %.9g already.", name, value);
        w->set_line[i] = c->s->line;
    }
    return ST_OK;
}

static enum status apply_watched(struct plan_context *c, struct edit_watch *w)
{
    char *after = NULL;
    double before[DEFAULTS];
    for (int i = 0; i < DEFAULTS; i++) before[i] = *plan_default_value(c->plan, (enum plan_default)i, NULL);
    c->used = c->set = 0;
    if (c->s->verb->apply(c)) return c->err->status;
    if (c->set) return watch_set(c, w, before);
    if (plan_check(c->plan, c->path, c->s->line, c->err) || plan_state(&after, c->plan, c->err)) return c->err->status;
    for (int i = 0; i < DEFAULTS; i++)
        if (c->used & 1u << i) w->set_line[i] = 0;
    const bool same = !strcmp(w->before, after);
    free(w->before);
    w->before = after;
    return same ? plan_statement_error(c, "the statement changes nothing: the plan is like that already.") : ST_OK;
}

/* *to: a copy of the items, or NULL. */
static enum status copy_items(void *to, const void *items, int count, size_t size, struct err *err)
{
    void *copy = malloc((size_t)count * size + 1);
    if (copy && count) memcpy(copy, items, (size_t)count * size);
    memcpy(to, &copy, sizeof copy);
    return copy ? ST_OK : err_nomem(err, "the unedited plan", (size_t)count * size);
}

static enum status keep_unedited(struct plan *p, struct err *err)
{
    struct plan *u = malloc(sizeof *u);
    if (!u) return err_nomem(err, "the unedited plan", sizeof *u);
    *u = *p;
    u->walls = NULL;
    u->openings = NULL;
    u->slots = NULL;
    u->boxes = NULL;
    u->rooms = NULL;
    u->names = NULL;
    u->wishes = NULL;
    u->zones = NULL;
    u->lamps = NULL;
    u->objects = NULL;
    u->things = NULL;
    u->base = NULL;
    u->wish_count = u->zone_count = u->lamp_count = u->object_count = 0;
    p->unedited = u;
    if (!copy_items(&u->walls, p->walls, p->wall_count, sizeof *p->walls, err) &&
        !copy_items(&u->openings, p->openings, p->opening_count, sizeof *p->openings, err) &&
        !copy_items(&u->slots, p->slots, p->slot_count, sizeof *p->slots, err) &&
        !copy_items(&u->boxes, p->boxes, p->box_count, sizeof *p->boxes, err) &&
        !copy_items(&u->rooms, p->rooms, p->room_count, sizeof *p->rooms, err) &&
        !copy_items(&u->things, p->things, p->thing_count, sizeof *p->things, err))
        copy_items(&u->names, p->names, p->name_capacity, sizeof *p->names, err);
    for (int i = 0; !err->status && i < u->room_count; i++) {
        struct plan_room *r = &u->rooms[i];
        r->walls = r->edge_of = NULL;
        r->edges = NULL;
        r->parts = NULL;
        r->wall_count = r->edge_count = r->part_count = 0;
    }
    return err->status;
}

static enum status apply_edit(struct plan_context *c, const struct script *script)
{
    struct edit_watch w = {0};
    if (!c->plan->unedited) keep_unedited(c->plan, c->err);
    if (!c->err->status) plan_state(&w.before, c->plan, c->err);
    for (int i = 0; i < script->count && !c->err->status; i++) {
        c->s = &script->statements[i];
        if (!needs_views(c)) apply_watched(c, &w);
    }
    for (int i = 0; i < DEFAULTS && !c->err->status; i++)
        if (w.set_line[i]) unused_default(c, (enum plan_default)i, w.set_line[i]);
    free(w.before);
    return c->err->status;
}

enum status plan_apply(struct plan *plan, const struct script *script, bool edit, const struct placer *placer,
                       struct err *err)
{
    struct plan_context c = {.plan = plan, .path = script->path, .placer = placer, .err = err, .edit = edit};
    if (edit) return apply_edit(&c, script);
    for (int i = 0; i < script->count; i++) {
        c.s = &script->statements[i];
        if (!(c.s->verb->where & IN_MODEL)) return plan_statement_for_edits(&c, c.s->verb->word);
        if (needs_views(&c) || c.s->verb->apply(&c)) return err->status;
    }
    return plan_check(plan, script->path, 0, err);
}
