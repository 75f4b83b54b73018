/* plan_geometry.c - lines of walls in the plan: faces, ends, and the parts of a wall that openings and rooms may use.
 *
 * A wall's end is stored as what it is joined to. The line across the wall there, its cap, is a face of the other wall:
 * at a corner the farther face, so that both walls contain the corner's solid; where a wall only meets another the
 * nearer one. The span of a wall is what remains of it between its neighbours, its reach goes from cap to cap. */
#include <math.h>

#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/plan/room_parts.h"

struct plan_line plan_wall_face(const struct plan_wall *w, int side)
{
    /* 0 - x instead of -x avoids -0 in the files */
    const struct plan_line in = {{w->d[1], 0 - w->d[0]}, w->c};
    return side == SIDE_IN ? in : (struct plan_line){{0 - in.n[0], 0 - in.n[1]}, w->thickness - w->c};
}

void plan_wall_point(const struct plan_wall *w, double s, double off, double p[2])
{
    const double t = w->sign * (s + w->origin), k = w->c - off;
    p[0] = w->d[0] * t + w->d[1] * k;
    p[1] = w->d[1] * t - w->d[0] * k;
}

double plan_wall_s(const struct plan_wall *w, const double p[2])
{
    return w->sign * (w->d[0] * p[0] + w->d[1] * p[1]) - w->origin;
}

bool plan_line_cross(struct plan_line a, struct plan_line b, double p[2])
{
    const double det = a.n[0] * b.n[1] - a.n[1] * b.n[0];
    if (!(fabs(det) > PARALLEL_SINE / 10)) return false;
    p[0] = (a.c * b.n[1] - b.c * a.n[1]) / det;
    p[1] = (a.n[0] * b.c - b.n[0] * a.c) / det;
    return true;
}

struct plan_line plan_face_ahead(const struct plan_wall *w, int end, const struct plan_wall *other, bool far, int *side)
{
    const double e[2] = {end == END_END ? w->d[0] : -w->d[0], end == END_END ? w->d[1] : -w->d[1]};
    struct plan_line in = plan_wall_face(other, SIDE_IN);
    const bool in_is_far = in.n[0] * e[0] + in.n[1] * e[1] > 0;
    *side = in_is_far == far ? SIDE_IN : SIDE_OUT;
    struct plan_line l = plan_wall_face(other, *side);
    if (l.n[0] * e[0] + l.n[1] * e[1] < 0) l = (struct plan_line){{-l.n[0], -l.n[1]}, -l.c};
    return l;
}

struct plan_line plan_wall_cap(const struct plan *plan, int wall, int end, int *face_wall, int *face_side)
{
    const struct plan_wall *w = &plan->walls[wall];
    const struct wall_end *e = &w->ends[end];
    *face_wall = -1;
    *face_side = SIDE_IN;
    if (e->kind == FREE_END) {
        const double t = w->sign * (e->s + w->origin);
        return end == END_END ? (struct plan_line){{w->d[0], w->d[1]}, t}
                              : (struct plan_line){{-w->d[0], -w->d[1]}, -t};
    }
    const struct plan_line l = plan_face_ahead(w, end, &plan->walls[e->other], e->kind == CORNER_END, face_side);
    if (e->kind == CORNER_END) *face_wall = e->other;
    return l;
}

bool plan_walls_on_one_line(const struct plan_wall *a, const struct plan_wall *b)
{
    const double turn = a->d[0] * b->d[0] + a->d[1] * b->d[1];
    return turn > 1 - 1e-12 && fabs(a->c - b->c) < LENGTH_EPS;
}

void plan_cut_range(const struct plan_wall *w, struct plan_line across, double range[2])
{
    double p[2] = {0, 0};
    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int side = 0; side < 2; side++) {
        if (!plan_line_cross(plan_wall_face(w, side), across, p)) continue;
        const double s = plan_wall_s(w, p);
        range[0] = fmin(range[0], s);
        range[1] = fmax(range[1], s);
    }
}

