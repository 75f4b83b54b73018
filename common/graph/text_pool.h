/* text_pool.h - texts, each kept once: rules name the same paths many times, and keep pointers to them.
 *
 * {0} is the empty pool. */
#ifndef REMODEL_TEXT_POOL_H
#define REMODEL_TEXT_POOL_H

#include "common/base/err.h"

struct text_pool {
    struct text_block *blocks; /* the bytes of the texts */
    const char **slots;        /* a hash table with open addressing; NULL: free */
    size_t slot_count, count;
};

/* The pool's copy of a text, which holds until the pool is released. NULL: ST_NOMEM. */
const char *text_pool_keep(struct text_pool *pool, const char *text, struct err *err);
void text_pool_release(struct text_pool *pool);

#endif
