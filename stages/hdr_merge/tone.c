/* tone.c - local tone mapping by the response of an adapted photoreceptor [Naka 1966], [Reinhard 2005].
 *
 *   s = Y / (Y + A),   ln A = a ln B + (1 - a) ln G,
 * where Y is luminance, B the local adaptation level, and G middle grey, the same for all views. s lies between 0 and 1
 * for any radiance, so nothing is clipped. s is used as the sRGB sample itself: its contrast at grey, 1/4 per e-fold,
 * is close to that of the sRGB curve. The dynamic range of B is compressed by the factor 1 - a; local contrast is kept.
 *
 * ln B is ln Y smoothed by a guided filter [He 2010] with itself as guide, at a quarter of the resolution: edges in ln
 * Y larger than EDGE are kept, so that bright windows have no halo. Colours keep SATURATION of their distance from
 * grey.
 *
 * Differs from the sources: the adaptation level is local and edge-preserving, and the global level is a constant. */
#include "stages/hdr_merge/tone.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"

enum { REDUCE = 4, CURVE = 4096 };

static const float GREY = 0.18f, FLOOR = 1e-7f, EDGE = 0.8f, SATURATION = 0.8f;
static const float ADAPTATION = 0.65f; /* a */
static const int SIDE_PER_RADIUS = 40; /* long side over the filter's radius */

struct reduced { /* a plane at reduced resolution */
    int width, height;
    float *v; /* owned */
};

static enum status init_reduced(struct reduced *s, int width, int height, struct err *err)
{
    *s = (struct reduced){width, height, calloc((size_t)width * (size_t)height, sizeof(float))};
    return s->v ? ST_OK : err_nomem(err, "a reduced picture", (size_t)width * (size_t)height * sizeof(float));
}

struct reduce_job {
    struct reduced *to;
    const struct image *from;
};

static void reduce_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct reduce_job *job = ctx;
    const struct image *im = job->from;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < job->to->width; x++) {
            float sum = 0;
            int n = 0;
            for (int dy = 0; dy < REDUCE && (int)y * REDUCE + dy < im->height; dy++)
                for (int dx = 0; dx < REDUCE && x * REDUCE + dx < im->width; dx++, n++)
                    sum += luminance_of(image_at(im, x * REDUCE + dx, (int)y * REDUCE + dy));
            job->to->v[y * (size_t)job->to->width + (size_t)x] = logf(fmaxf(sum, 0) / (float)n + FLOOR);
        }
}

/* Box means of 2 radius + 1 samples, clipped at the border, along a line of n samples `step` apart. */
static void box_line(float *line, double *sums, int n, size_t step, int radius)
{
    sums[0] = 0;
    for (int i = 0; i < n; i++) sums[i + 1] = sums[i] + (double)line[(size_t)i * step];
    for (int i = 0; i < n; i++) {
        const int from = i > radius ? i - radius : 0, to = i + radius + 1 < n ? i + radius + 1 : n;
        line[(size_t)i * step] = (float)((sums[to] - sums[from]) / (to - from));
    }
}

static void box_mean(struct reduced *s, double *sums, int radius)
{
    for (int y = 0; y < s->height; y++) box_line(s->v + (size_t)y * (size_t)s->width, sums, s->width, 1, radius);
    for (int x = 0; x < s->width; x++) box_line(s->v + x, sums, s->height, (size_t)s->width, radius);
}

/* The guided filter's mean coefficients: ln B = slope ln Y + offset. `level` is ln Y on entry and is overwritten. */
static enum status guided_filter(struct reduced *slope, struct reduced *offset, struct reduced *level, int radius,
                                 struct err *err)
{
    const size_t count = (size_t)level->width * (size_t)level->height;
    const int side = level->width > level->height ? level->width : level->height;
    double *sums = malloc(((size_t)side + 1) * sizeof *sums);
    if (!sums) return err_nomem(err, "sums", ((size_t)side + 1) * sizeof *sums);
    for (size_t i = 0; i < count; i++) slope->v[i] = level->v[i] * level->v[i];
    box_mean(slope, sums, radius);
    box_mean(level, sums, radius);
    for (size_t i = 0; i < count; i++) {
        const float mean = level->v[i], variance = fmaxf(slope->v[i] - mean * mean, 0);
        slope->v[i] = variance / (variance + EDGE * EDGE);
        offset->v[i] = mean * (1 - slope->v[i]);
    }
    box_mean(slope, sums, radius);
    box_mean(offset, sums, radius);
    free(sums);
    return ST_OK;
}

