/* script_volume.h - where there is matter in what script_model.h makes of a script, and how much. */
#ifndef REMODEL_TESTS_SCRIPT_VOLUME_H
#define REMODEL_TESTS_SCRIPT_VOLUME_H

#include "tests/unit/build_model/script_model.h"

/* ---------------------------------------------------------------------------------------------------------- matter */

/* Makes a room's edges from its walls, with the side on which the room is and the face towards it. */
static inline void expected_edges(const struct expected *t, struct expected_room *r)
{
    int first = 0;
    while (first < r->wall_count &&
           expected_same_line(&t->walls[r->walls[first]],
                              &t->walls[r->walls[(first + r->wall_count - 1) % r->wall_count]]))
        first++;
    r->edge_count = 0;
    for (int k = 0; k < r->wall_count; k++) {
        const int at = (first + k) % r->wall_count;
        if (!k || !expected_same_line(&t->walls[r->walls[at]], &t->walls[r->edges[r->edge_count - 1]]))
            r->edges[r->edge_count++] = r->walls[at];
        r->edge_of[at] = r->edge_count - 1;
    }
    for (int e = 0; e < r->edge_count; e++) { /* the room's side, by the crossings of a ray from the edge's middle */
        const struct expected_wall *w = &t->walls[r->edges[e]];
        double ends[2];
        int beyond = 0;
        for (int k = 0; k < 2; k++) {
            const struct expected_wall *o = &t->walls[r->edges[(e + (k ? 1 : r->edge_count - 1)) % r->edge_count]];
            ends[k] = (o->in + o->out) / 2;
        }
        const double s = (ends[0] + ends[1]) / 2 + 1e-5, at = (w->in + w->out) / 2;
        for (int f = 0; f < r->edge_count; f++) {
            const struct expected_wall *x = &t->walls[r->edges[f]];
            const struct expected_wall *before = &t->walls[r->edges[(f + r->edge_count - 1) % r->edge_count]],
                                       *after = &t->walls[r->edges[(f + 1) % r->edge_count]];
            const double a = (before->in + before->out) / 2, b = (after->in + after->out) / 2;
            if (f == e || x->axis != w->axis || (x->in + x->out) / 2 <= at) continue;
            beyond += (a < s) != (b < s);
        }
        r->above[e] = beyond % 2;
        r->face[e] = r->above[e] ? expected_high(w) : expected_low(w);
    }
}

/* The slabs' borders; in a wall with rooms on both sides they are in its middle. */
static inline void expected_shape(struct expected *t)
{
    unsigned char sides[MAX_ITEMS] = {0};
    for (int i = 0; i < t->room_count; i++) {
        struct expected_room *r = &t->rooms[i];
        if (r->gone) continue;
        expected_edges(t, r);
        for (int k = 0; k < r->wall_count; k++) sides[r->walls[k]] |= (unsigned char)(1 << r->above[r->edge_of[k]]);
    }
    for (int i = 0; i < t->room_count; i++) {
        struct expected_room *r = &t->rooms[i];
        for (int e = 0; !r->gone && e < r->edge_count; e++) {
            const struct expected_wall *w = &t->walls[r->edges[e]];
            r->border[e] = sides[r->edges[e]] == 3 ? (w->in + w->out) / 2
                           : r->above[e]           ? expected_low(w)
                                                   : expected_high(w);
        }
    }
}

static inline bool expected_between_rooms(const struct expected *t, int wall)
{
    unsigned sides = 0;
    for (int i = 0; i < t->room_count; i++) {
        const struct expected_room *r = &t->rooms[i];
        for (int k = 0; !r->gone && k < r->wall_count; k++)
            if (r->walls[k] == wall) sides |= 1u << r->above[r->edge_of[k]];
    }
    return sides == 3;
}

/* at: where the room's edges are: r->border, of its slabs, or r->face. */
static inline bool expected_in_outline(const struct expected *t, const struct expected_room *r, const double *at,
                                       const double p[3])
{
    int crossed = 0;
    for (int e = 0; e < r->edge_count; e++) {
        if (t->walls[r->edges[e]].axis != 1 || at[e] <= p[0]) continue;
        const double a = at[(e + r->edge_count - 1) % r->edge_count], b = at[(e + 1) % r->edge_count];
        crossed += (a < p[1]) != (b < p[1]);
    }
    return crossed % 2;
}

