/* flow_refine.c - subpixel flow: variational refinement [Horn 1981], [Brox 2004] of the whole-pixel flow.
 *
 * Minimises, by linearised least squares in a small change of the flow,
 *   data term        difference of grey and of its gradients (nearly independent of exposure) between the warped other
 *                    picture and this one, robustly reweighted and summed over 3 x 3 pixels
 *   smoothness term  difference of neighbours' flows, with less weight at edges of the picture, and hardly any where
 *                    the whole-pixel flow jumps
 *   epipolar term    distance from the epipolar line, where the flow is near it
 * by red-black Gauss-Seidel sweeps. Unlike the sources, the refined flow stays within FARTHEST px of the whole-pixel
 * flow in each coordinate, so one resolution suffices. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "stages/morph_views/flow_match.h"

enum { CHANNELS = 3, WARPS = 3, SWEEPS = 24, CHUNK = 8, SUMS = 5 };
#define SMOOTH        0.02f /* weight of the smoothness term */
#define EDGE_SCALE    0.04f /* of white */
#define JUMP          1.5f  /* px: a larger difference of neighbours' flows separates two surfaces */
#define JUMP_WEIGHT   0.01f /* factor of the smoothness term across a jump */
#define ROBUST        0.02f /* differences of this order are noise */
#define FARTHEST      0.6f  /* px, max change of the flow in x and in y */
#define LINE_WEIGHT   0.01f /* weight of the epipolar term */
#define GRADIENT_GAIN 2.0f

struct refinement {
    const struct image *from, *to; /* grey, its x and y gradients */
    struct flow *flow;
    const float *whole; /* the initial flow */
    float *sums;        /* SUMS per pixel: Jxx Jxy Jyy Jxt Jyt of the structure tensor */
    float *weights;     /* of the smoothness term, to the right and to the lower neighbour */
    float *change;      /* 2 per pixel */
    float *single;      /* as sums, before summation over 3 x 3 pixels */
    struct epipolar_line *lines;
    const struct pair_geometry *geometry;
    float epipolar_width;
    int from_idx, colour; /* colour: 0 or 1, of the red-black order */
};

/* out: grey of `in`, and its gradients. */
static enum status gradients(struct image *out, const struct image *in, struct err *err)
{
    if (image_init(out, in->width, in->height, CHANNELS, err)) return err->status;
    for (int y = 0; y < in->height; y++)
        for (int x = 0; x < in->width; x++) {
            const float *rgb = image_at(in, x, y);
            image_at(out, x, y)[0] = luminance_of(rgb);
        }
    for (int y = 0; y < in->height; y++)
        for (int x = 0; x < in->width; x++) {
            float *o = image_at(out, x, y);
            o[1] = GRADIENT_GAIN * 0.5f *
                   (image_at(out, clamp_int(x + 1, 0, in->width - 1), y)[0] -
                    image_at(out, clamp_int(x - 1, 0, in->width - 1), y)[0]);
            o[2] = GRADIENT_GAIN * 0.5f *
                   (image_at(out, x, clamp_int(y + 1, 0, in->height - 1))[0] -
                    image_at(out, x, clamp_int(y - 1, 0, in->height - 1))[0]);
        }
    return ST_OK;
}

static void sample(const struct image *im, float x, float y, float out[CHANNELS])
{
    x = fminf(fmaxf(x, 0), (float)(im->width - 1));
    y = fminf(fmaxf(y, 0), (float)(im->height - 1));
    int ix = clamp_int((int)x, 0, im->width - 2), iy = clamp_int((int)y, 0, im->height - 2);
    float fx = x - (float)ix, fy = y - (float)iy;
    const float *a = image_at(im, ix, iy), *b = image_at(im, ix, iy + 1);
    for (int c = 0; c < CHANNELS; c++)
        out[c] = (1 - fy) * ((1 - fx) * a[c] + fx * a[c + CHANNELS]) + fy * ((1 - fx) * b[c] + fx * b[c + CHANNELS]);
}

/* Calls at() for the pixels p = (x, y) of the rows: all of them, or with step 2 those of one colour. */
static inline void each_pixel(const struct refinement *r, size_t begin, size_t end, int step,
                              void (*at)(const struct refinement *r, int x, int y, size_t p))
{
    const int w = r->flow->width;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = step == 1 ? 0 : (y + r->colour) & 1; x < w; x += step)
            at(r, x, y, (size_t)y * (size_t)w + (size_t)x);
}

