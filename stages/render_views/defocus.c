/* defocus.c - depth of field by blurring a pinhole frame through a MIP map [Colburn 2014, 3.6.1].
 *
 * A pixel at depth z has the circle of confusion c = aperture fx (z - focus) / (z focus) px, negative in front of the
 * focus. Surfaces in or behind the focus (the back) and surfaces in front of it (the near layer) have one MIP map each,
 * because light spreads differently:
 *
 * - In front of the focus, a surface's light spreads over everything behind it. Each pixel's colour and coverage
 *   descend to the level of the pixel's own blur and stay there. The levels, upsampled and added, are the near layer,
 *   whose coverage fades across a silhouette. Nearer surfaces are blurred more, so a coarser level covers a finer one
 *   where they add up to more than 1. The near layer is composited over the back.
 * - In or behind the focus, a pixel sees through its own circle everything that nearer surfaces do not hide. It looks
 *   up the level of its own blur. On the way down a pixel counts only as long as its own blur is of the level's size,
 *   so sharp or near surfaces do not bleed into a blurred background. Near pixels have no weight: behind them the back
 *   is interpolated from their surroundings.
 *
 * The look-up is trilinear, bottom up. Upsampling is bilinear (3/4, 1/4 on each axis) and downsampling its transpose (1
 * 3 3 1) / 8, so that the blur of a moving point moves evenly. The kernel of level l has the variance (4^l - 1) / 2, a
 * disk c^2 / 16, hence l = log4(1 + c^2 / 8). Between two levels lies the finer one smoothed by (1 2 1) / 4, of twice
 * the variance; a mixture of neighbours among these has the required variance.
 *
 * The thesis blends pixels behind the focus with a blurred picture, by the mean depth and the fraction of foreground
 * pixels around them; its kernels are Gaussians on one level.
 *
 * In the code a blur is given by m = 4^l = 1 + c^2 / 8. Of texels that want the blur m, a part stays on a level, as it
 * is or smoothed, and the rest goes on to coarser levels: coarser_part(), smoothed_part(). A texel's m is the mean of
 * its contributions. Channels of a level: of the back, colour x weight, weight, m x weight; of the near layer, colour,
 * coverage, m x coverage; and OPEN, the part of a texel that is not near, or much less blurred than the level: what a
 * near pixel that looks up this level lets through. On the way up each level also gets the result of its look-up; the
 * near layer's is what stayed on coarser levels, which is nearer, and then what stays on this level as far as coverage
 * permits. All loops run over lines of one channel, eight texels at a time; lines are padded, and values in the padding
 * are never used. */
#include "stages/render_views/defocus.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/lanes.h"

enum { BACK, BACK_WEIGHT = 3, NEAR, NEAR_COVER = 7, OPEN, BACK_M, NEAR_M, CHANNELS };
#define UP_CHANNELS BACK_M /* results of BACK .. OPEN, stored behind the channels */

#define ROWS       32          /* per chunk */
#define MARGIN     8           /* floats beside a line, for its continuation beyond both ends */
#define MIN_WEIGHT (1.0f / 64) /* of texels too sharp for a level, or hidden: counts where there is nothing else */
#define TINY       1e-36f      /* avoids 0 / 0 */
#define FARTHEST   1e30f       /* depth in place of unknown ones */
#define BLURRED    1.5f        /* min m of a near surface whose silhouette is widened */
#define FADE_BEGIN 2           /* m from which on a near surface fades out of the back ... */
#define FADE_END   8           /* ... down to weight FADED */
#define FADED      1e-9f       /* counts where there is nothing else */
#define SPREAD     4           /* max ratio of the m that a pixel of the back contributes to and its own */

/* a < 0 (sign bit set) ? b : c */
static inline f32x8 if_below(f32x8 a, f32x8 b, f32x8 c) { return f32x8_if((i32x8)a, b, c); }

/* 0 at `from`, 1 at `to`, linear between. */
static inline f32x8 ramp(f32x8 m, float from, float to)
{
    return f32x8_min(f32x8_max((m - from) * (1 / (to - from)), f32x8_all(0)), f32x8_all(1));
}

/* The part of a blur m that goes on to levels coarser than the one of blur `here` = 4^level. The rest stays, as it is
 * or, except on level 0, smoothed by (1 2 1) / 4, which has the blur 2 `here`: so the mixed kernels differ by half
 * an octave only, and no sharp core shows inside a wide blur. */
static inline f32x8 coarser_part(f32x8 m, float here) { return here > 1 ? ramp(m, 2 * here, 4 * here) : ramp(m, 1, 4); }
static inline f32x8 smoothed_part(f32x8 m, float here) { return ramp(m, here, 2 * here) - coarser_part(m, here); }

