/* gamma_image.c - the tone curve of a view for matching: value = min(1, (exposure x linear)^power).
 *
 * The exposure brings the 98th percentile of the brightest channel to 0.95. The power is 1/2, close to a display's
 * curve; or lower, down to MIN_POWER, if the median would otherwise be darker than MIN_MEDIAN: a few bright windows
 * must not leave the room dark. As a pure power it keeps a change of exposure between two photos a constant factor. */
#include "stages/segment_depth/gamma_image.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"

#define POWER      0.5
#define MIN_POWER  0.2
#define MIN_MEDIAN 0.35 /* of the value at the exposure's percentile */

struct tone gamma_tone_of(const struct image *im)
{
    enum { SAMPLES = 1 << 14 };
    size_t pixels = (size_t)im->width * (size_t)im->height, step = pixels / SAMPLES + 1;
    float *brightest = malloc((pixels / step + 1) * sizeof *brightest);
    size_t count = 0;
    struct tone tone = {1, POWER};
    if (!brightest) return tone;
    for (size_t i = 0; i < pixels; i += step) {
        const float *p = im->data + 4 * i;
        if (p[3] >= 0.5f) brightest[count++] = fmaxf(p[0], fmaxf(p[1], p[2]));
    }
    if (count) {
        sort_floats(brightest, count);
        const double bright = (double)brightest[count - 1 - count / 50], middle = (double)brightest[count / 2];
        if (bright > 1e-12) {
            if (middle > 1e-12 * bright && middle < bright)
                tone.power = fmax(fmin(log(MIN_MEDIAN) / log(middle / bright), POWER), MIN_POWER);
            tone.exposure = pow(0.95, 1 / tone.power) / bright;
        }
    }
    free(brightest);
    return tone;
}

struct make_job {
    struct gamma_image *g;
    const struct image *linear;
    float exposure, power;
};

static float curve(float x, float power) { return power == 0.5f ? sqrtf(x) : powf(x, power); }

static void make_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct make_job *job = ctx;
    size_t width = (size_t)job->g->width;
    (void)thread;
    for (size_t i = begin * width; i < end * width; i++) {
        const float *p = job->linear->data + 4 * i;
        for (int c = 0; c < 3; c++) job->g->rgb[c][i] = curve(fminf(fmaxf(job->exposure * p[c], 0), 1), job->power);
        job->g->valid[i] = p[3] >= 0.5f;
    }
}

static enum status allocate(struct gamma_image *g, int width, int height, struct err *err)
{
    size_t pixels = (size_t)width * (size_t)height;
    *g = (struct gamma_image){.width = width, .height = height};
    bool ok = (g->valid = malloc(pixels)) != NULL;
    for (int c = 0; c < 3; c++) ok = (g->rgb[c] = malloc(pixels * sizeof(float))) && ok;
    if (ok) return ST_OK;
    gamma_image_release(g);
    return err_nomem(err, "a picture to match", pixels * 13);
}

enum status gamma_image_make(struct gamma_image *g, const struct image *linear_rgba, struct tone tone, struct err *err)
{
    if (allocate(g, linear_rgba->width, linear_rgba->height, err)) return ST_NOMEM;
    g->tone = tone;
    struct make_job job = {g, linear_rgba, (float)tone.exposure, (float)tone.power};
    parallel_for((size_t)g->height, 16, make_rows, &job);
    return ST_OK;
}

void gamma_image_release(struct gamma_image *g)
{
    if (!g) return;
    for (int c = 0; c < 3; c++) free(g->rgb[c]);
    free(g->valid);
    *g = (struct gamma_image){0};
}

enum status gamma_image_half(struct gamma_image *half, const struct gamma_image *g, struct err *err)
{
    int width = g->width > 1 ? g->width / 2 : 1, height = g->height > 1 ? g->height / 2 : 1;
    if (allocate(half, width, height, err)) return ST_NOMEM;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            size_t to = (size_t)y * (size_t)width + (size_t)x;
            float sum[3] = {0};
            half->valid[to] = 1;
            for (int k = 0; k < 4; k++) {
                int fx = 2 * x + (k & 1), fy = 2 * y + (k >> 1);
                size_t from = (size_t)(fy < g->height ? fy : g->height - 1) * (size_t)g->width +
                              (size_t)(fx < g->width ? fx : g->width - 1);
                for (int c = 0; c < 3; c++) sum[c] += g->rgb[c][from];
                half->valid[to] &= g->valid[from];
            }
            for (int c = 0; c < 3; c++) half->rgb[c][to] = sum[c] / 4;
        }
    half->tone = g->tone;
    return ST_OK;
}

enum status gamma_image_half_covering(struct gamma_image *half, const struct gamma_image *g, struct err *err)
{
    const int width = (g->width + 1) / 2, height = (g->height + 1) / 2;
    if (allocate(half, width, height, err)) return ST_NOMEM;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t to = (size_t)y * (size_t)width + (size_t)x;
            float sum[3] = {0};
            int count = 0;
            for (int k = 0; k < 4; k++) {
                const int fx = 2 * x + (k & 1), fy = 2 * y + (k >> 1);
                const size_t from = (size_t)fy * (size_t)g->width + (size_t)fx;
                if (fx >= g->width || fy >= g->height || !g->valid[from]) continue;
                for (int c = 0; c < 3; c++) sum[c] += g->rgb[c][from];
                count++;
            }
            half->valid[to] = count > 0;
            for (int c = 0; c < 3; c++) half->rgb[c][to] = count ? sum[c] / (float)count : 0;
        }
    half->tone = g->tone;
    return ST_OK;
}

enum status gamma_image_halve(struct gamma_image *g, struct err *err)
{
    struct gamma_image half;
    if (gamma_image_half(&half, g, err)) return err->status;
    gamma_image_release(g);
    *g = half;
    return ST_OK;
}

bool gamma_image_at(const struct gamma_image *g, double u, double v, float rgb[3])
{
    if (!(u >= 0 && v >= 0 && u <= g->width && v <= g->height)) return false;
    double x = fmin(fmax(u - 0.5, 0), g->width - 1), y = fmin(fmax(v - 0.5, 0), g->height - 1);
    int x0 = (int)x, y0 = (int)y;
    float fx = (float)(x - x0), fy = (float)(y - y0);
    size_t right = x0 + 1 < g->width, down = y0 + 1 < g->height ? (size_t)g->width : 0;
    size_t i = (size_t)y0 * (size_t)g->width + (size_t)x0;
    if (!g->valid[i] || !g->valid[i + right] || !g->valid[i + down] || !g->valid[i + down + right]) return false;
    for (int c = 0; c < 3; c++) {
        const float *p = g->rgb[c] + i;
        rgb[c] = (1 - fy) * ((1 - fx) * p[0] + fx * p[right]) + fy * ((1 - fx) * p[down] + fx * p[down + right]);
    }
    return true;
}
