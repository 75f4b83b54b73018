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

#include <immintrin.h>
#include <math.h>

/* A photo reduced by less than sqrt(2) is looked up as it is: bilinear levels are blurred by themselves. */
#define LEVEL_BIAS 0.5f
#define BORDER     0.05f /* width of the band in which a view fades out at its border, of the picture's long side */

/* ------------------------------------------------------------------------------------------------------ drawing */

/* Of the given lanes, all in cells of many segments, those whose cell has a texel of segment `id`. */
static inline int many_hits(int lanes, __m256i first, const struct layer_view *lv, __m256i id)
{
    uint32_t word[8];
    int hits = 0;

    _mm256_storeu_si256((__m256i *)word, first);
    for (; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz((unsigned)lanes);
        const __m256i ids =
            _mm256_load_si256((const __m256i *)(const void *)lv->many[word[k] & ~(CELL_MANY | CELL_SPLIT)].id);
        const __m256i equal = _mm256_cmpeq_epi32(ids, id);
        hits |= (_mm256_testz_si256(equal, equal) ? 0 : 1) << k;
    }
    return hits;
}

/* Eight lanes from eight bits. */
static inline __m256i mask_of(int lanes)
{
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(lanes), bits), bits);
}

/* words[base + near], near from 0 to 15. */
static inline __m256i words_near(const uint32_t *words, int base, __m256i near)
{
    const __m256i low = _mm256_loadu_si256((const __m256i *)(const void *)(words + base));
    const __m256i high = _mm256_loadu_si256((const __m256i *)(const void *)(words + base + 8));
    return _mm256_blendv_epi8(_mm256_permutevar8x32_epi32(low, near), _mm256_permutevar8x32_epi32(high, near),
                              _mm256_cmpgt_epi32(near, _mm256_set1_epi32(7)));
}

/* Both words of the cells at the eight indices `at`; lane `first` is the leftmost that matters. */
static inline void cell_words(uint32_t *const cells[2], __m256i at, int first, __m256i *word, __m256i *second)
{
    const __m256i base = _mm256_permutevar8x32_epi32(at, _mm256_set1_epi32(first));
    const __m256i near = _mm256_sub_epi32(at, base);
    const __m256i is_near =
        _mm256_cmpeq_epi32(_mm256_andnot_si256(_mm256_set1_epi32(15), near), _mm256_setzero_si256());

    if (_mm256_movemask_epi8(is_near) == -1) { /* three times as fast as a gather */
        const int begin = _mm_cvtsi128_si32(_mm256_castsi256_si128(base));
        *word = words_near(cells[0], begin, near);
        *second = words_near(cells[1], begin, near);
    } else {
        *word = _mm256_i32gather_epi32((const int *)(const void *)cells[0], at, 4);
        *second = _mm256_i32gather_epi32((const int *)(const void *)cells[1], at, 4);
    }
}

