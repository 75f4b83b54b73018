/* material_fit.c - the parameters of a reflectance model by robust least squares.
 *
 * A sample's radiance is L_c = k_d,c E_c + g I_c(s), with the irradiance E and the lobe's integral I of
 * material_samples.c; five unknowns [Colburn 2014, 5.4]: k_d of red, green and blue, the lobe's reflectance g (from
 * which k_s follows) and ln s, its width. Only s is nonlinear. The minimum in s may not be the only one: a wide lobe
 * can explain the slope of the light, a narrow one a few highlights.
 *
 *   1. For each of STARTS widths, the other four unknowns by linear least squares, reweighted for outliers (variable
 *      projection [Golub 1973]); the three best starts are kept.
 *   2. From each of them Levenberg-Marquardt (Ceres) in all five, with k_d, g >= 0 and s in its range; the smallest
 *      cost wins.
 *   3. The scale of the residuals, from their median, may have changed: once more from the solution.
 *
 * The loss of a sample is Cauchy's, of all channels together. Variances are at least (1e-4 of the brightest
 * radiance)^2. Where the residuals are larger than the variances say (texture, an imprecise model of the light), their
 * scale takes part in the loss and in the intervals.
 *
 * Intervals are 1.96 standard deviations by the inverse of the weighted normal matrix, or by the sum over points of the
 * outer products of their gradients, whichever is larger: samples of one point share its texture. The matrix has the
 * mean curvature of the loss [Huber 1964]. Intervals end at the bounds, and hold what the noise of the radiance does:
 * not an error of the light.
 * An unknown without curvature (the width of a lobe with g = 0) has the interval of its bounds. */
#include "stages/fit_materials/material_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/math/ceres_curve_fit.h"
#include "common/math/numbers.h"

enum { STARTS = 14, KEPT_STARTS = 3, REWEIGHTINGS = 5, ITERATIONS = 100 };
#define MEDIAN_CHI2_3 2.366 /* median of the sum of squares of three standard normal numbers */
#define MIN_DEVIATION 1e-4  /* of the brightest radiance */
#define MIN_PIVOT     1e-9  /* of a normal matrix with unit diagonal */
#define NORMAL_95     1.96

struct fit_problem {
    const struct material_samples *s;
    enum brdf_kind kind;
    int rows;
    double *weight; /* [rows] 1 / standard deviation, 0 for samples that are left out */
    double *lobe;   /* [2 rows] and its slope */
    double *predicted, *jacobian, *squares, *sorted;
};

int fit_unknowns(enum brdf_kind kind) { return kind == BRDF_LAMBERT ? FIT_GLOSS : FIT_UNKNOWNS; }

static void bounds(enum brdf_kind kind, double lower[FIT_UNKNOWNS], double upper[FIT_UNKNOWNS])
{
    for (int k = 0; k < FIT_UNKNOWNS; k++) lower[k] = 0, upper[k] = INFINITY;
    lower[FIT_LOG_S] = material_lobe_log_s(kind, kind == BRDF_WARD ? WARD_MAX : PHONG_MIN);
    upper[FIT_LOG_S] = material_lobe_log_s(kind, kind == BRDF_WARD ? WARD_MIN : PHONG_MAX);
}

/* ------------------------------------------------------------------------------------------------------ the problem */

static void problem_release(struct fit_problem *p)
{
    free(p->weight);
    free(p->lobe);
    free(p->predicted);
    free(p->jacobian);
    free(p->squares);
    free(p->sorted);
}

static enum status allocate(struct fit_problem *p, const struct material_samples *s, enum brdf_kind kind,
                            struct err *err)
{
    const size_t rows = 3 * (size_t)s->count + 3;
    *p = (struct fit_problem){.s = s, .kind = kind, .rows = 3 * s->count};
    p->weight = calloc(rows, sizeof *p->weight);
    p->lobe = calloc(2 * rows, sizeof *p->lobe);
    p->predicted = calloc(rows, sizeof *p->predicted);
    p->jacobian = calloc(rows * FIT_UNKNOWNS, sizeof *p->jacobian);
    p->squares = calloc(rows, sizeof *p->squares);
    p->sorted = calloc(rows, sizeof *p->sorted);
    if (p->weight && p->lobe && p->predicted && p->jacobian && p->squares && p->sorted) return ST_OK;
    problem_release(p);
    return err_nomem(err, "the fit of a material", rows * (FIT_UNKNOWNS + 6) * sizeof(double));
}

