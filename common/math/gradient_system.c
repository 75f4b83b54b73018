/* gradient_system.c - the normal equations of a gradient problem.
 *
 * The derivative of the sum in gradient_solve.h by v[p], halved, is
 *     data_weight (v[p] - data) + sum over pairs (p, q) of weight (v[p] - v[q] - g(q, p)) = 0,
 * where g(q, p) is the wanted v[p] - v[q]: plus the gradient if q is left of or above p, minus it if q is right or
 * below. A fixed q adds weight to the excess of p and weight (value[q] + g) to b; an unknown q is a link, and adds
 * weight g.
 *
 * Connected parts are found by union-find, the smaller index as root, so that parts are numbered in order of their
 * first unknown. A part without any excess has a singular block of A: a constant can be added to its values. The mean
 * of its start is added last. */
#include "common/math/gradient_system.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static enum status bad_pixel(const struct gradient_problem *p, size_t at, const char *what, double found,
                             const char *wanted, struct err *err)
{
    return err_set(err, ST_DATA, "pixel (%zu, %zu) has the %s %g; expected %s.", at % (size_t)p->width,
                   at / (size_t)p->width, what, found, wanted);
}

/* A weight, and if it is above 0 the 3 values that it weighs. */
static enum status check_weighted(const struct gradient_problem *p, size_t at, const char *name, float weight,
                                  const char *values_name, const float *values, struct err *err)
{
    if (!(weight >= 0) || !isfinite(weight))
        return bad_pixel(p, at, name, weight, "a finite number of at least 0", err);
    for (int c = 0; weight > 0 && c < 3; c++)
        if (!isfinite(values[c])) return bad_pixel(p, at, values_name, values[c], "a finite number", err);
    return ST_OK;
}

static bool counts(const struct gradient_problem *p, size_t a, size_t b)
{
    return (p->role[a] == GRADIENT_FREE && p->role[b] != GRADIENT_OUT) ||
           (p->role[a] == GRADIENT_FIXED && p->role[b] == GRADIENT_FREE);
}

static enum status check_pixel(const struct gradient_problem *p, int x, int y, struct err *err)
{
    const size_t width = (size_t)p->width, at = (size_t)y * width + (size_t)x;
    if (p->role[at] == GRADIENT_OUT) return ST_OK;
    for (int c = 0; c < 3; c++)
        if (!isfinite(p->value[3 * at + (size_t)c]))
            return bad_pixel(p, at, "value", p->value[3 * at + (size_t)c], "a finite number", err);
    const bool right = x + 1 < p->width && counts(p, at, at + 1);
    const bool below = y + 1 < p->height && counts(p, at, at + width);
    if ((p->role[at] == GRADIENT_FREE &&
         check_weighted(p, at, "data weight", p->data_weight[at], "datum", p->data + 3 * at, err)) ||
        (right && check_weighted(p, at, "horizontal weight", p->weight_x[at], "horizontal gradient",
                                 p->gradient_x + 3 * at, err)) ||
        (below &&
         check_weighted(p, at, "vertical weight", p->weight_y[at], "vertical gradient", p->gradient_y + 3 * at, err)))
        return err->status;
    return ST_OK;
}

/* Adds pair k (0: right, 1: below) of pixels a and b, whose unknowns are i and j (-1: none). */
static void add_pair(struct gradient_system *s, const struct gradient_problem *p, int k, size_t a, size_t b, int i,
                     int j)
{
    const float weight = (k ? p->weight_y : p->weight_x)[a];
    const float *gradient = (k ? p->gradient_y : p->gradient_x) + 3 * a;
    if (!counts(p, a, b) || !(weight > 0)) return;
    if (i >= 0 && j >= 0) {
        s->next[i][k] = j;
        s->weight[i][k] = weight;
    } else
        s->excess[i >= 0 ? i : j] += weight;
    for (size_t c = 0; c < 3; c++) {
        if (i >= 0) s->rhs[i][c] += (double)weight * ((j < 0 ? p->value[3 * b + c] : 0) - (double)gradient[c]);
        if (j >= 0) s->rhs[j][c] += (double)weight * ((i < 0 ? p->value[3 * a + c] : 0) + (double)gradient[c]);
    }
}