/* As coarser_part, for the weight of a texel in other pixels' look-ups: blurred texels contribute up to one level more,
 * so that edges between blurs have no step; sharp texels do not. */
static inline f32x8 source_part(f32x8 m, float here)
{
    return f32x8_max(coarser_part(m * f32x8_min(m, f32x8_all(SPREAD)), here), f32x8_all(MIN_WEIGHT));
}

struct defocus_pass { /* between two adjacent levels */
    struct defocus *d;
    struct rendered_frame *frame;
    float blur, focus, max_m; /* c = blur (1 - focus / z) */
    int level;                /* the finer one */
    bool any_near;
};

static float *line_of(const struct defocus_level *l, int y, int channel)
{
    return l->texels + (size_t)y * l->plane + (size_t)channel * l->stride;
}

static size_t line_size(int width) { return (size_t)(width + 2 * MARGIN + 7) / 8 * 8; }

static bool used(const struct defocus_pass *p, int channel)
{
    return p->any_near || channel < NEAR || channel == BACK_M;
}

/* ----------------------------------------------------------------------------------------------- downsampling */

/* A row of the frame to four lines, red, green, blue, alpha; and back. */
static void row_split(float *const *lines, const float *rgba, int width)
{
    int x = 0;
    for (; x + 8 <= width; x += 8, rgba += 32) { /* pixels 0 .. 3 in the low halves, 4 .. 7 in the high ones */
        f32x8 v[4];
        for (int k = 0; k < 4; k++) v[k] = f32x8_join(f32x4_load(rgba + 4 * k), f32x4_load(rgba + 4 * k + 16));
        f32x8_transpose(v);
        for (int k = 0; k < 4; k++) f32x8_store(lines[k] + x, v[k]);
    }
    for (; x < width; x++, rgba += 4)
        for (int k = 0; k < 4; k++) lines[k][x] = rgba[k];
}

static void row_join(float *rgba, float *const *lines, int width)
{
    int x = 0;
    for (; x + 8 <= width; x += 8, rgba += 32) {
        f32x8 v[4];
        for (int k = 0; k < 4; k++) v[k] = f32x8_load(lines[k] + x);
        f32x8_transpose(v);
        for (int k = 0; k < 4; k++) {
            f32x4_store(rgba + 4 * k, f32x8_low(v[k]));
            f32x4_store(rgba + 4 * k + 16, f32x8_high(v[k]));
        }
    }
    for (; x < width; x++, rgba += 4)
        for (int k = 0; k < 4; k++) rgba[k] = lines[k][x];
}

/* The blur m of a depth, negative in front of the focus. */
static inline f32x8 blur_of(const struct defocus_pass *p, f32x8 z)
{
    const f32x8 c = p->blur * (1 - p->focus / z), size = f32x8_min(1 + c * c * 0.125f, f32x8_all(p->max_m));
    return if_below(c, -size, size);
}

static inline f32x8 known(f32x8 z) { return if_below(0 - z, z, f32x8_all(FARTHEST)); }

/* The blur of each pixel of a row. Pixels beside a blurred near pixel count as near, too: silhouette pixels are mixed,
 * and their share of the near surface would show sharp under its blur. `nearest` is a scratch line. */
static void row_blur(float *m, const struct defocus_pass *p, int y, float *nearest)
{
    const int w = p->frame->width, h = p->frame->height;
    const float *row = p->frame->z + (size_t)y * (size_t)w;
    const float *above = y > 0 ? row - w : row, *below = y + 1 < h ? row + w : row;
    int x = 0;

    memcpy(m, row, (size_t)w * sizeof *m);
    if (!p->any_near) {
        for (; x < w; x += 8) f32x8_store(m + x, blur_of(p, known(f32x8_load(m + x))));
        return;
    }
    for (; x + 8 <= w; x += 8)
        f32x8_store(nearest + x, f32x8_min(known(f32x8_load(row + x)),
                                           f32x8_min(known(f32x8_load(above + x)), known(f32x8_load(below + x)))));
    for (; x < w; x++) {
        nearest[x] = FARTHEST;
        for (int i = 0; i < 3; i++) {
            const float z = (i == 0 ? above : i == 1 ? row : below)[x];
            if (z > 0 && z < nearest[x]) nearest[x] = z;
        }
    }
    nearest[-1] = nearest[w] = FARTHEST;
    for (x = 0; x < w; x += 8) {
        const f32x8 own = blur_of(p, known(f32x8_load(m + x)));
        const f32x8 beside = blur_of(
            p, f32x8_min(f32x8_load(nearest + x - 1), f32x8_min(f32x8_load(nearest + x), f32x8_load(nearest + x + 1))));
        f32x8_store(m + x, if_below(beside + BLURRED, beside, own));
    }
}

