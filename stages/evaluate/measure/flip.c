/* flip.c - FLIP of pictures of low dynamic range [Andersson 2020], from the paper's formulas.
 *
 * Colour. Both pictures go to the opponent space YCxCz, linear in XYZ, and are blurred by what the eye resolves at this
 * number of pixels per degree: each channel by a sum of Gaussians
 *     g(d) = a1 sqrt(pi / b1) exp(-pi^2 d^2 / b1) + a2 sqrt(pi / b2) exp(-pi^2 d^2 / b2),    d in degrees.
 * Then, clamped to RGB, they go to L*a*b*, where a and b shrink with the lightness (Hunt's effect). Their distance is
 * abs(dL) + hypot(da, db), to the power 0.7; it is compressed so that 0.4 of the largest distance, that of green and
 * blue, becomes 0.95.
 * Features. Edges and points of the lightness before the blur, by first and second derivatives of a Gaussian of 0.082
 * degrees: the larger difference of their magnitudes, over sqrt 2, to the power 0.5.
 * The difference of a pixel is colour ^ (1 - features).
 *
 * All kernels are separable: the sum of two Gaussians is filtered as two, and the positive and the negative weights of
 * a derivative are normalised along one axis alone, which is the same as in the plane. Borders are repeated. */
#include "stages/evaluate/measure/flip.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/image/image.h"

enum { MAX_RADIUS = 16, CHUNK_ROWS = 16 };

#define FEATURE_WIDTH 0.082 /* degrees */

struct kernel { /* centre at MAX_RADIUS */
    int radius;
    float tap[2 * MAX_RADIUS + 1];
};

struct flip_job {
    int width, height;
    const uint8_t *reference, *test, *mask;
    float *opponent[2]; /* Y Cx Cz of both pictures: three planes each */
    float *blurred[2];
    float *feature[2];  /* magnitudes of edges and points: two planes each */
    float *rows, *more; /* scratch, a plane each */
    double *sums;       /* of each chunk */
    double largest;     /* distance of green and blue */
};

/* --------------------------------------------------------------------------------------------------------- colours */

