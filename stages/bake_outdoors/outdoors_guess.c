/* outdoors_guess.c - what lies in directions that no picture shows.
 *
 * Overview. The outdoors depend on elevation more than on anything else: the sky is above the horizon, the ground
 * below. So the known pixels are split into a profile, the median colour of each row, and the residual, by which a
 * pixel differs from its row. The profile is carried on to rows of which little or nothing is known, without crossing
 * the horizon; the residual is carried on in all directions, so that a guess joins what is known without an edge. Both
 * are logarithms: a guess is never negative, and the sun, which is 10^5 times brighter than the sky, does not spread.
 *
 * Mathematics. Both are pull-push [Gortler 1996, 5.1]. Pull: a coarser level holds the weighted means of pairs of rows
 * (of 2 x 2 pixels), its weight the sum of theirs, at most 1. Push: from the coarsest level down, a value v of weight w
 * becomes w v + (1 - w) coarser, the coarser level interpolated bilinearly; columns wrap around. A row's weight is the
 * share of it that is known. A side of the horizon of which nothing is known takes the mean profile of the other side.
 * What stands at one place says little of places far from it: from FAR_LEVEL up, a residual becomes smaller by FADE at
 * each level. All columns of a row meet in a pole, so it also fades out within POLE degrees of one.
 *
 * What differs from the source: the profile, and logarithms. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/bake_outdoors/outdoors_gather.h"

enum { MAX_LEVELS = 16, FAR_LEVEL = 5, ROWS = 8 };
enum { STRIDE = 4 };  /* every STRIDE-th known pixel counts for a row's median */
#define POLE    15.0  /* degrees */
#define FADE    0.75f /* of a residual, from one level to the next coarser one */
#define DARKEST 1e-4  /* of the mean radiance: darker pixels count as that dark */

/* Values and their weights, 4 a pixel: three colours times the weight, and the weight. */
struct level {
    int width, height;
    float *v; /* owned */
};

static float *pixel(const struct level *l, int x, int y)
{
    return l->v + 4 * ((size_t)y * (size_t)l->width + (size_t)x);
}

static enum status level_init(struct level *l, int width, int height, struct err *err)
{
    *l = (struct level){width, height, calloc((size_t)width * (size_t)height, 4 * sizeof(float))};
    return l->v ? ST_OK : err_nomem(err, "a level of a picture", (size_t)width * (size_t)height * 16);
}

/* Means of 2 x 2 pixels, times `fade`; of 1 x 2 in a column. */
static void pull(struct level *to, const struct level *from, float fade)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            float *out = pixel(to, x, y);
            for (int k = 0; k < 4; k++) {
                const int sx = 2 * x + (k & 1), sy = 2 * y + (k >> 1);
                if (sx >= from->width || sy >= from->height) continue;
                for (int c = 0; c < 4; c++) out[c] += pixel(from, sx, sy)[c];
            }
            const float scale = out[3] > 1 ? 1 / out[3] : 1;
            for (int c = 0; c < 4; c++) out[c] *= c < 3 ? scale * fade : scale;
        }
}

/* What is missing of a weight of 1 comes from the coarser level, whose weights are 1. */
static void push(struct level *to, const struct level *from)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            float *out = pixel(to, x, y);
            const float missing = 1 - out[3];
            if (!(missing > 0)) continue;
            const float u = ((float)x + 0.5f) / 2 - 0.5f, v = ((float)y + 0.5f) / 2 - 0.5f;
            const int left = (int)floorf(u), top = (int)floorf(v);
            for (int k = 0; k < 4; k++) {
                const float wx = k & 1 ? u - (float)left : 1 - u + (float)left;
                const float wy = k >> 1 ? v - (float)top : 1 - v + (float)top;
                const int sx = (left + (k & 1) + from->width) % from->width;
                const int sy = clamp_int(top + (k >> 1), 0, from->height - 1);
                for (int c = 0; c < 4; c++) out[c] += missing * wx * wy * pixel(from, sx, sy)[c];
            }
        }
}

/* Gives every pixel of `base` the weight 1. Where no pixel has any weight, all become `fallback`. fade: of each level
 * from FAR_LEVEL up. */
static enum status pull_push(struct level *base, float fade, const float fallback[3], struct err *err)
{
    struct level levels[MAX_LEVELS] = {*base};
    int count = 1;
    for (; !err->status && (levels[count - 1].width > 1 || levels[count - 1].height > 1); count++) {
        const struct level *fine = &levels[count - 1];
        if (!level_init(&levels[count], (fine->width + 1) / 2, (fine->height + 1) / 2, err))
            pull(&levels[count], fine, count < FAR_LEVEL ? 1 : fade);
    }
    for (int k = count - 1; !err->status && k >= 0; k--) {
        if (k < count - 1) {
            push(&levels[k], &levels[k + 1]);
            continue;
        }
        float *top = levels[k].v;
        for (int c = 0; c < 3; c++) top[c] = top[3] > 0 ? top[c] / top[3] : fallback[c];
        top[3] = 1;
    }
    for (int k = 1; k < count; k++) free(levels[k].v);
    return err->status;
}

/* The mean of all known samples, times DARKEST; 0 if nothing is known or all is black. */
static double darkest_of(const struct outdoors *o)
{
    const size_t pixels = (size_t)o->width * (size_t)o->height;
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3 && o->source[i]; c++) {
            sum += (double)o->rgb[3 * i + c];
            count++;
        }
    return count ? DARKEST * sum / (double)count : 0;
}

