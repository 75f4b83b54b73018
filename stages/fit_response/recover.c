/* recover.c - recovers the response curve of a camera from bracketed exposures [Debevec 1997].
 *
 * The inverse response f^-1 maps a sample z to light. For each colour, g(z) = ln f^-1(z) at 256 levels and the log
 * light ln E_i of the patches i minimise
 *   sum w(z_ij) (g(z_ij) - ln E_i - ln t_j)^2 + lambda sum w(z) g''(z)^2,
 * where t_j are the exposures and w is a hat over the levels. The problem is linear. Each ln E_i occurs only in the
 * equations of its own patch and is eliminated when they are added; 256 unknowns remain for any number of patches,
 * solved by Cholesky factorisation.
 *
 * Differs from the source:
 * - The smoothness term is not g'' but z^2 g'' + z g', the second derivative of g over ln z. It is 0 for a power law,
 *   which tone curves resemble, so lambda can be large. It must be: exposures in equal steps cannot detect a ripple
 *   with the period of the step.
 * - Samples are means of uniform patches, usually between two levels, where g is interpolated linearly.
 * - Thousands of patches are used, not about fifty.
 * - The scale: level 128 has the light of the sRGB curve, in each colour.
 * - lambda is the largest of a list whose curve rises everywhere and explains the exposures about as well as the best.
 *
 * How well a curve explains the exposures: for samples a and b of a patch in neighbouring exposures, ln f^-1(b) - ln
 * f^-1(a) equals ln(t_b / t_a) at every level if the curve is right. A wrong exposure adds a constant at all levels. So
 * the median error of each pair of exposures is subtracted first; the rest, by level, is the error of the curve. */
#include "stages/fit_response/recover.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"

#define PARAM_STRUCT struct fit_params
const struct param fit_param_table[] = {FIT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { N = RESPONSE_LEVELS, GREY = 128, TOE = 16, BINS = 12, MIN_BIN = 20, MIN_PAIRS = 200 };

static const float ABSENT = -1;
static const float darkest = 4.0f / 255, brightest = 251.0f / 255;      /* of usable samples */
static const float judged_from = 40.0f / 255, judged_to = 232.0f / 255; /* of samples that a curve is judged by */

/* --------------------------------------------------------------------------------------------------------- patches */

static float sample_at(const struct photo *p, size_t i)
{
    return (float)p->samples[i] / (p->info.bits == 16 ? 65535.0f : 255.0f);
}

/* Mean and range of 3 x 3 pixels. */
static void patch_mean(const struct photo *p, int x, int y, float mean[3], float *range)
{
    *range = 0;
    for (int c = 0; c < 3; c++) {
        float min = 2, max = -1, sum = 0;
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++) {
                const float v =
                    sample_at(p, 3 * ((size_t)(y + dy) * (size_t)p->info.width + (size_t)(x + dx)) + (size_t)c);
                min = fminf(min, v);
                max = fmaxf(max, v);
                sum += v;
            }
        mean[c] = sum / 9;
        *range = fmaxf(*range, max - min);
    }
}

static bool in_range(float v) { return v > darkest && v < brightest; }

static bool is_usable(const float rgb[3]) { return in_range(rgb[0]) || in_range(rgb[1]) || in_range(rgb[2]); }

/* The slope of ln z over ln t. */
static float slope(const struct patch_sample *a, const struct patch_sample *b, int c)
{
    return a->rgb[c] > 0 ? logf(b->rgb[c] / a->rgb[c]) / (float)(b->time - a->time) : 0;
}

/* Marks samples as ABSENT if a colour hardly changes with the exposure: the black level of a sensor or scanner, painted
 * frames, moving objects. */
static void drop_constant(struct patch_sample *s, int count)
{
    const float min_slope = 0.15f; /* the sRGB curve has 0.42 or more */
    bool constant[RECOVER_MAX_EXPOSURES];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < count; k++) {
            int a = k - 1, b = k + 1; /* the nearest other exposure: some may be equal */
            while (a >= 0 && !(s[a].time < s[k].time)) a--;
            while (b < count && !(s[b].time > s[k].time)) b++;
            const bool other = a >= 0 || b < count;
            constant[k] = !in_range(s[k].rgb[c]) || !other ||
                          slope(a >= 0 ? &s[a] : &s[k], a >= 0 ? &s[k] : &s[b], c) < min_slope;
        }
        for (int k = 0; k < count; k++)
            if (constant[k]) s[k].rgb[c] = ABSENT;
    }
}

