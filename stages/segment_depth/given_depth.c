/* given_depth.c - robust fit of a plane to the given depths of each segment.
 *
 * 1. Least median of squares [Rousseeuw 1984]: of the least-squares plane and TRIALS planes through three random
 * samples, the
 *    one of minimum median residual. 1.5 times that residual is the samples' standard deviation: a fraction of a step
 * for a
 *    scanner, several steps for a network.
 * 2. Least squares over the samples within INLIER_RANGE deviations, REWEIGHTINGS times; the same for a constant depth.
 * 3. The slanted plane is chosen if it saves more truncated residual than the price of a slope. That is counted in
 * deviations, not in
 *    steps, since given depth is often finer than a step. */
#include "stages/segment_depth/given_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/sort.h"

#define MIN_SAMPLES           4
#define MAX_PIXELS_PER_SAMPLE 8 /* sparser samples are ignored */
#define TRIALS                12
#define MEDIAN_SAMPLES        64   /* samples that a median is taken of */
#define INLIER_RANGE          2.5  /* deviations */
#define TRUNCATION            4.0  /* deviations: larger residuals cost the same */
#define MIN_DEVIATION         1e-3 /* steps */
#define MIN_SLOPE_GAIN        4.0  /* deviations that a slope must save in total; less is fitted noise */
#define MAX_RESIDUAL          4.0  /* steps: residual of quality 0 */
#define REWEIGHTINGS          4

struct depth_sample {
    double u, v, d; /* u, v: from the segment's centroid; d: inverse depth */
};

struct plane_fits {
    struct given_depth *g;
    const struct segmentation *s;
    const float *z;
    double step;
    const struct segment_params *params;
    struct rng rng;
    struct depth_sample *samples; /* scratch: `largest` per thread */
    size_t largest;
};

bool given_depth_range(double *min_inverse_z, double *max_inverse_z, const float *z, size_t pixels)
{
    enum { MAX_SAMPLES = 1 << 16 };
    const size_t step = pixels / MAX_SAMPLES + 1;
    double *inverse = malloc((pixels / step + 1) * sizeof *inverse);
    size_t count = 0, known = 0;
    double low = INFINITY, high = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!(z[i] > 0)) continue;
        low = fmin(low, 1 / (double)z[i]);
        high = fmax(high, 1 / (double)z[i]);
        if (inverse && known++ % step == 0) inverse[count++] = 1 / (double)z[i];
    }
    if (count > 100) { /* 2 % at either end may be outliers */
        sort_doubles(inverse, count);
        low = inverse[count / 50];
        high = inverse[count - 1 - count / 50];
    }
    free(inverse);
    if (!(high > 0)) return false;
    *min_inverse_z = *min_inverse_z > 0 ? fmin(*min_inverse_z, 0.95 * low) : 0.95 * low;
    *max_inverse_z = fmax(*max_inverse_z, 1.05 * high);
    return true;
}

double given_depth_ratio(const float *z, int width, int height, const struct observed_points *seen)
{
    enum { MIN_POINTS = 8 };
    double *ratios = malloc(((size_t)seen->count + 1) * sizeof *ratios), median = 0;
    int count = 0;
    for (int i = 0; ratios && i < seen->count; i++) {
        const struct observed_point *p = &seen->points[i];
        if (!(p->u >= 0 && p->v >= 0 && p->u < width && p->v < height)) continue;
        const float at = z[(size_t)p->v * (size_t)width + (size_t)p->u];
        if (at > 0) ratios[count++] = (double)at * p->inverse_z;
    }
    if (count >= MIN_POINTS) {
        sort_doubles(ratios, (size_t)count);
        median = ratios[count / 2];
    }
    free(ratios);
    return median;
}

static double residual(const struct depth_sample *p, struct plane at)
{
    return fabs(at.a * p->u + at.b * p->v + at.c - p->d);
}

static double median_residual(const struct depth_sample *p, int count, struct plane at)
{
    double r[MEDIAN_SAMPLES];
    const int used = count < MEDIAN_SAMPLES ? count : MEDIAN_SAMPLES;
    for (int k = 0; k < used; k++) r[k] = residual(&p[(int64_t)k * count / used], at);
    sort_doubles(r, (size_t)used);
    return r[used / 2];
}

static bool through_three(const struct depth_sample *p, const struct depth_sample *q, const struct depth_sample *r,
                          struct plane *out)
{
    const double ux = q->u - p->u, uy = q->v - p->v, vx = r->u - p->u, vy = r->v - p->v, det = ux * vy - uy * vx;
    if (!(fabs(det) > 0.5)) return false; /* px^2 */
    out->a = ((q->d - p->d) * vy - (r->d - p->d) * uy) / det;
    out->b = ((r->d - p->d) * ux - (q->d - p->d) * vx) / det;
    out->c = p->d - out->a * p->u - out->b * p->v;
    return true;
}

/* Least-squares plane of the samples within `reach` of `from`; constant: with a = b = 0. Returns `from` if they do not
 * span a plane. */
static struct plane least_squares(const struct depth_sample *p, int count, struct plane from, double reach,
                                  bool constant)
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

static double truncated_cost(const struct depth_sample *p, int count, struct plane at, double limit)
{
    double sum = 0;
    for (int k = 0; k < count; k++) sum += fmin(residual(&p[k], at), limit);
    return sum / count;
}

/* Whether the plane is positive, and not far from the given depths, over the segment and the margin around it. */
static bool within_samples(const struct segment *g, struct plane at, const struct depth_sample *p, int count)
{
    double lowest = INFINITY, highest = 0;
    for (int k = 0; k < count; k++) {
        lowest = fmin(lowest, p[k].d);
        highest = fmax(highest, p[k].d);
    }
    return plane_within(at, g, 0.25 * lowest, 4 * highest);
}

