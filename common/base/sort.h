/* sort.h - sorts numbers in ascending order. None may be NaN. */
#ifndef REMODEL_SORT_H
#define REMODEL_SORT_H

#include <stddef.h>

void sort_doubles(double *values, size_t count);
void sort_floats(float *values, size_t count);

#endif
