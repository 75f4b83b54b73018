/* bake_composite.c - bake_composite(): joins the chosen candidates in the gradient domain [Perez 2003; Bhat 2010;
 * Colburn 2014, 4.5.2], and fills what no view shows.
 *
 * The unknowns are the texels in display units (bake.h), for which a gain of light is nearly a shift. Original
 * texels are fixed. A warped texel is drawn weakly to its colour in the best view; ten times as much in an atlas
 * without a viewpoint, which no original texel holds: furniture that leaves a rim on a wall would draw all of a dark
 * corner away from its colours, and gathers of light take these for its light. Each pair of neighbours takes the
 * difference that the best view of either has between them, if that view shows both; a difference above max_gradient,
 * an edge that may not be where the neighbour's source has it, counts little. Where no view shows both, the difference
 * is to be 0. Texels that no view shows are found afterwards, with the others fixed, so that a fill never moves what
 * is seen. They take the differences of texture elsewhere on the face, or of an atlas that has it already (fill.h), or
 * 0 where there is none. They are drawn weakly to that atlas, else to the nearest seen texel that is not beside what
 * hides the face: a face's mean would mix its materials. Where the atlas is brighter than what came of it they are
 * drawn to it more, so that a viewpoint whose rim lies in a thing's shadow has no darker hole than  others. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/gradient_solve.h"
#include "common/texture/bake.h"
#include "common/texture/fill.h"
#include "common/texture/filled_atlas.h"
#include "common/texture/hole_bounds.h"
#include "common/texture/hole_pieces.h"

static const float WEAK = 1e-5f;   /* weight of data, and of outlying differences */
static const float HELD = 1e-4f;   /* weight of data without a viewpoint: its colours are light, within 100 texels */
static const float SLACK = 1e-7f;  /* weight of pairs of a hole until what is seen is solved: they bend nothing */
static const float GUIDED = 5e-3f; /* weight of the filled atlas: a hole's rim tells less beyond 14 texels */
static const double DEFAULT_GREY = 0.5; /* of white */
enum { REACH = 12, FURNITURE = 24 };    /* texels: of the clean ones that an unseen one continues; behind furniture */
enum { MIN_SEEN = 8 };                  /* of these */
enum { ALIKE = 8 };                     /* neighbours are alike: this many count as one */
enum { SIDE = 6 };                      /* texels beside a hole in which only views of sure depth count */
enum { RIM = 3 };                       /* texels beside unseen ones, which may hold the shadow of what hides them */

/* How far a viewpoint is above the filled atlas. */
struct level {
    float above[3];
    bool known;
};

