/* borders.c - the borders of a union's surface in each plane.
 *
 * In a plane P let `below` be the region with solid just below it (on the side opposite to its normal) and `above` the
 * region with solid just above. Both are unions of convex polygons: a facet in P with its solid below adds to `below`,
 * a facet with its solid above to `above`, and the section of a solid that P cuts to both. The union's surface in P is
 * below \ above, with the normal outwards, and above \ below, with the normal inwards. So coplanar facets merge, and
 * opposite and covered facets vanish, without special cases.
 *
 * A floor and a ceiling belong to a room, and surfaces of two rooms, or of a room and of none, are not merged: there is
 * a border on either side of the line between them. The room of the surface at a place is the lowest of those of the
 * facets that cover it there.
 *
 * The borders of these regions are found in the same way, line by line. Each polygon that touches a line of P adds an
 * interval to the line's left or right side (if it has an edge there) or to both (if the line cuts it). The surface has
 * a border where it is on one side of the line only. Intervals end in points where three planes meet, which are
 * compared exactly: there are no tolerances. */
#include "stages/build_model/solid/borders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BELOW, ABOVE };
enum { LEFT, RIGHT };

struct interval {
    int polygon, from, to; /* points, along the line */
    bool on[2];            /* LEFT, RIGHT */
};

struct entry { /* an edge of a polygon in the plane */
    int line, polygon, edge;
};

struct sweep {
    struct convex_set *set;
    const int *rooms; /* by rank of a name */
    struct border_set *borders;
    int facets;        /* polygons before this index are facets, the others sections */
    int *first, *near; /* solids whose boxes meet the box of solid s, with s: near[first[s] .. first[s + 1]) */
    int *plane_first, *plane_facets; /* facets by plane */
    int *polygon_of;                 /* of each solid in the current plane, or -1 */
    char *bordered, *visible;        /* facets */
    /* of the current plane */
    int *polygons, polygon_count, polygon_capacity;
    struct entry *entries;
    int entry_count, entry_capacity;
    /* of the current line */
    int *stamp, stamp_capacity; /* of each polygon: the last line that it was tested with */
    int line;
    struct interval *intervals;
    int interval_count, interval_capacity;
    int *events, event_count, event_capacity;
    int *index, index_capacity; /* of points among the events */
    int (*covers)[2][2];        /* change of the number of intervals at an event: BELOW, ABOVE by LEFT, RIGHT */
    int (*room_at)[2][2];       /* after an event: the surface's room, by BELOW, ABOVE and LEFT, RIGHT */
    int (*border_at)[2][2];     /* the border after an event, likewise, or -1 */
    int covers_capacity, room_at_capacity, border_at_capacity;
};

void border_set_release(struct border_set *b)
{
    if (!b) return;
    free(b->borders);
    free(b->names);
    free(b->points);
    free(b->inner);
    *b = (struct border_set){0};
}

/* ----------------------------------------------------------------------------------------------------- neighbours */

struct by_low {
    double low;
    int solid;
};

static int compare_low(const void *a, const void *b)
{
    const struct by_low *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return (p->solid > q->solid) - (p->solid < q->solid);
}

/* Finds pairs of boxes that meet by a sweep along the longest axis of their bounding box. */
static enum status find_near(struct sweep *w, struct err *err)
{
    const struct convex_set *set = w->set;
    const int n = set->count;
    double low[3] = {0}, high[3] = {0};
    int axis = 0, pair_count = 0, pair_capacity = 0, active_count = 0, *pairs = NULL;
    struct by_low *order = malloc((size_t)n * sizeof *order);
    int *active = malloc((size_t)n * sizeof *active);
    if (!order || !active) err_nomem(err, "boxes of solids", (size_t)n * sizeof *order);

