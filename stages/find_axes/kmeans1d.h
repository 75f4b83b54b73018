/* kmeans1d.h - k-means of numbers on a line, solved exactly.
 *
 * H. Wang and M. Song, "Ckmeans.1d.dp: optimal k-means clustering in one dimension by dynamic programming", The R
 * Journal 3(2), 2011: clusters of sorted numbers are ranges, and the best first j ranges of the first i numbers hold the
 * best first j - 1 of fewer. There are no seeds, and no luck. */
#ifndef REMODEL_KMEANS1D_H
#define REMODEL_KMEANS1D_H

#include <stddef.h>

#include "common/base/err.h"

/* values: count >= k >= 1 finite numbers, ascending. Cluster j is values[begin[j] .. begin[j + 1] - 1], never empty;
 * begin[k + 1]. The sum of squared distances to the clusters' means is the least there is, to rounding; of equally good
 * answers the one whose last cluster begins first. O(k count log count) time, O(k count) memory. */
enum status kmeans1d(size_t *begin, const double *values, size_t count, int k, struct err *err);

/* That sum, of one range. */
double kmeans1d_cost(const double *values, size_t count);

#endif
