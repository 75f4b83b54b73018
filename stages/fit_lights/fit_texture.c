/* fit_texture.c - see fit_texture.h.
 *
 * Overview. The reflectance of plaster or brick varies, but less between neighbours than across a wall. Points just
 * inside and just outside of a cone tell more of a lamp than points far apart, and a hundred points on one patch tell
 * less of the wall than ten in ten places. The covariance of the points' deviations says both; a generalised
 * least-squares fit then weights all pairs as they deserve.
 *
 * Mathematics. Logarithms of reflectance are a Gaussian process: deviation^2 ((1 - grain) exp(-d / length) + grain [d =
 * 0]) is the covariance of two points of a material at a distance d [Cressie 1993]. The three are those of the greatest
 * restricted likelihood [Patterson 1971], which allows for the mean that is taken from the same points, on a grid of
 * lengths and grains; deviation has a closed form, with a few points' worth of the assumed deviation. Colours vary
 * together: they count as one sample.
 *
 * A point that the others do not predict (a poster) has its variance enlarged, so that its error, which the inverse of
 * the covariance gives, is OUTLIER standard deviations: it counts less, the farther off it is. */
#include "stages/fit_lights/fit_texture.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"

enum { MAX_SAMPLED = 256, LENGTHS = 7, GRAINS = 4, MIN_POINTS = 8, PRIOR_POINTS = 4 };
static const double grains[GRAINS] = {0.02, 0.1, 0.3, 0.6};
#define OUTLIER 2.5

static double distance(const struct light_fit *f, int a, int b)
{
    return vec3_length(vec3_sub(f->points[a].at, f->points[b].at));
}

static double correlation(const struct light_fit *f, int a, int b, double length, double grain)
{
    return (1 - grain) * (length > 0 ? exp(-distance(f, a, b) / length) : 0);
}

/* ---------------------------------------------------------------------------------------------------- the variation */

struct sampled {
    int points[MAX_SAMPLED], count;
    int unknowns; /* of one colour: lamps that are fitted to the material */
};

static struct sampled sample(const struct problem *p, int material)
{
    const struct light_fit *f = p->f;
    struct sampled s = {.count = 0};
    int all = 0, at = 0;
    for (int i = 0; i < f->point_count; i++) all += f->points[i].material == material;
    const int stride = (all + MAX_SAMPLED - 1) / MAX_SAMPLED;
    for (int i = 0; i < f->point_count; i++)
        if (f->points[i].material == material && at++ % stride == 0) s.points[s.count++] = i;
    for (int l = 0; l < f->lamp_count; l++) s.unknowns += f->lamps[l].fit && f->lamps[l].material == material;
    return s;
}

/* The restricted likelihood's logarithm; sets *variance. matrix and vector: room for the points. */
static double likelihood(double *variance, const struct problem *p, const struct sampled *s, double length,
                         double grain, double *matrix, double *vector)
{
    const int n = s->count, dof = n - 1 - s->unknowns;
    const double before = p->f->materials[p->f->points[s->points[0]].material].deviation;
    double ones[MAX_SAMPLED], determinant = 0, weights = 0, squares = 0;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) matrix[i * n + k] = correlation(p->f, s->points[i], s->points[k], length, grain);
        matrix[i * n + i] = 1 + p->excess[s->points[i]] / (before * before);
        ones[i] = 1;
    }
    if (!cholesky_factor(matrix, n)) return -INFINITY;
    cholesky_forward(matrix, n, ones);
    for (int i = 0; i < n; i++) {
        determinant += 2 * log(matrix[i * n + i]);
        weights += ones[i] * ones[i];
    }
    for (int c = 0; c < 3; c++) {
        double along = 0;
        for (int i = 0; i < n; i++) vector[i] = p->logs[3 * s->points[i] + c];
        cholesky_forward(matrix, n, vector);
        for (int i = 0; i < n; i++) along += vector[i] * ones[i] / weights;
        for (int i = 0; i < n; i++) squares += (vector[i] - along * ones[i]) * (vector[i] - along * ones[i]) / 3;
    }
    const double prior = PRIOR_POINTS * p->f->texture * p->f->texture;
    *variance = (squares + prior) / (dof + PRIOR_POINTS) + 1e-12;
    return -0.5 * ((dof + PRIOR_POINTS) * log(*variance) + determinant + log(weights));
}

