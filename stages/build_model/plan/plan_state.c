/* plan_state.c - a plan as a text, to tell whether a statement changed it. */
#include <stdio.h>
#include <stdlib.h>

#include "common/base/memory_text.h"

#include "stages/build_model/plan/plan_internal.h"

static void put(FILE *to, const double *values, int count)
{
    for (int i = 0; i < count; i++) fprintf(to, " %a", values[i] + 0.0); /* -0 is 0 */
    fputc('\n', to);
}

static void put_walls(FILE *to, const struct plan *plan)
{
    for (int i = 0; i < plan->wall_count; i++) {
        const struct plan_wall *w = &plan->walls[i];
        fprintf(to, "wall %d %d", w->removed, w->has_top);
        for (int e = 0; e < 2; e++) fprintf(to, " %d %d %a", w->ends[e].kind, w->ends[e].other, w->ends[e].s + 0.0);
        put(to, (const double[]){w->d[0], w->d[1], w->c, w->thickness, w->foot, w->top}, 6);
    }
}

static void put_openings(FILE *to, const struct plan *plan)
{
    for (int i = 0; i < plan->opening_count; i++) {
        const struct plan_opening *o = &plan->openings[i];
        fprintf(to, "opening %d %d %d %d %d", o->removed, o->interior, o->fill, o->refilled, o->wall);
        put(to, (const double[]){o->leaf, o->s[0], o->s[1], o->z[0], o->z[1]}, 5);
    }
    for (int i = 0; i < plan->slot_count; i++) {
        const struct plan_slot *s = &plan->slots[i];
        fprintf(to, "slot %d %d", s->removed, s->fill);
        put(to, (const double[]){s->leaf, s->low[0], s->low[1], s->high[0], s->high[1]}, 5);
    }
}

static void put_rooms(FILE *to, const struct plan *plan)
{
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        fprintf(to, "room %d %d %d %d", r->removed, (int)r->shape, r->slope_walls[0], r->slope_walls[1]);
        for (int k = 0; k < r->wall_count; k++) fprintf(to, " %d", r->walls[k]);
        put(to,
            (const double[]){r->floor, r->ceiling, r->slab, r->ridge_at, r->slope_heights[0], r->slope_heights[1],
                             r->slope_heights[2]},
            7);
    }
}

static void put_lights(FILE *to, const struct plan *plan)
{
    for (int i = 0; i < plan->lamp_count; i++) {
        const struct plan_lamp *l = &plan->lamps[i];
        if (!l->file && l->scale[0] == 1 && l->scale[1] == 1 && l->scale[2] == 1) continue;
        fprintf(to, "lamp %d %s", i, l->file ? l->file : "");
        put(to, l->scale, 3);
        if (!l->file) continue;
        put(to, l->placed.at, 3);
        put(to, l->placed.aim, 3);
        put(to, l->placed.colour, 3);
        put(to, &l->placed.turn, 1);
    }
    for (int i = 0; i < plan->object_count; i++) {
        const struct plan_object *o = &plan->objects[i];
        const struct brdf *b = &o->placed.brdf;
        fprintf(to, "object %d %s %d", o->removed, o->file, (int)b->kind);
        put(to, o->placed.at, 3);
        put(to, o->placed.scale, 3);
        put(to, (const double[]){o->placed.turn, b->albedo.r, b->albedo.g, b->albedo.b, b->ks, b->shape}, 6);
    }
}

enum status plan_state(char **state, const struct plan *plan, struct err *err)
{
    struct memory_text m = {0};
    *state = NULL;
    if (memory_text_open(&m, "a plan as a text", err)) return err->status;
    FILE *to = m.to;
    put_walls(to, plan);
    put_openings(to, plan);
    put_rooms(to, plan);
    for (int i = 0; i < plan->box_count; i++) {
        const struct plan_box *b = &plan->boxes[i];
        fprintf(to, "box %d", b->removed);
        put(to, (const double[]){b->low[0], b->low[1], b->low[2], b->high[0], b->high[1], b->high[2], b->turn}, 7);
    }
    put(to, plan->colour, 3);
    fprintf(to, "base %s\n", plan->base ? plan->base : "");
    put_lights(to, plan);
    for (int i = 0; i < plan->thing_count; i++) {
        const struct plan_thing *t = &plan->things[i];
        fprintf(to, "thing %d", (int)t->state);
        put(to, (const double[]){t->by[0], t->by[1], t->by[2], t->turn}, 4);
    }
    fprintf(to, "wishes %d zones %d\n", plan->wish_count, plan->zone_count);
    if (!memory_text_close(&m, "a plan as a text", err)) *state = m.text;
    return err->status;
}
