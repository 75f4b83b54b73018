/* given_depth.c - see given_depth.h.
 *
 * Of planes through three samples, and that of least squares, the one with the least median residual tells how well samples
 * agree at all (Rousseeuw 1984): a scanner's to a part of a step, a network's to several. Least squares of what lies within 2.5
 * such deviations, repeated, makes it exact. What a slope saves is counted in deviations too, for given depth is often finer than a
 * step. */
#include "stages/segment_depth/given_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/sort.h"

#define LEAST_SAMPLES 4
#define LEAST_PART    8 /* one in so many pixels */
#define TRIPLES       12
#define LOOKED_AT     64   /* samples that tell a median */
#define OUTSIDE       2.5  /* deviations: not of this plane */
#define LIMIT         4.0  /* deviations: a miss that costs no more when it grows */
#define FINEST        1e-3 /* steps: a smaller deviation makes no difference */
#define PARAMETERS    4.0  /* what a slope must save in all, in deviations: less is fitted noise */
#define NO_FIT        4.0  /* steps: what is farther off is not explained at all */
#define REPEATS       4

struct sample {
    double u, v, d; /* from the segment's middle; inverse depth */
};

struct fit {
    struct given_depth *g;
    const struct segmentation *s;
    const float *z;
    double step;
    const struct segment_params *params;
    struct rng rng;
    struct sample *samples; /* of the largest segment, a thread each */
    size_t largest;
};

bool given_depth_range(double *least, double *most, const float *z, size_t pixels)
{
    enum { MANY = 1 << 16 };
    const size_t step = pixels / MANY + 1;
    double *inverse = malloc((pixels / step + 1) * sizeof *inverse);
    size_t count = 0, known = 0;
    double low = INFINITY, high = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!(z[i] > 0)) continue;
        low = fmin(low, 1 / (double)z[i]);
        high = fmax(high, 1 / (double)z[i]);
        if (inverse && known++ % step == 0) inverse[count++] = 1 / (double)z[i];
    }
    if (count > 100) { /* one in fifty at either end may be false */
        sort_doubles(inverse, count);
        low = inverse[count / 50];
        high = inverse[count - 1 - count / 50];
    }
    free(inverse);
    if (!(high > 0)) return false;
    *least = *least > 0 ? fmin(*least, 0.95 * low) : 0.95 * low;
    *most = fmax(*most, 1.05 * high);
    return true;
}

double given_depth_ratio(const float *z, int width, int height, const struct seen_points *seen)
{
    enum { LEAST_POINTS = 8 };
    double *ratios = malloc(((size_t)seen->count + 1) * sizeof *ratios), median = 0;
    int count = 0;
    for (int i = 0; ratios && i < seen->count; i++) {
        const struct seen_point *p = &seen->points[i];
        if (!(p->u >= 0 && p->v >= 0 && p->u < width && p->v < height)) continue;
        const float at = z[(size_t)p->v * (size_t)width + (size_t)p->u];
        if (at > 0) ratios[count++] = (double)at * p->inverse_z;
    }
    if (count >= LEAST_POINTS) {
        sort_doubles(ratios, (size_t)count);
        median = ratios[count / 2];
    }
    free(ratios);
    return median;
}

static double residual(const struct sample *p, struct plane at)
{
    return fabs(at.a * p->u + at.b * p->v + at.c - p->d);
}

static double median_residual(const struct sample *p, int count, struct plane at)
{
    double r[LOOKED_AT];
    const int looked = count < LOOKED_AT ? count : LOOKED_AT;
    for (int k = 0; k < looked; k++) r[k] = residual(&p[(int64_t)k * count / looked], at);
    sort_doubles(r, (size_t)looked);
    return r[looked / 2];
}

static bool through_three(const struct sample *p, const struct sample *q, const struct sample *r, struct plane *out)
{
    const double ux = q->u - p->u, uy = q->v - p->v, vx = r->u - p->u, vy = r->v - p->v, det = ux * vy - uy * vx;
    if (!(fabs(det) > 0.5)) return false; /* px^2 */
    out->a = ((q->d - p->d) * vy - (r->d - p->d) * uy) / det;
    out->b = ((r->d - p->d) * ux - (q->d - p->d) * vx) / det;
    out->c = p->d - out->a * p->u - out->b * p->v;
    return true;
}

/* Least squares of the samples within `reach` of `from`; constant: a = b = 0. Stays `from` where they do not span a plane. */
static struct plane fitted(const struct sample *p, int count, struct plane from, double reach, bool constant)
{
    double n = 0, mean[3] = {0}, uu = 0, uv = 0, vv = 0, ud = 0, vd = 0;
    for (int k = 0; k < count; k++) {
        if (residual(&p[k], from) > reach) continue;
        n++;
        mean[0] += p[k].u;
        mean[1] += p[k].v;
        mean[2] += p[k].d;
    }
    if (!(n > 0)) return from;
    for (int i = 0; i < 3; i++) mean[i] /= n;
    if (constant) return (struct plane){0, 0, mean[2]};
    for (int k = 0; k < count; k++) {
        const double u = p[k].u - mean[0], v = p[k].v - mean[1], d = p[k].d - mean[2];
        if (residual(&p[k], from) > reach) continue;
        uu += u * u;
        uv += u * v;
        vv += v * v;
        ud += u * d;
        vd += v * d;
    }
    const double det = uu * vv - uv * uv;
    if (!(det > 1e-6 * (uu + vv) * (uu + vv)) || !(uu + vv > n / 4)) return from;
    const double a = (ud * vv - vd * uv) / det, b = (vd * uu - ud * uv) / det;
    return (struct plane){a, b, mean[2] - a * mean[0] - b * mean[1]};
}

