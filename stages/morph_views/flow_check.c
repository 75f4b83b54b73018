/* flow_check.c - left-right consistency check of two flows, and filling of the pixels that fail it.
 *
 * A pixel is consistent if the flow there and back ends where it began. Small islands whose flow differs from
 * everything around them are rejected. The rejected pixels are mostly occluded in the other picture by something
 * nearer, so they belong to the far side of the gap: of the consistent pixels that eight directions meet first, the
 * second farthest gives the flow [Hirschmueller 2008], or, where nearness is unknown, the one of most similar colour.
 * Where no consistent pixel is met the flow stays. A weighted median makes the choices of neighbouring pixels agree.
 *
 * Wide areas without a match have no far side. There the flow is smoothed, more strongly the farther the next
 * consistent pixel is, so that the morph dissolves and does not break into pieces; this is not in the source. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "stages/morph_views/flow_match.h"

enum { CHUNK = 8, DIRECTIONS = 8, MIN_ISLAND = 60, MEDIAN_ROUNDS = 3, SWEEPS = 150 };
#define AGREE        0.75f /* px, max round-trip error of confidence 1 ... */
#define DISAGREE     1.5f  /* ... and min of confidence 0 */
#define ISLAND_STEP  1.5f  /* px, max flow difference between neighbours of an island */
#define SIMILAR      0.1f  /* of white, sum of three channels: scale of colour differences */
#define HOLD         2.0f  /* weight of a filled pixel's own flow beside a consistent pixel ... */
#define HOLD_REACH   5.0f  /* ... which falls to 1 / e within this many px */
#define OVER         1.9f  /* over-relaxation */
#define MEDIAN_LIMIT 8.0f  /* px: differences are truncated here */

struct flow_checker {
    struct flow *flows;
    const struct image *pictures;
    const struct pair_geometry *geometry;
    int from;
    bool has_lines;
    const float *uv;         /* of flows[from], before the current step */
    const float *confidence; /* of flows[from], before filling */
    float *passed;           /* confidence of flows[from] before islands are rejected */
    const float *distance;   /* px to the nearest consistent pixel */
    int colour;              /* 0 or 1, of the red-black order */
};

/* Round-trip error: the flow f is taken at (u, v), from that of the four pixels around it whose flow ends nearest to
 * (x, y). */
static float round_trip_error(const struct flow *f, float u, float v, float x, float y)
{
    int iu = (int)floorf(u), iv = (int)floorf(v);
    float min = INFINITY;
    if (u < -0.5f || v < -0.5f || u > (float)f->width - 0.5f || v > (float)f->height - 0.5f) return INFINITY;
    for (int j = 0; j <= 1; j++)
        for (int i = 0; i <= 1; i++) {
            int qx = clamp_int(iu + i, 0, f->width - 1), qy = clamp_int(iv + j, 0, f->height - 1);
            const float *back = f->uv + 2 * ((size_t)qy * (size_t)f->width + (size_t)qx);
            min = fminf(min, hypotf(u + back[0] - x, v + back[1] - y));
        }
    return min;
}

static void check_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_checker *c = ctx;
    const struct flow *f = &c->flows[c->from];
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)f->width; x++) {
            size_t p = y * (size_t)f->width + x;
            float off = round_trip_error(&c->flows[!c->from], (float)x + f->uv[2 * p], (float)y + f->uv[2 * p + 1],
                                         (float)x, (float)y);
            c->passed[p] = off <= AGREE ? 1 : off >= DISAGREE ? 0 : (DISAGREE - off) / (DISAGREE - AGREE);
            struct epipolar_line line;
            f->nearness[p] = 0;
            if (epipolar_line_at(c->geometry, c->from, (double)x + 0.5, (double)y + 0.5, NULL, &line))
                f->nearness[p] = line.dx * f->uv[2 * p] + line.dy * f->uv[2 * p + 1];
        }
}

/* Sets the confidence of islands, connected pixels of similar flow, fewer than MIN_ISLAND, to 0. stack and seen:
 * scratch of the picture's size. */
static void reject_islands(struct flow *f, uint32_t *stack, unsigned char *seen)
{
    const size_t w = (size_t)f->width, h = (size_t)f->height;
    memset(seen, 0, w * h);
    for (size_t start = 0; start < w * h; start++) {
        size_t count = 0, done = 0;
        if (seen[start] || f->confidence[start] <= 0) continue;
        seen[start] = 1;
        stack[count++] = (uint32_t)start;
        while (done < count) {
            size_t p = stack[done++], x = p % w, y = p / w;
            size_t next[4] = {x > 0 ? p - 1 : p, x + 1 < w ? p + 1 : p, y > 0 ? p - w : p, y + 1 < h ? p + w : p};
            for (int k = 0; k < 4; k++) {
                size_t q = next[k];
                if (seen[q] || f->confidence[q] <= 0) continue;
                if (fabsf(f->uv[2 * p] - f->uv[2 * q]) + fabsf(f->uv[2 * p + 1] - f->uv[2 * q + 1]) > ISLAND_STEP)
                    continue;
                seen[q] = 1;
                stack[count++] = (uint32_t)q;
            }
        }
        for (size_t k = 0; count < MIN_ISLAND && k < count; k++) f->confidence[stack[k]] = 0;
    }
}