/* Weights, and whether there is anything to fit. */
static enum status weigh(struct fit_problem *p, const bool *used, struct err *err)
{
    const struct material_samples *s = p->s;
    double brightest = 0, light = 0;
    int count = 0;
    for (int i = 0; i < s->count; i++)
        for (int c = 0; (!used || used[i]) && c < 3; c++) {
            brightest = fmax(brightest, s->radiance[3 * i + c]);
            light = fmax(light, s->irradiance[3 * i + c]);
            count += c == 0;
        }
    if (!count) return err_set(err, ST_DATA, "there are no samples.");
    if (!(light > 0))
        return err_set(err, ST_DATA,
                       "no light arrives at any of the %d samples, so that nothing is known of how they reflect it.",
                       count);
    const double least = brightest > 0 ? MIN_DEVIATION * brightest : MIN_DEVIATION * light;
    for (int i = 0; i < s->count; i++)
        for (int c = 0; c < 3; c++)
            p->weight[3 * i + c] = !used || used[i] ? 1 / sqrt(fmax(s->variance[3 * i + c], least * least)) : 0;
    return ST_OK;
}

static enum status problem_init(struct fit_problem *p, const struct material_samples *s, enum brdf_kind kind,
                                const bool *used, struct err *err)
{
    if (allocate(p, s, kind, err)) return err->status;
    if (!weigh(p, used, err)) return ST_OK;
    problem_release(p);
    return err->status;
}

void fit_predict(const struct material_samples *s, enum brdf_kind kind, const double *x, double *scratch,
                 double *predicted, double *jacobian)
{
    const int n = fit_unknowns(kind), rows = 3 * s->count;
    const bool glossy = kind != BRDF_LAMBERT;
    const double *lobe = scratch, *slope = scratch + rows;
    if (glossy) material_lobe_integrals(s, kind, x[FIT_LOG_S], scratch, jacobian ? scratch + rows : NULL);
    for (int r = 0; r < rows; r++) predicted[r] = x[r % 3] * s->irradiance[r] + (glossy ? x[FIT_GLOSS] * lobe[r] : 0);
    if (!jacobian) return;
    memset(jacobian, 0, (size_t)rows * (size_t)n * sizeof *jacobian);
    for (int r = 0; r < rows; r++) {
        double *j = jacobian + (size_t)r * (size_t)n;
        j[r % 3] = s->irradiance[r];
        if (!glossy) continue;
        j[FIT_GLOSS] = lobe[r];
        j[FIT_LOG_S] = x[FIT_GLOSS] * slope[r];
    }
}

/* Squared residuals of each sample, in units of its variance; 0 for samples that are left out. */
static void square_residuals(struct fit_problem *p)
{
    for (int i = 0; i < p->s->count; i++) {
        p->squares[i] = 0;
        for (int r = 3 * i; r < 3 * i + 3; r++) {
            const double off = (p->predicted[r] - p->s->radiance[r]) * p->weight[r];
            p->squares[i] += off * off;
        }
    }
}

/* How many standard deviations the residuals are: by their median over the samples in use; at least 1. */
static double residual_scale(struct fit_problem *p)
{
    size_t count = 0;
    for (int i = 0; i < p->s->count; i++)
        if (p->weight[3 * i] > 0) p->sorted[count++] = p->squares[i];
    sort_doubles(p->sorted, count);
    return count ? fmax(1, sqrt(p->sorted[count / 2] / MEDIAN_CHI2_3)) : 1;
}

static double robust_weight(double square, double scale)
{
    return 1 / (1 + square / (scale * scale * FIT_CAUCHY * FIT_CAUCHY));
}

static double robust_loss(double square, double scale)
{
    return FIT_CAUCHY * FIT_CAUCHY * log1p(square / (scale * scale * FIT_CAUCHY * FIT_CAUCHY));
}

/* ------------------------------------------------------------------------------------------------------- the starts */

