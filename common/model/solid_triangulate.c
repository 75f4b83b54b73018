/* solid_triangulate.c - triangulates faces with holes by ear clipping [Meisters 1975].
 *
 * A face is projected along the axis of its normal's largest component. Each hole is joined to the loop around it by a
 * bridge [Eberly 2008], a pair of edges from its rightmost corner to the nearest visible corner; holes are joined from
 * right to left, so that there always is such a corner among the loops joined so far. Then ears are clipped.
 *
 * What differs: corners in the middle of an edge remain corners, so that neighbouring faces agree; a triangle is an ear
 * only if no other corner is in it or on its border; and since bridges, and holes that touch the outer loop in a point,
 * make corners coincide, a diagonal is not drawn where an edge joins the same two positions.
 *
 * Positions along the axes are exact in doubles; corners on oblique edges are rounded, so that lengths below a few
 * units in the last place of the largest coordinate count as 0. Ears that only this tolerance forbids, and finally flat
 * ones, are clipped when there are no others, which happens where corners are that close. At the end the area of the
 * triangles is compared with that of the face. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/model/solid_mesh.h"

struct face_corner {
    double x, y;
    int vertex, next, prev;
    int cell_next; /* the next corner in its grid cell, or -1 */
    bool gone;
};

struct clipper {
    struct face_corner *corners; /* owned */
    int count, capacity;
    double tolerance;
    int *cells, columns, rows; /* owned: first corner of each cell, or -1; no grid if columns is 0 */
    int cell_capacity;
    double low_x, low_y, cell_size;
};

void solid_triangles_release(struct solid_triangles *t)
{
    if (!t) return;
    free(t->triangles);
    free(t->first);
    *t = (struct solid_triangles){0};
}

/* ------------------------------------------------------------------------------------------------------ predicates */

static bool same_position(const struct face_corner *a, const struct face_corner *b)
{
    return a->x == b->x && a->y == b->y;
}

/* Twice the signed area of a, b, c, positive if counter-clockwise; 0 if the triangle is flat within rounding. */
static double turn(const struct clipper *t, const struct face_corner *a, const struct face_corner *b,
                   const struct face_corner *c)
{
    const double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y;
    const double area = bx * cy - by * cx;
    const double longest = fmax(fmax(fabs(bx) + fabs(by), fabs(cx) + fabs(cy)), fabs(cx - bx) + fabs(cy - by));
    return fabs(area) <= t->tolerance * longest ? 0 : area;
}

/* Whether the direction from a corner to p is inside the corner's interior angle. */
static bool faces_towards(const struct clipper *t, const struct face_corner *at, const struct face_corner *p)
{
    const struct face_corner *before = &t->corners[at->prev], *after = &t->corners[at->next];
    const double a = turn(t, before, at, p), b = turn(t, at, after, p);
    return turn(t, before, at, after) > 0 ? a > 0 && b > 0 : a > 0 || b > 0;
}

/* Whether p, on the line through a and b, is between them or at one of them. */
static bool between(const struct face_corner *a, const struct face_corner *b, const struct face_corner *p)
{
    const double dx = b->x - a->x, dy = b->y - a->y;
    const double along = dx * (p->x - a->x) + dy * (p->y - a->y);
    return along >= 0 && along <= dx * dx + dy * dy;
}

/* Whether the edge c to d crosses or touches the segment from a to b, other than at a common end. */
static bool blocks(const struct clipper *t, const struct face_corner *a, const struct face_corner *b,
                   const struct face_corner *c, const struct face_corner *d)
{
    if (fmax(c->x, d->x) < fmin(a->x, b->x) || fmin(c->x, d->x) > fmax(a->x, b->x) ||
        fmax(c->y, d->y) < fmin(a->y, b->y) || fmin(c->y, d->y) > fmax(a->y, b->y))
        return false;
    const bool c_end = same_position(c, a) || same_position(c, b), d_end = same_position(d, a) || same_position(d, b);
    if (c_end && d_end) return true; /* the same segment */
    const double tc = turn(t, a, b, c), td = turn(t, a, b, d);
    if (!c_end && tc == 0 && between(a, b, c)) return true;
    if (!d_end && td == 0 && between(a, b, d)) return true;
    if (c_end || d_end) return false;
    const double ta = turn(t, c, d, a), tb = turn(t, c, d, b);
    if ((ta == 0 && between(c, d, a)) || (tb == 0 && between(c, d, b))) return true;
    return ((tc > 0 && td < 0) || (tc < 0 && td > 0)) && ((ta > 0 && tb < 0) || (ta < 0 && tb > 0));
}

