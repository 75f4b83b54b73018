/* plan_walls.c - statements that make walls.
 *
 * A wall is a line with a direction, from left to right for a viewer inside the room; its in face is on the line. Ways
 * to place it: two points, a rectangle on a photograph with points of the wall (place.c), the line where it meets the
 * floor or the ceiling in a photograph (place_line.c), or parallel to another wall at a distance between two walls.
 * Walls run along an axis unless they are `angled`, because most do, and because a slip of the hand would otherwise
 * tilt a wall by a little.
 *
 * A chain of corners places several walls at once. The corners are on the floor, so each has a place by itself and each
 * may be of another photograph. Two of them give the line of a wall; consecutive lines are intersected, so that every
 * wall is straight along its axis and a corner that was clicked badly is corrected by its neighbours. The inside of a
 * closed chain is within it; an open one has its inside where the cameras stand.
 *
 * S, the coordinate along a wall, is x or y of the model for a wall along an axis, whichever way it runs, and the
 * distance from its first point for an angled one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "stages/build_model/plan/plan_checks.h"
#include "stages/build_model/script/script_words.h"

static enum status set_wall_line(struct plan_context *c, struct plan_wall *w, const double a[2], const double b[2])
{
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > LENGTH_EPS)) return plan_statement_error(c, "wall %s would have no length.", w->name);
    w->d[0] = (b[0] - a[0]) / length;
    w->d[1] = (b[1] - a[1]) / length;
    if (!w->angled) {
        const int axis = fabs(w->d[1]) > fabs(w->d[0]);
        if (fabs(w->d[!axis]) * length > LENGTH_EPS)
            return plan_statement_error(
                c,
                "wall %s from %.9g %.9g to %.9g %.9g is not along an axis; add the word angled if that is "
                "intended.",
                w->name, a[0], a[1], b[0], b[1]);
        w->d[axis] = w->d[axis] > 0 ? 1 : -1;
        w->d[!axis] = 0;
        w->sign = (int)w->d[axis];
        w->origin = 0;
    } else {
        w->sign = 1;
        w->origin = w->d[0] * a[0] + w->d[1] * a[1];
    }
    w->c = w->d[1] * a[0] - w->d[0] * a[1];
    w->ends[END_START] = (struct wall_end){FREE_END, plan_wall_s(w, a), -1};
    w->ends[END_END] = (struct wall_end){FREE_END, plan_wall_s(w, b), -1};
    return ST_OK;
}

/* A wall parallel to another one, in front of it by the statement's distance, facing the same way, which meets the
 * walls at its two ends. */
static enum status place_parallel_wall(struct plan_context *c, struct plan_wall *w)
{
    const struct script_place *place = &c->s->place;
    int other, ends[2];
    double p[2][2];
    if (plan_find_wall(c, place->wall, &other)) return c->err->status;
    const struct plan_wall *o = &c->plan->walls[other];
    memcpy(w->d, o->d, sizeof w->d);
    w->c = o->c + place->a[0];
    w->sign = o->sign;
    w->origin = o->origin;
    w->angled = o->angled;
    for (int i = 0; i < 2; i++) {
        if (plan_find_wall(c, place->between[i], &ends[i])) return c->err->status;
        const struct plan_wall *e = &c->plan->walls[ends[i]];
        if (!(fabs(w->d[0] * e->d[1] - w->d[1] * e->d[0]) > PARALLEL_SINE) ||
            !plan_line_cross(plan_wall_face(w, SIDE_IN), plan_wall_face(e, SIDE_IN), p[i]))
            return plan_statement_error(c, "wall %s cannot end at wall %s: it is parallel to that, or nearly so.",
                                        c->s->name, place->between[i]);
    }
    if (ends[0] == ends[1])
        return plan_statement_error(c, "wall %s lies between wall %s and itself; name a wall for each of its ends.",
                                    c->s->name, place->between[0]);
    const double along = w->d[0] * (p[1][0] - p[0][0]) + w->d[1] * (p[1][1] - p[0][1]);
    w->ends[END_START] = (struct wall_end){MEET_END, 0, ends[along < 0]};
    w->ends[END_END] = (struct wall_end){MEET_END, 0, ends[along >= 0]};
    return ST_OK;
}

