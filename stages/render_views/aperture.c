/* aperture.c - depth of field by averaging pinhole frames over a lens [Colburn 2014, 3.6.2].
 *
 * A pinhole at the lens's centre sees the camera point (X, Y, Z) at u = fx X / Z + cx. From the lens point (a, b), an
 * offset of the centre in the camera's x and y, with the principal point moved by fx a / focus, the point is at
 *   u' = fx (X - a) / Z + cx + fx a / focus = u + fx a (1 / focus - 1 / Z) = u + fx a (Z - focus) / (Z focus)
 * and likewise v with fy and b. At Z = focus this is exactly u, so frames are averaged without warping them; elsewhere
 * the lens's disk, |(a, b)| <= aperture / 2, becomes the circle of confusion, of diameter
 * aperture fx |Z - focus| / (Z focus) px. The surface in focus is a plane parallel to the picture.
 *
 * Lens samples: the first two dimensions of the Sobol sequence [Sobol 1967] with Owen scrambling [Owen 1995], mapped to
 * the disk with equal areas [Shirley 1997]. All frames use the same samples, so that the result does not flicker. On
 * smooth functions of the lens the error of their mean, at 32 and more samples, is half that of the R2 sequence, and
 * the difference between halves predicts it better.
 *
 * The thesis jitters views around the lens's centre, and leaves their number open. Here it adapts: samples are added in
 * batches, from 8 on, each of which doubles their number. With A and B the means of the n_A samples before the last
 * batch and of the n_B samples in it, the error of the whole mean is about |A - B| sqrt(n_A n_B) / (n_A + n_B). Its
 * root mean square is taken over each 32x32 tile, on square roots of colours clipped at white; the frame's error is the
 * 98th percentile of the tiles, so that a small blurred part counts in a picture that is mostly sharp. */
#include "stages/render_views/aperture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/sort.h"

#define FIRST_BATCH 8 /* samples before the first estimate: two halves */
#define TILE        32
#define PERCENTILE  0.98
#define SOBOL_BITS  20

/* Owen scrambling: each bit is flipped at random, keyed by the bits above it. */
static double scrambled(uint32_t bits, uint64_t dimension)
{
    const struct rng rng = rng_make(0, "render_views", "aperture");
    uint32_t result = 0;

    for (uint32_t k = 0; k < SOBOL_BITS; k++) {
        const uint32_t above = 1u << k | (k ? bits >> (32 - k) : 0);
        result |= ((bits >> (31 - k) ^ rng_u32(&rng, dimension, above)) & 1) << (31 - k);
    }
    return (result + 0.5 * (1u << (32 - SOBOL_BITS))) * 0x1p-32;
}

void aperture_lens_point(int index, double *x, double *y)
{
    uint32_t bits[2] = {0}, row = 1u << 31; /* row: of the second generator matrix, Pascal's triangle mod 2 */
    double square[2];

    for (uint32_t i = (uint32_t)index, k = 31; i; i >>= 1, k--, row ^= row >> 1) {
        if (!(i & 1)) continue;
        bits[0] |= 1u << k;
        bits[1] ^= row;
    }
    for (int k = 0; k < 2; k++) square[k] = 2 * scrambled(bits[k], (uint64_t)k) - 1;
    /* concentric squares to concentric circles */
    const bool wide = fabs(square[0]) > fabs(square[1]);
    const double radius = wide ? square[0] : square[1];
    const double angle = radius == 0 ? 0 : (wide ? square[1] : square[0]) / radius * (M_PI / 4);
    *x = radius * (wide ? cos(angle) : sin(angle));
    *y = radius * (wide ? sin(angle) : cos(angle));
}

struct lens_sums {
    const float *from;     /* the frame to add */
    float *before, *batch; /* sums over the samples before the last batch, and in it */
    float *mean;
    double before_scale, batch_scale; /* 1 / number of samples */
};

static void add_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct lens_sums *s = ctx;
    float *restrict to = s->batch;
    const float *restrict from = s->from;
    (void)thread;
    for (size_t i = begin; i < end; i++) to[i] += from[i];
}

static void merge_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct lens_sums *s = ctx;
    float *restrict before = s->before, *restrict batch = s->batch;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        before[i] += batch[i];
        batch[i] = 0;
    }
}

static void mean_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct lens_sums *s = ctx;
    const float *restrict before = s->before, scale = (float)s->before_scale;
    float *restrict mean = s->mean;
    (void)thread;
    for (size_t i = begin; i < end; i++) mean[i] = before[i] * scale;
}

#define CHUNK 65536

struct error_tiles {
    const struct lens_sums *sums;
    int width, height, across;
    float *error; /* mean square of each tile */
};

