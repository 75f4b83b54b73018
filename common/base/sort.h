/* sort.h - sorts numbers in ascending order. None may be NaN. */
#ifndef REMODEL_SORT_H
#define REMODEL_SORT_H

#include <stddef.h>

void sort_doubles(double *values, size_t count);
void sort_floats(float *values, size_t count);
/* Sorts the values and returns their median, of an even number the mean of the middle two; count > 0. */
double sort_median(double *values, size_t count);

#endif