/* Draws columns first .. last of one row; index: of the segment. */
static void draw_row(struct tile_visibility *tv, size_t row, int first, int last, const struct drawn_segment *s,
                     uint32_t index, const struct layer_view *lv, float y, int tile_x)
{
    const __m256 lanes = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7), zero = _mm256_setzero_ps();
    const __m256 one = _mm256_set1_ps(1);
    const __m256 u_step = _mm256_set1_ps(s->u[1]), v_step = _mm256_set1_ps(s->v[1]), w_step = _mm256_set1_ps(s->w[1]);
    const __m256 z_step = _mm256_set1_ps(s->inverse_z[1]);
    const __m256 u_row = _mm256_set1_ps(s->u[0] + y * s->u[2]), v_row = _mm256_set1_ps(s->v[0] + y * s->v[2]);
    const __m256 w_row = _mm256_set1_ps(s->w[0] + y * s->w[2]);
    const __m256 z_row = _mm256_set1_ps(s->inverse_z[0] + y * s->inverse_z[2]);
    const __m256 u0 = _mm256_set1_ps(s->u0), u1 = _mm256_set1_ps(s->u1), v0 = _mm256_set1_ps(s->v0),
                 v1 = _mm256_set1_ps(s->v1);
    const __m256i id = _mm256_set1_epi32((int)s->id), me = _mm256_set1_epi32((int)index);
    const __m256 gap = _mm256_set1_ps(s->surface_gap);
    const __m256i full_bit = _mm256_set1_epi32((int)VISIBLE_FULL);

    for (int x = first; x <= last; x += 8) {
        const size_t at = row + (size_t)(x - tile_x);
        const __m256 dx = _mm256_add_ps(_mm256_set1_ps((float)(x - s->x0)), lanes);
        const __m256 inverse = _mm256_add_ps(z_row, _mm256_mul_ps(dx, z_step));
        const __m256 front = _mm256_loadu_ps(tv->inverse_front + at);
        const __m256 behind = _mm256_loadu_ps(tv->inverse_behind + at);
        const __m256i front_index = _mm256_loadu_si256((const __m256i *)(const void *)(tv->front + at));
        /* nearest: in front of the front; second: behind a front that is not full, another surface, the nearest such */
        const __m256 nearest = _mm256_cmp_ps(inverse, front, _CMP_GT_OQ);
        const __m256 beyond = _mm256_cmp_ps(_mm256_sub_ps(front, inverse), _mm256_mul_ps(front, gap), _CMP_GT_OQ);
        const __m256 second = _mm256_andnot_ps(_mm256_castsi256_ps(front_index),
                                               _mm256_and_ps(beyond, _mm256_cmp_ps(inverse, behind, _CMP_GT_OQ)));
        int wanted = _mm256_movemask_ps(_mm256_or_ps(nearest, second));
        if (last - x < 7) wanted &= (2 << (last - x)) - 1;
        if (!wanted) continue;

        const __m256 w = _mm256_add_ps(w_row, _mm256_mul_ps(dx, w_step));
        const __m256 scale = _mm256_div_ps(one, w);
        const __m256 u = _mm256_mul_ps(_mm256_add_ps(u_row, _mm256_mul_ps(dx, u_step)), scale);
        const __m256 v = _mm256_mul_ps(_mm256_add_ps(v_row, _mm256_mul_ps(dx, v_step)), scale);
        const __m256 inside =
            _mm256_and_ps(_mm256_and_ps(_mm256_cmp_ps(u, u0, _CMP_GE_OQ), _mm256_cmp_ps(u, u1, _CMP_LT_OQ)),
                          _mm256_and_ps(_mm256_cmp_ps(v, v0, _CMP_GE_OQ), _mm256_cmp_ps(v, v1, _CMP_LT_OQ)));
        wanted &= _mm256_movemask_ps(_mm256_and_ps(inside, _mm256_cmp_ps(w, zero, _CMP_GT_OQ)));
        if (!wanted) continue;

        /* lanes outside of the segment read the cell of the leftmost lane inside */
        const int leftmost = __builtin_ctz((unsigned)wanted);
        const __m256i column = _mm256_cvttps_epi32(u), line = _mm256_cvttps_epi32(v);
        const __m256i cell_of = _mm256_add_epi32(column, _mm256_mullo_epi32(line, _mm256_set1_epi32(lv->stride)));
        const __m256i first_cell = _mm256_permutevar8x32_epi32(cell_of, _mm256_set1_epi32(leftmost));
        const __m256i cell = _mm256_blendv_epi8(first_cell, cell_of, _mm256_castps_si256(inside));
        __m256i split, other; /* the cells' words; CELL_SPLIT is the sign of the first */
        cell_words(lv->cells, cell, leftmost, &split, &other);
        const __m256i owner = _mm256_andnot_si256(_mm256_set1_epi32((int)CELL_SPLIT), split);
        const __m256i own = _mm256_or_si256(_mm256_cmpeq_epi32(owner, id), _mm256_cmpeq_epi32(other, id));
        int hits = wanted & _mm256_movemask_ps(_mm256_castsi256_ps(own));
        const int many = wanted & _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_slli_epi32(split, 1)));
        if (many) hits |= many_hits(many, split, lv, id);
        if (!hits) continue;

        const __m256i hit = mask_of(hits);
        const __m256 as_front = _mm256_and_ps(_mm256_castsi256_ps(hit), nearest);
        const __m256 as_second = _mm256_andnot_ps(nearest, _mm256_and_ps(_mm256_castsi256_ps(hit), second));
        const __m256i full = _mm256_andnot_si256(_mm256_srai_epi32(split, 31), full_bit);
        const __m256i behind_index = _mm256_loadu_si256((const __m256i *)(const void *)(tv->behind + at));
        /* the old front becomes the surface behind if it is another surface than the new one */
        const __m256 before = _mm256_cmp_ps(_mm256_sub_ps(inverse, front), _mm256_mul_ps(inverse, gap), _CMP_GT_OQ);
        const __m256 back = _mm256_and_ps(as_front, before);
        __m256 new_behind = _mm256_blendv_ps(behind, front, back);
        __m256 new_behind_index =
            _mm256_blendv_ps(_mm256_castsi256_ps(behind_index), _mm256_castsi256_ps(front_index), back);
        new_behind = _mm256_blendv_ps(new_behind, inverse, as_second);
        new_behind_index =
            _mm256_blendv_ps(new_behind_index, _mm256_castsi256_ps(_mm256_or_si256(me, full)), as_second);
        _mm256_storeu_ps(tv->inverse_behind + at, new_behind);
        _mm256_storeu_ps((float *)(void *)(tv->behind + at), new_behind_index);
        if (!_mm256_movemask_ps(as_front)) continue;
        _mm256_storeu_ps(tv->inverse_front + at, _mm256_blendv_ps(front, inverse, as_front));
        _mm256_storeu_ps((float *)(void *)(tv->front + at),
                         _mm256_blendv_ps(_mm256_castsi256_ps(front_index),
                                          _mm256_castsi256_ps(_mm256_or_si256(me, full)), as_front));
        _mm256_storeu_ps(tv->u + at, _mm256_blendv_ps(_mm256_loadu_ps(tv->u + at), u, as_front));
        _mm256_storeu_ps(tv->v + at, _mm256_blendv_ps(_mm256_loadu_ps(tv->v + at), v, as_front));
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
            const __m256 is = _mm256_cmp_ps(_mm256_loadu_ps(inverse + x), _mm256_setzero_ps(), _CMP_EQ_OQ);
            unsigned bits = (unsigned)_mm256_movemask_ps(is);
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

