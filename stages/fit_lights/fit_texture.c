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
 * The mean of a material is one more normal deviation, that of usual albedos (fit_problem.h), which all its points
 * share. The points of a mark share another one, its offset: a mark may be on another material, in shade or in the sun.
 * Offsets have Student's t distribution, that is, a normal one whose variance is unknown; the variance is renewed from
 * the offset that the fit finds [Lange 1989]. So a mark that the others do not predict counts less, the farther off it
 * is, but the differences between its own points still count.
 *
 * The error of the indirect irradiance is much the same along a wall, and another one on the next. So the points of a
 * wall share a deviation, too. Differences within one wall tell of a lamp; differences between two walls hardly do.
 *
 * A single point that the others do not predict (the frame of a picture) has its variance enlarged, so that its error,
 * which the inverse of the covariance gives, is OUTLIER standard deviations. */
#include "stages/fit_lights/fit_texture.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"

enum { MIN_POINTS = 8 };
static const double grains[TEXTURE_GRAINS] = {0.02, 0.1, 0.3, 0.6};
#define OUTLIER 2.5
#define ACROSS  3.0

static double distance(const struct light_fit *f, int a, int b)
{
    return vec3_length(vec3_sub(f->points[a].at, f->points[b].at));
}

struct texture_kind fit_texture_kind(int k, double longest)
{
    if (k >= TEXTURE_KINDS - 1) return (struct texture_kind){0, 1};
    return (struct texture_kind){longest / (1 << k / TEXTURE_GRAINS), grains[k % TEXTURE_GRAINS]};
}

double fit_texture_correlation(const struct light_fit *f, int a, int b, struct texture_kind kind)
{
    return (1 - kind.grain) * (kind.length > 0 ? exp(-distance(f, a, b) / kind.length) : 0);
}

/* ---------------------------------------------------------------------------------------------------- the variation */

/* Evenly chosen, those across an edge ACROSS times as densely: they tell a lamp's light from the texture. */
struct texture_sample fit_texture_sample(const struct light_fit *f, int material)
{
    struct texture_sample s = {.count = 0};
    double all = 0, at = 0;
    for (int i = 0; i < f->point_count; i++)
        if (f->points[i].material == material) all += f->points[i].kind == POINT_ACROSS ? ACROSS : 1;
    for (int i = 0; i < f->point_count; i++) {
        if (f->points[i].material != material) continue;
        const double before = at;
        at += f->points[i].kind == POINT_ACROSS ? ACROSS : 1;
        const bool next = floor(at * MAX_SAMPLED / all) > floor(before * MAX_SAMPLED / all);
        if (s.count < MAX_SAMPLED && next) s.points[s.count++] = i;
    }
    for (int i = 0; i < s.count; i++) s.longest = fmax(s.longest, distance(f, s.points[0], s.points[i]));
    return s;
}

/* The number of lamps that are fitted to a material's points. */
static int lamps_of(const struct light_fit *f, int material)
{
    int count = 0;
    for (int l = 0; l < f->lamp_count; l++) {
        bool found = false;
        for (int i = 0; i < f->point_count; i++) found |= f->points[i].material == material && f->points[i].lamp == l;
        count += f->lamps[l].fit && found;
    }
    return count;
}

