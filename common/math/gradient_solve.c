/* gradient_solve.c - gradient problems: which solver they get.
 *
 * Sparse Cholesky factors suit small parts, since their time per unknown grows with the size of a part. From some ten
 * thousand unknowns in one part multigrid is the faster (docs/benchmarks.md). So it solves problems with a large part;
 * the factors solve all others, and those on which multigrid does not converge. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/math/gradient_system.h"

enum { LARGE_PART = 50000 }; /* unknowns */

static bool has_large_part(const struct gradient_system *s)
{
    for (int k = 0; k < s->part_count; k++)
        if (s->size[k] >= LARGE_PART) return true;
    return false;
}

static void start(double (*v)[4], const struct gradient_system *s, const struct gradient_problem *p)
{
    for (int i = 0; i < s->count; i++) {
        const float *value = p->value + 3 * (size_t)s->pixel[i];
        for (int c = 0; c < 4; c++) v[i][c] = c < 3 ? (double)value[c] : 0;
    }
}

/* Sums over a part's unknowns. */
struct sums {
    double start[3], now[3];
};

/* Undetermined parts get the mean of their start. */
static enum status keep_means(const struct gradient_system *s, const struct gradient_problem *p, double (*v)[4],
                              struct err *err)
{
    const size_t n = (size_t)s->part_count + 1;
    struct sums *parts = calloc(n, sizeof *parts);
    if (!parts) return err_nomem(err, "parts of a gradient problem", n * sizeof *parts);
    for (int i = 0; i < s->count; i++) {
        struct sums *part = &parts[s->part[i]];
        for (size_t c = 0; c < 3; c++) {
            part->start[c] += (double)p->value[3 * (size_t)s->pixel[i] + c];
            part->now[c] += v[i][c];
        }
    }
    for (int i = 0; i < s->count; i++) {
        const int k = s->part[i];
        for (int c = 0; c < 3 && !s->determined[k]; c++) v[i][c] += (parts[k].start[c] - parts[k].now[c]) / s->size[k];
    }
    free(parts);
    return ST_OK;
}

static double largest(const double (*v)[4], int count)
{
    double most = 0;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) most = fabs(v[i][c]) > most ? fabs(v[i][c]) : most;
    return most;
}

static void fill_report(struct gradient_report *report, const struct gradient_system *s, const double (*r)[4])
{
    const double b = largest((const double(*)[4])s->rhs, s->count);
    report->residual = largest(r, s->count) / (b > 0 ? b : 1);
    report->free = s->count;
    report->undetermined = 0;
    for (int k = 0; k < s->part_count; k++)
        if (!s->determined[k]) report->undetermined += s->size[k];
}

static bool fit_float(const double (*v)[4], int count)
{
    bool fit = true;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) fit = fit && fabs(v[i][c]) <= (double)FLT_MAX;
    return fit;
}

/* By method; where it finds no solution by `otherwise`, unless that is NULL. v: scratch memory. */
static enum status find(double (*v)[4], const struct gradient_system *s, const struct gradient_problem *p,
                        gradient_method *method, gradient_method *otherwise, int *iterations, struct err *err)
{
    start(v, s, p);
    if (method(s, v, iterations, err)) return err->status;
    if (*iterations >= 0 && fit_float((const double(*)[4])v, s->count)) return ST_OK;
    if (otherwise) return find(v, s, p, otherwise, NULL, iterations, err);
    return err_set(err, ST_INTERNAL,
                   "%d gradient equations have no solution that fits in single precision, or none was "
                   "found; their weights may differ by too many orders of magnitude.",
                   s->count);
}

static enum status solve_system(const struct gradient_system *s, const struct gradient_problem *p,
                                gradient_method *method, gradient_method *otherwise, double (*v)[4], double (*r)[4],
                                struct gradient_report *report, struct err *err)
{
    if (find(v, s, p, method, otherwise, &report->iterations, err) || keep_means(s, p, v, err)) return err->status;
    gradient_system_residual(r, s, (const double(*)[4])v);
    fill_report(report, s, (const double(*)[4])r);
    for (int i = 0; i < s->count; i++)
        for (size_t c = 0; c < 3; c++) p->value[3 * (size_t)s->pixel[i] + c] = (float)v[i][c];
    return ST_OK;
}

static enum status solve(const struct gradient_problem *p, gradient_method *method, gradient_method *otherwise,
                         struct gradient_report *report, struct err *err)
{
    struct gradient_system s = {0};
    if (gradient_system_init(&s, p, err)) return err->status;
    const size_t n = (size_t)s.count + 1;
    double(*v)[4] = malloc(n * sizeof *v), (*r)[4] = malloc(n * sizeof *r);
    enum status status = v && r ? ST_OK : err_nomem(err, "the values of a gradient problem", n * sizeof(double[8]));
    if (!method) method = has_large_part(&s) ? gradient_multigrid : gradient_direct;
    if (!status) status = solve_system(&s, p, method, otherwise, v, r, report, err);
    free(v);
    free(r);
    gradient_system_release(&s);
    return status;
}

enum status gradient_solve(const struct gradient_problem *p, struct gradient_report *report, struct err *err)
{
    return solve(p, NULL, gradient_direct, report, err);
}

enum status gradient_solve_direct(const struct gradient_problem *p, struct gradient_report *report, struct err *err)
{
    return solve(p, gradient_direct, NULL, report, err);
}

enum status gradient_solve_multigrid(const struct gradient_problem *p, struct gradient_report *report, struct err *err)
{
    return solve(p, gradient_multigrid, NULL, report, err);
}
