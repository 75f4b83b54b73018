/* layer_visibility.c - visibility of one view's segments in a novel camera.
 *
 * Drawing a segment writes no colour. For each pixel of a tile it keeps the two nearest surfaces that have texels
 * there, each by its nearest segment, and the front's position in the view. Colour is looked up afterwards, once per
 * pixel, however many segments were drawn. Segments need no sorting, and eight pixels are drawn at once. [Colburn 2014,
 * 3.6.1] draws colour, segments sorted by the depth of the centremost camera.
 *
 * Two segments are one surface if their 1/z differ by at most surface_gap, relatively. The two surfaces do not depend
 * on the order in which segments are drawn, except where three or more at one pixel form a chain, each within the
 * tolerance of the next but not the first of the last: where the chain is cut depends on the order. That order is
 * always the one of the depth map's list, whichever segments a tile projects (drawn_view.h).
 *
 * Sampling: where all texels of a cell are one surface, the photo itself is looked up, so that neither seams between
 * segments nor the soft alpha of their boundaries show. In a split cell the texels of the segment's surface alone are
 * summed, which gives its coverage and premultiplied colour.
 *
 * A photo that the frame shows reduced would alias, and shimmer in a film. With n texels per pixel of the frame, from
 * the determinant of the segment's homography in its middle, cells of one surface are looked up between the two levels
 * of a MIP map [Williams 1983] that are nearest to log2(n) / 2 - LEVEL_BIAS. A depth map's borders are not filtered.
 */
#include "common/layers/layer_visibility.h"

#include <math.h>

#include "common/math/lanes.h"

/* A photo reduced by less than sqrt(2) is looked up as it is: bilinear levels are blurred by themselves. */
#define LEVEL_BIAS 0.5f
#define BORDER     0.05f /* width of the band in which a view fades out at its border, of the picture's long side */

/* ------------------------------------------------------------------------------------------------------ drawing */

/* Of the given lanes, all in cells of many segments, those whose cell has a texel of segment `id`. */
static inline int many_hits(int lanes, i32x8 first, const struct layer_view *lv, i32x8 id)
{
    uint32_t word[8];
    int hits = 0;

    i32x8_store(word, first);
    for (; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz((unsigned)lanes);
        const i32x8 ids = i32x8_load(lv->many[word[k] & ~(CELL_MANY | CELL_SPLIT)].id);
        hits |= (i32x8_any(ids == id)) << k;
    }
    return hits;
}

/* Eight lanes from eight bits. */
static inline i32x8 mask_of(int lanes)
{
    const i32x8 bits = {1, 2, 4, 8, 16, 32, 64, 128};
    return (lanes & bits) == bits;
}

/* words[base + near], near from 0 to 15. */
static inline i32x8 words_near(const uint32_t *words, int base, i32x8 near)
{
    const i32x8 low = i32x8_load(words + base);
    const i32x8 high = i32x8_load(words + base + 8);
    return i32x8_if(near > 7, i32x8_pick(high, near), i32x8_pick(low, near));
}

/* Both words of the cells at the eight indices `at`; lane `first` is the leftmost that matters. */
static inline void cell_words(uint32_t *const cells[2], i32x8 at, int first, i32x8 *word, i32x8 *second)
{
    const i32x8 base = i32x8_pick(at, i32x8_all(first));
    const i32x8 near = at - base;
    const i32x8 is_near = (near & ~15) == 0;

    if (i32x8_signs(is_near) == 0xFF) { /* three times as fast as a gather */
        const int begin = base[0];
        *word = words_near(cells[0], begin, near);
        *second = words_near(cells[1], begin, near);
    } else {
        *word = i32x8_gather((const int32_t *)cells[0], at);
        *second = i32x8_gather((const int32_t *)cells[1], at);
    }
}

