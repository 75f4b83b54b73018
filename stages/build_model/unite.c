/* unite.c - the union of convex solids as closed half-edge meshes.
 *
 * borders_find() returns the borders of the surface in each plane: segments of lines with the surface on their left.
 * They are joined to a half-edge mesh in these steps.
 *
 * - Segments are cut at the ends of others that lie on them, so that faces that meet have the same edges.
 * - The faces around an edge are sorted by angle, exactly. Each face is where solid begins or where it ends; faces with
 *   solid between them become neighbours (twins). So solids that touch in an edge stay separate there.
 * - The next half-edge in a face is the one that bounds the same corner of the face: the first one clockwise.
 * - Half-edges around a corner of the solid, one fan of faces, share a vertex; another fan gets another vertex.
 * - A vertex with two faces only, in the middle of an edge, is removed. Where several edges join the same two vertices,
 *   all but one are split in the middle, so that a pair of vertices identifies an edge; so is an edge that crosses a
 *   third face from corner to corner, so that no triangle of that face has the same side.
 *
 * docs/decisions/0015 explains why each step is exact. */
#include "stages/build_model/unite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/build_model/borders.h"
#include "stages/build_model/unite_names.h"

struct half {
    int border, from;     /* point where it begins; -1: in the middle of an edge, at `middle` */
    int next, prev, twin; /* twin -1: removed */
    int vertex, loop;
    double middle[3];
};

struct union_loop {
    int half; /* one of its half-edges that is not removed */
    int face; /* -1: unknown yet */
    bool hole;
    double area; /* of the projection along the axis of the normal's largest component */
};

struct union_face {
    int plane, side, name; /* name: the lowest rank */
    int loop, holes;       /* outer loop, number of holes */
};

struct body_union { /* the body being united */
    struct convex_set set;
    struct border_set borders;
    struct half *halves; /* all owned */
    struct union_loop *loops;
    struct union_face *faces;
    int half_count, half_capacity, loop_count, loop_capacity, face_count, face_capacity;
    int vertex_count;
};

struct polygon_soup { /* the faces of all bodies as polygons, with offsets instead of pointers */
    struct vec3 *vertices;
    struct solid_polygon *polygons;
    int *corners, *sizes;
    size_t *at; /* of each polygon in corners, in sizes */
    int vertex_count, vertex_capacity, polygon_count, polygon_capacity, corner_count, corner_capacity, size_count;
    int size_capacity, at_capacity;
};

static enum status broken(const struct solid *s, const char *what, struct err *err)
{
    return err_set(err, ST_INTERNAL, "the surface of body %s does not close: %s; this is a bug.", s->body, what);
}

/* The direction of a half-edge; outward(): the outward normal of its face. */
static void direction(const struct body_union *j, int half, int64_t d[3])
{
    const struct border *b = &j->borders.borders[j->halves[half].border];
    for (int i = 0; i < 3; i++) d[i] = j->set.space.lines[b->line].d[i] * (b->forward ? 1 : -1);
}

static void outward(const struct body_union *j, int half, int64_t n[3])
{
    const struct border *b = &j->borders.borders[j->halves[half].border];
    for (int i = 0; i < 3; i++) n[i] = j->set.space.planes[b->plane].n[i] * b->side;
}

static void negated(const int64_t a[3], int64_t out[3])
{
    for (int i = 0; i < 3; i++) out[i] = -a[i];
}

/* ------------------------------------------------------------------------------------------------ edges and twins */

static enum status add_half(struct body_union *j, int border, int from, struct err *err)
{
    if (exact_grow(&j->halves, &j->half_capacity, j->half_count + 1, sizeof *j->halves, err)) return err->status;
    j->halves[j->half_count++] =
        (struct half){.border = border, .from = from, .next = -1, .prev = -1, .twin = -1, .vertex = -1, .loop = -1};
    return ST_OK;
}

/* Pairs the half-edges of one edge, halves[of[0 .. count)]: those with solid between them become twins. Turning
 * counter-clockwise about the line, solid begins at a face whose half-edge goes backward and ends at one that goes
 * forward. A plane that passes straight through has no border here, so pairs nest like brackets. */