/* ---------------------------------------------------------------------------------------------------------- bridges */

static int add_corner(struct clipper *t, const struct face_corner *c)
{
    t->corners[t->count] = *c;
    return t->count++;
}

/* Whether corners m of a hole and p are visible from each other. */
static bool are_visible(const struct clipper *t, int m, int p)
{
    const struct face_corner *a = &t->corners[m], *b = &t->corners[p];
    if (!faces_towards(t, a, b) || !faces_towards(t, b, a)) return false;
    for (int i = 0; i < t->count; i++)
        if (blocks(t, a, b, &t->corners[i], &t->corners[t->corners[i].next])) return false;
    return true;
}

/* Joins the hole that has corner m to the polygon that has corner `outer`; m is the hole's rightmost. */
static bool bridge(struct clipper *t, int m, int outer)
{
    double last = -1;
    int last_corner = -1, p;
    for (;;) { /* corners of the polygon, the nearest first */
        double best = INFINITY;
        int i = outer;
        p = -1;
        do {
            const double dx = t->corners[i].x - t->corners[m].x, dy = t->corners[i].y - t->corners[m].y;
            const double d = dx * dx + dy * dy;
            const bool later = d > last || (d == last && i > last_corner);
            if (later && (d < best || (d == best && i < p))) {
                best = d;
                p = i;
            }
            i = t->corners[i].next;
        } while (i != outer);
        if (p < 0) return false;
        int from = m; /* or another corner of the hole at the same position */
        do {
            if (same_position(&t->corners[from], &t->corners[m]) && are_visible(t, from, p)) break;
            from = t->corners[from].next;
        } while (from != m);
        if (from != m || are_visible(t, m, p)) {
            m = from;
            break;
        }
        last = best;
        last_corner = p;
    }
    /* p -> m ... -> copy of m -> copy of p -> successor of p */
    const int m2 = add_corner(t, &t->corners[m]), p2 = add_corner(t, &t->corners[p]);
    struct face_corner *c = t->corners;
    c[m2].prev = c[m].prev;
    c[c[m].prev].next = m2;
    c[m2].next = p2;
    c[p2].prev = m2;
    c[p2].next = c[p].next;
    c[c[p].next].prev = p2;
    c[p].next = m;
    c[m].prev = p;
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- ears */

static int clamp_cell(double v, int count) { return v < 0 ? 0 : v >= count ? count - 1 : (int)v; }

static int column_of(const struct clipper *t, double x)
{
    return clamp_cell((x - t->low_x) / t->cell_size, t->columns);
}
static int row_of(const struct clipper *t, double y) { return clamp_cell((y - t->low_y) / t->cell_size, t->rows); }

/* Whether corner q forbids the ear a, b, c. A corner that coincides with a or c does if an edge joins it to the
 * position of c or a. */
static bool forbids(const struct clipper *t, int ia, int ib, int ic, int iq, bool strict)
{
    const struct face_corner *a = &t->corners[ia], *b = &t->corners[ib], *c = &t->corners[ic], *q = &t->corners[iq];
    if (iq == ib || q->gone) return false;
    if (same_position(q, a) || same_position(q, c)) {
        const struct face_corner *other = same_position(q, a) ? c : a;
        return (q->next != ib && same_position(&t->corners[q->next], other)) ||
               (q->prev != ib && same_position(&t->corners[q->prev], other));
    }
    if (same_position(q, b)) return false;
    if (q->x < fmin(fmin(a->x, b->x), c->x) - t->tolerance || q->x > fmax(fmax(a->x, b->x), c->x) + t->tolerance ||
        q->y < fmin(fmin(a->y, b->y), c->y) - t->tolerance || q->y > fmax(fmax(a->y, b->y), c->y) + t->tolerance)
        return false;
    const double d0 = turn(t, a, b, q), d1 = turn(t, b, c, q), d2 = turn(t, c, a, q);
    return strict ? d0 >= 0 && d1 >= 0 && d2 >= 0 : d0 > 0 && d1 > 0 && d2 > 0;
}

/* Which ears are allowed: strict ones; also those with corners on their border; also flat ones. */
enum { EXACT, LOOSE, FLAT };

static bool is_ear(struct clipper *t, int b, int how)
{
    struct face_corner *k = t->corners;
    const int a = k[b].prev, c = k[b].next;
    const double area = turn(t, &k[a], &k[b], &k[c]);
    const bool strict = how == EXACT;
    if (how == FLAT ? area < 0 : !(area > 0)) return false;
    if (k[c].next == a) return true; /* the last triangle */
    if (!t->columns) {
        int q = c;
        do {
            if (forbids(t, a, b, c, q, strict)) return false;
            q = k[q].next;
        } while (q != b);
        return true;
    }
    const int x0 = column_of(t, fmin(fmin(k[a].x, k[b].x), k[c].x) - t->tolerance);
    const int x1 = column_of(t, fmax(fmax(k[a].x, k[b].x), k[c].x) + t->tolerance);
    const int y0 = row_of(t, fmin(fmin(k[a].y, k[b].y), k[c].y) - t->tolerance);
    const int y1 = row_of(t, fmax(fmax(k[a].y, k[b].y), k[c].y) + t->tolerance);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            int *link = &t->cells[y * t->columns + x];
            while (*link >= 0) {
                const int q = *link;
                if (k[q].gone) {
                    *link = k[q].cell_next;
                    continue;
                }
                if (forbids(t, a, b, c, q, strict)) return false;
                link = &k[q].cell_next;
            }
        }
    return true;
}

