/* defocus.c - see defocus.h.
 *
 * m = 4^l = 1 + c^2 / 8 stands for a blur everywhere. Of what wants m, a part stays on a level, as it is or
 * smoothed, and the rest goes on to coarser ones: beyond(), smoothed(). A texel's m is the mean of what came down to
 * it.
 *
 * Channels of a level: of the back colour x weight, weight, m x weight; of the near layer colour, coverage, m x
 * coverage; and OPEN, how much of a texel is not near, or much less blurred than the level: what a pixel that looks up
 * this level lets be seen. On the way up beside them comes what is looked up there; of the near layer what was left on
 * coarser levels, which is nearer, then what is left on this one as far as there is room. All loops run over lines of
 * one channel, eight texels at a time; lines are padded, and what stands in the padding is never looked at. */
#include "stages/render_views/defocus.h"

#include <immintrin.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { BACK, BACK_WEIGHT = 3, NEAR, NEAR_COVER = 7, OPEN, BACK_M, NEAR_M, CHANNELS };
#define UP_CHANNELS BACK_M /* results are of BACK .. OPEN, and stand behind the channels */

#define ROWS     32          /* a chunk */
#define MARGIN   8           /* floats beside a line, for what lies beyond its ends */
#define LEAST    (1.0f / 64) /* weight of what is too sharp for a level, or hidden: used where there is nothing else */
#define TINY     1e-36f      /* keeps 0 / 0 out */
#define FARTHEST 1e30f       /* stands for unknown depths */
#define BLURRED  1.5f        /* m of a near surface whose silhouette is widened */
#define HARDLY   2           /* m from where on a near surface ceases to stand behind others, */
#define FULLY    8           /* up to here, where its weight there is */
#define LAST     1e-9f       /* this, which counts where there is nothing else */
#define SPREAD   4           /* how much more than its own m a pixel of the back may serve */

typedef float v8 __attribute__((vector_size(32)));

static inline v8 get(const float *p) { return _mm256_loadu_ps(p); }
static inline void put(float *p, v8 a) { _mm256_storeu_ps(p, a); }
static inline v8 all(float a) { return _mm256_set1_ps(a); }
static inline v8 least(v8 a, v8 b) { return _mm256_min_ps(a, b); }
static inline v8 most(v8 a, v8 b) { return _mm256_max_ps(a, b); }
/* b where a is below 0 (its sign bit is set), else c */
static inline v8 if_below(v8 a, v8 b, v8 c) { return _mm256_blendv_ps(c, b, a); }

static inline v8 ramp(v8 m, float from, float to)
{
    return least(most((m - from) * (1 / (to - from)), all(0)), all(1));
}

/* The part of what wants the blur m that goes beyond a level, whose own is `here` = 4^level. What stays is taken as
 * it is, or, on levels of the pyramid, smoothed by (1 2 1) / 4, which stands for the blur 2 `here`: so the kernels
 * that are mixed differ by half an octave, and no sharp core shows through a wide one. */
static inline v8 beyond(v8 m, float here) { return here > 1 ? ramp(m, 2 * here, 4 * here) : ramp(m, 1, 4); }
static inline v8 smoothed(v8 m, float here) { return ramp(m, here, 2 * here) - beyond(m, here); }

/* The same for the weight of what serves others' look-ups: something blurred serves up to one level more, so that
 * edges between blurs have no step; something sharp does not. */
static inline v8 serves(v8 m, float here) { return most(beyond(m * least(m, all(SPREAD)), here), all(LEAST)); }

struct pass {
    struct defocus *d;
    struct rendered_frame *frame;
    float blur, focus, m_most; /* c = blur (1 - focus / z) */
    int level;                 /* of the finer one */
    bool any_near;
};

static float *line_of(const struct defocus_level *l, int y, int channel)
{
    return l->texels + (size_t)y * l->plane + (size_t)channel * l->stride;
}

static size_t line_size(int width) { return (size_t)(width + 2 * MARGIN + 7) / 8 * 8; }

static bool used(const struct pass *p, int channel) { return p->any_near || channel < NEAR || channel == BACK_M; }

/* ------------------------------------------------------------------------------------------------------- down */

