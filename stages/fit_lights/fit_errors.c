/* fit_errors.c - how sure the radiance of lamps is.
 *
 * With whitened residuals the covariance of the unknowns is H^-1, H = J^T J. Colours vary together: with G the sum of
 * products of the colours' summed rows it is H^-1 G H^-1, which differs for the exponent alone. If the residuals are
 * larger than their covariance says, so are the errors. An error of E by a factor that is the same at all points
 * changes S by that factor; its relative error is added. */
#include "stages/fit_lights/fit_errors.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "common/math/inverse.h"

#define STEP 1e-4 /* of an unknown, for derivatives */

/* Derivatives of the residuals, [unknown][residual]. low: room for residuals. */
static void differentiate(struct problem *p, double *jacobian, double *low)
{
    const int n = p->unknown_count, rows = fit_residual_count(p);
    double x[MAX_UNKNOWNS] = {0};
    fit_get_unknowns(p, x);
    for (int u = 0; u < n; u++) {
        const double at = x[u], step = p->unknowns[u].colour < 3 ? STEP : STEP * fmax(1, at);
        double *column = jacobian + (ptrdiff_t)u * rows;
        x[u] = at + step;
        fit_evaluate(p, x, column);
        x[u] = at - step;
        fit_evaluate(p, x, low);
        for (int i = 0; i < rows; i++) column[i] = (column[i] - low[i]) / (2 * step);
        x[u] = at;
    }
    fit_evaluate(p, x, low);
}

/* The row of a derivative, summed over the colours of a point or of a lamp's picture. */
static double summed(const struct problem *p, const double *column, int i)
{
    const int n = p->f->point_count;
    if (i < n) return column[i] + column[n + i] + column[2 * n + i];
    const double *lamp = column + 3 * (ptrdiff_t)i;
    return lamp[0] + lamp[1] + lamp[2];
}

/* The factor by which residuals exceed their covariance, at least 1. */
static double excess(const struct problem *p, const double *residuals)
{
    const int points = p->f->point_count, dof = 3 * points - p->unknown_count - 3 * p->f->material_count;
    double squares = 0;
    for (int i = 0; i < 3 * points; i++) squares += residuals[i] * residuals[i];
    return dof > 0 ? fmax(1, sqrt(squares / dof)) : 1;
}

/* Standard errors of the unknowns; infinite if something is not determined. */
static void find_errors(struct problem *p, double *jacobian, double errors[MAX_UNKNOWNS])
{
    const int n = p->unknown_count, rows = fit_residual_count(p), places = p->f->point_count + p->f->lamp_count;
    double h[MAX_UNKNOWNS * MAX_UNKNOWNS] = {0}, g[MAX_UNKNOWNS * MAX_UNKNOWNS] = {0};
    double *residuals = jacobian + (ptrdiff_t)n * rows;
    differentiate(p, jacobian, residuals);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            const double *one = jacobian + (ptrdiff_t)a * rows, *other = jacobian + (ptrdiff_t)b * rows;
            for (int i = 0; i < rows; i++) h[a * n + b] += one[i] * other[i];
            for (int i = 0; i < places; i++) g[a * n + b] += summed(p, one, i) * summed(p, other, i);
        }
    const bool known = inverse_of_symmetric(h, n, 1e-300);
    for (int a = 0; a < n; a++) {
        double v = 0;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) v += h[a * n + i] * g[i * n + j] * h[j * n + a];
        errors[a] = known ? sqrt(fmax(v, 0)) * excess(p, residuals) : INFINITY;
    }
}

void fit_set_errors(struct problem *p, double *jacobian)
{
    double errors[MAX_UNKNOWNS];
    find_errors(p, jacobian, errors);
    struct light_fit *f = p->f;
    for (int u = 0; u < p->unknown_count; u++) {
        struct fit_lamp *l = &f->lamps[p->unknowns[u].lamp];
        const int c = p->unknowns[u].colour;
        const double e = isfinite(errors[u]) ? errors[u] : 1;
        if (c < 3)
            l->radiance_error[c] = l->radiance[c] * hypot(e, f->irradiance_error);
        else
            l->exponent_error = 2 * sqrt(l->exponent) * e + e * e;
    }
    for (int m = 0; m < f->material_count; m++) {
        const double *ones = p->ones + (ptrdiff_t)m * f->point_count;
        double weights = 0;
        for (int i = 0; i < f->point_count; i++) weights += ones[i] * ones[i];
        for (int c = 0; c < 3; c++)
            f->materials[m].k_d_error[c] =
                weights > 0 ? f->materials[m].k_d[c] * hypot(1 / sqrt(weights), f->irradiance_error) : 0;
    }
}
