/* fit_problem.c - the light at points, and the residuals of a fit; fit.c explains the mathematics. */
#include "stages/fit_lights/fit_problem.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "common/math/cholesky.h"
#include "common/math/numbers.h"

#define LEAST_SHARE      0.01 /* of the light at the point that the lamp lights best */
#define LEAST_IRRADIANCE 1e-6 /* of the radiance of a point: in the dark, residuals stay finite */

double fit_usual_log_k_d(void) { return log(USUAL_ALBEDO / PI); }

void fit_set_direct(struct problem *p, int lamp)
{
    const struct light_fit *f = p->f;
    for (int i = 0; i < f->point_count; i++)
        p->direct[lamp * f->point_count + i] = f->direct(f->ctx, lamp, i, f->lamps[lamp].exponent);
}

void fit_set_unknowns(struct problem *p, const double *x)
{
    for (int u = 0; u < p->unknown_count; u++) {
        struct fit_lamp *l = &p->f->lamps[p->unknowns[u].lamp];
        if (p->unknowns[u].colour < 3) {
            l->radiance[p->unknowns[u].colour] = exp(clamp(x[u], -60, 60));
        } else if (l->exponent != fmin(x[u] * x[u], 1000)) {
            l->exponent = fmin(x[u] * x[u], 1000);
            fit_set_direct(p, p->unknowns[u].lamp);
        }
    }
}

void fit_get_unknowns(const struct problem *p, double *x)
{
    for (int u = 0; u < p->unknown_count; u++) {
        const struct fit_lamp *l = &p->f->lamps[p->unknowns[u].lamp];
        x[u] = p->unknowns[u].colour < 3 ? log(l->radiance[p->unknowns[u].colour]) : sqrt(l->exponent);
    }
}

double fit_irradiance(const struct problem *p, int point, int colour)
{
    const struct light_fit *f = p->f;
    double e = f->points[point].indirect[colour];
    for (int l = 0; l < f->lamp_count; l++) e += f->lamps[l].radiance[colour] * p->direct[l * f->point_count + point];
    return fmax(e, LEAST_IRRADIANCE * f->points[point].radiance[colour]);
}

double fit_least_radiance(const struct problem *p, int lamp, int colour)
{
    const struct light_fit *f = p->f;
    double best = 0;
    for (int i = 0; i < f->point_count; i++) {
        const double e = fmax(f->points[i].indirect[colour], LEAST_IRRADIANCE * f->points[i].radiance[colour]);
        best = fmax(best, p->direct[lamp * f->point_count + i] / e);
    }
    return best > 0 ? LEAST_SHARE / best : 0;
}

void fit_set_logs(struct problem *p)
{
    for (int i = 0; i < p->f->point_count; i++)
        for (int c = 0; c < 3; c++) p->logs[3 * i + c] = log(p->f->points[i].radiance[c] / fit_irradiance(p, i, c));
}

void fit_set_residuals(struct problem *p)
{
    struct light_fit *f = p->f;
    const int n = f->point_count;
    fit_set_logs(p);
    for (int c = 0; c < 3; c++) {
        double *whitened = p->whitened + (ptrdiff_t)c * n;
        for (int i = 0; i < n; i++) whitened[i] = p->logs[3 * i + c] - fit_usual_log_k_d();
        cholesky_forward(p->factor, n, whitened);
        for (int m = 0; m < f->material_count; m++) {
            const double *ones = p->ones + (ptrdiff_t)m * n;
            double sum = 0;
            for (int i = 0; i < n; i++) sum += ones[i] * whitened[i];
            f->materials[m].k_d[c] = exp(fit_usual_log_k_d() + ALBEDO_DEVIATION * ALBEDO_DEVIATION * sum);
        }
    }
}

int fit_residual_count(const struct problem *p) { return 3 * (p->f->point_count + 2 * p->f->lamp_count); }

double fit_seen_residual(const struct fit_lamp *lamp, int colour, double radiance)
{
    if (!(lamp->seen_error[colour] > 0 && lamp->seen[colour] > 0)) return 0;
    const double r = log(radiance / lamp->seen[colour]) / lamp->seen_error[colour];
    return lamp->seen_is_bound ? fmin(r, 0) : r;
}

double fit_lit_residual(const struct fit_lamp *lamp, int colour, double radiance)
{
    if (!(lamp->lit_error[colour] > 0 && lamp->lit[colour] > 0)) return 0;
    return log(radiance / lamp->lit[colour]) / lamp->lit_error[colour];
}

void fit_evaluate(void *ctx, const double *x, double *residuals)
{
    struct problem *p = ctx;
    const size_t points = 3 * (size_t)p->f->point_count;
    fit_set_unknowns(p, x);
    fit_set_residuals(p);
    memcpy(residuals, p->whitened, points * sizeof *residuals);
    for (int l = 0; l < p->f->lamp_count; l++) {
        const struct fit_lamp *lamp = &p->f->lamps[l];
        for (int c = 0; c < 3; c++) {
            double *r = residuals + points + 6 * (size_t)l + 2 * (size_t)c;
            r[0] = lamp->fit ? fit_seen_residual(lamp, c, lamp->radiance[c]) : 0;
            r[1] = lamp->fit ? fit_lit_residual(lamp, c, lamp->radiance[c]) : 0;
        }
    }
}
