/* merge.c - merges exposures into linear radiance by a weighted mean [Debevec 1997].
 *
 * A sample v (linear, 1 is white) at exposure t estimates the radiance x as v / t. Its noise (bracket_noise.h) has a
 * part proportional to the light and a constant part: var(v) = photon v + read^2. The optimal weight of v / t is the
 * inverse of its variance, 1 / var(v / t) = t^2 / (photon t x + read^2).
 *
 * Weights computed from the noisy samples themselves would bias the mean. So there are two rounds. The first has
 * weights t, for which the mean is sum(v) / sum(t), already nearly optimal. The second computes noise, saturation and
 * darkness from the prediction t x of the first. (If photos do not follow the curve, the two disagree. The weight for
 * saturation is then the smaller of those of sample and prediction, so that the result has no steps.)
 *
 * Saturation applies to the whole pixel: if one colour saturates, JPEG's chroma channels spoil the others. A pixel with
 * a saturated colour in every exposure is merged per colour. A colour that still has no weight is taken from one
 * exposure: the shortest if all saturate (a lower bound), otherwise the longest that does not saturate, but no less
 * than the bound of the saturated ones. Both cases are marked.
 *
 * With weights w, the mean sum(w v) / sum(w t) has the variance sum(w^2 var(v)) / sum(w t)^2. That of the luminance is
 * the sum over independent colours, times a measured factor for colours that share their noise (bracket_noise.c).
 *
 * Differs from the source, which has hat weights on the samples' own values and a logarithmic mean: weights follow
 * noise and prediction, and the mean is of radiance, which has no bias towards dark samples.
 *
 * Blocks of pixels are processed in plain loops over planes, which the compiler vectorizes; pixels that are merged per
 * colour or have a colour without weight are then done one by one. */
#include "stages/hdr_merge/merge.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"

