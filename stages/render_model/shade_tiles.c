/* shade_tiles.c - see shade_tiles.h: look-ups in the tiles of atlases.
 *
 * A look-up in a tile is bilinear over the texels that exist. The tile's frame of empty texels (page_cache.h) and the
 * fourth half of a texel, 1 where it exists, make this one weighted sum of four texels, divided by its fourth number.
 * The weights are multiples of 1/256. So a pixel that looks at a texel's centre gets that texel bit for bit, although
 * its place is known to about 1e-4 texels only; other places are moved by at most 1/512 texel.
 *
 * Of several tiles that a pixel looks into, it takes one whose texels are the picture's own pixels; else the one in
 * which it lies farthest from the tile's edges, as in atlas_find(). Where that has no texel it takes the next one. */
#include "stages/render_model/shade_tiles.h"

#include <limits.h>
#include <math.h>

#include "common/math/lanes.h"

enum { STEPS = 1 << TEXELS_SHIFT };
static const float OWN = 1e6f;      /* added to the distance from a tile's edges */
static const double INSIDE = 0.01;  /* texels: a tile in whose inside, less this, all pixels look needs no test */
static const double OUTSIDE = 1e-3; /* texels: rounding */

/* ----------------------------------------------------------------------------------------------- tiles in a picture */

/* Least and greatest value in the corners of a rectangle of pixels: of x - at * w. */
struct range {
    double low, high;
};

static struct range range_of(const struct linear *a, const struct linear *w, double at, const int corner[4])
{
    struct range r = {INFINITY, -INFINITY};
    for (int k = 0; k < 4; k++) {
        const double x = corner[k & 1], y = corner[2 + (k >> 1)];
        const double value = linear_at(a, x, y) - at * linear_at(w, x, y);
        r.low = fmin(r.low, value);
        r.high = fmax(r.high, value);
    }
    return r;
}

static const struct linear nothing = {0, 0, 0};

/* Each test is linear in the pixel, so a rectangle whose corners all fail it has no pixel that passes. */
bool shade_tile_misses(const struct shade_tile *s, int x0, int y0, int x1, int y1)
{
    const int corner[4] = {x0, x1, y0, y1};
    return !(range_of(&s->w, &nothing, 0, corner).high > 0) || !(range_of(&s->x, &s->w, -OUTSIDE, corner).high >= 0) ||
           !(range_of(&s->x, &s->w, s->width + OUTSIDE, corner).low <= 0) ||
           !(range_of(&s->y, &s->w, -OUTSIDE, corner).high >= 0) ||
           !(range_of(&s->y, &s->w, s->height + OUTSIDE, corner).low <= 0);
}

static bool holds(const struct shade_tile *s, int x0, int y0, int x1, int y1)
{
    const int corner[4] = {x0, x1, y0, y1};
    return range_of(&s->w, &nothing, 0, corner).low > 0 && range_of(&s->x, &s->w, INSIDE, corner).low >= 0 &&
           range_of(&s->x, &s->w, s->width - INSIDE, corner).high <= 0 &&
           range_of(&s->y, &s->w, INSIDE, corner).low >= 0 &&
           range_of(&s->y, &s->w, s->height - INSIDE, corner).high <= 0;
}

int tile_lanes_make(struct tile_lanes *to, const struct shade_tile *tiles, int count, int x, int y, int side)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const struct shade_tile *s = &tiles[i];
        if (shade_tile_misses(s, x, y, x + side - 1, y + side - 1)) continue;
        to[kept++] = (struct tile_lanes){lanes_from(&s->x, x, y), lanes_from(&s->y, x, y), lanes_from(&s->w, x, y), s,
                                         holds(s, x, y, x + side - 1, y + side - 1)};
    }
    return kept;
}

/* -------------------------------------------------------------------------------------------------------- look-ups */

/* Where eight pixels look, in 1/256 texels from the frame's upper left texel, and in which tile. */
struct places {
    i32x8 x, y, tile;
    f32x8 depth; /* the distance from the tile's edges; below 0: no tile */
};

static inline i32x8 in_steps(f32x8 texels)
{
    /* a texel's centre is at +0.5, and the frame is one texel wide */
    const f32x8 steps = f32x8_all(STEPS), half = f32x8_all(STEPS / 2);
    return i32x8_round(texels * steps + half);
}