static bool make_grid(struct clipper *t)
{
    enum { FEW = 48 };
    t->columns = t->rows = 0;
    if (t->count < FEW) return true;
    double low[2] = {t->corners[0].x, t->corners[0].y}, high[2] = {low[0], low[1]};
    for (int i = 0; i < t->count; i++) {
        low[0] = fmin(low[0], t->corners[i].x);
        low[1] = fmin(low[1], t->corners[i].y);
        high[0] = fmax(high[0], t->corners[i].x);
        high[1] = fmax(high[1], t->corners[i].y);
    }
    const double w = high[0] - low[0], h = high[1] - low[1];
    t->low_x = low[0];
    t->low_y = low[1];
    t->cell_size = fmax(sqrt(w * h / t->count), fmax(w, h) / t->count) + 1e-300;
    t->columns = clamp_cell(w / t->cell_size, t->count) + 1;
    t->rows = clamp_cell(h / t->cell_size, t->count) + 1;
    const int need = t->columns * t->rows;
    if (need > t->cell_capacity) {
        int *cells = realloc(t->cells, (size_t)need * sizeof *cells);
        if (!cells) return false;
        t->cells = cells;
        t->cell_capacity = need;
    }
    for (int i = 0; i < need; i++) t->cells[i] = -1;
    for (int i = t->count - 1; i >= 0; i--) {
        int *cell = &t->cells[row_of(t, t->corners[i].y) * t->columns + column_of(t, t->corners[i].x)];
        t->corners[i].cell_next = *cell;
        *cell = i;
    }
    return true;
}

/* Cuts the polygon with corner `at`, of t->count corners, into triangles; returns their number, or -1 if there are no
 * ears left. */
static int clip_ears(struct clipper *t, int at, struct solid_triangle *out, int face)
{
    struct face_corner *k = t->corners;
    int left = t->count, made = 0, tried = 0;
    int how = EXACT;
    while (left >= 3) {
        const int a = k[at].prev, c = k[at].next;
        if (is_ear(t, at, how)) {
            out[made++] = (struct solid_triangle){{k[a].vertex, k[at].vertex, k[c].vertex}, face};
            if (left-- == 3) return made;
            k[a].next = c;
            k[c].prev = a;
            k[at].gone = true;
            at = k[c].next; /* skipping a corner avoids fans of thin triangles */
            tried = 0;
            how = EXACT;
        } else {
            at = c;
            if (++tried < left) continue;
            if (how++ == FLAT) return -1;
            tried = 0;
        }
    }
    return -1;
}

/* ------------------------------------------------------------------------------------------------------------ faces */

struct face_hole {
    int rightmost;
    double x, y;
};

static int compare_holes(const void *a, const void *b)
{
    const struct face_hole *p = a, *q = b;
    if (p->x != q->x) return p->x > q->x ? -1 : 1;
    if (p->y != q->y) return p->y > q->y ? -1 : 1;
    return (p->rightmost > q->rightmost) - (p->rightmost < q->rightmost);
}

