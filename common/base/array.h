/* array.h - growing arrays.
 *
 * `array` is the address of the pointer to the items (NULL while there are none): array_append(&list->items, ...). If
 * memory runs out, the array and its items stay as they were. `what` names the items in the ST_NOMEM error, in the
 * plural. */
#ifndef REMODEL_ARRAY_H
#define REMODEL_ARRAY_H

#include <stddef.h>

#include "common/base/err.h"

/* Makes room for one item after the first `count`. The capacity is not stored: it is the smallest power of two >=
 * count. Use it only on arrays that grow by array_append() alone. */
enum status array_append(void *array, size_t count, size_t item_size, const char *what, struct err *err);

/* Makes room for `needed` items in an array of *capacity items, which at least doubles when it grows. */
enum status array_reserve(void *array, size_t *capacity, size_t needed, size_t item_size, const char *what,
                          struct err *err);

#endif
