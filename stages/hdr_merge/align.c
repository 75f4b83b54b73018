/* align.c - finds shifts between exposures by threshold bitmaps [Ward 2003].
 *
 * Each exposure is thresholded at its own median, which separates the same parts of the scene at any exposure; pixels
 * near the median are ignored. Bitmaps are compared by exclusive or, 64 pixels at a time, over a pyramid: all shifts at
 * the smallest level, then the nine shifts around twice the result at each larger level.
 *
 * Differs from the source:
 * - The threshold of a pair is the quantile, from 9 to 91 %, that is farthest from black and white in both exposures,
 *   so that exposures many stops apart can be compared.
 * - The score of a shift is the fraction of differing pixels among the compared ones, not their number.
 * - A shift must remove at least a third of the differences; otherwise it is 0. */
#include "stages/hdr_merge/align.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum {
    MAX_LEVELS = 10,
    MIN_SIDE = 48,    /* px, of the smallest level */
    NEAR = 3,         /* grey levels around the threshold that are ignored */
    QUANTILES = 11,   /* candidates for the threshold */
    MIN_DISTANCE = 10 /* grey levels of the threshold from black and white */
};

struct grey_level {
    int width, height;
    uint8_t *grey; /* owned */
};

struct grey_pyramid {
    struct grey_level levels[MAX_LEVELS];
    uint8_t quantiles[QUANTILES]; /* of level 0 */
    bool out_of_memory;
};

struct bitmap {
    int width, height, words; /* a row */
    uint64_t *above, *valid;  /* above the threshold; not near it; owned */
};

/* ------------------------------------------------------------------------------------------------------- pyramids */

static void grey_samples(uint8_t *to, const struct photo *p, size_t pixels)
{
    if (p->values) {
        const float white = p->saturation > 0 ? p->saturation : 1;
        for (size_t i = 0; i < pixels; i++) { /* any monotone tone curve will do */
            const float *v = p->values + 3 * i, light = (0.25f * v[0] + 0.625f * v[1] + 0.125f * v[2]) / white;
            to[i] = (uint8_t)(255 * srgb_from_linear(light));
        }
        return;
    }
    const int shift = p->info.bits == 16 ? 12 : 4;
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *s = p->samples + 3 * i;
        to[i] = (uint8_t)((4u * s[0] + 10u * s[1] + 2u * s[2]) >> shift);
    }
}

static void find_quantiles(uint8_t *quantiles, const struct grey_level *l)
{
    size_t counts[256] = {0}, below = 0;
    const size_t pixels = (size_t)l->width * (size_t)l->height;
    int q = 0;
    for (size_t i = 0; i < pixels; i++) counts[l->grey[i]]++;
    for (int v = 0; v < 256; v++) {
        below += counts[v];
        while (q < QUANTILES && below * 100 >= pixels * (size_t)(9 + 82 * q / (QUANTILES - 1)))
            quantiles[q++] = (uint8_t)v;
    }
}

static bool halve(struct grey_level *to, const struct grey_level *from)
{
    *to = (struct grey_level){.width = from->width / 2, .height = from->height / 2};
    to->grey = malloc((size_t)to->width * (size_t)to->height);
    for (int y = 0; to->grey && y < to->height; y++) {
        const uint8_t *a = from->grey + (size_t)(2 * y) * (size_t)from->width, *b = a + from->width;
        uint8_t *row = to->grey + (size_t)y * (size_t)to->width;
        for (int x = 0; x < to->width; x++)
            row[x] = (uint8_t)((a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1] + 2) / 4);
    }
    return to->grey != NULL;
}

struct pyramid_job {
    const struct brackets *b;
    struct grey_pyramid *pyramids;
    int levels;
};

static void make_pyramids(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pyramid_job *job = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        struct grey_pyramid *p = &job->pyramids[k];
        const struct photo_info *info = &job->b->photos[k].info;
        const size_t pixels = (size_t)info->width * (size_t)info->height;
        p->levels[0] = (struct grey_level){info->width, info->height, malloc(pixels)};
        p->out_of_memory = !p->levels[0].grey;
        if (p->out_of_memory) continue;
        grey_samples(p->levels[0].grey, &job->b->photos[k], pixels);
        find_quantiles(p->quantiles, &p->levels[0]);
        for (int l = 1; l < job->levels && !p->out_of_memory; l++)
            p->out_of_memory = !halve(&p->levels[l], &p->levels[l - 1]);
    }
}

