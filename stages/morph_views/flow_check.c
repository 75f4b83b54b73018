/* flow_check.c - where two flows contradict each other, and what stands in their place there.
 *
 * A pixel whose way there and back ends where it began is sure. Small islands that flow unlike all around them are not,
 * whatever they say. What is not sure is mostly hidden in the other picture, behind something nearer: it belongs to
 * the far side of the gap, so of what the eight directions meet first the second farthest is taken (Hirschmueller 2008),
 * or where near and far are not known the one that looks most like the pixel. Where nothing sure is met the flow stays as it is. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/parallel.h"
#include "stages/morph_views/match.h"

enum { CHUNK = 8, DIRECTIONS = 8, LEAST_ISLAND = 60 };
#define AGREE       0.75f /* px between the way's beginning and its end: wholly sure ... */
#define DISAGREE    1.5f  /* ... and not at all */
#define ISLAND_STEP 1.5f

static int clamp_int(int x, int most) { return x < 0 ? 0 : x > most ? most : x; }

struct checking {
    struct flow *flows;
    const struct image *pictures;
    const struct geometry *geometry;
    int from;
    bool has_lines;
    const float *uv;   /* of flows[from], before filling */
    const float *sure; /* the same */
    float *passed;     /* of flows[from]: before islands are taken out */
};

/* The flow near a point: of the four pixels around it the one that ends nearest to (x, y). */
static float way_back(const struct flow *f, float u, float v, float x, float y)
{
    int iu = (int)floorf(u), iv = (int)floorf(v);
    float least = INFINITY;
    if (u < -0.5f || v < -0.5f || u > (float)f->width - 0.5f || v > (float)f->height - 0.5f) return INFINITY;
    for (int j = 0; j <= 1; j++)
        for (int i = 0; i <= 1; i++) {
            int qx = clamp_int(iu + i, f->width - 1), qy = clamp_int(iv + j, f->height - 1);
            const float *back = f->uv + 2 * ((size_t)qy * (size_t)f->width + (size_t)qx);
            least = fminf(least, hypotf(u + back[0] - x, v + back[1] - y));
        }
    return least;
}

static void check_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct checking *c = ctx;
    const struct flow *f = &c->flows[c->from];
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)f->width; x++) {
            size_t p = y * (size_t)f->width + x;
            float off =
                way_back(&c->flows[!c->from], (float)x + f->uv[2 * p], (float)y + f->uv[2 * p + 1], (float)x, (float)y);
            c->passed[p] = off <= AGREE ? 1 : off >= DISAGREE ? 0 : (DISAGREE - off) / (DISAGREE - AGREE);
            struct epipolar_line line;
            f->near[p] = 0;
            if (geometry_line(c->geometry, c->from, (double)x + 0.5, (double)y + 0.5, &line))
                f->near[p] = line.dx * f->uv[2 * p] + line.dy * f->uv[2 * p + 1];
        }
}

/* Connected pixels that flow alike, fewer than LEAST_ISLAND. stack and seen: scratch of a picture's size. */
static void drop_islands(struct flow *f, uint32_t *stack, unsigned char *seen)
{
    const size_t w = (size_t)f->width, h = (size_t)f->height;
    memset(seen, 0, w * h);
    for (size_t start = 0; start < w * h; start++) {
        size_t count = 0, done = 0;
        if (seen[start] || f->sure[start] <= 0) continue;
        seen[start] = 1;
        stack[count++] = (uint32_t)start;
        while (done < count) {
            size_t p = stack[done++], x = p % w, y = p / w;
            size_t next[4] = {x > 0 ? p - 1 : p, x + 1 < w ? p + 1 : p, y > 0 ? p - w : p, y + 1 < h ? p + w : p};
            for (int k = 0; k < 4; k++) {
                size_t q = next[k];
                if (seen[q] || f->sure[q] <= 0) continue;
                if (fabsf(f->uv[2 * p] - f->uv[2 * q]) + fabsf(f->uv[2 * p + 1] - f->uv[2 * q + 1]) > ISLAND_STEP)
                    continue;
                seen[q] = 1;
                stack[count++] = (uint32_t)q;
            }
        }
        for (size_t k = 0; count < LEAST_ISLAND && k < count; k++) f->sure[stack[k]] = 0;
    }
}