static inline float alpha_of(__m128 rgba) { return _mm_cvtss_f32(_mm_shuffle_ps(rgba, rgba, 0xFF)); }

/* Bilinear look-up of the photo in the cell that begins at texel `at`. */
static inline __m128 photo_texel(const struct layer_view *lv, int at, float fu, float fv)
{
    const uint16_t(*t)[4] = (const uint16_t(*)[4])lv->photo + at;
    const __m256 top = _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)t));
    const __m256 bottom = _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)(t + lv->stride)));
    const __m256 mean = _mm256_add_ps(top, _mm256_mul_ps(_mm256_sub_ps(bottom, top), _mm256_set1_ps(fv)));
    const __m128 left = _mm256_castps256_ps128(mean), right = _mm256_extractf128_ps(mean, 1);
    return _mm_add_ps(left, _mm_mul_ps(_mm_sub_ps(right, left), _mm_set1_ps(fu)));
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
static __m128 photo_cubic(const struct layer_view *lv, int at, float fu, float fv)
{
    float wu[4], wv[4];
    __m128 sum = _mm_setzero_ps();

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
        __m128 row = _mm_setzero_ps();
        for (int x = 0; x < 4; x++) {
            const __m128 texel = _mm_cvtph_ps(_mm_loadl_epi64((const __m128i *)(const void *)t[x]));
            row = _mm_add_ps(row, _mm_mul_ps(_mm_set1_ps(wu[x]), texel));
        }
        sum = _mm_add_ps(sum, _mm_mul_ps(_mm_set1_ps(wv[y]), row));
    }
    return _mm_max_ps(sum, _mm_setzero_ps());
}