enum status recover_add_patches(struct patches *p, const struct photo *photos, const double *exposures, int count,
                                int max_patches, struct err *err)
{
    const float max_range = 8.0f / 255, max_relative = 0.15f; /* of a uniform patch: constant, and by its mean */
    const int width = photos[0].info.width, height = photos[0].info.height;
    if (count < 2 || width < 3 || height < 3) return ST_OK;
    if (count > RECOVER_MAX_EXPOSURES) count = RECOVER_MAX_EXPOSURES;
    const int step = (int)fmax(3, sqrt((double)width * height / (4.0 * max_patches)));
    const size_t columns = (size_t)((width - 2) / step + 1), rows = (size_t)((height - 2) / step + 1),
                 room = columns * rows;
    struct patch_sample *samples = realloc(p->samples, (p->sample_count + room * (size_t)count) * sizeof *samples);
    if (samples) p->samples = samples;
    int *counts = realloc(p->counts, (p->count + room) * sizeof *counts);
    if (counts) p->counts = counts;
    if (!samples || !counts) return err_nomem(err, "samples of photos", room * (size_t)count * sizeof *samples);
    int added = 0;
    for (int y = 1; y < height - 1 && added < 4 * max_patches; y += step)
        for (int x = 1; x < width - 1; x += step) {
            struct patch_sample *to = p->samples + p->sample_count;
            float widest = -1;
            int n = 0;
            for (int k = 0; k < count; k++) {
                float range;
                to[n] = (struct patch_sample){.exposure = k, .time = log(exposures[k])};
                patch_mean(&photos[k], x, y, to[n].rgb, &range);
                if (!is_usable(to[n].rgb)) continue;
                const float brightest_mean = fmaxf(to[n].rgb[0], fmaxf(to[n].rgb[1], to[n].rgb[2]));
                widest = fmaxf(widest, range - max_range - max_relative * brightest_mean);
                n++;
            }
            if (n < 2 || widest > 0) continue;
            drop_constant(to, n);
            p->counts[p->count++] = n;
            p->sample_count += (size_t)n;
            added++;
        }
    return ST_OK;
}

void recover_release_patches(struct patches *p)
{
    if (!p) return;
    free(p->samples);
    free(p->counts);
    *p = (struct patches){0};
}

/* -------------------------------------------------------------------------------------------------------- evidence */

/* A patch in two neighbouring exposures. */
struct level_ratio {
    int exposure, colour; /* of the shorter exposure */
    float level, error;   /* mean of the samples; ln of the ratio over the stated one */
};

static int by_exposure(const void *x, const void *y)
{
    const struct level_ratio *a = x, *b = y;
    if (a->exposure != b->exposure) return a->exposure - b->exposure;
    if (a->colour != b->colour) return a->colour - b->colour;
    return (a->error > b->error) - (a->error < b->error);
}

static int by_level(const void *x, const void *y)
{
    const struct level_ratio *a = x, *b = y;
    if (a->colour != b->colour) return a->colour - b->colour;
    const int bin_a = (int)(a->level * BINS), bin_b = (int)(b->level * BINS);
    if (bin_a != bin_b) return bin_a - bin_b;
    return (a->error > b->error) - (a->error < b->error);
}

static bool judged(float v) { return v > judged_from && v < judged_to; }

static size_t find_pairs(struct level_ratio *pairs, const struct response *r, const struct patches *p)
{
    const struct patch_sample *s = p->samples;
    size_t count = 0;
    for (size_t i = 0; i < p->count; s += p->counts[i++])
        for (int k = 1; k < p->counts[i]; k++)
            for (int c = 0; c < 3; c++) {
                const struct patch_sample *a = &s[k - 1], *b = &s[k];
                if (b->exposure != a->exposure + 1 || !(b->time > a->time) || !judged(a->rgb[c]) || !judged(b->rgb[c]))
                    continue;
                const double la = (double)response_light(r, c, a->rgb[c]), lb = (double)response_light(r, c, b->rgb[c]);
                if (!(la > 0) || !(lb > 0)) continue;
                pairs[count++] = (struct level_ratio){a->exposure, c, (a->rgb[c] + b->rgb[c]) / 2,
                                                      (float)(log(lb / la) - (b->time - a->time))};
            }
    return count;
}

/* How well a curve explains the exposures. spread: relative RMS variation of exposure ratios over the levels of light.
 * It is 0 for the right curve, even if the stated exposures are inexact, and if there are too few pairs. */
struct evidence {
    double spread;
    size_t pairs; /* number of sample pairs */
};

