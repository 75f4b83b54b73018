/* layers.c - opaque interiors, and a two-colour matte at depth edges [Colburn 2014, 3.5] [Zitnick 2007].
 *
 * A pixel within MIX_RADIUS of a segment at a different depth may mix light of both: c = alpha f + (1 - alpha) b. The
 * colours f and b are means over nearby pixels of the two surfaces that are farther than MIX_RADIUS from any depth
 * edge; alpha is the projection of the pixel onto the line between them, in linear light, where mixing happens. A pixel
 * is split only if it lies near that line and the colours differ. Its residual is distributed by alpha, so that the two
 * layers sum to the photo. Alpha is a multiple of 1/1024, so that half floats hold alpha and 1 - alpha exactly.
 *
 * What differs from the sources: the matte is computed after the depth, only at depth edges, and from local means in
 * place of the segments' colours. */
#include "stages/segment_depth/layers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define MIX_RADIUS   2     /* px: distance to a depth edge at which pixels may be mixed */
#define MEAN_RADIUS  6     /* px: half width of the window of the two means */
#define MIN_PIXELS   4     /* in a mean */
#define MIN_CONTRAST 0.08f /* of the two means, in gamma-encoded values */
#define MAX_OFF_LINE 0.35f /* distance of a mixed pixel from the line, relative to the line's length */

struct layers {
    struct layered_depth *out;
    const int *label;
    int width, height;
    const struct plane *planes;
    const struct image *photo;
    double jump;
    uint8_t *near_jump; /* w * h: 1 within MIX_RADIUS of a depth edge */
};

static double depth_at(const struct layers *l, int label, int x, int y)
{
    return plane_at(l->planes[label], x + 0.5, y + 0.5);
}

