/* synthesis.c - which texels of a picture continue it where no view shows it; see synthesis.h.
 *
 * Overview.
 *   1. Slow changes, light and shade, are taken off: what is left is texture alone.
 *   2. A texel whose surroundings are like nothing else in the picture belongs to something unique, a poster, a socket.
 *      So does a colour that the picture hardly has, the border of a rug. What is unique is never copied, and a hole is
 *      left smooth where it is nearest. If most of a hole's sides are not unique, those that are do not hold its
 *      colours. What is like a texel is looked for at random, along its row and column, and where its neighbours found
 *      theirs [Barnes 2009].
 *   3. At half size, unseen texels get a source one by one, from the rim of the hole inwards. Candidates continue the
 *      sources of the neighbours that have one [Ashikhmin 2001], or lie anywhere in the picture. The best has the least
 *      difference of patches, over the texels that are known by then [Efros 1999].
 *   4. At full size sources are improved by those of their neighbours and by random steps [Barnes 2009].
 * So rows of bricks go on in line, and boards and noise keep their grain.
 *
 * What differs from the sources: no colours are averaged, so texture stays as sharp as it is elsewhere; the joints of
 * what is copied are left to the gradient domain (bake_composite.c). Random numbers are hashes of the texel, and steps
 * of one pass read the pass before: the same bits for any number of threads. */
#include "common/texture/synthesis.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { REACH = 3, SIDE = 2 * REACH + 1 };       /* texels: of a patch */
enum { SLOW = 20 };                             /* texels: half width of the boxes that slow changes are means of */
enum { TRIED = 64, STEPS = 12, PASSES = 4 };    /* sources anywhere; steps around the best; at full size */
enum { PROBES = 48, APART = 2 * SIDE };         /* sources that tell whether a place is unique; texels between them */
enum { SHARED = 8 };                            /* texels: of the first neighbours whose likes are tried */
enum { FEWEST = 64 };                           /* sources without which nothing is copied */
static const float UNLIKE = 4, NOTHING = 4e-4f; /* times the median difference; difference of patches that are alike */
static const float CONTRAST = 0.5f;             /* the same, of the median variance within a patch */
static const float ODD = 6, PLAIN = 0.12f;      /* times the median distance from the slow changes; display units */
enum { UNKNOWN, ORDINARY, UNIQUE };             /* places */
static const float GUESSED = 0.5f;              /* weight of texels that were copied themselves */

/* A picture at one size. */
struct level {
    int width, height;
    float *value;     /* 3 a texel, without slow changes */
    uint8_t *unseen;  /* 1: wanted */
    uint8_t *clean;   /* 1: may be copied */
    uint8_t *middle;  /* 1: a patch around it is clean */
    uint8_t *known;   /* 1: has a value: clean ones, and those that were filled */
    int32_t *middles; /* list of these */
    int middle_count;
    int32_t *source, *next;
    float *cost;    /* of the source */
    int32_t *order; /* unseen texels, from the rim inwards */
    int count;
};

static size_t texels_of(const struct level *l) { return (size_t)l->width * (size_t)l->height; }

static enum status level_init(struct level *l, int width, int height, struct err *err)
{
    *l = (struct level){.width = width, .height = height};
    const size_t n = texels_of(l) + 1;
    l->value = calloc(3 * n, sizeof *l->value);
    l->cost = malloc(n * sizeof *l->cost);
    l->unseen = calloc(n, 4);
    l->source = malloc(4 * n * sizeof *l->source);
    if (!l->value || !l->cost || !l->unseen || !l->source) return err_nomem(err, "a texture", n * 36);
    l->clean = l->unseen + n, l->middle = l->unseen + 2 * n, l->known = l->unseen + 3 * n;
    l->next = l->source + n, l->order = l->source + 2 * n, l->middles = l->source + 3 * n;
    return ST_OK;
}

static void level_release(struct level *l)
{
    free(l->value);
    free(l->cost);
    free(l->unseen);
    free(l->source);
}