/* A row of the frame in lines of its own, and back: four lines of red, green, blue, alpha. */
static void row_apart(float *const *lines, const float *rgba, int width)
{
    int x = 0;
    for (; x + 8 <= width; x += 8, rgba += 32) {
        /* 4x4 transposes of pixels 0 .. 3 in the low halves and 4 .. 7 in the high ones */
        const __m256 a = _mm256_loadu2_m128(rgba + 16, rgba), b = _mm256_loadu2_m128(rgba + 20, rgba + 4);
        const __m256 c = _mm256_loadu2_m128(rgba + 24, rgba + 8), d = _mm256_loadu2_m128(rgba + 28, rgba + 12);
        const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);
        const __m256 ab2 = _mm256_unpackhi_ps(a, b), cd2 = _mm256_unpackhi_ps(c, d);
        _mm256_storeu_ps(lines[0] + x, _mm256_shuffle_ps(ab, cd, 0x44));
        _mm256_storeu_ps(lines[1] + x, _mm256_shuffle_ps(ab, cd, 0xee));
        _mm256_storeu_ps(lines[2] + x, _mm256_shuffle_ps(ab2, cd2, 0x44));
        _mm256_storeu_ps(lines[3] + x, _mm256_shuffle_ps(ab2, cd2, 0xee));
    }
    for (; x < width; x++, rgba += 4)
        for (int k = 0; k < 4; k++) lines[k][x] = rgba[k];
}

static void row_together(float *rgba, float *const *lines, int width)
{
    int x = 0;
    for (; x + 8 <= width; x += 8, rgba += 32) {
        const __m256 r = _mm256_loadu_ps(lines[0] + x), g = _mm256_loadu_ps(lines[1] + x);
        const __m256 b = _mm256_loadu_ps(lines[2] + x), a = _mm256_loadu_ps(lines[3] + x);
        const __m256 rg = _mm256_unpacklo_ps(r, g), ba = _mm256_unpacklo_ps(b, a);
        const __m256 rg2 = _mm256_unpackhi_ps(r, g), ba2 = _mm256_unpackhi_ps(b, a);
        _mm256_storeu2_m128(rgba + 16, rgba, _mm256_shuffle_ps(rg, ba, 0x44));
        _mm256_storeu2_m128(rgba + 20, rgba + 4, _mm256_shuffle_ps(rg, ba, 0xee));
        _mm256_storeu2_m128(rgba + 24, rgba + 8, _mm256_shuffle_ps(rg2, ba2, 0x44));
        _mm256_storeu2_m128(rgba + 28, rgba + 12, _mm256_shuffle_ps(rg2, ba2, 0xee));
    }
    for (; x < width; x++, rgba += 4)
        for (int k = 0; k < 4; k++) rgba[k] = lines[k][x];
}

/* The blur m of a depth, less than 0 where it is nearer than the focus. */
static inline v8 blur_of(const struct pass *p, v8 z)
{
    const v8 c = p->blur * (1 - p->focus / z), size = least(1 + c * c * 0.125f, all(p->m_most));
    return if_below(c, -size, size);
}

static inline v8 known(v8 z) { return if_below(0 - z, z, all(FARTHEST)); }

/* The blur of each pixel of a row. A pixel at the side of a blurred near one is taken for near too: silhouettes are
 * mixed pixels, and what they have of the near surface would stand sharp under its blur. `nearest` is a scratch
 * line. */
static void row_blur(float *m, const struct pass *p, int y, float *nearest)
{
    const int w = p->frame->width, h = p->frame->height;
    const float *row = p->frame->z + (size_t)y * (size_t)w;
    const float *above = y > 0 ? row - w : row, *below = y + 1 < h ? row + w : row;
    int x = 0;

    memcpy(m, row, (size_t)w * sizeof *m);
    if (!p->any_near) {
        for (; x < w; x += 8) put(m + x, blur_of(p, known(get(m + x))));
        return;
    }
    for (; x + 8 <= w; x += 8)
        put(nearest + x, least(known(get(row + x)), least(known(get(above + x)), known(get(below + x)))));
    for (; x < w; x++) {
        nearest[x] = FARTHEST;
        for (int i = 0; i < 3; i++) {
            const float z = (i == 0 ? above : i == 1 ? row : below)[x];
            if (z > 0 && z < nearest[x]) nearest[x] = z;
        }
    }
    nearest[-1] = nearest[w] = FARTHEST;
    for (x = 0; x < w; x += 8) {
        const v8 own = blur_of(p, known(get(m + x)));
        const v8 beside = blur_of(p, least(get(nearest + x - 1), least(get(nearest + x), get(nearest + x + 1))));
        put(m + x, if_below(beside + BLURRED, beside, own));
    }
}

