/* pixel_quality.c - noise and marks under a filter's kernel.
 *
 * A filtered sample is s = sum_ij w_i w_j v_ij. If the noise of the v_ij is independent, its variance is
 * sum_ij w_i^2 w_j^2 var(v_ij). At the border a sample is repeated: then its weights are added before they are squared.
 * Noise that neighbouring pixels share, from demosaicing or JPEG, is not independent; a reduction then removes less of
 * it than stated. The filter's limit to the range of the nearest samples is not considered; it makes noise smaller.
 *
 * Few pixels are marked. The union of the marks in each tile of 8 x 8 pixels tells in at most four reads (without
 * reduction) that a window has none. */
#include "stages/rectify/pixel_quality.h"

#include <stdlib.h>
#include <string.h>

#include "common/image/samples.h"
#include "common/math/lanes.h"
#include "common/math/numbers.h"

enum { TILE_SHIFT = 3 };

static int tiles_across(int pixels) { return (pixels - 1) / (1 << TILE_SHIFT) + 1; }

enum status pixel_quality_init(struct pixel_quality *q, size_t pixels, struct err *err)
{
    const size_t tiles = pixels / 8 + 1; /* those of a picture of one row are most: an eighth of its pixels */
    q->tiles = samples_alloc(tiles);
    return q->tiles ? ST_OK : err_nomem(err, "tiles of marks", tiles);
}

void pixel_quality_prepare(struct pixel_quality *q)
{
    const size_t columns = (size_t)tiles_across(q->width), rows = (size_t)tiles_across(q->height);
    memset(q->tiles, 0, columns * rows);
    for (int y = 0; y < q->height; y++) {
        const uint8_t *marks = q->of->marks + (size_t)y * (size_t)q->width;
        uint8_t *tiles = q->tiles + (size_t)(y >> TILE_SHIFT) * columns;
        for (int x = 0; x < q->width; x++) tiles[x >> TILE_SHIFT] |= marks[x];
    }
}

void pixel_quality_release(struct pixel_quality *q)
{
    free(q->tiles);
    q->tiles = NULL;
}

static uint8_t unite(const uint8_t *marks, int stride, int x0, int y0, int x1, int y1)
{
    uint8_t all = 0;
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) all |= marks[(size_t)y * (size_t)stride + (size_t)x];
    return all;
}

uint8_t pixel_quality_marks(const struct pixel_quality *q, int x0, int y0, int x1, int y1)
{
    const int left = clamp_int(x0, 0, q->width - 1), right = clamp_int(x1 - 1, 0, q->width - 1);
    const int top = clamp_int(y0, 0, q->height - 1), bottom = clamp_int(y1 - 1, 0, q->height - 1);
    if (!unite(q->tiles, tiles_across(q->width), left >> TILE_SHIFT, top >> TILE_SHIFT, right >> TILE_SHIFT,
               bottom >> TILE_SHIFT))
        return 0;
    return unite(q->of->marks, q->width, left, top, right, bottom);
}

struct squares { /* squared weights of consecutive pixels */
    int first, count;
    float weight[MAX_TAPS];
};

static void square_taps(struct squares *s, const struct kernel_taps *t, int length)
{
    s->first = clamp_int(t->first, 0, length - 1);
    s->count = clamp_int(t->first + t->count - 1, 0, length - 1) - s->first + 1;
    for (int i = 0; i < s->count; i++) s->weight[i] = 0;
    for (int i = 0; i < t->count; i++) s->weight[clamp_int(t->first + i, 0, length - 1) - s->first] += t->weight[i];
    for (int i = 0; i < s->count; i++) s->weight[i] *= s->weight[i];
}

static float border_variance(const struct pixel_quality *q, const struct kernel_taps *tx, const struct kernel_taps *ty)
{
    struct squares across, down;
    float columns[MAX_TAPS], sum = 0;
    square_taps(&across, tx, q->width);
    square_taps(&down, ty, q->height);
    for (int i = 0; i < across.count; i++) columns[i] = 0;
    for (int j = 0; j < down.count; j++) {
        const float *row = q->of->variance + (size_t)(down.first + j) * (size_t)q->width + across.first;
        for (int i = 0; i < across.count; i++) columns[i] += down.weight[j] * row[i];
    }
    for (int i = 0; i < across.count; i++) sum += across.weight[i] * columns[i];
    return sum;
}

float pixel_quality_variance(const struct pixel_quality *q, const struct kernel_taps *tx, const struct kernel_taps *ty)
{
    if (tx->first < 0 || ty->first < 0 || tx->first + tx->count > q->width || ty->first + ty->count > q->height)
        return border_variance(q, tx, ty);
    const float *rows = q->of->variance + (size_t)ty->first * (size_t)q->width + (size_t)tx->first;
    f32x8 sum = {0};
    for (int i = 0; i < tx->count; i += LANES) {
        const f32x8 across = f32x8_load(tx->weight + i);
        f32x8 column = {0};
        const float *row = rows + i;
        for (int j = 0; j < ty->count; j++, row += q->width) column += ty->weight[j] * ty->weight[j] * f32x8_load(row);
        sum += across * across * column;
    }
    return f32x8_sum(sum);
}

float pixel_quality_sharp_variance(const struct pixel_quality *q, int x, int y, f32x8 across, const float *down, int n)
{
    const float *row = q->of->variance + (size_t)y * (size_t)q->width + (size_t)x;
    f32x8 sum = {0};
    for (int j = 0; j < n; j++, row += q->width) sum += down[j] * down[j] * f32x8_load(row);
    sum *= across * across;
    return f32x8_sum(sum);
}