#define PARAM_STRUCT struct merge_params
const struct param merge_param_table[] = {MERGE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { ROWS = 8, BLOCK = 64 };

static const float SATURATED_FROM = 0.8f; /* of `saturated`: the weight falls from here */
static const float DARK_UNTIL = 3;        /* of `dark`: the weight rises to here */
static const float ABSENT = -1e30f;       /* the shifted exposure does not cover this pixel */
static const float luma[3] = LUMINANCE_WEIGHTS;

struct exposure_job {
    const uint16_t *samples;
    const float *values;    /* instead of samples: linear already */
    const float *tables[3]; /* linear value of a sample */
    float t;
    int dx, dy;
    float saturated, trusted, falling; /* weight 0 from `saturated`, 1 below `trusted` */
    float dark, rising;                /* weight 0 up to `dark` */
    float photon, read2;
};

struct merge_job {
    struct merged *out;
    struct exposure_job exposures[MERGE_MAX_EXPOSURES]; /* ascending in t */
    int count;
    float luminance; /* variance of the luminance's noise, divided by what independent colours would give */
};

static inline float clamp01(float v)
{
    const float low = v > 0 ? v : 0;
    return low < 1 ? low : 1;
}

static inline float larger(float a, float b) { return a > b ? a : b; }
static inline float smaller(float a, float b) { return a < b ? a : b; }

/* Weight for saturation, 0 to 1; 0 for ABSENT. */
static inline float trust(const struct exposure_job *e, float v)
{
    return v <= ABSENT ? 0 : clamp01((e->saturated - v) * e->falling);
}

/* Weight for darkness, 0 to 1. */
static inline float clarity(const struct exposure_job *e, float v) { return clamp01((v - e->dark) * e->rising); }

/* ------------------------------------------------------------------------------------------------- pixel by pixel */

/* A colour that has no weight in any exposure; v: the samples of the pixel. */
static float bound(const struct merge_job *m, const float *v, int c, uint8_t *mark)
{
    int known = -1, shortest = -1; /* the longest exposure that does not saturate; the shortest that covers the pixel */
    for (int k = m->count - 1; k >= 0; k--) {
        if (v[3 * k + c] <= ABSENT) continue;
        shortest = k;
        if (known < 0 && v[3 * k + c] < m->exposures[k].saturated) known = k;
    }
    const int from = known < 0 ? shortest : known;
    float x = v[3 * from + c] / m->exposures[from].t;
    if (known < 0)
        *mark |= PHOTO_BRIGHT;
    else if (v[3 * known + c] <= m->exposures[known].dark)
        *mark |= PHOTO_DARK;
    for (int k = known + 1; known >= 0 && k < m->count; k++) x = larger(x, v[3 * k + c] / m->exposures[k].t);
    return x;
}

static void merge_colours(const struct merge_job *m, const float *v, float rgb[3], float variance[3], uint8_t *mark)
{
    for (int c = 0; c < 3; c++) {
        float sum = 0, times = 0, weighted = 0, weights = 0, squares = 0;
        for (int k = 0; k < m->count; k++) {
            const float w = trust(&m->exposures[k], v[3 * k + c]);
            sum += w * v[3 * k + c];
            times += w * m->exposures[k].t;
        }
        const float first = times > 0 ? sum / times : 0;
        for (int k = 0; k < m->count; k++) {
            const struct exposure_job *e = &m->exposures[k];
            const float value = e->t * first;
            const float trusted = smaller(trust(e, v[3 * k + c]), trust(e, value)) * clarity(e, value);
            const float w = trusted * e->t / (e->photon * larger(value, 0) + e->read2);
            weighted += w * v[3 * k + c];
            weights += w * e->t;
            squares += w * trusted * e->t;
        }
        rgb[c] = weights > 0 ? weighted / weights : bound(m, v, c, mark);
        variance[c] = weights > 0 ? squares / (weights * weights) : rgb[c] * rgb[c];
    }
}

/* ------------------------------------------------------------------------------------------------------- in blocks */

typedef float plane[BLOCK];

/* Loads the samples of an exposure for n pixels of a row, from (x, y) on. */
static void load(plane to[3], const struct exposure_job *e, int width, int height, int x, int y, int n)
{
    const int sx = x + e->dx, sy = y + e->dy;
    int begin = sx < 0 ? -sx : 0, end = sx + n > width ? width - sx : n;
    if (sy < 0 || sy >= height || begin >= end) begin = end = n;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < begin; i++) to[c][i] = ABSENT;
        for (int i = end; i < n; i++) to[c][i] = ABSENT;
    }
    const ptrdiff_t at = 3 * ((ptrdiff_t)sy * width + sx);
    if (e->values) {
        for (int i = begin; i < end; i++)
            for (int c = 0; c < 3; c++) to[c][i] = e->values[at + 3 * i + c];
        return;
    }
    const float *red = e->tables[0], *green = e->tables[1], *blue = e->tables[2];
    for (int i = begin; i < end; i++) {
        const uint16_t *s = e->samples + at + 3 * i;
        to[0][i] = red[s[0]];
        to[1][i] = green[s[1]];
        to[2][i] = blue[s[2]];
    }
}

/* The first round: the radiance for predictions, and its largest colour. times is 0 where every exposure saturates. */
static void first_round(const struct merge_job *m, plane (*const v)[3], plane first[3], plane max_first, plane times,
                        int n)
{
    for (int i = 0; i < n; i++) times[i] = 0;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < n; i++) first[c][i] = 0;
    for (int k = 0; k < m->count; k++) {
        const struct exposure_job *e = &m->exposures[k];
        const float saturated = e->saturated, falling = e->falling, t = e->t;
        const float *r = v[k][0], *g = v[k][1], *b = v[k][2];
        for (int i = 0; i < n; i++) {
            const float max = larger(r[i], larger(g[i], b[i]));
            const float trusted = clamp01((saturated - max) * falling), w = max <= ABSENT ? 0 : trusted;
            first[0][i] += w * r[i];
            first[1][i] += w * g[i];
            first[2][i] += w * b[i];
            times[i] += w * t;
        }
    }
    for (int i = 0; i < n; i++) {
        const float per_time = times[i] > 0 ? 1 / times[i] : 0;
        first[0][i] *= per_time;
        first[1][i] *= per_time;
        first[2][i] *= per_time;
        max_first[i] = larger(first[0][i], larger(first[1][i], first[2][i]));
    }
}

