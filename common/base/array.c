/* array.c - growing arrays. */
#include "common/base/array.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static enum status resize(void *array, size_t count, size_t item_size, const char *what, struct err *err)
{
    void *items;

    memcpy(&items, array, sizeof items); /* a pointer to any type */
    if (count > SIZE_MAX / item_size) return err_nomem(err, what, SIZE_MAX);
    void *grown = realloc(items, count * item_size);
    if (!grown) return err_nomem(err, what, count * item_size);
    memcpy(array, &grown, sizeof grown);
    return ST_OK;
}

enum status array_append(void *array, size_t count, size_t item_size, const char *what, struct err *err)
{
    if (count & (count - 1)) return ST_OK; /* below the capacity, a power of two */
    return resize(array, count ? 2 * count : 1, item_size, what, err);
}

enum status array_reserve(void *array, size_t *capacity, size_t needed, size_t item_size, const char *what,
                          struct err *err)
{
    if (needed <= *capacity) return ST_OK;
    const size_t doubled = *capacity > SIZE_MAX / 2 ? needed : 2 * *capacity,
                 count = doubled > needed ? doubled : needed;
    if (resize(array, count, item_size, what, err)) return err->status;
    *capacity = count;
    return ST_OK;
}