/* -------------------------------------------------------------------------------------------------------- bitmaps */

static enum status make_bitmap(struct bitmap *m, const struct grey_level *l, int threshold, struct err *err)
{
    *m = (struct bitmap){.width = l->width, .height = l->height, .words = (l->width + 63) / 64};
    const size_t words = (size_t)m->words * (size_t)m->height;
    m->above = calloc(words, sizeof *m->above);
    m->valid = calloc(words, sizeof *m->valid);
    if (!m->above || !m->valid) return err_nomem(err, "bitmaps", 2 * words * sizeof *m->above);
    for (int y = 0; y < l->height; y++) {
        const uint8_t *row = l->grey + (size_t)y * (size_t)l->width;
        for (int w = 0; w < m->words; w++) {
            const int begin = 64 * w, n = l->width - begin < 64 ? l->width - begin : 64;
            uint64_t above = 0, valid = 0;
            for (int i = 0; i < n; i++) {
                const int v = row[begin + i];
                above |= (uint64_t)(v > threshold) << i;
                valid |= (uint64_t)(v > threshold + NEAR || v < threshold - NEAR) << i;
            }
            m->above[(size_t)y * (size_t)m->words + (size_t)w] = above;
            m->valid[(size_t)y * (size_t)m->words + (size_t)w] = valid;
        }
    }
    return ST_OK;
}

static void release_bitmap(struct bitmap *m)
{
    free(m->above);
    free(m->valid);
}

/* 64 bits of a row, beginning with bit `at`; bits outside the row are 0. */
static inline uint64_t bits_from(const uint64_t *row, int words, int at)
{
    const int word = at >> 6, bit = at & 63;
    const uint64_t low = word >= 0 && word < words ? row[word] : 0;
    if (!bit) return low;
    const uint64_t high = word + 1 >= 0 && word + 1 < words ? row[word + 1] : 0;
    return low >> bit | high << (64 - bit);
}

/* The fraction of compared pixels that differ when pixel (x + dx, y + dy) of b is laid on (x, y) of a. */
static double difference(const struct bitmap *a, const struct bitmap *b, int dx, int dy)
{
    size_t differ = 0, compared = 0;
    for (int y = dy < 0 ? -dy : 0; y < a->height && y + dy < b->height; y++) {
        const uint64_t *aa = a->above + (size_t)y * (size_t)a->words, *as = a->valid + (size_t)y * (size_t)a->words;
        const uint64_t *ba = b->above + (size_t)(y + dy) * (size_t)b->words,
                       *bs = b->valid + (size_t)(y + dy) * (size_t)b->words;
        for (int w = 0; w < a->words; w++) {
            const uint64_t valid = as[w] & bits_from(bs, b->words, 64 * w + dx);
            compared += (size_t)__builtin_popcountll(valid);
            differ += (size_t)__builtin_popcountll(valid & (aa[w] ^ bits_from(ba, b->words, 64 * w + dx)));
        }
    }
    return compared > 0 ? (double)differ / (double)compared : 1;
}

/* ---------------------------------------------------------------------------------------------------------- pairs */

/* Distance of a grey level from black and white. */
static int distance_to_ends(int v) { return v < 255 - v ? v : 255 - v; }

struct pair_job {
    const struct grey_pyramid *fixed, *moved;
    int levels, max_shift;
    struct shift shift; /* of moved against fixed */
    bool found;
    struct err err;
};