static const double xyz_from_rgb[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                          {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                          {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
static const double rgb_from_xyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                          {-0.969224334, 1.875930071, 0.041554224},
                                          {0.055639423, -0.204011202, 1.057148933}};

static void multiply(double out[3], const double m[3][3], const double v[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

/* X / Xn, Y / Yn, Z / Zn of linear RGB. */
static void relative_xyz(double out[3], const double rgb[3])
{
    multiply(out, xyz_from_rgb, rgb);
    for (int i = 0; i < 3; i++) out[i] /= xyz_from_rgb[i][0] + xyz_from_rgb[i][1] + xyz_from_rgb[i][2];
}

static double lab_curve(double t)
{
    const double delta = 6.0 / 29;
    return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/* L*, and a* and b* with Hunt's effect. */
static void hunt_lab(double lab[3], const double rgb[3])
{
    double f[3];
    relative_xyz(f, rgb);
    for (int i = 0; i < 3; i++) f[i] = lab_curve(f[i]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200 * (f[1] - f[2]);
}

static double colour_distance(const double a[3], const double b[3])
{
    double p[3], q[3];
    hunt_lab(p, a);
    hunt_lab(q, b);
    return pow(fabs(p[0] - q[0]) + hypot(p[1] - q[1], p[2] - q[2]), 0.7);
}

static double compress(double distance, double largest)
{
    const double knee = 0.4 * largest, value = 0.95;
    return distance < knee ? value / knee * distance : value + (1 - value) * (distance - knee) / (largest - knee);
}

/* Linear RGB of an opponent colour, clamped. */
static void rgb_of(double rgb[3], const float *opponent, size_t pixels)
{
    const double y = ((double)opponent[0] + 16) / 116;
    const double relative[3] = {y + (double)opponent[pixels] / 500, y, y - (double)opponent[2 * pixels] / 200};
    double xyz[3];
    for (int i = 0; i < 3; i++) xyz[i] = relative[i] * (xyz_from_rgb[i][0] + xyz_from_rgb[i][1] + xyz_from_rgb[i][2]);
    multiply(rgb, rgb_from_xyz, xyz);
    for (int i = 0; i < 3; i++) rgb[i] = fmin(fmax(rgb[i], 0), 1);
}

static void opponent_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct flip_job *job = ctx;
    const size_t width = (size_t)job->width, pixels = width * (size_t)job->height;
    (void)thread;
    for (size_t p = begin * width; p < end * width; p++)
        for (int k = 0; k < 2; k++) {
            const uint8_t *bytes = k && (!job->mask || job->mask[p]) ? job->test : job->reference;
            double rgb[3], t[3];
            for (size_t c = 0; c < 3; c++) rgb[c] = (double)linear_from_srgb((float)bytes[3 * p + c] / 255);
            relative_xyz(t, rgb);
            job->opponent[k][p] = (float)(116 * t[1] - 16);
            job->opponent[k][pixels + p] = (float)(500 * (t[0] - t[1]));
            job->opponent[k][2 * pixels + p] = (float)(200 * (t[1] - t[2]));
        }
}

/* --------------------------------------------------------------------------------------------------------- filters */

struct filter_job {
    float *to;
    const float *from;
    const struct kernel *kernel;
    int width, height;
    bool down, adds;
    float factor;
};

static void filter_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct filter_job *f = ctx;
    const int r = f->kernel->radius;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < f->width; x++) {
            const int at = f->down ? y : x, last = (f->down ? f->height : f->width) - 1;
            float sum = 0;
            for (int k = -r; k <= r; k++) {
                const int i = at + k < 0 ? 0 : at + k > last ? last : at + k;
                const size_t p =
                    f->down ? (size_t)i * (size_t)f->width + (size_t)x : (size_t)y * (size_t)f->width + (size_t)i;
                sum += f->kernel->tap[MAX_RADIUS + k] * f->from[p];
            }
            float *to = f->to + (size_t)y * (size_t)f->width + (size_t)x;
            *to = f->adds ? *to + f->factor * sum : f->factor * sum;
        }
}

/* to = factor * (from filtered by `across` along rows and `down` along columns), added to what is there if `adds`. */
static void filter(struct flip_job *job, float *to, const float *from, const struct kernel *across,
                   const struct kernel *down, float factor, bool adds)
{
    struct filter_job f = {job->rows, from, across, job->width, job->height, false, false, 1};
    parallel_for((size_t)job->height, CHUNK_ROWS, filter_rows, &f);
    f = (struct filter_job){to, job->rows, down, job->width, job->height, true, adds, factor};
    parallel_for((size_t)job->height, CHUNK_ROWS, filter_rows, &f);
}

/* exp(-s d^2), d in degrees; returns the sum of its taps, which are divided by it. */
static double gaussian(struct kernel *k, int radius, double s)
{
    double sum = 0;
    k->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        const double d = i / FLIP_PIXELS_PER_DEGREE;
        sum += exp(-s * d * d);
    }
    for (int i = -radius; i <= radius; i++) {
        const double d = i / FLIP_PIXELS_PER_DEGREE;
        k->tap[MAX_RADIUS + i] = (float)(exp(-s * d * d) / sum);
    }
    return sum;
}

/* Blurs the channels of picture k as the eye does. */
static void blur(struct flip_job *job, int k)
{
    static const double params[3][4] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    const double pi = acos(-1);
    const int radius = (int)ceil(3 * sqrt(0.04 / (2 * pi * pi)) * FLIP_PIXELS_PER_DEGREE);
    const size_t pixels = (size_t)job->width * (size_t)job->height;
    for (size_t c = 0; c < 3; c++) {
        const double *p = params[c];
        struct kernel narrow, wide;
        const double s1 = gaussian(&wide, radius, pi * pi / p[1]), s2 = gaussian(&narrow, radius, pi * pi / p[3]);
        const double w1 = p[0] * sqrt(pi / p[1]) * s1 * s1, w2 = p[2] * sqrt(pi / p[3]) * s2 * s2;
        const float *from = job->opponent[k] + c * pixels;
        float *to = job->blurred[k] + c * pixels;
        filter(job, to, from, &wide, &wide, (float)(w1 / (w1 + w2)), false);
        if (w2 > 0) filter(job, to, from, &narrow, &narrow, (float)(w2 / (w1 + w2)), true);
    }
}

/* First or second derivative of a Gaussian of this deviation, px; positive and negative taps each sum to 1. */
static void derivative(struct kernel *k, int radius, double deviation, bool second)
{
    double positive = 0, negative = 0, tap[2 * MAX_RADIUS + 1];
    k->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        const double t = i / deviation, value = (second ? t * t - 1 : -i) * exp(-t * t / 2);
        tap[MAX_RADIUS + i] = value;
        *(value > 0 ? &positive : &negative) += fabs(value);
    }
    for (int i = -radius; i <= radius; i++)
        k->tap[MAX_RADIUS + i] = (float)(tap[MAX_RADIUS + i] / (tap[MAX_RADIUS + i] > 0 ? positive : negative));
}

static void find_features(struct flip_job *job, int k)
{
    const double deviation = 0.5 * FEATURE_WIDTH * FLIP_PIXELS_PER_DEGREE;
    const double pixels_per_degree = FLIP_PIXELS_PER_DEGREE;
    const int radius = (int)ceil(3 * deviation);
    const size_t pixels = (size_t)job->width * (size_t)job->height;
    const double scale = pixels_per_degree / deviation;
    struct kernel smooth, slope;
    gaussian(&smooth, radius, scale * scale / 2);
    for (int second = 0; second < 2; second++) {
        float *to = job->feature[k] + (size_t)second * pixels;
        derivative(&slope, radius, deviation, second);
        filter(job, to, job->opponent[k], &slope, &smooth, 1.0F / 116, false);
        filter(job, job->more, job->opponent[k], &smooth, &slope, 1.0F / 116, false);
        for (size_t p = 0; p < pixels; p++) to[p] = hypotf(to[p], job->more[p]);
    }
}

/* ----------------------------------------------------------------------------------------------------- differences */

static double difference(const struct flip_job *job, size_t p)
{
    const size_t pixels = (size_t)job->width * (size_t)job->height;
    double a[3], b[3];
    rgb_of(a, job->blurred[0] + p, pixels);
    rgb_of(b, job->blurred[1] + p, pixels);
    const double colour = compress(colour_distance(a, b), job->largest);
    const double edges = fabs((double)job->feature[0][p] - (double)job->feature[1][p]);
    const double points = fabs((double)job->feature[0][pixels + p] - (double)job->feature[1][pixels + p]);
    const double features = fmin(1, sqrt(fmax(edges, points) / sqrt(2)));
    return colour > 0 ? pow(colour, 1 - features) : 0;
}

static void sum_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flip_job *job = ctx;
    const size_t width = (size_t)job->width;
    double sum = 0;
    (void)thread;
    for (size_t p = begin * width; p < end * width; p++)
        if (!job->mask || job->mask[p]) sum += difference(job, p);
    job->sums[begin / CHUNK_ROWS] = sum;
}

