/* sort.h - sorts numbers in ascending order, and finds places in sorted arrays. No number may be NaN. */
#ifndef REMODEL_SORT_H
#define REMODEL_SORT_H

#include <stdbool.h>
#include <stddef.h>

void sort_doubles(double *values, size_t count);
void sort_floats(float *values, size_t count);
/* Sorts the values and returns their median, of an even number the mean of the middle two; count > 0. */
double sort_median(double *values, size_t count);

/* The first of `count` sorted items that is not below the key; count if all are. Inline, as is_below() should be. */
static inline size_t sort_place(const void *items, size_t count, size_t item_size,
                                bool (*is_below)(const void *item, const void *key), const void *key)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (is_below((const char *)items + middle * item_size, key))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

#endif