static float encoded(float linear) { return sqrtf(linear < 1 ? (linear > 0 ? linear : 0) : 1); }

static void tile_errors(void *ctx, size_t begin, size_t end, int thread)
{
    const struct error_tiles *t = ctx;
    const float a = (float)t->sums->before_scale, b = (float)t->sums->batch_scale;
    (void)thread;

    for (size_t i = begin; i < end; i++) {
        const int x0 = (int)i % t->across * TILE, y0 = (int)i / t->across * TILE;
        const int x1 = x0 + TILE < t->width ? x0 + TILE : t->width, y1 = y0 + TILE < t->height ? y0 + TILE : t->height;
        float sum = 0;
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++) {
                const size_t p = 4 * ((size_t)y * (size_t)t->width + (size_t)x);
                for (size_t k = 0; k < 3; k++) {
                    const float d = encoded(a * t->sums->before[p + k]) - encoded(b * t->sums->batch[p + k]);
                    sum += d * d;
                }
            }
        t->error[i] = sum / (float)(3 * (x1 - x0) * (y1 - y0));
    }
}

static double error_of_mean(const struct lens_sums *s, struct error_tiles *t, int before, int batch)
{
    const int count = t->across * ((t->height + TILE - 1) / TILE);
    struct lens_sums means = *s;

    means.before_scale = 1.0 / before;
    means.batch_scale = 1.0 / batch;
    t->sums = &means;
    parallel_for((size_t)count, 16, tile_errors, t);
    sort_floats(t->error, (size_t)count);
    return sqrt(t->error[(int)(PERCENTILE * (count - 1))]) * sqrt((double)before * batch) / (before + batch);
}

enum status aperture_render(struct rendered_frame *out, const struct view *camera, double aperture, double focus,
                            const struct aperture_options *options, aperture_pinhole *render, void *ctx,
                            struct aperture_stats *stats, struct err *err)
{
    struct rendered_frame frame = {0};
    struct aperture_stats done = {0, 0};
    struct lens_sums sums = {0};
    struct error_tiles tiles = {0};

    if (!(aperture >= 0) || !isfinite(aperture))
        return err_set(err, ST_DATA, "the aperture of frame %s is %g: wanted a diameter of 0 or more.",
                       camera->name ? camera->name : "", aperture);
    if (aperture > 0 && !(focus > 0 && isfinite(focus)))
        return err_set(err, ST_DATA,
                       "the focus of frame %s is %g: wanted a depth above 0, because its aperture is open.",
                       camera->name ? camera->name : "", focus);
    if (render(ctx, camera, out, err) || aperture == 0) goto done;

    done.error = 1;
    const size_t samples = 4 * (size_t)out->width * (size_t)out->height;
    tiles.width = out->width;
    tiles.height = out->height;
    tiles.across = (out->width + TILE - 1) / TILE;
    sums.before = calloc(samples, sizeof *sums.before);
    sums.batch = calloc(samples, sizeof *sums.batch);
    tiles.error = malloc((size_t)tiles.across * (size_t)((out->height + TILE - 1) / TILE) * sizeof *tiles.error);
    if (!sums.before || !sums.batch || !tiles.error) {
        err_nomem(err, "the mean of a lens's frames", 2 * samples * sizeof *sums.before);
        goto done;
    }
    int before = 0, count = 0; /* samples before this batch, and with it */
    while (count < options->max_samples) {
        const int until = before ? 2 * before : FIRST_BATCH / 2;
        while (count < until && count < options->max_samples) {
            double x, y;
            aperture_lens_point(count, &x, &y);
            const struct view at = view_from_lens_point(camera, x * aperture / 2, y * aperture / 2, focus);
            render(ctx, &at, &frame, err);
            if (!err->status && (frame.width != out->width || frame.height != out->height))
                err_set(err, ST_INTERNAL, "frames of one lens have different sizes.");
            if (err->status) goto done;
            sums.from = frame.rgba;
            parallel_for(samples, CHUNK, add_chunk, &sums);
            count++;
        }
        if (before) done.error = error_of_mean(&sums, &tiles, before, count - before);
        parallel_for(samples, CHUNK, merge_chunk, &sums);
        before = count;
        if (count >= FIRST_BATCH && done.error < options->max_error) break;
    }
    done.samples = count;
    sums.before_scale = 1.0 / done.samples;
    sums.mean = out->rgba;
    parallel_for(samples, CHUNK, mean_chunk, &sums);
done:
    if (!err->status && stats) *stats = done;
    rendered_frame_release(&frame);
    free(sums.before);
    free(sums.batch);
    free(tiles.error);
    return err->status;
}
