/* recover.c - see recover.h.
 *
 * Debevec and Malik 1997, Recovering high dynamic range radiance maps from photographs: g(z) = ln f^-1(z) of 256 levels
 * and the light ln E_i of places minimise
 *   sum w(z_ij) (g(z_ij) - ln E_i - ln t_j)^2 + lambda sum w(z) g''(z)^2,   w a hat over the levels,
 * colour by colour. The problem is linear, and each ln E_i stands in its own place's equations alone: it is eliminated
 * as they are read, so that what is left are 256 unknowns, whatever the number of places, solved by Cholesky. (A solver
 * of nonlinear problems, as Ceres, has nothing to add to that.)
 *
 * Differs in what is smooth: not g'' but z^2 g'' + z g', the bend of g over ln z, which is 0 for a power law, as tone
 * curves are much like one. So it can count for much, as it must: exposures of equal steps cannot tell a ripple of that
 * step. And in that samples are means of even places, between two levels as a rule, where g goes linearly; in that the
 * many places are taken, not some fifty; and in the scale: grey, level 128, has the light that the sRGB curve gives it,
 * in each colour. Smoothness is as much as the evidence allows: of a ladder of them the largest that explains the
 * exposures about as well as the best does, and whose curve rises everywhere.
 *
 * The evidence for a curve. Of two neighbouring exposures of a place ln f^-1(b) - ln f^-1(a) is ln(t_b / t_a) at every
 * level, if the curve is right. A wrong exposure shifts it by the same at all levels; so each pair of exposures is
 * first set right by its own median, and what is left is looked at by level. */
#include "stages/fit_response/recover.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PARAM_STRUCT struct fit_params
const struct param fit_param_table[] = {FIT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { N = RESPONSE_LEVELS, GREY = 128, TOE = 16, BINS = 12, BIN_LEAST = 20, PAIRS_LEAST = 200 };

static const float ABSENT = -1;
static const float darkest = 4.0f / 255, brightest = 251.0f / 255;      /* samples that tell something */
static const float judged_from = 40.0f / 255, judged_to = 232.0f / 255; /* samples a curve is judged by */

/* --------------------------------------------------------------------------------------------------------- places */

static float sample_at(const struct photo *p, size_t i)
{
    return (float)p->samples[i] / (p->info.bits == 16 ? 65535.0f : 255.0f);
}

/* Mean and range of 3 x 3 pixels. */
static void look_at(const struct photo *p, int x, int y, float mean[3], float *range)
{
    *range = 0;
    for (int c = 0; c < 3; c++) {
        float least = 2, most = -1, sum = 0;
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++) {
                const float v =
                    sample_at(p, 3 * ((size_t)(y + dy) * (size_t)p->info.width + (size_t)(x + dx)) + (size_t)c);
                least = fminf(least, v);
                most = fmaxf(most, v);
                sum += v;
            }
        mean[c] = sum / 9;
        *range = fmaxf(*range, most - least);
    }
}

static bool in_range(float v) { return v > darkest && v < brightest; }

static bool tells(const float rgb[3]) { return in_range(rgb[0]) || in_range(rgb[1]) || in_range(rgb[2]); }

/* How fast ln z rises with ln t. */
static float slope(const struct place_sample *a, const struct place_sample *b, int c)
{
    return a->rgb[c] > 0 ? logf(b->rgb[c] / a->rgb[c]) / (float)(b->time - a->time) : 0;
}

/* A colour that hardly follows the exposure tells nothing of the curve: a scanner's or a sensor's black level, frames
 * painted about the picture, what moved. Such samples become ABSENT. */
static void leave_out_level(struct place_sample *s, int count)
{
    const float least = 0.15f; /* of the sRGB curve it is 0.42 or more */
    bool level[RECOVER_MOST];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < count; k++)
            level[k] = !in_range(s[k].rgb[c]) || slope(k ? &s[k - 1] : s, k ? &s[k] : s + 1, c) < least;
        for (int k = 0; k < count; k++)
            if (level[k]) s[k].rgb[c] = ABSENT;
    }
}