static uint32_t hash(uint32_t a, uint32_t b)
{
    uint32_t i = a * 0x9e3779b9u + b * 0x85ebca6bu + 0x27d4eb2fu;
    i = (i ^ (i >> 15)) * 0x2c1b3c6du;
    i = (i ^ (i >> 12)) * 0x297a2d39u;
    return i ^ (i >> 15);
}

/* ----------------------------------------------------------------------------------------------------- slow changes */

/* Means of clean texels in a row or column of 2 SLOW + 1, of values and of counts alike. */
static void box_row(float *to, const float *from, size_t count, size_t step)
{
    double sum[4] = {0};
    for (size_t i = 0; i < count + SLOW; i++) {
        for (size_t c = 0; c < 4; c++) {
            if (i < count) sum[c] += (double)from[4 * step * i + c];
            if (i > 2 * SLOW) sum[c] -= (double)from[4 * step * (i - 2 * SLOW - 1) + c];
            if (i >= SLOW) to[4 * step * (i - SLOW) + c] = (float)sum[c];
        }
    }
}

/* Takes slow changes off the values of clean texels; the others get 0. */
static enum status flatten(struct level *l, const float *value, struct err *err)
{
    const size_t n = texels_of(l), width = (size_t)l->width, height = (size_t)l->height;
    float *a = calloc(n, 4 * sizeof *a), *b = calloc(n, 4 * sizeof *b);
    if (!a || !b) err_nomem(err, "the slow changes of a texture", n * 32);
    for (size_t i = 0; !err->status && i < n; i++)
        for (size_t c = 0; c < 4 && l->clean[i]; c++) a[4 * i + c] = c < 3 ? value[3 * i + c] : 1;
    for (int pass = 0; !err->status && pass < 2; pass++) {
        for (size_t y = 0; y < height; y++) box_row(b + 4 * y * width, a + 4 * y * width, width, 1);
        for (size_t x = 0; x < width; x++) box_row(a + 4 * x, b + 4 * x, height, width);
    }
    for (size_t i = 0; !err->status && i < n; i++)
        for (size_t c = 0; c < 3; c++)
            l->value[3 * i + c] = l->clean[i] && a[4 * i + 3] > 0 ? value[3 * i + c] - a[4 * i + c] / a[4 * i + 3] : 0;
    free(a);
    free(b);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- patches */

/* Mean squared difference of the patches around two texels, over the known ones of the first; FLT_MAX: there are none,
 * or it is above `most`. The second is a middle. */
static float difference(const struct level *l, int32_t at, int32_t from, float most)
{
    const int width = l->width, x = at % width, y = at / width;
    float sum = 0, weight = 0;
    const float limit = most < FLT_MAX ? most * (SIDE * SIDE) : FLT_MAX;
    for (int dy = -REACH; dy <= REACH; dy++) {
        if (y + dy < 0 || y + dy >= l->height) continue;
        for (int dx = -REACH; dx <= REACH; dx++) {
            if (x + dx < 0 || x + dx >= width) continue;
            const size_t p = (size_t)(at + dy * width + dx), q = (size_t)(from + dy * width + dx);
            if (!l->known[p]) continue;
            const float w = l->unseen[p] ? GUESSED : 1;
            for (size_t c = 0; c < 3; c++) {
                const float d = l->value[3 * p + c] - l->value[3 * q + c];
                sum += w * d * d;
            }
            weight += w;
        }
        if (sum > limit) return FLT_MAX; /* weight never exceeds SIDE squared */
    }
    return weight > 0 ? sum / weight : FLT_MAX;
}

static void find_middles(struct level *l)
{
    l->middle_count = 0;
    for (int y = REACH; y < l->height - REACH; y++)
        for (int x = REACH; x < l->width - REACH; x++) {
            const int32_t at = y * l->width + x;
            bool all = true;
            for (int dy = -REACH; dy <= REACH && all; dy++)
                all = !memchr(l->clean + at + dy * l->width - REACH, 0, SIDE);
            l->middle[at] = all;
            if (all) l->middles[l->middle_count++] = at;
        }
}

/* Tries a source; keeps the better. */
static void try(const struct level *l, int32_t at, int32_t x, int32_t y, int32_t *best, float *cost)
{
    if (x < REACH || y < REACH || x >= l->width - REACH || y >= l->height - REACH) return;
    const int32_t from = y * l->width + x;
    if (from == *best || !l->middle[from]) return;
    const float c = difference(l, at, from, *cost);
    if (c < *cost) *cost = c, *best = from;
}

/* Random steps around the best source, ever smaller ones. */
static void step_around(const struct level *l, int32_t at, uint32_t seed, int steps, int32_t *best, float *cost)
{
    for (int k = 0; k < steps && *best >= 0; k++) {
        const uint32_t h = hash((uint32_t)at, seed + (uint32_t)k);
        const int radius = 1 + (16 >> (k * 5 / steps));
        const int dx = (int)(h & 0xffff) % (2 * radius + 1) - radius, dy = (int)(h >> 16) % (2 * radius + 1) - radius;
        try(l, at, *best % l->width + dx, *best / l->width + dy, best, cost);
    }
}

/* ---------------------------------------------------------------------------------------------------- unique places */

/* Of the values in the patch around a middle, over all colours. */
static float variance(const struct level *l, int32_t middle)
{
    float sum[3] = {0}, squares = 0;
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++)
            for (size_t c = 0; c < 3; c++) {
                const float v = l->value[3 * (size_t)(middle + dy * l->width + dx) + c];
                sum[c] += v;
                squares += v * v;
            }
    for (int c = 0; c < 3; c++) squares -= sum[c] * sum[c] / (SIDE * SIDE);
    return fmaxf(0, squares) / (SIDE * SIDE);
}

