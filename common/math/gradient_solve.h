/* gradient_solve.h - weighted least squares on a raster: values whose differences between neighbours are given
 * (gradient-domain compositing [Perez 2003; Bhat 2010; Colburn 2014, 4.5.2]).
 *
 * Minimizes, separately for each of 3 channels,
 *     sum over free pixels p     data_weight[p] (v[p] - data[p])^2
 *   + sum over right neighbours  weight_x[p] (v[p + 1] - v[p] - gradient_x[p])^2
 *   + sum over lower neighbours  weight_y[p] (v[p + width] - v[p] - gradient_y[p])^2
 * Weights multiply squared residuals and are shared by the channels. A pair counts if both pixels take part and at
 * least one is free. */
#ifndef REMODEL_GRADIENT_SOLVE_H
#define REMODEL_GRADIENT_SOLVE_H

#include <stdint.h>

#include "common/base/err.h"

enum gradient_role {
    GRADIENT_OUT,   /* not part of the picture */
    GRADIENT_FREE,  /* unknown */
    GRADIENT_FIXED, /* keeps its value */
};

/* Row-major; everything is the caller's. Arrays of 3 channels are interleaved. */
struct gradient_problem {
    int width, height;
    const uint8_t *role;                /* enum gradient_role */
    const float *data_weight, *data;    /* 1 and 3 a pixel; weight 0: no data */
    const float *weight_x, *gradient_x; /* 1 and 3 a pixel: the pair of this pixel and the next in the row */
    const float *weight_y, *gradient_y; /* the pair of this pixel and the one below */
    float *value;                       /* 3 a pixel: in: fixed values, and where to start; out: the solution */
};

struct gradient_report {
    double residual; /* largest |A v - b| over free pixels and channels, divided by the largest |b|, or by 1 if b = 0 */
    int free;        /* unknowns a channel */
    int undetermined; /* free pixels in parts that neither data nor a fixed pixel determines */
    int iterations;   /* 0: a direct solve */
};

/* Same bytes for any number of threads. Each connected part of free pixels (joined by pairs of weight above 0) that
 * neither data nor a fixed pixel determines keeps the mean of its start. Only what counts is read: no datum or gradient
 * of weight 0, no pair of fixed pixels. ST_DATA: a weight that is negative or not finite, or a value, a datum or a
 * gradient that is not finite, named by pixel; ST_NOMEM; ST_INTERNAL: no convergence. On failure values stay. */
enum status gradient_solve(const struct gradient_problem *p, struct gradient_report *report, struct err *err);
/* The same by sparse Cholesky factors (CHOLMOD): the reference. */
enum status gradient_solve_direct(const struct gradient_problem *p, struct gradient_report *report, struct err *err);
/* The same by multigrid alone. Its largest error is about 1e-5 of the range of the values. ST_INTERNAL, too: a weight
 * above 0 is less than 1e-7 of the largest. */
enum status gradient_solve_multigrid(const struct gradient_problem *p, struct gradient_report *report, struct err *err);

#endif