static inline bool expected_under_room(const struct expected *t, const struct expected_room *r, const double p[3])
{
    return expected_in_outline(t, r, r->border, p);
}

/* Where no room lists the wall, it goes up to the ceilings of the rooms in which it stands. */
static inline double expected_top(const struct expected *t, int wall, double s, const double p[3])
{
    const struct expected_wall *w = &t->walls[wall];
    double top = -HUGE_VAL;
    if (w->has_top) return w->top;
    for (int i = 0; i < t->room_count; i++) {
        const struct expected_room *r = &t->rooms[i];
        for (int k = 0; !r->gone && k < r->wall_count; k++) {
            if (r->walls[k] != wall) continue;
            const int e = r->edge_of[k];
            const int x = (e + r->edge_count - 1) % r->edge_count, y = (e + 1) % r->edge_count;
            const double low = fmin(fmin(r->face[x], r->face[y]), fmin(r->border[x], r->border[y]));
            const double high = fmax(fmax(r->face[x], r->face[y]), fmax(r->border[x], r->border[y]));
            if (s > low && s < high) top = fmax(top, r->ceiling);
        }
    }
    const bool listed = top > -HUGE_VAL;
    for (int i = 0; i < t->room_count && !listed; i++)
        if (!t->rooms[i].gone && expected_under_room(t, &t->rooms[i], p)) top = fmax(top, t->rooms[i].ceiling);
    return top > -HUGE_VAL ? top : w->top;
}

static inline bool expected_in_wall(const struct expected *t, int wall, const double p[3])
{
    const struct expected_wall *w = &t->walls[wall];
    const double s = p[w->axis], across = p[!w->axis];
    if (w->gone || across < expected_low(w) || across > expected_high(w)) return false;
    if (s < expected_reach(t, w, 0) || s > expected_reach(t, w, 1) || p[2] < w->foot ||
        p[2] > expected_top(t, wall, s, p))
        return false;
    for (int i = 0; i < t->hole_count; i++) {
        const struct expected_hole *h = &t->holes[i];
        if (h->gone || h->wall != wall || s < h->s[0] || s > h->s[1] || p[2] < h->z[0] || p[2] > h->z[1]) continue;
        if (h->fill == 'w') continue;
        return h->fill == 'l' && fabs(across - (w->in + w->out) / 2) < h->thick / 2;
    }
    return true;
}

/* A point in a room's floor or ceiling is not in an opening, or in its leaf. */
static inline bool expected_in_slab(const struct expected *t, int room, char opening, const double p[3])
{
    const struct expected_room *r = &t->rooms[room];
    for (int i = 0; i < t->slot_count; i++) {
        const struct expected_slot *o = &t->slots[i];
        bool in = !o->gone && o->room == room && o->kind == opening && o->fill != 'w';
        for (int k = 0; k < 2; k++) in &= p[k] > o->low[k] && p[k] < o->high[k];
        if (in) return o->fill == 'l' && p[2] > (opening == 'h' ? r->floor : r->ceiling + r->slab) - o->thick;
    }
    return true;
}

static inline bool expected_has_matter(const struct expected *t, const double p[3])
{
    for (int i = 0; i < t->wall_count; i++)
        if (expected_in_wall(t, i, p)) return true;
    for (int i = 0; i < t->box_count; i++) {
        const struct expected_box *b = &t->boxes[i];
        bool in = !b->gone;
        for (int k = 0; k < 3; k++) in &= p[k] > b->low[k] && p[k] < b->high[k];
        if (in) return true;
    }
    for (int i = 0; i < t->room_count; i++) {
        const struct expected_room *r = &t->rooms[i];
        const bool floor = p[2] < r->floor && p[2] > r->floor - r->slab;
        if (r->gone || !(floor || (p[2] > r->ceiling && p[2] < r->ceiling + r->slab))) continue;
        if (expected_under_room(t, r, p) && expected_in_slab(t, i, floor ? 'h' : 's', p)) return true;
    }
    return false;
}

