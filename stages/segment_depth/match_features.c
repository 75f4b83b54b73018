/* match_features.c - colours, and gradients at two scales, as bytes.
 *
 * Gradients are divided by the root mean square gradient of their surroundings plus the picture's noise: so weak
 * texture counts, a change of exposure does not, and noise is not amplified. In noisy pictures the coarse gradients, of
 * the smoothed luma, take over from the fine ones.
 *
 * The noise is a low quantile of the second differences of [Immerkaer 1996]; the source takes the mean, but texture
 * is in the upper quantiles. */
#include "stages/segment_depth/match_features.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

#define WINDOW_RADIUS     1     /* px: half width of the window that gradients are normalized in */
#define DEVIATION         20.0f /* grey levels of a normalized gradient's standard deviation */
#define MIN_NOISE         1.5f  /* grey levels */
#define COARSE_NOISE      0.3f  /* of the noise remains in coarse gradients */
#define HALF_COARSE_NOISE 3.0f  /* grey levels of noise at which coarse gradients have half of their full amplitude */

static uint8_t byte_from(float x) { return (uint8_t)(x <= 0 ? 0 : x >= 255 ? 255 : x + 0.5f); }

struct feature_job {
    const struct gamma_image *g;
    const float *luma, *smooth, *fine_scale, *coarse_scale; /* scales: of gradients to bytes */
    float gain[3];
    float jacobian[2][2];
    uint8_t *packed; /* FEATURE_CHANNELS per pixel */
};

static void gradient(float out[2], const float jacobian[2][2], const float *luma, int w, int h, int x, int y, int step)
{
    float gx = luma[y * w + clamp_int(x + step, 0, w - 1)] - luma[y * w + clamp_int(x - step, 0, w - 1)];
    float gy = luma[clamp_int(y + step, 0, h - 1) * w + x] - luma[clamp_int(y - step, 0, h - 1) * w + x];
    out[0] = jacobian[0][0] * gx + jacobian[0][1] * gy;
    out[1] = jacobian[1][0] * gx + jacobian[1][1] * gy;
}

/* Running mean of 2 r + 1 values of a row or column, in place; the ends are repeated. line: scratch of `count`
 * floats. */
static void box_line(float *at, int count, size_t step, float *line, int r)
{
    double sum = 0;
    for (int i = 0; i < count; i++) line[i] = at[(size_t)i * step];
    for (int i = -r; i <= r; i++) sum += (double)line[clamp_int(i, 0, count - 1)];
    for (int i = 0; i < count; i++) {
        at[(size_t)i * step] = (float)(sum / (2 * r + 1));
        sum += (double)line[clamp_int(i + r + 1, 0, count - 1)] - (double)line[clamp_int(i - r, 0, count - 1)];
    }
}

/* The factor that normalizes gradients to a standard deviation of `deviation` grey levels in their window. */
static void gradient_scale(float *scale, const float jacobian[2][2], const float *luma, float *line, int w, int h,
                           int step, float deviation, float noise)
{
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            float d[2];
            gradient(d, jacobian, luma, w, h, x, y, step);
            scale[(size_t)y * (size_t)w + (size_t)x] = 0.5f * (d[0] * d[0] + d[1] * d[1]);
        }
    for (int y = 0; y < h; y++) box_line(scale + (size_t)y * (size_t)w, w, 1, line, WINDOW_RADIUS);
    for (int x = 0; x < w; x++) box_line(scale + x, h, (size_t)w, line, WINDOW_RADIUS);
    for (size_t i = 0; i < (size_t)w * (size_t)h; i++) scale[i] = deviation / (sqrtf(fmaxf(scale[i], 0)) + noise / 255);
}

static void feature_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct feature_job *job = ctx;
    int w = job->g->width;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < w; x++) {
            size_t i = (size_t)y * (size_t)w + (size_t)x;
            uint8_t *p = job->packed + FEATURE_CHANNELS * i;
            float fine[2], coarse[2];
            gradient(fine, job->jacobian, job->luma, w, job->g->height, x, y, 1);
            gradient(coarse, job->jacobian, job->smooth, w, job->g->height, x, y, 2);
            for (int c = 0; c < 3; c++) p[c] = byte_from(255 * job->gain[c] * job->g->rgb[c][i]);
            for (int c = 0; c < 2; c++) {
                p[3 + c] = byte_from(128 + job->fine_scale[i] * fine[c]);
                p[5 + c] = byte_from(128 + job->coarse_scale[i] * coarse[c]);
            }
            p[7] = job->g->valid[i] ? 255 : 0;
        }
}