struct composite { /* of a tile; all per texel */
    struct bake *b;
    const struct bake_tile *t;
    uint8_t *role;
    float *data, *data_weight, *value;
    float *gradient[2], *weight[2]; /* to the right, below */
    int32_t *nearest, *queue;       /* the nearest seen texel */
    uint8_t *unseen, *clean;        /* no view shows the texel; some does, and it is not within RIM of an unseen one */
    uint8_t *beyond;                /* it was filled beyond the colours around the hole */
    struct texture_fill fill;
    const struct level *level;
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

/* The difference of a pair that no view shows, from the texture that is copied to its ends. */
static void take_fill(struct composite *c, int side, size_t at, size_t next)
{
    float forward[3], back[3];
    const bool a = texture_fill_difference(forward, &c->fill, at, next);
    const bool b = texture_fill_difference(back, &c->fill, next, at);
    float *g = c->gradient[side] + 3 * at;
    for (int k = 0; k < 3; k++) g[k] = a && b ? 0.5f * (forward[k] - back[k]) : a ? forward[k] : b ? -back[k] : 0;
}

/* How far seen texels are above the texture that is copied to a hole; per colour. */
struct excess {
    double mean[3], variance[3]; /* variance: of the mean */
};

/* The excess of the seen texels around `at`, of clean ones or of others; false: there are fewer than MIN_SEEN. */
static bool excess_around(struct excess *e, const struct composite *c, size_t hole, size_t at, int reach, bool clean)
{
    const int width = c->t->raster.width, height = c->t->raster.height;
    const int x = (int)(at % (size_t)width), y = (int)(at / (size_t)width);
    double sum[3] = {0}, squares[3] = {0};
    int count = 0;
    for (int v = y > reach ? y - reach : 0; v <= y + reach && v < height; v++)
        for (int u = x > reach ? x - reach : 0; u <= x + reach && u < width; u++) {
            const size_t i = (size_t)v * (size_t)width + (size_t)u;
            float copy[3];
            if (c->role[i] != GRADIENT_FIXED || (c->clean[i] != 0) != clean) continue;
            if (!texture_fill_copy(copy, &c->fill, hole, i)) continue;
            for (size_t k = 0; k < 3; k++) {
                const double d = (double)(c->value[3 * i + k] - copy[k]);
                sum[k] += d;
                squares[k] += d * d;
            }
            count++;
        }
    for (int k = 0; k < 3 && count >= MIN_SEEN; k++) {
        e->mean[k] = sum[k] / count;
        e->variance[k] = fmax(0, squares[k] / count - e->mean[k] * e->mean[k]) * ALIKE / count;
    }
    return count >= MIN_SEEN;
}

/* Lets an unseen texel beside a seen one continue the clean texels behind that. Of a hole that an edit walls up the rim
 * may hold the reveal of a window that the model puts a little elsewhere; of one behind furniture it holds the deepest
 * part of its shadow. Only what the rim surely has above the clean texels, or below them, is left out. */
static void leave_rim(struct composite *c, int side, size_t at, size_t next)
{
    const size_t hole = c->unseen[at] ? at : next, rim = c->unseen[at] ? next : at;
    const int32_t list = c->b->list[c->t->first + hole];
    struct excess clean, soiled;
    const int reach = list >= 0 && c->b->hidden[list] ? FURNITURE : REACH;
    if (c->unseen[at] == c->unseen[next] || c->role[rim] != GRADIENT_FIXED || c->clean[rim]) return;
    if (!excess_around(&clean, c, hole, rim, reach, true) || !excess_around(&soiled, c, hole, rim, RIM, false)) return;
    const double sign = c->unseen[at] ? -1 : 1;
    for (size_t k = 0; k < 3; k++) {
        const double above = clean.mean[k] - soiled.mean[k], doubt = 4 * (clean.variance[k] + soiled.variance[k]);
        if (above * above > doubt)
            c->gradient[side][3 * at + k] += (float)(sign * above * (1 - doubt / (above * above)));
    }
}

/* Whether one of a pair is in a hole behind furniture, and the other does not hold the hole's colours. */
static bool is_loose(const struct composite *c, size_t at, size_t next)
{
    if (!c->fill.loose || c->unseen[at] == c->unseen[next]) return false;
    const int32_t list = c->b->list[c->t->first + (c->unseen[at] ? at : next)];
    return list >= 0 && c->b->hidden[list] && c->fill.loose[c->unseen[at] ? next : at];
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
    if (!known) c->weight[side][at] = (c->unseen[at] || c->unseen[next]) && !c->fill.value ? SLACK : 1;
    if (!known && is_loose(c, at, next)) {
        c->weight[side][at] = 0;
        return;
    }
    if (!known && c->fill.value) take_fill(c, side, at, next);
    if (!known && c->fill.value) leave_rim(c, side, at, next);
}

/* nearest[i]: the texel of `from` that is fewest steps away, by a search from all at once; -1: there is none. */
static bool find_nearest(struct composite *c, const uint8_t *from)
{
    const int width = c->t->raster.width, height = c->t->raster.height;
    size_t head = 0, tail = 0;
    for (size_t i = 0; i < texels_of(c->t); i++) {
        c->nearest[i] = from[i] ? (int32_t)i : -1;
        if (from[i]) c->queue[tail++] = (int32_t)i;
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
    return tail > 0;
}

/* Whether something stands before a texel in every view that could show it. */
static bool is_hole(const struct bake *b, size_t texel)
{
    return b->role[texel] == TEXEL_WANTED && !is_warped(b, texel) && b->list[texel] >= 0 && b->hidden[b->list[texel]];
}

/* Leaves a texel only the candidates of sure depth, the best first; without any it is part of the hole. */
static void keep_clean(struct bake *b, size_t list)
{
    struct candidate *in = b->lists[list];
    int kept = 0;
    for (int i = 0; i < b->counts[list]; i++)
        if (in[i].state == SOURCE_CLEAN) in[kept++] = in[i];
    b->counts[list] = (uint8_t)kept;
}

/* Beside what hides the face, a view whose depth is not sure may show the side of that: only the others count there. */
static void widen_holes(struct composite *c)
{
    struct bake *b = c->b;
    const int width = c->t->raster.width, height = c->t->raster.height;
    for (size_t i = 0; i < texels_of(c->t); i++) c->unseen[i] = is_hole(b, c->t->first + i);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t texel = c->t->first + (size_t)y * (size_t)width + (size_t)x;
            if (!is_warped(b, texel) || b->lists[b->list[texel]][0].state == SOURCE_CLEAN) continue;
            bool near = false;
            for (int v = y > SIDE ? y - SIDE : 0; v <= y + SIDE && v < height && !near; v++) {
                const int from = x > SIDE ? x - SIDE : 0, to = x + SIDE < width ? x + SIDE : width - 1;
                near = memchr(c->unseen + (size_t)v * (size_t)width + (size_t)from, 1, (size_t)(to - from + 1));
            }
            if (near) keep_clean(b, (size_t)b->list[texel]);
        }
}

/* Takes pieces of furniture beside holes into these. */
static enum status drop_pieces(struct composite *c, struct err *err)
{
    struct bake *b = c->b;
    const size_t n = texels_of(c->t);
    for (size_t i = 0; i < n; i++) {
        const size_t texel = c->t->first + i;
        c->unseen[i] = is_hole(b, texel);
        c->clean[i] = is_warped(b, texel) || b->role[texel] == TEXEL_ORIGINAL;
        if (is_warped(b, texel)) display_of(c->value + 3 * i, b, &b->lists[b->list[texel]][0]);
        for (size_t k = 0; k < 3 && b->role[texel] == TEXEL_ORIGINAL; k++)
            c->value[3 * i + k] = bake_display(b->rgb[3 * texel + k], b->white);
    }
    const struct hole_picture picture = {c->t->raster.width, c->t->raster.height, c->value, c->unseen, c->clean};
    if (hole_pieces_find(c->role, &picture, (float)b->params->max_gradient, err)) return err->status;
    for (size_t i = 0; i < n; i++) {
        const size_t texel = c->t->first + i;
        if (!c->role[i] || !is_warped(b, texel)) continue;
        b->counts[b->list[texel]] = 0;
        if (!b->hidden[b->list[texel]]) b->hidden[b->list[texel]] = 1;
    }
    return ST_OK;
}

/* Roles, and the values of texels that views show. */
static void set_seen(struct composite *c)
{
    const struct bake *b = c->b;
    for (size_t i = 0; i < texels_of(c->t); i++) {
        const size_t texel = c->t->first + i;
        c->unseen[i] = b->role[texel] != TEXEL_NONE && b->role[texel] != TEXEL_ORIGINAL && !is_warped(b, texel);
        c->role[i] = b->role[texel] == TEXEL_NONE       ? GRADIENT_OUT
                     : b->role[texel] == TEXEL_ORIGINAL ? GRADIENT_FIXED
                                                        : GRADIENT_FREE;
        if (c->role[i] == GRADIENT_FIXED)
            for (int k = 0; k < 3; k++)
                c->value[3 * i + (size_t)k] = bake_display(b->rgb[3 * texel + (size_t)k], b->white);
        if (c->role[i] != GRADIENT_FREE || c->unseen[i]) continue;
        display_of(c->value + 3 * i, b, &b->lists[b->list[texel]][0]);
        memcpy(c->data + 3 * i, c->value + 3 * i, 3 * sizeof *c->value);
        c->data_weight[i] = b->own_group < 0 ? HELD : WEAK;
    }
}

static bool has_guide(const struct composite *c, size_t i) { return c->fill.guide && !isnan(c->fill.guide[3 * i]); }

static float levelled_guide(const struct composite *c, size_t i, size_t channel)
{
    return c->fill.guide[3 * i + channel] + c->level->above[channel];
}

/* Whether no texel is made: only an edit has the place, or no view shows the face, so that the VITA is as good. */
static bool is_left_out(const struct composite *c, size_t i)
{
    return c->fill.guide && c->unseen[i] && !has_guide(c, i);
}

/* Unseen texels are drawn to the filled atlas, or else to the nearest of the texels that are listed as such. seen: the
 * role of seen ones from now. */
static void set_unseen(struct composite *c, int seen)
{
    const struct bake *b = c->b;
    for (size_t i = 0; i < texels_of(c->t); i++) {
        if (c->role[i] == GRADIENT_FREE && !c->unseen[i]) c->role[i] = (uint8_t)seen;
        if (!c->unseen[i]) continue;
        if (is_left_out(c, i)) {
            c->role[i] = GRADIENT_OUT;
            continue;
        }
        float *value = c->value + 3 * i;
        if (has_guide(c, i))
            for (size_t k = 0; k < 3; k++) value[k] = levelled_guide(c, i, k);
        else if (c->nearest[i] >= 0)
            memcpy(value, c->value + 3 * (size_t)c->nearest[i], 3 * sizeof *value);
        else
            for (int k = 0; k < 3; k++) value[k] = bake_display((float)(DEFAULT_GREY * b->white), b->white);
        memcpy(c->data + 3 * i, value, 3 * sizeof *value);
        c->data_weight[i] = WEAK;
    }
}

/* Draws unseen texels to the filled atlas where that is brighter than what was solved; false: nowhere. A hole whose rim
 * lies in the shadow of what hides it is too dark; no rim makes it too bright as often. */
static bool draw_to_guide(struct composite *c)
{
    bool any = false;
    for (size_t i = 0; i < texels_of(c->t) && c->level->known; i++) {
        float brighter = 0;
        if (!c->unseen[i] || !has_guide(c, i)) continue;
        for (size_t k = 0; k < 3; k++) brighter += levelled_guide(c, i, k) - c->value[3 * i + k];
        if (!(brighter > 0)) continue;
        for (size_t k = 0; k < 3; k++) c->data[3 * i + k] = levelled_guide(c, i, k);
        c->data_weight[i] = GUIDED;
        any = true;
    }
    return any;
}

/* Draws unseen texels to the colours around the hole where they lie beyond these; *any: somewhere. An atlas that is
 * filled already has its own bounds. */
static enum status draw_within_bounds(struct composite *c, bool *any, struct err *err)
{
    const struct synthesis_picture picture = {c->t->raster.width, c->t->raster.height, c->value, c->unseen, c->clean};
    *any = false;
    if (c->b->filled) return ST_OK;
    if (hole_bounds_find(c->data, c->beyond, any, &picture, c->nearest, FURNITURE, err)) return err->status;
    for (size_t i = 0; i < texels_of(c->t); i++)
        if (c->beyond[i]) c->data_weight[i] = GUIDED;
    return ST_OK;
}

/* Which texels are clean. */
static void find_clean(struct composite *c)
{
    const int width = c->t->raster.width, height = c->t->raster.height;
    for (size_t i = 0; i < texels_of(c->t); i++) c->clean[i] = c->role[i] != GRADIENT_OUT && !c->unseen[i];
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (!c->unseen[(size_t)y * (size_t)width + (size_t)x]) continue;
            for (int v = y > RIM ? y - RIM : 0; v <= y + RIM && v < height; v++)
                for (int u = x > RIM ? x - RIM : 0; u <= x + RIM && u < width; u++)
                    c->clean[(size_t)v * (size_t)width + (size_t)u] = 0;
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
        if (b->role[texel] == TEXEL_NONE) continue;
        if (is_left_out(c, i)) {
            b->role[texel] = TEXEL_NONE;
            continue;
        }
        totals->texels++;
        if (b->role[texel] == TEXEL_ORIGINAL) {
            totals->original++; /* made[] has the view already */
            continue;
        }
        for (int k = 0; k < 3; k++)
            b->rgb[3 * texel + (size_t)k] = bake_radiance(c->value[3 * i + (size_t)k], b->white);
        if (is_warped(b, texel)) {
            b->made[texel] = (uint32_t)ATLAS_VIEWS + b->lists[b->list[texel]][0].source;
            totals->warped++;
        } else if (c->nearest[i] >= 0 || has_guide(c, i)) {
            b->made[texel] = ATLAS_SYNTHESISED;
            totals->synthesised++;
        } else {
            b->made[texel] = ATLAS_DEFAULT;
            totals->by_default++;
        }
    }
}