/* --------------------------------------------------------------------------------------------------------- volumes */

struct expected_planes {
    double at[3][16 * MAX_ITEMS];
    int count[3];
};

static inline void expected_add_plane(struct expected_planes *g, int axis, double at)
{
    g->at[axis][g->count[axis]++] = at;
}

static inline int compare_planes(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Volumes of everything but panes, and of the panes. t->exact must be true. */
static inline void expected_volumes(struct expected *t, double *solid, double *panes)
{
    static struct expected_planes g;
    memset(g.count, 0, sizeof g.count);
    expected_shape(t);
    *solid = *panes = 0;
    for (int i = 0; i < t->wall_count; i++) {
        const struct expected_wall *w = &t->walls[i];
        expected_add_plane(&g, !w->axis, w->in);
        expected_add_plane(&g, !w->axis, w->out);
        expected_add_plane(&g, !w->axis, (w->in + w->out) / 2);
        expected_add_plane(&g, 2, w->foot);
        expected_add_plane(&g, 2, w->top);
        for (int e = 0; e < 2; e++)
            if (w->ends[e].kind == MODEL_FREE) expected_add_plane(&g, w->axis, w->ends[e].s);
    }
    for (int i = 0; i < t->hole_count; i++) {
        const struct expected_hole *h = &t->holes[i];
        const struct expected_wall *w = &t->walls[h->wall];
        if (h->gone || w->gone) continue;
        for (int k = 0; k < 2; k++) {
            expected_add_plane(&g, w->axis, h->s[k]);
            expected_add_plane(&g, 2, h->z[k]);
            expected_add_plane(&g, !w->axis, (w->in + w->out + (k ? h->thick : -h->thick)) / 2);
        }
        const bool none = h->kind == 'w' && !h->refilled && (h->interior || expected_between_rooms(t, h->wall));
        if (h->fill == 'g' && !none) *panes += (h->s[1] - h->s[0]) * (h->z[1] - h->z[0]) * h->thick;
    }
    for (int i = 0; i < t->slot_count; i++) {
        const struct expected_slot *o = &t->slots[i];
        const struct expected_room *r = &t->rooms[o->room];
        if (o->gone || r->gone) continue;
        for (int k = 0; k < 2; k++) {
            expected_add_plane(&g, k, o->low[k]);
            expected_add_plane(&g, k, o->high[k]);
        }
        expected_add_plane(&g, 2, (o->kind == 'h' ? r->floor : r->ceiling + r->slab) - o->thick);
        if (o->fill == 'g') *panes += (o->high[0] - o->low[0]) * (o->high[1] - o->low[1]) * o->thick;
    }
    for (int i = 0; i < t->box_count; i++)
        for (int k = 0; k < 3; k++) {
            expected_add_plane(&g, k, t->boxes[i].low[k]);
            expected_add_plane(&g, k, t->boxes[i].high[k]);
        }
    for (int i = 0; i < t->room_count; i++) {
        const struct expected_room *r = &t->rooms[i];
        const double z[4] = {r->floor, r->floor - r->slab, r->ceiling, r->ceiling + r->slab};
        for (int k = 0; k < 4; k++) expected_add_plane(&g, 2, z[k]);
    }
    for (int k = 0; k < 3; k++) {
        int n = 0;
        if (g.count[k]) qsort(g.at[k], (size_t)g.count[k], sizeof g.at[k][0], compare_planes);
        for (int i = 0; i < g.count[k]; i++)
            if (!n || g.at[k][i] - g.at[k][n - 1] > 1e-9) g.at[k][n++] = g.at[k][i];
        g.count[k] = n;
    }
    for (int x = 0; x + 1 < g.count[0]; x++)
        for (int y = 0; y + 1 < g.count[1]; y++)
            for (int z = 0; z + 1 < g.count[2]; z++) {
                const double *const c[3] = {&g.at[0][x], &g.at[1][y], &g.at[2][z]};
                double p[3], cell = 1;
                for (int k = 0; k < 3; k++) {
                    p[k] = (c[k][0] + c[k][1]) / 2;
                    cell *= c[k][1] - c[k][0];
                }
                if (expected_has_matter(t, p)) *solid += cell;
            }
}

#endif