static void fill_pixel(const struct checking *c, int x, int y)
{
    static const int ways[DIRECTIONS][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    struct flow *f = &c->flows[c->from];
    const size_t w = (size_t)f->width, p = (size_t)y * w + (size_t)x;
    const float *own = image_at(&c->pictures[c->from], x, y);
    size_t met[DIRECTIONS];
    float rank[DIRECTIONS];
    int count = 0;
    for (int d = 0; d < DIRECTIONS; d++) {
        int qx = x + ways[d][0], qy = y + ways[d][1];
        while (qx >= 0 && qy >= 0 && qx < f->width && qy < f->height && c->sure[(size_t)qy * w + (size_t)qx] < 0.5f) {
            qx += ways[d][0];
            qy += ways[d][1];
        }
        if (qx < 0 || qy < 0 || qx >= f->width || qy >= f->height) continue;
        size_t q = (size_t)qy * w + (size_t)qx;
        const float *other = image_at(&c->pictures[c->from], qx, qy);
        float unlike = 0;
        for (int k = 0; k < 3; k++) unlike += fabsf(own[k] - other[k]);
        float value = c->has_lines ? f->near[q] : unlike;
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
    const struct checking *c = ctx;
    struct flow *f = &c->flows[c->from];
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < f->width; x++) {
            size_t p = (size_t)y * (size_t)f->width + (size_t)x;
            if (c->sure[p] < 0.5f) {
                fill_pixel(c, x, y);
                f->sure[p] = 0;
            }
        }
}

static void near_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct checking *c = ctx;
    struct flow *f = &c->flows[c->from];
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)f->width; x++) {
            size_t p = y * (size_t)f->width + x;
            struct epipolar_line line;
            if (geometry_line(c->geometry, c->from, (double)x + 0.5, (double)y + 0.5, &line))
                f->near[p] = line.dx * f->uv[2 * p] + line.dy * f->uv[2 * p + 1];
        }
}

enum status flow_check(struct flow flows[2], const struct image pictures[2], const struct geometry *geometry,
                       struct err *err)
{
    const size_t n = (size_t)flows[0].width * (size_t)flows[0].height, h = (size_t)flows[0].height;
    struct checking c = {.flows = flows, .pictures = pictures, .geometry = geometry};
    struct epipolar_line line;
    float *passed[2] = {malloc(n * sizeof(float)), malloc(n * sizeof(float))};
    float *uv = malloc(2 * n * sizeof *uv), *sure = malloc(n * sizeof *sure);
    uint32_t *stack = malloc(n * sizeof *stack);
    unsigned char *seen = malloc(n);
    enum status st =
        passed[0] && passed[1] && uv && sure && stack && seen ? ST_OK : err_nomem(err, "a flow's check", n * 30);
    c.has_lines = geometry_line(geometry, 0, flows[0].width / 2.0, flows[0].height / 2.0, &line);
    for (c.from = 0; !st && c.from < 2; c.from++) {
        c.passed = passed[c.from];
        parallel_for(h, CHUNK, check_rows, &c);
    }
    for (c.from = 0; !st && c.from < 2; c.from++) {
        struct flow *f = &flows[c.from];
        memcpy(f->sure, passed[c.from], n * sizeof *f->sure);
        drop_islands(f, stack, seen);
        memcpy(uv, f->uv, 2 * n * sizeof *uv);
        memcpy(sure, f->sure, n * sizeof *sure);
        c.uv = uv;
        c.sure = sure;
        parallel_for(h, CHUNK, fill_rows, &c);
        parallel_for(h, CHUNK, near_rows, &c);
    }
    for (int i = 0; i < 2; i++) free(passed[i]);
    free(uv);
    free(sure);
    free(stack);
    free(seen);
    return st;
}