/* The wall's line n p = at, from the place on it that is nearest to a to that of b. d: its direction. */
static enum status set_placed_line(struct plan_context *c, struct plan_wall *w, const double d[2], double at,
                                   const double a[2], const double b[2])
{
    const double *const from[2] = {a, b};
    double ends[2][2];
    for (int i = 0; i < 2; i++) {
        const double t = d[0] * from[i][0] + d[1] * from[i][1];
        ends[i][0] = d[0] * t + d[1] * at;
        ends[i][1] = d[1] * t - d[0] * at;
    }
    if (set_wall_line(c, w, ends[0], ends[1])) return c->err->status;
    if (d[0] * w->d[0] + d[1] * w->d[1] > 0) memcpy(w->d, d, sizeof w->d);
    w->c = at;
    return ST_OK;
}

/* The direction that the statement gives, if any: of an axis or of a wall. *angled: it is not that of an axis. */
static enum status given_direction(struct plan_context *c, double d[2], const double **given, bool *angled)
{
    const char *along = c->s->place.along;
    int other;
    *given = along ? d : NULL;
    if (!along) return ST_OK;
    if (*angled)
        return plan_statement_error(c,
                                    "found both angled and along %s; along gives the wall's direction, so leave out "
                                    "angled.",
                                    along);
    d[0] = !strcmp(along, "x");
    d[1] = !strcmp(along, "y");
    if (d[0] + d[1] > 0) return ST_OK;
    if (plan_find_wall(c, along, &other)) return c->err->status;
    memcpy(d, c->plan->walls[other].d, sizeof c->plan->walls[other].d);
    *angled = c->plan->walls[other].angled;
    return ST_OK;
}

static enum status too_much_turned(struct plan_context *c, const char *wall, const struct placed_line *line,
                                   const struct placed_corner *start, const struct placed_corner *end, bool given)
{
    return plan_statement_error(
        c,
        "wall %s: from pixel %.9g %.9g of %s to %.9g %.9g of %s the line runs %.1f degrees off %s, and clicks that are "
        "%g px off explain %.1f; %s.",
        wall, start->x, start->y, start->view, end->x, end->y, end->view, line->turn,
        given ? "the wall's direction" : "the nearest axis", c->placer->params->click, line->turn_error,
        given
            ? "check the pixels and the direction"
            : "check the pixels, add the word angled if the wall is not along an axis, or give its direction (along x, "
              "along y, along WALL)");
}

static void note_line(const char *wall, const struct placed_line *line, const char *how)
{
    log_note("wall %s: by %s, %.2g degrees off its direction, of which clicks explain %.2g; they move it by %.2g", wall,
             how, line->turn, line->turn_error, line->error);
}

/* The side of the wall on which the camera stands: above 0 to the right of the direction from a to b. */
static double camera_side(const struct placed_corner *a, const struct placed_corner *b, const double camera[2])
{
    return (b->p[1] - a->p[1]) * (camera[0] - a->p[0]) - (b->p[0] - a->p[0]) * (camera[1] - a->p[1]);
}

enum status plan_place_line(struct plan_context *c, const char *wall, double z, const double along[2], bool is_free,
                            struct placed_line *line)
{
    const struct script_place *place = &c->s->place;
    const enum place_level level = place->kind == PLACE_TOP ? PLACE_ON_CEILING : PLACE_ON_FLOOR;
    struct placed_corner q[2];
    for (int i = 0; i < 2; i++) {
        const struct script_corner pixel = {place->view, place->a[2 * i], place->a[2 * i + 1]};
        if (place_corner(&q[i], c->placer, &pixel, z, level, c->path, c->s->line, c->err)) return c->err->status;
    }
    const bool swapped = camera_side(&q[0], &q[1], q[0].camera) < 0;
    const struct placed_corner *start = &q[swapped], *end = &q[!swapped];
    if (place_line(line, c->placer, start, end, along, is_free, c->path, c->s->line, c->err)) return c->err->status;
    if (!(line->d[1] * start->camera[0] - line->d[0] * start->camera[1] - line->c > LENGTH_EPS))
        return plan_statement_error(
            c,
            "wall %s: the camera of %s does not stand in front of the line from pixel %.9g %.9g "
            "to %.9g %.9g; draw it in a photo that shows the wall less from the side.",
            wall, place->view, place->a[0], place->a[1], place->a[2], place->a[3]);
    if (line->turn > line->max_turn) return too_much_turned(c, wall, line, &q[0], &q[1], along);
    note_line(wall, line, place->kind == PLACE_TOP ? "its line at the ceiling" : "its line at the floor");
    return ST_OK;
}

