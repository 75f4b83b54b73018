/* merge.c - weighted mean of exposures in linear radiance.
 *
 * A sample v (linear, 1 is white) of exposure t estimates the radiance x as v / t. Its noise has a part that grows with
 * the light (photons; the steps of the sRGB curve do about the same) and a part that does not (reading, the steps near
 * black): var(v) ~ v + NOISE_FLOOR. The best weight of v / t is 1 / var(v / t) = t^2 / (t x + NOISE_FLOOR).
 *
 * Weights taken from the noisy samples themselves would pull the mean towards the samples that happen to look sure. So
 * there are two rounds: the first has weights t, for which the mean is sum(v) / sum(t), nearly the best already; the
 * second takes all that weights depend on from what the first predicts, t x. (Where photos do not keep to the curve the two
 * disagree: a sample that looks saturated itself is never trusted more than it looks, so that the result has no steps.)
 *
 * Saturation counts for the pixel: where one colour saturates, JPEG's shared colour channels spoil the others too. A pixel
 * that has a saturated colour in every exposure is merged colour by colour. What is then left without weight takes the
 * exposure that knows most: the shortest if all saturate (a lower bound), else the longest that does not saturate, but
 * no less than the saturated ones say. Both are marked.
 *
 * Differs from Debevec and Malik 1997 (hat weights on the samples' own values, logarithmic mean) in that weights follow
 * noise and prediction, and the mean is of radiance, which has no bias towards dark samples. */
#include "stages/hdr_merge/merge.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/parallel.h"

#define PARAM_STRUCT struct merge_params
const struct param merge_param_table[] = {MERGE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { CHUNK = 1 << 14 };

static const float NOISE_FLOOR = 0.001f;  /* of white: about three steps of 8 bits near black */
static const float SATURATED_FROM = 0.8f; /* of `saturated`: the weight falls from here */
static const float DARK_UNTIL = 3;        /* of `dark`: the weight rises to here */

struct exposure_job { /* one exposure */
    const uint16_t *samples;
    const float *curve; /* linear value of a sample */
    float t;
};

struct merge {
    struct image *radiance;
    uint8_t *marks;
    const struct exposure_job *exposures; /* ascending in t */
    int count;
    float saturated, trusted; /* weight 0 from `saturated`, 1 below `trusted` */
    float dark, clear;        /* weight 0 up to `dark`, 1 from `clear` */
    float falling, rising;    /* the slopes in between */
};

static float trust(const struct merge *m, float v)
{
    return v >= m->saturated ? 0 : v <= m->trusted ? 1 : (m->saturated - v) * m->falling;
}

static float clarity(const struct merge *m, float v)
{
    return v >= m->clear ? 1 : v <= m->dark ? 0 : (v - m->dark) * m->rising;
}

static float largest(const float rgb[3]) { return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])); }

/* A colour that no weighted sample tells; v: that colour in every exposure. */
static float bound(const struct merge *m, const float *v, int c, uint8_t *mark)
{
    int known = m->count - 1; /* the longest exposure that does not saturate */
    while (known >= 0 && v[3 * known + c] >= m->saturated) known--;
    float x = v[3 * (known < 0 ? 0 : known) + c] / m->exposures[known < 0 ? 0 : known].t;
    if (known < 0)
        *mark |= MERGE_BRIGHT;
    else if (v[3 * known + c] <= m->dark)
        *mark |= MERGE_DARK;
    for (int k = known + 1; known >= 0 && k < m->count; k++) x = fmaxf(x, v[3 * k + c] / m->exposures[k].t);
    return x;
}

/* own: colours count by their own saturation, not by the pixel's. */
static void merge_pixel(const struct merge *m, const float *v, bool own, float rgb[3], uint8_t *mark)
{
    float first[3], sum[3] = {0}, times[3] = {0};
    for (int k = 0; k < m->count; k++) {
        const float *s = v + 3 * k, most = largest(s);
        for (int c = 0; c < 3; c++) {
            float w = trust(m, own ? s[c] : most);
            sum[c] += w * s[c];
            times[c] += w * m->exposures[k].t;
        }
    }
    if (!own && !(times[0] > 0)) {
        merge_pixel(m, v, true, rgb, mark);
        return;
    }
    for (int c = 0; c < 3; c++) first[c] = times[c] > 0 ? sum[c] / times[c] : 0;

    float weighted[3] = {0}, weights[3] = {0}, most_first = largest(first);
    for (int k = 0; k < m->count; k++) {
        const float *s = v + 3 * k, t = m->exposures[k].t, most = largest(s);
        float shared = fminf(trust(m, most), trust(m, t * most_first));
        for (int c = 0; c < 3; c++) {
            float value = t * first[c], trusted = own ? fminf(trust(m, s[c]), trust(m, value)) : shared;
            float w = trusted * clarity(m, value) * t / (value + NOISE_FLOOR);
            weighted[c] += w * s[c];
            weights[c] += w * t;
        }
    }
    for (int c = 0; c < 3; c++) rgb[c] = weights[c] > 0 ? weighted[c] / weights[c] : bound(m, v, c, mark);
}

