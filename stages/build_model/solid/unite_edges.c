/* unite_edges.c - half-edges of a body, their twins, loops and vertices.
 *
 * - Borders are cut at the ends of others that lie on them, so that faces that meet have the same edges.
 * - The faces around an edge are sorted by angle, exactly. Each face is where solid begins or where it ends; faces with
 *   solid between them become neighbours (twins). So solids that touch in an edge stay separate there.
 * - The next half-edge in a face is the one that bounds the same corner of the face: the first one clockwise.
 * - Half-edges around a corner of the solid, one fan of faces, share a vertex; another fan gets another vertex. A
 *   vertex with two faces only, in the middle of an edge, is removed. */
#include <stdlib.h>
#include <string.h>

#include "stages/build_model/solid/unite_internal.h"

enum status unite_broken(const struct solid *s, const char *what, struct err *err)
{
    return err_set(err, ST_INTERNAL, "the surface of body %s does not close: %s; this is a bug.", s->body, what);
}

void unite_half_direction(const struct body_union *j, int half, int64_t d[3])
{
    const struct border *b = &j->borders.borders[j->halves[half].border];
    for (int i = 0; i < 3; i++) d[i] = j->set.space.lines[b->line].d[i] * (b->forward ? 1 : -1);
}

void unite_half_outward(const struct body_union *j, int half, int64_t n[3])
{
    const struct border *b = &j->borders.borders[j->halves[half].border];
    for (int i = 0; i < 3; i++) n[i] = j->set.space.planes[b->plane].n[i] * b->side;
}

void unite_negated(const int64_t a[3], int64_t out[3])
{
    for (int i = 0; i < 3; i++) out[i] = -a[i];
}

/* ------------------------------------------------------------------------------------------------ edges and twins */

enum status unite_add_half(struct body_union *j, int border, int from, struct err *err)
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
    if (count % 2) return unite_broken(s, "an edge has no opposite", err);
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
        unite_half_outward(j, of[i], u[i]);
        if (!FORWARD(of[i])) unite_negated(u[i], u[i]);
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
    if (depth) unite_broken(s, "the faces around an edge do not alternate", err);
    for (int i = 0; !err->status && i < count; i++) {
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
    return err->status;
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
    for (int i = 0; i < count; i++) of[i] = 0; /* half-edges of the edge from point i to i + 1 */
    for (int i = 0; !err->status && i < border_count; i++) {
        const struct border b = j->borders.borders[borders[i]];
        const int step = b.forward ? 1 : -1;
        for (int k = index[b.from]; !err->status && k != index[b.to]; k += step) {
            of[b.forward ? k : k - 1]++;
            unite_add_half(j, borders[i], points[k], err);
        }
    }
    int *slots = malloc(((size_t)(j->half_count - first) + 1) * sizeof *slots);
    if (!err->status && !slots) err_nomem(err, "the edges of a line", (size_t)(j->half_count - first) * sizeof *slots);
    if (!err->status) {
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
        for (int i = 0, begin = 0; !err->status && i < count; begin = of[i++])
            if (of[i] > begin) pair_around(j, &slots[begin], of[i] - begin, s, err);
    }
    free(of);
    free(slots);
    return err->status;
}

enum status unite_make_halves(struct body_union *j, const struct solid *s, struct err *err)
{
    struct border_set *b = &j->borders;
    const size_t lines = (size_t)j->set.space.line_count, points = (size_t)j->set.space.point_count;
    int *border_first = calloc(lines + 2, sizeof *border_first), *point_first = calloc(lines + 2, sizeof *point_first);
    int *by_line = malloc(((size_t)b->border_count + 1) * sizeof *by_line);
    int *line_points = malloc(((size_t)b->point_count + 1) * sizeof *line_points);
    int *index = malloc((points + 1) * sizeof *index);
    char *ends = calloc(points + 1, 1); /* points in which a border ends */
    if (!border_first || !point_first || !by_line || !line_points || !index || !ends)
        err_nomem(err, "edges of a union", lines * sizeof *border_first);
    if (!err->status) {
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
    for (size_t i = 0; !err->status && i < lines; i++)
        if (border_first[i + 1] > border_first[i])
            cut_line(j, &by_line[border_first[i]], border_first[i + 1] - border_first[i], &line_points[point_first[i]],
                     point_first[i + 1] - point_first[i], index, s, err);
    free(border_first);
    free(point_first);
    free(by_line);
    free(line_points);
    free(index);
    free(ends);
    return err->status;
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
            unite_half_direction(j, h, back);
            unite_negated(back, back);
            unite_half_outward(j, h, down);
            unite_negated(down, down);
            unite_half_direction(j, best, best_d);
        }
        unite_half_direction(j, leaving[i], d);
        if (!exact_before(back, d, best_d, down)) continue;
        best = leaving[i];
        memcpy(best_d, d, sizeof d);
    }
    return best;
}

enum status unite_link_halves(struct body_union *j, const struct solid *s, struct err *err)
{
    const size_t points = (size_t)j->set.space.point_count;
    int *first = calloc(points + 2, sizeof *first), *leaving = malloc(((size_t)j->half_count + 1) * sizeof *leaving);
    if (!first || !leaving) err_nomem(err, "loops of a union", points * sizeof *first);
    if (!err->status) {
        for (int i = 0; i < j->half_count; i++) first[j->halves[i].from + 2]++;
        for (size_t i = 0; i < points; i++) first[i + 2] += first[i + 1];
        for (int i = 0; i < j->half_count; i++) leaving[first[j->halves[i].from + 1]++] = i;
    }
    for (int i = 0; !err->status && i < j->half_count; i++) {
        const int to = j->halves[j->halves[i].twin].from;
        const int next = following(j, i, &leaving[first[to]], first[to + 1] - first[to]);
        if (next < 0 || j->halves[next].prev >= 0) {
            unite_broken(s, "the edge of a face has no successor", err);
            break;
        }
        j->halves[i].next = next;
        j->halves[next].prev = i;
    }
    free(first);
    free(leaving);
    for (int i = 0; !err->status && i < j->half_count; i++) {
        if (j->halves[i].loop >= 0) continue;
        if (exact_grow(&j->loops, &j->loop_capacity, j->loop_count + 1, sizeof *j->loops, err)) break;
        for (int h = i; j->halves[h].loop < 0; h = j->halves[h].next) j->halves[h].loop = j->loop_count;
        j->loops[j->loop_count++] = (struct union_loop){.half = i, .face = -1};
    }
    return err->status;
}

/* Makes a vertex for each fan of faces, and removes those in the middle of an edge. */
void unite_make_vertices(struct body_union *j)
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

void unite_half_position(const struct body_union *j, int half, double p[3])
{
    const struct half *h = &j->halves[half];
    memcpy(p, h->from >= 0 ? j->set.space.points[h->from].p : h->middle, 3 * sizeof *p);
}