static enum status solve(struct composite *c, struct bake_totals *totals, struct err *err)
{
    const struct gradient_problem problem = {
        c->t->raster.width, c->t->raster.height, c->role,      c->data_weight, c->data,
        c->weight[0],       c->gradient[0],      c->weight[1], c->gradient[1], c->value};
    struct gradient_report report = {0};
    const size_t n = texels_of(c->t);
    memset(c->gradient[0], 0, 2 * 4 * n * sizeof(float)); /* and the weights behind them */
    set_pairs(c);
    gradient_solve(&problem, &report, err);
    totals->residual = fmax(totals->residual, report.residual);
    return err->status;
}

static bool find_nearest_seen(struct composite *c)
{
    for (size_t i = 0; i < texels_of(c->t); i++) c->clean[i] = c->role[i] != GRADIENT_OUT && !c->unseen[i];
    return find_nearest(c, c->clean);
}

/* All texels together first, unseen ones smooth; then the unseen ones again, with texture, between fixed seen ones. */
static enum status solve_tile(struct composite *c, struct bake_totals *totals, struct err *err)
{
    widen_holes(c);
    if (drop_pieces(c, err)) return err->status;
    set_seen(c);
    find_nearest_seen(c);
    set_unseen(c, GRADIENT_FREE);
    if (solve(c, totals, err) || !memchr(c->unseen, 1, texels_of(c->t))) return err->status;
    find_clean(c);
    if (!find_nearest(c, c->clean) && !find_nearest_seen(c) && !c->b->filled) return ST_OK;
    const struct synthesis_picture picture = {c->t->raster.width, c->t->raster.height, c->value, c->unseen, c->clean};
    if (c->b->filled) {
        float *guide = filled_atlas_tile(c->b->filled, c->b, c->t, err);
        if (guide) texture_fill_guide(&c->fill, &picture, guide, err);
    } else
        texture_fill_find(&c->fill, &picture, err);
    if (err->status) return err->status;
    set_unseen(c, GRADIENT_FIXED);
    if (solve(c, totals, err)) return err->status;
    const bool again = draw_to_guide(c);
    bool beyond;
    if (draw_within_bounds(c, &beyond, err)) return err->status;
    return again || beyond ? solve(c, totals, err) : ST_OK;
}