struct colour_sums { /* of a colour */
    plane weighted, weights, squares;
};

static void second_round(const struct merge_job *m, plane (*const v)[3], plane first[3], const float *max_first,
                         struct colour_sums sums[3], int n)
{
    plane shared, clear;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < n; i++) sums[c].weighted[i] = sums[c].weights[i] = sums[c].squares[i] = 0;
    for (int k = 0; k < m->count; k++) {
        const struct exposure_job e = m->exposures[k];
        const float *r = v[k][0], *g = v[k][1], *b = v[k][2];
        for (int i = 0; i < n; i++) {
            const float max = larger(r[i], larger(g[i], b[i]));
            const float measured = clamp01((e.saturated - max) * e.falling),
                        predicted = clamp01((e.saturated - e.t * max_first[i]) * e.falling);
            shared[i] = max <= ABSENT ? 0 : smaller(measured, predicted);
        }
        for (int c = 0; c < 3; c++) {
            const float *s = v[k][c], *x = first[c];
            float *weighted = sums[c].weighted, *weights = sums[c].weights, *squares = sums[c].squares;
            /* a separate loop: inside the next one the clamp would prevent vectorization */
            for (int i = 0; i < n; i++) clear[i] = clamp01((e.t * x[i] - e.dark) * e.rising);
            for (int i = 0; i < n; i++) {
                const float trusted = shared[i] * clear[i] * e.t,
                            w = trusted / (e.photon * larger(e.t * x[i], 0) + e.read2);
                weighted[i] += w * s[i];
                weights[i] += w * e.t;
                squares[i] += w * trusted;
            }
        }
    }
}

/* Relative variance of the luminance. */
static float relative_variance(const struct merge_job *m, const float rgb[3], const float variance[3], uint8_t mark)
{
    float y = 0, sum = 0;
    for (int c = 0; c < 3; c++) {
        y += luma[c] * rgb[c];
        sum += luma[c] * luma[c] * variance[c];
    }
    sum *= m->luminance;
    if ((mark & PHOTO_BRIGHT) || !(y > 0) || !(sum < y * y)) return 1;
    const float v = sum / (y * y);
    return v > 1e-12f ? v : 1e-12f;
}

static void merge_block(const struct merge_job *m, int x, int y, int n)
{
    plane v[MERGE_MAX_EXPOSURES][3], first[3], max_first, times;
    struct colour_sums sums[3];
    const int width = m->out->radiance.width, height = m->out->radiance.height;
    for (int k = 0; k < m->count; k++) load(v[k], &m->exposures[k], width, height, x, y, n);
    first_round(m, v, first, max_first, times, n);
    second_round(m, v, first, max_first, sums, n);
    const size_t at = (size_t)y * (size_t)width + (size_t)x;
    for (int i = 0; i < n; i++) {
        float rgb[3], variance[3];
        uint8_t mark = 0;
        if (times[i] > 0) {
            for (int c = 0; c < 3; c++) {
                const float weights = sums[c].weights[i];
                rgb[c] = weights > 0 ? sums[c].weighted[i] / weights : 0;
                variance[c] = weights > 0 ? sums[c].squares[i] / (weights * weights) : 0;
            }
        }
        const bool saturated = !(times[i] > 0);
        float pixel[3 * MERGE_MAX_EXPOSURES];
        if (saturated || !(sums[0].weights[i] > 0) || !(sums[1].weights[i] > 0) || !(sums[2].weights[i] > 0)) {
            for (int k = 0; k < m->count; k++)
                for (int c = 0; c < 3; c++) pixel[3 * k + c] = v[k][c][i];
            if (saturated) merge_colours(m, pixel, rgb, variance, &mark);
            for (int c = 0; !saturated && c < 3; c++)
                if (!(sums[c].weights[i] > 0)) {
                    rgb[c] = bound(m, pixel, c, &mark);
                    variance[c] = rgb[c] * rgb[c];
                }
        }
        for (int c = 0; c < 3; c++) m->out->radiance.data[3 * (at + (size_t)i) + (size_t)c] = rgb[c];
        m->out->variance[at + (size_t)i] = relative_variance(m, rgb, variance, mark);
        m->out->marks[at + (size_t)i] = mark;
    }
}