struct unique_job {
    struct level *l; /* its `source`: the like of each middle */
    float *least;    /* difference of each middle from its like */
    int far;         /* texels to the neighbours whose likes are tried */
};

/* The least difference of each middle from others that are not near it. */
static void find_least(void *ctx, size_t begin, size_t end, int thread)
{
    const struct unique_job *j = ctx;
    struct level *l = j->l;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const int32_t at = l->middles[i], x = at % l->width, y = at / l->width;
        float least = FLT_MAX;
        for (uint32_t k = 0; k < PROBES + STEPS; k++) {
            int32_t from = l->middles[hash((uint32_t)at, k) % (uint32_t)l->middle_count];
            if (k >= PROBES) { /* along its row or column: there bricks and boards are alike */
                const int off = (int)(hash((uint32_t)at, k) % 64) - 32;
                const int u = k & 1 ? x : x + off, v = k & 1 ? y + off : y;
                if (u < 0 || v < 0 || u >= l->width || v >= l->height || !l->middle[v * l->width + u]) continue;
                from = v * l->width + u;
            }
            if (abs(from % l->width - x) < APART && abs(from / l->width - y) < APART) continue;
            const float d = difference(l, at, from, least);
            if (d < least) least = d, l->source[at] = from;
        }
        j->least[i] = least;
    }
}

/* Tries what the likes of neighbours have in its place: few probes meet the one place in a whole brick that is alike,
 * but all of a brick are alike by the same step. The step is as long as the neighbour's, so it is not near either. */
static void share_likes(void *ctx, size_t begin, size_t end, int thread)
{
    const struct unique_job *j = ctx;
    struct level *l = j->l;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const int32_t at = l->middles[i], x = at % l->width, y = at / l->width;
        int32_t best = l->source[at];
        for (int k = 0; k < 4; k++) {
            const int step = k & 1 ? j->far : -j->far, dx = k & 2 ? step : 0, dy = step - dx;
            if (x + dx < 0 || y + dy < 0 || x + dx >= l->width || y + dy >= l->height) continue;
            const int32_t s = l->source[at + dy * l->width + dx];
            if (s >= 0) try(l, at, s % l->width - dx, s / l->width - dy, &best, &j->least[i]);
        }
        l->next[at] = best;
    }
}

