/* unite_faces.c - loops of a body as faces with holes, and their names.
 *
 * Input are closed loops of half-edges, each on one side of one plane; output are faces, each with one outer loop
 * and its holes. Everything that decides is exact (exact.h).
 *
 * Outer or hole. Loops are projected along the axis of their normal's largest component. At the corner with the
 * least coordinates (u, then v) the loop is convex; if the face continues there towards lower u, the face is outside
 * the loop, which is a hole.
 *
 * Whose hole. It belongs to the outer loop of least area that contains it, by the winding numbers of its corners: of
 * edges that cross the horizontal line through a corner, those that go up to its right count 1, those that go down
 * -1. A corner on the other loop says nothing, and the next one is asked; if all are on it, the middle of an edge
 * decides, in floating point, because it lies well inside or outside. Loops are sorted by plane, side and room
 * first, so only those that can belong together are compared: O(k^2) for k loops of a side.
 *
 * Names. A face has the name of lowest rank among those of the solids' facets that it is made of and that belong to
 * its room. Facets that lie inside a face without touching its borders are found by their middle. The other names
 * are merged into it, and logged. */
#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "stages/build_model/solid/unite_internal.h"

/* Axes u, v of the projection in which a face seen from outside keeps its orientation. */
static void projection(const struct body_union *j, const struct border *b, int *u, int *v)
{
    const int64_t *n = j->set.space.planes[b->plane].n;
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (llabs(n[i]) > llabs(n[k])) k = i;
    const bool same = (n[k] > 0) == (b->side > 0);
    *u = (k + (same ? 1 : 2)) % 3;
    *v = (k + (same ? 2 : 1)) % 3;
}

/* A loop is a hole if the face continues towards lower u at the loop's corner with the lowest u (then v). */
static void classify_loop(struct body_union *j, int loop)
{
    const struct half *h = j->halves;
    const struct exact_space *s = &j->set.space;
    const int first = j->loops[loop].half;
    const struct border *b = &j->borders.borders[h[first].border];
    int u, v, lowest = h[first].from;
    projection(j, b, &u, &v);
    const double *origin = s->points[lowest].p;
    double area = 0;
    for (int i = h[first].next; i != first; i = h[i].next) {
        const int c = exact_compare(s, h[i].from, lowest, u);
        if (c < 0 || (!c && exact_compare(s, h[i].from, lowest, v) < 0)) lowest = h[i].from;
        const double *p = s->points[h[i].from].p, *q = s->points[h[h[i].next].from].p;
        area += 0.5 * ((p[u] - origin[u]) * (q[v] - origin[v]) - (q[u] - origin[u]) * (p[v] - origin[v]));
    }
    j->loops[loop].area = fabs(area);
    /* the direction in the plane towards lower u at the same v */
    int64_t n[3], down[3], west[3] = {0};
    const int k = 3 - u - v;
    unite_half_outward(j, first, n);
    west[u] = n[k] > 0 ? -n[k] : n[k];
    west[k] = n[k] > 0 ? n[u] : -n[u];
    unite_negated(n, down);
    int i = first;
    do {
        if (h[i].from == lowest) {
            int64_t back[3], on[3];
            unite_half_direction(j, h[i].prev, back);
            unite_negated(back, back);
            unite_half_direction(j, i, on);
            if (exact_before(back, west, on, down)) j->loops[loop].hole = true;
        }
        i = h[i].next;
    } while (i != first);
}

