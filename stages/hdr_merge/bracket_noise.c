/* bracket_noise.c - measures the noise of samples from bracketed exposures.
 *
 * For neighbouring exposures s < t with samples a and b of one pixel, d = a - b s / t has mean 0 and variance
 *   photon v (1 + s / t) + read^2 (1 + (s / t)^2),
 * where v = b s / t is the better estimate of a. The standard deviation of d is estimated in bins of log v as 1.4826
 * times its median absolute deviation from the bin's median, which is robust against edges, moving objects and slightly
 * wrong exposures. photon and read^2 are the least-squares fit to the bins of all pairs, with relative weights; neither
 * may be negative.
 *
 * The noise of the luminance is not the sum of that of independent colours: JPEG stores chroma coarsely, so that the
 * colours of a pixel share most of what noise is left. The difference of the luminances of two exposures, divided by
 * the standard deviation that independent colours would have, is therefore measured as well, in the same bins: after
 * subtraction of the bin's median, 68.27 % of its absolute values are below a value q, and luminance is the mean of
 * q^2. */
#include "stages/hdr_merge/bracket_noise.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/image/luminance.h"
#include "stages/hdr_merge/merge.h"

enum { BINS = 24, SAMPLES = 1 << 17, MIN_BIN = 200, MIN_BINS = 3 }; /* samples of a pair; of a bin that counts */

static const double min_light = 0.002, max_light = 0.7, max_longer = 0.75; /* of v; of v; of b */

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

/* The end of a bin that begins at `begin`; samples are in order of light. */
static size_t end_of_bin(const struct pair_sample *s, size_t count, size_t begin, int bin)
{
    const double step = log(max_light / min_light) / BINS;
    const float end_light = (float)(min_light * exp(step * (bin + 1)));
    size_t end = begin;
    while (end < count && s[end].light < end_light) end++;
    return end;
}

static void add_pair(struct noise_fit *fit, struct pair_sample *s, size_t count, double ratio, float *values)
{
    qsort(s, count, sizeof *s, by_light);
    for (size_t begin = 0, end, bin = 0; bin < BINS; bin++, begin = end) {
        end = end_of_bin(s, count, begin, (int)bin);
        if (end - begin >= MIN_BIN) add_bin(fit, s + begin, end - begin, ratio, values);
    }
}

static float sample_at(const struct photo *p, const float *tables, size_t i, int c)
{
    if (p->values) return p->values[3 * i + (size_t)c];
    const size_t levels = p->info.bits == 16 ? 65536 : 256;
    return tables[(size_t)c * levels + p->samples[3 * i + (size_t)c]];
}

/* Two exposures of one view, the longer one behind the shorter one. */
struct pair {
    const struct photo *photo[2];
    const float *table[2];
    struct shift shift[2];
    double ratio; /* of their exposures */
    int width, height;
    size_t pixels;
};

static struct pair pair_of(const struct brackets *b, int k, const float *const tables[2])
{
    const struct photo *first = &b->photos[k - 1];
    struct pair p = {.photo = {first, &b->photos[k]},
                     .table = {tables[0], tables[1]},
                     .ratio = b->exposures[k - 1] / b->exposures[k],
                     .width = first->info.width,
                     .height = first->info.height};
    for (int n = 0; b->shifts && n < 2; n++) p.shift[n] = b->shifts[k - 1 + n];
    p.pixels = (size_t)p.width * (size_t)p.height;
    return p;
}

/* The linear samples of pixel i in both exposures; false outside one of them. */
static bool pair_samples(const struct pair *p, size_t i, double sample[2][3])
{
    for (int n = 0; n < 2; n++) {
        const int x = (int)(i % (size_t)p->width) + p->shift[n].dx, y = (int)(i / (size_t)p->width) + p->shift[n].dy;
        if (x < 0 || y < 0 || x >= p->width || y >= p->height) return false;
        for (int c = 0; c < 3; c++)
            sample[n][c] = (double)sample_at(p->photo[n], p->table[n], (size_t)y * (size_t)p->width + (size_t)x, c);
    }
    return true;
}

/* Collects the differences of a pair of exposures; returns their number. */
static size_t gather(struct pair_sample *to, const struct brackets *b, int k, const float *const tables[2])
{
    const struct pair p = pair_of(b, k, tables);
    const size_t step = p.pixels / (SAMPLES / 3) + 1;
    size_t count = 0;
    for (size_t i = 0; i < p.pixels; i += step) {
        double v[2][3];
        if (!pair_samples(&p, i, v)) continue;
        for (int c = 0; c < 3; c++) {
            const double light = v[1][c] * p.ratio;
            if (light < min_light || light > max_light || v[1][c] > max_longer) continue;
            to[count++] = (struct pair_sample){(float)light, (float)(v[0][c] - light)};
        }
    }
    return count;
}

