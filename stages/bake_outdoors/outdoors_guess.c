/* outdoors_guess.c - what lies in directions that no picture shows.
 *
 * Overview. Above the horizon there is sky, and in front of it, up to some height, what is solid: houses and trees.
 * Below it there is ground. Sky continues sky, and solids continue solids, or a tree in a window would darken the sky
 * above it and a row of houses would become a grey band around the horizon.
 *   1. Known pixels are sorted into sky and solid. In each column the sky is what lies on top, down to the first place
 *      where it becomes darker by more than EDGE within a few pixels; a column whose top is much darker than most tops
 *      shows no sky.
 *   2. A standard sky is fitted to the known sky (sky_fit.c). What is darker than that by more than DARKER is solid, a
 *      house of which only the wall is seen, and the sky is fitted again. Solids above the horizon, and the ground,
 *      have one median colour each. The share of solids at a height is that of the known pixels there; it never grows
 *      with height.
 *   3. How the known pixels differ from that, in logarithms, is carried on in all directions, and fades (pull_push.c):
 *      of sky, of solids, and of the share of solids. So a guess joins what is known without an edge, and far from it
 *      is the fitted sky above a haze of houses. A guess is share x solid + (1 - share) x sky, which is the light that
 *      comes from there on average.
 *
 * Logarithms are cut off at FARTHEST, so that the sun, which is 10^5 times brighter than the sky, does not spread. All
 * columns of a row meet in a pole, so differences also fade out within POLE degrees of one. Where no sky or no ground
 * is known, the median colour of the rest stands for it. */
#include "stages/bake_outdoors/outdoors_guess.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/bake_outdoors/pull_push.h"

enum kind { UNKNOWN, SKY, SOLID };
enum {
    ROWS = 8,
    ROUNDS = 3,
    SAMPLED = 96,
    SMOOTH = 8
}; /* rows of a picture that medians are taken from; px of the running level */
static const double EDGE = 0.2, FLASH = 0.7, MUCH_DARKER = 1.4, DARKER = 0.45; /* logarithms */
static const double FARTHEST = 1.5;                                            /* of a difference, a logarithm */
static const double POLE = 15;                                                 /* degrees */
static const double DARKEST = 1e-4; /* of the mean radiance: darker pixels count as that dark */
static const double BELT = 1.5;     /* degrees: above and below, over which shares of solids are averaged */
static const double FEW = 0.01;     /* of a row's pixels, added to those that are known */

static const struct fading of_colours = {5, 0.75f}, of_shares = {5, 0.6f};

struct guess {
    struct outdoors *o;
    uint8_t *kind; /* of each pixel */
    float *share;  /* of solids in each pixel */
    double *prior; /* the same of each row, where no picture is near; then as many rows before they are smooth */
    float darkest;
    struct sky_fit sky;
    double solid[2][3]; /* logarithms: above the horizon, below */
    double any[3];      /* of all known pixels */
    struct level differences;
};

static size_t pixel_of(const struct guess *g, int x, int y) { return (size_t)y * (size_t)g->o->width + (size_t)x; }

static void level_of(double level[3], const struct guess *g, size_t at)
{
    for (size_t c = 0; c < 3; c++) level[c] = (double)logf(fmaxf(g->o->rgb[3 * at + c], g->darkest));
}

static double brightness(const struct guess *g, size_t at)
{
    return (double)logf(fmaxf(luminance_of(g->o->rgb + 3 * at), g->darkest));
}