/* What of a row of the frame goes down to level 1; lines[channel][x]. rgba are scratch lines. */
static void frame_goes_down(const struct pass *p, int y, float *const *lines, float *const *rgba)
{
    const int w = p->frame->width;
    float *m = rgba[4];

    row_apart(rgba, p->frame->rgba + (size_t)y * (size_t)w * 4, w);
    row_blur(m, p, y, rgba[5]);
    for (int x = 0; x < w; x += 8) {
        /* what is near but hardly blurred may stand behind what is more so */
        const v8 m_signed = get(m + x), size = if_below(m_signed, -m_signed, m_signed);
        const v8 part = serves(size, 1) * most(1 - ramp(-m_signed, HARDLY, FULLY), all(LAST)),
                 weight = get(rgba[3] + x) * part;
        for (int k = 0; k < 3; k++) put(lines[BACK + k] + x, get(rgba[k] + x) * part);
        put(lines[BACK_WEIGHT] + x, weight);
        put(lines[BACK_M] + x, weight * size);
    }
    for (int x = 0; p->any_near && x < w; x += 8) {
        const v8 size = -get(m + x), part = beyond(size, 1), cover = get(rgba[3] + x) * part;
        for (int k = 0; k < 3; k++) put(lines[NEAR + k] + x, get(rgba[k] + x) * part);
        put(lines[NEAR_COVER] + x, cover);
        put(lines[NEAR_M] + x, cover * size);
        put(lines[OPEN] + x, if_below(size, all(1), all(0)));
    }
}

static void level_goes_down(const struct pass *p, int y, float *const *lines)
{
    const struct defocus_level *l = &p->d->levels[p->level];
    const float here = ldexpf(1, 2 * p->level), *row = line_of(l, y, 0);
    const size_t stride = l->stride;

    for (int x = 0; x < l->width; x += 8) {
        const float *at = row + x;
        const v8 weight = get(at + BACK_WEIGHT * stride), m = get(at + BACK_M * stride);
        const v8 part = serves(m / (weight + TINY), here);
        for (size_t k = BACK; k < BACK_WEIGHT; k++) put(lines[k] + x, get(at + k * stride) * part);
        put(lines[BACK_WEIGHT] + x, weight * part);
        put(lines[BACK_M] + x, m * part);
    }
    for (int x = 0; p->any_near && x < l->width; x += 8) {
        const float *at = row + x;
        const v8 cover = get(at + NEAR_COVER * stride), m = get(at + NEAR_M * stride);
        const v8 wanted = m / (cover + TINY), part = beyond(wanted, here), open = get(at + OPEN * stride);
        for (size_t k = NEAR; k < NEAR_COVER; k++) put(lines[k] + x, get(at + k * stride) * part);
        put(lines[NEAR_COVER] + x, cover * part);
        put(lines[NEAR_M] + x, m * part);
        put(lines[OPEN] + x, 1 - (1 - open) * ramp(wanted, here / 4, here));
    }
}

/* to[i] = (1 3 3 1) / 8 around 2 i and 2 i + 1; the line's ends go on as they are. */
static void halve_line(float *restrict to, float *restrict line, int width)
{
    const int half = (width + 1) / 2;
    line[-1] = line[0];
    line[width] = line[width + 1] = line[width - 1];
    for (int i = 0; i < half; i++)
        to[i] = 0.125f * ((line[2 * i - 1] + line[2 * i + 2]) + 3 * (line[2 * i] + line[2 * i + 1]));
}