/* Sums of weighted products of irradiance E, lobe I and radiance L, per channel. */
struct sums {
    double ee[3], ei[3], el[3], ii, il;
};

/* g without the channels whose k_d is held at 0. */
static double eliminated_gloss(const struct sums *m, const bool held[3])
{
    double above = m->il, below = m->ii;
    for (int c = 0; c < 3; c++)
        if (!held[c] && m->ee[c] > 0) {
            above -= m->ei[c] * m->el[c] / m->ee[c];
            below -= m->ei[c] * m->ei[c] / m->ee[c];
        }
    return below > MIN_PIVOT * m->ii ? fmax(0, above / below) : 0;
}

/* k_d and g by weighted linear least squares for the lobe in p->lobe; none is negative. */
static void linear_step(const struct fit_problem *p, const double *robust, double x[FIT_UNKNOWNS])
{
    struct sums m = {0};
    for (int r = 0; r < p->rows; r++) {
        const int c = r % 3;
        const double w = p->weight[r] * p->weight[r] * robust[r / 3], e = p->s->irradiance[r], l = p->s->radiance[r];
        const double lobe = p->kind == BRDF_LAMBERT ? 0 : p->lobe[r];
        m.ee[c] += w * e * e;
        m.ei[c] += w * e * lobe;
        m.el[c] += w * e * l;
        m.ii += w * lobe * lobe;
        m.il += w * lobe * l;
    }
    bool held[3] = {false, false, false};
    for (int pass = 0; pass < 2; pass++) {
        x[FIT_GLOSS] = eliminated_gloss(&m, held);
        for (int c = 0; c < 3; c++) {
            const double k = m.ee[c] > 0 ? (m.el[c] - x[FIT_GLOSS] * m.ei[c]) / m.ee[c] : 0;
            held[c] |= !(k > 0);
            x[c] = held[c] ? 0 : k;
        }
    }
}

/* The linear unknowns at x[FIT_LOG_S], reweighted; p->squares are its residuals. Returns their scale. */
static double start_at(struct fit_problem *p, double x[FIT_UNKNOWNS])
{
    double scale = 1;
    double *robust = p->jacobian; /* not in use yet */
    for (int i = 0; i < p->s->count; i++) robust[i] = 1;
    if (p->kind != BRDF_LAMBERT) material_lobe_integrals(p->s, p->kind, x[FIT_LOG_S], p->lobe, NULL);
    for (int round = 0; round < REWEIGHTINGS; round++) {
        linear_step(p, robust, x);
        for (int r = 0; r < p->rows; r++)
            p->predicted[r] =
                x[r % 3] * p->s->irradiance[r] + (p->kind == BRDF_LAMBERT ? 0 : x[FIT_GLOSS] * p->lobe[r]);
        square_residuals(p);
        scale = residual_scale(p);
        for (int i = 0; i < p->s->count; i++) robust[i] = robust_weight(p->squares[i], scale);
    }
    return scale;
}

static double total_loss(const struct fit_problem *p, const double *squares, double scale)
{
    double sum = 0;
    for (int i = 0; i < p->s->count; i++)
        if (p->weight[3 * i] > 0) sum += robust_loss(squares[i], scale);
    return sum;
}

/* Fills starts with the best ones, the best first, and returns their number. */
static int find_starts(struct fit_problem *p, double starts[KEPT_STARTS][FIT_UNKNOWNS], double *scale)
{
    const int count = p->kind == BRDF_LAMBERT ? 1 : STARTS;
    double tried[STARTS][FIT_UNKNOWNS] = {{0}}, loss[STARTS], lower[FIT_UNKNOWNS], upper[FIT_UNKNOWNS];
    bounds(p->kind, lower, upper);
    *scale = INFINITY;
    for (int pass = 0; pass < 2; pass++) /* the losses are compared at the smallest scale of all */
        for (int k = 0; k < count; k++) {
            tried[k][FIT_LOG_S] = lower[FIT_LOG_S] + (k + 0.5) / STARTS * (upper[FIT_LOG_S] - lower[FIT_LOG_S]);
            const double own = start_at(p, tried[k]);
            if (pass == 0) *scale = fmin(*scale, own);
            loss[k] = total_loss(p, p->squares, *scale);
        }
    int kept = 0;
    for (; kept < KEPT_STARTS && kept < count; kept++) {
        int best = -1;
        for (int k = 0; k < count; k++)
            if (loss[k] < INFINITY && (best < 0 || loss[k] < loss[best])) best = k;
        if (best < 0) break;
        memcpy(starts[kept], tried[best], sizeof starts[kept]);
        loss[best] = INFINITY;
    }
    return kept;
}