/* Leaves `source` as it was: -1. */
static void find_likes(struct level *l, float *least)
{
    const size_t n = (size_t)l->middle_count;
    struct unique_job job = {l, least, 2 * SHARED};
    parallel_for(n, 64, find_least, &job);
    while ((job.far /= 2) > 0) {
        parallel_for(n, 64, share_likes, &job);
        for (size_t i = 0; i < n; i++) l->source[l->middles[i]] = l->next[l->middles[i]];
    }
    for (size_t i = 0; i < n; i++) l->source[l->middles[i]] = -1;
}

static int compare_floats(const void *a, const void *b)
{
    const float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

/* Sets unique[texel] to ORDINARY where a patch around it is like another, to UNIQUE where none is, and to UNKNOWN where
 * no patch is clean. */
static enum status find_unique(uint8_t *unique, struct level *l, struct err *err)
{
    const size_t n = (size_t)l->middle_count;
    float *least = malloc((2 * n + 1) * sizeof *least);
    if (!least) return err_nomem(err, "unique places of a texture", 2 * n * sizeof *least);
    find_likes(l, least);
    memcpy(least + n, least, n * sizeof *least);
    qsort(least + n, n, sizeof *least, compare_floats);
    float limit = n ? fmaxf(NOTHING, UNLIKE * least[n + n / 2]) : 0;
    for (size_t i = 0; i < n; i++) least[n + i] = variance(l, l->middles[i]);
    qsort(least + n, n, sizeof *least, compare_floats);
    if (n) limit = fmaxf(limit, CONTRAST * least[n + n / 2]);
    memset(unique, UNKNOWN, texels_of(l));
    for (int kind = UNIQUE; kind >= ORDINARY; kind--) /* a patch that is ordinary holds no texel that is unique */
        for (size_t i = 0; i < n; i++) {
            if ((least[i] > limit) != (kind == UNIQUE)) continue;
            uint8_t *first = unique + l->middles[i] - REACH * l->width - REACH;
            for (int dy = 0; dy < SIDE; dy++) memset(first + dy * l->width, kind, SIDE);
        }
    free(least);
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- levels */

/* Half the size: the mean of four texels; one of which a quarter is wanted is wanted, one is clean if all four are. */
static enum status halve(struct level *to, const struct level *from, struct err *err)
{
    if (level_init(to, from->width / 2, from->height / 2, err)) return err->status;
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            const size_t i = (size_t)y * (size_t)to->width + (size_t)x;
            to->clean[i] = 1;
            for (int k = 0; k < 4; k++) {
                const size_t p = (size_t)(2 * y + (k >> 1)) * (size_t)from->width + (size_t)(2 * x + (k & 1));
                to->clean[i] &= from->clean[p];
                to->unseen[i] |= from->unseen[p];
                for (size_t c = 0; c < 3; c++) to->value[3 * i + c] += 0.25f * from->value[3 * p + c];
            }
        }
    return ST_OK;
}

static void start(struct level *l)
{
    const size_t n = texels_of(l);
    find_middles(l);
    for (size_t i = 0; i < n; i++) {
        l->known[i] = l->clean[i];
        l->source[i] = -1;
        l->cost[i] = FLT_MAX;
    }
}

/* The four texels beside one; -1: the picture ends there. */
static void neighbours(int32_t around[4], const struct level *l, int32_t at)
{
    const int x = at % l->width, y = at / l->width;
    around[0] = x > 0 ? at - 1 : -1;
    around[1] = x + 1 < l->width ? at + 1 : -1;
    around[2] = y > 0 ? at - l->width : -1;
    around[3] = y + 1 < l->height ? at + l->width : -1;
}

/* Lists the wanted texels by their distance in steps from a texel that is not wanted. Leaves out those to which a
 * unique place is nearest. */
static void list_order(struct level *l, const uint8_t *unique)
{
    const size_t n = texels_of(l);
    int32_t *queue = l->next; /* holds each texel once */
    size_t head = 0, tail = 0;
    uint8_t *state = l->known; /* of the nearest place that is known; set anew by start() */
    for (size_t i = 0; i < n; i++) {
        state[i] = l->clean[i] ? unique[i] : UNKNOWN;
        if (state[i]) queue[tail++] = (int32_t)i;
    }
    l->count = 0;
    while (head < tail) {
        const int32_t at = queue[head++];
        int32_t around[4];
        neighbours(around, l, at);
        if (l->unseen[at] && state[at] == ORDINARY) l->order[l->count++] = at;
        for (int k = 0; k < 4; k++) {
            if (around[k] < 0 || state[around[k]]) continue;
            state[around[k]] = state[at];
            queue[tail++] = around[k];
        }
    }
}

/* Marks, in loose[], what is unique beside holes of which most sides are not: keys of a piano that lean on a wall must
 * not tint what is continued behind them. After list_order(), whose states tell what is unique. */
static void find_loose(uint8_t *loose, const struct level *l)
{
    const size_t n = texels_of(l);
    int32_t *list = l->next;
    uint8_t *listed = l->middle; /* set anew by start() */
    memset(loose, 0, n);
    memset(listed, 0, n);
    for (size_t first = 0; first < n; first++) {
        if (!l->unseen[first] || listed[first]) continue;
        size_t count = 0, sides[3] = {0};
        list[count++] = (int32_t)first;
        listed[first] = 1;
        for (size_t i = 0; i < count; i++) {
            int32_t around[4];
            neighbours(around, l, list[i]);
            for (int k = 0; k < 4; k++) {
                if (around[k] < 0 || listed[around[k]]) continue;
                if (!l->unseen[around[k]]) {
                    sides[l->known[around[k]]]++;
                    continue;
                }
                listed[around[k]] = 1;
                list[count++] = around[k];
            }
        }
        for (size_t i = 0; i < count && sides[ORDINARY] > sides[UNIQUE]; i++) {
            int32_t around[4];
            neighbours(around, l, list[i]);
            for (int k = 0; k < 4; k++)
                if (around[k] >= 0 && !l->unseen[around[k]] && l->known[around[k]] == UNIQUE) loose[around[k]] = 1;
        }
    }
}

static void take(struct level *l, int32_t at, int32_t from, float cost)
{
    l->source[at] = from;
    l->cost[at] = cost;
    memcpy(l->value + 3 * (size_t)at, l->value + 3 * (size_t)from, 3 * sizeof *l->value);
}

/* One by one, from the rim inwards. */
static void fill_inwards(struct level *l)
{
    for (int i = 0; i < l->count; i++) {
        const int32_t at = l->order[i], x = at % l->width, y = at / l->width;
        int32_t best = -1;
        float cost = FLT_MAX;
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++) {
                if (x + dx < 0 || y + dy < 0 || x + dx >= l->width || y + dy >= l->height) continue;
                const int32_t s = l->source[at + dy * l->width + dx];
                if (s >= 0) try(l, at, s % l->width - dx, s / l->width - dy, &best, &cost);
            }
        for (uint32_t k = 0; k < TRIED; k++) {
            const int32_t from = l->middles[hash((uint32_t)at, k) % (uint32_t)l->middle_count];
            try(l, at, from % l->width, from / l->width, &best, &cost);
        }
        step_around(l, at, TRIED, STEPS, &best, &cost);
        if (best < 0) continue;
        take(l, at, best, cost);
        l->known[at] = 1;
    }
}

