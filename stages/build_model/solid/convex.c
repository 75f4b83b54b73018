/* convex.c - convex solids on the lattice: their facets, and their sections with planes.
 *
 * Rounding. A solid is an intersection of half-spaces with real coefficients; exact.h wants integers. Normals along
 * an axis and offsets are rounded to steps of the lattice. An oblique normal becomes exact where the ratios of its
 * components are those of small integers, which continued fractions find (walls between typed corners), otherwise it
 * is rounded to 2^-22. Two walls in one plane may differ in the last bits after that, and would leave slivers: so
 * planes are sorted, and each is replaced by the first that differs by at most two steps in normal and offset.
 *
 * Facets. Each facet begins as a square in its plane with corners just out of reach, and is cut by every other
 * half-space [Sutherland 1974]. A corner is the exact meeting point of three planes, so a cut never moves an
 * existing corner, and signs cannot contradict each other. A facet with a corner on the far planes left means that
 * the solid is unbounded; fewer than four facets mean that it is empty or flat.
 *
 * A section of a solid with a plane is a square in that plane, cut by all facets' planes.
 *
 * A solid of k half-spaces takes O(k^2) cuts of polygons of O(k) corners. */
#include "stages/build_model/solid/convex.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FAR_OUT ((int64_t)(SOLID_REACH / SOLID_STEP) + 1000000) /* of a facet's first square: just out of reach */
#define SNAP    2                                               /* max steps in normal and offset of equal planes */

void convex_set_release(struct convex_set *set)
{
    if (!set) return;
    exact_release(&set->space);
    free(set->solids);
    free(set->polygons);
    free(set->edges);
    free(set->scratch[0]);
    free(set->scratch[1]);
    free(set->signs);
    *set = (struct convex_set){0};
}

/* ---------------------------------------------------------------------------------------------------- the lattice */

struct oblique {         /* a plane; the first nonzero component of its normal is positive */
    int64_t n[3], q;     /* for comparison: scaled to a largest component of 2^22; the offset in steps */
    int64_t whole[3], d; /* the plane on the lattice */
    size_t of;           /* half-space */
    bool turned;         /* the half-space has the opposite normal */
};

static int by_plane(const void *a, const void *b)
{
    const struct oblique *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->n[i] != q->n[i]) return p->n[i] < q->n[i] ? -1 : 1;
    if (p->q != q->q) return p->q < q->q ? -1 : 1;
    return (p->of > q->of) - (p->of < q->of);
}

static bool nearly_same(const struct oblique *a, const struct oblique *b)
{
    for (int i = 0; i < 3; i++)
        if (llabs(a->n[i] - b->n[i]) > SNAP) return false;
    return llabs(a->q - b->q) <= SNAP;
}

static int64_t divisor(int64_t a, int64_t b) { return b ? divisor(b, a % b) : llabs(a); }

/* p / q = x within 1e-13, with q at most EXACT_NORMAL, by continued fractions; false: none. |x| is at most 1. */
static bool ratio(double x, int64_t *p, int64_t *q)
{
    int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    double rest = x;
    for (int i = 0; i < 40; i++) {
        const double whole = floor(rest);
        if (fabs(whole) > EXACT_NORMAL) return false;
        const int64_t p2 = (int64_t)whole * p1 + p0, q2 = (int64_t)whole * q1 + q0;
        if (q2 > EXACT_NORMAL) return false;
        p0 = p1;
        q0 = q1;
        p1 = p2;
        q1 = q2;
        if (fabs(x - (double)p1 / (double)q1) <= 1e-13) {
            *p = p1;
            *q = q1;
            return true;
        }
        rest = 1 / (rest - whole);
    }
    return false;
}

/* Makes the normal an integer vector: exact where the ratios of its components are those of small integers (walls
 * between typed corners), otherwise rounded to 2^-22. d is the offset, in steps, times the normal's length. max: the
 * largest component's magnitude. */