/* Rows of level + 1 from rows of level. */
static void rows_down(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pass *p = ctx;
    const bool base = p->level == 0;
    const struct defocus_level *to = &p->d->levels[p->level + 1], *from = &p->d->levels[p->level];
    const size_t size = line_size(from->width), half = line_size(to->width);
    float *at = p->d->scratch + (size_t)thread * p->d->scratch_size, *lines[CHANNELS], *spare[6], *halved[4][CHANNELS];

    for (int k = 0; k < CHANNELS; k++, at += size) lines[k] = at + MARGIN;
    for (int k = 0; k < 6; k++, at += size) spare[k] = at + MARGIN;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < CHANNELS; k++, at += half) halved[i][k] = at;

    for (int row = 2 * (int)begin - 1; row <= 2 * (int)end; row++) {
        const int y = row < 0 ? 0 : row >= from->height ? from->height - 1 : row;
        if (base)
            frame_goes_down(p, y, lines, spare);
        else
            level_goes_down(p, y, lines);
        for (int k = 0; k < CHANNELS; k++)
            if (used(p, k)) halve_line(halved[row & 3][k], lines[k], from->width);
        if (row & 1 || row < 2 * (int)begin + 2) continue;
        const int out = row / 2 - 1; /* rows 2 out - 1 .. 2 out + 2 are there */
        for (int k = 0; k < CHANNELS; k++) {
            const float *restrict a = halved[(row - 3) & 3][k], *restrict b = halved[(row - 2) & 3][k];
            const float *restrict c = halved[(row - 1) & 3][k], *restrict d = halved[row & 3][k];
            float *restrict sum = line_of(to, out, k);
            if (!used(p, k)) continue;
            for (int i = 0; i < to->width; i++) sum[i] = 0.125f * ((a[i] + d[i]) + 3 * (b[i] + c[i]));
        }
    }
}

/* --------------------------------------------------------------------------------------------------------- up */

/* A line of the coarser level as row y of the finer one has it; of an odd width one more value is written. */
static void double_line(float *restrict to, float *restrict blend, const struct defocus_level *coarse, int y, int k)
{
    const int near = y / 2, other = y & 1 ? near + 1 : near - 1, w = coarse->width;
    const float *restrict a = line_of(coarse, near, CHANNELS + k);
    const float *restrict b = line_of(coarse,
                                      other < 0                ? 0
                                      : other < coarse->height ? other
                                                               : coarse->height - 1,
                                      CHANNELS + k);

    for (int i = 0; i < w; i++) blend[i] = 0.75f * a[i] + 0.25f * b[i];
    blend[-1] = blend[0];
    blend[w] = blend[w - 1];
    for (int i = 0; i < w; i++) {
        to[2 * i] = 0.75f * blend[i] + 0.25f * blend[i - 1];
        to[2 * i + 1] = 0.75f * blend[i] + 0.25f * blend[i + 1];
    }
}

/* lines[k]: rows y - 1 .. y + 1 of the channels that hold light, by (1 2 1) / 4; of the near ones what is to be
 * smoothed. */
static void smooth_rows(const struct pass *p, int y, float *const *lines)
{
    const struct defocus_level *l = &p->d->levels[p->level];
    const float here = ldexpf(1, 2 * p->level);
    const float *rows[3];

    for (int i = 0; i < 3; i++) {
        const int at = y + i - 1;
        rows[i] = line_of(l, at < 0 ? 0 : at < l->height ? at : l->height - 1, 0);
    }
    for (size_t k = BACK; k <= BACK_WEIGHT; k++) {
        const float *a = rows[0] + k * l->stride, *b = rows[1] + k * l->stride, *c = rows[2] + k * l->stride;
        for (int x = 0; x < l->width; x += 8) put(lines[k] + x, 0.25f * (get(a + x) + get(c + x)) + 0.5f * get(b + x));
    }
    for (int x = 0; p->any_near && x < l->width; x += 8) {
        v8 sum[NEAR_COVER + 1] = {{0}};
        for (int i = 0; i < 3; i++) {
            const float *at = rows[i] + x;
            const v8 m = get(at + NEAR_M * l->stride) / (get(at + NEAR_COVER * l->stride) + TINY);
            const v8 part = (i == 1 ? 0.5f : 0.25f) * smoothed(m, here);
            for (size_t k = NEAR; k <= NEAR_COVER; k++) sum[k] += part * get(at + k * l->stride);
        }
        for (size_t k = NEAR; k <= NEAR_COVER; k++) put(lines[k] + x, sum[k]);
    }
    for (int k = BACK; k <= NEAR_COVER; k++) {
        lines[k][-1] = lines[k][0];
        lines[k][l->width] = lines[k][l->width - 1];
    }
}

static inline v8 smooth(const float *at) { return 0.25f * (get(at - 1) + get(at + 1)) + 0.5f * get(at); }

/* The part of a coverage for which there is room beside what is nearer. */
static inline v8 room_for(v8 cover, v8 nearer) { return least(most(1 - nearer, all(0)) / (cover + TINY), all(1)); }