/* Bilinear look-up in a reduced photo, at (u, v) of the padded texels of the photo itself. Texels without depth and
 * beyond the border do not count. */
static __m128 reduced_texel(const struct layer_view *lv, int level, float u, float v)
{
    const struct photo_level *from = &lv->reduced[level - 1];
    const float part = 1 / (float)(1 << level), x = (u - 0.5f) * part + 0.5f, y = (v - 0.5f) * part + 0.5f;
    const int i = (int)x, j = (int)y;
    const float fx = x - (float)i, fy = y - (float)j;
    const uint16_t(*t)[4] = (const uint16_t(*)[4])from->texels + (size_t)j * (size_t)from->stride + i;
    const __m256 top = _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)t));
    const __m256 bottom = _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)(t + from->stride)));
    const __m256 mean = _mm256_add_ps(top, _mm256_mul_ps(_mm256_sub_ps(bottom, top), _mm256_set1_ps(fy)));
    const __m128 left = _mm256_castps256_ps128(mean), right = _mm256_extractf128_ps(mean, 1);
    const __m128 sum = _mm_add_ps(left, _mm_mul_ps(_mm_sub_ps(right, left), _mm_set1_ps(fx)));
    const float alpha = alpha_of(sum);
    return alpha > 0 ? _mm_div_ps(sum, _mm_set1_ps(alpha)) : sum;
}

/* The photo between two levels; `sharp` is the photo itself there. */
static __m128 photo_between(const struct layer_view *lv, float level, float u, float v, __m128 sharp)
{
    const int below = (int)level < lv->reduced_count ? (int)level : lv->reduced_count - 1;
    const __m128 fine = below ? reduced_texel(lv, below, u, v) : sharp, coarse = reduced_texel(lv, below + 1, u, v);
    return _mm_add_ps(fine, _mm_mul_ps(_mm_sub_ps(coarse, fine), _mm_set1_ps(level - (float)below)));
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
                           int pixels, __m256i segment, const float *u, const float *v)
{
    int index[8], known = -1;
    float level = 0;

    _mm256_storeu_si256((__m256i *)(void *)index, segment);
    for (; pixels; pixels &= pixels - 1) {
        const int k = __builtin_ctz((unsigned)pixels);
        if (index[k] != known) level = photo_level(&dt->segments[known = index[k]], lv->reduced_count);
        if (!(level > 0)) continue;
        _mm_storeu_ps(s->rgba[i + (size_t)k],
                      photo_between(lv, level, u[k], v[k], _mm_loadu_ps(s->rgba[i + (size_t)k])));
    }
}

static __m128 photo_at(const struct layer_view *lv, float u, float v)
{
    const int i = (int)u, j = (int)v;
    return photo_texel(lv, j * lv->stride + i, u - (float)i, v - (float)j);
}

/* Mask of the layers of a texel whose id is one of `ids`; eight lanes: 0..3 interior, 4..7 boundary. */
static inline __m256 layers_of(const struct texel *t, const uint32_t *ids, int count)
{
    const __m256i spread = _mm256_set_epi32(1, 1, 1, 1, 0, 0, 0, 0);
    const __m128i id_bits = _mm_set1_epi32((int)~TEXEL_JOINED);
    const __m128i own = _mm_and_si128(_mm_loadl_epi64((const __m128i *)(const void *)t->id), id_bits);
    __m128i found = _mm_setzero_si128();
    for (int i = 0; i < count; i++) found = _mm_or_si128(found, _mm_cmpeq_epi32(own, _mm_set1_epi32((int)ids[i])));
    return _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(_mm256_castsi128_si256(found), spread));
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
static __m128 surface_at(const struct layer_view *lv, uint32_t id, float u, float v)
{
    struct split_cell c;
    __m256 sum = _mm256_setzero_ps();

    split_cell_at(&c, lv, id, u, v);
    for (int k = 0; k < 4; k++) {
        const __m256 w = _mm256_and_ps(layers_of(c.texel[k], c.ids, c.count), _mm256_set1_ps(c.weight[k]));
        const __m256 color = _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)c.texel[k]->rgba));
        sum = _mm256_add_ps(sum, _mm256_mul_ps(w, color));
    }
    return _mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1));
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
            if (found) sum[l] += c.weight[k] * _cvtsh_ss(c.texel[k]->rgba[l][3]);
        }
    return sum[0] + sum[1];
}