static void to_integers(struct oblique *o, const double n[3], double max, double offset)
{
    int64_t p[3], q[3], common = 1;
    bool exact = true;
    for (int i = 0; i < 3 && exact; i++) {
        exact = ratio(n[i] / max, &p[i], &q[i]);
        if (exact) common *= q[i] / divisor(common, q[i]);
        exact = exact && common <= EXACT_NORMAL;
    }
    for (int i = 0; i < 3; i++) o->whole[i] = exact ? p[i] * (common / q[i]) : o->n[i];
    const int64_t g = divisor(divisor(o->whole[0], o->whole[1]), o->whole[2]);
    double square = 0;
    for (int i = 0; i < 3; i++) {
        o->whole[i] /= g;
        square += (double)o->whole[i] * (double)o->whole[i];
    }
    o->d = llround(offset * sqrt(square));
}

static struct lattice_half_space half_space_of(const struct oblique *o, bool turned)
{
    struct lattice_half_space h = {.everywhere = false};
    for (int i = 0; i < 3; i++) h.n[i] = turned ? -o->whole[i] : o->whole[i];
    h.d = turned ? -o->d : o->d;
    return h;
}

/* Replaces each plane by the first nearly equal plane, in the order of by_plane(), that was not replaced itself. */
static void snap_oblique(const struct oblique *planes, size_t *first, size_t count, struct lattice_half_space *out)
{
    size_t kept = 0, window = 0; /* first[0 .. kept): the planes that were not replaced */
    for (size_t i = 0; i < count; i++) {
        while (window < kept && planes[first[window]].n[0] < planes[i].n[0] - SNAP) window++;
        size_t k = window;
        while (k < kept && !nearly_same(&planes[first[k]], &planes[i])) k++;
        if (k == kept) first[kept++] = i;
        out[planes[i].of] = half_space_of(&planes[first[k]], planes[i].turned);
    }
}

enum status convex_half_spaces(struct lattice_half_space **half_spaces, const struct solid_list *list, struct err *err)
{
    size_t all = 0, oblique = 0, at = 0;
    for (int i = 0; i < list->count; i++) all += (size_t)list->solids[i].count;
    struct oblique *planes = malloc((all + 1) * sizeof *planes);
    size_t *first = malloc((all + 1) * sizeof *first);
    struct lattice_half_space *out = calloc(all + 1, sizeof *out);
    if (!planes || !first || !out) err_nomem(err, "solids on the lattice", all * sizeof *planes);

    for (int i = 0; !err->status && i < list->count; i++)
        for (int k = 0; k < list->solids[i].count; k++, at++) {
            const struct half_space *h = &list->solids[i].half_spaces[k];
            const double n[3] = {h->normal.x, h->normal.y, h->normal.z};
            const double max = fmax(fmax(fabs(n[0]), fabs(n[1])), fabs(n[2]));
            double offset = h->offset / vec3_length(h->normal) / SOLID_STEP;
            struct oblique o = {.of = at};
            out[at].everywhere = offset > 2.0 * FAR_OUT;
            if (out[at].everywhere) continue;
            offset = fmax(offset, -2.0 * FAR_OUT);
            for (int a = 0; a < 3; a++) o.n[a] = llround(n[a] / max * EXACT_NORMAL);
            const int64_t lead = o.n[0] ? o.n[0] : o.n[1] ? o.n[1] : o.n[2];
            o.turned = lead < 0;
            double up[3];
            for (int a = 0; a < 3; a++) {
                up[a] = o.turned ? -n[a] : n[a];
                o.n[a] = llround(up[a] / max * EXACT_NORMAL);
            }
            offset = o.turned ? -offset : offset;
            o.q = llround(offset);
            if ((o.n[0] != 0) + (o.n[1] != 0) + (o.n[2] != 0) == 1) {
                for (int a = 0; a < 3; a++) o.whole[a] = o.n[a] / EXACT_NORMAL;
                o.d = o.q;
                out[at] = half_space_of(&o, o.turned);
            } else {
                to_integers(&o, up, max, offset);
                planes[oblique++] = o;
            }
        }
    if (!err->status) {
        qsort(planes, oblique, sizeof *planes, by_plane);
        snap_oblique(planes, first, oblique, out);
    }
    free(planes);
    free(first);
    if (err->status)
        free(out);
    else
        *half_spaces = out;
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- polygons */

/* Cuts the polygon of *count edges in scratch[0], in `plane`, down to the part with exact_side() * side <= 0 of plane
 * `by`; *count is 0 if no area is left. */
static enum status cut(struct convex_set *set, int plane, int *count, int by, int side, struct err *err)
{
    const int n = *count;
    bool inside = false, outside = false;
    if (exact_grow(&set->signs, &set->signs_capacity, n + 1, sizeof *set->signs, err) ||
        exact_grow(&set->scratch[1], &set->scratch_capacity[1], 2 * n + 2, sizeof **set->scratch, err))
        return err->status;
    const struct polygon_edge *in = set->scratch[0];
    struct polygon_edge *out = set->scratch[1];
    for (int i = 0; i < n; i++) {
        set->signs[i] = side * exact_side(&set->space, in[i].corner, by);
        inside = inside || set->signs[i] < 0;
        outside = outside || set->signs[i] > 0;
    }
    if (!inside) *count = 0;
    if (!inside || !outside) return ST_OK;
    set->signs[n] = set->signs[0];