static void merge_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct merge *m = ctx;
    float v[3 * MERGE_MOST];
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        uint8_t mark = 0;
        for (int k = 0; k < m->count; k++)
            for (int c = 0; c < 3; c++)
                v[3 * k + c] = m->exposures[k].curve[m->exposures[k].samples[3 * i + (size_t)c]];
        merge_pixel(m, v, false, m->radiance->data + 3 * i, &mark);
        if (m->marks) m->marks[i] = mark;
    }
}

void merge_agreement(struct exposure_agreement *worst, const struct photo *photos, const double *exposures, int count)
{
    enum { SAMPLES = 1 << 16 };
    const double least = 0.02, most = 0.7; /* linear: neither dark nor near white */
    *worst = (struct exposure_agreement){0, 1, 1, 0};
    for (int k = 1; k < count; k++) {
        const struct photo *a = &photos[k - 1], *b = &photos[k];
        size_t samples = (size_t)a->info.width * (size_t)a->info.height * 3, step = samples / SAMPLES + 1, n = 0;
        double sum_a = 0, sum_b = 0, white_a = a->info.bits == 16 ? 65535 : 255,
               white_b = b->info.bits == 16 ? 65535 : 255;
        for (size_t i = 0; i < samples; i += step) {
            double va = linear_from_srgb((float)(a->samples[i] / white_a)),
                   vb = linear_from_srgb((float)(b->samples[i] / white_b));
            if (va < least || vb < least || va > most || vb > most) continue;
            sum_a += va;
            sum_b += vb;
            n++;
        }
        if (n < SAMPLES / 256) continue;
        double stated = exposures[k] / exposures[k - 1], seen = sum_b / sum_a;
        if (fabs(log(seen / stated)) > fabs(log(worst->seen / worst->stated)))
            *worst = (struct exposure_agreement){k, stated, seen, n};
    }
}

static float *make_curve(int bits, struct err *err)
{
    size_t levels = bits == 16 ? 65536 : 256;
    float *curve = malloc(levels * sizeof *curve);
    if (!curve) err_nomem(err, "a tone curve", levels * sizeof *curve);
    for (size_t i = 0; curve && i < levels; i++) curve[i] = linear_from_srgb((float)i / (float)(levels - 1));
    return curve;
}

enum status merge_brackets(struct image *radiance, uint8_t *marks, const struct photo *photos, const double *exposures,
                           int count, const struct merge_params *params, struct err *err)
{
    struct exposure_job jobs[MERGE_MOST];
    float *curves[2] = {NULL, NULL}; /* of 8 and of 16 bits */
    *radiance = (struct image){0};
    if (count < 1 || count > MERGE_MOST)
        return err_set(err, ST_DATA, "%d exposures cannot be merged; wanted 1 to %d.", count, (int)MERGE_MOST);
    enum status st = ST_OK;
    for (int k = 0; !st && k < count; k++) {
        const struct photo_info *info = &photos[k].info, *first = &photos[0].info;
        int wide = info->bits == 16;
        if (info->width != first->width || info->height != first->height)
            st = err_set(err, ST_DATA,
                         "exposure %d has %d x %d pixels, but the first one %d x %d; the exposures of a view have one "
                         "size.",
                         k + 1, info->width, info->height, first->width, first->height);
        if (!st && !(exposures[k] >= 1e-12 && exposures[k] <= 1e12))
            st = err_set(err, ST_DATA,
                         "exposure %d is %g times that of white, which cannot be; correct it in exposures.txt.", k + 1,
                         exposures[k]);
        if (!st && !curves[wide] && !(curves[wide] = make_curve(info->bits, err))) st = ST_NOMEM;
        jobs[k] = (struct exposure_job){photos[k].samples, curves[wide], (float)exposures[k]};
    }
    if (!st) st = image_init(radiance, photos[0].info.width, photos[0].info.height, 3, err);
    if (!st) {
        float saturated = (float)params->saturated, dark = (float)params->dark;
        struct merge m = {.radiance = radiance,
                          .marks = marks,
                          .exposures = jobs,
                          .count = count,
                          .saturated = saturated,
                          .trusted = SATURATED_FROM * saturated,
                          .falling = 1 / (saturated - SATURATED_FROM * saturated),
                          .dark = dark,
                          .clear = DARK_UNTIL * dark,
                          .rising = dark > 0 ? 1 / (DARK_UNTIL * dark - dark) : 0};
        parallel_for((size_t)radiance->width * (size_t)radiance->height, CHUNK, merge_chunk, &m);
    }
    free(curves[0]);
    free(curves[1]);
    return st;
}