static double solid_angle(const struct guess *g, int y)
{
    return cos(PI / 2 - PI * (y + 0.5) / g->o->height) * 2 * PI * PI / g->o->width / g->o->height;
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

/* -------------------------------------------------------------------------------------------- sky and what is not */

/* The first known pixel of a column from row y on, at most half the height: none. */
static int next_known(const struct guess *g, int x, int y)
{
    while (y < g->o->height / 2 && !g->o->source[pixel_of(g, x, y)]) y++;
    return y;
}

static int end_of_run(const struct guess *g, int x, int y)
{
    while (y < g->o->height / 2 && g->o->source[pixel_of(g, x, y)]) y++;
    return y;
}

/* The brightness of most tops of columns, which counts as that of the sky. */
static enum status find_tops(double *usual, const struct guess *g, struct err *err)
{
    struct weighted *tops = malloc((size_t)g->o->width * sizeof *tops);
    size_t count = 0;
    if (!tops) return err_nomem(err, "columns", (size_t)g->o->width * sizeof *tops);
    for (int x = 0; x < g->o->width; x++) {
        const int y = next_known(g, x, 0);
        if (y < g->o->height / 2) tops[count++] = (struct weighted){brightness(g, pixel_of(g, x, y)), 1};
    }
    *usual = count ? weighted_percentile(tops, count, 0.8) : -INFINITY;
    free(tops);
    return ST_OK;
}

/* From the top of a run of known pixels down: sky until an edge. */
static void sort_run(struct guess *g, int x, int y, int end, double usual)
{
    double level = brightness(g, pixel_of(g, x, y));
    bool sky = level > usual - MUCH_DARKER;
    for (; y < end; y++) {
        const double here = brightness(g, pixel_of(g, x, y));
        if (here < level - EDGE) sky = false;
        if (here < level + FLASH) level += (here - level) / SMOOTH;
        g->kind[pixel_of(g, x, y)] = sky ? SKY : SOLID;
    }
}

static enum status sort_pixels(struct guess *g, struct err *err)
{
    double usual = -INFINITY;
    if (find_tops(&usual, g, err)) return err->status;
    for (int x = 0; x < g->o->width; x++)
        for (int y = next_known(g, x, 0); y < g->o->height / 2; y = next_known(g, x, y)) {
            const int end = end_of_run(g, x, y);
            sort_run(g, x, y, end, usual);
            y = end;
        }
    for (int y = g->o->height / 2; y < g->o->height; y++)
        for (int x = 0; x < g->o->width; x++)
            if (g->o->source[pixel_of(g, x, y)]) g->kind[pixel_of(g, x, y)] = SOLID;
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- priors */

static int stride_of(const struct guess *g) { return g->o->height < 2 * SAMPLED ? 1 : g->o->height / SAMPLED; }

static enum status fit_to_known(struct guess *g, const struct vec3 *to_sun, struct err *err)
{
    const int stride = stride_of(g);
    const size_t most = ((size_t)g->o->height / (size_t)stride + 1) * ((size_t)g->o->width / (size_t)stride + 1);
    struct sky_sample *samples = malloc(most * sizeof *samples);
    int count = 0;
    if (!samples) return err_nomem(err, "samples of the sky", most * sizeof *samples);
    for (int y = stride / 2; y < g->o->height / 2; y += stride)
        for (int x = stride / 2; x < g->o->width; x += stride) {
            if (g->kind[pixel_of(g, x, y)] != SKY) continue;
            samples[count] = (struct sky_sample){.direction = outdoors_direction(g->o, x + 0.5, y + 0.5),
                                                 .weight = solid_angle(g, y)};
            level_of(samples[count++].level, g, pixel_of(g, x, y));
        }
    sky_fit_samples(&g->sky, samples, count, to_sun, err);
    free(samples);
    return err->status;
}

static void drop_dark(struct guess *g)
{
    for (int y = 0; y < g->o->height / 2; y++)
        for (int x = 0; x < g->o->width; x++) {
            const size_t at = pixel_of(g, x, y);
            double level[3];
            if (g->kind[at] != SKY) continue;
            sky_fit_level(level, &g->sky, outdoors_direction(g->o, x + 0.5, y + 0.5));
            const float sky[3] = {expf((float)level[0]), expf((float)level[1]), expf((float)level[2])};
            if (brightness(g, at) < (double)logf(luminance_of(sky)) - DARKER) g->kind[at] = SOLID;
        }
}

static enum status fit_sky(struct guess *g, const struct vec3 *to_sun, struct err *err)
{
    for (int round = 0; round < ROUNDS; round++) {
        if (fit_to_known(g, to_sun, err)) return err->status;
        if (round + 1 < ROUNDS && g->sky.type) drop_dark(g);
    }
    return ST_OK;
}

/* The median colour of the known pixels of a kind in some rows; UNKNOWN: of any kind. False: there are none. */
static bool median_colour(double colour[3], const struct guess *g, enum kind kind, int first, int end,
                          struct weighted *scratch)
{
    const int stride = stride_of(g);
    size_t count = 0;
    for (int c = 0; c < 3; c++) {
        count = 0;
        for (int y = first; y < end; y++)
            for (int x = y % stride; x < g->o->width; x += stride) {
                const enum kind k = (enum kind)g->kind[pixel_of(g, x, y)];
                double level[3];
                if (k == UNKNOWN || (kind != UNKNOWN && k != kind)) continue;
                level_of(level, g, pixel_of(g, x, y));
                scratch[count++] = (struct weighted){level[c], solid_angle(g, y)};
            }
        if (count) colour[c] = weighted_percentile(scratch, count, 0.5);
    }
    return count > 0;
}

static enum status find_colours(struct guess *g, struct err *err)
{
    const int half = g->o->height / 2;
    const size_t most = ((size_t)g->o->width / (size_t)stride_of(g) + 2) * (size_t)g->o->height;
    struct weighted *scratch = malloc(most * sizeof *scratch);
    if (!scratch) return err_nomem(err, "pixels", most * sizeof *scratch);
    median_colour(g->any, g, UNKNOWN, 0, g->o->height, scratch);
    for (int side = 0; side < 2; side++) {
        double *colour = g->solid[side];
        if (!median_colour(colour, g, SOLID, side ? half : 0, side ? g->o->height : half, scratch) &&
            !median_colour(colour, g, SOLID, 0, g->o->height, scratch))
            median_colour(colour, g, UNKNOWN, 0, g->o->height, scratch);
    }
    free(scratch);
    return ST_OK;
}

/* The share of solids at each height, smooth, so that no belt has an edge. */
static void find_prior(struct guess *g)
{
    const int half = g->o->height / 2, reach = (int)lround(BELT / 180 * g->o->height);
    double *sharp = g->prior + g->o->height;
    for (int y = 0; y < g->o->height; y++) {
        int known = 0, solid = 0;
        sharp[y] = 1;
        if (y >= half) continue;
        for (int x = 0; x < g->o->width; x++) {
            const uint8_t kind = g->kind[pixel_of(g, x, y)];
            known += kind != UNKNOWN;
            solid += kind == SOLID;
        }
        sharp[y] = solid / (known + FEW * g->o->width);
        if (y && sharp[y] < sharp[y - 1]) sharp[y] = sharp[y - 1];
    }
    for (int y = 0; y < g->o->height; y++) {
        double sum = 0;
        for (int k = -reach; k <= reach; k++) sum += sharp[clamp_int(y + k, 0, y < half ? half - 1 : g->o->height - 1)];
        g->prior[y] = sum / (2 * reach + 1);
    }
}

/* What the sky is without any picture near: the fitted one. */
static void sky_level(double level[3], const struct guess *g, struct vec3 direction)
{
    if (g->sky.type)
        sky_fit_level(level, &g->sky, direction);
    else
        for (int c = 0; c < 3; c++) level[c] = g->any[c];
}

/* ------------------------------------------------------------------------------------------------------ differences */

static double pole_share(const struct guess *g, int y)
{
    return fmin(1, (90 - fabs(90 - 180 * (y + 0.5) / g->o->height)) / POLE);
}

/* The colour of a kind where no picture is near. */
static void usual_level(double level[3], const struct guess *g, enum kind kind, int x, int y)
{
    if (kind == SKY)
        sky_level(level, g, outdoors_direction(g->o, x + 0.5, y + 0.5));
    else
        for (int c = 0; c < 3; c++) level[c] = g->solid[y >= g->o->height / 2][c];
}

/* How known pixels of a kind differ from the usual, carried on everywhere. */
static enum status spread(struct guess *g, enum kind kind, struct err *err)
{
    if (pull_push_init(&g->differences, g->o->width, g->o->height, 3, err)) return err->status;
    for (int y = 0; y < g->o->height; y++)
        for (int x = 0; x < g->o->width; x++) {
            double usual[3], level[3];
            float *out = pull_push_pixel(&g->differences, x, y);
            if (g->kind[pixel_of(g, x, y)] != kind) continue;
            usual_level(usual, g, kind, x, y);
            level_of(level, g, pixel_of(g, x, y));
            for (int c = 0; c < 3; c++) out[c] = (float)clamp(level[c] - usual[c], -FARTHEST, FARTHEST);
            out[3] = 1;
        }
    return pull_push(&g->differences, &of_colours, err);
}

static enum status spread_share(struct guess *g, struct err *err)
{
    struct level l;
    if (pull_push_init(&l, g->o->width, g->o->height, 1, err)) return err->status;
    for (int y = 0; y < g->o->height / 2; y++)
        for (int x = 0; x < g->o->width; x++) {
            const uint8_t kind = g->kind[pixel_of(g, x, y)];
            float *out = pull_push_pixel(&l, x, y);
            if (kind == UNKNOWN) continue;
            out[0] = (float)((kind == SOLID) - g->prior[y]);
            out[1] = 1;
        }
    pull_push(&l, &of_shares, err);
    for (int y = 0; !err->status && y < g->o->height; y++)
        for (int x = 0; x < g->o->width; x++) {
            const double share = g->prior[y] + pole_share(g, y) * (double)pull_push_pixel(&l, x, y)[0];
            g->share[pixel_of(g, x, y)] = y < g->o->height / 2 ? (float)clamp(share, 0, 1) : 1;
        }
    pull_push_release(&l);
    return err->status;
}

struct fill_job {
    const struct guess *g;
    enum kind kind;
};

/* Adds the share of a kind to what is unknown. */
static void fill_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fill_job *job = ctx;
    const struct guess *g = job->g;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < g->o->width; x++) {
            const size_t at = pixel_of(g, x, y);
            const double share = job->kind == SKY ? 1 - (double)g->share[at] : (double)g->share[at];
            double level[3];
            if (g->kind[at] != UNKNOWN || !(share > 0)) continue;
            usual_level(level, g, job->kind, x, y);
            for (int c = 0; c < 3; c++)
                g->o->rgb[3 * at + (size_t)c] +=
                    (float)(share *
                            exp(level[c] + pole_share(g, y) * (double)pull_push_pixel(&g->differences, x, y)[c]));
        }
}