void plan_wall_span(const struct plan *plan, int wall, double span[2])
{
    const struct plan_wall *w = &plan->walls[wall];
    for (int end = 0; end < 2; end++) {
        const struct wall_end *e = &w->ends[end];
        const int upper = (end == END_END) == (w->sign > 0); /* which bound of S this end is */
        if (e->kind == FREE_END) {
            span[upper] = e->s;
            continue;
        }
        double range[2];
        int side;
        plan_cut_range(w, plan_face_ahead(w, end, &plan->walls[e->other], false, &side), range);
        span[upper] = (upper ? range[0] : range[1]) + 0.0; /* a -0 becomes 0 */
    }
}

void plan_wall_reach(const struct plan *plan, int wall, double span[2])
{
    const struct plan_wall *w = &plan->walls[wall];
    for (int end = 0; end < 2; end++) {
        double range[2];
        int face_wall, face_side;
        const int upper = (end == END_END) == (w->sign > 0);
        plan_cut_range(w, plan_wall_cap(plan, wall, end, &face_wall, &face_side), range);
        span[upper] = range[upper] + 0.0; /* a -0 becomes 0 */
    }
}

void plan_room_span(const struct plan *plan, const struct plan_room *room, int edge, int wall, double span[2])
{
    const struct plan_wall *w = &plan->walls[wall];
    const struct room_edge *e = &room->edges[edge],
                           *before = &room->edges[(edge + room->edge_count - 1) % room->edge_count];
    const double a = fmin(plan_wall_s(w, e->corner), plan_wall_s(w, before->corner));
    const double b = fmax(plan_wall_s(w, e->corner), plan_wall_s(w, before->corner));
    double reach[2];
    span[0] = fmin(a, fmin(plan_wall_s(w, e->outer), plan_wall_s(w, before->outer)));
    span[1] = fmax(b, fmax(plan_wall_s(w, e->outer), plan_wall_s(w, before->outer)));
    plan_wall_reach(plan, wall, reach);
    span[0] = fmax(span[0], reach[0]);
    span[1] = fmin(span[1], reach[1]);
}

const char *plan_opening_word(enum opening_kind kind)
{
    static const char *const WORDS[] = {"door", "passage", "window", "skylight", "hatch"};
    return WORDS[kind];
}

bool plan_opening_is_there(const struct plan *plan, const struct plan_opening *o)
{
    return !o->removed && o->fill != FILL_WALL && !plan->walls[o->wall].removed;
}

bool plan_slot_is_there(const struct plan *plan, const struct plan_slot *slot)
{
    return !slot->removed && slot->fill != FILL_WALL && !plan->rooms[slot->room].removed;
}

double plan_top_at(const struct plan_top *top, const double p[2])
{
    double z = HUGE_VAL;
    for (int i = 0; i < top->count; i++) z = fmin(z, top->a[i][0] + top->a[i][1] * p[0] + top->a[i][2] * p[1]);
    return z;
}

struct plan_top plan_level_top(double z) { return (struct plan_top){{{z, 0, 0}}, 1}; }

int plan_room_edge_of(const struct plan_room *room, int wall)
{
    for (int i = 0; i < room->wall_count; i++)
        if (room->walls[i] == wall) return room->edge_of[i];
    return -1;
}

static bool in_part(const struct room_part *part, const double p[2])
{
    for (int i = 0; i < part->count; i++) {
        const struct plan_line *l = &part->corners[i].line;
        if (l->n[0] * p[0] + l->n[1] * p[1] > l->c) return false;
    }
    return true;
}

/* Where the segments from a to b and from c to d cross. */
static bool segments_cross(const double a[2], const double b[2], const double c[2], const double d[2], double at[2])
{
    const double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {d[0] - c[0], d[1] - c[1]},
                 w[2] = {c[0] - a[0], c[1] - a[1]};
    const double det = u[0] * v[1] - u[1] * v[0], s = (w[0] * v[1] - w[1] * v[0]) / det,
                 t = (w[0] * u[1] - w[1] * u[0]) / det;
    if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) return false;
    for (int k = 0; k < 2; k++) at[k] = a[k] + s * u[k];
    return true;
}