/* A point of the face's plane is outside (-1), on (0) or inside (1) a loop: its winding number in the projection. */
static int point_in_loop(const struct body_union *j, int point, int loop)
{
    const struct half *h = j->halves;
    const struct exact_space *s = &j->set.space;
    const int first = j->loops[loop].half;
    const struct border *b = &j->borders.borders[h[first].border];
    int u, v, i = first, winding = 0;
    projection(j, b, &u, &v);
    do {
        const int a = h[i].from, c = h[h[i].next].from;
        const int va = exact_compare(s, a, point, v), vc = exact_compare(s, c, point, v);
        if (a == point) return 0;
        if (va * vc <= 0) {
            const struct border *e = &j->borders.borders[h[i].border];
            const struct exact_line *l = &s->lines[e->line];
            const int other = l->plane[l->plane[0] == b->plane];
            int64_t d[3], n[3];
            unite_half_direction(j, i, d);
            unite_half_outward(j, i, n);
            const int left = exact_turn(n, d, s->planes[other].n) * exact_side(s, point, other);
            if (!left) { /* on the edge's line: on the edge if between its ends */
                const int ua = exact_compare(s, a, point, u), uc = exact_compare(s, c, point, u);
                if (ua * uc <= 0) return 0;
            } else if (va <= 0 && vc > 0 && left > 0) {
                winding++;
            } else if (va > 0 && vc <= 0 && left < 0) {
                winding--;
            }
        }
        i = h[i].next;
    } while (i != first);
    return winding ? 1 : -1;
}

/* The same for coordinates, in floating point, for positions well inside or outside. */
bool unite_position_in_loop(const struct body_union *j, const double p[3], int loop)
{
    const struct half *h = j->halves;
    const int first = j->loops[loop].half;
    int u, v, i = first;
    bool in = false;
    projection(j, &j->borders.borders[h[first].border], &u, &v);
    do {
        const double *a = j->set.space.points[h[i].from].p, *b = j->set.space.points[h[h[i].next].from].p;
        if ((a[v] > p[v]) != (b[v] > p[v]) && p[u] < a[u] + (p[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u])) in = !in;
        i = h[i].next;
    } while (i != first);
    return in;
}

static bool loop_in_loop(const struct body_union *j, int loop, int outer)
{
    const struct half *h = j->halves;
    const int first = j->loops[loop].half;
    int i = first;
    do {
        const int in = point_in_loop(j, h[i].from, outer);
        if (in) return in > 0;
        i = h[i].next;
    } while (i != first);
    /* all its corners are on the other loop: the middle of an edge decides */
    const double *a = j->set.space.points[h[first].from].p, *b = j->set.space.points[h[h[first].next].from].p;
    return unite_position_in_loop(j, (double[3]){0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])}, outer);
}

static const struct border *loop_border(const struct body_union *j, int loop)
{
    return &j->borders.borders[j->halves[j->loops[loop].half].border];
}

struct loop_order {
    int key, room, loop; /* key: 2 plane + side */
};

static int compare_loops(const void *a, const void *b)
{
    const struct loop_order *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    if (p->room != q->room) return p->room < q->room ? -1 : 1;
    return (p->loop > q->loop) - (p->loop < q->loop);
}

/* Makes faces from the loops of one room on one side of one plane. */
static enum status faces_of_side(struct body_union *j, const struct loop_order *loops, int count, const struct solid *s,
                                 struct err *err)
{
    for (int i = 0; i < count; i++) {
        const int l = loops[i].loop;
        if (j->loops[l].hole) continue;
        if (exact_grow(&j->faces, &j->face_capacity, j->face_count + 1, sizeof *j->faces, err)) return err->status;
        const struct border *b = loop_border(j, l);
        j->loops[l].face = j->face_count;
        j->faces[j->face_count++] = (struct union_face){b->plane, b->side, INT32_MAX, l, 0};
    }
    for (int i = 0; i < count; i++) {
        const int l = loops[i].loop;
        int best = -1;
        if (!j->loops[l].hole) continue;
        for (int k = 0; k < count; k++) {
            const int o = loops[k].loop;
            if (j->loops[o].hole || j->loops[o].area <= j->loops[l].area) continue;
            if (best >= 0 && j->loops[o].area >= j->loops[best].area) continue;
            if (loop_in_loop(j, l, o)) best = o;
        }
        if (best < 0) return unite_broken(s, "a hole has no face around it", err);
        j->loops[l].face = j->loops[best].face;
        j->faces[j->loops[best].face].holes++;
    }
    return ST_OK;
}

