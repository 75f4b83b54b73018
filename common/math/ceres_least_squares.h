/* ceres_least_squares.h - nonlinear least squares by Ceres: Levenberg-Marquardt with numeric derivatives (central
 * differences). */
#ifndef REMODEL_CERES_LEAST_SQUARES_H
#define REMODEL_CERES_LEAST_SQUARES_H

#ifdef __cplusplus
extern "C" {
#endif

#include "common/base/err.h"

struct least_squares {
    int unknowns, residuals;
    void (*evaluate)(void *ctx, const double *x, double *residuals); /* residuals must be finite for any finite x */
    void *ctx;
    int iterations; /* maximum */
};

/* x: the initial values on entry, the solution on return; it may not be converged after the maximum of iterations. Runs
 * in one thread, so that the same input gives the same bits. ST_DATA: Ceres found no usable solution. */
enum status ceres_least_squares(const struct least_squares *problem, double *x, struct err *err);

#ifdef __cplusplus
}
#endif

#endif
