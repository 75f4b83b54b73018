/* composite.c - bake_composite(): joins the chosen candidates in the gradient domain [Perez 2003; Bhat 2010;
 * Colburn 2014, 4.5.2], and fills what no view shows.
 *
 * The unknowns are the texels in display units (bake.h), for which a gain of light is nearly a shift. Original texels are
 * fixed. A warped texel is drawn weakly to its colour in the best view. Each pair of neighbours takes the difference that
 * the best view of either has between them, if that view shows both; a difference above max_gradient, an edge that may
 * not be where the neighbour's source has it, counts little. Where no view shows both, the difference is to be 0.
 * A texel that no view shows is drawn weakly to the nearest texel of its tile that some view shows: a face's mean would
 * mix its materials. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/gradient_solve.h"
#include "common/texture/bake.h"

static const float WEAK = 1e-5f;        /* weight of data, and of outlying differences */
static const double DEFAULT_GREY = 0.5; /* of white */

struct composite { /* of a tile; all per texel */
    const struct bake *b;
    const struct bake_tile *t;
    uint8_t *role;
    float *data, *data_weight, *value;
    float *gradient[2], *weight[2]; /* to the right, below */
    int32_t *nearest, *queue;       /* the nearest seen texel */
};

static size_t texels_of(const struct bake_tile *t) { return (size_t)t->raster.width * (size_t)t->raster.height; }

/* The candidates of a texel; NULL if there are none. The first is the best. */
static const struct candidate *candidates_at(const struct bake *b, size_t texel, int *count)
{
    *count = b->list[texel] < 0 ? 0 : b->counts[b->list[texel]];
    return *count ? b->lists[b->list[texel]] : NULL;
}

static void display_of(float out[3], const struct bake *b, const struct candidate *c)
{
    for (int k = 0; k < 3; k++) out[k] = bake_display(c->rgb[k] * b->sources[c->source].gain[k], b->white);
}

/* Whether a texel is warped: wanted, and some view shows it. */
static bool is_warped(const struct bake *b, size_t texel)
{
    return b->role[texel] == TEXEL_WANTED && b->list[texel] >= 0 && b->counts[b->list[texel]] > 0;
}

/* Adds the difference that `source` has between texels p and q to the pair's constraint. */
static bool add_difference(struct composite *c, int side, size_t at, size_t p, size_t q, int source)
{
    const struct candidate *ends[2] = {NULL, NULL};
    float shown[2][3], difference[3], largest = 0;
    for (int k = 0; k < 2; k++) {
        int count;
        const struct candidate *list = candidates_at(c->b, k ? q : p, &count);
        for (int i = 0; i < count && !ends[k]; i++)
            if (list[i].source == source) ends[k] = &list[i];
        if (!ends[k]) return false;
        display_of(shown[k], c->b, ends[k]);
    }
    for (int k = 0; k < 3; k++) {
        difference[k] = shown[1][k] - shown[0][k];
        largest = fmaxf(largest, fabsf(difference[k]));
    }
    const float weight = largest > (float)c->b->params->max_gradient ? WEAK : 1;
    float *g = c->gradient[side] + 3 * at, *w = c->weight[side] + at;
    for (int k = 0; k < 3; k++) g[k] = (*w * g[k] + weight * difference[k]) / (*w + weight);
    *w += weight;
    return true;
}

/* The pair of a texel and its neighbour to the right or below. */
static void set_pair(struct composite *c, int side, size_t at, size_t next)
{
    const struct bake *b = c->b;
    const size_t p = c->t->first + at, q = c->t->first + next;
    if (c->role[at] == GRADIENT_OUT || c->role[next] == GRADIENT_OUT) return;
    if (c->role[at] == GRADIENT_FIXED && c->role[next] == GRADIENT_FIXED) return;
    const int best[2] = {is_warped(b, p) ? b->lists[b->list[p]][0].source : -1,
                         is_warped(b, q) ? b->lists[b->list[q]][0].source : -1};
    bool known = best[0] >= 0 && add_difference(c, side, at, p, q, best[0]);
    if (best[1] >= 0 && best[1] != best[0] && add_difference(c, side, at, p, q, best[1])) known = true;
    if (!known) c->weight[side][at] = 1;
}

/* nearest[i]: the seen texel that is fewest steps away, by a search from all of them at once; -1: the tile has none. */
static void find_nearest(struct composite *c)
{
    const int width = c->t->raster.width, height = c->t->raster.height;
    size_t head = 0, tail = 0;
    for (size_t i = 0; i < texels_of(c->t); i++) {
        const bool seen =
            c->role[i] == GRADIENT_FIXED || (c->role[i] == GRADIENT_FREE && is_warped(c->b, c->t->first + i));
        c->nearest[i] = seen ? (int32_t)i : -1;
        if (seen) c->queue[tail++] = (int32_t)i;
    }
    while (head < tail) {
        const int32_t at = c->queue[head++];
        const int x = at % width, y = at / width;
        const int32_t around[4] = {x > 0 ? at - 1 : -1, x + 1 < width ? at + 1 : -1, y > 0 ? at - width : -1,
                                   y + 1 < height ? at + width : -1};
        for (int k = 0; k < 4; k++) {
            if (around[k] < 0 || c->nearest[around[k]] >= 0) continue;
            c->nearest[around[k]] = c->nearest[at];
            c->queue[tail++] = around[k];
        }
    }
}

