/* cache_tree.c - an octree of balls.
 *
 * A ball is an entry of the nodes that it overlaps, at the level where a node is between two and four times as wide as
 * its radius: at most eight nodes. A point is in one node of each level, hence a search follows one path from the root.
 *
 * Source: [Ward 1988]. */
#include "common/gather/cache_tree.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"

enum { DEEPEST = 20 };

static enum status add_node(struct cache_tree *t, int *index, struct err *err)
{
    if (array_append(&t->nodes, (size_t)t->node_count, sizeof *t->nodes, "a cache of irradiance", err))
        return err->status;
    *index = t->node_count;
    t->nodes[t->node_count++] = (struct cache_tree_node){.first = -1};
    return ST_OK;
}

enum status cache_tree_init(struct cache_tree *t, struct vec3 low, struct vec3 high, struct err *err)
{
    int root;
    const struct vec3 d = vec3_sub(high, low);
    *t = (struct cache_tree){.low = low, .size = fmax(fmax(d.x, d.y), fmax(d.z, 1e-12))};
    return add_node(t, &root, err);
}

void cache_tree_release(struct cache_tree *t)
{
    free(t->nodes);
    free(t->entries);
    *t = (struct cache_tree){0};
}

struct ball {
    int index;
    struct vec3 centre;
    double radius;
};

static struct vec3 child_low(struct vec3 low, double half, int octant)
{
    return vec3_add(low, vec3_make(octant & 1 ? half : 0, octant & 2 ? half : 0, octant & 4 ? half : 0));
}

static int overlaps(const struct ball *b, struct vec3 low, double size)
{
    return b->centre.x + b->radius >= low.x && b->centre.x - b->radius <= low.x + size &&
           b->centre.y + b->radius >= low.y && b->centre.y - b->radius <= low.y + size &&
           b->centre.z + b->radius >= low.z && b->centre.z - b->radius <= low.z + size;
}

static enum status add_entry(struct cache_tree *t, int node, int ball, struct err *err)
{
    if (array_append(&t->entries, (size_t)t->entry_count, sizeof *t->entries, "a cache of irradiance", err))
        return err->status;
    t->entries[t->entry_count] = (struct cache_tree_entry){ball, t->nodes[node].first};
    t->nodes[node].first = t->entry_count++;
    return ST_OK;
}

static enum status add_below(struct cache_tree *t, int node, struct vec3 low, double size, const struct ball *b,
                             int depth, struct err *err)
{
    const double half = size / 2;
    if (half < 2 * b->radius || depth == DEEPEST) return add_entry(t, node, b->index, err);
    for (int i = 0; i < 8; i++) {
        const struct vec3 at = child_low(low, half, i);
        int child = t->nodes[node].child[i];
        if (!overlaps(b, at, half)) continue;
        if (!child && add_node(t, &child, err)) return err->status;
        t->nodes[node].child[i] = child;
        if (add_below(t, child, at, half, b, depth + 1, err)) return err->status;
    }
    return ST_OK;
}

enum status cache_tree_add(struct cache_tree *t, int ball, struct vec3 centre, double radius, struct err *err)
{
    const struct ball b = {ball, centre, radius};
    return add_below(t, 0, t->low, t->size, &b, 0, err);
}

void cache_tree_find(const struct cache_tree *t, struct vec3 at, void fn(void *ctx, int ball), void *ctx)
{
    struct vec3 low = t->low;
    double size = t->size;
    int node = 0;
    do {
        const struct cache_tree_node *n = &t->nodes[node];
        for (int i = n->first; i >= 0; i = t->entries[i].next) fn(ctx, t->entries[i].ball);
        size /= 2;
        const int octant = (at.x >= low.x + size) | (at.y >= low.y + size) << 1 | (at.z >= low.z + size) << 2;
        low = child_low(low, size, octant);
        node = n->child[octant];
    } while (node);
}
