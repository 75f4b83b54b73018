/* cholesky.h - dense symmetric positive definite systems by Cholesky factors, in a fixed order of operations: the same
 * bits on every machine. Matrices are row-major; of a symmetric one the lower triangle is read. Sparse systems:
 * gradient_solve.h. */
#ifndef REMODEL_MATH_CHOLESKY_H
#define REMODEL_MATH_CHOLESKY_H

#include <stdbool.h>

/* Replaces the lower triangle of a (n x n) by L with L L^T = a. False: it is not positive definite; a is then lost. */
bool cholesky_factor(double *a, int n);

/* b = L^-1 b, and b = L^-T b; both, one after the other, solve a x = b. */
void cholesky_forward(const double *l, int n, double *b);
void cholesky_backward(const double *l, int n, double *b);
/* cholesky_forward of a vector that is 0 before its element `first`, in less time. */
void cholesky_forward_from(const double *l, int n, int first, double *b);

#endif