static void merge_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct merge_job *m = ctx;
    const int width = m->out->radiance.width;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < width; x += BLOCK) merge_block(m, x, (int)y, width - x < BLOCK ? width - x : BLOCK);
}

/* ----------------------------------------------------------------------------------------------------------- setup */

static enum status check(const struct brackets *b, struct err *err)
{
    if (b->count < 1 || b->count > MERGE_MAX_EXPOSURES)
        return err_set(err, ST_DATA, "%d exposures cannot be merged; wanted 1 to %d.", b->count,
                       (int)MERGE_MAX_EXPOSURES);
    for (int k = 0; k < b->count; k++) {
        const struct photo_info *info = &b->photos[k].info, *first = &b->photos[0].info;
        if (info->width != first->width || info->height != first->height)
            return err_set(err, ST_DATA,
                           "exposure %d has %d x %d pixels, but the first one %d x %d; the exposures of a view must "
                           "have one size.",
                           k + 1, info->width, info->height, first->width, first->height);
        if (!(b->exposures[k] >= 1e-12 && b->exposures[k] <= 1e12))
            return err_set(err, ST_DATA,
                           "exposure %d is %g times that of white, wanted 1e-12 to 1e12; correct it in exposures.txt.",
                           k + 1, b->exposures[k]);
    }
    return ST_OK;
}

/* Parameters are limits on the sRGB curve. For another curve, limits are at the same sample values, and of the three
 * colours the strictest applies. */
static void set_limits(struct exposure_job *e, const struct photo *p, const struct response *r,
                       const struct merge_params *params)
{
    const float clear = (float)fmin(DARK_UNTIL * params->dark, 1);
    float saturated = (float)params->saturated, trusted = SATURATED_FROM * saturated, dark = (float)params->dark,
          from = clear;
    if (p->values) { /* an EXR may have values above 1, or be clipped below it */
        saturated = p->saturation > 0 ? saturated * p->saturation : HUGE_VALF;
        trusted = SATURATED_FROM * saturated;
    } else if (r->table || r->space) {
        const float at[4] = {srgb_from_linear(saturated), srgb_from_linear(trusted), srgb_from_linear(dark),
                             srgb_from_linear(clear)};
        saturated = trusted = HUGE_VALF;
        dark = from = 0;
        for (int c = 0; c < 3; c++) {
            saturated = smaller(saturated, response_light(r, c, at[0]));
            trusted = smaller(trusted, response_light(r, c, at[1]));
            dark = larger(dark, response_light(r, c, at[2]));
            from = larger(from, response_light(r, c, at[3]));
        }
    }
    if (saturated == HUGE_VALF) saturated = trusted = 1e30f;
    e->saturated = saturated;
    e->trusted = trusted;
    e->falling = saturated > trusted ? 1 / (saturated - trusted) : 1e30f;
    e->dark = dark > 0 ? dark : -2; /* dark = 0: black samples count too */
    e->rising = dark > 0 && from > dark ? 1 / (from - dark) : 1;
}