/* Step 1. *median: the minimum of the median residual. */
static struct plane least_median_plane(const struct plane_fits *f, int i, const struct depth_sample *p, int count,
                                       struct plane level, double *median)
{
    struct plane best = level;
    *median = INFINITY;
    for (int k = -1; k < TRIALS; k++) {
        struct plane tried = least_squares(p, count, level, INFINITY, false);
        const struct depth_sample *three[3];
        for (uint64_t j = 0; j < 3; j++)
            three[j] = &p[(int)(rng_uniform(&f->rng, (uint64_t)i, 3 * (uint64_t)(k + 1) + j) * count)];
        if (k >= 0 && !through_three(three[0], three[1], three[2], &tried)) continue;
        const double found = median_residual(p, count, tried);
        if (!(found < *median)) continue;
        *median = found;
        best = tried;
        if (k < 0 && found < 1e-3 * f->step) break;
    }
    return best;
}

static void fit_segment(const struct plane_fits *f, int i, const struct depth_sample *p, int count)
{
    const struct segment *g = &f->s->segments[i];
    const double size = (double)g->pixels / f->params->segment_pixels;
    double inverse[MEDIAN_SAMPLES], median;
    const int used = count < MEDIAN_SAMPLES ? count : MEDIAN_SAMPLES;
    for (int k = 0; k < used; k++) inverse[k] = p[(int64_t)k * count / used].d;
    sort_doubles(inverse, (size_t)used);
    struct plane level = {0, 0, inverse[used / 2]};
    struct plane slanted = least_median_plane(f, i, p, count, level, &median);
    const double deviation = fmax(1.5 * median, MIN_DEVIATION * f->step), reach = INLIER_RANGE * deviation,
                 limit = TRUNCATION * deviation;
    for (int k = 0; k < REWEIGHTINGS; k++) {
        slanted = least_squares(p, count, slanted, reach, false);
        level = least_squares(p, count, level, reach, true);
    }
    const struct plane moved = {slanted.a, slanted.b, slanted.c - slanted.a * g->cx - slanted.b * g->cy};
    const double gain = (truncated_cost(p, count, level, limit) - truncated_cost(p, count, slanted, limit)) / deviation;
    const bool slants =
        size * gain > f->params->slant && count * gain > MIN_SLOPE_GAIN && within_samples(g, moved, p, count);
    const struct plane best = slants ? slanted : level;
    double sum = 0, quality = 0;
    int inliers = 0;
    for (int k = 0; k < count; k++) {
        const double r = residual(&p[k], best);
        quality += 1 - fmin(r / (MAX_RESIDUAL * f->step), 1);
        if (r > reach) continue;
        sum += r;
        inliers++;
    }
    f->g->planes[i] = slants ? moved : level;
    f->g->quality[i] = (float)(quality / count);
    f->g->residual[i] = inliers ? (float)(sum / inliers) : 0;
}

static void fit_segments(void *ctx, size_t begin, size_t end, int thread)
{
    const struct plane_fits *f = ctx;
    struct depth_sample *p = f->samples + f->largest * (size_t)thread;
    for (size_t i = begin; i < end; i++) {
        const struct segment *g = &f->s->segments[i];
        int count = 0;
        for (int k = 0; k < g->pixels; k++) {
            const int at = f->s->pixel[g->first + k];
            if (!(f->z[at] > 0)) continue;
            p[count++] = (struct depth_sample){at % f->s->width + 0.5 - g->cx, at / f->s->width + 0.5 - g->cy,
                                               1 / (double)f->z[at]};
        }
        f->g->known[i] = count >= MIN_SAMPLES && count >= g->pixels / MAX_PIXELS_PER_SAMPLE;
        if (f->g->known[i]) fit_segment(f, (int)i, p, count);
    }
}

enum status given_depth_make(struct given_depth *g, const struct segmentation *s, const float *z, double step,
                             const struct segment_params *params, struct err *err)
{
    const size_t count = (size_t)s->count + 1;
    struct plane_fits f = {
        .g = g, .s = s, .z = z, .step = step, .params = params, .rng = rng_make(1, "segment_depth", "given")};
    for (int i = 0; i < s->count; i++)
        if ((size_t)s->segments[i].pixels > f.largest) f.largest = (size_t)s->segments[i].pixels;
    f.samples = malloc((f.largest * (size_t)parallel_threads() + 1) * sizeof *f.samples);
    g->known = calloc(count, sizeof *g->known);
    g->planes = calloc(count, sizeof *g->planes);
    g->quality = calloc(count, sizeof *g->quality);
    g->residual = calloc(count, sizeof *g->residual);
    if (!f.samples || !g->known || !g->planes || !g->quality || !g->residual)
        err_nomem(err, "given planes", count * 40 + f.largest * sizeof *f.samples);
    if (!err->status) parallel_for((size_t)s->count, 64, fit_segments, &f);
    for (int i = 0; !err->status && i < s->count; i++) {
        const struct segment *at = &s->segments[i];
        g->segments += g->known[i];
        for (int k = 0; k < at->pixels; k++) g->pixels += z[s->pixel[at->first + k]] > 0;
    }
    free(f.samples);
    return err->status;
}

void given_depth_release(struct given_depth *g)
{
    if (!g) return;
    free(g->known);
    free(g->planes);
    free(g->quality);
    free(g->residual);
    *g = (struct given_depth){0};
}