/* Takes tile i where a pixel lies deeper in it than in those before, but not as deep as `most`. */
static inline void choose(struct places *p, const struct tile_lanes *l, int i, f32x8 most, f32x8 down, f32x8 right)
{
    const struct shade_tile *s = l->tile;
    const f32x8 w = lanes_value(&l->w, down, right), zero = {0};
    const f32x8 x = lanes_value(&l->x, down, right) / w;
    const f32x8 y = lanes_value(&l->y, down, right) / w;
    const f32x8 beside = f32x8_min(x, (float)s->width - x);
    const f32x8 above = f32x8_min(y, (float)s->height - y);
    const f32x8 edge = f32x8_min(beside, above);
    const f32x8 depth = edge + (s->own ? OWN : 0);
    i32x8 take = (w > zero) & (edge >= zero);
    take &= depth > p->depth;
    take &= depth < most;
    p->x = i32x8_if(take, in_steps(x), p->x);
    p->y = i32x8_if(take, in_steps(y), p->y);
    p->tile = i32x8_if(take, i32x8_all(i), p->tile);
    p->depth = f32x8_if(take, depth, p->depth);
}

static inline struct places find_places(const struct tile_lanes *list, int count, f32x8 most, f32x8 down, f32x8 right)
{
    struct places p = {.depth = f32x8_all(-1)};
    for (int i = 0; i < count; i++) choose(&p, &list[i], i, most, down, right);
    return p;
}

static inline struct places place_in_whole(const struct tile_lanes *l, f32x8 down, f32x8 right)
{
    const f32x8 w = lanes_value(&l->w, down, right);
    return (struct places){in_steps(lanes_value(&l->x, down, right) / w), in_steps(lanes_value(&l->y, down, right) / w),
                           (i32x8){0}, (f32x8){0}};
}

/* Weighted sum of the four texels around a place. */
static inline f32x4 blend_texels(const struct shade_tile *s, int x, int y)
{
    const uint16_t *at = s->texels + 4 * ((y >> TEXELS_SHIFT) * (ptrdiff_t)s->stride + (x >> TEXELS_SHIFT));
    const f32x8 upper = f32x8_from_half(at);
    const f32x8 lower = f32x8_from_half(at + 4 * (ptrdiff_t)s->stride);
    const f32x8 down = f32x8_all((float)(y & (STEPS - 1)) * (1.0f / STEPS));
    const f32x4 right = f32x4_all((float)(x & (STEPS - 1)) * (1.0f / STEPS));
    const f32x8 both = upper + down * (lower - upper);
    const f32x4 left = f32x8_low(both);
    return left + right * (f32x8_high(both) - left);
}

/* Looks up the texels at `places`. Returns the lanes that have one. */
static inline unsigned look_up(struct texels *t, const struct tile_lanes *list, const struct places *p, unsigned lanes)
{
    unsigned found = lanes;
    int x[LANES], y[LANES], tile[LANES];
    i32x8_store(x, p->x);
    i32x8_store(y, p->y);
    i32x8_store(tile, p->tile);
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int k = __builtin_ctz(rest);
        const f32x4 sum = blend_texels(list[tile[k]].tile, x[k], y[k]);
        const float there = sum[3];
        t->x[k] = x[k], t->y[k] = y[k], t->tile[k] = tile[k];
        t->rgba[k] = there == 1 ? sum : sum / there;
        if (!(there > 0)) found &= ~(1u << k);
    }
    return found;
}

/* Other tiles for pixels whose first one has no texel. */
static unsigned look_further(struct texels *t, const struct tile_lanes *list, int count, struct places p,
                             unsigned lanes, f32x8 down, f32x8 right)
{
    unsigned found = 0;
    for (int i = 1; i < count && lanes; i++) {
        p = find_places(list, count, p.depth, down, right);
        const unsigned inside = i32x8_signs(p.depth >= (f32x8){0});
        lanes &= inside;
        const unsigned now = look_up(t, list, &p, lanes);
        found |= now;
        lanes &= ~now;
    }
    return found;
}