static void level_looks_up(const struct pass *p, int y, float *const *up, float *const *lines)
{
    const struct defocus_level *l = &p->d->levels[p->level];
    const float here = ldexpf(1, 2 * p->level); /* on the last level no m is above it */
    const size_t stride = l->stride, result = CHANNELS * l->stride;
    float *row = line_of(l, y, 0);

    smooth_rows(p, y, lines);
    for (int x = 0; x < l->width; x += 8) {
        float *at = row + x;
        const v8 weight = get(at + BACK_WEIGHT * stride), above = get(up[BACK_WEIGHT] + x);
        const v8 m = get(at + BACK_M * stride) / (weight + TINY), blurred = smoothed(m, here);
        const v8 sum = weight + LEAST * above, sharp = 1 - beyond(m, here) - blurred;
        const v8 around = blurred * weight / (smooth(lines[BACK_WEIGHT] + x) + TINY);
        const v8 coarser = (sum - (sharp + blurred) * weight) / (above + TINY);
        for (size_t k = BACK; k < BACK_WEIGHT; k++)
            put(at + k * stride + result,
                get(at + k * stride) * sharp + smooth(lines[k] + x) * around + get(up[k] + x) * coarser);
        put(at + BACK_WEIGHT * stride + result, sum);
    }
    for (int x = 0; p->any_near && x < l->width; x += 8) {
        float *at = row + x;
        const v8 cover = get(at + NEAR_COVER * stride), nearer = get(up[NEAR_COVER] + x);
        const v8 m = get(at + NEAR_M * stride) / (cover + TINY), on = beyond(m, here),
                 sharp = 1 - on - smoothed(m, here);
        const v8 left = cover * sharp + smooth(lines[NEAR_COVER] + x), room = room_for(left, nearer);
        for (size_t k = NEAR; k < NEAR_COVER; k++)
            put(at + k * stride + result,
                (get(at + k * stride) * sharp + smooth(lines[k] + x)) * room + get(up[k] + x));
        put(at + NEAR_COVER * stride + result, left * room + nearer);
        put(at + OPEN * stride + result, get(at + OPEN * stride) * (1 - on) + get(up[OPEN] + x) * on);
    }
}

static void frame_looks_up(const struct pass *p, int y, float *const *up, float *const *rgba)
{
    const int w = p->frame->width;
    float *row = p->frame->rgba + (size_t)y * (size_t)w * 4, *m = rgba[4];

    row_apart(rgba, row, w);
    row_blur(m, p, y, rgba[5]);
    for (int x = 0; !p->any_near && x < w; x += 8) {
        const v8 on = beyond(get(m + x), 1), own = 1 - on;
        const v8 coarser = on * get(rgba[3] + x) / (get(up[BACK_WEIGHT] + x) + TINY);
        for (int k = 0; k < 3; k++) put(rgba[k] + x, get(rgba[k] + x) * own + get(up[BACK + k] + x) * coarser);
    }
    for (int x = 0; p->any_near && x < w; x += 8) {
        /* A pixel of the back lies under the near layer; a near pixel is a part of it, and where the layer does not
         * cover it the back shows as far as there is any within its own blur. */
        const v8 m_signed = get(m + x), alpha = get(rgba[3] + x);
        const v8 on = beyond(if_below(m_signed, -m_signed, m_signed), 1), own = 1 - on;
        const v8 nearer = get(up[NEAR_COVER] + x), room = room_for(alpha * own, nearer);
        const v8 cover = nearer + if_below(m_signed, alpha * own * room, all(0));
        const v8 left = most(1 - cover, all(0)), seen = on * get(up[OPEN] + x);
        const v8 layer = 1 / if_below(m_signed, cover + seen + TINY, most(cover, all(1)));
        const v8 mine = own * if_below(m_signed, layer * room, left);
        const v8 coarser = if_below(m_signed, layer * seen, left * on * alpha) / (get(up[BACK_WEIGHT] + x) + TINY);
        for (int k = 0; k < 3; k++)
            put(rgba[k] + x,
                get(rgba[k] + x) * mine + (get(up[NEAR + k] + x) * layer + get(up[BACK + k] + x) * coarser));
        put(rgba[3] + x, if_below(m_signed, all(1), cover * layer + left * alpha));
    }
    row_together(row, rgba, w);
}

