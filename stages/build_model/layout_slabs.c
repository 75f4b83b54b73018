/* layout_slabs.c - floors, ceilings and boxes as convex solids.
 *
 * Floors and ceilings extend under the walls, to the middle of a wall between two rooms: they support the walls,
 * continue through doorways, and keep solids from touching in an edge alone. A slab is made of the convex parts of its
 * room's outline. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/math/numbers.h"
#include "stages/build_model/layout_shape.h"
#include "stages/build_model/room_parts.h"

enum {
    SLOT_SIDE = -16
}; /* SLOT_SIDE - i: label of a polygon's sides that are reveals of slot i, in part_corner's wall */

static const char *const SIDES[4] = {"left", "right", "front", "back"}; /* at -x, +x, -y, +y */

struct slab { /* a floor, or the part of a ceiling in one plane */
    struct solid_list *list;
    const struct plan *plan;
    const struct plan_room *room;
    enum verb opening;     /* of its openings: VERB_HATCH for a floor */
    const double *ceiling; /* its plane; NULL: a floor */
    struct err *err;
};

static void slab_sides(struct shape *s, const struct slab *b, const struct part_corner *c, int n)
{
    const struct plan *p = b->plan;
    for (int i = 0; i < n; i++) {
        const struct plan_line l = c[i].line;
        const struct plan_slot *slot = c[i].wall <= SLOT_SIDE ? &p->slots[SLOT_SIDE - c[i].wall] : NULL;
        if (slot)
            add_side(s, l.n[0], l.n[1], 0, l.c, "%s/%s/%s", verb_name(slot->kind), slot->name, SIDES[c[i].side]);
        else if (c[i].wall >= 0 && !p->walls[c[i].wall].removed)
            add_side(s, l.n[0], l.n[1], 0, l.c, "wall/%s/%s", p->walls[c[i].wall].name,
                     c[i].side == SIDE_IN ? "in" : "out");
        else
            add_side(s, l.n[0], l.n[1], 0, l.c, "%s/%s/side", b->ceiling ? "ceiling" : "floor", b->room->name);
    }
}

static enum status add_slab(void *ctx, const struct part_corner *c, int n)
{
    const struct slab *b = ctx;
    const struct plan_room *r = b->room;
    const double *l = b->ceiling;
    struct shape s = {0};
    slab_sides(&s, b, c, n);
    if (l) {
        add_side(&s, l[1], l[2], -1, -l[0], "ceiling/%s", r->name);
        add_side(&s, -l[1], -l[2], 1, l[0] + r->slab, "ceiling/%s/top", r->name);
    } else {
        add_side(&s, 0, 0, 1, r->floor, "floor/%s", r->name);
        add_side(&s, 0, 0, -1, r->slab - r->floor, "floor/%s/bottom", r->name);
    }
    return add_shape(b->list, BODY, &s, b->err);
}

/* The footprint of a slot, counter-clockwise; sides are labelled as its reveals. */
static void slot_outline(const struct plan *p, const struct plan_slot *o, struct part_corner c[4])
{
    static const int side[4] = {2, 1, 3, 0}; /* front, right, back, left */
    for (int i = 0; i < 4; i++) {
        const int axis = side[i] / 2, high = side[i] % 2;
        c[i] = (struct part_corner){.wall = SLOT_SIDE - (int)(o - p->slots), .side = side[i]};
        c[i].line.n[axis] = high ? 1 : -1;
        c[i].line.c = high ? o->high[axis] : -o->low[axis];
        c[i].p[0] = i == 0 || i == 1 ? o->high[0] : o->low[0];
        c[i].p[1] = i == 1 || i == 2 ? o->high[1] : o->low[1];
    }
}

/* Adds the slab within a convex polygon, without its openings. */
static enum status add_around_slots(struct slab *b, const struct part_corner *c, int n)
{
    const struct plan *p = b->plan;
    struct part_corner(*outlines)[4] = calloc((size_t)p->slot_count + 1, sizeof *outlines);
    struct room_part *slots = calloc((size_t)p->slot_count + 1, sizeof *slots);
    int count = 0;
    enum status st = outlines && slots ? ST_OK : err_nomem(b->err, "openings of a room", (size_t)p->slot_count);
    for (int i = 0; i < p->slot_count && !st; i++) {
        const struct plan_slot *o = &p->slots[i];
        if (&p->rooms[o->room] != b->room || o->kind != b->opening || !slot_is_there(p, o)) continue;
        slot_outline(p, o, outlines[count]);
        slots[count] = (struct room_part){outlines[count], 4};
        count++;
    }
    if (!st) st = parts_outside(c, n, slots, count, add_slab, b, b->err);
    free(outlines);
    free(slots);
    return st;
}

/* Adds the parts of a gable's ceiling on either side of the ridge, or the whole ceiling. */
static enum status add_ceiling(struct slab *b, const struct room_part *part)
{
    const struct plan_room *r = b->room;
    b->ceiling = r->lower.a[0];
    if (r->lower.count == 1) return add_around_slots(b, part->corners, part->count);
    struct part_corner *half = calloc((size_t)part->count + 2, sizeof *half);
    enum status st = half ? ST_OK : err_nomem(b->err, "a ceiling", (size_t)part->count * sizeof *half);
    for (int i = 0; i < 2 && !st; i++) {
        const struct part_corner ridge = {.line = i ? line_reversed(r->ridge) : r->ridge, .wall = PART_CUT};
        const int n = part_clip(half, part->corners, part->count, &ridge);
        b->ceiling = r->lower.a[i];
        if (n) st = add_around_slots(b, half, n);
    }
    free(half);
    return st;
}