enum status flip_mean(const uint8_t *reference, const uint8_t *test, int width, int height, const uint8_t *mask,
                      double *mean, struct err *err)
{
    static const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    const size_t pixels = (size_t)width * (size_t)height, planes = 2 * (3 + 3 + 2) + 2;
    const size_t chunks = ((size_t)height + CHUNK_ROWS - 1) / CHUNK_ROWS;
    struct flip_job job = {.width = width, .height = height, .reference = reference, .test = test, .mask = mask};
    size_t count = 0;
    double sum = 0;
    for (size_t p = 0; p < pixels; p++) count += !mask || mask[p];
    if (!count) return err_set(err, ST_DATA, "no pixel is compared; wanted one or more.");
    float *buffer = malloc(planes * pixels * sizeof *buffer);
    job.sums = malloc(chunks * sizeof *job.sums);
    if (!buffer || !job.sums) {
        free(buffer);
        free(job.sums);
        return err_nomem(err, "pictures", planes * pixels * sizeof *buffer);
    }
    for (size_t k = 0; k < 2; k++) {
        job.opponent[k] = buffer + 3 * k * pixels;
        job.blurred[k] = buffer + (6 + 3 * k) * pixels;
        job.feature[k] = buffer + (12 + 2 * k) * pixels;
    }
    job.rows = buffer + 16 * pixels;
    job.more = buffer + 17 * pixels;
    job.largest = colour_distance(green, blue);
    parallel_for((size_t)height, CHUNK_ROWS, opponent_rows, &job);
    for (int k = 0; k < 2; k++) {
        blur(&job, k);
        find_features(&job, k);
    }
    parallel_for((size_t)height, CHUNK_ROWS, sum_rows, &job);
    for (size_t i = 0; i < chunks; i++) sum += job.sums[i];
    *mean = sum / (double)count;
    free(buffer);
    free(job.sums);
    return ST_OK;
}