static int root(int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static enum status find_parts(struct gradient_system *s, struct err *err)
{
    for (int i = 0; i < s->count; i++) s->part[i] = i;
    for (int i = 0; i < s->count; i++)
        for (int k = 0; k < 2; k++) {
            if (s->next[i][k] < 0) continue;
            const int a = root(s->part, i), b = root(s->part, s->next[i][k]);
            s->part[a > b ? a : b] = a > b ? b : a;
        }
    /* a parent is before its children: its part is known when they need it */
    for (int i = 0; i < s->count; i++) s->part[i] = s->part[i] == i ? s->part_count++ : s->part[s->part[i]];
    const size_t n = (size_t)s->part_count + 1; /* never 0 bytes */
    s->size = calloc(n, sizeof *s->size);
    s->determined = calloc(n, 1);
    if (!s->size || !s->determined) return err_nomem(err, "parts of a gradient problem", n * (sizeof *s->size + 1));
    for (int i = 0; i < s->count; i++) {
        s->size[s->part[i]]++;
        if (s->excess[i] > 0) s->determined[s->part[i]] = 1;
    }
    return ST_OK;
}

static enum status allocate(struct gradient_system *s, struct err *err)
{
    const size_t n = (size_t)s->count + 1; /* never 0 bytes */
    s->pixel = malloc(n * sizeof *s->pixel);
    s->next = malloc(n * sizeof *s->next);
    s->weight = calloc(n, sizeof *s->weight);
    s->excess = calloc(n, sizeof *s->excess);
    s->rhs = calloc(n, sizeof *s->rhs);
    s->part = malloc(n * sizeof *s->part);
    if (s->pixel && s->next && s->weight && s->excess && s->rhs && s->part) return ST_OK;
    return err_nomem(err, "the equations of a gradient problem",
                     n * (sizeof *s->pixel + sizeof *s->next + sizeof *s->weight + sizeof *s->excess + sizeof *s->rhs +
                          sizeof *s->part));
}

/* unknown: of each pixel; -1: none */
static void fill(struct gradient_system *s, const struct gradient_problem *p, const int *unknown)
{
    s->low = INFINITY;
    s->high = -INFINITY;
    const size_t width = (size_t)p->width, pixels = width * (size_t)p->height;
    for (size_t at = 0; at < pixels; at++) {
        const int i = unknown[at];
        for (size_t c = 0; c < 3 && p->role[at] == GRADIENT_FIXED; c++) {
            s->low = fmin(s->low, (double)p->value[3 * at + c]);
            s->high = fmax(s->high, (double)p->value[3 * at + c]);
        }
        if (i >= 0) {
            s->pixel[i] = (int)at;
            s->next[i][0] = s->next[i][1] = -1;
            s->excess[i] += p->data_weight[at];
            for (size_t c = 0; c < 3 && p->data_weight[at] > 0; c++)
                s->rhs[i][c] += (double)p->data_weight[at] * (double)p->data[3 * at + c];
        }
        if ((at + 1) % width) add_pair(s, p, 0, at, at + 1, i, unknown[at + 1]);
        if (at + width < pixels) add_pair(s, p, 1, at, at + width, i, unknown[at + width]);
    }
}

enum status gradient_system_init(struct gradient_system *s, const struct gradient_problem *p, struct err *err)
{
    assert(p->width > 0 && p->height > 0 && (int64_t)p->width * p->height <= INT_MAX - 1);
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            if (check_pixel(p, x, y, err)) return err->status;
    int *unknown = malloc(pixels * sizeof *unknown);
    if (!unknown) return err_nomem(err, "the unknowns of a gradient problem", pixels * sizeof *unknown);
    for (size_t at = 0; at < pixels; at++) unknown[at] = p->role[at] == GRADIENT_FREE ? s->count++ : -1;
    enum status status = allocate(s, err);
    if (!status) {
        fill(s, p, unknown);
        status = find_parts(s, err);
    }
    free(unknown);
    if (status) gradient_system_release(s);
    return status;
}

void gradient_system_release(struct gradient_system *s)
{
    free(s->pixel);
    free(s->next);
    free(s->weight);
    free(s->excess);
    free(s->rhs);
    free(s->part);
    free(s->size);
    free(s->determined);
    *s = (struct gradient_system){0};
}

void gradient_system_residual(double (*r)[4], const struct gradient_system *s, const double (*v)[4])
{
    for (int i = 0; i < s->count; i++)
        for (int c = 0; c < 4; c++) r[i][c] = s->rhs[i][c] - s->excess[i] * v[i][c];
    for (int i = 0; i < s->count; i++)
        for (int k = 0; k < 2; k++) {
            const int j = s->next[i][k];
            if (j < 0) continue;
            for (int c = 0; c < 4; c++) {
                const double flow = (double)s->weight[i][k] * (v[j][c] - v[i][c]);
                r[i][c] += flow;
                r[j][c] -= flow;
            }
        }
}