enum status add_room(struct solid_list *list, const struct plan *p, const struct plan_room *r, struct err *err)
{
    enum status st = ST_OK;
    for (int i = 0; i < r->part_count && !st; i++) {
        struct slab floor = {list, p, r, VERB_HATCH, NULL, err}, ceiling = {list, p, r, VERB_SKYLIGHT, NULL, err};
        st = add_around_slots(&floor, r->parts[i].corners, r->parts[i].count);
        if (!st) st = add_ceiling(&ceiling, &r->parts[i]);
    }
    return st;
}

/* One part of what fills a slot: between two heights above `plane`, within its footprint and before the ridge. */
static enum status add_slot_part(struct solid_list *list, const struct plan *p, const struct plan_slot *o,
                                 const double plane[3], const double heights[2], const struct plan_line *ridge,
                                 struct err *err)
{
    const bool glass = o->fill == FILL_GLASS;
    const char *kind = glass ? "glass" : verb_name(o->kind), *leaf = glass ? "" : "leaf-";
    const bool above = o->kind == VERB_SKYLIGHT; /* the room is below a skylight, above a hatch */
    char body[NAME_SIZE];
    struct part_corner c[4];
    struct shape s = {0};
    snprintf(body, sizeof body, glass ? "glass/%s" : BODY "%.0s", o->name);
    add_side(&s, plane[1], plane[2], -1, -plane[0] - heights[0], "%s/%s/%s%s", kind, o->name, leaf,
             above ? "in" : "out");
    add_side(&s, -plane[1], -plane[2], 1, plane[0] + heights[1], "%s/%s/%s%s", kind, o->name, leaf,
             above ? "out" : "in");
    slot_outline(p, o, c);
    for (int i = 0; i < 4; i++)
        add_side(&s, c[i].line.n[0], c[i].line.n[1], 0, c[i].line.c, "%s/%s/%s", kind, o->name, SIDES[c[i].side]);
    if (ridge) add_side(&s, ridge->n[0], ridge->n[1], 0, ridge->c, "%s/%s/left", kind, o->name); /* inside */
    return add_shape(list, body, &s, err);
}

/* A skylight's glass or leaf is flush with the ceiling's upper face, a hatch's with the floor. */
enum status add_slot(struct solid_list *list, const struct plan *p, const struct plan_slot *o, struct err *err)
{
    const struct plan_room *r = &p->rooms[o->room];
    if (o->fill != FILL_LEAF && o->fill != FILL_GLASS) return ST_OK;
    if (o->kind == VERB_HATCH)
        return add_slot_part(list, p, o, (const double[3]){r->floor, 0, 0}, (const double[2]){-o->leaf, 0}, NULL, err);
    enum status st = ST_OK;
    for (int i = 0; i < r->lower.count && !st; i++) {
        const struct part_corner ridge = {.line = i ? line_reversed(r->ridge) : r->ridge, .wall = PART_CUT};
        struct part_corner c[4], half[6];
        slot_outline(p, o, c);
        const int n = r->lower.count == 1 ? 4 : part_clip(half, c, 4, &ridge);
        bool cut = false;
        for (int k = 0; k < n && r->lower.count > 1; k++) cut |= half[k].wall == PART_CUT;
        if (n)
            st = add_slot_part(list, p, o, r->lower.a[i], (const double[2]){r->slab - o->leaf, r->slab},
                               cut ? &ridge.line : NULL, err);
    }
    return st;
}

/* ------------------------------------------------------------------------------------------------------------ boxes */

enum status add_box(struct solid_list *list, const struct plan_box *b, struct err *err)
{
    static const char *const names[4] = {"left", "right", "front", "back"};
    const double turn = fmod(b->turn, 360) * DEGREE;
    double c = cos(turn), s = sin(turn);
    if (fmod(b->turn, 90) == 0) c = round(c), s = round(s);
    const double middle[2] = {0.5 * (b->low[0] + b->high[0]), 0.5 * (b->low[1] + b->high[1])};
    struct shape sh = {0};
    for (int k = 0; k < 4; k++) {
        const int axis = k / 2, out = k % 2 ? 1 : -1;
        const double n[2] = {axis ? -out * s : out * c, axis ? out * c : out * s};
        const double offset = b->turn == 0 ? (k % 2 ? b->high[axis] : -b->low[axis])
                                           : n[0] * middle[0] + n[1] * middle[1] + 0.5 * (b->high[axis] - b->low[axis]);
        add_side(&sh, n[0], n[1], 0, offset, "box/%s/%s", b->name, names[k]);
    }
    add_side(&sh, 0, 0, -1, -b->low[2], "box/%s/bottom", b->name);
    add_side(&sh, 0, 0, 1, b->high[2], "box/%s/top", b->name);
    return add_shape(list, BODY, &sh, err);
}