/* Roles, fixed values, and what draws free texels. */
static void set_texels(struct composite *c)
{
    const struct bake *b = c->b;
    for (size_t i = 0; i < texels_of(c->t); i++) {
        const size_t texel = c->t->first + i;
        c->role[i] = b->role[texel] == TEXEL_NONE       ? GRADIENT_OUT
                     : b->role[texel] == TEXEL_ORIGINAL ? GRADIENT_FIXED
                                                        : GRADIENT_FREE;
        if (c->role[i] == GRADIENT_FIXED)
            for (int k = 0; k < 3; k++)
                c->value[3 * i + (size_t)k] = bake_display(b->rgb[3 * texel + (size_t)k], b->white);
        if (c->role[i] != GRADIENT_FREE || !is_warped(b, texel)) continue;
        display_of(c->value + 3 * i, b, &b->lists[b->list[texel]][0]);
    }
    find_nearest(c);
    for (size_t i = 0; i < texels_of(c->t); i++) {
        if (c->role[i] != GRADIENT_FREE) continue;
        float *value = c->value + 3 * i;
        if (c->nearest[i] >= 0)
            memcpy(value, c->value + 3 * (size_t)c->nearest[i], 3 * sizeof *value);
        else
            for (int k = 0; k < 3; k++) value[k] = bake_display((float)(DEFAULT_GREY * b->white), b->white);
        memcpy(c->data + 3 * i, value, 3 * sizeof *value);
        c->data_weight[i] = WEAK;
    }
}

static void set_pairs(struct composite *c)
{
    const int width = c->t->raster.width, height = c->t->raster.height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t at = (size_t)y * (size_t)width + (size_t)x;
            if (x + 1 < width) set_pair(c, 0, at, at + 1);
            if (y + 1 < height) set_pair(c, 1, at, at + (size_t)width);
        }
}

/* The result, and how each texel was made. */
static void take_texels(struct bake *b, const struct composite *c, struct bake_totals *totals)
{
    for (size_t i = 0; i < texels_of(c->t); i++) {
        const size_t texel = c->t->first + i;
        if (c->role[i] == GRADIENT_OUT) continue;
        totals->texels++;
        if (c->role[i] == GRADIENT_FIXED) {
            totals->original++; /* made[] has the view already */
            continue;
        }
        for (int k = 0; k < 3; k++)
            b->rgb[3 * texel + (size_t)k] = bake_radiance(c->value[3 * i + (size_t)k], b->white);
        if (is_warped(b, texel)) {
            b->made[texel] = (uint32_t)ATLAS_VIEWS + b->lists[b->list[texel]][0].source;
            totals->warped++;
        } else if (c->nearest[i] >= 0) {
            b->made[texel] = ATLAS_SYNTHESISED;
            totals->synthesised++;
        } else {
            b->made[texel] = ATLAS_DEFAULT;
            totals->by_default++;
        }
    }
}

static enum status composite_tile(struct bake *b, const struct bake_tile *t, struct bake_totals *totals,
                                  struct err *err)
{
    enum { FLOATS = 3 + 1 + 3 + 2 * (3 + 1) };
    const size_t n = texels_of(t);
    float *memory = calloc(n, FLOATS * sizeof *memory);
    int32_t *indices = malloc(2 * n * sizeof *indices);
    struct composite c = {.b = b, .t = t, .role = malloc(n), .nearest = indices, .queue = indices + n};
    struct gradient_report report = {0};
    enum status st = memory && indices && c.role ? ST_OK : err_nomem(err, "a tile", n * FLOATS * sizeof *memory);
    if (!st) {
        c.data = memory, c.value = memory + 3 * n, c.data_weight = memory + 6 * n;
        c.gradient[0] = memory + 7 * n, c.gradient[1] = memory + 10 * n;
        c.weight[0] = memory + 13 * n, c.weight[1] = memory + 14 * n;
        set_texels(&c);
        set_pairs(&c);
        const struct gradient_problem problem = {t->raster.width, t->raster.height, c.role,        c.data_weight,
                                                 c.data,          c.weight[0],      c.gradient[0], c.weight[1],
                                                 c.gradient[1],   c.value};
        st = gradient_solve(&problem, &report, err);
    }
    if (!st) {
        totals->residual = fmax(totals->residual, report.residual);
        take_texels(b, &c, totals);
    }
    free(memory);
    free(indices);
    free(c.role);
    return st;
}

enum status bake_composite(struct bake *b, struct bake_totals *totals, struct err *err)
{
    enum status st = ST_OK;
    *totals = (struct bake_totals){0};
    for (int i = 0; !st && i < b->tile_count; i++) st = composite_tile(b, &b->tiles[i], totals, err);
    return st;
}
