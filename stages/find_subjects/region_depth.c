/* region_depth.c - weighted median of the depths in a rectangle. */
#include "stages/find_subjects/region_depth.h"

#include <stdlib.h>

#include "common/math/weighted.h"

/* Pixels [*first, *end) whose centres lie in [low, high]; if there are none, the pixel at the middle. */
static void pixel_range(double low, double high, int size, int *first, int *end)
{
    *first = (int)ceil(low - 0.5);
    *end = (int)floor(high - 0.5) + 1;
    if (*end <= *first) *end = (*first = (int)((low + high) / 2)) + 1;
    if (*first < 0) *first = 0;
    if (*end > size) *end = size;
}

static size_t add_sample(struct weighted *samples, size_t count, const struct layered_depth *d, const struct layer *l,
                         size_t pixel)
{
    const uint32_t id = l->id[pixel];
    const float z = l->z[pixel], alpha = l->rgba[4 * pixel + 3];
    if (!id || !(z > 0) || !(alpha > 0)) return count;
    samples[count] = (struct weighted){z, alpha * (float)fmax(d->segments[id - 1].confidence, DEPTH_INHERITED)};
    return count + 1;
}

enum status region_depth(double *depth, const struct layered_depth *d, const struct subject *s, struct err *err)
{
    int left, right, top, bottom;
    *depth = 0;
    pixel_range(s->x0, s->x1, d->width, &left, &right);
    pixel_range(s->y0, s->y1, d->height, &top, &bottom);
    if (right <= left || bottom <= top) return ST_OK;
    const size_t max_samples = 2 * (size_t)(right - left) * (size_t)(bottom - top);
    struct weighted *samples = malloc(max_samples * sizeof *samples);
    if (!samples) return err_nomem(err, "the depths in a rectangle", max_samples * sizeof *samples);
    size_t count = 0;
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) {
            const size_t pixel = (size_t)y * (size_t)d->width + (size_t)x;
            count = add_sample(samples, count, d, &d->interior, pixel);
            count = add_sample(samples, count, d, &d->boundary, pixel);
        }
    *depth = weighted_percentile(samples, count, 0.5);
    free(samples);
    return ST_OK;
}