unsigned tile_texels_find(struct texels *t, const struct tile_lanes *list, int count, unsigned lanes, float down,
                          float right)
{
    const f32x8 rows = f32x8_all(down), columns = f32x8_all(right);
    if (!count) return 0;
    if (count == 1 && list->whole) {
        const struct places p = place_in_whole(list, rows, columns);
        return look_up(t, list, &p, lanes);
    }
    const struct places p = find_places(list, count, f32x8_all(INFINITY), rows, columns);
    lanes &= i32x8_signs(p.depth >= (f32x8){0});
    const unsigned found = look_up(t, list, &p, lanes);
    return found == lanes ? found : found | look_further(t, list, count, p, lanes & ~found, rows, columns);
}

enum picture_made tile_texels_made_near(const struct texels *t, const struct tile_lanes *list, int lane)
{
    const struct shade_tile *s = list[t->tile[lane]].tile;
    const int x = t->x[lane], y = t->y[lane];
    const int right = (x >> (TEXELS_SHIFT - 1)) & 1, down = (y >> (TEXELS_SHIFT - 1)) & 1;
    const uint8_t *at = s->made + (y >> TEXELS_SHIFT) * (ptrdiff_t)s->stride + (x >> TEXELS_SHIFT);
    for (int k = 1; k < 4; k++) {
        const uint8_t made = at[(down ^ k >> 1) * (ptrdiff_t)s->stride + (right ^ (k & 1))];
        if (made != MADE_NOTHING) return made;
    }
    return MADE_NOTHING;
}

/* --------------------------------------------------------------------------------------------------- nearest texels */

static float lane_value(const struct lanes *l, int lane, float down, float right)
{
    float values[LANES];
    f32x8_store(values, lanes_value(l, f32x8_all(down), f32x8_all(right)));
    return values[lane];
}

/* The texel at column x, row y of a tile, if it exists and is nearer to (px, py) than *best, a squared distance. */
static void try_texel(const struct shade_tile *s, int x, int y, float px, float py, const uint16_t **nearest,
                      float *best)
{
    if (x < 0 || y < 0 || x >= s->width || y >= s->height) return;
    const ptrdiff_t at = (y + 1) * (ptrdiff_t)s->stride + x + 1;
    const float dx = (float)x + 0.5f - px, dy = (float)y + 0.5f - py, squared = dx * dx + dy * dy;
    if (s->made[at] == MADE_NOTHING || squared >= *best) return;
    *best = squared;
    *nearest = s->texels + 4 * at;
}

/* Looks at squares of growing size around a place in the tile. */
static const uint16_t *nearest_in_tile(const struct shade_tile *s, float px, float py)
{
    const int cx = (int)fminf(px, (float)(s->width - 1)), cy = (int)fminf(py, (float)(s->height - 1));
    const int last = s->width > s->height ? s->width : s->height;
    const uint16_t *nearest = NULL;
    float best = INFINITY;
    for (int r = 0; r <= last && (float)(r - 1) * (float)(r - 1) < best; r++)
        for (int k = -r; k <= r; k++) {
            try_texel(s, cx + k, cy - r, px, py, &nearest, &best);
            try_texel(s, cx + k, cy + r, px, py, &nearest, &best);
            try_texel(s, cx - r, cy + k, px, py, &nearest, &best);
            try_texel(s, cx + r, cy + k, px, py, &nearest, &best);
        }
    return nearest;
}

bool tile_texel_nearest(float rgb[3], const struct tile_lanes *list, int count, int lane, float down, float right)
{
    const uint16_t *found = NULL;
    float least = INFINITY;
    for (int i = 0; i < count; i++) {
        const struct shade_tile *s = list[i].tile;
        const float w = lane_value(&list[i].w, lane, down, right);
        const float x = lane_value(&list[i].x, lane, down, right) / w,
                    y = lane_value(&list[i].y, lane, down, right) / w;
        if (!(w > 0) || !isfinite(x) || !isfinite(y)) continue;
        const float px = fminf(fmaxf(x, 0), (float)s->width), py = fminf(fmaxf(y, 0), (float)s->height);
        const float away = (x - px) * (x - px) + (y - py) * (y - py);
        if (away >= least) continue;
        const uint16_t *texel = nearest_in_tile(s, px, py);
        if (!texel) continue;
        found = texel;
        least = away;
    }
    for (int c = 0; found && c < 3; c++) rgb[c] = float_from_half(found[c]);
    return found;
}