struct pass {
    struct level *l;
    uint32_t number;
};

static void improve(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pass *pass = ctx;
    struct level *l = pass->l;
    const int jump = 8 >> (pass->number % 4);
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const int32_t at = l->order[i], x = at % l->width, y = at / l->width;
        int32_t best = l->source[at];
        float cost = best >= 0 ? difference(l, at, best, FLT_MAX) : FLT_MAX;
        for (int k = 0; k < 8; k++) {
            const int far = k < 4 ? 1 : jump, dx = (k & 3) == 0 ? far : (k & 3) == 1 ? -far : 0;
            const int dy = (k & 3) == 2 ? far : (k & 3) == 3 ? -far : 0;
            if (x + dx < 0 || y + dy < 0 || x + dx >= l->width || y + dy >= l->height) continue;
            const int32_t s = l->source[at + dy * l->width + dx];
            if (s >= 0) try(l, at, s % l->width - dx, s / l->width - dy, &best, &cost);
        }
        step_around(l, at, 1000 * (pass->number + 1), STEPS / 2, &best, &cost);
        l->next[at] = best;
        l->cost[at] = cost;
    }
}

static void run_passes(struct level *l)
{
    for (uint32_t k = 0; k < PASSES; k++) {
        struct pass pass = {l, k};
        parallel_for((size_t)l->count, 64, improve, &pass);
        for (int i = 0; i < l->count; i++)
            if (l->next[l->order[i]] >= 0) take(l, l->order[i], l->next[l->order[i]], l->cost[l->order[i]]);
    }
}