static void estimate_material(struct problem *p, int material, double *matrix, double *vector)
{
    const struct sampled s = sample(p, material);
    struct fit_material *m = &p->f->materials[material];
    double longest = 0, variance = 0;
    if (s.count < MIN_POINTS || s.count <= 1 + s.unknowns) return;
    for (int i = 0; i < s.count; i++) longest = fmax(longest, distance(p->f, s.points[0], s.points[i]));
    double best = likelihood(&variance, p, &s, 0, 1, matrix, vector), deviation = sqrt(variance);
    m->length = 0;
    m->grain = 1;
    for (int k = 0; k < LENGTHS * GRAINS; k++) {
        const double length = longest / (1 << k / GRAINS), grain = grains[k % GRAINS];
        const double found = likelihood(&variance, p, &s, length, grain, matrix, vector);
        if (!(found > best)) continue;
        best = found;
        deviation = sqrt(variance);
        m->length = length;
        m->grain = grain;
    }
    m->deviation = deviation;
}

void fit_texture_estimate(struct problem *p)
{
    for (int m = 0; m < p->f->material_count; m++) estimate_material(p, m, p->factor, p->vector);
}

/* --------------------------------------------------------------------------------------------------- the covariance */

static double own_variance(const struct light_fit *f, int i)
{
    const double deviation = f->materials[f->points[i].material].deviation;
    return deviation * deviation + f->points[i].sigma * f->points[i].sigma + 1e-8;
}

enum status fit_texture_set_covariance(struct problem *p, struct err *err)
{
    const struct light_fit *f = p->f;
    const int n = f->point_count;
    for (int i = 0; i < n; i++) {
        const struct fit_material *m = &f->materials[f->points[i].material];
        const double variance = m->deviation * m->deviation;
        double *row = p->factor + (ptrdiff_t)i * n;
        for (int k = 0; k < i; k++)
            row[k] = f->points[k].material == f->points[i].material
                         ? variance * correlation(f, i, k, m->length, m->grain)
                         : 0;
        row[i] = own_variance(f, i) + p->excess[i];
    }
    if (!cholesky_factor(p->factor, n))
        return err_set(err, ST_DATA, "%s: the covariance of the marked points is not positive; mark fewer points.",
                       f->points[0].place);
    for (int m = 0; m < f->material_count; m++) {
        double *ones = p->ones + (ptrdiff_t)m * n;
        for (int i = 0; i < n; i++) ones[i] = f->points[i].material == m;
        cholesky_forward(p->factor, n, ones);
    }
    return ST_OK;
}

void fit_texture_set_excess(struct problem *p)
{
    const int n = p->f->point_count;
    double *solved = p->vector;
    fit_set_residuals(p);
    for (int c = 0; c < 3; c++) cholesky_backward(p->factor, n, p->whitened + (ptrdiff_t)c * n);
    for (int i = 0; i < n; i++) {
        double inverse = 0, squares = 0;
        for (int k = 0; k < n; k++) solved[k] = k == i;
        cholesky_forward(p->factor, n, solved);
        for (int k = i; k < n; k++) inverse += solved[k] * solved[k];
        for (int c = 0; c < 3; c++) {
            const double error = p->whitened[(ptrdiff_t)c * n + i] / inverse;
            squares += error * error / 3;
        }
        /* the variance of the prediction and of the point, without its excess */
        p->next_excess[i] = fmax(squares / (OUTLIER * OUTLIER) - (1 / inverse - p->excess[i]), 0);
    }
    memcpy(p->excess, p->next_excess, (size_t)n * sizeof *p->excess);
}
