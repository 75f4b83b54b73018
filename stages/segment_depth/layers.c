/* layers.c - opaque interiors, and a two-colour matte at depth edges.
 *
 * A pixel within two pixels of a segment that lies at a clearly different depth may hold light of both. The two
 * colours are means over nearby pixels of either side that are out of reach of any jump; alpha is the projection on
 * the line between them, in linear light, where mixing happens. The pixel is split only when it lies near that line and the
 * colours differ; what the two-colour model leaves over is shared out by alpha, so that the sum stays the photo.
 * Alpha is a multiple of 1/1024, which half floats hold exactly, and so does 1 - alpha. */
#include "stages/segment_depth/layers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define REACH          2     /* px: how far light spreads over a jump */
#define COLLECT        6     /* px: half width of the window of the two means */
#define LEAST_COLOURS  4     /* pixels a mean needs */
#define LEAST_CONTRAST 0.08f /* of the means' gamma-encoded distance */
#define OFF_LINE       0.35f /* distance from the line, in lengths of the line, up to which a pixel is a mixture */

struct layers {
    struct layered_depth *out;
    const struct segmentation *s;
    const struct plane *planes;
    const struct image *photo;
    double jump;
    uint8_t *near_jump; /* w * h: 1 within REACH of a pixel of the other side of a jump */
};

static double depth_at(const struct layers *l, int label, int x, int y)
{
    return plane_at(l->planes[label], x + 0.5, y + 0.5);
}

/* Segment of the nearest pixel within REACH beyond a jump as seen from (x, y); -1: none. */
static int beyond_jump(const struct layers *l, int x, int y)
{
    int own = l->s->label[y * l->s->width + x], found = -1, nearest = REACH * REACH + 1;
    double here = depth_at(l, own, x, y);
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++) {
            int nx = x + i, ny = y + j, d2 = i * i + j * j;
            if (d2 >= nearest || nx < 0 || ny < 0 || nx >= l->s->width || ny >= l->s->height) continue;
            int other = l->s->label[ny * l->s->width + nx];
            if (other < 0 || other == own || !(fabs(depth_at(l, other, x, y) - here) > l->jump)) continue;
            nearest = d2;
            found = other;
        }
    return found;
}

static void mark_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct layers *l = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < l->s->width; x++) {
            size_t i = (size_t)y * (size_t)l->s->width + (size_t)x;
            l->near_jump[i] = l->s->label[i] >= 0 && beyond_jump(l, x, y) >= 0;
        }
}

/* Mean colour around (x, y) of pixels at the depth of `label` there, out of reach of jumps. */
static bool side_colour(const struct layers *l, int x, int y, int label, float mean[3])
{
    double depth = depth_at(l, label, x, y);
    float sum[3] = {0}, total = 0;
    int count = 0;
    for (int j = -COLLECT; j <= COLLECT; j++)
        for (int i = -COLLECT; i <= COLLECT; i++) {
            int nx = x + i, ny = y + j;
            if (nx < 0 || ny < 0 || nx >= l->s->width || ny >= l->s->height) continue;
            size_t at = (size_t)ny * (size_t)l->s->width + (size_t)nx;
            int other = l->s->label[at];
            if (other < 0 || l->near_jump[at] || !(fabs(depth_at(l, other, nx, ny) - depth) <= l->jump)) continue;
            float w = 1 / (1 + (float)(i * i + j * j));
            for (int c = 0; c < 3; c++) sum[c] += w * l->photo->data[4 * at + (size_t)c];
            total += w;
            count++;
        }
    if (count < LEAST_COLOURS) return false;
    for (int c = 0; c < 3; c++) mean[c] = sum[c] / total;
    return true;
}

/* Part of the pixel that is the first colour's, 0 .. 1; 1 if it is no mixture of the two. */
static float matte_alpha(const float pixel[3], const float first[3], const float second[3])
{
    float along = 0, length2 = 0, off2 = 0, contrast2 = 0;
    for (int c = 0; c < 3; c++) {
        float d = first[c] - second[c], g = sqrtf(fmaxf(first[c], 0)) - sqrtf(fmaxf(second[c], 0));
        along += (pixel[c] - second[c]) * d;
        length2 += d * d;
        contrast2 += g * g;
    }
    if (!(contrast2 > LEAST_CONTRAST * LEAST_CONTRAST) || !(length2 > 0)) return 1;
    float alpha = fminf(fmaxf(along / length2, 0), 1);
    for (int c = 0; c < 3; c++) {
        float e = pixel[c] - (second[c] + alpha * (first[c] - second[c]));
        off2 += e * e;
    }
    return off2 <= OFF_LINE * OFF_LINE * length2 ? rintf(alpha * 1024) / 1024 : 1;
}

static void put(struct layer *layer, size_t i, const float rgb[3], float alpha, double inverse_z, int label)
{
    for (int c = 0; c < 3; c++) layer->rgba[4 * i + (size_t)c] = rgb[c];
    layer->rgba[4 * i + 3] = alpha;
    layer->z[i] = (float)(1 / inverse_z);
    layer->id[i] = (uint32_t)label + 1;
}

static void split_pixel(const struct layers *l, int x, int y)
{
    size_t i = (size_t)y * (size_t)l->s->width + (size_t)x;
    const float *pixel = l->photo->data + 4 * i;
    int own = l->s->label[i], other = -1;
    float mine[3], theirs[3], alpha = 1;
    if (own < 0) return;
    if (l->near_jump[i]) {
        other = beyond_jump(l, x, y);
        if (side_colour(l, x, y, own, mine) && side_colour(l, x, y, other, theirs))
            alpha = matte_alpha(pixel, mine, theirs);
    }
    /* nearly one colour is one colour: of the other side, if the border was drawn a little off */
    if (alpha < 0.06f) {
        put(&l->out->interior, i, pixel, 1, depth_at(l, other, x, y), other);
    } else if (alpha > 0.94f) {
        put(&l->out->interior, i, pixel, 1, depth_at(l, own, x, y), own);
    } else {
        float first[3], second[3];
        for (int c = 0; c < 3; c++) {
            float left = pixel[c] - (alpha * mine[c] + (1 - alpha) * theirs[c]);
            first[c] = fminf(fmaxf(alpha * (mine[c] + left), 0), fmaxf(pixel[c], 0));
            second[c] = pixel[c] - first[c];
        }
        put(&l->out->interior, i, first, alpha, depth_at(l, own, x, y), own);
        put(&l->out->boundary, i, second, 1 - alpha, depth_at(l, other, x, y), other);
    }
}

static void split_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct layers *l = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < l->s->width; x++) split_pixel(l, x, y);
}

enum status layers_make(struct layered_depth *out, const struct segmentation *s, const struct plane *planes,
                        const struct image *linear_rgba, double step, bool matte, struct err *err)
{
    size_t pixels = (size_t)s->width * (size_t)s->height;
    struct layers l = {out, s, planes, linear_rgba, 2 * step, calloc(pixels, 1)};
    if (!l.near_jump) return err_nomem(err, "a mask of depth edges", pixels);
    if (matte) parallel_for((size_t)s->height, 16, mark_rows, &l);
    parallel_for((size_t)s->height, 16, split_rows, &l);
    for (size_t i = 0; i < pixels; i++)
        if (out->interior.id[i]) out->segments[out->interior.id[i] - 1].pixels++;
    free(l.near_jump);
    return ST_OK;
}
