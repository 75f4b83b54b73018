/* text_pool.c - see text_pool.h. */
#include "common/graph/text_pool.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

enum { BLOCK = 1 << 20 }; /* bytes; no text is longer */

struct text_block {
    struct text_block *next;
    size_t used;
    char bytes[BLOCK];
};

/* The slot of a text, or the free one where it belongs. */
static const char **find_slot(const struct text_pool *pool, const char *text, size_t length)
{
    size_t i = XXH3_64bits(text, length) & (pool->slot_count - 1);
    while (pool->slots[i] && strcmp(pool->slots[i], text)) i = (i + 1) & (pool->slot_count - 1);
    return &pool->slots[i];
}

static enum status grow_slots(struct text_pool *pool, struct err *err)
{
    struct text_pool more = {.slot_count = pool->slot_count ? 2 * pool->slot_count : 1024};
    more.slots = calloc(more.slot_count, sizeof *more.slots);
    if (!more.slots) return err_nomem(err, "paths", more.slot_count * sizeof *more.slots);
    for (size_t i = 0; i < pool->slot_count; i++)
        if (pool->slots[i]) *find_slot(&more, pool->slots[i], strlen(pool->slots[i])) = pool->slots[i];
    free(pool->slots);
    pool->slots = more.slots;
    pool->slot_count = more.slot_count;
    return ST_OK;
}

const char *text_pool_keep(struct text_pool *pool, const char *text, struct err *err)
{
    const size_t size = strlen(text) + 1;
    if (2 * pool->count >= pool->slot_count && grow_slots(pool, err)) return NULL;
    const char **slot = find_slot(pool, text, size - 1);
    if (*slot) return *slot;
    if (!pool->blocks || pool->blocks->used + size > BLOCK) {
        struct text_block *block = size <= BLOCK ? malloc(sizeof *block) : NULL;
        if (!block) return err_nomem(err, "paths", sizeof *block), NULL;
        block->next = pool->blocks;
        block->used = 0;
        pool->blocks = block;
    }
    *slot = memcpy(pool->blocks->bytes + pool->blocks->used, text, size);
    pool->blocks->used += size;
    pool->count++;
    return *slot;
}

void text_pool_release(struct text_pool *pool)
{
    while (pool->blocks) {
        struct text_block *next = pool->blocks->next;
        free(pool->blocks);
        pool->blocks = next;
    }
    free(pool->slots);
    *pool = (struct text_pool){0};
}