/* The segment of the nearest pixel within MIX_RADIUS of (x, y) that lies at another depth; -1 if there is none. */
static int beyond_jump(const struct layers *l, int x, int y)
{
    int own = l->label[y * l->width + x], found = -1, nearest = MIX_RADIUS * MIX_RADIUS + 1;
    double here = depth_at(l, own, x, y);
    for (int j = -MIX_RADIUS; j <= MIX_RADIUS; j++)
        for (int i = -MIX_RADIUS; i <= MIX_RADIUS; i++) {
            int nx = x + i, ny = y + j, d2 = i * i + j * j;
            if (d2 >= nearest || nx < 0 || ny < 0 || nx >= l->width || ny >= l->height) continue;
            int other = l->label[ny * l->width + nx];
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
        for (int x = 0; x < l->width; x++) {
            size_t i = (size_t)y * (size_t)l->width + (size_t)x;
            l->near_jump[i] = l->label[i] >= 0 && beyond_jump(l, x, y) >= 0;
        }
}

/* Mean colour of the pixels around (x, y) that lie at the depth of segment `label` and not near a depth edge. False if
 * there are too few. */
static bool mean_colour(const struct layers *l, int x, int y, int label, float mean[3])
{
    double depth = depth_at(l, label, x, y);
    float sum[3] = {0}, total = 0;
    int count = 0;
    for (int j = -MEAN_RADIUS; j <= MEAN_RADIUS; j++)
        for (int i = -MEAN_RADIUS; i <= MEAN_RADIUS; i++) {
            int nx = x + i, ny = y + j;
            if (nx < 0 || ny < 0 || nx >= l->width || ny >= l->height) continue;
            size_t at = (size_t)ny * (size_t)l->width + (size_t)nx;
            int other = l->label[at];
            if (other < 0 || l->near_jump[at] || !(fabs(depth_at(l, other, nx, ny) - depth) <= l->jump)) continue;
            float w = 1 / (1 + (float)(i * i + j * j));
            for (int c = 0; c < 3; c++) sum[c] += w * l->photo->data[4 * at + (size_t)c];
            total += w;
            count++;
        }
    if (count < MIN_PIXELS) return false;
    for (int c = 0; c < 3; c++) mean[c] = sum[c] / total;
    return true;
}

/* The first colour's share of the pixel, 0 .. 1; 1 if the pixel is not a mixture of the two. */
static float matte_alpha(const float pixel[3], const float first[3], const float second[3])
{
    float along = 0, length2 = 0, off2 = 0, contrast2 = 0;
    for (int c = 0; c < 3; c++) {
        float d = first[c] - second[c], g = sqrtf(fmaxf(first[c], 0)) - sqrtf(fmaxf(second[c], 0));
        along += (pixel[c] - second[c]) * d;
        length2 += d * d;
        contrast2 += g * g;
    }
    if (!(contrast2 > MIN_CONTRAST * MIN_CONTRAST) || !(length2 > 0)) return 1;
    float alpha = fminf(fmaxf(along / length2, 0), 1);
    for (int c = 0; c < 3; c++) {
        float e = pixel[c] - (second[c] + alpha * (first[c] - second[c]));
        off2 += e * e;
    }
    return off2 <= MAX_OFF_LINE * MAX_OFF_LINE * length2 ? rintf(alpha * 1024) / 1024 : 1;
}

static void put_pixel(struct layer *layer, size_t i, const float rgb[3], float alpha, double inverse_z, int label)
{
    for (int c = 0; c < 3; c++) layer->rgba[4 * i + (size_t)c] = rgb[c];
    layer->rgba[4 * i + 3] = alpha;
    layer->z[i] = (float)(1 / inverse_z);
    layer->id[i] = (uint32_t)label + 1;
}

static void split_pixel(const struct layers *l, int x, int y)
{
    size_t i = (size_t)y * (size_t)l->width + (size_t)x;
    const float *pixel = l->photo->data + 4 * i;
    int own = l->label[i], other = -1;
    float own_mean[3], other_mean[3], alpha = 1;
    if (own < 0) return;
    if (l->near_jump[i]) {
        other = beyond_jump(l, x, y);
        if (mean_colour(l, x, y, own, own_mean) && mean_colour(l, x, y, other, other_mean))
            alpha = matte_alpha(pixel, own_mean, other_mean);
    }
    /* an alpha close to 0 or 1 is not split; close to 0, the segments' border lies on the wrong side of the pixel */
    if (alpha < 0.06f) {
        put_pixel(&l->out->interior, i, pixel, 1, depth_at(l, other, x, y), other);
    } else if (alpha > 0.94f) {
        put_pixel(&l->out->interior, i, pixel, 1, depth_at(l, own, x, y), own);
    } else {
        float first[3], second[3];
        for (int c = 0; c < 3; c++) {
            float residual = pixel[c] - (alpha * own_mean[c] + (1 - alpha) * other_mean[c]);
            first[c] = fminf(fmaxf(alpha * (own_mean[c] + residual), 0), fmaxf(pixel[c], 0));
            second[c] = pixel[c] - first[c];
        }
        put_pixel(&l->out->interior, i, first, alpha, depth_at(l, own, x, y), own);
        put_pixel(&l->out->boundary, i, second, 1 - alpha, depth_at(l, other, x, y), other);
    }
}

static void split_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct layers *l = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < l->width; x++) split_pixel(l, x, y);
}

enum status layers_make(struct layered_depth *out, const int *label, const struct plane *planes,
                        const struct image *linear_rgba, double step, bool matte, struct err *err)
{
    size_t pixels = (size_t)out->width * (size_t)out->height;
    struct layers l = {out, label, out->width, out->height, planes, linear_rgba, 2 * step, calloc(pixels, 1)};
    if (!l.near_jump) return err_nomem(err, "a mask of depth edges", pixels);
    if (matte) parallel_for((size_t)out->height, 16, mark_rows, &l);
    parallel_for((size_t)out->height, 16, split_rows, &l);
    for (size_t i = 0; i < pixels; i++)
        if (out->interior.id[i]) out->segments[out->interior.id[i] - 1].pixels++;
    free(l.near_jump);
    return ST_OK;
}