static enum status place_new_wall(struct plan_context *c, struct plan_wall *w)
{
    const struct statement *s = c->s;
    double direction[2];
    const double *given;
    if (s->place.kind == PLACE_PARALLEL) return place_parallel_wall(c, w);
    if (s->place.kind == PLACE_COORDINATES) return set_wall_line(c, w, s->place.a, s->place.a + 2);
    const bool is_free = w->angled;
    if (given_direction(c, direction, &given, &w->angled)) return c->err->status;
    if (s->place.kind != PLACE_VIEW) {
        struct placed_line line;
        if (plan_place_line(c, s->name, s->place.kind == PLACE_TOP ? w->top : w->foot, given, is_free, &line))
            return c->err->status;
        return set_placed_line(c, w, line.d, line.c, line.ends[0], line.ends[1]);
    }
    struct placed_wall placed;
    const struct place_direction wanted = {.along = given, .is_free = is_free};
    if (place_wall(&placed, c->placer, &s->place, &wanted, c->path, s->line, c->err)) return c->err->status;
    /* left to right for a viewer looking against n: n turned by 90 degrees counter-clockwise */
    const double d[2] = {-placed.n[1], placed.n[0]};
    if (set_placed_line(c, w, d, placed.c, placed.ends[0], placed.ends[1])) return c->err->status;
    log_note("wall %s: %zu points, median distance from the wall %.3g", s->name, placed.points, placed.spread);
    return ST_OK;
}

enum status plan_read_wall(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name) ||
        script_read_place(r, &s->place, 1u << PLACE_PARALLEL | 1u << PLACE_FOOT | 1u << PLACE_TOP))
        return r->err->status;
    s->by_points = s->place.kind == PLACE_VIEW;
    return s->place.view ? script_read_along(r, &s->place) : ST_OK;
}

/* A wall with the statement's thickness and heights, or the defaults. The caller frees the name, or adds the wall. */
static enum status begin_wall(struct plan_context *c, struct plan_wall *w, const char *name)
{
    const struct statement *s = c->s;
    *w = (struct plan_wall){.line = s->line, .angled = s->has_option[OPTION_ANGLED]};
    w->thickness = plan_option_or_default(c, OPTION_THICKNESS, DEFAULT_THICKNESS);
    w->foot = plan_option_or_default(c, OPTION_FOOT, DEFAULT_FLOOR);
    w->top = plan_option_or_default(c, OPTION_TOP, DEFAULT_CEILING);
    w->has_top = s->has_option[OPTION_TOP];
    if (!s->has_option[OPTION_THICKNESS] && w->thickness == 0)
        return plan_statement_error(
            c, "the thickness of walls is unknown without a scale; write \"set thickness NUMBER\" before.");
    if (!w->has_top && w->top == 0)
        return plan_statement_error(c, "no ceiling was found; write \"set ceiling NUMBER\" before.");
    if (plan_check_length(c, "thickness", w->thickness)) return c->err->status;
    if (!(w->top - w->foot >= MIN_SIZE))
        return plan_statement_error(c, "wall %s goes from %.9g up to %.9g, wanted a top above its foot.", name, w->foot,
                                    w->top);
    return plan_copy_new_name(c, name, &w->name);
}

static enum status add_wall(struct plan_context *c, const struct plan_wall *w)
{
    struct plan *p = c->plan;
    if (array_append(&p->walls, (size_t)p->wall_count, sizeof *w, "walls", c->err)) return c->err->status;
    p->walls[p->wall_count++] = *w;
    return plan_add_name(p, w->name, NAMED_WALL, p->wall_count - 1, c->err);
}

enum status plan_apply_wall(struct plan_context *c)
{
    struct plan_wall w;
    const int before = c->plan->wall_count;
    if (!begin_wall(c, &w, c->s->name) && !place_new_wall(c, &w)) add_wall(c, &w);
    if (c->plan->wall_count == before) free(w.name);
    return c->err->status;
}

/* ---------------------------------------------------------------------------------------------- chains of corners */

struct chain {
    const struct statement *s;
    struct placed_corner *corners;
    struct placed_line *lines; /* of the walls, from corner to corner as they are written */
    bool *angled;              /* of the walls */
    double (*ends)[2];         /* the corners as the walls meet there */
    int corner_count, wall_count;
    bool closed;
    bool left; /* the room is to the left of the chain's direction */
};

enum status plan_read_walls(struct script_reader *r, struct statement *s)
{
    while (textfile_more(&r->t) && !script_next_is(r, "corner")) {
        if (array_append(&s->names, (size_t)s->name_count, sizeof *s->names, "names of walls", r->err) ||
            script_read_name(r, "a name", &s->names[s->name_count]))
            return r->err->status;
        s->name_count++;
    }
    if (!s->name_count) return script_usage_error(r, NULL);
    return script_read_corners(r, s);
}

