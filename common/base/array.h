/* array.h - arrays that grow as items are appended.
 *
 * `array` is the address of a pointer to the items, or to NULL while there are none: array_append(&list->items, ...). It keeps what it
 * holds when it cannot grow. */
#ifndef REMODEL_ARRAY_H
#define REMODEL_ARRAY_H

#include <stddef.h>

#include "common/base/err.h"

/* Makes room for one more item after the `count` that are there. The capacity is not stored: it is the power of two not below
 * `count`, so an array that was filled by other means must not be grown like this. ST_NOMEM names `what`, in the plural. */
enum status array_append(void *array, size_t count, size_t item_size, const char *what, struct err *err);

/* Makes room for `needed` items in an array of *capacity, which at least doubles when it grows. */
enum status array_reserve(void *array, size_t *capacity, size_t needed, size_t item_size, const char *what,
                          struct err *err);

#endif
