/* layout_slabs.c - floors, ceilings and boxes as convex solids.
 *
 * Floors and ceilings extend under the walls, to the middle of a wall between two rooms: they support the walls,
 * continue through doorways, and keep solids from touching in an edge alone. A slab is made of the convex parts of its
 * room's outline. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/math/numbers.h"
#include "stages/build_model/layout/layout_shape.h"
#include "stages/build_model/plan/room_parts.h"

enum {
    SLOT_SIDE = -16
}; /* SLOT_SIDE - i: label of a polygon's sides that are reveals of slot i, in part_corner's wall */

static const char *const SIDES[4] = {"left", "right", "front", "back"}; /* at -x, +x, -y, +y */

struct slab { /* a floor, or the part of a ceiling in one plane */
    struct solid_list *list;
    const struct plan *plan;
    const struct plan_room *room;
    enum opening_kind opening; /* of its openings: OPENING_HATCH for a floor */
    int plane;                 /* of the ceiling's lower face; -1: a floor */
    struct err *err;
};

static void slab_sides(struct shape *s, const struct slab *b, const struct part_corner *c, int n)
{
    const struct plan *p = b->plan;
    for (int i = 0; i < n; i++) {
        const struct plan_line l = c[i].line;
        const struct plan_slot *slot = c[i].wall <= SLOT_SIDE ? &p->slots[SLOT_SIDE - c[i].wall] : NULL;
        if (slot)
            shape_add_side(s, l.n[0], l.n[1], 0, l.c, "%s/%s/%s", plan_opening_word(slot->kind), slot->name,
                           SIDES[c[i].side]);
        else if (c[i].wall >= 0 && !p->walls[c[i].wall].removed)
            shape_add_side(s, l.n[0], l.n[1], 0, l.c, "wall/%s/%s", p->walls[c[i].wall].name,
                           c[i].side == SIDE_IN ? "in" : "out");
        else
            shape_add_side(s, l.n[0], l.n[1], 0, l.c, "%s/%s/side", b->plane >= 0 ? "ceiling" : "floor", b->room->name);
    }
}

/* Whether the top's plane is its lower one somewhere over a polygon. If its planes coincide there, the first is. */
static bool is_lower(const struct plan_top *top, int plane, const struct part_corner *c, int n)
{
    bool lower[2] = {false, false};
    for (int i = 0; i < n && top->count > 1; i++) {
        double z[2];
        for (int k = 0; k < 2; k++) z[k] = top->a[k][0] + top->a[k][1] * c[i].p[0] + top->a[k][2] * c[i].p[1];
        for (int k = 0; k < 2; k++) lower[k] |= z[k] < z[!k] - PART_EPS;
    }
    return lower[plane] || (plane == 0 && !lower[1]);
}

/* The half-space above (down: below) `by` above a plane of the top. */
static void add_plane(struct shape *s, const double plane[3], double by, bool down, const char *name)
{
    const double sign = down ? 1 : -1;
    shape_add_side(s, -sign * plane[1], -sign * plane[2], sign, sign * (plane[0] + by), "%s", name);
}

/* Adds a slab over a polygon. One of a gable's two planes begins at that plane and ends below the upper faces of both:
 * together they are all that lies between the lower and the upper faces, and the ridge is where the planes cross. */
static enum status add_slab(void *ctx, const struct part_corner *c, int n)
{
    const struct slab *b = ctx;
    const struct plan_room *r = b->room;
    struct shape s = {0};
    if (b->plane >= 0 && !is_lower(&r->lower, b->plane, c, n)) return ST_OK;
    slab_sides(&s, b, c, n);
    if (b->plane >= 0) {
        char lower[NAME_SIZE], upper[NAME_SIZE];
        snprintf(lower, sizeof lower, "ceiling/%s", r->name);
        snprintf(upper, sizeof upper, "ceiling/%s/top", r->name);
        add_plane(&s, r->lower.a[b->plane], 0, false, lower);
        for (int i = 0; i < r->lower.count; i++) add_plane(&s, r->lower.a[i], r->slab, true, upper);
    } else {
        shape_add_side(&s, 0, 0, 1, r->floor, "floor/%s", r->name);
        shape_add_side(&s, 0, 0, -1, r->slab - r->floor, "floor/%s/bottom", r->name);
    }
    return shape_add(b->list, BODY, &s, b->err);
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
    if (!outlines || !slots) err_nomem(b->err, "openings of a room", (size_t)p->slot_count);
    for (int i = 0; i < p->slot_count && !b->err->status; i++) {
        const struct plan_slot *o = &p->slots[i];
        if (&p->rooms[o->room] != b->room || o->kind != b->opening || !plan_slot_is_there(p, o)) continue;
        slot_outline(p, o, outlines[count]);
        slots[count] = (struct room_part){outlines[count], 4};
        count++;
    }
    if (!b->err->status) parts_outside(c, n, slots, count, add_slab, b, b->err);
    free(outlines);
    free(slots);
    return b->err->status;
}