static double cost_of(const struct sample *p, int count, struct plane at, double limit)
{
    double sum = 0;
    for (int k = 0; k < count; k++) sum += fmin(residual(&p[k], at), limit);
    return sum / count;
}

/* Positive over the segment and the margin where its edge may be painted, and nowhere far from what was given. */
static bool stays_near(const struct segment *g, struct plane at, const struct sample *p, int count)
{
    double least = INFINITY, most = 0;
    for (int k = 0; k < count; k++) {
        least = fmin(least, p[k].d);
        most = fmax(most, p[k].d);
    }
    return plane_keeps_to(at, g, 0.25 * least, 4 * most);
}

static void fit_segment(const struct fit *f, int i, const struct sample *p, int count)
{
    const struct segment *g = &f->s->segments[i];
    const double size = (double)g->pixels / f->params->segment_pixels;
    double inverse[LOOKED_AT], least = INFINITY;
    const int looked = count < LOOKED_AT ? count : LOOKED_AT;
    for (int k = 0; k < looked; k++) inverse[k] = p[(int64_t)k * count / looked].d;
    sort_doubles(inverse, (size_t)looked);
    struct plane level = {0, 0, inverse[looked / 2]}, slanted = level;
    for (int k = -1; k < TRIPLES; k++) {
        struct plane tried = fitted(p, count, level, INFINITY, false);
        const struct sample *three[3];
        for (uint64_t j = 0; j < 3; j++)
            three[j] = &p[(int)(rng_uniform(&f->rng, (uint64_t)i, 3 * (uint64_t)(k + 1) + j) * count)];
        if (k >= 0 && !through_three(three[0], three[1], three[2], &tried)) continue;
        const double median = median_residual(p, count, tried);
        if (!(median < least)) continue;
        least = median;
        slanted = tried;
        if (k < 0 && median < 1e-3 * f->step) break;
    }
    const double deviation = fmax(1.5 * least, FINEST * f->step), reach = OUTSIDE * deviation,
                 limit = LIMIT * deviation;
    for (int k = 0; k < REPEATS; k++) {
        slanted = fitted(p, count, slanted, reach, false);
        level = fitted(p, count, level, reach, true);
    }
    const struct plane moved = {slanted.a, slanted.b, slanted.c - slanted.a * g->cx - slanted.b * g->cy};
    const double gain = (cost_of(p, count, level, limit) - cost_of(p, count, slanted, limit)) / deviation;
    const bool slants = size * gain > f->params->slant && count * gain > PARAMETERS && stays_near(g, moved, p, count);
    const struct plane best = slants ? slanted : level;
    double off = 0, good = 0;
    int inside = 0;
    for (int k = 0; k < count; k++) {
        const double r = residual(&p[k], best);
        good += 1 - fmin(r / (NO_FIT * f->step), 1);
        if (r > reach) continue;
        off += r;
        inside++;
    }
    f->g->planes[i] = slants ? moved : level;
    f->g->good[i] = (float)(good / count);
    f->g->off[i] = inside ? (float)(off / inside) : 0;
}

static void fit_segments(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fit *f = ctx;
    struct sample *p = f->samples + f->largest * (size_t)thread;
    for (size_t i = begin; i < end; i++) {
        const struct segment *g = &f->s->segments[i];
        int count = 0;
        for (int k = 0; k < g->pixels; k++) {
            const int at = f->s->pixel[g->first + k];
            if (!(f->z[at] > 0)) continue;
            p[count++] =
                (struct sample){at % f->s->width + 0.5 - g->cx, at / f->s->width + 0.5 - g->cy, 1 / (double)f->z[at]};
        }
        f->g->known[i] = count >= LEAST_SAMPLES && count >= g->pixels / LEAST_PART;
        if (f->g->known[i]) fit_segment(f, (int)i, p, count);
    }
}

enum status given_depth_make(struct given_depth *g, const struct segmentation *s, const float *z, double step,
                             const struct segment_params *params, struct err *err)
{
    const size_t count = (size_t)s->count + 1;
    struct fit f = {
        .g = g, .s = s, .z = z, .step = step, .params = params, .rng = rng_make(1, "segment_depth", "given")};
    for (int i = 0; i < s->count; i++)
        if ((size_t)s->segments[i].pixels > f.largest) f.largest = (size_t)s->segments[i].pixels;
    f.samples = malloc((f.largest * (size_t)parallel_threads() + 1) * sizeof *f.samples);
    g->known = calloc(count, sizeof *g->known);
    g->planes = calloc(count, sizeof *g->planes);
    g->good = calloc(count, sizeof *g->good);
    g->off = calloc(count, sizeof *g->off);
    enum status st = f.samples && g->known && g->planes && g->good && g->off
                         ? ST_OK
                         : err_nomem(err, "given planes", count * 40 + f.largest * sizeof *f.samples);
    if (!st) parallel_for((size_t)s->count, 64, fit_segments, &f);
    for (int i = 0; !st && i < s->count; i++) {
        const struct segment *at = &s->segments[i];
        g->segments += g->known[i];
        for (int k = 0; k < at->pixels; k++) g->pixels += z[s->pixel[at->first + k]] > 0;
    }
    free(f.samples);
    return st;
}

void given_depth_release(struct given_depth *g)
{
    if (!g) return;
    free(g->known);
    free(g->planes);
    free(g->good);
    free(g->off);
    *g = (struct given_depth){0};
}