/* Contribution of a row of the frame to level 1: lines[channel][x]. rgba are scratch lines. */
static void downsample_frame(const struct defocus_pass *p, int y, float *const *lines, float *const *rgba)
{
    const int w = p->frame->width;
    float *m = rgba[4];

    row_split(rgba, p->frame->rgba + (size_t)y * (size_t)w * 4, w);
    row_blur(m, p, y, rgba[5]);
    for (int x = 0; x < w; x += 8) {
        /* near but slightly blurred surfaces may show behind more blurred ones */
        const f32x8 m_signed = f32x8_load(m + x), size = if_below(m_signed, -m_signed, m_signed);
        const f32x8 part =
                        source_part(size, 1) * f32x8_max(1 - ramp(-m_signed, FADE_BEGIN, FADE_END), f32x8_all(FADED)),
                    weight = f32x8_load(rgba[3] + x) * part;
        for (int k = 0; k < 3; k++) f32x8_store(lines[BACK + k] + x, f32x8_load(rgba[k] + x) * part);
        f32x8_store(lines[BACK_WEIGHT] + x, weight);
        f32x8_store(lines[BACK_M] + x, weight * size);
    }
    for (int x = 0; p->any_near && x < w; x += 8) {
        const f32x8 size = -f32x8_load(m + x), part = coarser_part(size, 1), cover = f32x8_load(rgba[3] + x) * part;
        for (int k = 0; k < 3; k++) f32x8_store(lines[NEAR + k] + x, f32x8_load(rgba[k] + x) * part);
        f32x8_store(lines[NEAR_COVER] + x, cover);
        f32x8_store(lines[NEAR_M] + x, cover * size);
        f32x8_store(lines[OPEN] + x, if_below(size, f32x8_all(1), f32x8_all(0)));
    }
}

/* Contribution of a row of level p->level to the next coarser one. */
static void downsample_level(const struct defocus_pass *p, int y, float *const *lines)
{
    const struct defocus_level *l = &p->d->levels[p->level];
    const float here = ldexpf(1, 2 * p->level), *row = line_of(l, y, 0);
    const size_t stride = l->stride;

    for (int x = 0; x < l->width; x += 8) {
        const float *at = row + x;
        const f32x8 weight = f32x8_load(at + BACK_WEIGHT * stride), m = f32x8_load(at + BACK_M * stride);
        const f32x8 part = source_part(m / (weight + TINY), here);
        for (size_t k = BACK; k < BACK_WEIGHT; k++) f32x8_store(lines[k] + x, f32x8_load(at + k * stride) * part);
        f32x8_store(lines[BACK_WEIGHT] + x, weight * part);
        f32x8_store(lines[BACK_M] + x, m * part);
    }
    for (int x = 0; p->any_near && x < l->width; x += 8) {
        const float *at = row + x;
        const f32x8 cover = f32x8_load(at + NEAR_COVER * stride), m = f32x8_load(at + NEAR_M * stride);
        const f32x8 wanted = m / (cover + TINY), part = coarser_part(wanted, here),
                    open = f32x8_load(at + OPEN * stride);
        for (size_t k = NEAR; k < NEAR_COVER; k++) f32x8_store(lines[k] + x, f32x8_load(at + k * stride) * part);
        f32x8_store(lines[NEAR_COVER] + x, cover * part);
        f32x8_store(lines[NEAR_M] + x, m * part);
        f32x8_store(lines[OPEN] + x, 1 - (1 - open) * ramp(wanted, here / 4, here));
    }
}

/* to[i] = (1 3 3 1) / 8 around 2 i and 2 i + 1; the end values continue beyond the line. */
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
    const struct defocus_pass *p = ctx;
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
            downsample_frame(p, y, lines, spare);
        else
            downsample_level(p, y, lines);
        for (int k = 0; k < CHANNELS; k++)
            if (used(p, k)) halve_line(halved[row & 3][k], lines[k], from->width);
        if (row & 1 || row < 2 * (int)begin + 2) continue;
        const int out = row / 2 - 1; /* rows 2 out - 1 .. 2 out + 2 are in `halved` */
        for (int k = 0; k < CHANNELS; k++) {
            const float *restrict a = halved[(row - 3) & 3][k], *restrict b = halved[(row - 2) & 3][k];
            const float *restrict c = halved[(row - 1) & 3][k], *restrict d = halved[row & 3][k];
            float *restrict sum = line_of(to, out, k);
            if (!used(p, k)) continue;
            for (int i = 0; i < to->width; i++) sum[i] = 0.125f * ((a[i] + d[i]) + 3 * (b[i] + c[i]));
        }
    }
}

