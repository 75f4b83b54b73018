/* gradient_direct.c - a gradient problem by sparse Cholesky factors.
 *
 * A = L D L' in a fill-reducing order, by CHOLMOD [Chen 2008], then one step of iterative refinement, whose residual is
 * evaluated from differences (gradient_system.h). In each part that nothing determines, weight is added to the excess
 * of its first unknown: A becomes regular, and since the right-hand side of such a part sums to 0, this unknown becomes
 * 0 and all equations hold.
 *
 * The factors are simplicial: CHOLMOD's supernodal ones call the BLAS that is installed, whose sums depend on its
 * version and on its threads. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <suitesparse/cholmod.h>

#include "common/math/gradient_system.h"

/* The diagonal of A, with the weight that holds each undetermined part. NULL: no memory. */
static double *regular_diagonal(const struct gradient_system *s)
{
    double *diagonal = malloc((size_t)s->count * sizeof *diagonal);
    if (!diagonal) return NULL;
    memcpy(diagonal, s->excess, (size_t)s->count * sizeof *diagonal);
    for (int i = 0; i < s->count; i++)
        for (int k = 0; k < 2; k++)
            if (s->next[i][k] >= 0) {
                diagonal[i] += s->weight[i][k];
                diagonal[s->next[i][k]] += s->weight[i][k];
            }
    for (int i = 0, part = 0; i < s->count; i++) /* parts are in order of their first unknown */
        if (s->part[i] == part && !s->determined[part++]) diagonal[i] += diagonal[i] > 0 ? diagonal[i] : 1;
    return diagonal;
}

/* The lower triangle of A by columns. NULL: no memory. */
static cholmod_sparse *matrix(const struct gradient_system *s, cholmod_common *cm)
{
    const size_t n = (size_t)s->count;
    double *diagonal = regular_diagonal(s);
    cholmod_sparse *a = diagonal ? cholmod_allocate_sparse(n, n, 3 * n, 1, 1, -1, CHOLMOD_REAL, cm) : NULL;
    if (a) {
        int *begin = a->p, *row = a->i, at = 0;
        double *value = a->x;
        for (int i = 0; i < s->count; i++) {
            begin[i] = at;
            row[at] = i;
            value[at++] = diagonal[i];
            for (int k = 0; k < 2; k++)
                if (s->next[i][k] >= 0) {
                    row[at] = s->next[i][k];
                    value[at++] = -(double)s->weight[i][k];
                }
        }
        begin[n] = at;
    }
    free(diagonal);
    return a;
}

/* v += A^-1 r */
static int correct(double (*v)[4], const double (*r)[4], int count, cholmod_dense *b, cholmod_factor *l,
                   cholmod_common *cm)
{
    double *column = b->x;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) column[(size_t)c * b->d + (size_t)i] = r[i][c];
    cholmod_dense *x = cholmod_solve(CHOLMOD_A, l, b, cm);
    if (!x) return 0;
    column = x->x;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) v[i][c] += column[(size_t)c * x->d + (size_t)i];
    cholmod_free_dense(&x, cm);
    return 1;
}

static enum status factor_and_solve(double (*v)[4], double (*r)[4], const struct gradient_system *s, cholmod_common *cm,
                                    struct err *err)
{
    cholmod_sparse *a = matrix(s, cm);
    cholmod_factor *l = a ? cholmod_analyze(a, cm) : NULL;
    cholmod_dense *b = l && cholmod_factorize(a, l, cm) ? cholmod_zeros((size_t)s->count, 3, CHOLMOD_REAL, cm) : NULL;
    int ok = b && cm->status == CHOLMOD_OK;
    for (int step = 0; ok && step < 2; step++) { /* the second one refines */
        gradient_system_residual(r, s, (const double(*)[4])v);
        ok = correct(v, (const double(*)[4])r, s->count, b, l, cm);
    }
    const bool singular = cm->status == CHOLMOD_NOT_POSDEF;
    cholmod_free_dense(&b, cm);
    cholmod_free_factor(&l, cm);
    cholmod_free_sparse(&a, cm);
    if (ok) return ST_OK;
    return singular ? err_set(err, ST_INTERNAL,
                              "CHOLMOD finds no factors of %d gradient equations: their weights differ by too many "
                              "orders of magnitude.",
                              s->count)
                    : err_nomem(err, "the factors of a gradient problem", cm->memory_usage);
}

enum status gradient_direct(const struct gradient_system *s, double (*v)[4], int *iterations, struct err *err)
{
    *iterations = 0;
    if (!s->count) return ST_OK;
    const size_t bytes = (size_t)s->count * sizeof(double[4]);
    double(*r)[4] = malloc(bytes);
    if (!r) return err_nomem(err, "the residual of a gradient problem", bytes);
    cholmod_common cm;
    cholmod_start(&cm);
    cm.supernodal = CHOLMOD_SIMPLICIAL;
    cm.print = 0;
    const enum status status = factor_and_solve(v, r, s, &cm, err);
    cholmod_finish(&cm);
    free(r);
    return status;
}
