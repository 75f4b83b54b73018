/* given_check.c - see given_check.h.
 *
 * Ranks do not depend on units, nor on whether a program writes depth or any rising function of it. So they tell
 * inverse depth, which networks and stereo programs write, from depth in other units [Spearman 1904].
 *
 * Disparity of a network has an unknown scale and shift [Ranftl 2022]. They are found by least median of squares
 * [Rousseeuw 1984] over lines through two points, then by least squares of the points within INLIER_RANGE
 * deviations. */
#include "stages/segment_depth/given_check.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/rng.h"
#include "common/base/sort.h"

#define TRIALS       200
#define INLIER_RANGE 2.5 /* deviations, of 1.4826 times the median residual */

struct pair {
    double value, inverse_z, rank; /* rank: of the value */
};

static int by_value(const void *a, const void *b)
{
    const struct pair *p = a, *q = b;
    return (p->value > q->value) - (p->value < q->value);
}

/* Pairs whose depth is equal are in order of value, so that the result does not depend on their order before. */
static int by_depth(const void *a, const void *b)
{
    const struct pair *p = a, *q = b;
    if (p->inverse_z != q->inverse_z) return p->inverse_z > q->inverse_z ? -1 : 1;
    return by_value(a, b);
}

/* *pairs: the points where a value is given; malloc'ed. */
static enum status find_pairs(struct pair **pairs, int *count, const float *values, int width, int height,
                              const struct observed_points *seen, struct err *err)
{
    *count = 0;
    *pairs = malloc(((size_t)seen->count + 1) * sizeof **pairs);
    if (!*pairs) return err_nomem(err, "depths of points", (size_t)seen->count * sizeof **pairs);
    for (int i = 0; i < seen->count; i++) {
        const struct observed_point *p = &seen->points[i];
        if (!(p->u >= 0 && p->v >= 0 && p->u < width && p->v < height)) continue;
        const float value = values[(size_t)p->v * (size_t)width + (size_t)p->u];
        if (value > 0) (*pairs)[(*count)++] = (struct pair){(double)value, p->inverse_z, 0};
    }
    return ST_OK;
}

enum status given_check_ranks(double *correlation, const float *values, int width, int height,
                              const struct observed_points *seen, struct err *err)
{
    struct pair *p = NULL;
    int count = 0;
    *correlation = NAN;
    if (find_pairs(&p, &count, values, width, height, seen, err) || count < GIVEN_CHECKED) {
        free(p);
        return err->status;
    }
    const size_t n = (size_t)count;
    qsort(p, n, sizeof *p, by_value);
    for (int i = 0, end; i < count; i = end) { /* equal values share their mean rank */
        for (end = i; end < count && p[end].value == p[i].value;) end++;
        for (int k = i; k < end; k++) p[k].rank = (i + end - 1) / 2.0;
    }
    qsort(p, n, sizeof *p, by_depth);
    double xy = 0, xx = 0, yy = 0;
    const double mean = (count - 1) / 2.0;
    for (int i = 0; i < count; i++) {
        const double x = p[i].rank - mean, y = i - mean;
        xy += x * y;
        xx += x * x;
        yy += y * y;
    }
    *correlation = xx > 0 ? xy / sqrt(xx * yy) : 0;
    free(p);
    return ST_OK;
}

struct line {
    double a, b; /* inverse depth = a value + b */
};

static double residual(const struct pair *p, struct line l) { return fabs(l.a * p->value + l.b - p->inverse_z); }

static double median_residual(const struct pair *p, int count, struct line l, double *scratch)
{
    for (int i = 0; i < count; i++) scratch[i] = residual(&p[i], l);
    return sort_median(scratch, (size_t)count);
}

static struct line least_squares(const struct pair *p, int count, struct line from, double reach)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < count; i++) {
        if (residual(&p[i], from) > reach) continue;
        n++;
        x += p[i].value;
        y += p[i].inverse_z;
    }
    if (!(n > 2)) return from;
    x /= n;
    y /= n;
    for (int i = 0; i < count; i++) {
        if (residual(&p[i], from) > reach) continue;
        xx += (p[i].value - x) * (p[i].value - x);
        xy += (p[i].value - x) * (p[i].inverse_z - y);
    }
    return xx > 0 ? (struct line){xy / xx, y - xy / xx * x} : from;
}

static struct line find_line(const struct pair *p, int count, double *scratch)
{
    const struct rng rng = rng_make(1, "segment_depth", "disparity");
    struct line best = {0, 0};
    double least = INFINITY;
    for (uint64_t k = 0; k < TRIALS; k++) {
        const struct pair *one = &p[(int)(rng_uniform(&rng, k, 0) * count)],
                          *two = &p[(int)(rng_uniform(&rng, k, 1) * count)];
        if (one->value == two->value) continue;
        const double a = (two->inverse_z - one->inverse_z) / (two->value - one->value);
        const struct line tried = {a, one->inverse_z - a * one->value};
        const double found = median_residual(p, count, tried, scratch);
        if (!(found < least)) continue;
        least = found;
        best = tried;
    }
    return isfinite(least) ? least_squares(p, count, best, fmax(INLIER_RANGE * 1.4826 * least, 1e-12)) : best;
}

enum status given_check_fit(bool *fits, float *values, int width, int height, const struct observed_points *seen,
                            struct err *err)
{
    struct pair *p = NULL;
    int count = 0;
    double *scratch = malloc(((size_t)seen->count + 1) * sizeof *scratch);
    *fits = false;
    if (!scratch) err_nomem(err, "depths of points", (size_t)seen->count * sizeof *scratch);
    if (!err->status && !find_pairs(&p, &count, values, width, height, seen, err) && count >= GIVEN_CHECKED) {
        const struct line l = find_line(p, count, scratch);
        *fits = l.a > 0;
        const size_t pixels = (size_t)width * (size_t)height;
        for (size_t i = 0; *fits && i < pixels; i++) {
            const double inverse = l.a * (double)values[i] + l.b;
            values[i] = values[i] > 0 && inverse > 0 ? (float)(1 / inverse) : 0;
        }
    }
    free(scratch);
    free(p);
    return err->status;
}

enum status given_check_lone(bool *known, double *farthest, float *values, int width, int height, bool disparity,
                             struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    float *sorted = malloc(pixels * sizeof *sorted);
    size_t count = 0;
    *known = false;
    if (!sorted) return err_nomem(err, "given depth", pixels * sizeof *sorted);
    for (size_t i = 0; i < pixels; i++)
        if (values[i] > 0) sorted[count++] = values[i];
    if (count) {
        sort_floats(sorted, count);
        const size_t tail = count / 50;
        const float near = sorted[disparity ? count - 1 - tail : tail],
                    far = sorted[disparity ? tail : count - 1 - tail];
        for (size_t i = 0; i < pixels; i++)
            if (values[i] > 0) values[i] = fminf(disparity ? near / values[i] : values[i] / near, (float)LONE_FARTHEST);
        *farthest = fmin((double)(disparity ? near / far : far / near), LONE_FARTHEST);
        *known = true;
    }
    free(sorted);
    return ST_OK;
}