/* Collects the differences of the luminances of a pair, divided by their deviation; returns their number. */
static size_t gather_luminance(struct pair_sample *to, const struct brackets *b, int k, const float *const tables[2],
                               const struct noise *n)
{
    static const double luma[3] = LUMINANCE_WEIGHTS;
    const struct pair p = pair_of(b, k, tables);
    const size_t step = (p.pixels / (SAMPLES / 3) + 1) | 1; /* odd: all places of JPEG's blocks */
    size_t count = 0;
    for (size_t i = 0; i < p.pixels; i += step) {
        double v[2][3], difference = 0, variance = 0, light = 0;
        bool exposed = true;
        if (!pair_samples(&p, i, v)) continue;
        for (int c = 0; c < 3; c++) {
            const double l = v[1][c] * p.ratio;
            const double noise = n->photon * l * (1 + p.ratio) + n->read2 * (1 + p.ratio * p.ratio);
            /* clipping at black would distort the differences of darker samples */
            exposed = exposed && l >= min_light && l <= max_light && v[1][c] <= max_longer && l * l >= 9 * noise;
            difference += luma[c] * (v[0][c] - l);
            variance += luma[c] * luma[c] * noise;
            light += luma[c] * l;
        }
        if (exposed) to[count++] = (struct pair_sample){(float)light, (float)(difference / sqrt(variance))};
    }
    return count;
}

struct spread { /* mean of q^2, weighted by samples */
    double sum, count;
};

static void add_spread(struct spread *to, const struct pair_sample *s, size_t count, float *values)
{
    for (size_t i = 0; i < count; i++) values[i] = s[i].difference;
    sort_floats(values, count);
    const float middle = values[count / 2];
    for (size_t i = 0; i < count; i++) values[i] = fabsf(values[i] - middle);
    sort_floats(values, count);
    const double q = (double)values[(size_t)(0.6827 * (double)count)];
    to->sum += q * q * (double)count;
    to->count += (double)count;
}

/* false: too few bins; *noise is then unchanged. */
static bool solve(struct noise *noise, const struct noise_fit *fit)
{
    const double det = fit->pp * fit->rr - fit->pr * fit->pr;
    if (fit->bins < MIN_BINS || !(det > 0)) return false;
    double photon = (fit->p * fit->rr - fit->r * fit->pr) / det, read2 = (fit->pp * fit->r - fit->pr * fit->p) / det;
    if (photon < 0) photon = 0, read2 = fit->r / fit->rr;
    if (read2 < 0) read2 = 0, photon = fit->p / fit->pp;
    *noise = (struct noise){fmax(photon, 1e-9), fmax(read2, 1e-10), 1};
    return true;
}

enum status noise_measure(struct noise *noise, bool *measured, const struct brackets *b, struct err *err)
{
    struct noise_fit fit = {0};
    const size_t room = SAMPLES + 3;
    struct pair_sample *samples = malloc(room * sizeof *samples);
    float *values = malloc(room * sizeof *values), *tables[2] = {NULL, NULL}; /* of 8 and of 16 bits */
    if (!samples || !values) err_nomem(err, "samples of noise", room * sizeof *samples);
    *measured = false;
    for (int k = 0; !err->status && k < b->count; k++) {
        const int bits = b->photos[k].info.bits;
        if (bits == 32 || tables[bits == 16]) continue;
        tables[bits == 16] = response_tables(b->response, bits, err);
    }
    for (int k = 1; !err->status && k < b->count; k++) {
        const float *const pair[2] = {tables[b->photos[k - 1].info.bits == 16], tables[b->photos[k].info.bits == 16]};
        const size_t count = gather(samples, b, k, pair);
        add_pair(&fit, samples, count, b->exposures[k - 1] / b->exposures[k], values);
    }
    *measured = !err->status && solve(noise, &fit);
    struct spread spread = {0};
    for (int k = 1; *measured && k < b->count; k++) {
        const float *const pair[2] = {tables[b->photos[k - 1].info.bits == 16], tables[b->photos[k].info.bits == 16]};
        const size_t count = gather_luminance(samples, b, k, pair, noise);
        qsort(samples, count, sizeof *samples, by_light);
        for (size_t begin = 0, end, bin = 0; bin < BINS; bin++, begin = end) {
            end = end_of_bin(samples, count, begin, (int)bin);
            if (end - begin >= MIN_BIN) add_spread(&spread, samples + begin, end - begin, values);
        }
    }
    if (*measured) noise->luminance = spread.sum > 0 ? spread.sum / spread.count : 1;
    free(tables[0]);
    free(tables[1]);
    free(values);
    free(samples);
    return err->status;
}
