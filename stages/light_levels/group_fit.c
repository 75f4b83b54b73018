/* group_fit.c - see group_fit.h.
 *
 * Mathematics. Factors x minimise the sum over measurements of ((A x + other - lux) / sigma)^2 plus the sum over groups
 * of ((x - 1) / spread)^2, with x of 0 or more: least squares with a prior, so that groups which no measurement tells
 * apart share what there is to explain. sigma is the relative error of what the factors of the round before give:
 * errors relative to the measured values would favour the low ones. With the normal matrix Q and the vector c this is a
 * convex quadratic function, and rounds over single factors, x_i = max(0, (c_i - sum of the others) / Q_ii), end at its
 * minimum. The intervals are those of the Gaussian with the inverse of Q for factors above 0, cut at 0; a factor of 0
 * has the upper end of a Gaussian with the other factors held.
 *
 * Photos. With S = sum(light x), W = sum(weights light x) and the quotient q of a patch, f = ln q + ln S - ln W - ln k
 * is 0 where k is the photo's exposure. That does not change if all factors grow alike, so photos say how groups
 * compare; all light together stays as it is, unless somebody measured. f is made linear in x at the factors of the
 * round before, whose gradient is light / S - weights light / W; k is eliminated by taking the weighted mean off f and
 * off the gradients, but for what is known of it: with a prior of the weight u the means count with their own weight U
 * as U u / (U + u). The weights of patches are robust, 1 / (1 + (f / 2 sigma)^2), because furniture moves and small
 * shadows are missed. Patches beside each other err together, so that all of a photo count as INDEPENDENT. Patches that
 * are dark in the state say nothing: their light is noise and reflections. Steps are halved, since the linear model
 * holds near by. */
#include "stages/light_levels/group_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"
#include "common/math/weighted.h"

enum { WEIGHINGS = 6, STEPS = 60, ROUNDS = 10000, INDEPENDENT = 10 };
static const double SETTLED = 1e-9, NORMAL_95 = 1.959964, MATTERS = 0.1, LEAST = 0.1;
static const double DIM = 0.02;                   /* of all light: with less, a patch is dark */
static const double ROBUST = 2;                   /* of the error: a patch with half of the weight */
static const double TOGETHER = 0.1;               /* error of the sum of all light, which textures show */
static const double SHOWS = 0.02, EXPOSED = 0.05; /* a change that a photo shows; error of a known exposure */

struct fit {
    double *q, *c, *x, *inner; /* inner: the factors above 0, twice */
    int n;
};

static double expected(const struct fit *f, const struct group_measurement *m)
{
    double sum = m->other;
    for (int i = 0; i < f->n; i++) sum += m->light[i] * f->x[i];
    return sum;
}

/* The standard error of a measurement, in lx. */
static double error_of(const struct fit *f, const struct group_measurement *m)
{
    return m->error * fmax(expected(f, m), LEAST * m->lux);
}

static void add_measurement(const struct fit *f, const struct group_measurement *m, double sigma)
{
    const double weight = 1 / (sigma * sigma);
    for (int i = 0; i < f->n; i++) {
        f->c[i] += weight * m->light[i] * (m->lux - m->other);
        for (int k = 0; k < f->n; k++) f->q[i * f->n + k] += weight * m->light[i] * m->light[k];
    }
}