enum status places_add(struct places *p, const struct photo *photos, const double *exposures, int count, int most,
                       struct err *err)
{
    const float even = 8.0f / 255, even_part = 0.15f;
    const int width = photos[0].info.width, height = photos[0].info.height;
    if (count < 2 || width < 3 || height < 3) return ST_OK;
    if (count > RECOVER_MOST) count = RECOVER_MOST;
    const int step = (int)fmax(3, sqrt((double)width * height / (4.0 * most)));
    const size_t columns = (size_t)((width - 2) / step + 1), rows = (size_t)((height - 2) / step + 1),
                 room = columns * rows;
    struct place_sample *samples = realloc(p->samples, (p->sample_count + room * (size_t)count) * sizeof *samples);
    if (samples) p->samples = samples;
    int *counts = realloc(p->counts, (p->count + room) * sizeof *counts);
    if (counts) p->counts = counts;
    if (!samples || !counts) return err_nomem(err, "samples of photos", room * (size_t)count * sizeof *samples);
    int added = 0;
    for (int y = 1; y < height - 1 && added < 4 * most; y += step)
        for (int x = 1; x < width - 1; x += step) {
            struct place_sample *to = p->samples + p->sample_count;
            float widest = -1;
            int n = 0;
            for (int k = 0; k < count; k++) {
                float range;
                to[n] = (struct place_sample){.exposure = k, .time = log(exposures[k])};
                look_at(&photos[k], x, y, to[n].rgb, &range);
                if (!tells(to[n].rgb)) continue;
                const float brightest_mean = fmaxf(to[n].rgb[0], fmaxf(to[n].rgb[1], to[n].rgb[2]));
                widest = fmaxf(widest, range - even - even_part * brightest_mean);
                n++;
            }
            if (n < 2 || widest > 0) continue;
            leave_out_level(to, n);
            p->counts[p->count++] = n;
            p->sample_count += (size_t)n;
            added++;
        }
    return ST_OK;
}

void places_release(struct places *p)
{
    if (!p) return;
    free(p->samples);
    free(p->counts);
    *p = (struct places){0};
}

/* -------------------------------------------------------------------------------------------------------- evidence */

struct pair {
    int exposure, colour; /* of the shorter one */
    float level, off;     /* mean of the samples; ln of the ratio's error */
};

static int by_exposure(const void *x, const void *y)
{
    const struct pair *a = x, *b = y;
    if (a->exposure != b->exposure) return a->exposure - b->exposure;
    if (a->colour != b->colour) return a->colour - b->colour;
    return (a->off > b->off) - (a->off < b->off);
}

static int by_level(const void *x, const void *y)
{
    const struct pair *a = x, *b = y;
    if (a->colour != b->colour) return a->colour - b->colour;
    const int bin_a = (int)(a->level * BINS), bin_b = (int)(b->level * BINS);
    if (bin_a != bin_b) return bin_a - bin_b;
    return (a->off > b->off) - (a->off < b->off);
}

static bool judged(float v) { return v > judged_from && v < judged_to; }

static size_t find_pairs(struct pair *pairs, const struct response *r, const struct places *p)
{
    const struct place_sample *s = p->samples;
    size_t count = 0;
    for (size_t i = 0; i < p->count; s += p->counts[i++])
        for (int k = 1; k < p->counts[i]; k++)
            for (int c = 0; c < 3; c++) {
                const struct place_sample *a = &s[k - 1], *b = &s[k];
                if (b->exposure != a->exposure + 1 || !judged(a->rgb[c]) || !judged(b->rgb[c])) continue;
                const double la = (double)response_light(r, c, a->rgb[c]), lb = (double)response_light(r, c, b->rgb[c]);
                if (!(la > 0) || !(lb > 0)) continue;
                pairs[count++] = (struct pair){a->exposure, c, (a->rgb[c] + b->rgb[c]) / 2,
                                               (float)(log(lb / la) - (b->time - a->time))};
            }
    return count;
}

/* How much the light ratio of neighbouring exposures varies with the level of light, as a part of it: 0 for the right
 * curve, also where exposures are not quite what is stated, for that is the same at all levels. pairs: how many
 * told; too few give 0. */
struct evidence {
    double spread;
    size_t pairs;
};