static void rows_up(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pass *p = ctx;
    const struct defocus_level *l = &p->d->levels[p->level];
    const size_t size = line_size(l->width + 1);
    float *at = p->d->scratch + (size_t)thread * p->d->scratch_size, *up[UP_CHANNELS], *spare[8], *blend;

    for (int k = 0; k < UP_CHANNELS; k++, at += size) up[k] = at;
    for (int k = 0; k < 8; k++, at += size) spare[k] = at + MARGIN;
    blend = at + MARGIN;
    for (int y = (int)begin; y < (int)end; y++) {
        for (int k = 0; k < UP_CHANNELS; k++) {
            if (!used(p, k)) continue;
            if (p->level == p->d->level_count)
                memset(up[k], 0, size * sizeof *at);
            else
                double_line(up[k], blend, l + 1, y, k);
        }
        if (p->level)
            level_looks_up(p, y, up, spare);
        else
            frame_looks_up(p, y, up, spare);
    }
}

/* ------------------------------------------------------------------------------------------------------ frames */

static enum status resize(struct defocus *d, int width, int height, struct err *err)
{
    const int threads = parallel_threads();
    size_t size = 0;

    if (d->width == width && d->height == height && d->threads >= threads) return ST_OK;
    defocus_release(d);
    d->levels[0] = (struct defocus_level){.width = width, .height = height};
    while (d->levels[d->level_count].width > 1 || d->levels[d->level_count].height > 1) {
        const struct defocus_level *from = &d->levels[d->level_count];
        struct defocus_level *l = &d->levels[++d->level_count];
        l->width = (from->width + 1) / 2;
        l->height = (from->height + 1) / 2;
        l->stride = (size_t)(l->width + 7) / 8 * 8;
        l->plane = (CHANNELS + UP_CHANNELS) * l->stride;
        size += l->plane * (size_t)l->height;
    }
    d->scratch_size = (CHANNELS + 6) * line_size(width + 1) + 4 * CHANNELS * line_size((width + 1) / 2);
    const size_t bytes = (size + (size_t)threads * d->scratch_size) * sizeof *d->memory;
    d->memory = aligned_alloc(64, (bytes + 63) / 64 * 64 + 64);
    if (!d->memory) {
        defocus_release(d);
        return err_nomem(err, "the pyramids of a blurred frame", bytes);
    }
    float *at = d->memory;
    for (int k = 1; k <= d->level_count; k++) {
        d->levels[k].texels = at;
        at += d->levels[k].plane * (size_t)d->levels[k].height;
    }
    d->scratch = at;
    memset(d->memory, 0, bytes);
    d->width = width;
    d->height = height;
    d->threads = threads;
    return ST_OK;
}

void defocus_release(struct defocus *d)
{
    if (!d) return;
    free(d->memory);
    *d = (struct defocus){0};
}

static bool has_nearer(const float *restrict z, size_t count, float focus)
{
    for (size_t begin = 0; begin < count; begin += 4096) {
        const size_t end = count - begin > 4096 ? begin + 4096 : count;
        int nearer = 0;
        for (size_t i = begin; i < end; i++) nearer |= (z[i] > 0) & (z[i] < focus);
        if (nearer) return true;
    }
    return false;
}

enum status defocus_apply(struct defocus *d, struct rendered_frame *frame, const struct view *camera, double aperture,
                          double focus, struct err *err)
{
    if (!(aperture >= 0) || !isfinite(aperture))
        return err_set(err, ST_DATA, "frame %s has the aperture %g: wanted a diameter of 0 or more.",
                       camera->name ? camera->name : "", aperture);
    if (aperture == 0) return ST_OK;
    if (!(focus > 0 && isfinite(focus)))
        return err_set(err, ST_DATA, "frame %s is focused at depth %g: with an aperture, wanted more than 0.",
                       camera->name ? camera->name : "", focus);
    if (resize(d, frame->width, frame->height, err)) return err->status;
    if (!d->level_count) return ST_OK;

    struct pass pass = {.d = d, .frame = frame, .focus = (float)focus};
    pass.blur = (float)(aperture * camera->fx / focus);
    pass.m_most = ldexpf(1, 2 * d->level_count);
    pass.any_near = has_nearer(frame->z, (size_t)frame->width * (size_t)frame->height, pass.focus);
    for (pass.level = 0; pass.level < d->level_count; pass.level++)
        parallel_for((size_t)d->levels[pass.level + 1].height, ROWS / 2, rows_down, &pass);
    for (pass.level = d->level_count; pass.level >= 0; pass.level--)
        parallel_for((size_t)d->levels[pass.level].height, ROWS, rows_up, &pass);
    return ST_OK;
}