/* ---------------------------------------------------------------------------------------------------------- the fit */

struct scaled_problem {
    struct fit_problem *p;
    double scale;
};

static void evaluate(void *ctx, const double *x, double *residuals, double *jacobian)
{
    const struct scaled_problem *scaled = ctx;
    struct fit_problem *p = scaled->p;
    const int n = fit_unknowns(p->kind);
    fit_predict(p->s, p->kind, x, p->lobe, p->predicted, jacobian);
    for (int r = 0; r < p->rows; r++) {
        const double weight = p->weight[r] / scaled->scale;
        residuals[r] = (p->predicted[r] - p->s->radiance[r]) * weight;
        for (int k = 0; jacobian && k < n; k++) jacobian[(size_t)r * (size_t)n + (size_t)k] *= weight;
    }
}

static enum status solve(struct curve_fit_outcome *outcome, struct fit_problem *p, double scale, double *x,
                         struct err *err)
{
    struct scaled_problem scaled = {p, scale};
    double lower[FIT_UNKNOWNS], upper[FIT_UNKNOWNS];
    bounds(p->kind, lower, upper);
    const struct curve_fit fit = {
        fit_unknowns(p->kind), p->s->count, 3, evaluate, &scaled, lower, upper, FIT_CAUCHY, ITERATIONS};
    return ceres_curve_fit(outcome, &fit, x, err);
}

/* -------------------------------------------------------------------------------------------------------- intervals */

struct normal_matrix {
    double h[FIT_UNKNOWNS][FIT_UNKNOWNS], inverse[FIT_UNKNOWNS][FIT_UNKNOWNS];
    bool known[FIT_UNKNOWNS];
};

/* Column k of the inverse of the known part, by Cholesky factors l. */
static void solve_column(struct normal_matrix *m, double l[FIT_UNKNOWNS][FIT_UNKNOWNS], int n, int k)
{
    double y[FIT_UNKNOWNS] = {0};
    for (int i = 0; i < n; i++) {
        if (!m->known[i]) continue;
        y[i] = i == k;
        for (int j = 0; j < i; j++) y[i] -= l[i][j] * y[j];
        y[i] /= l[i][i];
    }
    for (int i = n - 1; i >= 0; i--) {
        if (!m->known[i]) continue;
        for (int j = i + 1; j < n; j++) y[i] -= l[j][i] * y[j];
        y[i] /= l[i][i];
    }
    for (int i = 0; i < n; i++) m->inverse[i][k] = y[i];
}

/* Inverts h, scaled to a unit diagonal; unknowns that the earlier ones explain are not known. */
static void invert(struct normal_matrix *m, int n)
{
    double l[FIT_UNKNOWNS][FIT_UNKNOWNS] = {{0}}, size[FIT_UNKNOWNS];
    for (int i = 0; i < n; i++) size[i] = m->h[i][i] > 0 ? 1 / sqrt(m->h[i][i]) : 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = m->h[i][j] * size[i] * size[j];
            for (int k = 0; k < j; k++) sum -= l[i][k] * l[j][k];
            if (j < i) l[i][j] = m->known[j] ? sum / l[j][j] : 0;
            if (j == i) m->known[i] = size[i] > 0 && sum > MIN_PIVOT;
            if (j == i) l[i][i] = m->known[i] ? sqrt(sum) : 1;
        }
        for (int j = 0; !m->known[i] && j < i; j++) l[i][j] = 0;
    }
    for (int k = 0; k < n; k++)
        if (m->known[k]) solve_column(m, l, n, k);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) m->inverse[i][k] *= size[i] * size[k];
}

