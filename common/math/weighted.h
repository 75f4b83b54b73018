/* weighted.h - percentiles of numbers that do not count alike. */
#ifndef REMODEL_WEIGHTED_H
#define REMODEL_WEIGHTED_H

#include <stddef.h>

struct weighted {
    double value, weight;
};

/* The value up to which `part` (0..1) of the weight lies; 0 if there is none. Sorts the values. */
double weighted_percentile(struct weighted *values, size_t count, double part);

#endif