static enum status pair_around(struct body_union *j, int *of, int count, const struct solid *s, struct err *err)
{
    const struct border *borders = j->borders.borders;
#define FORWARD(h) borders[j->halves[h].border].forward
    if (count == 2 && FORWARD(of[0]) != FORWARD(of[1])) {
        j->halves[of[0]].twin = of[1];
        j->halves[of[1]].twin = of[0];
        return ST_OK;
    }
    if (count % 2) return broken(s, "an edge has no opposite", err);
    /* normals, negated where needed so that all are on the same side of their half-plane */
    int64_t(*u)[3] = malloc((size_t)count * sizeof *u);
    int *order = malloc(2 * (size_t)count * sizeof *order), *open, depth = 0, min_depth = 0, start = 0;
    if (!u || !order) {
        free(u);
        free(order);
        return err_nomem(err, "the faces about an edge", (size_t)count * sizeof *u);
    }
    open = order + count;
    const int64_t *d = j->set.space.lines[borders[j->halves[of[0]].border].line].d;
    for (int i = 0; i < count; i++) {
        outward(j, of[i], u[i]);
        if (!FORWARD(of[i])) negated(u[i], u[i]);
    }
    for (int i = 0; i < count; i++) { /* by angle from the first */
        int k = i;
        for (; k > 0 && exact_before(u[0], u[i], u[order[k - 1]], d); k--) order[k] = order[k - 1];
        order[k] = i;
    }
    for (int i = 0; i < count; i++) {
        depth += FORWARD(of[order[i]]) ? -1 : 1;
        if (depth < min_depth) {
            min_depth = depth;
            start = i + 1;
        }
    }
    const enum status st = depth ? broken(s, "the faces around an edge do not alternate", err) : ST_OK;
    for (int i = 0; !st && i < count; i++) {
        const int h = of[order[(start + i) % count]];
        if (!FORWARD(h)) {
            open[depth++] = h;
            continue;
        }
        const int o = open[--depth];
        j->halves[h].twin = o;
        j->halves[o].twin = h;
    }
    free(u);
    free(order);
    return st;
#undef FORWARD
}

struct along {
    const struct exact_space *space;
    const struct exact_line *line;
};

static int compare_along(const void *a, const void *b, void *ctx)
{
    const struct along *l = ctx;
    return exact_compare_along(l->space, l->line, *(const int *)a, *(const int *)b);
}

/* Cuts the borders of one line at the given points into half-edges, and pairs these. index is scratch, by point. */
static enum status cut_line(struct body_union *j, const int *borders, int border_count, int *points, int point_count,
                            int *index, const struct solid *s, struct err *err)
{
    const struct along along = {&j->set.space, &j->set.space.lines[j->borders.borders[borders[0]].line]};
    qsort_r(points, (size_t)point_count, sizeof *points, compare_along, (void *)&along);
    int count = 0, first = j->half_count;
    for (int i = 0; i < point_count; i++)
        if (!count || points[count - 1] != points[i]) points[count++] = points[i];
    for (int i = 0; i < count; i++) index[points[i]] = i;
    int *of = malloc(((size_t)count + 1) * sizeof *of);
    if (!of) return err_nomem(err, "the edges of a line", ((size_t)count + 1) * sizeof *of);
    enum status st = ST_OK;
    for (int i = 0; i < count; i++) of[i] = 0; /* half-edges of the edge from point i to i + 1 */
    for (int i = 0; !st && i < border_count; i++) {
        const struct border b = j->borders.borders[borders[i]];
        const int step = b.forward ? 1 : -1;
        for (int k = index[b.from]; !st && k != index[b.to]; k += step) {
            of[b.forward ? k : k - 1]++;
            st = add_half(j, borders[i], points[k], err);
        }
    }
    int *slots = malloc(((size_t)(j->half_count - first) + 1) * sizeof *slots);
    if (!st && !slots) st = err_nomem(err, "the edges of a line", (size_t)(j->half_count - first) * sizeof *slots);
    if (!st) {
        for (int i = 0, sum = 0; i < count; i++) {
            const int n = of[i];
            of[i] = sum;
            sum += n;
        }
        for (int h = first; h < j->half_count; h++) {
            const struct half *a = &j->halves[h];
            const int k = index[a->from] - (j->borders.borders[a->border].forward ? 0 : 1);
            slots[of[k]++] = h;
        }
        for (int i = 0, begin = 0; !st && i < count; begin = of[i++])
            if (of[i] > begin) st = pair_around(j, &slots[begin], of[i] - begin, s, err);
    }
    free(of);
    free(slots);
    return st;
}