static void solve(const struct fit *f)
{
    double change = 1;
    for (int round = 0; round < ROUNDS && change > SETTLED; round++) {
        change = 0;
        for (int i = 0; i < f->n; i++) {
            double rest = f->c[i];
            for (int k = 0; k < f->n; k++)
                if (k != i) rest -= f->q[i * f->n + k] * f->x[k];
            const double now = fmax(0, rest / f->q[i * f->n + i]);
            change = fmax(change, fabs(now - f->x[i]));
            f->x[i] = now;
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- photos */

struct photo_fit {
    struct group_photo *list;
    int count;
    double error;
    double *mean;          /* of gradients, of each group */
    struct weighted *room; /* as long as the longest list of patches */
};

/* ln q + ln S - ln W of a patch; *all, *lit: S and W. False: the patch is dark. */
static bool patch_residual(double *residual, double *all, double *lit, const struct fit *f,
                           const struct group_quotient *q)
{
    *all = *lit = 0;
    for (int i = 0; i < f->n; i++) {
        *all += q->light[i] * f->x[i];
        *lit += q->weights[i] * q->light[i] * f->x[i];
    }
    if (!(*all > 0 && *lit > DIM * *all && q->quotient > 0)) return false;
    *residual = log(q->quotient * *all / *lit);
    return true;
}

static double gradient(const struct group_quotient *q, int i, double all, double lit)
{
    return q->light[i] / all - q->weights[i] * q->light[i] / lit;
}

static double robust_weight(const struct photo_fit *p, double off)
{
    const double part = off / (ROBUST * p->error);
    return 1 / (1 + part * part);
}

/* Sets the exposure and the misfit of a photo from the factors so far, and p->mean; returns the sum of weights, and
 * the number of patches that are lit. */
static double find_exposure(const struct fit *f, const struct photo_fit *p, struct group_photo *photo, int *lit_count)
{
    double residual, all, lit, sum = 0, weights = 0;
    int n = 0;
    for (int j = 0; j < photo->count; j++)
        if (patch_residual(&residual, &all, &lit, f, &photo->patches[j])) p->room[n++] = (struct weighted){residual, 1};
    *lit_count = n;
    if (!n) return 0;
    const double median = weighted_percentile(p->room, (size_t)n, 0.5);
    for (int i = 0; i < f->n; i++) p->mean[i] = 0;
    for (int j = 0; j < photo->count; j++) {
        if (!patch_residual(&residual, &all, &lit, f, &photo->patches[j])) continue;
        const double weight = robust_weight(p, residual - median);
        sum += weight * residual;
        weights += weight;
        for (int i = 0; i < f->n; i++) p->mean[i] += weight * gradient(&photo->patches[j], i, all, lit);
    }
    for (int i = 0; i < f->n; i++) p->mean[i] /= weights;
    n = 0;
    for (int j = 0; j < photo->count; j++)
        if (patch_residual(&residual, &all, &lit, f, &photo->patches[j]))
            p->room[n++] = (struct weighted){fabs(residual - sum / weights), 1};
    photo->misfit = exp(weighted_percentile(p->room, (size_t)n, 0.5)) - 1;
    photo->exposure = exp(sum / weights);
    return weights;
}

/* What a known exposure says. off: the logarithm of the exposure that was found over it. */
static void add_exposure(const struct fit *f, const struct photo_fit *p, double off, double weights)
{
    const double prior = 1 / (EXPOSED * EXPOSED), weight = weights * prior / (weights + prior);
    for (int i = 0; i < f->n; i++) {
        f->c[i] -= weight * p->mean[i] * off;
        for (int k = 0; k < f->n; k++) {
            f->q[i * f->n + k] += weight * p->mean[i] * p->mean[k];
            f->c[i] += weight * p->mean[i] * p->mean[k] * f->x[k];
        }
    }
}

static void add_photo(const struct fit *f, const struct photo_fit *p, struct group_photo *photo)
{
    int count;
    const double weights = find_exposure(f, p, photo, &count), gain = log(photo->exposure);
    double residual, all, lit, *own = p->mean + f->n;
    if (!(weights > 0)) return;
    const double each = fmin(1, INDEPENDENT / weights) / (p->error * p->error);
    if (photo->known > 0) add_exposure(f, p, gain - log(photo->known), each * weights);
    for (int j = 0; j < photo->count; j++) {
        if (!patch_residual(&residual, &all, &lit, f, &photo->patches[j])) continue;
        const double off = residual - gain, weight = each * robust_weight(p, off);
        for (int i = 0; i < f->n; i++) own[i] = gradient(&photo->patches[j], i, all, lit) - p->mean[i];
        for (int i = 0; i < f->n; i++) {
            double at = -off;
            for (int k = 0; k < f->n; k++) {
                at += own[k] * f->x[k];
                f->q[i * f->n + k] += weight * own[i] * own[k];
            }
            f->c[i] += weight * own[i] * at;
        }
    }
}

/* Where nobody measured, all light together stays as the model found it where photos look. */
static void keep_sum(const struct fit *f, const struct photo_fit *p)
{
    const double weight = 1 / (TOGETHER * TOGETHER);
    double all = 0;
    for (int i = 0; i < f->n; i++) p->mean[i] = 0;
    for (int k = 0; k < p->count; k++)
        for (int j = 0; j < p->list[k].count; j++)
            for (int i = 0; i < f->n; i++) p->mean[i] += p->list[k].patches[j].light[i];
    for (int i = 0; i < f->n; i++) all += p->mean[i];
    for (int i = 0; all > 0 && i < f->n; i++) {
        f->c[i] += weight * p->mean[i] / all;
        for (int k = 0; k < f->n; k++) f->q[i * f->n + k] += weight * p->mean[i] / all * p->mean[k] / all;
    }
}

/* A photo counts for a factor if it shows a change of it, of 1 % for one of 50 %, in the mean of patches. */
static void count_photos(struct group_factor *factors, const struct fit *f, const struct photo_fit *p)
{
    for (int k = 0; k < p->count; k++) {
        int count;
        if (!(find_exposure(f, p, &p->list[k], &count) > 0)) continue;
        for (int i = 0; i < f->n; i++) {
            double sum = 0, residual, all, lit;
            for (int j = 0; j < p->list[k].count; j++)
                if (patch_residual(&residual, &all, &lit, f, &p->list[k].patches[j]))
                    sum += fabs(gradient(&p->list[k].patches[j], i, all, lit) - p->mean[i]) * f->x[i];
            factors[i].measurements += sum >= SHOWS * count;
        }
    }
}

static enum status start_photos(struct photo_fit *p, int groups, struct err *err)
{
    int most = 0;
    for (int k = 0; k < p->count; k++) most = p->list[k].count > most ? p->list[k].count : most;
    p->mean = calloc(2 * (size_t)groups + 1, sizeof *p->mean);
    p->room = calloc((size_t)most + 1, sizeof *p->room);
    return p->mean && p->room ? ST_OK : err_nomem(err, "patches of photos", (size_t)most * sizeof *p->room);
}

/* Solves with the errors of the factors so far. */
static void weigh(const struct fit *f, const struct group_measurement *m, int count, const struct photo_fit *p,
                  double spread)
{
    memset(f->q, 0, (size_t)f->n * (size_t)f->n * sizeof *f->q);
    for (int i = 0; i < f->n; i++) f->c[i] = f->q[i * f->n + i] = 1 / (spread * spread);
    for (int k = 0; k < count; k++) add_measurement(f, &m[k], error_of(f, &m[k]));
    for (int k = 0; k < p->count; k++) add_photo(f, p, &p->list[k]);
    if (!count && p->count) keep_sum(f, p);
    solve(f);
}

/* Half of a step, and the factors that it began at. */
static void step(const struct fit *f, const struct group_measurement *m, int count, const struct photo_fit *p,
                 double spread, double *was)
{
    memcpy(was, f->x, (size_t)f->n * sizeof *was);
    weigh(f, m, count, p, spread);
    for (int i = 0; i < f->n; i++) f->x[i] = 0.5 * (f->x[i] + was[i]);
}

/* The variance of factor i: element i of the inverse of Q's part of factors above 0. */
static double variance_of(const struct fit *f, int which)
{
    const int n = f->n;
    double *l = f->inner, *b = f->inner + n * n;
    int count = 0, at = 0;
    for (int i = 0; i < n; i++) {
        if (!(f->x[i] > 0)) continue;
        if (i == which) at = count;
        int column = 0;
        for (int k = 0; k < n; k++)
            if (f->x[k] > 0) b[column++] = f->q[i * n + k];
        for (int k = 0; k < column; k++) l[count * n + k] = b[k];
        count++;
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < count; k++) l[i * count + k] = l[i * n + k];
    for (int i = 0; i < count; i++) b[i] = i == at;
    if (!cholesky_factor(l, count)) return 1 / f->q[which * n + which];
    cholesky_forward(l, count, b);
    cholesky_backward(l, count, b);
    return b[at];
}

static void set_factors(struct group_factor *factors, const struct fit *f, const struct group_measurement *m, int count)
{
    for (int i = 0; i < f->n; i++) {
        const double variance = f->x[i] > 0 ? variance_of(f, i) : 1 / f->q[i * f->n + i];
        const double away = NORMAL_95 * sqrt(variance);
        factors[i] = (struct group_factor){f->x[i], fmax(0, f->x[i] - away), f->x[i] + away, 0};
        for (int k = 0; k < count; k++) factors[i].measurements += m[k].light[i] * f->x[i] >= MATTERS * m[k].lux;
    }
}

enum status group_fit_photos(struct group_factor *factors, int groups, struct group_measurement *m, int count,
                             struct group_photo *photos, int photo_count, double error, double spread, struct err *err)
{
    const size_t n = (size_t)groups;
    struct fit f = {calloc(n * n + 1, sizeof(double)), calloc(n + 1, sizeof(double)), calloc(n + 1, sizeof(double)),
                    calloc(n * n + n + 1, sizeof(double)), groups};
    struct photo_fit p = {.list = photos, .count = photo_count, .error = error};
    if (!f.q || !f.c || !f.x || !f.inner) {
        err_nomem(err, "groups of light", n * n * sizeof *f.q);
    } else if (!start_photos(&p, groups, err)) {
        for (int i = 0; i < groups; i++) f.x[i] = 1;
        for (int round = 0; photo_count && round < STEPS; round++) step(&f, m, count, &p, spread, f.inner);
        for (int round = 0; !photo_count && round < WEIGHINGS; round++) weigh(&f, m, count, &p, spread);
        set_factors(factors, &f, m, count);
        count_photos(factors, &f, &p);
        for (int k = 0; k < count; k++) m[k].deviation = (m[k].lux - expected(&f, &m[k])) / error_of(&f, &m[k]);
    }
    free(p.mean);
    free(p.room);
    free(f.q);
    free(f.c);
    free(f.x);
    free(f.inner);
    return err->status;
}

enum status group_fit(struct group_factor *factors, int groups, struct group_measurement *m, int count, double spread,
                      struct err *err)
{
    return group_fit_photos(factors, groups, m, count, NULL, 0, 1, spread, err);
}