/* Smooths by (1 4 6 4 1)/16 in both directions. from and to differ; line: scratch of w * h floats. */
static void smooth_luma(float *to, const float *from, float *line, int w, int h)
{
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const float *p = from + (size_t)y * (size_t)w;
            line[(size_t)y * (size_t)w + (size_t)x] =
                0.375f * p[x] + 0.25f * (p[clamp_int(x - 1, 0, w - 1)] + p[clamp_int(x + 1, 0, w - 1)]) +
                0.0625f * (p[clamp_int(x - 2, 0, w - 1)] + p[clamp_int(x + 2, 0, w - 1)]);
        }
    for (int y = 0; y < h; y++) {
        const float *p[5];
        for (int k = 0; k < 5; k++) p[k] = line + (size_t)clamp_int(y + k - 2, 0, h - 1) * (size_t)w;
        float *q = to + (size_t)y * (size_t)w;
        for (int x = 0; x < w; x++)
            q[x] = 0.375f * p[2][x] + 0.25f * (p[1][x] + p[3][x]) + 0.0625f * (p[0][x] + p[4][x]);
    }
}

float match_image_noise(const struct gamma_image *g)
{
    enum { BINS = 512, BINS_PER_LEVEL = 16 };
    const int w = g->width;
    size_t count[BINS] = {0}, all = 0, below = 0;
    for (int y = 1; y + 1 < g->height; y++)
        for (int x = 1; x + 1 < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x;
            const float *p = g->rgb[1] + i;
            if (!g->valid[i] || !(p[0] > 0.02f && p[0] < 0.98f)) continue; /* clipped pixels have no noise */
            const float corners = p[-w - 1] + p[-w + 1] + p[w - 1] + p[w + 1], sides = p[-w] + p[w] + p[-1] + p[1];
            const float off = fabsf(corners - 2 * sides + 4 * p[0]) * (255.0f / 6);
            count[off < (float)(BINS - 1) / BINS_PER_LEVEL ? (int)(off * BINS_PER_LEVEL) : BINS - 1]++;
            all++;
        }
    int bin = 0;
    while (bin < BINS - 1 && (below += count[bin]) < all / 5) bin++;
    return all ? ((float)bin + 0.5f) / BINS_PER_LEVEL / 0.2533f
               : 0; /* a fifth of a normal distribution lies within 0.2533 deviations */
}

uint8_t *match_features(const struct gamma_image *g, const double gain[3], double jacobian[2][2], float noise)
{
    size_t pixels = (size_t)g->width * (size_t)g->height;
    size_t longest = (size_t)(g->width > g->height ? g->width : g->height);
    float *luma = malloc((4 * pixels + longest) * sizeof *luma);
    uint8_t *packed = malloc(FEATURE_CHANNELS * pixels);
    if (!luma || !packed) {
        free(luma);
        free(packed);
        return NULL;
    }
    for (size_t i = 0; i < pixels; i++)
        luma[i] = (float)(0.3 * gain[0]) * g->rgb[0][i] + (float)(0.6 * gain[1]) * g->rgb[1][i] +
                  (float)(0.1 * gain[2]) * g->rgb[2][i];
    float *smooth = luma + pixels, *fine = luma + 2 * pixels, *coarse = luma + 3 * pixels, *line = luma + 4 * pixels;
    smooth_luma(smooth, luma, fine, g->width, g->height);
    struct feature_job job = {
        .g = g, .luma = luma, .smooth = smooth, .fine_scale = fine, .coarse_scale = coarse, .packed = packed};
    for (int c = 0; c < 3; c++) job.gain[c] = (float)gain[c];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) job.jacobian[i][j] = (float)jacobian[i][j];
    const float effective_noise = fmaxf(noise, MIN_NOISE),
                coarse_part = noise * noise / (noise * noise + HALF_COARSE_NOISE * HALF_COARSE_NOISE);
    gradient_scale(fine, job.jacobian, luma, line, g->width, g->height, 1, DEVIATION, effective_noise);
    gradient_scale(coarse, job.jacobian, smooth, line, g->width, g->height, 2, DEVIATION * coarse_part,
                   fmaxf(COARSE_NOISE * noise, MIN_NOISE));
    parallel_for((size_t)g->height, 16, feature_rows, &job);
    free(luma);
    return packed;
}