/* Data term of one pixel. */
static void linearise(const struct refinement *r, int x, int y, size_t p)
{
    const int w = r->flow->width, h = r->flow->height;
    float *j = r->single + SUMS * p, here[CHANNELS], left[CHANNELS], right[CHANNELS], up[CHANNELS], down[CHANNELS];
    float u = (float)x + r->flow->uv[2 * p], v = (float)y + r->flow->uv[2 * p + 1];
    memset(j, 0, SUMS * sizeof *j);
    if (u < 1 || v < 1 || u > (float)(w - 2) || v > (float)(h - 2)) return;
    sample(r->to, u, v, here);
    sample(r->to, u - 1, v, left);
    sample(r->to, u + 1, v, right);
    sample(r->to, u, v - 1, up);
    sample(r->to, u, v + 1, down);
    const float *own = image_at(r->from, x, y);
    const float *l = image_at(r->from, clamp_int(x - 1, 0, w - 1), y);
    const float *rt = image_at(r->from, clamp_int(x + 1, 0, w - 1), y);
    const float *t = image_at(r->from, x, clamp_int(y - 1, 0, h - 1));
    const float *d = image_at(r->from, x, clamp_int(y + 1, 0, h - 1));
    for (int c = 0; c < CHANNELS; c++) {
        float it = here[c] - own[c];
        float ix = 0.25f * (right[c] - left[c] + rt[c] - l[c]), iy = 0.25f * (down[c] - up[c] + d[c] - t[c]);
        float weight = 1 / sqrtf(it * it + ROBUST * ROBUST);
        j[0] += weight * ix * ix;
        j[1] += weight * ix * iy;
        j[2] += weight * iy * iy;
        j[3] += weight * ix * it;
        j[4] += weight * iy * it;
    }
}

static void linearise_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    each_pixel(ctx, begin, end, 1, linearise);
}

/* Sums the data term over 3 x 3 pixels of the same surface, and adds the epipolar term. */
static void sum_around(const struct refinement *r, int x, int y, size_t p)
{
    const int w = r->flow->width, h = r->flow->height;
    float *sums = r->sums + SUMS * p;
    const float *own = r->whole + 2 * p;
    memset(sums, 0, SUMS * sizeof *sums);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            size_t q = (size_t)clamp_int(y + j, 0, h - 1) * (size_t)w + (size_t)clamp_int(x + i, 0, w - 1);
            const float *other = r->whole + 2 * q;
            if (fabsf(own[0] - other[0]) + fabsf(own[1] - other[1]) > JUMP) continue;
            for (int k = 0; k < SUMS; k++) sums[k] += r->single[SUMS * q + (size_t)k];
        }
    const struct epipolar_line *l = &r->lines[p];
    if (l->dx == 0 && l->dy == 0) return;
    float u = (float)x + 0.5f + r->flow->uv[2 * p], v = (float)y + 0.5f + r->flow->uv[2 * p + 1];
    float off = l->dx * v - l->dy * u + l->c;
    if (fabsf(off) > r->epipolar_width) return;
    float weight = LINE_WEIGHT * (1 - fabsf(off) / r->epipolar_width);
    sums[0] += weight * l->dy * l->dy;
    sums[1] -= weight * l->dy * l->dx;
    sums[2] += weight * l->dx * l->dx;
    sums[3] -= weight * l->dy * off;
    sums[4] += weight * l->dx * off;
}

static void sum_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    each_pixel(ctx, begin, end, 1, sum_around);
}

static float weight_between(const struct refinement *r, size_t p, size_t q)
{
    const float *a = r->whole + 2 * p, *b = r->whole + 2 * q;
    if (fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) > JUMP) return SMOOTH * JUMP_WEIGHT;
    float step = fabsf(r->from->data[CHANNELS * p] - r->from->data[CHANNELS * q]);
    return SMOOTH * (0.1f + 0.9f * expf(-step / EDGE_SCALE));
}