/* Takes the flow from the second farthest of the consistent pixels met first, or from the most similar. */
static void fill_pixel(const struct flow_checker *c, int x, int y)
{
    static const int steps[DIRECTIONS][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    struct flow *f = &c->flows[c->from];
    const size_t w = (size_t)f->width, p = (size_t)y * w + (size_t)x;
    const float *own = image_at(&c->pictures[c->from], x, y);
    size_t met[DIRECTIONS];
    float rank[DIRECTIONS];
    int count = 0;
    for (int d = 0; d < DIRECTIONS; d++) {
        int qx = x + steps[d][0], qy = y + steps[d][1];
        while (qx >= 0 && qy >= 0 && qx < f->width && qy < f->height &&
               c->confidence[(size_t)qy * w + (size_t)qx] < 0.5f) {
            qx += steps[d][0];
            qy += steps[d][1];
        }
        if (qx < 0 || qy < 0 || qx >= f->width || qy >= f->height) continue;
        size_t q = (size_t)qy * w + (size_t)qx;
        const float *other = image_at(&c->pictures[c->from], qx, qy);
        float difference = 0;
        for (int k = 0; k < 3; k++) difference += fabsf(own[k] - other[k]);
        float value = c->has_lines ? f->nearness[q] : difference;
        int k = count++;
        for (; k > 0 && rank[k - 1] > value; k--) {
            rank[k] = rank[k - 1];
            met[k] = met[k - 1];
        }
        rank[k] = value;
        met[k] = q;
    }
    if (!count) return;
    size_t q = met[c->has_lines && count > 2 ? 1 : 0];
    f->uv[2 * p] = c->uv[2 * q];
    f->uv[2 * p + 1] = c->uv[2 * q + 1];
}

static void fill_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_checker *c = ctx;
    struct flow *f = &c->flows[c->from];
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < f->width; x++) {
            size_t p = (size_t)y * (size_t)f->width + (size_t)x;
            if (c->confidence[p] < 0.5f) {
                fill_pixel(c, x, y);
                f->confidence[p] = 0;
            }
        }
}

/* Weighted median: of the flows of a filled pixel and its eight neighbours, the one from which the 7 x 7 pixels around
 * differ least, weighted by their similarity of colour. */
static void median_rows(void *ctx, size_t begin, size_t end, int thread)
{
    enum { REACH = 3 };
    const struct flow_checker *c = ctx;
    struct flow *f = &c->flows[c->from];
    const struct image *im = &c->pictures[c->from];
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < f->width; x++) {
            size_t p = (size_t)y * (size_t)f->width + (size_t)x, best = p;
            if (f->confidence[p] >= 0.5f) continue;
            float weights[49], min = INFINITY;
            size_t around[49];
            int count = 0;
            for (int j = -REACH; j <= REACH; j++)
                for (int i = -REACH; i <= REACH; i++) {
                    int qx = clamp_int(x + i, 0, f->width - 1), qy = clamp_int(y + j, 0, f->height - 1);
                    const float *a = image_at(im, x, y), *b = image_at(im, qx, qy);
                    around[count] = (size_t)qy * (size_t)f->width + (size_t)qx;
                    float difference = fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) + fabsf(a[2] - b[2]);
                    weights[count++] = 0.05f + expf(-difference / SIMILAR);
                }
            for (int k = 0; k < 9; k++) {
                size_t q = around[24 + (k / 3 - 1) * 7 + k % 3 - 1];
                float sum = 0;
                for (int i = 0; i < count; i++)
                    sum += weights[i] * fminf(fabsf(c->uv[2 * q] - c->uv[2 * around[i]]) +
                                                  fabsf(c->uv[2 * q + 1] - c->uv[2 * around[i] + 1]),
                                              MEDIAN_LIMIT);
                if (sum < min) {
                    min = sum;
                    best = q;
                }
            }
            f->uv[2 * p] = c->uv[2 * best];
            f->uv[2 * p + 1] = c->uv[2 * best + 1];
        }
}

