/* kmeans1d.c - exact k-means of numbers on a line [Wang 2011].
 *
 * Clusters of sorted numbers are ranges. D[j][i], the min cost of the first i + 1 numbers in j + 1 ranges, is the
 * minimum over m of D[j - 1][m - 1] + cost(m, i). The best m does not decrease with i (the cost satisfies the
 * quadrangle inequality), so a row is filled by divide and conquer: the middle's m bounds the m of both halves. That
 * takes O(k n log n) time instead of the source's O(k n^2). Costs come from prefix sums of the numbers minus their
 * mean, in long double, so that cancellation stays far below the rounding of doubles. */
#include "stages/find_axes/kmeans1d.h"

#include <stdlib.h>

struct rows {
    const long double *sum, *square; /* of the first i numbers, i = 0 .. count */
    const double *before;            /* D of one range fewer */
    double *now;
    size_t *first; /* begin of the last range */
};

static double cost(const struct rows *r, size_t from, size_t last)
{
    const long double n = (long double)(last + 1 - from), s = r->sum[last + 1] - r->sum[from];
    const long double c = r->square[last + 1] - r->square[from] - s * s / n;
    return c > 0 ? (double)c : 0;
}

/* Fills the row for numbers low .. high, whose last ranges begin in from .. to. */
static void fill(const struct rows *r, size_t low, size_t high, size_t from, size_t to)
{
    while (low <= high) {
        const size_t middle = low + (high - low) / 2;
        size_t best = from;
        double min_cost = -1;
        for (size_t m = from; m <= to && m <= middle; m++) {
            const double c = r->before[m - 1] + cost(r, m, middle);
            if (min_cost >= 0 && !(c < min_cost)) continue;
            min_cost = c;
            best = m;
        }
        r->now[middle] = min_cost;
        r->first[middle] = best;
        if (middle > low) fill(r, low, middle - 1, from, best);
        low = middle + 1;
        from = best;
    }
}

enum status kmeans1d(size_t *begin, const double *values, size_t count, int k, struct err *err)
{
    const size_t clusters = (size_t)k;
    long double *sum = calloc(count + 1, sizeof *sum), *square = calloc(count + 1, sizeof *square), mean = 0;
    double *costs[2] = {malloc(count * sizeof **costs), malloc(count * sizeof **costs)};
    size_t *first = malloc(clusters * count * sizeof *first);
    if (!sum || !square || !costs[0] || !costs[1] || !first)
        err_nomem(err, "clusters of numbers", (clusters + 6) * count * sizeof *first);
    for (size_t i = 0; i < count; i++) mean += values[i];
    mean /= (long double)count;
    for (size_t i = 0; !err->status && i < count; i++) {
        const long double x = values[i] - mean;
        sum[i + 1] = sum[i] + x;
        square[i + 1] = square[i] + x * x;
    }
    struct rows r = {sum, square, NULL, costs[0], first};
    for (size_t i = 0; !err->status && i < count; i++) r.now[i] = cost(&r, 0, i);
    for (size_t j = 1; !err->status && j < clusters; j++) {
        r.before = costs[(j + 1) % 2];
        r.now = costs[j % 2];
        r.first = first + j * count;
        fill(&r, j, count - 1, j, count - 1);
    }
    if (!err->status) {
        begin[clusters] = count;
        for (size_t j = clusters - 1; j > 0; j--) begin[j] = first[j * count + begin[j + 1] - 1];
        begin[0] = 0;
    }
    free(sum);
    free(square);
    free(costs[0]);
    free(costs[1]);
    free(first);
    return err->status;
}
