/* draft_shape.c - a tree of boxes over triangles; see draft_shape.h.
 *
 * Each node halves its triangles, in the order of their middles along the longest side of the box around these. */
#include "stages/build_model/live/draft_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, DEPTH = 64 };

struct draft_node {
    double low[3], high[3];
    int first, count, right; /* of triangles; right: the second child, the first one follows; count 0: not a leaf */
};

struct item {
    double middle[3];
    int triangle;
};

static double part(struct vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static int compare(const void *a, const void *b, void *axis)
{
    const struct item *x = a, *y = b;
    const int k = *(const int *)axis;
    return x->middle[k] < y->middle[k] ? -1 : x->middle[k] > y->middle[k] ? 1 : x->triangle - y->triangle;
}

static int longest_side(const struct item *items, int count)
{
    double best = -1;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int i = 0; i < count; i++) {
            low = fmin(low, items[i].middle[k]);
            high = fmax(high, items[i].middle[k]);
        }
        if (high - low > best) best = high - low, axis = k;
    }
    return axis;
}

/* Adds the node of items first to first + count. */
static int add_node(struct draft_shape *s, const struct vec3 (*triangles)[3], struct item *items, int first, int count)
{
    const int at = s->node_count++;
    struct draft_node *n = &s->nodes[at];
    for (int k = 0; k < 3; k++) {
        n->low[k] = HUGE_VAL;
        n->high[k] = -HUGE_VAL;
        for (int i = 0; i < 3 * count; i++) {
            const double v = part(triangles[items[first + i / 3].triangle][i % 3], k);
            n->low[k] = fmin(n->low[k], v);
            n->high[k] = fmax(n->high[k], v);
        }
    }
    n->first = first;
    n->count = count <= LEAF ? count : 0;
    if (count <= LEAF) return at;
    int axis = longest_side(items + first, count);
    qsort_r(items + first, (size_t)count, sizeof *items, compare, &axis);
    add_node(s, triangles, items, first, count / 2);
    const int right = add_node(s, triangles, items, first + count / 2, count - count / 2);
    s->nodes[at].right = right;
    return at;
}

enum status draft_shape_make(struct draft_shape *s, struct vec3 (*triangles)[3], int count, struct err *err)
{
    struct item *items = calloc((size_t)count + 1, sizeof *items);
    *s = (struct draft_shape){.nodes = calloc((size_t)count * 2 + 1, sizeof *s->nodes),
                              .triangles = calloc((size_t)count + 1, sizeof *s->triangles)};
    if (items && s->nodes && s->triangles) {
        for (int i = 0; i < count; i++) {
            const struct vec3 *c = triangles[i];
            items[i].triangle = i;
            for (int k = 0; k < 3; k++) items[i].middle[k] = (part(c[0], k) + part(c[1], k) + part(c[2], k)) / 3;
        }
        if (count > 0) add_node(s, (const struct vec3(*)[3])triangles, items, 0, count);
        for (int i = 0; i < count; i++) memcpy(s->triangles[i], triangles[items[i].triangle], sizeof *triangles);
        s->count = count;
    } else
        err_nomem(err, "a shape", (size_t)count * sizeof *s->nodes);
    free(items);
    free(triangles);
    if (err->status) draft_shape_release(s);
    return err->status;
}

void draft_shape_release(struct draft_shape *s)
{
    free(s->triangles);
    free(s->nodes);
    *s = (struct draft_shape){0};
}

struct vec3 draft_shape_middle(const struct draft_shape *s)
{
    const struct draft_node *n = s->nodes;
    if (!s->node_count) return vec3_make(0, 0, 0);
    return vec3_make((n->low[0] + n->high[0]) / 2, (n->low[1] + n->high[1]) / 2, (n->low[2] + n->high[2]) / 2);
}

/* A ray meets a box nearer than `most`. one: 1 / the coordinates of its direction. */
static bool meets_box(const struct draft_node *n, struct vec3 from, const double one[3], double most)
{
    double near = 0, far = most;
    for (int k = 0; k < 3; k++) {
        const double o = part(from, k), a = (n->low[k] - o) * one[k], b = (n->high[k] - o) * one[k];
        near = fmax(near, fmin(a, b)); /* in the plane of a side 0 times infinity is NaN, which counts as met */
        far = fmin(far, fmax(a, b));
    }
    return near <= far * (1 + 1e-12);
}

/* By the three areas that the place of the ray divides the triangle into. */
static bool meets_triangle(const struct vec3 c[3], struct vec3 from, struct vec3 way, double *at)
{
    const struct vec3 u = vec3_sub(c[1], c[0]), v = vec3_sub(c[2], c[0]), to = vec3_sub(from, c[0]);
    const struct vec3 p = vec3_cross(way, v), q = vec3_cross(to, u);
    const double det = vec3_dot(u, p), b = vec3_dot(to, p) / det, g = vec3_dot(way, q) / det, t = vec3_dot(v, q) / det;
    if (!(b >= 0 && g >= 0 && b + g <= 1 && t > 0 && t < *at)) return false;
    *at = t;
    return true;
}

bool draft_shape_meets(const struct draft_shape *s, struct vec3 from, struct vec3 way, double *at, struct vec3 *normal)
{
    const double one[3] = {1 / way.x, 1 / way.y, 1 / way.z};
    int left[DEPTH], count = 0, found = -1;
    if (s->node_count) left[count++] = 0;
    while (count) {
        const int node = left[--count];
        const struct draft_node *n = &s->nodes[node];
        if (!meets_box(n, from, one, *at)) continue;
        for (int i = n->first; i < n->first + n->count; i++)
            if (meets_triangle(s->triangles[i], from, way, at)) found = i;
        if (n->count || count + 2 > DEPTH) continue;
        left[count++] = n->right;
        left[count++] = node + 1;
    }
    if (found < 0) return false;
    const struct vec3 *c = s->triangles[found],
                      n = vec3_normalize(vec3_cross(vec3_sub(c[1], c[0]), vec3_sub(c[2], c[0])));
    if (normal) *normal = vec3_dot(n, way) > 0 ? vec3_scale(n, -1) : n;
    return true;
}