/* Smoothness weights and epipolar line of one pixel. */
static void weigh(const struct refinement *r, int x, int y, size_t p)
{
    const int w = r->flow->width, h = r->flow->height;
    r->weights[2 * p] = x + 1 < w ? weight_between(r, p, p + 1) : 0;
    r->weights[2 * p + 1] = y + 1 < h ? weight_between(r, p, p + (size_t)w) : 0;
    const double at[2] = {(double)x + 0.5 + r->whole[2 * p], (double)y + 0.5 + r->whole[2 * p + 1]};
    if (!epipolar_line_at(r->geometry, r->from_idx, (double)x + 0.5, (double)y + 0.5, at, &r->lines[p]))
        r->lines[p] = (struct epipolar_line){0};
}

static void weigh_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    each_pixel(ctx, begin, end, 1, weigh);
}

/* Adds the smoothness term between p and q. */
static void pull(float weight, const struct refinement *r, size_t p, size_t q, float *sum, float b[2])
{
    *sum += weight;
    for (size_t c = 0; c < 2; c++)
        b[c] += weight * (r->flow->uv[2 * q + c] + r->change[2 * q + c] - r->flow->uv[2 * p + c]);
}

/* Solves for the change of one pixel, its neighbours fixed. */
static void relax(const struct refinement *r, int x, int y, size_t p)
{
    const int w = r->flow->width, h = r->flow->height;
    const size_t row = (size_t)w;
    const float *j = r->sums + SUMS * p;
    float sum = 1e-6f, b[2] = {-j[3], -j[4]};
    if (x > 0) pull(r->weights[2 * (p - 1)], r, p, p - 1, &sum, b);
    if (x + 1 < w) pull(r->weights[2 * p], r, p, p + 1, &sum, b);
    if (y > 0) pull(r->weights[2 * (p - row) + 1], r, p, p - row, &sum, b);
    if (y + 1 < h) pull(r->weights[2 * p + 1], r, p, p + row, &sum, b);
    float xx = j[0] + sum, yy = j[2] + sum, xy = j[1], det = xx * yy - xy * xy;
    float change[2] = {(yy * b[0] - xy * b[1]) / det, (xx * b[1] - xy * b[0]) / det};
    for (size_t c = 0; c < 2; c++) {
        float min = r->whole[2 * p + c] - FARTHEST - r->flow->uv[2 * p + c];
        r->change[2 * p + c] = fminf(fmaxf(change[c], min), min + 2 * FARTHEST);
    }
}

static void relax_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    each_pixel(ctx, begin, end, 2, relax);
}

enum status flow_refine(struct flow *flow, const struct image pictures[2], int from,
                        const struct pair_geometry *geometry, const struct morph_params *params, struct err *err)
{
    const size_t n = (size_t)flow->width * (size_t)flow->height, h = (size_t)flow->height;
    struct image channels[2] = {0};
    struct refinement r = {
        .flow = flow, .geometry = geometry, .from_idx = from, .epipolar_width = (float)params->epipolar_width};
    float *whole = malloc(2 * n * sizeof *whole);
    r.sums = malloc(n * SUMS * sizeof *r.sums);
    r.single = malloc(n * SUMS * sizeof *r.single);
    r.weights = malloc(2 * n * sizeof *r.weights);
    r.change = malloc(2 * n * sizeof *r.change);
    r.lines = malloc(n * sizeof *r.lines);
    if (!whole || !r.sums || !r.single || !r.weights || !r.change || !r.lines)
        err_nomem(err, "a flow's refinement", n * 80);
    for (int i = 0; !err->status && i < 2; i++) gradients(&channels[i], &pictures[i], err);
    if (!err->status) {
        memcpy(whole, flow->uv, 2 * n * sizeof *whole);
        r.whole = whole;
        r.from = &channels[from];
        r.to = &channels[!from];
        parallel_for(h, CHUNK, weigh_rows, &r);
        for (int warp = 0; warp < WARPS; warp++) {
            parallel_for(h, CHUNK, linearise_rows, &r);
            parallel_for(h, CHUNK, sum_rows, &r);
            memset(r.change, 0, 2 * n * sizeof *r.change);
            for (int k = 0; k < 2 * SWEEPS; k++) {
                r.colour = k & 1;
                parallel_for(h, CHUNK, relax_rows, &r);
            }
            for (size_t i = 0; i < 2 * n; i++) flow->uv[i] += r.change[i];
        }
    }
    for (int i = 0; i < 2; i++) image_release(&channels[i]);
    free(whole);
    free(r.sums);
    free(r.single);
    free(r.weights);
    free(r.change);
    free(r.lines);
    return err->status;
}