static int face_at(const struct body_union *j, const struct loop_order *loops, int count, const double p[3])
{
    int best = -1;
    for (int i = 0; i < count; i++) {
        const int l = loops[i].loop;
        if (j->loops[l].hole || !unite_position_in_loop(j, p, l)) continue;
        if (best < 0 || j->loops[l].area < j->loops[best].area) best = l;
    }
    return best < 0 ? -1 : j->loops[best].face;
}

static bool side_is_below(const void *loop, const void *key)
{
    return ((const struct loop_order *)loop)->key < *(const int *)key;
}

static int side_begin(const struct loop_order *order, int count, int key)
{
    return (int)sort_place(order, (size_t)count, sizeof *order, side_is_below, &key);
}

/* Names each face after the lowest rank among its facets of its room, and records the names that it merged.
 * loop_of_border: a loop of each border. */
static enum status name_faces(struct body_union *j, const struct loop_order *order, const int *loop_of_border,
                              struct merges *merges, const struct name_table *names, struct err *err)
{
    const struct border_set *b = &j->borders;
    const int first = merges->count;
    if (exact_grow(&merges->merges, &merges->capacity, first + b->name_count + b->inner_count, sizeof *merges->merges,
                   err))
        return err->status;
    /* until names are known, a merge's `into` is the face */
    for (int i = 0; i < b->name_count; i++)
        merges->merges[merges->count++] =
            (struct merge){b->names[i].name, j->loops[loop_of_border[b->names[i].border]].face};
    for (int i = 0; i < b->inner_count; i++) {
        const struct polygon *p = &j->set.polygons[b->inner[i]];
        double middle[3] = {0};
        for (int k = p->first; k < p->first + p->count; k++)
            for (int a = 0; a < 3; a++) middle[a] += j->set.space.points[j->set.edges[k].corner].p[a] / p->count;
        const int key = 2 * p->plane + (p->side > 0), begin = side_begin(order, j->loop_count, key);
        const int face = face_at(j, &order[begin], side_begin(order, j->loop_count, key + 1) - begin, middle);
        if (face >= 0) merges->merges[merges->count++] = (struct merge){p->name, face};
    }
    for (int i = first; i < merges->count; i++) {
        struct union_face *f = &j->faces[merges->merges[i].into];
        const int name = merges->merges[i].name;
        if (names->room[name] == loop_border(j, f->loop)->room && name < f->name) f->name = name;
    }
    int kept = first;
    for (int i = first; i < merges->count; i++) {
        const struct merge m = {merges->merges[i].name, j->faces[merges->merges[i].into].name};
        names->present[m.name] = 1;
        if (m.name != m.into) merges->merges[kept++] = m;
    }
    merges->count = kept;
    return ST_OK;
}

enum status unite_make_faces(struct body_union *j, const int *loop_of_border, struct merges *merges,
                             const struct name_table *names, const struct solid *s, struct err *err)
{
    struct loop_order *order = malloc(((size_t)j->loop_count + 1) * sizeof *order);
    if (!order) err_nomem(err, "faces of a union", (size_t)j->loop_count * sizeof *order);
    for (int i = 0; !err->status && i < j->loop_count; i++) {
        classify_loop(j, i);
        const struct border *b = loop_border(j, i);
        order[i] = (struct loop_order){2 * b->plane + (b->side > 0), b->room, i};
    }
    if (!err->status && j->loop_count) qsort(order, (size_t)j->loop_count, sizeof *order, compare_loops);
    for (int i = 0, k; !err->status && i < j->loop_count; i = k) {
        for (k = i + 1; k < j->loop_count && order[k].key == order[i].key && order[k].room == order[i].room;) k++;
        faces_of_side(j, &order[i], k - i, s, err);
    }
    if (!err->status) name_faces(j, order, loop_of_border, merges, names, err);
    free(order);
    return err->status;
}
