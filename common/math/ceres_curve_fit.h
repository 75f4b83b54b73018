/* ceres_curve_fit.h - nonlinear least squares by Ceres with derivatives, bounds and a robust loss: Levenberg-Marquardt
 * from one start. */
#ifndef REMODEL_CERES_CURVE_FIT_H
#define REMODEL_CERES_CURVE_FIT_H

#ifdef __cplusplus
extern "C" {
#endif

#include <stdbool.h>

#include "common/base/err.h"

/* Residuals come in blocks of equal size, each with one loss: 2 cost = the sum of rho(|r|^2) over blocks r. */
struct curve_fit {
    int unknowns, blocks, block_size;
    /* Fills residuals[blocks * block_size] and, unless it is NULL, jacobian[blocks * block_size][unknowns]. All must be
     * finite within the bounds. */
    void (*evaluate)(void *ctx, const double *x, double *residuals, double *jacobian);
    void *ctx;
    const double *lower, *upper; /* of each unknown; an infinite bound is none */
    double cauchy;               /* rho(s) = cauchy^2 log(1 + s / cauchy^2); 0: rho(s) = s */
    int iterations;              /* maximum */
};

struct curve_fit_outcome {
    double cost;
    bool converged; /* false: stopped by the maximum of iterations */
    int iterations;
};

/* x: the start on entry, within the bounds; the solution on return. Runs in one thread, so that the same input gives
 * the same bits. ST_DATA: Ceres found no usable solution. */
enum status ceres_curve_fit(struct curve_fit_outcome *outcome, const struct curve_fit *problem, double *x,
                            struct err *err);

#ifdef __cplusplus
}
#endif

#endif
