/* plan_joins.c - statements that join, extend and split walls.
 *
 * An end stores what it is joined to, so a wall that moves takes its neighbours' ends along. A split moves the
 * openings, joined walls and rooms of the wall to the part that they belong to. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

static double distance_from_end(const struct plan *plan, int wall, int end, const double p[2])
{
    double range[2];
    int face_wall, face_side;
    const struct plan_wall *w = &plan->walls[wall];
    plan_cut_range(w, plan_wall_cap(plan, wall, end, &face_wall, &face_side), range);
    return fabs(plan_wall_s(w, p) - 0.5 * (range[0] + range[1]));
}

/* The end of a that forms the corner with b: one already joined to b, else the nearer free one. */
static enum status corner_end(struct plan_context *c, int a, int b, const double p[2], int *end)
{
    const struct plan *plan = c->plan;
    const struct plan_wall *w = &plan->walls[a];
    for (int e = 0; e < 2; e++)
        if (w->ends[e].kind != FREE_END && w->ends[e].other == b) {
            *end = e;
            return ST_OK;
        }
    const bool free0 = w->ends[0].kind == FREE_END, free1 = w->ends[1].kind == FREE_END;
    if (!free0 && !free1)
        return plan_statement_error(
            c, "walls %s and %s cannot be joined: both ends of %s are joined already, to %s and %s.", w->name,
            plan->walls[b].name, w->name, plan->walls[w->ends[0].other].name, plan->walls[w->ends[1].other].name);
    *end = !free1 ? 0 : !free0 ? 1 : distance_from_end(plan, a, 0, p) <= distance_from_end(plan, a, 1, p) ? 0 : 1;
    return ST_OK;
}

/* Where the inner faces of both walls cross. ST_DATA: the walls are the same, or parallel. */
static enum status check_crossing(struct plan_context *c, int a, int b, double p[2])
{
    const struct plan_wall *x = &c->plan->walls[a], *y = &c->plan->walls[b];
    if (a == b) return plan_statement_error(c, "wall %s cannot be joined to itself.", x->name);
    if (fabs(x->d[0] * y->d[1] - x->d[1] * y->d[0]) > PARALLEL_SINE)
        return plan_line_cross(plan_wall_face(x, SIDE_IN), plan_wall_face(y, SIDE_IN), p), ST_OK;
    return plan_statement_error(c, "walls %s and %s cannot be joined: they are parallel, or nearly so.", x->name,
                                y->name);
}

enum status plan_read_join(struct script_reader *r, struct statement *s) { return script_read_list(r, s, 2); }

enum status plan_apply_join(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    for (int i = 0; i + 1 < s->name_count; i++) {
        int walls[2], ends[2];
        double p[2];
        if (plan_find_wall(c, s->names[i], &walls[0]) || plan_find_wall(c, s->names[i + 1], &walls[1]) ||
            check_crossing(c, walls[0], walls[1], p) || corner_end(c, walls[0], walls[1], p, &ends[0]) ||
            corner_end(c, walls[1], walls[0], p, &ends[1]))
            return c->err->status;
        for (int k = 0; k < 2; k++) plan->walls[walls[k]].ends[ends[k]] = (struct wall_end){CORNER_END, 0, walls[!k]};
    }
    return ST_OK;
}

enum status plan_read_extend(struct script_reader *r, struct statement *s)
{
    char *word;
    if (script_read_name(r, "a wall", &s->name)) return r->err->status;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL);
    if (textfile_word(&r->t, "\"start\" or \"end\"", &word, r->err)) return r->err->status;
    s->end = !strcmp(word, "start") ? END_START : !strcmp(word, "end") ? END_END : END_NONE;
    if (s->end == END_NONE)
        return textfile_error(&r->t, r->err, word, "\"start\" or \"end\", in a line \"%s\"", r->verb->usage);
    if (script_expect(r, "to") || textfile_word(&r->t, "a wall or a coordinate", &word, r->err)) return r->err->status;
    if (scan_double(word, &s->values[0])) {
        s->value_count = 1;
        if (fabs(s->values[0]) <= MAX_NUMBER) return ST_OK;
        return textfile_error(&r->t, r->err, word, "a coordinate within 1e6");
    }
    if (!scan_is_name(word)) return textfile_error(&r->t, r->err, word, "the name of a wall, or a coordinate");
    s->other = script_keep_word(r, word);
    return ST_OK;
}

enum status plan_apply_extend(struct plan_context *c)
{
    const struct statement *s = c->s;
    int wall, other;
    double p[2];
    if (plan_find_wall(c, s->name, &wall)) return c->err->status;
    struct wall_end *e = &c->plan->walls[wall].ends[s->end];
    if (!s->other) {
        *e = (struct wall_end){FREE_END, s->values[0], -1};
        return ST_OK;
    }
    if (plan_find_wall(c, s->other, &other) || check_crossing(c, wall, other, p)) return c->err->status;
    const struct wall_end *opposite = &c->plan->walls[wall].ends[!s->end];
    if (opposite->kind != FREE_END && opposite->other == other)
        return plan_statement_error(c, "wall %s cannot be extended to %s: its other end is there already.", s->name,
                                    s->other);
    *e = (struct wall_end){MEET_END, 0, other};
    return ST_OK;
}

