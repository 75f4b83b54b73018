/* plan_names.c - the names of a plan's walls, openings, boxes and rooms, in a hash table with open addressing. */
#include <stdlib.h>
#include <string.h>

#include "common/base/hash.h"
#include "common/base/scan.h"
#include "stages/build_model/plan/plan_internal.h"

static struct plan_name *find_slot(const struct plan *plan, const char *name)
{
    const size_t mask = (size_t)plan->name_capacity - 1;
    size_t i = hash_text(name) & mask;
    while (plan->names[i].name && strcmp(plan->names[i].name, name)) i = (i + 1) & mask;
    return &plan->names[i];
}

static enum name_kind find_name(const struct plan *plan, const char *name, int *at)
{
    const struct plan_name *n = plan->name_capacity ? find_slot(plan, name) : NULL;
    if (!n || !n->name) return NAMED_NONE;
    *at = n->at;
    return n->kind;
}

enum status plan_add_name(struct plan *plan, const char *name, enum name_kind kind, int at, struct err *err)
{
    if (2 * (plan->name_count + 1) > plan->name_capacity) {
        const int capacity = plan->name_capacity ? 2 * plan->name_capacity : 64;
        struct plan larger = {.names = calloc((size_t)capacity, sizeof *plan->names), .name_capacity = capacity};
        if (!larger.names) return err_nomem(err, "names", (size_t)capacity * sizeof *plan->names);
        for (int i = 0; i < plan->name_capacity; i++)
            if (plan->names[i].name) *find_slot(&larger, plan->names[i].name) = plan->names[i];
        free(plan->names);
        plan->names = larger.names;
        plan->name_capacity = capacity;
    }
    *find_slot(plan, name) = (struct plan_name){name, kind, at};
    plan->name_count++;
    return ST_OK;
}

static const char *kind_name(enum name_kind kind)
{
    static const char *const names[] = {"nothing", "a wall", "an opening", "a box", "a room", "an opening in a room",
                                        "a thing"};
    return names[kind];
}

static int name_line(const struct plan *plan, enum name_kind kind, int at)
{
    return kind == NAMED_WALL      ? plan->walls[at].line
           : kind == NAMED_OPENING ? plan->openings[at].line
           : kind == NAMED_BOX     ? plan->boxes[at].line
           : kind == NAMED_SLOT    ? plan->slots[at].line
           : kind == NAMED_THING   ? plan->things[at].line
                                   : plan->rooms[at].line;
}

static bool is_removed(const struct plan *plan, enum name_kind kind, int at)
{
    return kind == NAMED_WALL      ? plan->walls[at].removed
           : kind == NAMED_OPENING ? plan->openings[at].removed
           : kind == NAMED_BOX     ? plan->boxes[at].removed
           : kind == NAMED_SLOT    ? plan->slots[at].removed
           : kind == NAMED_THING   ? false
                                   : plan->rooms[at].removed;
}

static const char *nth_name(const void *ctx, int i)
{
    const struct plan *plan = ctx;
    for (int k = 0; k < plan->name_capacity; k++)
        if (plan->names[k].name && i-- == 0) return plan->names[k].name;
    return NULL;
}

enum status plan_find_named(struct plan_context *c, const char *name, unsigned kinds, const char *wanted,
                            enum name_kind *kind, int *at)
{
    *kind = find_name(c->plan, name, at);
    if (*kind == NAMED_NONE) {
        const char *near = c->plan->name_count < 2000 ? scan_nearest(name, nth_name, c->plan) : NULL;
        if (near) return plan_statement_error(c, "nothing is named %s yet; did you mean %s?", name, near);
        return plan_statement_error(c, "nothing is named %s yet; wanted %s.", name, wanted);
    }
    if (is_removed(c->plan, *kind, *at))
        return plan_statement_error(c, "%s was removed and can no longer be changed.", name);
    if (!(kinds & (1u << *kind)))
        return plan_statement_error(c, "%s is %s; wanted %s.", name, kind_name(*kind), wanted);
    return ST_OK;
}

bool plan_is_thing(const struct plan *plan, const char *name, int *at)
{
    return find_name(plan, name, at) == NAMED_THING;
}

enum status plan_find_solid(struct plan_context *c, const char *name, enum name_kind *kind, int *at)
{
    return plan_find_named(c, name, 1u << NAMED_WALL | 1u << NAMED_OPENING | 1u << NAMED_SLOT | 1u << NAMED_BOX,
                           "a wall, an opening or a box", kind, at);
}

enum status plan_find_wall(struct plan_context *c, const char *name, int *wall)
{
    enum name_kind kind;
    return plan_find_named(c, name, 1u << NAMED_WALL, "a wall", &kind, wall);
}

enum status plan_find_room(struct plan_context *c, const char *name, int *room)
{
    enum name_kind kind;
    return plan_find_named(c, name, 1u << NAMED_ROOM, "a room", &kind, room);
}

enum status plan_copy_new_name(struct plan_context *c, const char *name, char **copy)
{
    int at;
    const enum name_kind kind = find_name(c->plan, name, &at);
    if (kind != NAMED_NONE)
        return plan_statement_error(
            c,
            "the name %s is used already, for %s%s (line %d); faces are identified by name, so choose "
            "another one.",
            name, kind_name(kind), is_removed(c->plan, kind, at) ? " that was removed" : "",
            name_line(c->plan, kind, at));
    *copy = strdup(name);
    return *copy ? ST_OK : err_nomem(c->err, "a name", strlen(name));
}
