/* plan_openings.c - statements that make openings in walls, ceilings and floors, and boxes; their places.
 *
 * A rectangle in a photograph is the intersection of the rays through its corners with the face of the wall, the
 * ceiling or the floor that the camera sees. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

enum status plan_fill_thickness(struct plan_context *c, enum filling fill, double *thickness)
{
    *thickness = 0;
    if (fill != FILL_LEAF && fill != FILL_GLASS) return ST_OK;
    *thickness = plan_use_default(c, fill == FILL_GLASS ? DEFAULT_GLASS : DEFAULT_LEAF);
    if (*thickness > 0) return ST_OK;
    return plan_statement_error(c, "the thickness of %s is unknown without a scale; write \"set %s NUMBER\" before.",
                                fill == FILL_GLASS ? "glass" : "a door's leaf", fill == FILL_GLASS ? "glass" : "leaf");
}

/* Measured from an end of the wall, where its neighbour's near face is; left and right as seen from its inside. */
static enum status place_from_end(struct plan_context *c, int wall, double s[2], double z[2])
{
    const struct plan_wall *w = &c->plan->walls[wall];
    const double *a = c->s->place.a;
    double span[2];
    if (!(a[1] >= MIN_SIZE)) return plan_statement_error(c, "found the width %.9g, wanted %g or more.", a[1], MIN_SIZE);
    plan_wall_span(c->plan, wall, span);
    /* the start is at the left */
    const bool from_high = c->s->place.right == (w->sign > 0);
    s[0] = from_high ? span[1] - a[0] - a[1] : span[0] + a[0];
    s[1] = from_high ? span[1] - a[0] : span[0] + a[0] + a[1];
    z[0] = fmin(a[2], a[3]);
    z[1] = fmax(a[2], a[3]);
    return ST_OK;
}

enum status plan_place_on_wall(struct plan_context *c, int wall, double s[2], double z[2])
{
    const struct script_place *p = &c->s->place;
    const struct plan_wall *w = &c->plan->walls[wall];
    if (p->kind == PLACE_FROM_END) return place_from_end(c, wall, s, z);
    if (p->kind == PLACE_COORDINATES) {
        s[0] = fmin(p->a[0], p->a[2]);
        s[1] = fmax(p->a[0], p->a[2]);
        z[0] = fmin(p->a[1], p->a[3]);
        z[1] = fmax(p->a[1], p->a[3]);
        return ST_OK;
    }
    /* the camera sees one of the faces: from behind, a ray meets the in face from the wrong side */
    struct vec3 corners[2];
    const struct plan_line in = plan_wall_face(w, SIDE_IN), out = plan_wall_face(w, SIDE_OUT);
    struct err first = ERR_INIT;
    if (place_corners(corners, c->placer, p, vec3_make(in.n[0], in.n[1], 0), in.c, c->path, c->s->line, &first)) {
        struct err second = ERR_INIT;
        if (place_corners(corners, c->placer, p, vec3_make(out.n[0], out.n[1], 0), out.c, c->path, c->s->line, &second))
            return err_set(c->err, first.status, "%s", first.text);
    }
    for (int i = 0; i < 2; i++) {
        const double at[2] = {corners[i].x, corners[i].y};
        s[i] = plan_wall_s(w, at);
        z[i] = corners[i].z;
    }
    if (s[0] > s[1]) {
        const double t = s[0];
        s[0] = s[1];
        s[1] = t;
    }
    if (z[0] > z[1]) {
        const double t = z[0];
        z[0] = z[1];
        z[1] = t;
    }
    return ST_OK;
}

void plan_set_foot_on_floor(const struct plan_context *c, const struct plan_wall *w, enum opening_kind kind,
                            double z[2])
{
    if (kind != OPENING_WINDOW && c->s->place.kind == PLACE_VIEW) z[0] = w->foot;
}

/* NAME on WHAT PLACE */
static enum status read_on(struct script_reader *r, struct statement *s, const char *what)
{
    return script_read_name(r, "a name", &s->name) || script_expect(r, "on") || script_read_name(r, what, &s->other) ||
                   script_read_place(r, &s->place, 1u << PLACE_FROM_END)
               ? r->err->status
               : ST_OK;
}

enum status plan_read_opening(struct script_reader *r, struct statement *s) { return read_on(r, s, "a wall"); }

static enum status add_opening(struct plan_context *c, enum opening_kind kind, enum filling fill)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_opening o = {.line = s->line, .kind = kind, .interior = s->has_option[OPTION_INTERIOR], .fill = fill};
    if (plan_find_wall(c, s->other, &o.wall) || plan_place_on_wall(c, o.wall, o.s, o.z)) return c->err->status;
    plan_set_foot_on_floor(c, &p->walls[o.wall], kind, o.z);
    if (plan_fill_thickness(c, o.fill, &o.leaf) || plan_copy_new_name(c, s->name, &o.name)) return c->err->status;
    if (array_append(&p->openings, (size_t)p->opening_count, sizeof o, "openings", c->err)) {
        free(o.name);
        return c->err->status;
    }
    p->openings[p->opening_count++] = o;
    return plan_add_name(p, o.name, NAMED_OPENING, p->opening_count - 1, c->err);
}

enum status plan_apply_door(struct plan_context *c)
{
    return add_opening(c, OPENING_DOOR, c->s->has_option[OPTION_CLOSED] ? FILL_LEAF : FILL_NOTHING);
}

enum status plan_apply_passage(struct plan_context *c) { return add_opening(c, OPENING_PASSAGE, FILL_NOTHING); }