enum status merge_brackets(struct merged *out, const struct brackets *b, const struct noise *noise,
                           const struct merge_params *params, struct err *err)
{
    struct merge_job m = {.out = out, .count = b->count};
    float *tables[2] = {NULL, NULL}; /* of 8 and of 16 bits */
    *out = (struct merged){0};
    check(b, err);
    for (int k = 0; !err->status && k < b->count; k++) {
        const struct photo *p = &b->photos[k];
        const int wide = p->info.bits == 16;
        if (!p->values && !tables[wide]) tables[wide] = response_tables(b->response, p->info.bits, err);
        if (err->status) break;
        struct exposure_job *e = &m.exposures[k];
        *e = (struct exposure_job){.samples = p->samples,
                                   .values = p->values,
                                   .t = (float)b->exposures[k],
                                   .dx = b->shifts ? b->shifts[k].dx : 0,
                                   .dy = b->shifts ? b->shifts[k].dy : 0,
                                   .photon = (float)noise[k].photon,
                                   .read2 = (float)noise[k].read2};
        for (int c = 0; !p->values && c < 3; c++) e->tables[c] = tables[wide] + (size_t)c * (wide ? 65536 : 256);
        set_limits(e, p, b->response, params);
        m.luminance = larger(m.luminance, (float)noise[k].luminance);
    }
    const int width = err->status ? 1 : b->photos[0].info.width, height = err->status ? 1 : b->photos[0].info.height;
    const size_t pixels = (size_t)width * (size_t)height;
    if (!err->status) image_init(&out->radiance, width, height, 3, err);
    if (!err->status && (!(out->marks = malloc(pixels)) || !(out->variance = malloc(pixels * sizeof *out->variance))))
        err_nomem(err, "a view's marks and variance", pixels * 5);
    if (!err->status) parallel_for((size_t)height, ROWS, merge_rows, &m);
    free(tables[0]);
    free(tables[1]);
    return err->status;
}

void merge_release(struct merged *m)
{
    if (!m) return;
    image_release(&m->radiance);
    free(m->marks);
    free(m->variance);
    *m = (struct merged){0};
}

/* ------------------------------------------------------------------------------------------------------- agreement */

/* The linear light of sample i. */
static double light_of(const struct photo *p, const struct response *r, size_t i)
{
    if (p->values) return (double)p->values[i];
    return (double)response_light(r, (int)(i % 3), (float)p->samples[i] / (p->info.bits == 16 ? 65535.0f : 255.0f));
}

enum status merge_agreement(struct exposure_agreement *worst, const struct brackets *b, struct err *err)
{
    enum { SAMPLES = 1 << 16 };
    const double min = 0.02, max = 0.7; /* linear: neither dark nor near white */
    *worst = (struct exposure_agreement){0, 1, 1, 0};
    check(b, err);
    for (int k = 1; !err->status && k < b->count; k++) {
        const struct photo *p = &b->photos[k - 1], *q = &b->photos[k];
        const struct shift none = {0, 0}, sp = b->shifts ? b->shifts[k - 1] : none,
                           sq = b->shifts ? b->shifts[k] : none;
        const int width = p->info.width, height = p->info.height;
        const size_t pixels = (size_t)width * (size_t)height, step = 3 * pixels / SAMPLES + 1;
        size_t n = 0;
        double sum_p = 0, sum_q = 0;
        for (size_t i = 0; i < pixels; i += step) {
            const int x = (int)(i % (size_t)width), y = (int)(i / (size_t)width);
            const int xp = x + sp.dx, yp = y + sp.dy, xq = x + sq.dx, yq = y + sq.dy;
            if (xp < 0 || yp < 0 || xq < 0 || yq < 0 || xp >= width || xq >= width || yp >= height || yq >= height)
                continue;
            for (size_t c = 0; c < 3; c++) {
                const double vp = light_of(p, b->response, 3 * ((size_t)yp * (size_t)width + (size_t)xp) + c),
                             vq = light_of(q, b->response, 3 * ((size_t)yq * (size_t)width + (size_t)xq) + c);
                if (vp < min || vq < min || vp > max || vq > max) continue;
                sum_p += vp;
                sum_q += vq;
                n++;
            }
        }
        if (n < SAMPLES / 256) continue;
        const double stated = b->exposures[k] / b->exposures[k - 1], measured = sum_q / sum_p;
        if (fabs(log(measured / stated)) > fabs(log(worst->measured / worst->stated)))
            *worst = (struct exposure_agreement){k, stated, measured, n};
    }
    return err->status;
}