/* Fade towards the picture's border at texel positions (u, v): 0 at the border, 1 from BORDER on. */
static inline __m256 inside8(const struct layer_view *lv, __m256 u, __m256 v)
{
    const float across = (float)(lv->width > lv->height ? lv->width : lv->height) * BORDER;
    const __m256 half = _mm256_set1_ps(0.5f);
    const __m256 x = _mm256_min_ps(_mm256_sub_ps(u, half), _mm256_sub_ps(_mm256_set1_ps((float)lv->width + 0.5f), u));
    const __m256 y = _mm256_min_ps(_mm256_sub_ps(v, half), _mm256_sub_ps(_mm256_set1_ps((float)lv->height + 0.5f), v));
    const __m256 part =
        _mm256_mul_ps(_mm256_max_ps(_mm256_setzero_ps(), _mm256_min_ps(x, y)), _mm256_set1_ps(1 / across));
    return _mm256_min_ps(_mm256_set1_ps(1), part);
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
static __m128 behind_at(const struct drawn_segment *b, bool full, const struct layer_view *lv, int x, int y)
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
    __m128 sum = surface_at(lv, dt->segments[tv->front[i]].id, tv->u[i], tv->v[i]);
    const float alpha = alpha_of(sum);

    if (index != VISIBLE_NONE && alpha < 1) {
        const uint32_t at = index & ~VISIBLE_FULL;
        const __m128 back = behind_at(&dt->segments[at], index & VISIBLE_FULL, lv, x, y);
        const float back_alpha = alpha_of(back), weight = back_alpha < 1 - alpha ? back_alpha : 1 - alpha;
        const __m128 rest = weight > 0 ? _mm_mul_ps(back, _mm_set1_ps(weight / back_alpha)) : _mm_setzero_ps();
        struct view_samples *to = behind ? behind : s;
        if (behind) {
            _mm_storeu_ps(behind->rgba[i], rest);
            behind->alpha[i] = weight > 0 ? weight : 0;
        } else
            sum = _mm_add_ps(sum, rest);
        if (behind || weight > alpha) { /* depth of the dominant surface, never a mean across a depth jump */
            to->z[i] = 1 / tv->inverse_behind[i];
            to->sigma[i] = dt->sigmas[at];
        }
    }
    _mm_storeu_ps(s->rgba[i], sum);
    s->alpha[i] = alpha_of(sum);
}

static void sample_nothing(struct view_samples *s, size_t i)
{
    _mm_storeu_ps(s->rgba[i], _mm_setzero_ps());
    s->alpha[i] = s->z[i] = s->sigma[i] = s->inside[i] = 0;
}