static enum status compare_at(struct pair_job *p, int level, int quantile, double *min, double *unmoved)
{
    struct bitmap a = {0}, b = {0};
    if (!make_bitmap(&a, &p->fixed->levels[level], p->fixed->quantiles[quantile], &p->err))
        make_bitmap(&b, &p->moved->levels[level], p->moved->quantiles[quantile], &p->err);
    /* all shifts at the smallest level, then the nine around twice the level above's; the centre first, so that it wins
     * ties */
    const int limit = p->max_shift >> level, reach = level == p->levels - 1 ? (limit > 1 ? limit : 1) : 1;
    const struct shift centre = {2 * p->shift.dx, 2 * p->shift.dy};
    struct shift best = centre;
    if (!p->err.status) *min = difference(&a, &b, centre.dx, centre.dy);
    for (int j = -reach; !p->err.status && j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            const int dx = centre.dx + i, dy = centre.dy + j;
            if ((!i && !j) || abs(dx) > limit || abs(dy) > limit) continue;
            const double d = difference(&a, &b, dx, dy);
            if (d < *min) *min = d, best = (struct shift){dx, dy};
        }
    if (!p->err.status) *unmoved = difference(&a, &b, 0, 0);
    p->shift = best;
    release_bitmap(&a);
    release_bitmap(&b);
    return p->err.status;
}

static void find_shift(struct pair_job *p)
{
    const double min_reduction = 1.0 / 3;
    int quantile = 0, farthest = -1;
    for (int q = 0; q < QUANTILES; q++) {
        const int a = distance_to_ends(p->fixed->quantiles[q]), b = distance_to_ends(p->moved->quantiles[q]),
                  distance = a < b ? a : b;
        if (distance > farthest) farthest = distance, quantile = q;
    }
    if (farthest < MIN_DISTANCE)
        return; /* no threshold separates both: one is nearly white wherever the other is not black */
    double min = 1, unmoved = 0;
    for (int l = p->levels - 1; l >= 0; l--)
        if (compare_at(p, l, quantile, &min, &unmoved)) return;
    p->found = unmoved < 1;
    if (!(min < (1 - min_reduction) * unmoved)) p->shift = (struct shift){0, 0};
}

static void find_shifts(void *ctx, size_t begin, size_t end, int thread)
{
    struct pair_job *pairs = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) find_shift(&pairs[i]);
}

static int count_levels(const struct photo_info *info, int max_shift)
{
    const int side = info->width < info->height ? info->width : info->height;
    int levels = 1;
    while (levels < MAX_LEVELS && 1 << levels <= max_shift && side >> levels >= MIN_SIDE) levels++;
    return levels;
}

enum status align_brackets(struct alignment *a, const struct brackets *b, int middle, int max_shift, struct err *err)
{
    *a = (struct alignment){0};
    a->found[middle] = true;
    if (b->count < 2) return ST_OK;
    struct grey_pyramid *pyramids = calloc((size_t)b->count, sizeof *pyramids);
    struct pair_job *pairs = calloc((size_t)b->count, sizeof *pairs); /* pair k: exposure k and its neighbour */
    struct pyramid_job job = {b, pyramids, count_levels(&b->photos[0].info, max_shift)};
    if (!pyramids || !pairs) err_nomem(err, "pyramids", (size_t)b->count * sizeof *pyramids);
    if (!err->status) parallel_for((size_t)b->count, 1, make_pyramids, &job);
    for (int k = 0; !err->status && k < b->count; k++) {
        if (pyramids[k].out_of_memory) err_nomem(err, "pyramids", 0);
        pairs[k] = (struct pair_job){.fixed = &pyramids[k < middle   ? k + 1
                                                        : k > middle ? k - 1
                                                                     : k],
                                     .moved = &pyramids[k],
                                     .levels = job.levels,
                                     .max_shift = max_shift,
                                     .err = ERR_INIT};
    }
    if (!err->status) parallel_for((size_t)b->count, 1, find_shifts, pairs);
    for (int step = 1; !err->status && step < b->count; step++)
        for (int side = -1; side <= 1; side += 2) {
            const int k = middle + side * step, before = k - side;
            if (k < 0 || k >= b->count) continue;
            if (pairs[k].err.status) err_set(err, pairs[k].err.status, "%s", pairs[k].err.text);
            a->found[k] = pairs[k].found;
            a->at_limit[k] = abs(pairs[k].shift.dx) == max_shift || abs(pairs[k].shift.dy) == max_shift;
            a->shifts[k] =
                (struct shift){a->shifts[before].dx + pairs[k].shift.dx, a->shifts[before].dy + pairs[k].shift.dy};
        }
    for (int k = 0; pyramids && k < b->count; k++)
        for (int l = 0; l < MAX_LEVELS; l++) free(pyramids[k].levels[l].grey);
    free(pyramids);
    free(pairs);
    return err->status;
}
