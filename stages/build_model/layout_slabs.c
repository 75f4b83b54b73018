/* layout_slabs.c - floors, ceilings and boxes as convex solids.
 *
 * Floors and ceilings extend under the walls, to the middle of a wall between two rooms: they support the walls,
 * continue through doorways, and keep solids from touching in an edge alone. A slab is made of the convex parts of its
 * room's outline. */
#include <math.h>

#include "common/math/numbers.h"
#include "stages/build_model/layout_shape.h"
#include "stages/build_model/room_parts.h"

struct slabs {
    struct solid_list *list;
    const struct plan *plan;
    const struct plan_room *room;
    struct err *err;
};

static void slab_sides(struct shape *s, const struct slabs *b, const struct part_corner *c, int n, const char *what)
{
    const struct plan *p = b->plan;
    for (int i = 0; i < n; i++)
        if (c[i].wall >= 0 && !p->walls[c[i].wall].removed)
            add_side(s, c[i].line.n[0], c[i].line.n[1], 0, c[i].line.c, "wall/%s/%s", p->walls[c[i].wall].name,
                     c[i].side == SIDE_IN ? "in" : "out");
        else
            add_side(s, c[i].line.n[0], c[i].line.n[1], 0, c[i].line.c, "%s/%s/side", what, b->room->name);
}

static enum status add_floor(const struct slabs *b, const struct part_corner *c, int n)
{
    const struct plan_room *r = b->room;
    struct shape s = {0};
    slab_sides(&s, b, c, n, "floor");
    add_side(&s, 0, 0, 1, r->floor, "floor/%s", r->name);
    add_side(&s, 0, 0, -1, r->slab - r->floor, "floor/%s/bottom", r->name);
    return add_shape(b->list, BODY, &s, b->err);
}

static enum status add_ceiling(const struct slabs *b, const struct part_corner *c, int n, int plane)
{
    const struct plan_room *r = b->room;
    const double *l = r->lower.a[plane];
    struct shape s = {0};
    slab_sides(&s, b, c, n, "ceiling");
    add_side(&s, l[1], l[2], -1, -l[0], "ceiling/%s", r->name);
    add_side(&s, -l[1], -l[2], 1, l[0] + r->slab, "ceiling/%s/top", r->name);
    return add_shape(b->list, BODY, &s, b->err);
}

enum status add_room(struct solid_list *list, const struct plan *p, const struct plan_room *r, struct err *err)
{
    const struct slabs b = {list, p, r, err};
    enum status st = ST_OK;
    for (int i = 0; i < r->part_count && !st; i++) {
        st = add_floor(&b, r->parts[i].corners, r->parts[i].count);
        if (!st) st = add_ceiling(&b, r->parts[i].corners, r->parts[i].count, 0);
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
