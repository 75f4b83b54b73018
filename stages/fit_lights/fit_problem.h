/* fit_problem.h - shared by fit.c and fit_errors.c: the unknowns, weights and residuals of a fit. */
#ifndef REMODEL_FIT_LIGHTS_FIT_PROBLEM_H
#define REMODEL_FIT_LIGHTS_FIT_PROBLEM_H

#include "stages/fit_lights/fit.h"

enum { MOST_UNKNOWNS = 64 };

struct unknown {
    int lamp, colour; /* colour 3: the exponent */
};

struct problem {
    struct light_fit *f;
    struct unknown unknowns[MOST_UNKNOWNS];
    int unknown_count;
    double *direct; /* [lamp][point] at the lamps' present exponents */
    double *weight; /* per point and colour, robust; times 1 / sigma^2 it is the weight of the squared residual */
    double *residual;
};

/* The unknowns: logarithms of radiance, roots of exponents. */
void fit_set_unknowns(struct problem *p, const double *x);
void fit_get_unknowns(const struct problem *p, double *x);
/* The variance of a point's residual before it is divided by it. */
double fit_variance(const struct light_fit *f, int point);
/* Sets the residuals, not yet robust, and k_d of the materials. */
void fit_set_residuals(struct problem *p);
/* Sets the unknowns, then residuals times the roots of their weights. ctx: the problem. */
void fit_evaluate(void *ctx, const double *x, double *residuals);

/* Sets the standard errors of lamps and materials. jacobian: room for a number per unknown and residual. */
void fit_set_errors(struct problem *p, double *jacobian);

#endif