static enum status judge(struct evidence *e, const struct response *r, const struct places *p, struct err *err)
{
    struct pair *pairs = malloc((3 * p->sample_count + 1) * sizeof *pairs);
    *e = (struct evidence){0};
    if (!pairs) return err_nomem(err, "pairs of samples", 3 * p->sample_count * sizeof *pairs);
    e->pairs = find_pairs(pairs, r, p);
    /* each pair of exposures set right by its own median, over all colours and levels alike */
    qsort(pairs, e->pairs, sizeof *pairs, by_exposure);
    for (size_t begin = 0, end; begin < e->pairs; begin = end) {
        for (end = begin; end < e->pairs && pairs[end].exposure == pairs[begin].exposure;) end++;
        float middles[3];
        int colours = 0;
        for (size_t from = begin, to; from < end; from = to) {
            for (to = from; to < end && pairs[to].colour == pairs[from].colour;) to++;
            middles[colours++] = pairs[from + (to - from) / 2].off;
        }
        float mean = 0;
        for (int c = 0; c < colours; c++) mean += middles[c] / (float)colours;
        for (size_t i = begin; i < end; i++) pairs[i].off -= mean;
    }
    qsort(pairs, e->pairs, sizeof *pairs, by_level);
    double sum = 0, weight = 0;
    for (size_t begin = 0, end; begin < e->pairs; begin = end) {
        const int bin = (int)(pairs[begin].level * BINS);
        for (end = begin;
             end < e->pairs && pairs[end].colour == pairs[begin].colour && (int)(pairs[end].level * BINS) == bin;)
            end++;
        if (end - begin < BIN_LEAST) continue;
        const double middle = (double)pairs[begin + (end - begin) / 2].off;
        sum += middle * middle;
        weight += 1;
    }
    e->spread = weight >= 3 ? sqrt(sum / weight) : 0;
    free(pairs);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- recovery */

struct system { /* normal equations, the lower triangle */
    double a[N][N], b[N];
};

static double hat(double z) { return fmax(z < (N - 1) / 2.0 ? z : N - 1 - z, 0) / ((N - 1) / 2.0); }

/* An equation of up to three levels: sum of factors times levels = value. */
static void add_row(struct system *s, const int *levels, const double *factors, int n, double weight, double value)
{
    for (int i = 0; i < n; i++) {
        s->b[levels[i]] += weight * factors[i] * value;
        for (int k = 0; k < n; k++) s->a[levels[i]][levels[k]] += weight * factors[i] * factors[k];
    }
}

/* A place's samples, its own light eliminated. Returns the weight of what was added. */
static double add_place(struct system *s, const struct place_sample *samples, int count, int colour)
{
    double mean[N] = {0}, total = 0, time = 0;
    int seen[2 * RECOVER_MOST], n = 0;
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

/* Cholesky in place; b becomes the solution. False: not positive definite. */
static bool solve(struct system *s)
{
    for (int i = 0; i < N; i++) {
        for (int k = 0; k <= i; k++) {
            double sum = s->a[i][k];
            for (int j = 0; j < k; j++) sum -= s->a[i][j] * s->a[k][j];
            if (i == k && !(sum > 0)) return false;
            s->a[i][k] = i == k ? sqrt(sum) : sum / s->a[k][k];
        }
        for (int j = 0; j < i; j++) s->b[i] -= s->a[i][j] * s->b[j];
        s->b[i] /= s->a[i][i];
    }
    for (int i = N - 1; i >= 0; i--) {
        for (int j = i + 1; j < N; j++) s->b[i] -= s->a[j][i] * s->b[j];
        s->b[i] /= s->a[i][i];
    }
    return true;
}

/* A colour's equations without smoothness; *weight: of all its samples. */
static enum status set_up(struct system *s, double *weight, const struct places *p, int colour, struct err *err)
{
    static const double one = 1;
    const struct place_sample *at = p->samples;
    const int grey = GREY;
    *weight = 0;
    memset(s, 0, sizeof *s);
    for (size_t i = 0; i < p->count; at += p->counts[i++]) *weight += add_place(s, at, p->counts[i], colour);
    if (!(*weight > N / 4.0))
        return err_set(err, ST_DATA,
                       "too few places are well exposed in two photos to recover how samples follow light.");
    add_row(s, &grey, &one, 1, *weight, (double)logf(linear_from_srgb((float)GREY / (N - 1))));
    return ST_OK;
}

/* False: the curve falls somewhere. s is used up. */
static bool solve_smooth(float light[N], struct system *s, double smoothness)
{
    const double ends = 0.02; /* of smoothness, at black and white, where no sample counts */
    for (int z = 1; z < N - 1; z++) {
        const double reach = fmax(z, TOE) / GREY, bend = reach * reach, lean = bend / (2 * z);
        const double factors[3] = {bend - lean, -2 * bend, bend + lean};
        const int levels[3] = {z - 1, z, z + 1};
        add_row(s, levels, factors, 3, smoothness * fmax(hat(z), ends), 0);
    }
    bool rises = solve(s);
    for (int z = 1; rises && z < N; z++) rises = s->b[z] > s->b[z - 1];
    for (int z = 0; rises && z < N; z++) light[z] = (float)exp(s->b[z]);
    return rises;
}

/* Least squares. ST_DATA: too little to go by. */
static enum status recover(struct response *r, const struct places *p, struct err *err)
{
    static const double ladder[] = {10, 30, 100, 300, 1000, 3000, 10000};
    enum { RUNGS = sizeof ladder / sizeof *ladder };
    const double as_good = 1.2, as_small = 0.002;
    struct response curves[RUNGS];
    struct evidence e[RUNGS];
    bool rises[RUNGS];
    struct system *s = malloc(4 * sizeof *s); /* the colours', and one to solve */
    double weights[3], least = HUGE_VAL;
    enum status st = s ? ST_OK : err_nomem(err, "a system of equations", 4 * sizeof *s);
    *r = (struct response){0};
    for (int c = 0; !st && c < 3; c++) st = set_up(&s[c], &weights[c], p, c, err);
    for (int i = 0; !st && i < RUNGS; i++) {
        curves[i] = (struct response){.table = true};
        rises[i] = true;
        for (int c = 0; c < 3; c++) {
            s[3] = s[c];
            rises[i] &= solve_smooth(curves[i].light[c], &s[3], ladder[i] * weights[c]);
        }
        if (rises[i]) st = judge(&e[i], &curves[i], p, err);
        if (!st && rises[i]) least = fmin(least, e[i].spread);
    }
    for (int i = 0; !st && i < RUNGS; i++)
        if (rises[i] && e[i].spread <= as_good * least + as_small) *r = curves[i];
    if (!st && !r->table)
        st = err_set(err, ST_DATA, "what the photos show gives no curve that rises; their exposures must be wrong.");
    free(s);
    return st;
}

enum status response_decide(struct response *r, char told[RESPONSE_TOLD], const struct places *p,
                            const struct fit_params *params, struct err *err)
{
    const double better = 0.5; /* a recovered curve must halve what the sRGB curve leaves */
    const bool must = !strcmp(params->response, "recover");
    struct evidence srgb, table;
    struct response curve;
    *r = (struct response){0};
    enum status st = judge(&srgb, r, p, err);
    if (st) return st;
    if (!strcmp(params->response, "srgb")) {
        snprintf(told, RESPONSE_TOLD, "the sRGB curve, as [fit_response] response = srgb says");
        return ST_OK;
    }
    if (!must && srgb.pairs < PAIRS_LEAST) {
        snprintf(told, RESPONSE_TOLD, "the sRGB curve: too few places are well exposed in two photos to tell another");
        return ST_OK;
    }
    if (!must && srgb.spread <= params->most_spread) {
        snprintf(told, RESPONSE_TOLD, "the sRGB curve: ratios of exposures vary by %.1f %% over the levels of light",
                 100 * srgb.spread);
        return ST_OK;
    }
    st = recover(&curve, p, err);
    if (!st) st = judge(&table, &curve, p, err);
    if (st) return st;
    if (must || table.spread < better * srgb.spread) {
        *r = curve;
        snprintf(told, RESPONSE_TOLD,
                 "recovered from the exposures: ratios of exposures vary by %.1f %% over the levels of light by the "
                 "sRGB curve, by %.1f %% by this one",
                 100 * srgb.spread, 100 * table.spread);
    } else {
        snprintf(told, RESPONSE_TOLD,
                 "the sRGB curve, though ratios of exposures vary by %.1f %% over the levels of light, for a recovered "
                 "curve does no better (%.1f %%)",
                 100 * srgb.spread, 100 * table.spread);
    }
    return ST_OK;
}