/* ST_DATA: `what` is wrong at a corner of the chain. */
static enum status corner_error(struct plan_context *c, const struct placed_corner *q, const char *what)
{
    return plan_statement_error(c, "the corner at pixel %.9g %.9g of %s: %s", q->x, q->y, q->view, what);
}

static enum status count_corners(struct plan_context *c, const struct chain *k)
{
    if (k->closed && k->corner_count < 3)
        return plan_statement_error(c, "found %d corners, wanted 3 or more to close a room.", k->corner_count);
    if (k->wall_count == k->s->name_count) return ST_OK;
    return plan_statement_error(c,
                                "found %d names and %d corners, wanted a name for each wall from one corner to the "
                                "next: %d%s.",
                                k->s->name_count, k->corner_count, k->wall_count,
                                k->closed || k->s->name_count != k->corner_count
                                    ? ""
                                    : ", or the word closed for a wall from the last corner to the first");
}

static enum status place_chain_corners(struct plan_context *c, struct chain *k)
{
    const double z = plan_option_or_default(c, OPTION_FOOT, DEFAULT_FLOOR);
    for (int i = 0; i < k->corner_count; i++) {
        struct placed_corner *q = &k->corners[i];
        if (place_corner(q, c->placer, &k->s->corners[i], z, PLACE_ON_FLOOR, c->path, c->s->line, c->err))
            return c->err->status;
    }
    return ST_OK;
}

/* On which side of the chain the room is: of a closed one inside; else where most cameras stand that show both corners
 * of a wall. */
static enum status find_side(struct plan_context *c, struct chain *k)
{
    double sum = 0;
    for (int i = 0; i < k->wall_count; i++) {
        const struct placed_corner *a = &k->corners[i], *b = &k->corners[(i + 1) % k->corner_count];
        if (k->closed)
            sum -= a->p[0] * b->p[1] - a->p[1] * b->p[0];
        else
            sum += (camera_side(a, b, a->camera) > 0 ? 1 : -1) + (camera_side(a, b, b->camera) > 0 ? 1 : -1);
    }
    k->left = sum < 0;
    if (sum != 0) return ST_OK;
    return plan_statement_error(c,
                                "the cameras of these corners stand on both sides of the walls, so it is unknown which "
                                "side is the inside; mark the corners of one room in photos from inside it.");
}

static enum status place_chain_lines(struct plan_context *c, struct chain *k)
{
    for (int i = 0; i < k->wall_count; i++) {
        const struct placed_corner *a = &k->corners[i], *b = &k->corners[(i + 1) % k->corner_count];
        struct placed_line *line = &k->lines[i];
        if (place_line(line, c->placer, a, b, NULL, false, c->path, c->s->line, c->err)) return c->err->status;
        k->angled[i] = k->s->has_option[OPTION_ANGLED] && line->turn > line->max_turn;
        if (k->angled[i] && place_line(line, c->placer, a, b, NULL, true, c->path, c->s->line, c->err))
            return c->err->status;
        if (line->turn > line->max_turn && k->closed && i == k->wall_count - 1)
            return plan_statement_error(
                c,
                "the room does not close: from its last corner, at pixel %.9g %.9g of %s, to its first, at pixel %.9g "
                "%.9g of %s, the wall %s would run %.1f degrees off the nearest axis; add the corner that is missing, "
                "or "
                "the word angled.",
                a->x, a->y, a->view, b->x, b->y, b->view, k->s->names[i], line->turn);
        if (line->turn > line->max_turn) return too_much_turned(c, k->s->names[i], line, a, b, false);
    }
    return ST_OK;
}

static struct plan_line line_of(const struct placed_line *line)
{
    return (struct plan_line){{line->d[1], -line->d[0]}, line->c};
}

/* The corners where the lines of two walls meet; the first and last of an open chain where their clicks put them. */
static enum status meet_lines(struct plan_context *c, struct chain *k)
{
    for (int i = 0; i < k->corner_count; i++) {
        const int after = i % k->wall_count, before = (i + k->wall_count - 1) % k->wall_count;
        const bool first = !k->closed && i == 0, last = !k->closed && i == k->corner_count - 1;
        const struct placed_line *a = &k->lines[before], *b = &k->lines[after];
        if (first || last) {
            memcpy(k->ends[i], first ? b->ends[0] : a->ends[1], sizeof k->ends[i]);
            continue;
        }
        if (!(fabs(a->d[0] * b->d[1] - a->d[1] * b->d[0]) > PARALLEL_SINE))
            return corner_error(c, &k->corners[i],
                                "the walls before and after it run in one direction; leave this corner out, or add the "
                                "one that is missing.");
        plan_line_cross(line_of(a), line_of(b), k->ends[i]);
    }
    return ST_OK;
}

