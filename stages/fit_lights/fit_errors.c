/* fit_errors.c - how sure the radiance of lamps is.
 *
 * The covariance is H^-1 (sum of g g^T) H^-1 with H = J^T W J and g a point's part of the gradient [Huber 1967], which
 * needs no assumption on the residuals' variance. An error of E by a factor that is the same at all points changes S by
 * that factor; its relative error is added.
 *
 * What differs from the source: clusters are also points that a person marked together, and an assumed deviation of the
 * material bounds the error from below, because few points may agree by chance. */
#include <math.h>
#include <string.h>

#include "stages/fit_lights/fit_problem.h"

#define STEP 1e-4 /* of an unknown, for derivatives */

/* Inverts a symmetric positive matrix in place by Gauss-Jordan elimination; false: it is singular. */
static bool invert(double *a, int n)
{
    for (int k = 0; k < n; k++) {
        const double pivot = a[k * n + k];
        if (!(fabs(pivot) > 1e-300)) return false;
        a[k * n + k] = 1;
        for (int j = 0; j < n; j++) a[k * n + j] /= pivot;
        for (int i = 0; i < n; i++) {
            const double factor = a[i * n + k];
            if (i == k) continue;
            a[i * n + k] = 0;
            for (int j = 0; j < n; j++) a[i * n + j] -= factor * a[k * n + j];
        }
    }
    return true;
}

static int cluster_count(const struct light_fit *f)
{
    int count = 0;
    for (int i = 0; i < f->point_count; i++) count += !i || f->points[i].cluster != f->points[i - 1].cluster;
    return count;
}

/* Adds the products of gradients, of single points or summed over clusters. Points of a cluster follow each other. */
static void add_meat(const struct problem *p, const double *jacobian, bool clusters, double *meat)
{
    const int n = p->unknown_count, points = p->f->point_count, rows = 3 * points;
    double g[MOST_UNKNOWNS] = {0};
    for (int i = 0; i < points; i++) {
        for (int a = 0; a < n; a++)
            for (int c = 3 * i; c < 3 * i + 3; c++)
                g[a] += jacobian[a * rows + c] * sqrt(p->weight[c]) * p->residual[c];
        if (clusters && i + 1 < points && p->f->points[i + 1].cluster == p->f->points[i].cluster) continue;
        for (int a = 0; a < n; a++)
            for (int b = 0; b < n; b++) meat[a * n + b] += g[a] * g[b];
        memset(g, 0, sizeof g);
    }
}

/* The roots of the diagonal of H^-1 meat H^-1, corrected for the number of clusters. */
static void cluster_errors(double *errors, const double *h, const double *meat, int n, int clusters,
                           const struct problem *p)
{
    /* unknowns and reflectances of one colour use up clusters */
    const int used = (n + 2) / 3 + p->f->material_count;
    const double correction = clusters > used ? (double)clusters / (clusters - used) : clusters;
    for (int a = 0; a < n; a++) {
        double v = 0;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) v += h[a * n + i] * meat[i * n + j] * h[j * n + a];
        errors[a] = sqrt(v * correction);
    }
}

/* The errors if the reflectance of all points that were marked together deviates in all colours: by `texture`, or by half of
 * what single points of the material do, as they cover a few of its planks or bricks. */
static void assumed_errors(double *errors, const double *h, const double *jacobian, const struct problem *p)
{
    const struct light_fit *f = p->f;
    const int n = p->unknown_count, rows = 3 * f->point_count;
    double shift[MOST_UNKNOWNS] = {0}, variances[MOST_UNKNOWNS] = {0};
    for (int i = 0; i < f->point_count; i++) {
        const double deviation = fmax(f->texture, 0.5 * f->materials[f->points[i].material].spread);
        for (int a = 0; a < n; a++)
            for (int c = 3 * i; c < 3 * i + 3; c++)
                shift[a] += jacobian[a * rows + c] * sqrt(p->weight[c]) * deviation / sqrt(fit_variance(f, i));
        if (i + 1 < f->point_count && f->points[i + 1].cluster == f->points[i].cluster) continue;
        for (int a = 0; a < n; a++) {
            double moved = 0;
            for (int b = 0; b < n; b++) moved += h[a * n + b] * shift[b];
            variances[a] += moved * moved;
        }
        memset(shift, 0, sizeof shift);
    }
    for (int a = 0; a < n; a++) errors[a] = sqrt(variances[a]);
}

/* Standard errors of the unknowns: the largest of what single points, points marked together, and the assumed deviations
 * of noise and material show, because few points may agree by chance. jacobian: [unknown][residual]. */
static void find_errors(struct problem *p, double *jacobian, double errors[MOST_UNKNOWNS])
{
    const int n = p->unknown_count, points = p->f->point_count, rows = 3 * points;
    double x[MOST_UNKNOWNS] = {0}, h[MOST_UNKNOWNS * MOST_UNKNOWNS] = {0}, meat[MOST_UNKNOWNS * MOST_UNKNOWNS] = {0};
    double *low = p->residual, clustered[MOST_UNKNOWNS];
    fit_get_unknowns(p, x);
    for (int u = 0; u < n; u++) {
        const double at = x[u], step = p->unknowns[u].colour < 3 ? STEP : STEP * fmax(1, at);
        x[u] = at + step;
        fit_evaluate(p, x, jacobian + (ptrdiff_t)u * rows);
        x[u] = at - step;
        fit_set_unknowns(p, x);
        fit_set_residuals(p);
        for (int i = 0; i < rows; i++)
            jacobian[u * rows + i] = (jacobian[u * rows + i] - sqrt(p->weight[i]) * low[i]) / (2 * step);
        x[u] = at;
    }
    fit_set_unknowns(p, x);
    fit_set_residuals(p);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int i = 0; i < rows; i++) h[a * n + b] += jacobian[a * rows + i] * jacobian[b * rows + i];
    if (!invert(h, n)) {
        for (int a = 0; a < n; a++) errors[a] = INFINITY;
        return;
    }
    add_meat(p, jacobian, false, meat);
    cluster_errors(errors, h, meat, n, points, p);
    memset(meat, 0, sizeof meat);
    add_meat(p, jacobian, true, meat);
    cluster_errors(clustered, h, meat, n, cluster_count(p->f), p);
    for (int a = 0; a < n; a++) errors[a] = fmax(errors[a], clustered[a]);
    assumed_errors(clustered, h, jacobian, p);
    for (int a = 0; a < n; a++) errors[a] = fmax(fmax(errors[a], clustered[a]), sqrt(h[a * n + a]));
}

void fit_set_errors(struct problem *p, double *jacobian)
{
    double errors[MOST_UNKNOWNS];
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
    for (int m = 0; m < f->material_count; m++)
        for (int c = 0; c < 3; c++) {
            struct fit_material *material = &f->materials[m];
            const int n = material->lit + material->unlit;
            material->k_d_error[c] =
                material->k_d[c] * hypot(fmax(material->spread, f->texture) / sqrt(fmax(n, 1)), f->irradiance_error);
        }
}
