/* sort.c - sorts numbers. */
#include "common/base/sort.h"

#include <stdlib.h>

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

void sort_doubles(double *values, size_t count)
{
    if (count) qsort(values, count, sizeof *values, compare_doubles);
}

void sort_floats(float *values, size_t count)
{
    if (count) qsort(values, count, sizeof *values, compare_floats);
}

double sort_median(double *values, size_t count)
{
    sort_doubles(values, count);
    return (values[(count - 1) / 2] + values[count / 2]) / 2;
}