static enum status make_halves(struct body_union *j, const struct solid *s, struct err *err)
{
    struct border_set *b = &j->borders;
    const size_t lines = (size_t)j->set.space.line_count, points = (size_t)j->set.space.point_count;
    int *border_first = calloc(lines + 2, sizeof *border_first), *point_first = calloc(lines + 2, sizeof *point_first);
    int *by_line = malloc(((size_t)b->border_count + 1) * sizeof *by_line);
    int *line_points = malloc(((size_t)b->point_count + 1) * sizeof *line_points);
    int *index = malloc((points + 1) * sizeof *index);
    char *ends = calloc(points + 1, 1); /* points in which a border ends */
    enum status st = border_first && point_first && by_line && line_points && index && ends
                         ? ST_OK
                         : err_nomem(err, "edges of a union", lines * sizeof *border_first);
    if (!st) {
        for (int i = 0; i < b->border_count; i++) {
            ends[b->borders[i].from] = ends[b->borders[i].to] = 1;
            border_first[b->borders[i].line + 2]++;
        }
        for (int i = 0; i < b->point_count; i++)
            if (ends[b->points[i].point]) point_first[b->points[i].line + 2]++;
        for (size_t i = 0; i < lines; i++) {
            border_first[i + 2] += border_first[i + 1];
            point_first[i + 2] += point_first[i + 1];
        }
        for (int i = 0; i < b->border_count; i++) by_line[border_first[b->borders[i].line + 1]++] = i;
        for (int i = 0; i < b->point_count; i++)
            if (ends[b->points[i].point]) line_points[point_first[b->points[i].line + 1]++] = b->points[i].point;
    }
    for (size_t i = 0; !st && i < lines; i++)
        if (border_first[i + 1] > border_first[i])
            st = cut_line(j, &by_line[border_first[i]], border_first[i + 1] - border_first[i],
                          &line_points[point_first[i]], point_first[i + 1] - point_first[i], index, s, err);
    free(border_first);
    free(point_first);
    free(by_line);
    free(line_points);
    free(index);
    free(ends);
    return st;
}

/* ---------------------------------------------------------------------------------------------------------- loops */

/* The half-edge that follows h in its face: of those that leave h's end, the first one clockwise from h's reverse. */
static int following(const struct body_union *j, int h, const int *leaving, int count)
{
    const struct border *b = &j->borders.borders[j->halves[h].border];
    int best = -1, found = 0;
    int64_t back[3], down[3], d[3], best_d[3];
    for (int i = 0; i < count; i++) {
        const struct border *o = &j->borders.borders[j->halves[leaving[i]].border];
        if (o->plane != b->plane || o->side != b->side || o->room != b->room) continue;
        found++;
        if (best < 0) {
            best = leaving[i];
            continue;
        }
        if (found == 2) {
            direction(j, h, back);
            negated(back, back);
            outward(j, h, down);
            negated(down, down);
            direction(j, best, best_d);
        }
        direction(j, leaving[i], d);
        if (!exact_before(back, d, best_d, down)) continue;
        best = leaving[i];
        memcpy(best_d, d, sizeof d);
    }
    return best;
}

static enum status link_halves(struct body_union *j, const struct solid *s, struct err *err)
{
    const size_t points = (size_t)j->set.space.point_count;
    int *first = calloc(points + 2, sizeof *first), *leaving = malloc(((size_t)j->half_count + 1) * sizeof *leaving);
    enum status st = first && leaving ? ST_OK : err_nomem(err, "loops of a union", points * sizeof *first);
    if (!st) {
        for (int i = 0; i < j->half_count; i++) first[j->halves[i].from + 2]++;
        for (size_t i = 0; i < points; i++) first[i + 2] += first[i + 1];
        for (int i = 0; i < j->half_count; i++) leaving[first[j->halves[i].from + 1]++] = i;
    }
    for (int i = 0; !st && i < j->half_count; i++) {
        const int to = j->halves[j->halves[i].twin].from;
        const int next = following(j, i, &leaving[first[to]], first[to + 1] - first[to]);
        if (next < 0 || j->halves[next].prev >= 0) {
            st = broken(s, "the edge of a face has no successor", err);
            break;
        }
        j->halves[i].next = next;
        j->halves[next].prev = i;
    }
    free(first);
    free(leaving);
    for (int i = 0; !st && i < j->half_count; i++) {
        if (j->halves[i].loop >= 0) continue;
        st = exact_grow(&j->loops, &j->loop_capacity, j->loop_count + 1, sizeof *j->loops, err);
        if (st) break;
        for (int h = i; j->halves[h].loop < 0; h = j->halves[h].next) j->halves[h].loop = j->loop_count;
        j->loops[j->loop_count++] = (struct union_loop){.half = i, .face = -1};
    }
    return st;
}