/* ------------------------------------------------------------------------------------------------- upsampling */

/* Upsamples channel k of the coarser level's result to row y of the finer one. Writes an even number of values. */
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

/* lines[k]: rows y - 1 .. y + 1 of the colour and weight channels, filtered by (1 2 1) / 4; of the near layer only the
 * smoothed part. */
static void smooth_rows(const struct defocus_pass *p, int y, float *const *lines)
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
        for (int x = 0; x < l->width; x += 8)
            f32x8_store(lines[k] + x, 0.25f * (f32x8_load(a + x) + f32x8_load(c + x)) + 0.5f * f32x8_load(b + x));
    }
    for (int x = 0; p->any_near && x < l->width; x += 8) {
        f32x8 sum[NEAR_COVER + 1] = {{0}};
        for (int i = 0; i < 3; i++) {
            const float *at = rows[i] + x;
            const f32x8 m = f32x8_load(at + NEAR_M * l->stride) / (f32x8_load(at + NEAR_COVER * l->stride) + TINY);
            const f32x8 part = (i == 1 ? 0.5f : 0.25f) * smoothed_part(m, here);
            for (size_t k = NEAR; k <= NEAR_COVER; k++) sum[k] += part * f32x8_load(at + k * l->stride);
        }
        for (size_t k = NEAR; k <= NEAR_COVER; k++) f32x8_store(lines[k] + x, sum[k]);
    }
    for (int k = BACK; k <= NEAR_COVER; k++) {
        lines[k][-1] = lines[k][0];
        lines[k][l->width] = lines[k][l->width - 1];
    }
}

static inline f32x8 smooth(const float *at)
{
    return 0.25f * (f32x8_load(at - 1) + f32x8_load(at + 1)) + 0.5f * f32x8_load(at);
}

/* The part of a coverage that fits beside nearer coverage. */
static inline f32x8 room_for(f32x8 cover, f32x8 nearer)
{
    return f32x8_min(f32x8_max(1 - nearer, f32x8_all(0)) / (cover + TINY), f32x8_all(1));
}

/* Result of row y of a level: its own part composited with the coarser levels' result `up`. */
static void composite_level(const struct defocus_pass *p, int y, float *const *up, float *const *lines)
{
    const struct defocus_level *l = &p->d->levels[p->level];
    const float here = ldexpf(1, 2 * p->level); /* max_m on the last level */
    const size_t stride = l->stride, result = CHANNELS * l->stride;
    float *row = line_of(l, y, 0);

    smooth_rows(p, y, lines);
    for (int x = 0; x < l->width; x += 8) {
        float *at = row + x;
        const f32x8 weight = f32x8_load(at + BACK_WEIGHT * stride), above = f32x8_load(up[BACK_WEIGHT] + x);
        const f32x8 m = f32x8_load(at + BACK_M * stride) / (weight + TINY), blurred = smoothed_part(m, here);
        const f32x8 sum = weight + MIN_WEIGHT * above, sharp = 1 - coarser_part(m, here) - blurred;
        const f32x8 around = blurred * weight / (smooth(lines[BACK_WEIGHT] + x) + TINY);
        const f32x8 coarser = (sum - (sharp + blurred) * weight) / (above + TINY);
        for (size_t k = BACK; k < BACK_WEIGHT; k++)
            f32x8_store(at + k * stride + result, f32x8_load(at + k * stride) * sharp + smooth(lines[k] + x) * around +
                                                      f32x8_load(up[k] + x) * coarser);
        f32x8_store(at + BACK_WEIGHT * stride + result, sum);
    }
    for (int x = 0; p->any_near && x < l->width; x += 8) {
        float *at = row + x;
        const f32x8 cover = f32x8_load(at + NEAR_COVER * stride), nearer = f32x8_load(up[NEAR_COVER] + x);
        const f32x8 m = f32x8_load(at + NEAR_M * stride) / (cover + TINY), on = coarser_part(m, here),
                    sharp = 1 - on - smoothed_part(m, here);
        const f32x8 left = cover * sharp + smooth(lines[NEAR_COVER] + x), room = room_for(left, nearer);
        for (size_t k = NEAR; k < NEAR_COVER; k++)
            f32x8_store(at + k * stride + result,
                        (f32x8_load(at + k * stride) * sharp + smooth(lines[k] + x)) * room + f32x8_load(up[k] + x));
        f32x8_store(at + NEAR_COVER * stride + result, left * room + nearer);
        f32x8_store(at + OPEN * stride + result,
                    f32x8_load(at + OPEN * stride) * (1 - on) + f32x8_load(up[OPEN] + x) * on);
    }
}