static double coordinate(struct vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/* Stores the face's triangles at out: clipper.count - 2 of them. False: the face cannot be triangulated. */
static bool triangulate_face(struct clipper *t, const struct solid_mesh *mesh, int face, struct solid_triangle *out,
                             struct face_hole *holes)
{
    const struct solid_face *f = &mesh->faces[face];
    const double n[3] = {f->normal.x, f->normal.y, f->normal.z};
    int axis = 0, wanted = -2, hole_count = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(n[i]) > fabs(n[axis])) axis = i;
    const int u = (axis + (n[axis] > 0 ? 1 : 2)) % 3, v = (axis + (n[axis] > 0 ? 2 : 1)) % 3;
    double largest = 0;
    t->count = 0;
    for (int l = f->loop; l < f->loop + f->loops; l++) {
        const int first = mesh->loops[l].half_edge, begin = t->count;
        int h = first, right = begin;
        do {
            const struct vec3 p = mesh->vertices[mesh->half_edges[h].origin].p;
            const struct face_corner c = {.x = coordinate(p, u),
                                          .y = coordinate(p, v),
                                          .vertex = mesh->half_edges[h].origin,
                                          .prev = t->count - 1,
                                          .next = t->count + 1,
                                          .cell_next = -1};
            largest = fmax(largest, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
            const int i = add_corner(t, &c);
            if (c.x > t->corners[right].x || (c.x == t->corners[right].x && c.y > t->corners[right].y)) right = i;
            h = mesh->half_edges[h].next;
        } while (h != first);
        t->corners[begin].prev = t->count - 1;
        t->corners[t->count - 1].next = begin;
        if (l > f->loop) holes[hole_count++] = (struct face_hole){right, t->corners[right].x, t->corners[right].y};
    }
    t->tolerance = 16 * 0x1p-53 * largest;
    qsort(holes, (size_t)hole_count, sizeof *holes, compare_holes);
    for (int i = 0; i < hole_count; i++)
        if (!bridge(t, holes[i].rightmost, 0)) return false;
    wanted += t->count;
    if (!make_grid(t)) return false;
    if (clip_ears(t, 0, out, face) != wanted) return false;
    double sum = 0, area = 0;
    for (int i = 0; i < wanted; i++) {
        const struct vec3 a = mesh->vertices[out[i].v[0]].p, b = mesh->vertices[out[i].v[1]].p;
        const struct vec3 c = mesh->vertices[out[i].v[2]].p;
        sum += 0.5 * vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)), f->normal);
    }
    double around = 0;
    for (int l = f->loop; l < f->loop + f->loops; l++) {
        const double one = solid_mesh_loop_area(mesh, l);
        area += one;
        around += fabs(one);
    }
    return fabs(sum - area) <= 1e-9 * around + 1e3 * t->tolerance * largest;
}

enum status solid_mesh_triangulate(struct solid_triangles *t, const struct solid_mesh *mesh, struct err *err)
{
    const size_t max_corners = (size_t)mesh->half_edge_count + 2 * (size_t)mesh->loop_count + 1;
    struct clipper clipper = {.corners = malloc(max_corners * sizeof *clipper.corners)};
    struct face_hole *holes = malloc(((size_t)mesh->loop_count + 1) * sizeof *holes);
    t->triangles = malloc(max_corners * sizeof *t->triangles);
    t->first = malloc(((size_t)mesh->face_count + 1) * sizeof *t->first);
    if (!clipper.corners || !holes || !t->triangles || !t->first)
        err_nomem(err, "triangles", max_corners * sizeof *t->triangles);
    for (int i = 0; !err->status && i < mesh->face_count; i++) {
        t->first[i] = t->count;
        if (triangulate_face(&clipper, mesh, i, t->triangles + t->count, holes))
            t->count += clipper.count - 2;
        else
            err_set(err, ST_DATA,
                    "face %d, %s: its loops cross or have the wrong orientation, wanted a simple polygon with holes.",
                    i + 1, solid_face_name(mesh, i));
    }
    if (!err->status) t->first[mesh->face_count] = t->count;
    free(clipper.corners);
    free(clipper.cells);
    free(holes);
    if (err->status) solid_triangles_release(t);
    return err->status;
}