/* Sources at half size say where those at full size begin. */
static void take_halves(struct level *l, const struct level *half)
{
    for (int i = 0; i < l->count; i++) {
        const int32_t at = l->order[i], x = at % l->width, y = at / l->width;
        if (x / 2 >= half->width || y / 2 >= half->height) continue;
        const int32_t s = half->source[(y / 2) * half->width + x / 2];
        if (s < 0) continue;
        const int u = 2 * (s % half->width) + (x & 1), v = 2 * (s / half->width) + (y & 1);
        take(l, at, v * l->width + u, FLT_MAX);
        l->known[at] = 1;
    }
}

/* Marks texels of a colour that the face hardly has as unique, too: the border of a rug is like itself all along. */
static enum status find_odd_colours(uint8_t *unique, const struct level *l, struct err *err)
{
    const size_t n = texels_of(l);
    float *off = malloc((n + 1) * sizeof *off);
    if (!off) return err_nomem(err, "colours of a texture", n * sizeof *off);
    for (size_t c = 0; c < 3; c++) {
        size_t count = 0;
        for (size_t i = 0; i < n; i++)
            if (l->clean[i]) off[count++] = fabsf(l->value[3 * i + c]);
        qsort(off, count, sizeof *off, compare_floats);
        const float limit = count ? fmaxf(PLAIN, ODD * off[count / 2]) : 0;
        for (size_t i = 0; i < n; i++)
            if (l->clean[i] && fabsf(l->value[3 * i + c]) > limit) unique[i] = UNIQUE;
    }
    free(off);
    return ST_OK;
}

static enum status find_sources(struct level *l, uint8_t *loose, struct err *err)
{
    struct level half = {0};
    uint8_t *unique = calloc(2 * texels_of(l) + 2, 1), *halved = unique + texels_of(l) + 1;
    if (!unique) err_nomem(err, "unique places of a texture", 2 * texels_of(l));
    if (!err->status && !halve(&half, l, err)) {
        start(&half);
        if (!find_unique(halved, &half, err)) find_odd_colours(halved, &half, err);
    }
    for (int y = 0; !err->status && y < l->height; y++)
        for (int x = 0; x < l->width; x++)
            if (x / 2 < half.width && y / 2 < half.height)
                unique[(size_t)y * (size_t)l->width + (size_t)x] =
                    halved[(size_t)(y / 2) * (size_t)half.width + (size_t)(x / 2)];
    if (!err->status) {
        list_order(&half, halved);
        list_order(l, unique);
        find_loose(loose, l);
        for (size_t i = 0; i < texels_of(&half); i++) half.clean[i] &= halved[i] != UNIQUE;
        for (size_t i = 0; i < texels_of(l); i++) l->clean[i] &= unique[i] != UNIQUE;
        start(&half);
        start(l);
        if (half.middle_count >= FEWEST && l->middle_count >= FEWEST) {
            fill_inwards(&half);
            take_halves(l, &half);
            run_passes(l);
        }
    }
    level_release(&half);
    free(unique);
    return err->status;
}

enum status synthesis_find(int32_t *source, uint8_t *loose, const struct synthesis_picture *p, struct err *err)
{
    struct level l = {0};
    if (!level_init(&l, p->width, p->height, err)) {
        memcpy(l.unseen, p->unseen, texels_of(&l));
        memcpy(l.clean, p->clean, texels_of(&l));
        if (!flatten(&l, p->value, err) && !find_sources(&l, loose, err))
            memcpy(source, l.source, texels_of(&l) * sizeof *source);
    }
    level_release(&l);
    return err->status;
}