/* to += the outer product of a point's gradient; the gradient is 0 then. */
static void add_gradient(double to[FIT_UNKNOWNS][FIT_UNKNOWNS], double gradient[FIT_UNKNOWNS])
{
    for (int a = 0; a < FIT_UNKNOWNS; a++)
        for (int b = 0; b < FIT_UNKNOWNS; b++) to[a][b] += gradient[a] * gradient[b];
    memset(gradient, 0, FIT_UNKNOWNS * sizeof *gradient);
}

/* The normal matrix, and the outer products of the gradients of points. p->jacobian and p->predicted are set. */
static void add_samples(struct normal_matrix *m, double outer[FIT_UNKNOWNS][FIT_UNKNOWNS], const struct fit_problem *p,
                        double scale)
{
    const int n = fit_unknowns(p->kind);
    double gradient[FIT_UNKNOWNS] = {0};
    for (int i = 0; i < p->s->count; i++) {
        if (i && p->s->point[i] != p->s->point[i - 1]) add_gradient(outer, gradient);
        const double robust = robust_weight(p->squares[i], scale);
        for (int r = 3 * i; r < 3 * i + 3; r++) {
            const double *j = p->jacobian + (size_t)r * (size_t)n, w = p->weight[r] / scale;
            const double off = (p->predicted[r] - p->s->radiance[r]) * w;
            for (int a = 0; a < n; a++) {
                gradient[a] += robust * w * j[a] * off;
                for (int b = 0; b < n; b++) m->h[a][b] += robust * w * w * j[a] * j[b];
            }
        }
    }
    add_gradient(outer, gradient);
}

/* The variance of a linear form of the unknowns. */
static double form_variance(const struct normal_matrix *m, double outer[FIT_UNKNOWNS][FIT_UNKNOWNS],
                            const double form[FIT_UNKNOWNS])
{
    double column[FIT_UNKNOWNS] = {0}, by_matrix = 0, by_points = 0;
    for (int a = 0; a < FIT_UNKNOWNS; a++)
        for (int b = 0; b < FIT_UNKNOWNS; b++) column[a] += m->inverse[a][b] * form[b];
    for (int a = 0; a < FIT_UNKNOWNS; a++) {
        by_matrix += form[a] * column[a];
        for (int b = 0; b < FIT_UNKNOWNS; b++) by_points += column[a] * outer[a][b] * column[b];
    }
    return fmax(0, fmax(by_matrix, by_points));
}

/* The mean curvature of the loss over its mean weight: the loss bends less than its weights say. */
static double loss_curvature(const struct fit_problem *p, double scale)
{
    double weights = 0, curvature = 0;
    for (int i = 0; i < p->s->count; i++) {
        if (!(p->weight[3 * i] > 0)) continue;
        const double w = robust_weight(p->squares[i], scale);
        weights += w;
        curvature += (2 * w + w * (2 * w - 1)) / 3; /* two directions across the residual, one along it */
    }
    return clamp(curvature / weights, 0.25, 1);
}

static struct interval about(double value, double deviation, double low, double high)
{
    const double off = NORMAL_95 * deviation;
    return (struct interval){fmax(low, value - off), fmin(high, value + off)};
}

