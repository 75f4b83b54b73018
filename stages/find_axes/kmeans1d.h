/* kmeans1d.h - k-means of numbers on a line, solved exactly: no seeds, no local minima. */
#ifndef REMODEL_KMEANS1D_H
#define REMODEL_KMEANS1D_H

#include <stddef.h>

#include "common/base/err.h"

/* values: count >= k >= 1 finite numbers, ascending. Cluster j is values[begin[j] .. begin[j + 1] - 1], never empty;
 * begin has k + 1 items. The sum of squared distances to the clusters' means is minimal, to rounding; of equal
 * solutions the one whose last cluster begins first. O(k count log count) time, O(k count) memory. */
enum status kmeans1d(size_t *begin, const double *values, size_t count, int k, struct err *err);

#endif
