/* weighted.h - weighted percentiles. */
#ifndef REMODEL_WEIGHTED_H
#define REMODEL_WEIGHTED_H

#include <stddef.h>

struct weighted {
    double value, weight;
};

/* The smallest value up to which `fraction` (0 to 1) of the total weight lies; 0 if count is 0. Sorts the values. */
double weighted_percentile(struct weighted *values, size_t count, double fraction);

#endif