static enum status fill(struct guess *g, struct err *err)
{
    static const enum kind kinds[2] = {SKY, SOLID};
    if (spread_share(g, err)) return err->status;
    for (int k = 0; !err->status && k < 2; k++) {
        struct fill_job job = {g, kinds[k]};
        if (!spread(g, kinds[k], err)) parallel_for((size_t)g->o->height, ROWS, fill_rows, &job);
        pull_push_release(&g->differences);
    }
    return err->status;
}

enum status outdoors_guess(struct outdoors *o, const struct vec3 *to_sun, struct sky_fit *sky, struct err *err)
{
    const size_t pixels = (size_t)o->width * (size_t)o->height;
    struct guess g = {.o = o, .darkest = (float)darkest_of(o)};
    *sky = (struct sky_fit){0};
    if (!(g.darkest > 0)) return ST_OK;
    g.kind = calloc(pixels, sizeof *g.kind);
    g.share = calloc(pixels, sizeof *g.share);
    g.prior = calloc(2 * (size_t)o->height, sizeof *g.prior);
    if (!g.kind || !g.share || !g.prior) err_nomem(err, "a picture of the outdoors", pixels * 5);
    if (!err->status && !sort_pixels(&g, err) && !fit_sky(&g, to_sun, err) && !find_colours(&g, err)) {
        find_prior(&g);
        if (!fill(&g, err)) *sky = g.sky;
    }
    free(g.kind);
    free(g.share);
    free(g.prior);
    return err->status;
}
