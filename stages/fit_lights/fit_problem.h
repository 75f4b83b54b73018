/* fit_problem.h - the unknowns of a fit, and its residuals, whitened by their covariance. */
#ifndef REMODEL_FIT_LIGHTS_FIT_PROBLEM_H
#define REMODEL_FIT_LIGHTS_FIT_PROBLEM_H

#include "stages/fit_lights/light_fit.h"

enum { MAX_UNKNOWNS = 256, MAX_FIT_POINTS = 1500 };

/* What is known of a material before anything is measured: the logarithm of its albedo is normal. Nearly all surfaces
 * of rooms have albedos from 0.06 to 0.9. */
#define USUAL_ALBEDO     0.35
#define ALBEDO_DEVIATION 0.9

/* Offsets of marks have Student's t distribution with MARK_FREEDOM degrees: most are small, a few are large. */
#define MARK_FREEDOM 2.0
#define MARK_SCALE   0.5 /* of the assumed texture */

struct unknown {
    int lamp, colour; /* colour 3: the exponent */
};

struct problem {
    struct light_fit *f;
    struct unknown unknowns[MAX_UNKNOWNS];
    int unknown_count;
    double *direct;      /* [lamp][point] at the lamps' present exponents */
    double *logs;        /* [point][colour] of radiance over irradiance */
    double *excess;      /* [point] variance beyond that of noise, material and mark, of outliers */
    double *factor;      /* [point][point] Cholesky factor of the residuals' covariance */
    double *ones;        /* [material][point] whitened: 1 at the material's points */
    double *whitened;    /* [colour][point] residuals times the inverse of the factor */
    double *vector;      /* [point], and */
    double *next_excess; /* [point]: room for work */
};

/* The logarithm of k_d that is assumed before anything is measured. */
double fit_usual_log_k_d(void);
/* Renews the light of a lamp at the points, after a change of its exponent. */
void fit_set_direct(struct problem *p, int lamp);
/* The irradiance of a point from everything; above 0. */
double fit_irradiance(const struct problem *p, int point, int colour);
/* The irradiance at which the light of a lamp at a point begins to show: the logarithm of radiance is penalised below
 * it. */
double fit_least_radiance(const struct problem *p, int lamp, int colour);
/* The unknowns: logarithms of radiance, roots of exponents. */
void fit_set_unknowns(struct problem *p, const double *x);
void fit_get_unknowns(const struct problem *p, double *x);
/* Sets the logarithms of radiance over irradiance. */
void fit_set_logs(struct problem *p);
/* Sets the logarithms, then the whitened residuals and k_d of the materials. */
void fit_set_residuals(struct problem *p);
/* The residuals of a fit: of the points' colours, of the lamps' pictures, and of what faces tell of the lamps. */
int fit_residual_count(const struct problem *p);
/* The deviation of a lamp's radiance from what views show of it, in standard errors; of a lower bound, only below
 * it. */
double fit_seen_residual(const struct fit_lamp *lamp, int colour, double radiance);
/* The same of what all faces tell. */
double fit_lit_residual(const struct fit_lamp *lamp, int colour, double radiance);
/* Sets the unknowns, then the residuals, whitened. ctx: the problem. */
void fit_evaluate(void *ctx, const double *x, double *residuals);

#endif