/* Draws columns first .. last of one row; index: of the segment. */
static void draw_row(struct tile_visibility *tv, size_t row, int first, int last, const struct drawn_segment *s,
                     uint32_t index, const struct layer_view *lv, float y, int tile_x)
{
    const f32x8 lanes = {0, 1, 2, 3, 4, 5, 6, 7}, zero = {0};
    const f32x8 one = f32x8_all(1);
    const f32x8 u_step = f32x8_all(s->u[1]), v_step = f32x8_all(s->v[1]), w_step = f32x8_all(s->w[1]);
    const f32x8 z_step = f32x8_all(s->inverse_z[1]);
    const f32x8 u_row = f32x8_all(s->u[0] + y * s->u[2]), v_row = f32x8_all(s->v[0] + y * s->v[2]);
    const f32x8 w_row = f32x8_all(s->w[0] + y * s->w[2]);
    const f32x8 z_row = f32x8_all(s->inverse_z[0] + y * s->inverse_z[2]);
    const f32x8 u0 = f32x8_all(s->u0), u1 = f32x8_all(s->u1), v0 = f32x8_all(s->v0), v1 = f32x8_all(s->v1);
    const i32x8 id = i32x8_all((int)s->id), me = i32x8_all((int)index);
    const f32x8 gap = f32x8_all(s->surface_gap);
    const i32x8 full_bit = i32x8_all((int)VISIBLE_FULL);

    for (int x = first; x <= last; x += 8) {
        const size_t at = row + (size_t)(x - tile_x);
        const f32x8 dx = (float)(x - s->x0) + lanes;
        const f32x8 inverse = z_row + dx * z_step;
        const f32x8 front = f32x8_load(tv->inverse_front + at);
        const f32x8 behind = f32x8_load(tv->inverse_behind + at);
        const i32x8 front_index = i32x8_load(tv->front + at);
        /* nearest: in front of the front; second: behind a front that is not full, another surface, the nearest such */
        const i32x8 nearest = inverse > front;
        const i32x8 beyond = front - inverse > front * gap;
        const i32x8 second = ~front_index & beyond & (inverse > behind);
        int wanted = i32x8_signs(nearest | second);
        if (last - x < 7) wanted &= (2 << (last - x)) - 1;
        if (!wanted) continue;

        const f32x8 w = w_row + dx * w_step;
        const f32x8 scale = one / w;
        const f32x8 u = (u_row + dx * u_step) * scale;
        const f32x8 v = (v_row + dx * v_step) * scale;
        const i32x8 inside = (u >= u0) & (u < u1) & ((v >= v0) & (v < v1));
        wanted &= i32x8_signs(inside & (w > zero));
        if (!wanted) continue;

        /* lanes outside of the segment read the cell of the leftmost lane inside */
        const int leftmost = __builtin_ctz((unsigned)wanted);
        const i32x8 column = i32x8_truncate(u), line = i32x8_truncate(v);
        const i32x8 cell_of = i32x8_index(line, lv->stride, column);
        const i32x8 first_cell = i32x8_pick(cell_of, i32x8_all(leftmost));
        const i32x8 cell = i32x8_if(inside, cell_of, first_cell);
        i32x8 split, other; /* the cells' words; CELL_SPLIT is the sign of the first */
        cell_words(lv->cells, cell, leftmost, &split, &other);
        const i32x8 owner = split & (int)~CELL_SPLIT;
        const i32x8 own = (owner == id) | (other == id);
        int hits = wanted & i32x8_signs(own);
        const int many = wanted & i32x8_signs(split << 1);
        if (many) hits |= many_hits(many, split, lv, id);
        if (!hits) continue;

        const i32x8 hit = mask_of(hits);
        const i32x8 as_front = hit & nearest;
        const i32x8 as_second = ~nearest & (hit & second);
        const i32x8 full = ~(split >> 31) & full_bit;
        const i32x8 behind_index = i32x8_load(tv->behind + at);
        /* the old front becomes the surface behind if it is another surface than the new one */
        const i32x8 before = inverse - front > inverse * gap;
        const i32x8 back = as_front & before;
        f32x8 new_behind = f32x8_if(back, front, behind);
        i32x8 new_behind_index = i32x8_if(back, front_index, behind_index);
        new_behind = f32x8_if(as_second, inverse, new_behind);
        new_behind_index = i32x8_if(as_second, me | full, new_behind_index);
        f32x8_store(tv->inverse_behind + at, new_behind);
        i32x8_store(tv->behind + at, new_behind_index);
        if (!i32x8_any(as_front)) continue;
        f32x8_store(tv->inverse_front + at, f32x8_if(as_front, inverse, front));
        i32x8_store(tv->front + at, i32x8_if(as_front, me | full, front_index));
        f32x8_store(tv->u + at, f32x8_if(as_front, u, f32x8_load(tv->u + at)));
        f32x8_store(tv->v + at, f32x8_if(as_front, v, f32x8_load(tv->v + at)));
    }
}

