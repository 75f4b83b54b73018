/* pull_push.c - fills what is unknown in a panorama from what is known around it.
 *
 * Pull-push [Gortler 1996, 5.1]. Pull: a coarser level holds the weighted means of 2 x 2 pixels, its weight the sum of
 * theirs, at most 1. Push: from the coarsest level down, a value v of weight w becomes w v + (1 - w) coarser, the
 * coarser level interpolated bilinearly; columns wrap around. What stands at one place says little of places far from
 * it: from a level up, values become smaller by a factor at each level.
 *
 * What differs from the source: the fading. */
#include "stages/bake_outdoors/pull_push.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"

enum { MAX_LEVELS = 16 };

float *pull_push_pixel(const struct level *l, int x, int y)
{
    return l->v + (size_t)(l->values + 1) * ((size_t)y * (size_t)l->width + (size_t)x);
}

enum status pull_push_init(struct level *l, int width, int height, int values, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height, size = ((size_t)values + 1) * sizeof(float);
    *l = (struct level){width, height, values, calloc(pixels, size)};
    return l->v ? ST_OK : err_nomem(err, "a level of a picture", pixels * size);
}

void pull_push_release(struct level *l)
{
    free(l->v);
    *l = (struct level){0};
}

/* Means of 2 x 2 pixels, times `fade`. */
static void pull(struct level *to, const struct level *from, float fade)
{
    const int n = to->values;
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            float *out = pull_push_pixel(to, x, y);
            for (int k = 0; k < 4; k++) {
                const int sx = 2 * x + (k & 1), sy = 2 * y + (k >> 1);
                if (sx >= from->width || sy >= from->height) continue;
                for (int c = 0; c <= n; c++) out[c] += pull_push_pixel(from, sx, sy)[c];
            }
            const float scale = out[n] > 1 ? 1 / out[n] : 1;
            for (int c = 0; c <= n; c++) out[c] *= c < n ? scale * fade : scale;
        }
}

/* What is missing of a weight of 1 comes from the coarser level, whose weights are 1. */
static void push(struct level *to, const struct level *from)
{
    const int n = to->values;
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            float *out = pull_push_pixel(to, x, y);
            const float missing = 1 - out[n];
            if (!(missing > 0)) continue;
            const float u = ((float)x + 0.5f) / 2 - 0.5f, v = ((float)y + 0.5f) / 2 - 0.5f;
            const int left = (int)floorf(u), top = (int)floorf(v);
            for (int k = 0; k < 4; k++) {
                const float wx = k & 1 ? u - (float)left : 1 - u + (float)left;
                const float wy = k >> 1 ? v - (float)top : 1 - v + (float)top;
                const int sx = (left + (k & 1) + from->width) % from->width;
                const int sy = clamp_int(top + (k >> 1), 0, from->height - 1);
                for (int c = 0; c <= n; c++) out[c] += missing * wx * wy * pull_push_pixel(from, sx, sy)[c];
            }
        }
}

static void normalise_top(struct level *l)
{
    const int n = l->values;
    for (int c = 0; c < n; c++) l->v[c] = l->v[n] > 0 ? l->v[c] / l->v[n] : 0;
    l->v[n] = 1;
}

enum status pull_push(struct level *base, const struct fading *fading, struct err *err)
{
    struct level levels[MAX_LEVELS] = {*base};
    int count = 1;
    for (; !err->status && (levels[count - 1].width > 1 || levels[count - 1].height > 1); count++) {
        const struct level *fine = &levels[count - 1];
        if (!pull_push_init(&levels[count], (fine->width + 1) / 2, (fine->height + 1) / 2, base->values, err))
            pull(&levels[count], fine, count < fading->first ? 1 : fading->factor);
    }
    if (!err->status) normalise_top(&levels[count - 1]);
    for (int k = count - 2; !err->status && k >= 0; k--) push(&levels[k], &levels[k + 1]);
    for (int k = 1; k < count; k++) pull_push_release(&levels[k]);
    return err->status;
}