/* Makes a vertex for each fan of faces, and removes those in the middle of an edge. */
static void make_vertices(struct body_union *j)
{
    struct half *h = j->halves;
    for (int i = 0; i < j->half_count; i++) {
        if (h[i].vertex >= 0) continue;
        int count = 0;
        for (int k = i; h[k].vertex < 0; k = h[h[k].prev].twin, count++) h[k].vertex = j->vertex_count;
        j->vertex_count++;
        const int o = h[h[i].prev].twin;
        const struct border *b = j->borders.borders;
#define LINE(x) b[h[x].border].line
        if (count != 2 || LINE(i) != LINE(h[i].prev) || LINE(o) != LINE(h[o].prev)) continue;
#undef LINE
        const int gone[2] = {i, o};
        for (int k = 0; k < 2; k++) {
            const int g = gone[k], before = h[g].prev;
            h[before].next = h[g].next;
            h[h[g].next].prev = before;
            if (j->loops[h[g].loop].half == g) j->loops[h[g].loop].half = before;
        }
        h[h[i].prev].twin = h[o].prev;
        h[h[o].prev].twin = h[i].prev;
        h[i].twin = h[o].twin = -1;
    }
}

static void coordinates(const struct body_union *j, int half, double p[3])
{
    const struct half *h = &j->halves[half];
    memcpy(p, h->from >= 0 ? j->set.space.points[h->from].p : h->middle, 3 * sizeof *p);
}

/* ---------------------------------------------------------------------------------------------------------- faces */

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
    outward(j, first, n);
    west[u] = n[k] > 0 ? -n[k] : n[k];
    west[k] = n[k] > 0 ? n[u] : -n[u];
    negated(n, down);
    int i = first;
    do {
        if (h[i].from == lowest) {
            int64_t back[3], on[3];
            direction(j, h[i].prev, back);
            negated(back, back);
            direction(j, i, on);
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
            direction(j, i, d);
            outward(j, i, n);
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
static bool position_in_loop(const struct body_union *j, const double p[3], int loop)
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
    return position_in_loop(j, (double[3]){0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])}, outer);
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
        if (best < 0) return broken(s, "a hole has no face around it", err);
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
        if (j->loops[l].hole || !position_in_loop(j, p, l)) continue;
        if (best < 0 || j->loops[l].area < j->loops[best].area) best = l;
    }
    return best < 0 ? -1 : j->loops[best].face;
}