/* The pixels to draw: in the row's range of columns, and not skipped. */
static void find_open(struct open_pixels *open, const struct tile_visibility *tv, int tile_x, int tile_y)
{
    int x0 = TILE_WIDTH, x1 = -1, y0 = TILE_HEIGHT, y1 = -1;

    for (int y = 0; y < TILE_HEIGHT; y++) {
        const float *inverse = tv->inverse_front + (size_t)y * TILE_STRIDE;
        const int first = tv->first[y], last = tv->last[y];
        open->row[y][0] = open->row[y][1] = 0;
        for (int x = first & ~7; x <= last; x += 8) {
            const i32x8 is = f32x8_load(inverse + x) == (f32x8){0};
            unsigned bits = i32x8_signs(is);
            if (x < first) bits &= 0xFFu << (first - x);
            if (last - x < 7) bits &= (2u << (last - x)) - 1;
            open->row[y][x / 64] |= (uint64_t)bits << x % 64;
        }
        const uint64_t low = open->row[y][0], high = open->row[y][1];
        if (!(low | high)) continue;
        const int left = low ? __builtin_ctzll(low) : 64 + __builtin_ctzll(high);
        const int right = high ? 127 - __builtin_clzll(high) : 63 - __builtin_clzll(low);
        x0 = left < x0 ? left : x0;
        x1 = right > x1 ? right : x1;
        y0 = y < y0 ? y : y0;
        y1 = y;
    }
    open->x = tile_x;
    open->y = tile_y;
    open->box = (struct pixel_box){tile_x + x0, tile_y + y0, tile_x + x1, tile_y + y1};
}

