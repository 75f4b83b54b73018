/* noise.c - measures the noise of samples from bracketed exposures.
 *
 * For neighbouring exposures s < t with samples a and b of one pixel, d = a - b s / t has mean 0 and variance
 *   photon v (1 + s / t) + read^2 (1 + (s / t)^2),
 * where v = b s / t is the better estimate of a. The standard deviation of d is estimated in bins of log v as 1.4826
 * times its median absolute deviation from the bin's median, which is robust against edges, moving objects and slightly
 * wrong exposures. photon and read^2 are the least-squares fit to the bins of all pairs, with relative weights; neither
 * may be negative. */
#include "stages/hdr_merge/noise.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "stages/hdr_merge/merge.h"

enum { BINS = 24, SAMPLES = 1 << 17, MIN_BIN = 200 }; /* samples of a pair; of a bin that counts */

static const double min_light = 0.002, max_light = 0.7, max_longer = 0.75; /* of v; of v; of b */

struct noise noise_given(const struct merge_params *params, const struct response *r, int bits)
{
    struct noise n = {1 / params->electrons, pow(params->read_noise / params->electrons, 2)};
    if (bits == 32) return n;
    const double levels = bits == 16 ? 65535 : 255;
    /* the mean step near black, and the mean of step^2 / light over the brighter half of the samples */
    double near_black = 0, per_light = 0;
    for (int i = 0; i < RESPONSE_LEVELS - 1; i++) {
        const float from = (float)i / (RESPONSE_LEVELS - 1), to = (float)(i + 1) / (RESPONSE_LEVELS - 1);
        const double light = (double)response_light(r, 1, to),
                     step = (light - (double)response_light(r, 1, from)) * (RESPONSE_LEVELS - 1) / levels;
        if (i < 8) near_black += step / 8;
        if (i >= RESPONSE_LEVELS / 2 && light > 0) per_light += step * step / light / (RESPONSE_LEVELS / 2 - 1);
    }
    n.photon += per_light / 12;
    n.read2 += near_black * near_black / 12;
    return n;
}

struct pair_sample {
    float light, difference;
};

static int by_light(const void *x, const void *y)
{
    const struct pair_sample *a = x, *b = y;
    if (a->light != b->light) return a->light < b->light ? -1 : 1;
    return (a->difference > b->difference) - (a->difference < b->difference);
}

struct noise_fit { /* normal equations */
    double pp, pr, rr, p, r;
    int bins;
};

/* Adds the samples of a bin to the fit and reorders them. */
static void add_bin(struct noise_fit *fit, struct pair_sample *s, size_t count, double ratio, float *values)
{
    double light = 0;
    for (size_t i = 0; i < count; i++) {
        light += (double)s[i].light / (double)count;
        values[i] = s[i].difference;
    }
    sort_floats(values, count);
    const float middle = values[count / 2];
    for (size_t i = 0; i < count; i++) values[i] = fabsf(values[i] - middle);
    sort_floats(values, count);
    const double sigma = 1.4826 * (double)values[count / 2], variance = sigma * sigma;
    if (!(variance > 0) || light < 3 * sigma) return; /* clipping at black would distort the deviation */
    const double a = light * (1 + ratio) / variance, b = (1 + ratio * ratio) / variance;
    fit->pp += a * a;
    fit->pr += a * b;
    fit->rr += b * b;
    fit->p += a;
    fit->r += b;
    fit->bins++;
}

static void add_pair(struct noise_fit *fit, struct pair_sample *s, size_t count, double ratio, float *values)
{
    qsort(s, count, sizeof *s, by_light);
    const double step = log(max_light / min_light) / BINS;
    size_t begin = 0;
    for (int bin = 0; bin < BINS; bin++) {
        const float end_light = (float)(min_light * exp(step * (bin + 1)));
        size_t end = begin;
        while (end < count && s[end].light < end_light) end++;
        if (end - begin >= MIN_BIN) add_bin(fit, s + begin, end - begin, ratio, values);
        begin = end;
    }
}

static float sample_at(const struct photo *p, const float *tables, size_t i, int c)
{
    if (p->values) return p->values[3 * i + (size_t)c];
    const size_t levels = p->info.bits == 16 ? 65536 : 256;
    return tables[(size_t)c * levels + p->samples[3 * i + (size_t)c]];
}

/* Collects the differences of a pair of exposures; returns their number. */
static size_t gather(struct pair_sample *to, const struct brackets *b, int k, const float *const tables[2])
{
    const struct photo *a = &b->photos[k - 1], *l = &b->photos[k];
    const struct shift none = {0, 0}, sa = b->shifts ? b->shifts[k - 1] : none, sl = b->shifts ? b->shifts[k] : none;
    const int width = a->info.width, height = a->info.height;
    const double ratio = b->exposures[k - 1] / b->exposures[k];
    const size_t pixels = (size_t)width * (size_t)height, step = pixels / (SAMPLES / 3) + 1;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i += step) {
        const int x = (int)(i % (size_t)width), y = (int)(i / (size_t)width);
        const int xa = x + sa.dx, ya = y + sa.dy, xl = x + sl.dx, yl = y + sl.dy;
        if (xa < 0 || ya < 0 || xl < 0 || yl < 0 || xa >= width || xl >= width || ya >= height || yl >= height)
            continue;
        for (int c = 0; c < 3; c++) {
            const double va = (double)sample_at(a, tables[0], (size_t)ya * (size_t)width + (size_t)xa, c),
                         vl = (double)sample_at(l, tables[1], (size_t)yl * (size_t)width + (size_t)xl, c);
            const double light = vl * ratio;
            if (light < min_light || light > max_light || vl > max_longer) continue;
            to[count++] = (struct pair_sample){(float)light, (float)(va - light)};
        }
    }
    return count;
}

enum status noise_measure(struct noise *noise, bool *measured, const struct brackets *b, struct err *err)
{
    enum { MIN_BINS = 3 };
    struct noise_fit fit = {0};
    const size_t room = SAMPLES + 3;
    struct pair_sample *samples = malloc(room * sizeof *samples);
    float *values = malloc(room * sizeof *values), *tables[2] = {NULL, NULL}; /* of 8 and of 16 bits */
    enum status st = samples && values ? ST_OK : err_nomem(err, "samples of noise", room * sizeof *samples);
    *measured = false;
    for (int k = 0; !st && k < b->count; k++) {
        const int bits = b->photos[k].info.bits;
        if (bits == 32 || tables[bits == 16]) continue;
        if (!(tables[bits == 16] = response_tables(b->response, bits, err))) st = ST_NOMEM;
    }
    for (int k = 1; !st && k < b->count; k++) {
        const float *const pair[2] = {tables[b->photos[k - 1].info.bits == 16], tables[b->photos[k].info.bits == 16]};
        const size_t count = gather(samples, b, k, pair);
        add_pair(&fit, samples, count, b->exposures[k - 1] / b->exposures[k], values);
    }
    const double det = fit.pp * fit.rr - fit.pr * fit.pr;
    if (!st && fit.bins >= MIN_BINS && det > 0) {
        double photon = (fit.p * fit.rr - fit.r * fit.pr) / det, read2 = (fit.pp * fit.r - fit.pr * fit.p) / det;
        if (photon < 0) photon = 0, read2 = fit.r / fit.rr;
        if (read2 < 0) read2 = 0, photon = fit.p / fit.pp;
        *noise = (struct noise){fmax(photon, 1e-9), fmax(read2, 1e-10)};
        *measured = true;
    }
    free(tables[0]);
    free(tables[1]);
    free(values);
    free(samples);
    return st;
}
