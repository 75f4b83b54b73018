#include "common/math/cholesky.h"

#include <math.h>
#include <stddef.h>

/* from less the scalar product of two vectors. */
static double less_product(double from, const double *a, const double *b, int n)
{
    for (int j = 0; j < n; j++) from -= a[j] * b[j];
    return from;
}

bool cholesky_factor(double *a, int n)
{
    for (int i = 0; i < n; i++) {
        double *row = a + (ptrdiff_t)i * n;
        for (int k = 0; k < i; k++) {
            const double *other = a + (ptrdiff_t)k * n;
            row[k] = less_product(row[k], row, other, k) / other[k];
        }
        const double pivot = less_product(row[i], row, row, i);
        if (!(pivot > 0)) return false;
        row[i] = sqrt(pivot);
    }
    return true;
}

void cholesky_forward(const double *l, int n, double *b)
{
    for (int i = 0; i < n; i++) {
        const double *row = l + (ptrdiff_t)i * n;
        b[i] = less_product(b[i], row, b, i) / row[i];
    }
}

void cholesky_backward(const double *l, int n, double *b)
{
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) b[i] -= l[(ptrdiff_t)j * n + i] * b[j];
        b[i] /= l[(ptrdiff_t)i * n + i];
    }
}