/* City-block distance to the nearest consistent pixel, in two passes. */
static void find_distance(float *distance, const struct flow *f)
{
    const int w = f->width, h = f->height;
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < w * h; k++) {
            int p = pass ? w * h - 1 - k : k, x = p % w, y = p / w, step = pass ? 1 : -1;
            if (!pass) distance[p] = f->confidence[p] >= 0.5f ? 0 : 1e6f;
            if (x + step >= 0 && x + step < w) distance[p] = fminf(distance[p], distance[p + step] + 1);
            if (y + step >= 0 && y + step < h) distance[p] = fminf(distance[p], distance[p + step * w] + 1);
        }
}

/* One sweep of successive over-relaxation of the filled pixels of one colour. */
static void relax_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_checker *c = ctx;
    struct flow *f = &c->flows[c->from];
    const struct image *im = &c->pictures[c->from];
    const int w = f->width, h = f->height;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = (y + c->colour) & 1; x < w; x += 2) {
            static const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
            size_t p = (size_t)y * (size_t)w + (size_t)x;
            if (f->confidence[p] >= 0.5f) continue;
            float sum = HOLD * expf(-c->distance[p] / HOLD_REACH), total[2];
            for (size_t k = 0; k < 2; k++) total[k] = sum * c->uv[2 * p + k];
            for (int d = 0; d < 4; d++) {
                int qx = x + steps[d][0], qy = y + steps[d][1];
                if (qx < 0 || qy < 0 || qx >= w || qy >= h) continue;
                size_t q = (size_t)qy * (size_t)w + (size_t)qx;
                const float *a = image_at(im, x, y), *b = image_at(im, qx, qy);
                float difference = fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) + fabsf(a[2] - b[2]);
                float weight = 0.02f + expf(-difference / SIMILAR);
                sum += weight;
                for (size_t k = 0; k < 2; k++) total[k] += weight * f->uv[2 * q + k];
            }
            for (size_t k = 0; k < 2; k++) f->uv[2 * p + k] += OVER * (total[k] / sum - f->uv[2 * p + k]);
        }
}

static void nearness_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_checker *c = ctx;
    struct flow *f = &c->flows[c->from];
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)f->width; x++) {
            size_t p = y * (size_t)f->width + x;
            struct epipolar_line line;
            if (epipolar_line_at(c->geometry, c->from, (double)x + 0.5, (double)y + 0.5, NULL, &line))
                f->nearness[p] = line.dx * f->uv[2 * p] + line.dy * f->uv[2 * p + 1];
        }
}

enum status flow_check(struct flow flows[2], const struct image pictures[2], const struct pair_geometry *geometry,
                       struct err *err)
{
    const size_t n = (size_t)flows[0].width * (size_t)flows[0].height, h = (size_t)flows[0].height;
    struct flow_checker c = {.flows = flows, .pictures = pictures, .geometry = geometry};
    struct epipolar_line line;
    float *passed[2] = {malloc(n * sizeof(float)), malloc(n * sizeof(float))};
    float *uv = malloc(2 * n * sizeof *uv), *confidence = malloc(n * sizeof *confidence);
    uint32_t *stack = malloc(n * sizeof *stack);
    unsigned char *seen = malloc(n);
    if (!passed[0] || !passed[1] || !uv || !confidence || !stack || !seen) err_nomem(err, "a flow's check", n * 30);
    c.has_lines = epipolar_line_at(geometry, 0, flows[0].width / 2.0, flows[0].height / 2.0, NULL, &line);
    for (c.from = 0; !err->status && c.from < 2; c.from++) {
        c.passed = passed[c.from];
        parallel_for(h, CHUNK, check_rows, &c);
    }
    for (c.from = 0; !err->status && c.from < 2; c.from++) {
        struct flow *f = &flows[c.from];
        memcpy(f->confidence, passed[c.from], n * sizeof *f->confidence);
        reject_islands(f, stack, seen);
        memcpy(uv, f->uv, 2 * n * sizeof *uv);
        memcpy(confidence, f->confidence, n * sizeof *confidence);
        c.uv = uv;
        c.confidence = confidence;
        parallel_for(h, CHUNK, fill_rows, &c);
        for (int k = 0; k < MEDIAN_ROUNDS; k++) {
            memcpy(uv, f->uv, 2 * n * sizeof *uv);
            parallel_for(h, CHUNK, median_rows, &c);
        }
        memcpy(uv, f->uv, 2 * n * sizeof *uv);
        find_distance(passed[c.from], f);
        c.distance = passed[c.from];
        for (int k = 0; k < 2 * SWEEPS; k++) {
            c.colour = k & 1;
            parallel_for(h, CHUNK, relax_rows, &c);
        }
        parallel_for(h, CHUNK, nearness_rows, &c);
    }
    for (int i = 0; i < 2; i++) free(passed[i]);
    free(uv);
    free(confidence);
    free(stack);
    free(seen);
    return err->status;
}
