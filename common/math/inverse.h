/* inverse.h - inverses of small dense matrices by Gauss-Jordan elimination, row-major and in place, in a fixed order of
 * operations. False, and the matrix is lost: a pivot's size is not above min_pivot. Systems that need no inverse:
 * cholesky.h. */
#ifndef REMODEL_MATH_INVERSE_H
#define REMODEL_MATH_INVERSE_H

#include <stdbool.h>

enum { INVERSE_MAX = 8 };

/* Of a symmetric positive definite matrix: pivots are the diagonal's, as they come. */
bool inverse_of_symmetric(double *a, int n, double min_pivot);

/* Of any matrix of at most INVERSE_MAX rows, scaled to a largest entry of 1 and exchanged for the largest pivot. */
bool inverse_of(double *a, int n, double min_pivot);

#endif
