/* plan_lights.c - statements about lamps and about synthetic objects. What they say is kept by name: the last statement
 * about a lamp or an object counts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/build_model/plan_internal.h"

void plan_lights_release(struct plan *plan)
{
    for (int i = 0; i < plan->lamp_count; i++) free(plan->lamps[i].name);
    for (int i = 0; i < plan->object_count; i++) {
        free(plan->objects[i].name);
        free(plan->objects[i].path);
        free(plan->objects[i].file);
    }
    free(plan->lamps);
    free(plan->objects);
}

/* off, scale */
enum status apply_lamp(struct plan_context *c)
{
    struct plan *p = c->plan;
    int i = 0;
    while (i < p->lamp_count && strcmp(p->lamps[i].name, c->s->name)) i++;
    if (i == p->lamp_count) {
        if (array_append(&p->lamps, (size_t)i, sizeof *p->lamps, "lamps", c->err)) return c->err->status;
        p->lamps[i].name = strdup(c->s->name);
        if (!p->lamps[i].name) return err_nomem(c->err, "a lamp", strlen(c->s->name) + 1);
        p->lamp_count++;
    }
    memcpy(p->lamps[i].scale, c->s->values, sizeof p->lamps[i].scale);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- objects */

/* The object of a name, removed or not; NULL: there was never one. */
static struct plan_object *find_object(const struct plan *p, const char *name)
{
    for (int i = 0; i < p->object_count; i++)
        if (!strcmp(p->objects[i].name, name)) return &p->objects[i];
    return NULL;
}

static enum status check_size(struct plan_context *c)
{
    for (int k = 0; k < 3; k++)
        if (!(fabs(c->s->object.at[k]) <= MAX_SIZE))
            return statement_error(c, "the object %s is at %.9g %.9g %.9g, wanted it within %g of the origin.",
                                   c->s->name, c->s->object.at[0], c->s->object.at[1], c->s->object.at[2], MAX_SIZE);
    return ST_OK;
}

enum status apply_object(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_object *o = find_object(p, s->name);
    if (check_size(c)) return c->err->status;
    if (!o) {
        if (array_append(&p->objects, (size_t)p->object_count, sizeof *p->objects, "objects", c->err))
            return c->err->status;
        o = &p->objects[p->object_count++];
        *o = (struct plan_object){.name = strdup(s->name)};
    }
    free(o->path);
    free(o->file);
    o->path = strdup(c->path);
    o->file = strdup(s->other);
    o->line = s->line;
    o->removed = false;
    o->placed = s->object;
    return o->name && o->path && o->file ? ST_OK : err_nomem(c->err, "an object", strlen(c->path) + strlen(s->other));
}

static const char *nth_object(const void *ctx, int i)
{
    const struct plan *p = ctx;
    return i < p->object_count ? p->objects[i].name : NULL;
}

enum status remove_object(struct plan_context *c)
{
    struct plan_object *o = find_object(c->plan, c->s->name);
    if (!o) {
        const char *near = scan_nearest(c->s->name, nth_object, c->plan);
        if (near) return statement_error(c, "no object is named %s; did you mean %s?", c->s->name, near);
        return statement_error(
            c, "no object is named %s; objects.txt or the edit that this one stands on must place it.", c->s->name);
    }
    if (o->removed) return statement_error(c, "the object %s was removed already.", c->s->name);
    o->removed = true;
    return ST_OK;
}
