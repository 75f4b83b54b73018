/* cache_tree.h - an octree of balls: which balls hold a point. */
#ifndef REMODEL_CACHE_TREE_H
#define REMODEL_CACHE_TREE_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct cache_tree_node {
    int child[8]; /* 0: none */
    int first;    /* of its entries; -1: none */
};

struct cache_tree_entry {
    int ball, next; /* -1: the last one */
};

/* Filled by cache_tree_init(); everything is owned. */
struct cache_tree {
    struct vec3 low;
    double size; /* of its cube */
    struct cache_tree_node *nodes;
    struct cache_tree_entry *entries;
    int node_count, entry_count;
};

/* An empty tree over a box. ST_NOMEM. */
enum status cache_tree_init(struct cache_tree *t, struct vec3 low, struct vec3 high, struct err *err);
void cache_tree_release(struct cache_tree *t);

/* Adds a ball whose centre is in the box. ST_NOMEM. */
enum status cache_tree_add(struct cache_tree *t, int ball, struct vec3 centre, double radius, struct err *err);

/* Calls fn for each ball that may hold the point, always in the same order. */
void cache_tree_find(const struct cache_tree *t, struct vec3 at, void fn(void *ctx, int ball), void *ctx);

#endif
