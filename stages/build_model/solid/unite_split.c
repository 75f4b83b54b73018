/* unite_split.c - edges that a mesh cannot have are split in the middle.
 *
 * Where several edges join the same two vertices all but one are split, so that a pair of vertices identifies an edge.
 * So is an edge that crosses a third face from corner to corner, so that no triangle of that face has the same side. */
#include <stdlib.h>

#include "stages/build_model/solid/unite_internal.h"

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
        unite_half_position(j, i, a);
        unite_half_position(j, k[i].next, b);
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
        unite_half_position(j, h, p);
        unite_half_position(j, end, q);
        for (int i = 0; i < 3; i++) p[i] = 0.5 * (p[i] + q[i]);
        const int outer = j->faces[face].loop;
        bool in = !edge_along(j, p, h, outer) && unite_position_in_loop(j, p, outer);
        for (int l = 0; in && j->faces[face].holes && l < j->loop_count; l++)
            in = !(j->loops[l].hole && j->loops[l].face == face &&
                   (edge_along(j, p, h, l) || unite_position_in_loop(j, p, l)));
        if (in) return true;
    }
    return false;
}

/* Splits in the middle each edge whose ends another edge joins too, or that may be a side of a third face's triangle:
 * a pair of vertices then identifies an edge, also of the triangles. */
enum status unite_split_edges(struct body_union *j, struct err *err)
{
    struct edge_ends *ends = malloc(((size_t)j->half_count + 1) * sizeof *ends);
    int count = 0, kept = 0;
    if (!ends) err_nomem(err, "edges of a union", (size_t)j->half_count * sizeof *ends);
    for (int i = 0; !err->status && i < j->half_count; i++) {
        if (j->halves[i].twin < i) continue;
        const int a = j->halves[i].vertex, b = j->halves[j->halves[i].twin].vertex;
        ends[count++] = (struct edge_ends){a < b ? a : b, a < b ? b : a, i, false};
    }
    if (!err->status && count) qsort(ends, (size_t)count, sizeof *ends, compare_ends);
    for (int i = 0; !err->status && i < count; i++) {
        const bool again = i && ends[i].low == ends[i - 1].low && ends[i].high == ends[i - 1].high;
        ends[i].split = again || crosses_a_face(j, ends[i].half);
    }
    for (int i = 0; !err->status && i < count; i++)
        if (ends[i].split) ends[kept++] = ends[i];
    for (int i = 0; !err->status && i < kept; i++) {
        const int pair[2] = {ends[i].half, j->halves[ends[i].half].twin}, made = j->half_count;
        double p[2][3];
        for (int k = 0; k < 2; k++) unite_half_position(j, pair[k], p[k]);
        for (int k = 0; !err->status && k < 2; k++) {
            if (unite_add_half(j, j->halves[pair[k]].border, -1, err)) break;
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
        for (int k = 0; !err->status && k < 2; k++) j->halves[pair[k]].twin = made + 1 - k;
        j->vertex_count++;
    }
    free(ends);
    return err->status;
}