enum status layout_add_room(struct solid_list *list, const struct plan *p, const struct plan_room *r, struct err *err)
{
    for (int i = 0; i < r->part_count && !err->status; i++)
        for (int plane = -1; plane < r->lower.count && !err->status; plane++) {
            struct slab b = {list, p, r, plane < 0 ? OPENING_HATCH : OPENING_SKYLIGHT, plane, err};
            add_around_slots(&b, r->parts[i].corners, r->parts[i].count);
        }
    return err->status;
}

/* Adds one solid of what fills a slot, within its footprint: between two heights above the plane of `top`, and below
 * the same height above its other plane. */
static enum status add_slot_part(struct solid_list *list, const struct plan *p, const struct plan_slot *o,
                                 const struct plan_top *top, int plane, const double heights[2], struct err *err)
{
    const bool glass = o->fill == FILL_GLASS;
    const char *kind = glass ? "glass" : plan_opening_word(o->kind), *leaf = glass ? "" : "leaf-";
    const bool above = o->kind == OPENING_SKYLIGHT; /* the room is below a skylight, above a hatch */
    char body[NAME_SIZE], faces[2][NAME_SIZE];
    struct part_corner c[4];
    struct shape s = {0};
    slot_outline(p, o, c);
    if (!is_lower(top, plane, c, 4)) return ST_OK;
    snprintf(body, sizeof body, glass ? "glass/%s" : BODY "%.0s", o->name);
    for (int i = 0; i < 2; i++)
        snprintf(faces[i], sizeof faces[i], "%s/%s/%s%s", kind, o->name, leaf, (i == 0) == above ? "in" : "out");
    add_plane(&s, top->a[plane], heights[0], false, faces[0]);
    for (int i = 0; i < top->count; i++) add_plane(&s, top->a[i], heights[1], true, faces[1]);
    for (int i = 0; i < 4; i++)
        shape_add_side(&s, c[i].line.n[0], c[i].line.n[1], 0, c[i].line.c, "%s/%s/%s", kind, o->name, SIDES[c[i].side]);
    return shape_add(list, body, &s, err);
}

/* A skylight's glass or leaf is flush with the ceiling's upper face, a hatch's with the floor. */
enum status layout_add_slot(struct solid_list *list, const struct plan *p, const struct plan_slot *o, struct err *err)
{
    const struct plan_room *r = &p->rooms[o->room];
    const struct plan_top floor = plan_level_top(r->floor), *top = o->kind == OPENING_HATCH ? &floor : &r->lower;
    const double upper = o->kind == OPENING_HATCH ? 0 : r->slab, heights[2] = {upper - o->leaf, upper};
    if (o->fill != FILL_LEAF && o->fill != FILL_GLASS) return ST_OK;
    for (int i = 0; i < top->count && !err->status; i++) add_slot_part(list, p, o, top, i, heights, err);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ boxes */

enum status layout_add_box(struct solid_list *list, const struct plan_box *b, struct err *err)
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
        shape_add_side(&sh, n[0], n[1], 0, offset, "box/%s/%s", b->name, names[k]);
    }
    shape_add_side(&sh, 0, 0, -1, -b->low[2], "box/%s/bottom", b->name);
    shape_add_side(&sh, 0, 0, 1, b->high[2], "box/%s/top", b->name);
    return shape_add(list, BODY, &sh, err);
}