/* The restricted likelihood's logarithm; sets *variance. matrix and vector: room for the points. */
static double likelihood(double *variance, const struct problem *p, const struct texture_sample *s, int lamps,
                         struct texture_kind kind, double *matrix, double *vector)
{
    const int n = s->count, dof = n - 1 - lamps;
    const double before = p->f->materials[p->f->points[s->points[0]].material].deviation;
    double ones[MAX_SAMPLED], determinant = 0, weights = 0, squares = 0;
    for (int i = 0; i < n; i++) {
        const int mark = p->f->points[s->points[i]].mark;
        const int wall = p->f->points[s->points[i]].wall;
        const double shared = p->f->marks[mark].variance / (before * before);
        const double of_wall = p->f->wall_variance / (before * before);
        for (int k = 0; k < i; k++)
            matrix[i * n + k] = fit_texture_correlation(p->f, s->points[i], s->points[k], kind) +
                                (p->f->points[s->points[k]].mark == mark ? shared : 0) +
                                (p->f->points[s->points[k]].wall == wall ? of_wall : 0);
        matrix[i * n + i] = 1 + shared + of_wall + p->excess[s->points[i]] / (before * before);
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
    const double prior = TEXTURE_PRIOR * p->f->texture * p->f->texture;
    *variance = (squares + prior) / (dof + TEXTURE_PRIOR) + 1e-12;
    return -0.5 * ((dof + TEXTURE_PRIOR) * log(*variance) + determinant + log(weights));
}

static void estimate_material(struct problem *p, int material, double *matrix, double *vector)
{
    const struct texture_sample s = fit_texture_sample(p->f, material);
    struct fit_material *m = &p->f->materials[material];
    const int lamps = lamps_of(p->f, material);
    double best = -INFINITY, variance = 0, deviation = m->deviation;
    if (s.count < MIN_POINTS || s.count <= 1 + lamps) return;
    for (int k = TEXTURE_KINDS - 1; k >= 0; k--) {
        const struct texture_kind kind = fit_texture_kind(k, s.longest);
        const double found = likelihood(&variance, p, &s, lamps, kind, matrix, vector);
        if (!(found > best)) continue;
        best = found;
        deviation = sqrt(variance);
        m->length = kind.length;
        m->grain = kind.grain;
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
        const struct texture_kind kind = {m->length, m->grain};
        const double variance = m->deviation * m->deviation, shared = f->marks[f->points[i].mark].variance;
        double *row = p->factor + (ptrdiff_t)i * n;
        for (int k = 0; k < i; k++)
            row[k] = f->points[k].material != f->points[i].material
                         ? 0
                         : ALBEDO_DEVIATION * ALBEDO_DEVIATION + variance * fit_texture_correlation(f, i, k, kind) +
                               (f->points[k].mark == f->points[i].mark ? shared : 0) +
                               (f->points[k].wall == f->points[i].wall ? f->wall_variance : 0);
        row[i] = ALBEDO_DEVIATION * ALBEDO_DEVIATION + own_variance(f, i) + shared + f->wall_variance + p->excess[i];
    }
    if (!cholesky_factor(p->factor, n))
        return err_set(err, ST_DATA,
                       "the covariance of the %d marked points of lamps is not positive; mark fewer points.", n);
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
        cholesky_forward_from(p->factor, n, i, solved);
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

void fit_texture_set_marks(struct problem *p)
{
    const struct light_fit *f = p->f;
    const int n = f->point_count;
    const double scale = MARK_SCALE * MARK_SCALE * f->texture * f->texture;
    fit_set_residuals(p);
    for (int c = 0; c < 3; c++) cholesky_backward(p->factor, n, p->whitened + (ptrdiff_t)c * n);
    for (int m = 0; m < f->mark_count; m++) {
        struct fit_mark *mark = &f->marks[m];
        double squares = 0, weights = 0;
        int points = 0;
        for (int i = 0; i < n; i++) {
            p->vector[i] = f->points[i].mark == m;
            points += f->points[i].mark == m;
        }
        if (!points) continue;
        cholesky_forward(p->factor, n, p->vector);
        for (int i = 0; i < n; i++) weights += p->vector[i] * p->vector[i];
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int i = 0; i < n; i++)
                if (f->points[i].mark == m) sum += p->whitened[(ptrdiff_t)c * n + i];
            squares += mark->variance * sum * mark->variance * sum / 3;
        }
        const double left = mark->variance - mark->variance * mark->variance * weights; /* unknown of the offset */
        p->next_excess[m] = (MARK_FREEDOM * scale + squares + fmax(left, 0)) / (MARK_FREEDOM + 1);
    }
    for (int m = 0; m < f->mark_count; m++) f->marks[m].variance = p->next_excess[m];
}