static enum status judge(struct evidence *e, const struct response *r, const struct patches *p, struct err *err)
{
    struct level_ratio *pairs = malloc((3 * p->sample_count + 1) * sizeof *pairs);
    *e = (struct evidence){0};
    if (!pairs) return err_nomem(err, "pairs of samples", 3 * p->sample_count * sizeof *pairs);
    e->pairs = find_pairs(pairs, r, p);
    /* subtract from each pair of exposures its mean over the colours of the median error */
    qsort(pairs, e->pairs, sizeof *pairs, by_exposure);
    for (size_t begin = 0, end; begin < e->pairs; begin = end) {
        for (end = begin; end < e->pairs && pairs[end].exposure == pairs[begin].exposure;) end++;
        float medians[3];
        int colours = 0;
        for (size_t from = begin, to; from < end; from = to) {
            for (to = from; to < end && pairs[to].colour == pairs[from].colour;) to++;
            medians[colours++] = pairs[from + (to - from) / 2].error;
        }
        float mean = 0;
        for (int c = 0; c < colours; c++) mean += medians[c] / (float)colours;
        for (size_t i = begin; i < end; i++) pairs[i].error -= mean;
    }
    qsort(pairs, e->pairs, sizeof *pairs, by_level);
    double sum = 0, weight = 0;
    for (size_t begin = 0, end; begin < e->pairs; begin = end) {
        const int bin = (int)(pairs[begin].level * BINS);
        for (end = begin;
             end < e->pairs && pairs[end].colour == pairs[begin].colour && (int)(pairs[end].level * BINS) == bin;)
            end++;
        if (end - begin < MIN_BIN) continue;
        const double median = (double)pairs[begin + (end - begin) / 2].error;
        sum += median * median;
        weight += 1;
    }
    e->spread = weight >= 3 ? sqrt(sum / weight) : 0;
    free(pairs);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- recovery */

struct normal_equations {
    double a[N][N], b[N];
};

static double hat(double z) { return fmax(z < (N - 1) / 2.0 ? z : N - 1 - z, 0) / ((N - 1) / 2.0); }

/* Adds an equation in up to three unknowns: sum of factors * g(levels) = value. */
static void add_row(struct normal_equations *s, const int *levels, const double *factors, int n, double weight,
                    double value)
{
    for (int i = 0; i < n; i++) {
        s->b[levels[i]] += weight * factors[i] * value;
        for (int k = 0; k < n; k++) s->a[levels[i]][levels[k]] += weight * factors[i] * factors[k];
    }
}

/* Adds the samples of a patch and eliminates its light. Returns the sum of their weights. */
static double add_patch(struct normal_equations *s, const struct patch_sample *samples, int count, int colour)
{
    double mean[N] = {0}, total = 0, time = 0;
    int seen[2 * RECOVER_MAX_EXPOSURES], n = 0;
    for (int k = 0; k < count; k++) total += hat((double)samples[k].rgb[colour] * (N - 1));
    if (!(total > 0.1)) return 0;
    for (int k = 0; k < count; k++) {
        const double z = (double)samples[k].rgb[colour] * (N - 1), w = hat(z);
        if (!(w > 0)) continue;
        const int below = z < N - 2 ? (int)z : N - 2, levels[2] = {below, below + 1};
        const double part = z - below, factors[2] = {1 - part, part};
        add_row(s, levels, factors, 2, w, samples[k].time);
        for (int i = 0; i < 2; i++) {
            if (mean[levels[i]] == 0) seen[n++] = levels[i];
            mean[levels[i]] += w * factors[i] / total;
        }
        time += w * samples[k].time / total;
    }
    for (int i = 0; i < n; i++) {
        if (mean[seen[i]] == 0) continue;
        for (int k = 0; k < n; k++) s->a[seen[i]][seen[k]] -= total * mean[seen[i]] * mean[seen[k]];
        s->b[seen[i]] -= total * mean[seen[i]] * time;
    }
    return total;
}

/* Solves in place; b becomes the solution. False: not positive definite. */
static bool solve(struct normal_equations *s)
{
    if (!cholesky_factor(&s->a[0][0], N)) return false;
    cholesky_forward(&s->a[0][0], N, s->b);
    cholesky_backward(&s->a[0][0], N, s->b);
    return true;
}

/* The equations of a colour without smoothness; *weight: the sum over its samples. */
static enum status set_up(struct normal_equations *s, double *weight, const struct patches *p, int colour,
                          struct err *err)
{
    static const double one = 1;
    const struct patch_sample *at = p->samples;
    const int grey = GREY;
    *weight = 0;
    memset(s, 0, sizeof *s);
    for (size_t i = 0; i < p->count; at += p->counts[i++]) *weight += add_patch(s, at, p->counts[i], colour);
    if (!(*weight > N / 4.0))
        return err_set(err, ST_DATA,
                       "too few patches are well exposed in two photos to recover the response curve; set "
                       "[fit_response] response = "
                       "srgb, or take more exposures.");
    add_row(s, &grey, &one, 1, *weight, (double)logf(linear_from_srgb((float)GREY / (N - 1))));
    return ST_OK;
}

/* Adds smoothness and solves; overwrites s. False: the curve falls somewhere. */
static bool solve_smooth(float light[N], struct normal_equations *s, double smoothness)
{
    const double min_weight = 0.02; /* of smoothness at black and white, where samples have no weight */
    for (int z = 1; z < N - 1; z++) {
        const double scale = fmax(z, TOE) / GREY, second = scale * scale,
                     first = second / (2 * z); /* of g'', of g' / 2 */
        const double factors[3] = {second - first, -2 * second, second + first};
        const int levels[3] = {z - 1, z, z + 1};
        add_row(s, levels, factors, 3, smoothness * fmax(hat(z), min_weight), 0);
    }
    bool rises = solve(s);
    for (int z = 1; rises && z < N; z++) rises = s->b[z] > s->b[z - 1];
    for (int z = 0; rises && z < N; z++) light[z] = (float)exp(s->b[z]);
    return rises;
}

/* Solves for each smoothness and chooses one. ST_DATA: too few patches, or no curve that rises. */
static enum status recover(struct response *r, const struct patches *p, struct err *err)
{
    static const double smoothness[] = {10, 30, 100, 300, 1000, 3000, 10000};
    enum { STEPS = sizeof smoothness / sizeof *smoothness };
    const double tolerance = 1.2, min_spread = 0.002; /* relative to the smallest spread; absolute */
    struct response curves[STEPS];
    struct evidence e[STEPS];
    bool rises[STEPS];
    struct normal_equations *s = malloc(4 * sizeof *s); /* one per colour, and one to solve */
    double weights[3], smallest = HUGE_VAL;
    if (!s) err_nomem(err, "a system of equations", 4 * sizeof *s);
    *r = (struct response){0};
    for (int c = 0; !err->status && c < 3; c++) set_up(&s[c], &weights[c], p, c, err);
    for (int i = 0; !err->status && i < STEPS; i++) {
        curves[i] = (struct response){.table = true};
        rises[i] = true;
        for (int c = 0; c < 3; c++) {
            s[3] = s[c];
            rises[i] &= solve_smooth(curves[i].light[c], &s[3], smoothness[i] * weights[c]);
        }
        if (rises[i]) judge(&e[i], &curves[i], p, err);
        if (!err->status && rises[i]) smallest = fmin(smallest, e[i].spread);
    }
    for (int i = 0; !err->status && i < STEPS; i++)
        if (rises[i] && e[i].spread <= tolerance * smallest + min_spread) *r = curves[i];
    if (!err->status && !r->table)
        err_set(err, ST_DATA, "no rising response curve explains the photos; correct their exposures (exposures.txt).");
    free(s);
    return err->status;
}

enum status recover_decide(struct response *r, char summary[RESPONSE_SUMMARY], const struct patches *p,
                           const struct fit_params *params, struct err *err)
{
    const double improvement = 0.5; /* a recovered curve must halve the spread of the sRGB curve */
    const bool forced = !strcmp(params->response, "recover");
    struct evidence srgb, table;
    struct response curve;
    *r = (struct response){0};
    if (judge(&srgb, r, p, err)) return err->status;
    if (!strcmp(params->response, "srgb")) {
        snprintf(summary, RESPONSE_SUMMARY, "sRGB, set by [fit_response] response = srgb");
        return ST_OK;
    }
    if (!forced && srgb.pairs < MIN_PAIRS) {
        snprintf(summary, RESPONSE_SUMMARY, "sRGB: too few patches are well exposed in two photos to judge it");
        return ST_OK;
    }
    if (!forced && srgb.spread <= params->max_spread) {
        snprintf(summary, RESPONSE_SUMMARY, "sRGB: exposure ratios vary by %.1f %% over the levels of light",
                 100 * srgb.spread);
        return ST_OK;
    }
    if (!recover(&curve, p, err)) judge(&table, &curve, p, err);
    if (err->status) return err->status;
    if (forced || table.spread < improvement * srgb.spread) {
        *r = curve;
        snprintf(
            summary, RESPONSE_SUMMARY,
            "recovered: exposure ratios vary by %.1f %% over the levels of light with the sRGB curve, by %.1f %% with "
            "this one",
            100 * srgb.spread, 100 * table.spread);
    } else {
        snprintf(
            summary, RESPONSE_SUMMARY,
            "sRGB, although exposure ratios vary by %.1f %% over the levels of light: a recovered curve is not better "
            "(%.1f %%)",
            100 * srgb.spread, 100 * table.spread);
    }
    return ST_OK;
}
