/* hole_bounds.c - see hole_bounds.h.
 *
 * Overview. Texture is copied as differences, and where it is copied from light may slope: across a large hole the
 * slope adds up, to black under a bed whose floor is seen on one side alone. A rim that holds a strip of furniture does
 * the same nearby. The colours around the nearest clean place bound what can be there: shares of RARE at both ends of
 * each channel are left out, since dirt and noise lie there. */
#include "common/texture/hole_bounds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

enum { BINS = 256 };
static const double RARE = 0.02, RANGE = 2; /* display units: black is 0, white is 1 */
static const float SPARE = 0.02f;           /* display units: beyond the bounds is allowed */

struct bounds {
    float low[3], high[3];
};

struct bounds_list {
    int32_t *number; /* of the bounds of a clean texel; -1: not found yet */
    struct bounds *bounds;
    size_t count;
};

static int bin_of(float value)
{
    const double bin = (double)value / RANGE * BINS;
    return bin > 0 ? bin < BINS ? (int)bin : BINS - 1 : 0;
}

static float value_of(int bin) { return (float)(bin * RANGE / BINS); }

static struct bounds bounds_around(const struct synthesis_picture *p, int32_t at, int reach)
{
    const int x = at % p->width, y = at / p->width;
    const int x0 = x > reach ? x - reach : 0, x1 = x + reach < p->width ? x + reach : p->width - 1;
    int counts[3][BINS], all = 0;
    struct bounds b;
    memset(counts, 0, sizeof counts);
    for (int v = y > reach ? y - reach : 0; v <= y + reach && v < p->height; v++)
        for (int u = x0; u <= x1; u++) {
            const size_t i = (size_t)v * (size_t)p->width + (size_t)u;
            if (!p->clean[i]) continue;
            for (size_t k = 0; k < 3; k++) counts[k][bin_of(p->value[3 * i + k])]++;
            all++;
        }
    for (int k = 0; k < 3; k++) {
        int low = 0, high = BINS - 1;
        for (int n = counts[k][low]; n <= RARE * all && low < BINS - 1;) n += counts[k][++low];
        for (int n = counts[k][high]; n <= RARE * all && high > 0;) n += counts[k][--high];
        b.low[k] = value_of(low) - SPARE;
        b.high[k] = value_of(high + 1) + SPARE;
    }
    return b;
}

static bool limit_texel(float limit[3], const float value[3], const struct bounds *b)
{
    float within[3];
    bool beyond = false;
    for (int k = 0; k < 3; k++) {
        within[k] = fminf(fmaxf(value[k], b->low[k]), b->high[k]);
        beyond = beyond || within[k] != value[k];
    }
    if (beyond) memcpy(limit, within, sizeof within);
    return beyond;
}

/* The bounds around a clean texel, found once each; NULL: no memory is left. */
static const struct bounds *bounds_of(struct bounds_list *l, const struct synthesis_picture *p, int32_t at, int reach,
                                      struct err *err)
{
    if (l->number[at] < 0) {
        if (array_append(&l->bounds, l->count, sizeof *l->bounds, "the bounds of holes", err)) return NULL;
        l->number[at] = (int32_t)l->count;
        l->bounds[l->count++] = bounds_around(p, at, reach);
    }
    return &l->bounds[l->number[at]];
}

enum status hole_bounds_find(float *limit, uint8_t *beyond, bool *any, const struct synthesis_picture *picture,
                             const int32_t *nearest, int reach, struct err *err)
{
    const size_t texels = (size_t)picture->width * (size_t)picture->height;
    struct bounds_list list = {.number = malloc((texels + 1) * sizeof *list.number)};
    *any = false;
    memset(beyond, 0, texels);
    if (!list.number) return err_nomem(err, "the bounds of holes", texels * sizeof *list.number);
    for (size_t i = 0; i < texels; i++) list.number[i] = -1;
    for (size_t i = 0; i < texels; i++) {
        if (!picture->unseen[i] || nearest[i] < 0) continue;
        const struct bounds *b = bounds_of(&list, picture, nearest[i], reach, err);
        if (!b) break;
        beyond[i] = limit_texel(limit + 3 * i, picture->value + 3 * i, b);
        *any = *any || beyond[i];
    }
    free(list.bounds);
    free(list.number);
    return err->status;
}
