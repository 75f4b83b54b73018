/* ceres_least_squares.h - nonlinear least squares by Ceres: Levenberg-Marquardt, derivatives by central differences. */
#ifndef REMODEL_CERES_LEAST_SQUARES_H
#define REMODEL_CERES_LEAST_SQUARES_H

#ifdef __cplusplus
extern "C" {
#endif

#include "common/base/err.h"

struct least_squares {
    int unknowns, residuals;
    void (*evaluate)(void *ctx, const double *x, double *residuals); /* finite for any finite x */
    void *ctx;
    int iterations; /* at most */
};

/* x: a start on entry, a local minimum on return, or as near to it as the iterations come. One thread: same bits
 * always. ST_DATA: no step could be made from the start. */
enum status ceres_least_squares(const struct least_squares *problem, double *x, struct err *err);

#ifdef __cplusplus
}
#endif

#endif