static enum status composite_tile(struct bake *b, const struct bake_tile *t, const struct level *level,
                                  struct bake_totals *totals, struct err *err)
{
    enum { FLOATS = 3 + 1 + 3 + 2 * (3 + 1) };
    const size_t n = texels_of(t);
    float *memory = calloc(n, FLOATS * sizeof *memory);
    int32_t *indices = malloc(2 * n * sizeof *indices);
    uint8_t *flags = malloc(4 * n);
    if (!memory || !indices || !flags) {
        err_nomem(err, "a tile", n * FLOATS * sizeof *memory);
    } else {
        struct composite c = {.b = b,
                              .t = t,
                              .level = level,
                              .role = flags,
                              .unseen = flags + n,
                              .clean = flags + 2 * n,
                              .beyond = flags + 3 * n,
                              .nearest = indices,
                              .queue = indices + n,
                              .data = memory,
                              .value = memory + 3 * n,
                              .data_weight = memory + 6 * n,
                              .gradient = {memory + 7 * n, memory + 10 * n},
                              .weight = {memory + 13 * n, memory + 14 * n}};
        if (!solve_tile(&c, totals, err)) take_texels(b, &c, totals);
        texture_fill_release(&c.fill);
    }
    free(memory);
    free(indices);
    free(flags);
    return err->status;
}

enum status bake_composite(struct bake *b, struct bake_totals *totals, struct err *err)
{
    struct level level = {.known = false};
    *totals = (struct bake_totals){0};
    if (b->filled) filled_atlas_level(level.above, &level.known, b->filled, b, err);
    for (int i = 0; !err->status && i < b->tile_count; i++) composite_tile(b, &b->tiles[i], &level, totals, err);
    return err->status;
}