/* The lowest height of the ceiling over the part of a convex quadrilateral that lies in the room's part; HUGE_VAL:
 * none lies there. A linear height is lowest at a corner of the two polygons' intersection. */
static double lowest_over(const struct plan_top *top, const struct room_part *part, const struct room_part *quad)
{
    double low = HUGE_VAL, at[2];
    for (int i = 0; i < quad->count; i++) {
        const double *a = quad->corners[(i + quad->count - 1) % quad->count].p, *b = quad->corners[i].p;
        if (in_part(part, b)) low = fmin(low, plan_top_at(top, b));
        for (int k = 0; k < part->count; k++) {
            const double *c = part->corners[(k + part->count - 1) % part->count].p, *d = part->corners[k].p;
            if (segments_cross(a, b, c, d, at)) low = fmin(low, plan_top_at(top, at));
        }
    }
    for (int k = 0; k < part->count; k++)
        if (in_part(quad, part->corners[k].p)) low = fmin(low, plan_top_at(top, part->corners[k].p));
    return low;
}

/* The lowest ceiling over a stretch of a wall that no room lists, or the wall's own top if no room covers it all. */
static double top_in_rooms(const struct plan *plan, const struct plan_wall *w, double s0, double s1)
{
    const double inset = fmin(2 * PART_EPS, 0.25 * (s1 - s0)); /* a wall that only touches a room is not under it */
    struct part_corner corners[4];
    struct room_part quad = {corners, 4};
    bool covered[4] = {false};
    double low = HUGE_VAL;
    for (int k = 0; k < 4; k++) { /* counter-clockwise: along the out face against d, back along the in face */
        const bool end = (k == 0 || k == 1) == (w->sign > 0);
        plan_wall_point(w, end ? s1 - inset : s0 + inset, k == 1 || k == 2 ? w->thickness - inset : inset,
                        corners[k].p);
    }
    for (int k = 0; k < 4; k++) {
        const double *a = corners[(k + 3) % 4].p, *b = corners[k].p;
        const double n[2] = {b[1] - a[1], a[0] - b[0]};
        corners[k].line = (struct plan_line){{n[0], n[1]}, n[0] * b[0] + n[1] * b[1]};
    }
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        for (int k = 0; !r->removed && k < r->part_count; k++) {
            low = fmin(low, lowest_over(&r->lower, &r->parts[k], &quad));
            for (int c = 0; c < 4; c++) covered[c] |= in_part(&r->parts[k], corners[c].p);
        }
    }
    return covered[0] && covered[1] && covered[2] && covered[3] ? low : fmin(low, w->top);
}

double plan_wall_top(const struct plan *plan, int wall, double s0, double s1)
{
    const struct plan_wall *w = &plan->walls[wall];
    double top = HUGE_VAL;
    if (w->has_top) return w->top;
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        for (int e = 0; !r->removed && e < r->edge_count; e++) {
            double span[2];
            if (plan_room_edge_of(r, wall) != e) continue;
            plan_room_span(plan, r, e, wall, span);
            if (span[1] <= s0 || span[0] >= s1) continue;
            for (int k = 0; k < 4; k++) {
                double p[2];
                plan_wall_point(w, k & 1 ? s1 : s0, k & 2 ? w->thickness : 0, p);
                top = fmin(top, plan_top_at(&r->lower, p));
            }
        }
    }
    return top < HUGE_VAL ? top : top_in_rooms(plan, w, s0, s1);
}

void plan_wall_corners(const struct plan *p, int wall, double corners[4][2])
{
    const struct plan_wall *w = &p->walls[wall];
    for (int end = 0; end < 2; end++) {
        int face_wall, face_side;
        const struct plan_line cap = plan_wall_cap(p, wall, end, &face_wall, &face_side);
        for (int side = 0; side < 2; side++)
            plan_line_cross(plan_wall_face(w, side), cap, corners[end == END_START ? side : 3 - side]);
    }
}