void visibility_sample8(struct view_samples *s, struct view_samples *behind, const struct tile_visibility *tv,
                        const struct drawn_tile *dt, const struct layer_view *lv, size_t i, int tile_x, int tile_y)
{
    const __m256i index = _mm256_loadu_si256((const __m256i *)(const void *)(tv->front + i));
    const __m256i none = _mm256_cmpeq_epi32(index, _mm256_set1_epi32(-1));
    const int empty = _mm256_movemask_ps(_mm256_castsi256_ps(none));
    const int full = _mm256_movemask_ps(_mm256_castsi256_ps(index)) & ~empty;
    const __m256 present = _mm256_castsi256_ps(_mm256_xor_si256(none, _mm256_set1_epi32(-1)));
    const __m256 u = _mm256_and_ps(present, _mm256_loadu_ps(tv->u + i)),
                 v = _mm256_and_ps(present, _mm256_loadu_ps(tv->v + i));
    const __m256i segment = _mm256_andnot_si256(none, _mm256_and_si256(index, _mm256_set1_epi32((int)~VISIBLE_FULL)));

    if (behind) _mm256_storeu_ps(behind->alpha + i, _mm256_setzero_ps());
    if (empty == 0xFF) {
        for (size_t k = i; k < i + 8; k++) sample_nothing(s, k);
        return;
    }
    _mm256_storeu_ps(s->z + i, _mm256_div_ps(_mm256_set1_ps(1), _mm256_loadu_ps(tv->inverse_front + i)));
    _mm256_storeu_ps(s->sigma + i, _mm256_i32gather_ps(dt->sigmas, segment, 4));
    _mm256_storeu_ps(s->inside + i, inside8(lv, u, v));
    _mm256_storeu_ps(s->alpha + i, _mm256_set1_ps(1));

    const __m256i column = _mm256_cvttps_epi32(u), line = _mm256_cvttps_epi32(v);
    float fu[8], fv[8];
    int at[8];
    _mm256_storeu_ps(fu, _mm256_sub_ps(u, _mm256_cvtepi32_ps(column)));
    _mm256_storeu_ps(fv, _mm256_sub_ps(v, _mm256_cvtepi32_ps(line)));
    _mm256_storeu_si256((__m256i *)at,
                        _mm256_add_epi32(column, _mm256_mullo_epi32(line, _mm256_set1_epi32(lv->stride))));
    if (behind)
        for (int k = 0; k < 8; k++) _mm_storeu_ps(s->rgba[i + (size_t)k], photo_cubic(lv, at[k], fu[k], fv[k]));
    else
        for (int k = 0; k < 8; k++) _mm_storeu_ps(s->rgba[i + (size_t)k], photo_texel(lv, at[k], fu[k], fv[k]));
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
    const __m256i index = _mm256_loadu_si256((const __m256i *)(const void *)(tv->front + i));
    const __m256i none = _mm256_cmpeq_epi32(index, _mm256_set1_epi32(-1));
    const int empty = _mm256_movemask_ps(_mm256_castsi256_ps(none));
    const int full = _mm256_movemask_ps(_mm256_castsi256_ps(index)) & ~empty;
    const __m256i segment = _mm256_andnot_si256(none, _mm256_and_si256(index, _mm256_set1_epi32((int)~VISIBLE_FULL)));
    const __m256 clear = _mm256_castsi256_ps(none);

    if (empty == 0xFF) {
        _mm256_storeu_ps(s->z + i, _mm256_setzero_ps());
        _mm256_storeu_ps(s->sigma + i, _mm256_setzero_ps());
        _mm256_storeu_ps(s->alpha + i, _mm256_setzero_ps());
        return;
    }
    const __m256 one = _mm256_set1_ps(1);
    _mm256_storeu_ps(s->z + i, _mm256_andnot_ps(clear, _mm256_div_ps(one, _mm256_loadu_ps(tv->inverse_front + i))));
    _mm256_storeu_ps(s->sigma + i, _mm256_andnot_ps(clear, _mm256_i32gather_ps(dt->sigmas, segment, 4)));
    _mm256_storeu_ps(s->alpha + i, _mm256_andnot_ps(clear, one));
    for (int lanes = ~(full | empty) & 0xFF; lanes; lanes &= lanes - 1) {
        const size_t p = i + (size_t)__builtin_ctz((unsigned)lanes);
        cover_split(s, tv, dt, lv, p, tile_x + (int)(p % TILE_STRIDE), tile_y + (int)(p / TILE_STRIDE));
    }
}
