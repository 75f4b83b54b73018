/* cholesky.c - see cholesky.h.
 *
 * Each element of L^-1 b is what is left of b's after a sum of products, whose order is fixed. One such sum waits for
 * each of its additions. So ROWS rows are summed side by side: the same bits, in a fifth of the time. */
#include "common/math/cholesky.h"

#include <math.h>
#include <stddef.h>

enum { ROWS = 8 };

/* from less the scalar product of two vectors. */
static double less_product(double from, const double *a, const double *b, int n)
{
    for (int j = 0; j < n; j++) from -= a[j] * b[j];
    return from;
}

/* b[at], ..., b[at + ROWS - 1], of those from `first` on. */
static void solve_rows(const double *l, int n, int first, int at, double *b)
{
    const double *row = l + (ptrdiff_t)at * n;
    double sum[ROWS];
    for (int r = 0; r < ROWS; r++) sum[r] = b[at + r];
    for (int j = first; j < at; j++)
        for (int r = 0; r < ROWS; r++) sum[r] -= row[(ptrdiff_t)r * n + j] * b[j];
    for (int r = 0; r < ROWS; r++, row += n) b[at + r] = less_product(sum[r], row + at, b + at, r) / row[at + r];
}

/* b = L^-1 b of the first `count` rows of L, whose rows have n numbers; b is 0 before `first`. */
static void forward(const double *l, int n, int count, int first, double *b)
{
    int i = first;
    for (; i + ROWS <= count; i += ROWS) solve_rows(l, n, first, i, b);
    for (; i < count; i++) {
        const double *row = l + (ptrdiff_t)i * n;
        b[i] = less_product(b[i], row + first, b + first, i - first) / row[i];
    }
}

bool cholesky_factor(double *a, int n)
{
    for (int i = 0; i < n; i++) {
        double *row = a + (ptrdiff_t)i * n;
        forward(a, n, i, 0, row);
        const double pivot = less_product(row[i], row, row, i);
        if (!(pivot > 0)) return false;
        row[i] = sqrt(pivot);
    }
    return true;
}

void cholesky_forward(const double *l, int n, double *b) { forward(l, n, n, 0, b); }
void cholesky_forward_from(const double *l, int n, int first, double *b) { forward(l, n, n, first, b); }

void cholesky_backward(const double *l, int n, double *b)
{
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) b[i] -= l[(ptrdiff_t)j * n + i] * b[j];
        b[i] /= l[(ptrdiff_t)i * n + i];
    }
}
