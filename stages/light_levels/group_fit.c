/* group_fit.c - see group_fit.h.
 *
 * Mathematics. Factors x minimise the sum over measurements of ((A x + other - lux) / sigma)^2 plus the sum over groups
 * of ((x - 1) / spread)^2, with x of 0 or more: least squares with a prior, so that groups which no measurement tells
 * apart share what there is to explain. sigma is the relative error of what the factors of the round before give:
 * errors relative to the measured values would favour the low ones. With the normal matrix Q and the vector c this is a
 * convex quadratic function, and rounds over single factors, x_i = max(0, (c_i - sum of the others) / Q_ii), end at its
 * minimum. The intervals are those of the Gaussian with the inverse of Q for factors above 0, cut at 0; a factor of 0
 * has the upper end of a Gaussian with the other factors held. */
#include "stages/light_levels/group_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"

enum { WEIGHINGS = 6, ROUNDS = 10000 };
static const double SETTLED = 1e-9, NORMAL_95 = 1.959964, MATTERS = 0.1, LEAST = 0.1;

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

/* Solves with the errors of the factors so far. */
static void weigh(const struct fit *f, const struct group_measurement *m, int count, double spread)
{
    memset(f->q, 0, (size_t)f->n * (size_t)f->n * sizeof *f->q);
    for (int i = 0; i < f->n; i++) f->c[i] = f->q[i * f->n + i] = 1 / (spread * spread);
    for (int k = 0; k < count; k++) add_measurement(f, &m[k], error_of(f, &m[k]));
    solve(f);
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

enum status group_fit(struct group_factor *factors, int groups, struct group_measurement *m, int count, double spread,
                      struct err *err)
{
    const size_t n = (size_t)groups;
    struct fit f = {calloc(n * n + 1, sizeof(double)), calloc(n + 1, sizeof(double)), calloc(n + 1, sizeof(double)),
                    calloc(n * n + n + 1, sizeof(double)), groups};
    if (!f.q || !f.c || !f.x || !f.inner) {
        err_nomem(err, "groups of light", n * n * sizeof *f.q);
    } else {
        for (int i = 0; i < groups; i++) f.x[i] = 1;
        for (int round = 0; round < WEIGHINGS; round++) weigh(&f, m, count, spread);
        set_factors(factors, &f, m, count);
        for (int k = 0; k < count; k++) m[k].deviation = (m[k].lux - expected(&f, &m[k])) / error_of(&f, &m[k]);
    }
    free(f.q);
    free(f.c);
    free(f.x);
    free(f.inner);
    return err->status;
}