static void take_logarithms(struct level *l, const struct outdoors *o, double darkest)
{
    const size_t pixels = (size_t)o->width * (size_t)o->height;
    for (size_t i = 0; i < pixels; i++) {
        if (!o->source[i]) continue;
        for (size_t c = 0; c < 3; c++) l->v[4 * i + c] = logf(fmaxf(o->rgb[3 * i + c], (float)darkest));
        l->v[4 * i + 3] = 1;
    }
}

/* The median colour of a row's known pixels, weighted by the share that is known. */
static void sum_row(float out[4], const struct level *known, int y, struct weighted *scratch)
{
    size_t seen = 0;
    for (int x = 0; x < known->width; x++) seen += pixel(known, x, y)[3] > 0;
    out[3] = (float)seen / (float)known->width;
    for (int c = 0; c < 3; c++) {
        size_t count = 0, at = 0;
        for (int x = 0; x < known->width; x++)
            if (pixel(known, x, y)[3] > 0 && at++ % STRIDE == 0)
                scratch[count++] = (struct weighted){(double)pixel(known, x, y)[c], 1};
        out[c] = out[3] * (float)weighted_percentile(scratch, count, 0.5);
    }
}

struct row_job {
    const struct level *known, *column;
    struct weighted *scratch; /* a row for each thread */
    int first;
};

static void sum_row_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct row_job *job = ctx;
    struct weighted *scratch = job->scratch + (size_t)thread * (size_t)job->known->width;
    for (size_t y = begin; y < end; y++)
        sum_row(pixel(job->column, 0, (int)y), job->known, job->first + (int)y, scratch);
}

/* One side of the horizon: rows from `first`, a column of a pixel a row. */
static enum status sum_rows(struct level *column, const struct level *known, int first, struct err *err)
{
    if (level_init(column, 1, known->height / 2, err)) return err->status;
    struct row_job job = {known, column, NULL, first};
    const size_t samples = (size_t)known->width * (size_t)parallel_threads();
    job.scratch = malloc(samples * sizeof *job.scratch);
    if (!job.scratch) return err_nomem(err, "rows", samples * sizeof *job.scratch);
    parallel_for((size_t)column->height, ROWS, sum_row_range, &job);
    free(job.scratch);
    return ST_OK;
}

/* The mean of a side's rows; false: nothing is known of it. */
static bool mean_of(float mean[3], const struct level *column)
{
    double sum[4] = {0};
    for (int y = 0; y < column->height; y++)
        for (int c = 0; c < 4; c++) sum[c] += (double)pixel(column, 0, y)[c];
    for (int c = 0; c < 3 && sum[3] > 0; c++) mean[c] = (float)(sum[c] / sum[3]);
    return sum[3] > 0;
}

/* profile: 4 a row. */
static enum status find_profile(float *profile, const struct level *known, struct err *err)
{
    const int half = known->height / 2;
    struct level sides[2] = {{0}};
    float means[2][3] = {{0}};
    if (!sum_rows(&sides[0], known, 0, err)) sum_rows(&sides[1], known, half, err);
    for (int k = 0; !err->status && k < 2; k++)
        if (!mean_of(means[k], &sides[k])) mean_of(means[k], &sides[1 - k]);
    for (int k = 0; !err->status && k < 2; k++) {
        if (!pull_push(&sides[k], 1, means[k], err))
            memcpy(profile + 4 * (size_t)(k * half), sides[k].v, (size_t)half * 4 * sizeof *profile);
    }
    free(sides[0].v);
    free(sides[1].v);
    return err->status;
}

/* Leaves the residual in pixels that are known. */
static void subtract_profile(struct level *l, const float *profile)
{
    for (int y = 0; y < l->height; y++)
        for (int x = 0; x < l->width; x++)
            for (int c = 0; c < 3 && pixel(l, x, y)[3] > 0; c++) pixel(l, x, y)[c] -= profile[4 * y + c];
}

static void fill(struct outdoors *o, const struct level *residual, const float *profile)
{
    for (int y = 0; y < o->height; y++) {
        const double from_pole = 90 - fabs(90 - 180 * (y + 0.5) / o->height);
        const float share = (float)fmin(1, from_pole / POLE);
        for (int x = 0; x < o->width; x++) {
            const size_t i = (size_t)y * (size_t)o->width + (size_t)x;
            for (size_t c = 0; c < 3 && !o->source[i]; c++)
                o->rgb[3 * i + c] = expf(profile[4 * (size_t)y + c] + share * residual->v[4 * i + c]);
        }
    }
}

enum status outdoors_guess(struct outdoors *o, struct err *err)
{
    static const float none[3] = {0};
    const double darkest = darkest_of(o);
    struct level known = {0};
    float *profile = calloc((size_t)o->height, 4 * sizeof *profile);
    if (!profile) err_nomem(err, "a profile", (size_t)o->height * 16);
    if (!err->status && darkest > 0 && !level_init(&known, o->width, o->height, err)) {
        take_logarithms(&known, o, darkest);
        if (!find_profile(profile, &known, err)) subtract_profile(&known, profile);
        if (!err->status && !pull_push(&known, FADE, none, err)) fill(o, &known, profile);
    }
    free(known.v);
    free(profile);
    return err->status;
}