static void set_intervals(struct material_fit *f, struct fit_problem *p)
{
    struct normal_matrix m = {0};
    double outer[FIT_UNKNOWNS][FIT_UNKNOWNS] = {{0}}, lower[FIT_UNKNOWNS], upper[FIT_UNKNOWNS];
    bounds(f->kind, lower, upper);
    fit_predict(p->s, p->kind, f->x, p->lobe, p->predicted, p->jacobian);
    square_residuals(p);
    add_samples(&m, outer, p, f->scale);
    const double curvature = loss_curvature(p, f->scale);
    for (int a = 0; a < FIT_UNKNOWNS; a++)
        for (int b = 0; b < FIT_UNKNOWNS; b++) m.h[a][b] *= curvature;
    invert(&m, fit_unknowns(f->kind));
    for (int c = 0; c < 3; c++) {
        double form[FIT_UNKNOWNS] = {0};
        form[c] = 1;
        f->k_d_range[c] = m.known[c] ? about(f->k_d[c], sqrt(form_variance(&m, outer, form)), 0, INFINITY)
                                     : (struct interval){0, INFINITY};
    }
    f->gloss_known = m.known[FIT_GLOSS];
    if (f->kind == BRDF_LAMBERT) return;
    const double to_ks = material_lobe_ks(f->kind, f->x[FIT_LOG_S]), s = exp(f->x[FIT_LOG_S]);
    /* d ks: by g, and for Phong by n, on which the scale of the lobe depends */
    const double ks_form[FIT_UNKNOWNS] = {
        [FIT_GLOSS] = to_ks, [FIT_LOG_S] = f->kind == BRDF_WARD ? 0 : f->ks * s / (s + 1)};
    const double s_form[FIT_UNKNOWNS] = {[FIT_LOG_S] = 1};
    f->ks_range = m.known[FIT_GLOSS] ? about(f->ks, sqrt(form_variance(&m, outer, ks_form)), 0, INFINITY)
                                     : (struct interval){0, INFINITY};
    struct interval log_s = {lower[FIT_LOG_S], upper[FIT_LOG_S]};
    if (m.known[FIT_LOG_S])
        log_s = about(f->x[FIT_LOG_S], sqrt(form_variance(&m, outer, s_form)), log_s.low, log_s.high);
    const double ends[2] = {material_lobe_shape(f->kind, log_s.low), material_lobe_shape(f->kind, log_s.high)};
    f->shape_range = (struct interval){fmin(ends[0], ends[1]), fmax(ends[0], ends[1])};
}

static void set_meaning(struct material_fit *f)
{
    for (int c = 0; c < 3; c++) f->k_d[c] = f->x[c];
    if (f->kind == BRDF_LAMBERT) return;
    f->ks = f->x[FIT_GLOSS] * material_lobe_ks(f->kind, f->x[FIT_LOG_S]);
    f->shape = material_lobe_shape(f->kind, f->x[FIT_LOG_S]);
}

/* One solution from f->x at f->scale. */
static enum status refine(struct material_fit *f, struct fit_problem *p, struct err *err)
{
    struct curve_fit_outcome outcome = {0};
    if (solve(&outcome, p, f->scale, f->x, err)) return err->status;
    f->cost = 2 * outcome.cost;
    f->converged = outcome.converged;
    return ST_OK;
}

static enum status fit_from_starts(struct material_fit *f, struct fit_problem *p, struct err *err)
{
    double starts[KEPT_STARTS][FIT_UNKNOWNS], scale;
    const int count = find_starts(p, starts, &scale);
    f->cost = INFINITY;
    for (int k = 0; k < count; k++) {
        struct material_fit one = {.kind = p->kind, .scale = scale};
        memcpy(one.x, starts[k], sizeof one.x);
        if (refine(&one, p, err)) return err->status;
        if (one.cost < f->cost) *f = one;
    }
    fit_predict(p->s, p->kind, f->x, p->lobe, p->predicted, NULL);
    square_residuals(p);
    f->scale = residual_scale(p);
    return refine(f, p, err);
}

enum status material_fit(struct material_fit *fit, const struct material_samples *s, enum brdf_kind kind,
                         const bool *used, struct err *err)
{
    struct fit_problem p;
    *fit = (struct material_fit){.kind = kind};
    if (problem_init(&p, s, kind, used, err)) return err->status;
    if (!fit_from_starts(fit, &p, err)) {
        set_meaning(fit);
        set_intervals(fit, &p);
    }
    problem_release(&p);
    return err->status;
}

enum status material_fit_again(struct material_fit *fit, const struct material_fit *from,
                               const struct material_samples *s, const bool *used, struct err *err)
{
    struct fit_problem p;
    *fit = *from;
    if (problem_init(&p, s, from->kind, used, err)) return err->status;
    if (!refine(fit, &p, err)) set_meaning(fit);
    problem_release(&p);
    return err->status;
}

enum status material_fit_losses(double *losses, const struct material_fit *fit, const struct material_samples *s,
                                double scale, struct err *err)
{
    struct fit_problem p;
    if (problem_init(&p, s, fit->kind, NULL, err)) return err->status;
    fit_predict(s, fit->kind, fit->x, p.lobe, p.predicted, NULL);
    square_residuals(&p);
    for (int i = 0; i < s->count; i++) losses[i] = robust_loss(p.squares[i], scale);
    problem_release(&p);
    return ST_OK;
}