enum status visibility_draw(struct tile_visibility *tv, struct drawn_tile *segments, const struct drawn_view *dv,
                            int tile, struct err *err)
{
    const int tile_x = tile % dv->tiles_x * TILE_WIDTH, tile_y = tile / dv->tiles_x * TILE_HEIGHT;
    struct open_pixels open;

    find_open(&open, tv, tile_x, tile_y);
    if (drawn_tile_project(segments, dv, tile, &open, err)) return ST_NOMEM;
    for (int i = 0; i < segments->count; i++) {
        const uint32_t index = segments->order[i];
        const struct drawn_segment *s = &segments->segments[index];
        const int top = s->y0 > tile_y ? s->y0 : tile_y;
        const int bottom = s->y1 < tile_y + TILE_HEIGHT - 1 ? s->y1 : tile_y + TILE_HEIGHT - 1;
        for (int y = top; y <= bottom; y++) {
            const int first = s->x0 > tile_x + tv->first[y - tile_y] ? s->x0 : tile_x + tv->first[y - tile_y];
            const int last = s->x1 < tile_x + tv->last[y - tile_y] ? s->x1 : tile_x + tv->last[y - tile_y];
            if (!open_pixels_any(&open, first, y, last, y)) continue;
            draw_row(tv, (size_t)(y - tile_y) * TILE_STRIDE, first, last, s, index, dv->lv, (float)(y - s->y0), tile_x);
        }
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ sampling */

static inline float alpha_of(f32x4 rgba) { return rgba[3]; }

/* Bilinear look-up of the photo in the cell that begins at texel `at`. */
static inline f32x4 photo_texel(const struct layer_view *lv, int at, float fu, float fv)
{
    const uint16_t(*t)[4] = (const uint16_t(*)[4])lv->photo + at;
    const f32x8 top = f32x8_from_half(t[0]);
    const f32x8 bottom = f32x8_from_half(t[lv->stride]);
    const f32x8 mean = top + (bottom - top) * fv;
    const f32x4 left = f32x8_low(mean), right = f32x8_high(mean);
    return left + (right - left) * fu;
}

static void cubic_weights(float w[4], float t)
{
    const float t2 = t * t, t3 = t2 * t;
    w[0] = -0.5f * t3 + t2 - 0.5f * t;
    w[1] = 1.5f * t3 - 2.5f * t2 + 1;
    w[2] = -1.5f * t3 + 2 * t2 + 0.5f * t;
    w[3] = 0.5f * t3 - 0.5f * t2;
}

/* Catmull-Rom look-up [Catmull 1974] in 4 x 4 texels; falls back to photo_texel where one of their cells is split. */
static f32x4 photo_cubic(const struct layer_view *lv, int at, float fu, float fv)
{
    float wu[4], wv[4];
    f32x4 sum = {0};

    if (at < lv->stride + 1) return photo_texel(lv, at, fu, fv);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const uint32_t word = lv->cells[0][at + y * lv->stride + x];
            if (!word || word & CELL_SPLIT) return photo_texel(lv, at, fu, fv);
        }
    cubic_weights(wu, fu);
    cubic_weights(wv, fv);
    for (int y = 0; y < 4; y++) {
        const uint16_t(*t)[4] = (const uint16_t(*)[4])lv->photo + at + (y - 1) * lv->stride - 1;
        f32x4 row = {0};
        for (int x = 0; x < 4; x++) {
            const f32x4 texel = f32x4_from_half(t[x]);
            row += wu[x] * texel;
        }
        sum += wv[y] * row;
    }
    return f32x4_max(sum, (f32x4){0});
}

/* Bilinear look-up in a reduced photo, at (u, v) of the padded texels of the photo itself. Texels without depth and
 * beyond the border do not count. */
static f32x4 reduced_texel(const struct layer_view *lv, int level, float u, float v)
{
    const struct photo_level *from = &lv->reduced[level - 1];
    const float part = 1 / (float)(1 << level), x = (u - 0.5f) * part + 0.5f, y = (v - 0.5f) * part + 0.5f;
    const int i = (int)x, j = (int)y;
    const float fx = x - (float)i, fy = y - (float)j;
    const uint16_t(*t)[4] = (const uint16_t(*)[4])from->texels + (size_t)j * (size_t)from->stride + i;
    const f32x8 top = f32x8_from_half(t[0]);
    const f32x8 bottom = f32x8_from_half(t[from->stride]);
    const f32x8 mean = top + (bottom - top) * fy;
    const f32x4 left = f32x8_low(mean), right = f32x8_high(mean);
    const f32x4 sum = left + (right - left) * fx;
    const float alpha = alpha_of(sum);
    return alpha > 0 ? sum / alpha : sum;
}

/* The photo between two levels; `sharp` is the photo itself there. */
static f32x4 photo_between(const struct layer_view *lv, float level, float u, float v, f32x4 sharp)
{
    const int below = (int)level < lv->reduced_count ? (int)level : lv->reduced_count - 1;
    const f32x4 fine = below ? reduced_texel(lv, below, u, v) : sharp, coarse = reduced_texel(lv, below + 1, u, v);
    return fine + (coarse - fine) * (level - (float)below);
}

/* MIP level of a segment's photo: the homography's determinant over w^3 is the area in texels of a target pixel. */
static float photo_level(const struct drawn_segment *s, int levels)
{
    const float dx = 0.5f * (float)(s->x1 - s->x0), dy = 0.5f * (float)(s->y1 - s->y0);
    const float w = s->w[0] + dx * s->w[1] + dy * s->w[2];
    const float det = s->u[1] * (s->v[2] * s->w[0] - s->v[0] * s->w[2]) -
                      s->u[2] * (s->v[1] * s->w[0] - s->v[0] * s->w[1]) +
                      s->u[0] * (s->v[1] * s->w[2] - s->v[2] * s->w[1]);
    const float area = fabsf(det) / (w * w * w);
    if (!(w > 0) || !(area > 1)) return 0;
    return fmaxf(0, fminf((float)levels, 0.5f * log2f(area) - LEVEL_BIAS));
}

/* Replaces the colours of those of the eight pixels from i on whose segments the frame shows reduced. */
static void sample_reduced(struct view_samples *s, const struct drawn_tile *dt, const struct layer_view *lv, size_t i,
                           int pixels, i32x8 segment, const float *u, const float *v)
{
    int index[8], known = -1;
    float level = 0;

    i32x8_store(index, segment);
    for (; pixels; pixels &= pixels - 1) {
        const int k = __builtin_ctz((unsigned)pixels);
        if (index[k] != known) level = photo_level(&dt->segments[known = index[k]], lv->reduced_count);
        if (!(level > 0)) continue;
        f32x4_store(s->rgba[i + (size_t)k], photo_between(lv, level, u[k], v[k], f32x4_load(s->rgba[i + (size_t)k])));
    }
}

static f32x4 photo_at(const struct layer_view *lv, float u, float v)
{
    const int i = (int)u, j = (int)v;
    return photo_texel(lv, j * lv->stride + i, u - (float)i, v - (float)j);
}

/* Mask of the layers of a texel whose id is one of `ids`; eight lanes: 0..3 interior, 4..7 boundary. */
static inline i32x8 layers_of(const struct texel *t, const uint32_t *ids, int count)
{
    const int32_t interior = (int32_t)(t->id[0] & ~TEXEL_JOINED), boundary = (int32_t)(t->id[1] & ~TEXEL_JOINED);
    const i32x8 own = {interior, interior, interior, interior, boundary, boundary, boundary, boundary};
    i32x8 found = {0};
    for (int i = 0; i < count; i++) found |= own == (int32_t)ids[i];
    return found;
}

/* Segments of the cell that are one surface with segment `id`, itself included. Returns their number. */
static int same_surface(const struct layer_view *lv, size_t at, uint32_t id, uint32_t ids[CELL_IDS])
{
    const uint32_t word = lv->cells[0][at];
    int count = 0, own = 0;

    ids[0] = id;
    if (!(word & CELL_MANY)) return 1;
    const struct many_cell *cell = &lv->many[word & ~(CELL_MANY | CELL_SPLIT)];
    while (own < CELL_IDS - 1 && cell->id[own] != id) own++;
    for (int i = 0; i < CELL_IDS && cell->id[i]; i++)
        if (cell->surface[i] == cell->surface[own]) ids[count++] = cell->id[i];
    return count;
}

/* A cell of four texels with their bilinear weights, and the segments that are one surface in it. */
struct split_cell {
    const struct texel *texel[4];
    float weight[4];
    uint32_t ids[CELL_IDS];
    int count;
};

static inline void split_cell_at(struct split_cell *c, const struct layer_view *lv, uint32_t id, float u, float v)
{
    const int i = (int)u, j = (int)v;
    const float fu = u - (float)i, fv = v - (float)j;
    const size_t at = (size_t)j * (size_t)lv->stride + (size_t)i;
    const struct texel *t = lv->texels + at;
    c->texel[0] = t;
    c->texel[1] = t + 1;
    c->texel[2] = t + lv->stride;
    c->texel[3] = t + lv->stride + 1;
    c->weight[0] = (1 - fu) * (1 - fv);
    c->weight[1] = fu * (1 - fv);
    c->weight[2] = (1 - fu) * fv;
    c->weight[3] = fu * fv;
    c->count = same_surface(lv, at, id, c->ids);
}

/* Coverage and premultiplied colour of segment `id`'s surface in a split cell. */
static f32x4 surface_at(const struct layer_view *lv, uint32_t id, float u, float v)
{
    struct split_cell c;
    f32x8 sum = {0};

    split_cell_at(&c, lv, id, u, v);
    for (int k = 0; k < 4; k++) {
        const f32x8 w = f32x8_where(layers_of(c.texel[k], c.ids, c.count), f32x8_all(c.weight[k]));
        const f32x8 color = f32x8_from_half(c.texel[k]->rgba[0]);
        sum += w * color;
    }
    return f32x8_low(sum) + f32x8_high(sum);
}

/* Coverage by segment `id`'s surface in a split cell: the alpha of surface_at(), bit by bit. */
static float surface_alpha(const struct layer_view *lv, uint32_t id, float u, float v)
{
    struct split_cell c;
    float sum[2] = {0, 0};

    split_cell_at(&c, lv, id, u, v);
    for (int k = 0; k < 4; k++)
        for (int l = 0; l < 2; l++) {
            const uint32_t own = c.texel[k]->id[l] & ~TEXEL_JOINED;
            bool found = false;
            for (int n = 0; n < c.count; n++) found |= own == c.ids[n];
            if (found) sum[l] += c.weight[k] * float_from_half(c.texel[k]->rgba[l][3]);
        }
    return sum[0] + sum[1];
}

/* Fade towards the picture's border at texel positions (u, v): 0 at the border, 1 from BORDER on. */
static inline f32x8 inside8(const struct layer_view *lv, f32x8 u, f32x8 v)
{
    const float across = (float)(lv->width > lv->height ? lv->width : lv->height) * BORDER;
    const f32x8 half = f32x8_all(0.5f);
    const f32x8 x = f32x8_min(u - half, (float)lv->width + 0.5f - u);
    const f32x8 y = f32x8_min(v - half, (float)lv->height + 0.5f - v);
    const f32x8 part = f32x8_max((f32x8){0}, f32x8_min(x, y)) * (1 / across);
    return f32x8_min(f32x8_all(1), part);
}

/* Position of target pixel (x, y) on segment b, in the padded texels. */
static void position_on(const struct drawn_segment *b, int x, int y, float *u, float *v)
{
    const float dx = (float)(x - b->x0), dy = (float)(y - b->y0);
    const float scale = 1 / (b->w[0] + dx * b->w[1] + dy * b->w[2]);
    *u = (b->u[0] + dx * b->u[1] + dy * b->u[2]) * scale;
    *v = (b->v[0] + dx * b->v[1] + dy * b->v[2]) * scale;
}

/* Coverage and premultiplied colour of segment b at target pixel (x, y). */
static f32x4 behind_at(const struct drawn_segment *b, bool full, const struct layer_view *lv, int x, int y)
{
    float u, v;
    position_on(b, x, y, &u, &v);
    return full ? photo_at(lv, u, v) : surface_at(lv, b->id, u, v);
}

static float alpha_behind(const struct drawn_segment *b, bool full, const struct layer_view *lv, int x, int y)
{
    float u, v;
    position_on(b, x, y, &u, &v);
    return full ? alpha_of(photo_at(lv, u, v)) : surface_alpha(lv, b->id, u, v);
}

/* Samples a pixel that its front covers only partly: saturating compositing, front to back. */
static void sample_split(struct view_samples *s, struct view_samples *behind, const struct tile_visibility *tv,
                         const struct drawn_tile *dt, const struct layer_view *lv, size_t i, int x, int y)
{
    const uint32_t index = tv->behind[i];
    f32x4 sum = surface_at(lv, dt->segments[tv->front[i]].id, tv->u[i], tv->v[i]);
    const float alpha = alpha_of(sum);

    if (index != VISIBLE_NONE && alpha < 1) {
        const uint32_t at = index & ~VISIBLE_FULL;
        const f32x4 back = behind_at(&dt->segments[at], index & VISIBLE_FULL, lv, x, y);
        const float back_alpha = alpha_of(back), weight = back_alpha < 1 - alpha ? back_alpha : 1 - alpha;
        const f32x4 rest = weight > 0 ? back * (weight / back_alpha) : (f32x4){0};
        struct view_samples *to = behind ? behind : s;
        if (behind) {
            f32x4_store(behind->rgba[i], rest);
            behind->alpha[i] = weight > 0 ? weight : 0;
        } else
            sum += rest;
        if (behind || weight > alpha) { /* depth of the dominant surface, never a mean across a depth jump */
            to->z[i] = 1 / tv->inverse_behind[i];
            to->sigma[i] = dt->sigmas[at];
        }
    }
    f32x4_store(s->rgba[i], sum);
    s->alpha[i] = alpha_of(sum);
}

static void sample_nothing(struct view_samples *s, size_t i)
{
    f32x4_store(s->rgba[i], (f32x4){0});
    s->alpha[i] = s->z[i] = s->sigma[i] = s->inside[i] = 0;
}

void visibility_sample8(struct view_samples *s, struct view_samples *behind, const struct tile_visibility *tv,
                        const struct drawn_tile *dt, const struct layer_view *lv, size_t i, int tile_x, int tile_y)
{
    const i32x8 index = i32x8_load(tv->front + i);
    const i32x8 none = index == -1;
    const int empty = i32x8_signs(none);
    const int full = i32x8_signs(index) & ~empty;
    const f32x8 u = f32x8_unless(none, f32x8_load(tv->u + i)), v = f32x8_unless(none, f32x8_load(tv->v + i));
    const i32x8 segment = ~none & index & (int)~VISIBLE_FULL;

    if (behind) f32x8_store(behind->alpha + i, (f32x8){0});
    if (empty == 0xFF) {
        for (size_t k = i; k < i + 8; k++) sample_nothing(s, k);
        return;
    }
    f32x8_store(s->z + i, 1 / f32x8_load(tv->inverse_front + i));
    f32x8_store(s->sigma + i, f32x8_gather(dt->sigmas, segment));
    f32x8_store(s->inside + i, inside8(lv, u, v));
    f32x8_store(s->alpha + i, f32x8_all(1));

    const i32x8 column = i32x8_truncate(u), line = i32x8_truncate(v);
    float fu[8], fv[8];
    int at[8];
    f32x8_store(fu, u - f32x8_from_i32(column));
    f32x8_store(fv, v - f32x8_from_i32(line));
    i32x8_store(at, i32x8_index(line, lv->stride, column));
    if (behind)
        for (int k = 0; k < 8; k++) f32x4_store(s->rgba[i + (size_t)k], photo_cubic(lv, at[k], fu[k], fv[k]));
    else
        for (int k = 0; k < 8; k++) f32x4_store(s->rgba[i + (size_t)k], photo_texel(lv, at[k], fu[k], fv[k]));
    sample_reduced(s, dt, lv, i, full, segment, tv->u + i, tv->v + i);
    if (full == 0xFF) return;
    for (int k = 0; k < 8; k++) {
        const size_t p = i + (size_t)k;
        if (empty >> k & 1)
            sample_nothing(s, p);
        else if (!(full >> k & 1))
            sample_split(s, behind, tv, dt, lv, p, tile_x + (int)(p % TILE_STRIDE), tile_y + (int)(p / TILE_STRIDE));
    }
}

/* As sample_split() without `behind`, but no colour. */
static void cover_split(struct view_samples *s, const struct tile_visibility *tv, const struct drawn_tile *dt,
                        const struct layer_view *lv, size_t i, int x, int y)
{
    const uint32_t index = tv->behind[i];
    float alpha = surface_alpha(lv, dt->segments[tv->front[i]].id, tv->u[i], tv->v[i]);

    if (index != VISIBLE_NONE && alpha < 1) {
        const uint32_t at = index & ~VISIBLE_FULL;
        const float back = alpha_behind(&dt->segments[at], index & VISIBLE_FULL, lv, x, y);
        const float weight = back < 1 - alpha ? back : 1 - alpha;
        if (weight > alpha) {
            s->z[i] = 1 / tv->inverse_behind[i];
            s->sigma[i] = dt->sigmas[at];
        }
        alpha += weight > 0 ? back * (weight / back) : 0;
    }
    s->alpha[i] = alpha;
}

void visibility_cover8(struct view_samples *s, const struct tile_visibility *tv, const struct drawn_tile *dt,
                       const struct layer_view *lv, size_t i, int tile_x, int tile_y)
{
    const i32x8 index = i32x8_load(tv->front + i);
    const i32x8 none = index == -1;
    const int empty = i32x8_signs(none);
    const int full = i32x8_signs(index) & ~empty;
    const i32x8 segment = ~none & index & (int)~VISIBLE_FULL;

    if (empty == 0xFF) {
        f32x8_store(s->z + i, (f32x8){0});
        f32x8_store(s->sigma + i, (f32x8){0});
        f32x8_store(s->alpha + i, (f32x8){0});
        return;
    }
    const f32x8 one = f32x8_all(1);
    f32x8_store(s->z + i, f32x8_unless(none, one / f32x8_load(tv->inverse_front + i)));
    f32x8_store(s->sigma + i, f32x8_unless(none, f32x8_gather(dt->sigmas, segment)));
    f32x8_store(s->alpha + i, f32x8_unless(none, one));
    for (int lanes = ~(full | empty) & 0xFF; lanes; lanes &= lanes - 1) {
        const size_t p = i + (size_t)__builtin_ctz((unsigned)lanes);
        cover_split(s, tv, dt, lv, p, tile_x + (int)(p % TILE_STRIDE), tile_y + (int)(p / TILE_STRIDE));
    }
}
