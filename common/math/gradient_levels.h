/* gradient_levels.h - the equations of a gradient problem, and coarser and coarser forms of them. */
#ifndef REMODEL_GRADIENT_LEVELS_H
#define REMODEL_GRADIENT_LEVELS_H

#include "common/math/gradient_system.h"

enum {
    GRADIENT_MAX_LEVELS = 32,
    GRADIENT_FINE_WIDTH = 2,
    GRADIENT_COARSE_WIDTH = 3,
    GRADIENT_DENSE = 48, /* largest number of nodes that are eliminated */
};

struct gradient_link {
    int to;
    float weight;
};

/* Node i has `width` places for links to smaller nodes, then as many for links to larger ones, from 2 width i on. Both
 * are in ascending order, next to i without a gap; empty places have weight 0. Further links, to the smallest and to
 * the largest nodes, are in `more`: from more_begin[2 i] and from more_begin[2 i + 1] on; the finest level has none. */
struct gradient_level {
    int count, width;
    int *to;
    float *weight;
    int *more_begin;
    struct gradient_link *more;
    float *excess;
    float *inverse; /* of the diagonal: excess and weights; 0 where that is 0 */
    int *group; /* the node of the next level that this one belongs to; that level's count: none. NULL: no next level */
    int twice;  /* 1: a visit takes two steps towards this level's solution; 0: one */
};

struct gradient_levels {
    struct gradient_level level[GRADIENT_MAX_LEVELS];
    int count;
    float scale; /* of the weights, over those of the system: a power of two, so that they keep their digits */
    /* If the last level has at most GRADIENT_DENSE nodes, else NULL. Row k of dense: weight / pivot of the links of
     * node k to later nodes when it is eliminated. */
    float *dense, *inverse_pivot;
};

/* levels is empty on entry; ST_NOMEM: it is empty. */
enum status gradient_levels_init(struct gradient_levels *levels, const struct gradient_system *s, struct err *err);
void gradient_levels_release(struct gradient_levels *levels);

#endif
