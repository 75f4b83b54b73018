/* inverse.c - see inverse.h.
 *
 * Step k of the elimination makes column k a unit vector by operations on rows. Of the identity that they would turn
 * into the inverse, column k is the first that changes, so it takes the place of the matrix's column k. Where rows were
 * exchanged it is the column of the row that came to place k, and the columns are put in order at the end. A row that
 * was divided by s has 1 / s in the identity instead of 1. */
#include "common/math/inverse.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

/* Step k; unit: what the identity has in row k. */
static void eliminate(double *a, int n, int k, double unit)
{
    double *row = a + (ptrdiff_t)k * n;
    const double pivot = row[k];
    row[k] = unit;
    for (int j = 0; j < n; j++) row[j] /= pivot;
    for (int i = 0; i < n; i++) {
        double *other = a + (ptrdiff_t)i * n;
        const double factor = other[k];
        if (i == k) continue;
        other[k] = 0;
        for (int j = 0; j < n; j++) other[j] -= factor * row[j];
    }
}

bool inverse_of_symmetric(double *a, int n, double min_pivot)
{
    for (int k = 0; k < n; k++) {
        if (!(fabs(a[(ptrdiff_t)k * n + k]) > min_pivot)) return false;
        eliminate(a, n, k, 1);
    }
    return true;
}

static void swap(double *a, double *b)
{
    const double t = *a;
    *a = *b;
    *b = t;
}

/* Divides a row by its largest size, which is returned, unless that is 0. */
static double scale_row(double *row, int n)
{
    double max = 0;
    for (int j = 0; j < n; j++) max = fmax(max, fabs(row[j]));
    for (int j = 0; max > 0 && j < n; j++) row[j] /= max;
    return max;
}

/* Brings the row with the largest entry in column k, of rows k and below, to place k; returns where it was. */
static int exchange_rows(double *a, int n, int k)
{
    int from = k;
    for (int i = k + 1; i < n; i++)
        if (fabs(a[i * n + k]) > fabs(a[from * n + k])) from = i;
    for (int j = 0; j < n; j++) swap(&a[k * n + j], &a[from * n + j]);
    return from;
}

bool inverse_of(double *a, int n, double min_pivot)
{
    double unit[INVERSE_MAX];
    int from[INVERSE_MAX];
    assert(n <= INVERSE_MAX);
    for (int i = 0; i < n; i++) {
        const double max = scale_row(a + (ptrdiff_t)i * n, n);
        if (!(max > 0)) return false;
        unit[i] = 1 / max;
    }
    for (int k = 0; k < n; k++) {
        from[k] = exchange_rows(a, n, k);
        swap(&unit[k], &unit[from[k]]);
        if (!(fabs(a[k * n + k]) > min_pivot)) return false;
        eliminate(a, n, k, unit[k]);
    }
    for (int k = n - 1; k >= 0; k--)
        for (int i = 0; i < n; i++) swap(&a[i * n + k], &a[i * n + from[k]]);
    return true;
}