enum status plan_apply_window(struct plan_context *c)
{
    return add_opening(c, OPENING_WINDOW, c->s->has_option[OPTION_OPEN] ? FILL_NOTHING : FILL_GLASS);
}

/* ---------------------------------------------------------------------------------------------- ceilings and floors */

/* A footprint in the plane z = a[0] + a[1] x + a[2] y, where a photograph shows it. */
static enum status place_in_plane(struct plan_context *c, const double plane[3], double low[2], double high[2])
{
    const struct script_place *p = &c->s->place;
    double a[4];
    if (p->kind == PLACE_FROM_END)
        return plan_statement_error(c, "%s is in no wall; give its place by coordinates or in a view.", c->s->name);
    memcpy(a, p->a, sizeof a);
    if (p->kind == PLACE_VIEW) {
        struct vec3 corners[2];
        struct err above = ERR_INIT; /* seen from above, or from below, as a beam is */
        const double length = sqrt(1 + plane[1] * plane[1] + plane[2] * plane[2]);
        const struct vec3 up = vec3_scale(vec3_make(-plane[1], -plane[2], 1), 1 / length);
        const double d = plane[0] / length;
        if (place_corners(corners, c->placer, p, up, d, c->path, c->s->line, &above) &&
            place_corners(corners, c->placer, p, vec3_scale(up, -1), -d, c->path, c->s->line, c->err))
            return c->err->status;
        for (int i = 0; i < 2; i++) {
            a[2 * i] = corners[i].x;
            a[2 * i + 1] = corners[i].y;
        }
    }
    for (int k = 0; k < 2; k++) {
        low[k] = fmin(a[k], a[2 + k]);
        high[k] = fmax(a[k], a[2 + k]);
    }
    return ST_OK;
}

enum status plan_place_footprint(struct plan_context *c, double at, double low[2], double high[2])
{
    return place_in_plane(c, (const double[3]){at, 0, 0}, low, high);
}

enum status plan_place_in_room(struct plan_context *c, const struct plan_room *r, enum opening_kind kind, double low[2],
                               double high[2])
{
    if (kind == OPENING_HATCH) return plan_place_footprint(c, r->floor, low, high);
    /* of a gable's planes, the one in which the footprint's middle is on the ceiling */
    for (int i = 0; i < r->lower.count && !c->err->status; i++) {
        place_in_plane(c, r->lower.a[i], low, high);
        const double middle[2] = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
        const struct plan_top one = {{{r->lower.a[i][0], r->lower.a[i][1], r->lower.a[i][2]}}, 1};
        if (!c->err->status && plan_top_at(&one, middle) <= plan_top_at(&r->lower, middle) + LENGTH_EPS) break;
    }
    return c->err->status;
}

enum status plan_read_slot(struct script_reader *r, struct statement *s) { return read_on(r, s, "a room"); }

static enum status add_slot(struct plan_context *c, enum opening_kind kind, enum filling fill)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_slot slot = {.line = s->line, .kind = kind, .fill = fill};
    if (plan_find_room(c, s->other, &slot.room) ||
        plan_place_in_room(c, &p->rooms[slot.room], kind, slot.low, slot.high) ||
        plan_fill_thickness(c, slot.fill, &slot.leaf) || plan_copy_new_name(c, s->name, &slot.name))
        return c->err->status;
    if (array_append(&p->slots, (size_t)p->slot_count, sizeof slot, "openings in rooms", c->err)) {
        free(slot.name);
        return c->err->status;
    }
    p->slots[p->slot_count++] = slot;
    return plan_add_name(p, slot.name, NAMED_SLOT, p->slot_count - 1, c->err);
}

enum status plan_apply_skylight(struct plan_context *c)
{
    return add_slot(c, OPENING_SKYLIGHT, c->s->has_option[OPTION_OPEN] ? FILL_NOTHING : FILL_GLASS);
}

enum status plan_apply_hatch(struct plan_context *c)
{
    return add_slot(c, OPENING_HATCH, c->s->has_option[OPTION_CLOSED] ? FILL_LEAF : FILL_NOTHING);
}

/* ------------------------------------------------------------------------------------------------------------ boxes */

enum status plan_read_box(struct script_reader *r, struct statement *s)
{
    return script_read_name(r, "a name", &s->name) || script_read_place(r, &s->place, 0) ? r->err->status : ST_OK;
}

enum status plan_apply_box(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_box b = {.line = s->line, .turn = s->has_option[OPTION_TURN] ? s->options[OPTION_TURN] : 0};
    b.low[2] = plan_option_or_default(c, OPTION_FOOT, DEFAULT_FLOOR);
    b.high[2] = plan_option_or_default(c, OPTION_TOP, DEFAULT_CEILING);
    if (!s->has_option[OPTION_TOP] && p->ceiling == 0)
        return plan_statement_error(
            c, "box %s has no top, because no ceiling was found; add \"top NUMBER\" to the line.", s->name);
    const double at = s->has_option[OPTION_AT] ? s->options[OPTION_AT] : b.low[2];
    if (plan_place_footprint(c, at, b.low, b.high) || plan_copy_new_name(c, s->name, &b.name)) return c->err->status;
    if (array_append(&p->boxes, (size_t)p->box_count, sizeof b, "boxes", c->err)) {
        free(b.name);
        return c->err->status;
    }
    p->boxes[p->box_count++] = b;
    return plan_add_name(p, b.name, NAMED_BOX, p->box_count - 1, c->err);
}