/* Lists the new part of a split wall beside the old part in every room that has the wall. */
static enum status add_to_rooms(struct plan_context *c, int wall, int part)
{
    struct plan *plan = c->plan;
    for (int i = 0; i < plan->room_count; i++) {
        struct plan_room *r = &plan->rooms[i];
        int at = 0;
        while (at < r->wall_count && r->walls[at] != wall) at++;
        if (at == r->wall_count) continue;
        int *more = realloc(r->walls, ((size_t)r->wall_count + 1) * sizeof *more);
        if (!more) return err_nomem(c->err, "a room", ((size_t)r->wall_count + 1) * sizeof *more);
        r->walls = more;
        /* the part that the room's next wall joins comes second */
        const int next = r->walls[(at + 1) % r->wall_count];
        const struct plan_wall *p = &plan->walls[part], *n = &plan->walls[next];
        bool after = p->ends[END_END].kind != FREE_END && p->ends[END_END].other == next;
        for (int e = 0; e < 2; e++) after |= n->ends[e].kind != FREE_END && n->ends[e].other == part;
        const int where = after ? at + 1 : at;
        memmove(r->walls + where + 1, r->walls + where, (size_t)(r->wall_count - where) * sizeof *more);
        r->walls[where] = part;
        r->wall_count++;
    }
    return ST_OK;
}

enum status plan_read_split(struct script_reader *r, struct statement *s)
{
    s->value_count = 2;
    if (script_read_name(r, "a wall", &s->name) || script_expect(r, "from") ||
        script_read_number(r, "where the gap begins", &s->values[0]) || script_expect(r, "to") ||
        script_read_number(r, "where the gap ends", &s->values[1]) || script_expect(r, "into") ||
        script_read_name(r, "a new name", &s->other))
        return r->err->status;
    return ST_OK;
}

enum status plan_apply_split(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *plan = c->plan;
    int wall;
    double span[2];
    char *name = NULL;
    const double gap[2] = {fmin(s->values[0], s->values[1]), fmax(s->values[0], s->values[1])};
    if (plan_find_wall(c, s->name, &wall)) return c->err->status;
    plan_wall_span(plan, wall, span);
    if (!(gap[0] > span[0] + LENGTH_EPS && gap[1] < span[1] - LENGTH_EPS && gap[1] > gap[0] + LENGTH_EPS))
        return plan_statement_error(c,
                                    "the gap from %.9g to %.9g does not lie in wall %s, which goes from %.9g to %.9g.",
                                    gap[0], gap[1], s->name, span[0], span[1]);
    for (int i = 0; i < plan->opening_count; i++) {
        const struct plan_opening *o = &plan->openings[i];
        if (o->wall == wall && !o->removed && o->s[0] < gap[1] && o->s[1] > gap[0])
            return plan_statement_error(c,
                                        "the gap from %.9g to %.9g cuts %s %s, from %.9g to %.9g; remove that first.",
                                        gap[0], gap[1], plan_opening_word(o->kind), o->name, o->s[0], o->s[1]);
    }
    if (plan_copy_new_name(c, s->other, &name)) return c->err->status;
    if (array_append(&plan->walls, (size_t)plan->wall_count, sizeof *plan->walls, "walls", c->err)) {
        free(name);
        return c->err->status;
    }
    const int new = plan->wall_count++;
    struct plan_wall *w = &plan->walls[wall], *part = &plan->walls[new];
    *part = *w;
    part->name = name;
    part->line = s->line;
    part->ends[END_START] = (struct wall_end){FREE_END, gap[w->sign > 0], -1};
    w->ends[END_END] = (struct wall_end){FREE_END, gap[w->sign < 0], -1};
    const bool new_above = w->sign > 0; /* the new part has the larger S */
    const double middle = 0.5 * (gap[0] + gap[1]);
    for (int i = 0; i < plan->opening_count; i++) {
        struct plan_opening *o = &plan->openings[i];
        if (o->wall == wall && (o->s[0] > middle) == new_above) o->wall = new;
    }
    for (int i = 0; i < plan->wall_count; i++)
        for (int e = 0; e < 2; e++) {
            struct plan_wall *x = &plan->walls[i];
            double p[2];
            if (i == wall || i == new || x->ends[e].kind == FREE_END || x->ends[e].other != wall) continue;
            if (plan_line_cross(plan_wall_face(x, SIDE_IN), plan_wall_face(w, SIDE_IN), p) &&
                (plan_wall_s(w, p) > middle) == new_above)
                x->ends[e].other = new;
        }
    if (plan_add_name(plan, part->name, NAMED_WALL, new, c->err)) return c->err->status;
    return add_to_rooms(c, wall, new);
}
