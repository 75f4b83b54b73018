/* layout.c - lays out a plan as convex solids: walls (layout_walls.c), floors, ceilings and boxes (layout_slabs.c), and
 * here the leaves and panes of openings in walls. */
#include "stages/build_model/layout/layout.h"

#include <stdio.h>

#include "stages/build_model/layout/layout_shape.h"

/* There are rooms on both sides of the wall; *side: the side away from the room if there is one only. */
static bool between_rooms(const struct plan *plan, int wall, int *side)
{
    unsigned sides = 0;
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        for (int k = 0; !r->removed && k < r->wall_count; k++)
            if (r->walls[k] == wall) sides |= 1u << r->edges[r->edge_of[k]].side;
    }
    *side = sides == 1u << SIDE_OUT ? SIDE_IN : SIDE_OUT;
    return sides == 3;
}

bool layout_opening_filling(const struct plan *plan, const struct plan_opening *o, double off[2])
{
    const double t = plan->walls[o->wall].thickness;
    int side;
    if (o->fill != FILL_LEAF && o->fill != FILL_GLASS) return false;
    const bool inner = between_rooms(plan, o->wall, &side);
    const bool flush = o->kind == OPENING_WINDOW && o->fill == FILL_GLASS;
    if (flush && !o->refilled && (o->interior || inner)) return false;
    off[0] = !flush || inner ? 0.5 * t - 0.5 * o->leaf : side == SIDE_OUT ? t - o->leaf : 0;
    off[1] = !flush || inner ? 0.5 * t + 0.5 * o->leaf : side == SIDE_OUT ? t : o->leaf;
    return true;
}

/* The slab that fills an opening, from off[0] to off[1] behind the wall's in face. */
static enum status add_filling(struct solid_list *list, const struct plan *p, const struct plan_opening *o,
                               const double off[2], struct err *err)
{
    const struct plan_wall *w = &p->walls[o->wall];
    const struct plan_line in = plan_wall_face(w, SIDE_IN);
    const bool glass = o->fill == FILL_GLASS;
    const char *kind = glass ? "glass" : plan_opening_word(o->kind), *leaf = glass ? "" : "leaf-";
    char body[NAME_SIZE];
    struct shape s = {0};
    snprintf(body, sizeof body, glass ? "glass/%s" : BODY "%.0s", o->name);
    shape_add_side(&s, in.n[0], in.n[1], 0, in.c - off[0], "%s/%s/%sin", kind, o->name, leaf);
    shape_add_side(&s, -in.n[0], -in.n[1], 0, off[1] - in.c, "%s/%s/%sout", kind, o->name, leaf);
    for (int k = 0; k < 2; k++) {
        const double along = w->sign * (o->s[k] + w->origin), out = (k == 1) == (w->sign > 0) ? 1 : -1;
        shape_add_side(&s, out * w->d[0], out * w->d[1], 0, out * along, "%s/%s/%s", kind, o->name,
                       shape_reveal_side(w, k));
    }
    shape_add_side(&s, 0, 0, -1, -o->z[0], "%s/%s/sill", kind, o->name);
    shape_add_side(&s, 0, 0, 1, o->z[1], "%s/%s/head", kind, o->name);
    return shape_add(list, body, &s, err);
}

enum status layout_solids(struct solid_list *list, const struct plan *plan, struct err *err)
{
    *list = (struct solid_list){0};
    layout_add_walls(list, plan, err);
    for (int i = 0; i < plan->room_count && !err->status; i++)
        if (!plan->rooms[i].removed) layout_add_room(list, plan, &plan->rooms[i], err);
    for (int i = 0; i < plan->box_count && !err->status; i++)
        if (!plan->boxes[i].removed) layout_add_box(list, &plan->boxes[i], err);
    for (int i = 0; i < plan->opening_count && !err->status; i++) {
        const struct plan_opening *o = &plan->openings[i];
        double off[2];
        if (plan_opening_is_there(plan, o) && layout_opening_filling(plan, o, off))
            add_filling(list, plan, o, off, err);
    }
    for (int i = 0; i < plan->slot_count && !err->status; i++)
        if (plan_slot_is_there(plan, &plan->slots[i])) layout_add_slot(list, plan, &plan->slots[i], err);
    if (err->status) solid_list_release(list);
    return err->status;
}