/* The final row y of the frame. */
static void composite_frame(const struct defocus_pass *p, int y, float *const *up, float *const *rgba)
{
    const int w = p->frame->width;
    float *row = p->frame->rgba + (size_t)y * (size_t)w * 4, *m = rgba[4];

    row_split(rgba, row, w);
    row_blur(m, p, y, rgba[5]);
    for (int x = 0; !p->any_near && x < w; x += 8) {
        const f32x8 on = coarser_part(f32x8_load(m + x), 1), own = 1 - on;
        const f32x8 coarser = on * f32x8_load(rgba[3] + x) / (f32x8_load(up[BACK_WEIGHT] + x) + TINY);
        for (int k = 0; k < 3; k++)
            f32x8_store(rgba[k] + x, f32x8_load(rgba[k] + x) * own + f32x8_load(up[BACK + k] + x) * coarser);
    }
    for (int x = 0; p->any_near && x < w; x += 8) {
        /* A pixel of the back is under the near layer. A near pixel is part of the layer; where the layer does not
         * cover it, the back shows through as far as there is any within the pixel's own blur. */
        const f32x8 m_signed = f32x8_load(m + x), alpha = f32x8_load(rgba[3] + x);
        const f32x8 on = coarser_part(if_below(m_signed, -m_signed, m_signed), 1), own = 1 - on;
        const f32x8 nearer = f32x8_load(up[NEAR_COVER] + x), room = room_for(alpha * own, nearer);
        const f32x8 cover = nearer + if_below(m_signed, alpha * own * room, f32x8_all(0));
        const f32x8 left = f32x8_max(1 - cover, f32x8_all(0)), seen = on * f32x8_load(up[OPEN] + x);
        const f32x8 layer = 1 / if_below(m_signed, cover + seen + TINY, f32x8_max(cover, f32x8_all(1)));
        const f32x8 mine = own * if_below(m_signed, layer * room, left);
        const f32x8 coarser =
            if_below(m_signed, layer * seen, left * on * alpha) / (f32x8_load(up[BACK_WEIGHT] + x) + TINY);
        for (int k = 0; k < 3; k++)
            f32x8_store(rgba[k] + x, f32x8_load(rgba[k] + x) * mine + (f32x8_load(up[NEAR + k] + x) * layer +
                                                                       f32x8_load(up[BACK + k] + x) * coarser));
        f32x8_store(rgba[3] + x, if_below(m_signed, f32x8_all(1), cover * layer + left * alpha));
    }
    row_join(row, rgba, w);
}

static void rows_up(void *ctx, size_t begin, size_t end, int thread)
{
    const struct defocus_pass *p = ctx;
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
            composite_level(p, y, up, spare);
        else
            composite_frame(p, y, up, spare);
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
        return err_nomem(err, "the MIP maps of a frame", bytes);
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

/* Whether any known depth is in front of the focus. */
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
        return err_set(err, ST_DATA, "the aperture of frame %s is %g: wanted a diameter of 0 or more.",
                       camera->name ? camera->name : "", aperture);
    if (aperture == 0) return ST_OK;
    if (!(focus > 0 && isfinite(focus)))
        return err_set(err, ST_DATA,
                       "the focus of frame %s is %g: wanted a depth above 0, because its aperture is open.",
                       camera->name ? camera->name : "", focus);
    if (resize(d, frame->width, frame->height, err)) return err->status;
    if (!d->level_count) return ST_OK;

    struct defocus_pass pass = {.d = d, .frame = frame, .focus = (float)focus};
    pass.blur = (float)(aperture * camera->fx / focus);
    pass.max_m = ldexpf(1, 2 * d->level_count);
    pass.any_near = has_nearer(frame->z, (size_t)frame->width * (size_t)frame->height, pass.focus);
    for (pass.level = 0; pass.level < d->level_count; pass.level++)
        parallel_for((size_t)d->levels[pass.level + 1].height, ROWS / 2, rows_down, &pass);
    for (pass.level = d->level_count; pass.level >= 0; pass.level--)
        parallel_for((size_t)d->levels[pass.level].height, ROWS, rows_up, &pass);
    return ST_OK;
}