    int made = 0;
    for (int i = 0; i < n; i++) {
        const int here = set->signs[i], there = set->signs[i + 1];
        if (here <= 0) {
            out[made] = in[i];
            if (!here && there > 0) out[made].plane = by;
            made++;
        }
        if (here * there >= 0) continue;
        int corner;
        if (exact_meet(&set->space, plane, in[i].plane, by, &corner, err)) return err->status;
        out[made++] = (struct polygon_edge){corner, here < 0 ? by : in[i].plane, 0};
    }
    struct polygon_edge *swap = set->scratch[0];
    const int capacity = set->scratch_capacity[0];
    set->scratch[0] = set->scratch[1];
    set->scratch_capacity[0] = set->scratch_capacity[1];
    set->scratch[1] = swap;
    set->scratch_capacity[1] = capacity;
    *count = made;
    return ST_OK;
}

/* A quadrilateral in the plane with corners just out of reach along the axes of the normal's smaller components. */
static enum status square(struct convex_set *set, int plane, int *count, const int far[6], struct err *err)
{
    const struct exact_plane *p = &set->space.planes[plane];
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (llabs(p->n[i]) > llabs(p->n[k])) k = i;
    const int u = (k + 1) % 3, v = (k + 2) % 3, around[4] = {far[2 * u], far[2 * v], far[2 * u + 1], far[2 * v + 1]};
    if (exact_grow(&set->scratch[0], &set->scratch_capacity[0], 4, sizeof **set->scratch, err)) return err->status;
    for (int i = 0; i < 4; i++) {
        set->scratch[0][i].plane = around[i];
        if (exact_meet(&set->space, plane, around[i], around[(i + 3) % 4], &set->scratch[0][i].corner, err))
            return err->status;
    }
    *count = 4;
    return ST_OK;
}

/* Adds the polygon in scratch[0] to the set. */
static enum status keep(struct convex_set *set, struct polygon p, struct err *err)
{
    if (exact_grow(&set->edges, &set->edge_capacity, set->edge_count + p.count, sizeof *set->edges, err) ||
        exact_grow(&set->polygons, &set->polygon_capacity, set->polygon_count + 1, sizeof *set->polygons, err))
        return err->status;
    p.first = set->edge_count;
    for (int i = 0; i < p.count; i++) {
        struct polygon_edge e = set->scratch[0][i];
        if (exact_line_add(&set->space, p.plane, e.plane, &e.line, err)) return err->status;
        const double *at = set->space.points[e.corner].p;
        for (int a = 0; a < 3; a++) {
            p.low[a] = i ? fmin(p.low[a], at[a]) : at[a];
            p.high[a] = i ? fmax(p.high[a], at[a]) : at[a];
        }
        set->edges[set->edge_count++] = e;
    }
    set->polygons[set->polygon_count++] = p;
    return ST_OK;
}

static enum status far_planes(struct convex_set *set, int far[6], struct err *err)
{
    for (int i = 0; i < 6; i++) {
        int64_t n[3] = {0};
        int side;
        n[i / 2] = 1;
        if (exact_plane_add(&set->space, n, i % 2 ? FAR_OUT : -FAR_OUT, &far[i], &side, err)) return err->status;
    }
    return ST_OK;
}

static enum status wrong(const struct solid *s, const char *what, struct err *err)
{
    return err_set(err, ST_DATA, "the solid of body %s with the face %s %s.", s->body, s->half_spaces[0].name, what);
}

enum status convex_set_add(struct convex_set *set, const struct solid *solid,
                           const struct lattice_half_space *half_spaces, const int *names, struct err *err)
{
    enum { FEW = 64 };
    int far[6], few[2 * FEW], *planes = few;
    struct convex c = {.first = set->polygon_count};
    if (far_planes(set, far, err)) return err->status;
    if (solid->count > FEW) planes = malloc(2 * (size_t)solid->count * sizeof *planes);
    if (!planes) return err_nomem(err, "a solid", 2 * (size_t)solid->count * sizeof *planes);
    int *sides = planes + (solid->count > FEW ? solid->count : FEW);
    bool bounded = true;
    for (int i = 0; !err->status && i < solid->count; i++)
        if (!half_spaces[i].everywhere)
            exact_plane_add(&set->space, half_spaces[i].n, half_spaces[i].d, &planes[i], &sides[i], err);
    for (int i = 0; !err->status && i < solid->count; i++) {
        bool again = half_spaces[i].everywhere;
        for (int k = 0; k < i; k++)
            again = again || (!half_spaces[k].everywhere && planes[k] == planes[i] && sides[k] == sides[i]);
        if (again) continue;
        int count;
        square(set, planes[i], &count, far, err);
        for (int k = 0; !err->status && count && k < solid->count; k++)
            if (!half_spaces[k].everywhere && !exact_parallel(&set->space, planes[i], planes[k]))
                cut(set, planes[i], &count, planes[k], sides[k], err);
            else if (!half_spaces[k].everywhere && k != i &&
                     sides[k] * exact_side(&set->space, set->scratch[0][0].corner, planes[k]) > 0)
                count = 0; /* outside a parallel plane */
        for (int k = 0; !err->status && k < count; k++)
            for (int f = 0; f < 6; f++) bounded = bounded && set->scratch[0][k].plane != far[f];
        if (!err->status && count)
            keep(set,
                 (struct polygon){
                     .plane = planes[i], .solid = set->count, .side = sides[i], .name = names[i], .count = count},
                 err);
    }
    if (planes != few) free(planes);
    if (err->status) return err->status;
    c.count = set->polygon_count - c.first;
    if (!bounded) return wrong(solid, "is not bounded, or extends beyond 1000 units from the origin", err);
    if (c.count < 4) return wrong(solid, "is empty, or flat when rounded to a millionth of a unit", err);
    for (int i = c.first; i < c.first + c.count; i++)
        for (int a = 0; a < 3; a++) {
            c.low[a] = i > c.first ? fmin(c.low[a], set->polygons[i].low[a]) : set->polygons[i].low[a];
            c.high[a] = i > c.first ? fmax(c.high[a], set->polygons[i].high[a]) : set->polygons[i].high[a];
        }
    if (exact_grow(&set->solids, &set->capacity, set->count + 1, sizeof *set->solids, err)) return err->status;
    set->solids[set->count++] = c;
    return ST_OK;
}

enum status convex_section(struct convex_set *set, int solid, int plane, int *polygon, struct err *err)
{
    const struct convex c = set->solids[solid];
    bool above = false, below = false;
    *polygon = -1;
    for (int i = c.first; i < c.first + c.count && !(above && below); i++) {
        const struct polygon *p = &set->polygons[i];
        if (p->plane == plane) return ST_OK;
        for (int k = p->first; k < p->first + p->count; k++) {
            const int s = exact_side(&set->space, set->edges[k].corner, plane);
            above = above || s > 0;
            below = below || s < 0;
        }
    }
    if (!above || !below) return ST_OK;
    int far[6], count;
    if (far_planes(set, far, err) || square(set, plane, &count, far, err)) return err->status;
    for (int i = c.first; i < c.first + c.count && count; i++) {
        const struct polygon *p = &set->polygons[i];
        if (!exact_parallel(&set->space, p->plane, plane) && cut(set, plane, &count, p->plane, p->side, err))
            return err->status;
    }
    *polygon = set->polygon_count;
    return keep(set, (struct polygon){.plane = plane, .solid = solid, .name = -1, .count = count}, err);
}
