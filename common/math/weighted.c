/* weighted.c - weighted percentiles. */
#include "common/math/weighted.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const double x = ((const struct weighted *)a)->value, y = ((const struct weighted *)b)->value;
    return (x > y) - (x < y);
}

double weighted_percentile(struct weighted *values, size_t count, double fraction)
{
    double total = 0, sum = 0;
    qsort(values, count, sizeof *values, compare);
    for (size_t i = 0; i < count; i++) total += values[i].weight;
    for (size_t i = 0; i < count; i++) {
        sum += values[i].weight;
        if (sum >= fraction * total) return values[i].value;
    }
    return count ? values[count - 1].value : 0;
}