struct tone_job {
    unsigned char *to;
    const struct image *from;
    const struct reduced *slope, *offset;
    float code_from_light[CURVE + 1], light_from_code[CURVE + 1]; /* sRGB */
};

/* Bilinear interpolation between the centres of the reduced pixels. */
static float upsampled(const struct reduced *s, float x, float y)
{
    const float fx = fminf(fmaxf((x + 0.5f) / REDUCE - 0.5f, 0), (float)(s->width - 1)),
                fy = fminf(fmaxf((y + 0.5f) / REDUCE - 0.5f, 0), (float)(s->height - 1));
    const int x0 = (int)fx, y0 = (int)fy, x1 = x0 + 1 < s->width ? x0 + 1 : x0, y1 = y0 + 1 < s->height ? y0 + 1 : y0;
    const float u = fx - (float)x0, v = fy - (float)y0;
    const float *a = s->v + (size_t)y0 * (size_t)s->width, *b = s->v + (size_t)y1 * (size_t)s->width;
    return (a[x0] + (a[x1] - a[x0]) * u) * (1 - v) + (b[x0] + (b[x1] - b[x0]) * u) * v;
}

static float interpolate(const float *table, float at)
{
    const float scaled = fminf(fmaxf(at, 0), 1) * CURVE;
    const int below = scaled < CURVE - 1 ? (int)scaled : CURVE - 1;
    return table[below] + (table[below + 1] - table[below]) * (scaled - (float)below);
}

static void tone_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct tone_job *job = ctx;
    const struct image *im = job->from;
    const float grey = logf(GREY);
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < im->width; x++) {
            const float *rgb = image_at(im, x, (int)y), light = luminance_of(rgb),
                        level = logf(fmaxf(light, 0) + FLOOR);
            const float base =
                upsampled(job->slope, (float)x, (float)y) * level + upsampled(job->offset, (float)x, (float)y);
            const float sample = 1 / (1 + expf(ADAPTATION * base + (1 - ADAPTATION) * grey - level));
            const float mapped = interpolate(job->light_from_code, sample); /* luminance */
            unsigned char *to = job->to + 3 * (y * (size_t)im->width + (size_t)x);
            for (int c = 0; c < 3; c++) {
                const float ratio = light > 0 ? rgb[c] / light : 1;
                const float code = interpolate(job->code_from_light, mapped * (1 + SATURATION * (ratio - 1)));
                to[c] = (unsigned char)(255 * code + 0.5f);
            }
        }
}

enum status tone_map(unsigned char *rgb, const struct image *radiance, struct err *err)
{
    const int width = (radiance->width + REDUCE - 1) / REDUCE, height = (radiance->height + REDUCE - 1) / REDUCE;
    const int side = width > height ? width : height, radius = side / SIDE_PER_RADIUS > 1 ? side / SIDE_PER_RADIUS : 1;
    struct reduced level = {0}, slope = {0}, offset = {0};
    struct tone_job *job = malloc(sizeof *job);
    if (!job) err_nomem(err, "a tone curve", sizeof *job);
    if (!err->status && !init_reduced(&level, width, height, err) && !init_reduced(&slope, width, height, err))
        init_reduced(&offset, width, height, err);
    if (!err->status) {
        parallel_for((size_t)height, 8, reduce_rows, &(struct reduce_job){&level, radiance});
        guided_filter(&slope, &offset, &level, radius, err);
    }
    if (!err->status) {
        *job = (struct tone_job){.to = rgb, .from = radiance, .slope = &slope, .offset = &offset};
        for (int i = 0; i <= CURVE; i++) {
            job->code_from_light[i] = srgb_from_linear((float)i / CURVE);
            job->light_from_code[i] = linear_from_srgb((float)i / CURVE);
        }
        parallel_for((size_t)radiance->height, 8, tone_rows, job);
    }
    free(level.v);
    free(slope.v);
    free(offset.v);
    free(job);
    return err->status;
}