/* ST_DATA: a wall without length, or two walls that cross. */
static enum status check_outline(struct plan_context *c, const struct chain *k)
{
    for (int i = 0; i < k->wall_count; i++) {
        const double *a = k->ends[i], *b = k->ends[(i + 1) % k->corner_count], *d = k->lines[i].d;
        if (!(d[0] * (b[0] - a[0]) + d[1] * (b[1] - a[1]) >= MIN_SIZE))
            return corner_error(c, &k->corners[i],
                                "the wall from it to the next corner has no length between its neighbours; check the "
                                "pixels of both.");
        for (int j = i + 2; j < k->wall_count; j++) {
            if (k->closed && i == 0 && j == k->wall_count - 1) continue;
            const int next = (j + 1) % k->corner_count;
            if (!plan_segments_meet(a, b, k->ends[j], k->ends[next])) continue;
            return plan_statement_error(c,
                                        "the room does not close: wall %s, from pixel %.9g %.9g of %s, crosses wall "
                                        "%s, from pixel %.9g %.9g of "
                                        "%s; list the corners in the order in which they go round the room.",
                                        k->s->names[j], k->corners[j].x, k->corners[j].y, k->corners[j].view,
                                        k->s->names[i], k->corners[i].x, k->corners[i].y, k->corners[i].view);
        }
    }
    return ST_OK;
}

/* An open chain that comes back to its first corner is one that its writer takes for closed. */
static enum status check_return(struct plan_context *c, const struct chain *k)
{
    const struct placed_corner *a = &k->corners[0], *b = &k->corners[k->corner_count - 1];
    const double error = sqrt(a->xx + a->yy + b->xx + b->yy), off = hypot(a->p[0] - b->p[0], a->p[1] - b->p[1]);
    if (k->closed || k->corner_count < 4 || off > 2 * error) return ST_OK;
    return corner_error(
        c, b,
        "it is the first corner again, as near as clicks tell; leave it out and write closed at the end "
        "of the line.");
}

static enum status add_chain_walls(struct plan_context *c, const struct chain *k)
{
    const int first = c->plan->wall_count;
    for (int i = 0; i < k->wall_count; i++) {
        const struct placed_line *line = &k->lines[i];
        const double *a = k->ends[i], *b = k->ends[(i + 1) % k->corner_count];
        const double back[2] = {-line->d[0], -line->d[1]};
        struct plan_wall w;
        if (!begin_wall(c, &w, k->s->names[i])) {
            w.angled = k->angled[i];
            if (!(k->left ? set_placed_line(c, &w, back, -line->c, b, a)
                          : set_placed_line(c, &w, line->d, line->c, a, b)))
                add_wall(c, &w);
        }
        if (c->err->status) {
            if (c->plan->wall_count == first + i) free(w.name);
            return c->err->status;
        }
        note_line(k->s->names[i], line, "its corners");
    }
    for (int i = 0; i < (k->closed ? k->wall_count : k->wall_count - 1); i++) {
        const int a = first + i, b = first + (i + 1) % k->wall_count;
        c->plan->walls[a].ends[k->left ? END_START : END_END] = (struct wall_end){CORNER_END, 0, b};
        c->plan->walls[b].ends[k->left ? END_END : END_START] = (struct wall_end){CORNER_END, 0, a};
    }
    return ST_OK;
}

enum status plan_apply_walls(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct chain k = {.s = s, .corner_count = s->corner_count, .closed = s->has_option[OPTION_CLOSED]};
    k.wall_count = k.closed ? k.corner_count : k.corner_count - 1;
    if (count_corners(c, &k)) return c->err->status;
    const size_t count = (size_t)k.corner_count;
    k.corners = calloc(count, sizeof *k.corners);
    k.lines = calloc(count, sizeof *k.lines);
    k.angled = calloc(count, sizeof *k.angled);
    k.ends = calloc(count, sizeof *k.ends);
    if (!k.corners || !k.lines || !k.angled || !k.ends) err_nomem(c->err, "corners", count * sizeof *k.corners);
    if (!c->err->status && !place_chain_corners(c, &k) && !check_return(c, &k) && !find_side(c, &k) &&
        !place_chain_lines(c, &k) && !meet_lines(c, &k) && !check_outline(c, &k))
        add_chain_walls(c, &k);
    free(k.corners);
    free(k.lines);
    free(k.angled);
    free(k.ends);
    return c->err->status;
}