static int side_begin(const struct loop_order *order, int count, int key)
{
    int low = 0, high = count;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (order[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
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

static enum status make_faces(struct body_union *j, const int *loop_of_border, struct merges *merges,
                              const struct name_table *names, const struct solid *s, struct err *err)
{
    struct loop_order *order = malloc(((size_t)j->loop_count + 1) * sizeof *order);
    enum status st = order ? ST_OK : err_nomem(err, "faces of a union", (size_t)j->loop_count * sizeof *order);
    for (int i = 0; !st && i < j->loop_count; i++) {
        classify_loop(j, i);
        const struct border *b = loop_border(j, i);
        order[i] = (struct loop_order){2 * b->plane + (b->side > 0), b->room, i};
    }
    if (!st && j->loop_count) qsort(order, (size_t)j->loop_count, sizeof *order, compare_loops);
    for (int i = 0, k; !st && i < j->loop_count; i = k) {
        for (k = i + 1; k < j->loop_count && order[k].key == order[i].key && order[k].room == order[i].room;) k++;
        st = faces_of_side(j, &order[i], k - i, s, err);
    }
    if (!st) st = name_faces(j, order, loop_of_border, merges, names, err);
    free(order);
    return st;
}

struct edge_ends {
    int low, high, half;
    bool split;
};

static int compare_ends(const void *a, const void *b)
{
    const struct edge_ends *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return (p->half > q->half) - (p->half < q->half);
}

/* Whether a position on half-edge h's line is on an edge of the loop along that line. */
static bool edge_along(const struct body_union *j, const double p[3], int h, int loop)
{
    const struct half *k = j->halves;
    const int line = j->borders.borders[k[h].border].line, axis = j->set.space.lines[line].axis;
    int i = j->loops[loop].half;
    do {
        double a[3], b[3];
        coordinates(j, i, a);
        coordinates(j, k[i].next, b);
        if (j->borders.borders[k[i].border].line == line && (a[axis] < p[axis]) != (b[axis] < p[axis])) return true;
        i = k[i].next;
    } while (i != j->loops[loop].half);
    return false;
}

/* Whether half-edge h crosses the inside of a third face, from one of that face's corners to another. */
static bool crosses_a_face(const struct body_union *j, int h)
{
    const struct half *k = j->halves;
    const int end = k[h].twin, own[2] = {j->loops[k[h].loop].face, j->loops[k[end].loop].face};
    for (int a = k[k[h].prev].twin; a != h; a = k[k[a].prev].twin) {
        const int face = j->loops[k[a].loop].face;
        bool both = false;
        if (face == own[0] || face == own[1]) continue;
        for (int b = k[k[end].prev].twin; b != end && !both; b = k[k[b].prev].twin)
            both = j->loops[k[b].loop].face == face;
        if (!both) continue;
        double p[3], q[3];
        coordinates(j, h, p);
        coordinates(j, end, q);
        for (int i = 0; i < 3; i++) p[i] = 0.5 * (p[i] + q[i]);
        const int outer = j->faces[face].loop;
        bool in = !edge_along(j, p, h, outer) && position_in_loop(j, p, outer);
        for (int l = 0; in && j->faces[face].holes && l < j->loop_count; l++)
            in = !(j->loops[l].hole && j->loops[l].face == face &&
                   (edge_along(j, p, h, l) || position_in_loop(j, p, l)));
        if (in) return true;
    }
    return false;
}

/* Splits in the middle each edge whose ends another edge joins too, or that may be a side of a third face's triangle:
 * a pair of vertices then identifies an edge, also of the triangles. */
static enum status split_edges(struct body_union *j, struct err *err)
{
    struct edge_ends *ends = malloc(((size_t)j->half_count + 1) * sizeof *ends);
    int count = 0, kept = 0;
    enum status st = ends ? ST_OK : err_nomem(err, "edges of a union", (size_t)j->half_count * sizeof *ends);
    for (int i = 0; !st && i < j->half_count; i++) {
        if (j->halves[i].twin < i) continue;
        const int a = j->halves[i].vertex, b = j->halves[j->halves[i].twin].vertex;
        ends[count++] = (struct edge_ends){a < b ? a : b, a < b ? b : a, i, false};
    }
    if (!st && count) qsort(ends, (size_t)count, sizeof *ends, compare_ends);
    for (int i = 0; !st && i < count; i++) {
        const bool again = i && ends[i].low == ends[i - 1].low && ends[i].high == ends[i - 1].high;
        ends[i].split = again || crosses_a_face(j, ends[i].half);
    }
    for (int i = 0; !st && i < count; i++)
        if (ends[i].split) ends[kept++] = ends[i];
    for (int i = 0; !st && i < kept; i++) {
        const int pair[2] = {ends[i].half, j->halves[ends[i].half].twin}, made = j->half_count;
        double p[2][3];
        for (int k = 0; k < 2; k++) coordinates(j, pair[k], p[k]);
        for (int k = 0; !st && k < 2; k++) {
            st = add_half(j, j->halves[pair[k]].border, -1, err);
            if (st) break;
            struct half *h = j->halves, *m = &h[made + k];
            m->vertex = j->vertex_count;
            m->loop = h[pair[k]].loop;
            m->prev = pair[k];
            m->next = h[pair[k]].next;
            h[m->next].prev = made + k;
            h[pair[k]].next = made + k;
            m->twin = pair[1 - k];
            for (int a = 0; a < 3; a++) m->middle[a] = 0.5 * (p[0][a] + p[1][a]);
        }
        for (int k = 0; !st && k < 2; k++) j->halves[pair[k]].twin = made + 1 - k;
        j->vertex_count++;
    }
    free(ends);
    return st;
}

/* --------------------------------------------------------------------------------------------------------- result */

struct face_order {
    int name, face;
};

static int compare_faces(const void *a, const void *b)
{
    const struct face_order *p = a, *q = b;
    if (p->name != q->name) return p->name < q->name ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

static enum status add_loop(struct body_union *j, struct polygon_soup *r, int loop, int *vertex, struct err *err)
{
    const int first = j->loops[loop].half;
    int h = first, count = 0;
    do {
        int *v = &vertex[j->halves[h].vertex];
        if (*v < 0) {
            double p[3];
            if (exact_grow(&r->vertices, &r->vertex_capacity, r->vertex_count + 1, sizeof *r->vertices, err))
                return err->status;
            coordinates(j, h, p);
            /* divided, so that 2700000 becomes the double 2.7; + 0 removes negative zeros */
            r->vertices[r->vertex_count] = vec3_make(p[0] / 1e6 + 0., p[1] / 1e6 + 0., p[2] / 1e6 + 0.);
            *v = r->vertex_count++;
        }
        if (exact_grow(&r->corners, &r->corner_capacity, r->corner_count + 1, sizeof *r->corners, err))
            return err->status;
        r->corners[r->corner_count++] = *v;
        count++;
        h = j->halves[h].next;
    } while (h != first);
    if (exact_grow(&r->sizes, &r->size_capacity, r->size_count + 1, sizeof *r->sizes, err)) return err->status;
    r->sizes[r->size_count++] = count;
    return ST_OK;
}

static enum status add_result(struct body_union *j, struct polygon_soup *r, const char *body, const char *const *names,
                              struct err *err)
{
    struct face_order *order = malloc(((size_t)j->face_count + 1) * sizeof *order);
    int *vertex = malloc(((size_t)j->vertex_count + 1) * sizeof *vertex);
    int *hole_first = calloc((size_t)j->face_count + 2, sizeof *hole_first);
    int *holes = malloc(((size_t)j->loop_count + 1) * sizeof *holes);
    enum status st = order && vertex && hole_first && holes
                         ? ST_OK
                         : err_nomem(err, "faces of a union", (size_t)j->vertex_count * sizeof *vertex);
    if (!st) {
        for (int i = 0; i < j->vertex_count; i++) vertex[i] = -1;
        for (int i = 0; i < j->face_count; i++) order[i] = (struct face_order){j->faces[i].name, i};
        qsort(order, (size_t)j->face_count, sizeof *order, compare_faces);
        for (int i = 0; i < j->face_count; i++) hole_first[i + 2] = hole_first[i + 1] + j->faces[i].holes;
        for (int i = 0; i < j->loop_count; i++)
            if (j->loops[i].hole) holes[hole_first[j->loops[i].face + 1]++] = i;
    }
    for (int i = 0; !st && i < j->face_count; i++) {
        const struct union_face *f = &j->faces[order[i].face];
        const struct exact_plane *p = &j->set.space.planes[f->plane];
        const double n[3] = {(double)(p->n[0] * f->side), (double)(p->n[1] * f->side), (double)(p->n[2] * f->side)};
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (exact_grow(&r->polygons, &r->polygon_capacity, r->polygon_count + 1, sizeof *r->polygons, err) ||
            exact_grow(&r->at, &r->at_capacity, 2 * r->polygon_count + 2, sizeof *r->at, err)) {
            st = err->status;
            break;
        }
        r->at[2 * r->polygon_count] = (size_t)r->corner_count;
        r->at[2 * r->polygon_count + 1] = (size_t)r->size_count;
        r->polygons[r->polygon_count++] = (struct solid_polygon){
            .name = names[f->name],
            .body = body,
            .normal = vec3_make(n[0] / length + 0., n[1] / length + 0., n[2] / length + 0.),
            .offset = (double)(p->d * f->side) / length / 1e6 + 0.,
            .loops = 1 + f->holes,
        };
        st = add_loop(j, r, f->loop, vertex, err);
        for (int k = hole_first[order[i].face]; !st && k < hole_first[order[i].face + 1]; k++)
            st = add_loop(j, r, holes[k], vertex, err);
    }
    free(order);
    free(vertex);
    free(hole_first);
    free(holes);
    return st;
}

static void joined_release(struct body_union *j)
{
    convex_set_release(&j->set);
    border_set_release(&j->borders);
    free(j->halves);
    free(j->loops);
    free(j->faces);
}

/* Unites the solids of one body: list->solids[members[0 .. count)]. half_space_of: first half-space of each solid. */
static enum status unite_body(struct polygon_soup *r, const struct solid_list *list, const int *members, int count,
                              const size_t *half_space_of, const struct lattice_half_space *half_spaces,
                              const struct name_table *names, struct merges *merges, struct err *err)
{
    struct body_union j = {0};
    const struct solid *first = &list->solids[members[0]];
    enum status st = ST_OK;
    for (int i = 0; !st && i < count; i++) {
        const size_t at = half_space_of[members[i]];
        st = convex_set_add(&j.set, &list->solids[members[i]], &half_spaces[at], &names->rank[at], err);
    }
    if (!st) st = borders_find(&j.borders, &j.set, names->room, err);
    if (!st) st = make_halves(&j, first, err);
    if (!st) st = link_halves(&j, first, err);
    int *loop_of_border = malloc(((size_t)j.borders.border_count + 1) * sizeof *loop_of_border);
    if (!st && !loop_of_border) st = err_nomem(err, "faces of a union", (size_t)j.borders.border_count);
    if (!st) {
        for (int i = 0; i < j.half_count; i++) loop_of_border[j.halves[i].border] = j.halves[i].loop;
        make_vertices(&j);
        st = make_faces(&j, loop_of_border, merges, names, first, err);
    }
    if (!st) st = split_edges(&j, err);
    if (!st) st = add_result(&j, r, first->body, names->texts, err);
    free(loop_of_border);
    joined_release(&j);
    return st;
}

/* ----------------------------------------------------------------------------------------------------- whole lists */

void unite_log_release(struct unite_log *log)
{
    if (!log) return;
    free(log->notes);
    *log = (struct unite_log){0};
}

enum status solids_unite(struct solid_mesh *mesh, const struct solid_list *solids, struct unite_log *log,
                         struct err *err)
{
    const size_t n = (size_t)solids->count;
    struct lattice_half_space *half_spaces = NULL;
    struct name_table names = {0};
    struct merges merges = {0};
    struct polygon_soup r = {0};
    int *body = malloc((n + 1) * sizeof *body), *members = malloc((n + 1) * sizeof *members), bodies = 0;
    int *first = calloc(n + 2, sizeof *first);
    size_t *half_space_of = malloc((n + 1) * sizeof *half_space_of), at = 0;
    enum status st = body && members && first && half_space_of ? ST_OK : err_nomem(err, "solids", n * sizeof *body);

    if (!st) st = lattice_half_spaces(&half_spaces, solids, err);
    if (!st) st = unite_rank_names(&names, body, &bodies, solids, err);
    if (!st) {
        for (int i = 0; i < solids->count; at += (size_t)solids->solids[i++].count) {
            half_space_of[i] = at;
            first[body[i] + 2]++;
        }
        for (int i = 0; i < bodies; i++) first[i + 2] += first[i + 1];
        for (int i = 0; i < solids->count; i++) members[first[body[i] + 1]++] = i;
    }
    for (int i = 0; !st && i < bodies; i++)
        st = unite_body(&r, solids, &members[first[i]], first[i + 1] - first[i], half_space_of, half_spaces, &names,
                        &merges, err);
    for (int i = 0; !st && i < r.polygon_count; i++) {
        r.polygons[i].corners = r.corners + r.at[2 * i];
        r.polygons[i].sizes = r.sizes + r.at[2 * i + 1];
    }
    if (!st) st = solid_mesh_make(mesh, r.vertices, r.vertex_count, r.polygons, r.polygon_count, NULL, err);
    if (!st && log) st = unite_write_log(log, &merges, &names, err);
    if (st) {
        solid_mesh_release(mesh);
        if (log) unite_log_release(log);
    }
    free(half_spaces);
    free(names.texts);
    free(names.rank);
    free(names.room);
    free(names.present);
    free(merges.merges);
    free(r.vertices);
    free(r.polygons);
    free(r.corners);
    free(r.sizes);
    free(r.at);
    free(body);
    free(members);
    free(first);
    free(half_space_of);
    return st;
}