    for (int a = 0; a < 3; a++)
        for (int i = 0; i < n; i++) {
            low[a] = i ? fmin(low[a], set->solids[i].low[a]) : set->solids[i].low[a];
            high[a] = i ? fmax(high[a], set->solids[i].high[a]) : set->solids[i].high[a];
        }
    for (int a = 1; a < 3; a++)
        if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
    for (int i = 0; !err->status && i < n; i++) order[i] = (struct by_low){set->solids[i].low[axis], i};
    if (!err->status) qsort(order, (size_t)n, sizeof *order, compare_low);
    for (int i = 0; !err->status && i < n; i++) {
        const struct convex *c = &set->solids[order[i].solid];
        int kept = 0;
        for (int k = 0; !err->status && k < active_count; k++) {
            const struct convex *o = &set->solids[active[k]];
            if (o->high[axis] + 0.25 < c->low[axis]) continue;
            active[kept++] = active[k];
            if (!boxes_meet(c->low, c->high, o->low, o->high)) continue;
            if (exact_grow(&pairs, &pair_capacity, pair_count + 2, sizeof *pairs, err)) break;
            pairs[pair_count++] = order[i].solid;
            pairs[pair_count++] = active[k];
        }
        active_count = kept;
        active[active_count++] = order[i].solid;
    }
    w->first = calloc((size_t)n + 2, sizeof *w->first);
    w->near = malloc(((size_t)pair_count + (size_t)n + 1) * sizeof *w->near);
    if (!err->status && !(w->first && w->near))
        err_nomem(err, "neighbours of solids", (size_t)pair_count * sizeof *w->near);
    if (!err->status) {
        for (int i = 0; i < n; i++) w->first[i + 2]++;
        for (int i = 0; i < pair_count; i++) w->first[pairs[i] + 2]++;
        for (int i = 0; i < n; i++) w->first[i + 2] += w->first[i + 1];
        for (int i = 0; i < n; i++) w->near[w->first[i + 1]++] = i;
        for (int i = 0; i < pair_count; i++) w->near[w->first[pairs[i] + 1]++] = pairs[i ^ 1];
    }
    free(order);
    free(active);
    free(pairs);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- a line */

static int compare_events(const void *a, const void *b, void *ctx)
{
    const struct sweep *w = ctx;
    return exact_compare_along(&w->set->space, &w->set->space.lines[w->line], *(const int *)a, *(const int *)b);
}

static enum status add_event(struct sweep *w, int point, struct err *err)
{
    if (exact_grow(&w->events, &w->event_capacity, w->event_count + 1, sizeof *w->events, err)) return err->status;
    w->events[w->event_count++] = point;
    return ST_OK;
}

/* Adds the interval of a polygon of plane `plane` on the line in which it meets plane `other`. Points with
 * exact_side() * turn > 0 with respect to `other` are to the left. */
static enum status add_interval(struct sweep *w, int polygon, int plane, int other, int turn, struct err *err)
{
    struct exact_space *space = &w->set->space;
    const struct polygon p = w->set->polygons[polygon];
    const struct polygon_edge *e = &w->set->edges[p.first];
    int points[2], count = 0;
    bool left = false, right = false;
    int before = turn * exact_side(space, e[p.count - 1].corner, other);
    for (int i = 0; i < p.count; i++) {
        const int here = turn * exact_side(space, e[i].corner, other);
        int point = e[i].corner;
        left = left || here > 0;
        right = right || here < 0;
        if (here * before < 0 && exact_meet(space, plane, other, e[(i + p.count - 1) % p.count].plane, &point, err))
            return err->status;
        if ((!here || here * before < 0) && count < 2) points[count++] = point;
        before = here;
    }
    if (!count) return ST_OK;
    if (add_event(w, points[0], err) || (count > 1 && add_event(w, points[1], err))) return err->status;
    if (count < 2) return ST_OK;
    const bool swap = exact_compare_along(space, &space->lines[w->line], points[0], points[1]) > 0;
    if (exact_grow(&w->intervals, &w->interval_capacity, w->interval_count + 1, sizeof *w->intervals, err))
        return err->status;
    w->intervals[w->interval_count++] = (struct interval){polygon, points[swap], points[!swap], {left, right}};
    return ST_OK;
}

static bool on_surface(const int cover[2][2], int which, int side)
{
    return cover[which][side] > 0 && !cover[!which][side];
}

/* Finds the room of the surface after each event, on both sides. */
static void find_rooms(struct sweep *w)
{
    for (int i = 0; i < w->event_count; i++)
        for (int k = 0; k < 4; k++) w->room_at[i][k / 2][k % 2] = -1;
    for (int i = 0; i < w->interval_count; i++) {
        const struct interval *v = &w->intervals[i];
        const struct polygon *p = &w->set->polygons[v->polygon];
        const int room = p->side ? w->rooms[p->name] : -1, which = p->side > 0 ? BELOW : ABOVE;
        for (int k = w->index[v->from]; room >= 0 && k < w->index[v->to]; k++)
            for (int side = LEFT; side <= RIGHT; side++) {
                int *at = &w->room_at[k][which][side];
                if (v->on[side] && (*at < 0 || room < *at)) *at = room;
            }
    }
}

/* Continues the border that ends at event `i`, or begins one there. */
static enum status add_border(struct sweep *w, int i, struct border b, int *run, struct err *err)
{
    struct border_set *set = w->borders;
    if (*run >= 0 && set->borders[*run].forward == b.forward && set->borders[*run].room == b.room) {
        *(b.forward ? &set->borders[*run].to : &set->borders[*run].from) = w->events[i + 1];
        return ST_OK;
    }
    if (exact_grow(&set->borders, &set->border_capacity, set->border_count + 1, sizeof *set->borders, err))
        return err->status;
    b.line = w->line;
    b.from = w->events[b.forward ? i : i + 1];
    b.to = w->events[b.forward ? i + 1 : i];
    *run = set->border_count++;
    set->borders[*run] = b;
    return ST_OK;
}

/* Makes borders from the numbers of intervals that cover each part of the line. */
static enum status add_borders(struct sweep *w, int plane, bool *any, struct err *err)
{
    int cover[2][2] = {{0}}, run[2][2] = {{-1, -1}, {-1, -1}};
    *any = false;
    for (int i = 0; i + 1 < w->event_count; i++) {
        for (int k = 0; k < 4; k++) cover[k / 2][k % 2] += w->covers[i][k / 2][k % 2];
        for (int which = BELOW; which <= ABOVE; which++) {
            const bool on[2] = {on_surface(cover, which, LEFT), on_surface(cover, which, RIGHT)};
            const int *room = w->room_at[i][which];
            for (int side = LEFT; side <= RIGHT; side++) {
                int *at = &run[which][side];
                const bool ends = on[side] && !(on[!side] && room[LEFT] == room[RIGHT]);
                if (!ends) *at = -1;
                const struct border b = {.plane = plane,
                                         .side = which == BELOW ? 1 : -1,
                                         .room = room[side],
                                         .forward = (side == LEFT) == (which == BELOW)};
                if (ends && add_border(w, i, b, at, err)) return err->status;
                *any |= ends;
                w->border_at[i][which][side] = *at;
            }
        }
        /* for add_names(): whether the surface is on this side of the line */
        for (int k = 0; k < 4; k++) w->covers[i][k / 2][k % 2] = on_surface(cover, k / 2, k % 2);
    }
    return ST_OK;
}

/* Records the names of the facets that are part of the surface along the line. */
static enum status add_names(struct sweep *w, struct err *err)
{
    for (int i = 0; i < w->interval_count; i++) {
        const struct interval *v = &w->intervals[i];
        const struct polygon *p = &w->set->polygons[v->polygon];
        if (!p->side) continue;
        const int which = p->side > 0 ? BELOW : ABOVE;
        for (int side = LEFT; side <= RIGHT; side++) {
            int last = -1;
            for (int k = w->index[v->from]; v->on[side] && k < w->index[v->to]; k++) {
                if (!w->covers[k][which][side]) continue;
                w->visible[v->polygon] = 1;
                const int border = w->border_at[k][which][side];
                if (border < 0 || border == last) continue;
                last = border;
                w->bordered[v->polygon] = 1;
                struct border_set *set = w->borders;
                if (exact_grow(&set->names, &set->name_capacity, set->name_count + 1, sizeof *set->names, err))
                    return err->status;
                set->names[set->name_count++] = (struct border_name){border, p->name};
            }
        }
    }
    return ST_OK;
}

/* Finds the borders on one line. entries: all edges of the plane's polygons on it. */
static enum status sweep_line(struct sweep *w, int plane, const struct entry *entries, int count, struct err *err)
{
    struct convex_set *set = w->set;
    struct exact_space *space = &set->space;
    const int other = set->edges[entries[0].edge].plane;
    w->line = entries[0].line;
    const int turn = exact_turn(space->planes[plane].n, space->lines[w->line].d, space->planes[other].n);
    w->event_count = w->interval_count = 0;
    for (int i = 0; i < count; i++) {
        const struct polygon p = set->polygons[entries[i].polygon];
        const int next = entries[i].edge + 1 < p.first + p.count ? entries[i].edge + 1 : p.first;
        const double *a = space->points[set->edges[entries[i].edge].corner].p;
        const double *b = space->points[set->edges[next].corner].p;
        double low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(a[k], b[k]);
            high[k] = fmax(a[k], b[k]);
        }
        for (int k = w->first[p.solid]; k < w->first[p.solid + 1]; k++) {
            const int q = w->polygon_of[w->near[k]];
            if (q < 0 || w->stamp[q] == w->line) continue;
            if (!boxes_meet(low, high, set->polygons[q].low, set->polygons[q].high)) continue;
            w->stamp[q] = w->line;
            if (add_interval(w, q, plane, other, turn, err)) return err->status;
        }
    }
    qsort_r(w->events, (size_t)w->event_count, sizeof *w->events, compare_events, w);
    int kept = 0;
    for (int i = 0; i < w->event_count; i++)
        if (!kept || w->events[kept - 1] != w->events[i]) w->events[kept++] = w->events[i];
    w->event_count = kept;
    if (exact_grow(&w->index, &w->index_capacity, space->point_count, sizeof *w->index, err) ||
        exact_grow(&w->covers, &w->covers_capacity, kept + 1, sizeof *w->covers, err) ||
        exact_grow(&w->room_at, &w->room_at_capacity, kept + 1, sizeof *w->room_at, err) ||
        exact_grow(&w->border_at, &w->border_at_capacity, kept + 1, sizeof *w->border_at, err))
        return err->status;
    memset(w->covers, 0, (size_t)kept * sizeof *w->covers);
    for (int i = 0; i < kept; i++) w->index[w->events[i]] = i;
    for (int i = 0; i < w->interval_count; i++) {
        const struct interval *v = &w->intervals[i];
        const int side = set->polygons[v->polygon].side;
        for (int k = 0; k < 4; k++)
            if (v->on[k % 2] && (k / 2 == BELOW ? side >= 0 : side <= 0)) {
                w->covers[w->index[v->from]][k / 2][k % 2]++;
                w->covers[w->index[v->to]][k / 2][k % 2]--;
            }
    }
    bool any;
    find_rooms(w);
    if (add_borders(w, plane, &any, err) || add_names(w, err)) return err->status;
    if (!any) return ST_OK;
    struct border_set *b = w->borders;
    if (exact_grow(&b->points, &b->point_capacity, b->point_count + kept, sizeof *b->points, err)) return err->status;
    for (int i = 0; i < kept; i++) b->points[b->point_count++] = (struct line_point){w->line, w->events[i]};
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- a plane */

static int compare_entries(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    if (p->line != q->line) return p->line < q->line ? -1 : 1;
    return (p->edge > q->edge) - (p->edge < q->edge);
}

static enum status add_polygon(struct sweep *w, int polygon, struct err *err)
{
    if (exact_grow(&w->polygons, &w->polygon_capacity, w->polygon_count + 1, sizeof *w->polygons, err))
        return err->status;
    w->polygons[w->polygon_count++] = polygon;
    w->polygon_of[w->set->polygons[polygon].solid] = polygon;
    return ST_OK;
}

static enum status sweep_plane(struct sweep *w, int plane, struct err *err)
{
    struct convex_set *set = w->set;
    w->polygon_count = w->entry_count = 0;
    for (int i = w->plane_first[plane]; !err->status && i < w->plane_first[plane + 1]; i++)
        add_polygon(w, w->plane_facets[i], err);
    for (int i = w->plane_first[plane]; !err->status && i < w->plane_first[plane + 1]; i++) {
        const struct polygon p = set->polygons[w->plane_facets[i]];
        for (int k = w->first[p.solid]; !err->status && k < w->first[p.solid + 1]; k++) {
            const struct convex *c = &set->solids[w->near[k]];
            int section;
            if (w->polygon_of[w->near[k]] >= 0 || !boxes_meet(p.low, p.high, c->low, c->high)) continue;
            convex_section(set, w->near[k], plane, &section, err);
            if (!err->status && section >= 0) add_polygon(w, section, err);
        }
    }
    int old = w->stamp_capacity;
    if (!err->status) exact_grow(&w->stamp, &w->stamp_capacity, set->polygon_count, sizeof *w->stamp, err);
    for (; old < w->stamp_capacity; old++) w->stamp[old] = -1;
    for (int i = 0; !err->status && i < w->polygon_count; i++) {
        const struct polygon p = set->polygons[w->polygons[i]];
        w->stamp[w->polygons[i]] = -1;
        exact_grow(&w->entries, &w->entry_capacity, w->entry_count + p.count, sizeof *w->entries, err);
        for (int k = p.first; !err->status && k < p.first + p.count; k++)
            w->entries[w->entry_count++] = (struct entry){set->edges[k].line, w->polygons[i], k};
    }
    if (!err->status && w->entry_count) qsort(w->entries, (size_t)w->entry_count, sizeof *w->entries, compare_entries);
    for (int i = 0, k; !err->status && i < w->entry_count; i = k) {
        for (k = i + 1; k < w->entry_count && w->entries[k].line == w->entries[i].line;) k++;
        sweep_line(w, plane, &w->entries[i], k - i, err);
    }
    for (int i = 0; i < w->polygon_count; i++) w->polygon_of[set->polygons[w->polygons[i]].solid] = -1;
    return err->status;
}

enum status borders_find(struct border_set *borders, struct convex_set *set, const int *rooms, struct err *err)
{
    struct sweep w = {.set = set, .rooms = rooms, .borders = borders, .facets = set->polygon_count};
    const int planes = set->space.plane_count; /* sections add none */
    find_near(&w, err);
    w.plane_first = calloc((size_t)planes + 2, sizeof *w.plane_first);
    w.plane_facets = malloc((size_t)w.facets * sizeof *w.plane_facets);
    w.polygon_of = malloc((size_t)set->count * sizeof *w.polygon_of);
    w.bordered = calloc((size_t)w.facets, 1);
    w.visible = calloc((size_t)w.facets, 1);
    if (!err->status && !(w.plane_first && w.plane_facets && w.polygon_of && w.bordered && w.visible))
        err_nomem(err, "the surface of a union", (size_t)w.facets * sizeof *w.plane_facets);
    if (!err->status) {
        for (int i = 0; i < set->count; i++) w.polygon_of[i] = -1;
        for (int i = 0; i < w.facets; i++) w.plane_first[set->polygons[i].plane + 2]++;
        for (int i = 0; i < planes; i++) w.plane_first[i + 2] += w.plane_first[i + 1];
        for (int i = 0; i < w.facets; i++) w.plane_facets[w.plane_first[set->polygons[i].plane + 1]++] = i;
    }
    for (int i = 0; !err->status && i < planes; i++) sweep_plane(&w, i, err);
    for (int i = 0; !err->status && i < w.facets; i++) {
        if (!w.visible[i] || w.bordered[i]) continue;
        if (!exact_grow(&borders->inner, &borders->inner_capacity, borders->inner_count + 1, sizeof *borders->inner,
                        err))
            borders->inner[borders->inner_count++] = i;
    }
    free(w.first);
    free(w.near);
    free(w.plane_first);
    free(w.plane_facets);
    free(w.polygon_of);
    free(w.bordered);
    free(w.visible);
    free(w.polygons);
    free(w.entries);
    free(w.stamp);
    free(w.intervals);
    free(w.events);
    free(w.index);
    free(w.covers);
    free(w.room_at);
    free(w.border_at);
    return err->status;
}
