/* drawn_view.c - a view's segments in a novel camera, projected where and when a tile needs them.
 *
 * A view has tens of thousands of segments, but a tile few hundred, and most tiles few views. So a view is prepared in
 * two steps. Once per frame its groups of eight neighbouring segments (layer_view.h) are sorted into tiles by a bound
 * of their pixels. Then each tile that draws the view projects the segments of its groups, into
 * memory that stays in the cache, and keeps those in the part of the tile that is still open. A segment that several
 * tiles show is projected for each of them, two to three times on average.
 *
 * Bounds. With the names of segment_project.c, a point of the view's pixel (u, v) and inverse depth q is, in the novel
 * camera, (x, y, w) = M' (u, v, 1) + k' q. A group fills a box of (u, v, q) at most. Where w > 0 the map keeps convex
 * sets, so the pixels of the box are within the bounding box of its eight projected corners. A group whose w is
 * negative in all corners is behind the camera; one with both signs, or too near to 0 for rounding, may be everywhere.
 * Four groups are bounded at once.
 *
 * Segments are projected four at a time with exactly the operations of segment_project() in their order, so the bits
 * are the same; a segment that must be clipped is projected by that function. */
#include "common/layers/drawn_view.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAFE_RATIO   1e-3 /* min w in all corners of a box that is bounded by its corners */
#define HIDDEN_RATIO 5e-7 /* max w in all corners of a box that is not visible; below PROJECT_MIN_RATIO */
#define MAX_SHIFT    1e9  /* px: larger |k' q| loses too many digits for bounds */
#define LANES        4

/* Room for `count` items; the old contents are lost. */
static enum status reserve(void *buffer, size_t *capacity, size_t count, size_t size, struct err *err)
{
    void **at = buffer;
    if (count <= *capacity) return ST_OK;
    free(*at);
    *at = malloc((count + count / 4) * size);
    *capacity = *at ? count + count / 4 : 0;
    return *at ? ST_OK : err_nomem(err, "a view's segments in a frame", count * size);
}

/* ---------------------------------------------------------------------------------------------- bounds of groups */

static inline __m256d all4(double x) { return _mm256_set1_pd(x); }

/* min and max over the sums of one term of each pair */
static inline __m256d low_sum(const __m256d a[2], const __m256d b[2], const __m256d c[2])
{
    return _mm256_add_pd(_mm256_add_pd(_mm256_min_pd(a[0], a[1]), _mm256_min_pd(b[0], b[1])),
                         _mm256_min_pd(c[0], c[1]));
}

static inline __m256d high_sum(const __m256d a[2], const __m256d b[2], const __m256d c[2])
{
    return _mm256_add_pd(_mm256_add_pd(_mm256_max_pd(a[0], a[1]), _mm256_max_pd(b[0], b[1])),
                         _mm256_max_pd(c[0], c[1]));
}

/* Boxes that hold the pixels of four groups. Returns the lanes of those that may have pixels. */
static int bound_pixels(struct pixel_box boxes[LANES], const struct view_relation *r, const struct group_bounds *b)
{
    const __m256d zero = _mm256_setzero_pd(), one = all4(1);
    const __m256d u[2] = {_mm256_loadu_pd(b->u0), _mm256_loadu_pd(b->u1)};
    const __m256d v[2] = {_mm256_loadu_pd(b->v0), _mm256_loadu_pd(b->v1)};
    const __m256d q[2] = {_mm256_loadu_pd(b->low_inverse), _mm256_loadu_pd(b->high_inverse)};
    const double shift = fmax(fmax(fabs(r->inverse_k[0]), fabs(r->inverse_k[1])), fabs(r->inverse_k[2]));
    const __m256d exact = _mm256_cmp_pd(q[1], all4(fmin(MAX_SHIFT / shift, 1e300)), _CMP_LE_OQ);
    __m256d by_u[3][2], by_v[3][2], by_q[3][2];

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            by_u[i][k] = _mm256_mul_pd(all4(r->inverse_m[i][0]), u[k]);
            by_v[i][k] = _mm256_add_pd(_mm256_mul_pd(all4(r->inverse_m[i][1]), v[k]), all4(r->inverse_m[i][2]));
            by_q[i][k] = _mm256_mul_pd(all4(r->inverse_k[i]), q[k]);
        }
    const __m256d min_w = low_sum(by_u[2], by_v[2], by_q[2]), max_w = high_sum(by_u[2], by_v[2], by_q[2]);
    const __m256d safe = _mm256_and_pd(exact, _mm256_cmp_pd(min_w, all4(SAFE_RATIO), _CMP_GE_OQ));
    const __m256d hidden = _mm256_and_pd(exact, _mm256_cmp_pd(max_w, all4(HIDDEN_RATIO), _CMP_LE_OQ));
    const __m256d seen = _mm256_andnot_pd(hidden, _mm256_cmp_pd(q[1], zero, _CMP_GT_OQ));
    int lanes = _mm256_movemask_pd(seen);
    if (!lanes) return 0;

    __m256d x0 = all4(INFINITY), y0 = x0, x1 = all4(-INFINITY), y1 = x1;
    for (int corner = 0; corner < 8; corner++) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const __m256d w = _mm256_div_pd(one, _mm256_add_pd(_mm256_add_pd(by_u[2][i], by_v[2][j]), by_q[2][k]));
        const __m256d x = _mm256_mul_pd(_mm256_add_pd(_mm256_add_pd(by_u[0][i], by_v[0][j]), by_q[0][k]), w);
        const __m256d y = _mm256_mul_pd(_mm256_add_pd(_mm256_add_pd(by_u[1][i], by_v[1][j]), by_q[1][k]), w);
        x0 = _mm256_min_pd(x, x0);
        x1 = _mm256_max_pd(x, x1);
        y0 = _mm256_min_pd(y, y0);
        y1 = _mm256_max_pd(y, y1);
    }
    /* a pixel more on each side: for rounding, and PROJECT_SLACK */
    const __m256d right = all4(r->width - 1), bottom = all4(r->height - 1);
    x0 = _mm256_and_pd(safe, _mm256_max_pd(_mm256_sub_pd(_mm256_floor_pd(x0), one), zero));
    y0 = _mm256_and_pd(safe, _mm256_max_pd(_mm256_sub_pd(_mm256_floor_pd(y0), one), zero));
    x1 = _mm256_blendv_pd(right, _mm256_min_pd(_mm256_ceil_pd(x1), right), safe);
    y1 = _mm256_blendv_pd(bottom, _mm256_min_pd(_mm256_ceil_pd(y1), bottom), safe);
    const __m256d within =
        _mm256_and_pd(_mm256_and_pd(_mm256_cmp_pd(x0, right, _CMP_LE_OQ), _mm256_cmp_pd(y0, bottom, _CMP_LE_OQ)),
                      _mm256_and_pd(_mm256_cmp_pd(x1, zero, _CMP_GE_OQ), _mm256_cmp_pd(y1, zero, _CMP_GE_OQ)));
    lanes &= _mm256_movemask_pd(within);
    int box[4][LANES];
    _mm_storeu_si128((__m128i *)(void *)box[0], _mm256_cvttpd_epi32(x0));
    _mm_storeu_si128((__m128i *)(void *)box[1], _mm256_cvttpd_epi32(y0));
    _mm_storeu_si128((__m128i *)(void *)box[2], _mm256_cvttpd_epi32(x1));
    _mm_storeu_si128((__m128i *)(void *)box[3], _mm256_cvttpd_epi32(y1));
    for (int k = 0; k < LANES; k++) {
        boxes[k] = (struct pixel_box){box[0][k], box[1][k], box[2][k], box[3][k]};
        if (!(lanes >> k & 1)) boxes[k] = (struct pixel_box){0, 0, -1, -1};
    }
    return lanes;
}

/* Bounds all groups and counts those of each tile. Returns the number of entries in all tiles' lists. */
static size_t bound_groups(struct drawn_view *dv, uint32_t *counts)
{
    const struct layer_view *lv = dv->lv;
    const int blocks = (lv->group_count + BOUNDS_GROUPS - 1) / BOUNDS_GROUPS;
    size_t entries = 0;

    for (int block = 0; block < blocks; block++) {
        struct pixel_box *boxes = &dv->boxes[block * BOUNDS_GROUPS];
        const int lanes = bound_pixels(boxes, &dv->relation, &lv->bounds[block]);
        for (int k = 0; k < BOUNDS_GROUPS; k++) {
            const struct pixel_box b = lanes ? boxes[k] : (boxes[k] = (struct pixel_box){0, 0, -1, -1});
            if (b.x1 < b.x0) continue;
            for (int ty = b.y0 / TILE_HEIGHT; ty <= b.y1 / TILE_HEIGHT; ty++)
                for (int tx = b.x0 / TILE_WIDTH; tx <= b.x1 / TILE_WIDTH; tx++) {
                    counts[ty * dv->tiles_x + tx]++;
                    entries++;
                }
        }
    }
    return entries;
}

enum status drawn_view_prepare(struct drawn_view *dv, const struct layered_depth *depth, const struct layer_view *lv,
                               const struct view *view, const struct view *novel, struct err *err)
{
    const int tiles_x = (novel->width + TILE_WIDTH - 1) / TILE_WIDTH;
    const int tiles_y = (novel->height + TILE_HEIGHT - 1) / TILE_HEIGHT;
    const int blocks = (lv->group_count + BOUNDS_GROUPS - 1) / BOUNDS_GROUPS;
    struct pixel_box all[LANES];

    if (reserve(&dv->tile_begin, &dv->tile_capacity, (size_t)tiles_x * (size_t)tiles_y + 2, sizeof *dv->tile_begin,
                err))
        return ST_NOMEM;
    dv->depth = depth;
    dv->lv = lv;
    dv->tiles_x = tiles_x;
    dv->tile_count = tiles_x * tiles_y;
    for (int t = 0; t <= dv->tile_count + 1; t++) dv->tile_begin[t] = 0;
    segment_relation_make(&dv->relation, view, novel);
    if (!(bound_pixels(all, &dv->relation, &lv->bounds[blocks]) & 1)) return ST_OK;

    if (reserve(&dv->boxes, &dv->box_capacity, (size_t)blocks * BOUNDS_GROUPS, sizeof *dv->boxes, err)) return ST_NOMEM;
    uint32_t *begins = dv->tile_begin + 1; /* counting sort: tile t at t + 1 until the lists are filled */
    const size_t entries = bound_groups(dv, begins);
    if (reserve(&dv->tile_groups, &dv->list_capacity, entries + 1, sizeof *dv->tile_groups, err)) {
        for (int t = 0; t <= dv->tile_count + 1; t++) dv->tile_begin[t] = 0;
        return ST_NOMEM;
    }
    uint32_t sum = 0; /* begins[t]: from the count of tile t to its first entry */
    for (int t = 0; t < dv->tile_count; t++) {
        const uint32_t count = begins[t];
        begins[t] = sum;
        sum += count;
    }
    for (int i = 0; i < lv->group_count; i++) {
        const struct pixel_box *b = &dv->boxes[i];
        if (b->x1 < b->x0) continue;
        for (int ty = b->y0 / TILE_HEIGHT; ty <= b->y1 / TILE_HEIGHT; ty++)
            for (int tx = b->x0 / TILE_WIDTH; tx <= b->x1 / TILE_WIDTH; tx++)
                dv->tile_groups[begins[ty * tiles_x + tx]++] =
                    (uint32_t)i; /* begins[t] ends at tile t + 1's first entry */
    }
    return ST_OK;
}

void drawn_view_release(struct drawn_view *dv)
{
    if (!dv) return;
    free(dv->boxes);
    free(dv->tile_begin);
    free(dv->tile_groups);
    *dv = (struct drawn_view){0};
}

/* ---------------------------------------------------------------------------------------------- segments of a tile */

/* Linear form row . (x, y, 1), relative to (x, y). */
static void form_at(float form[3], const double row[3], double x, double y)
{
    form[0] = (float)(row[0] * x + row[1] * y + row[2]);
    form[1] = (float)row[0];
    form[2] = (float)row[1];
}

static void drawn_segment_make(struct drawn_segment *s, const struct projected_segment *p, uint32_t id,
                               float surface_gap)
{
    const double x = p->x0 + 0.5, y = p->y0 + 0.5;
    *s = (struct drawn_segment){.u0 = (float)p->u0, .v0 = (float)p->v0, .u1 = (float)p->u1, .v1 = (float)p->v1};
    s->id = id;
    s->surface_gap = surface_gap;
    s->x0 = p->x0;
    s->y0 = p->y0;
    s->x1 = p->x1;
    s->y1 = p->y1;
    form_at(s->u, p->from_target[0], x, y);
    form_at(s->v, p->from_target[1], x, y);
    form_at(s->w, p->from_target[2], x, y);
    form_at(s->inverse_z, p->inverse_z, x, y);
}

struct four_segments { /* half of a group, seen by the novel camera */
    __m256d plane[3], to_target[3][3], facing;
    __m128i x0, y0, x1, y1;
    int visible, clipped; /* lanes: with open pixels; to be projected alone */
};

static inline __m256d row_at(const __m256d row[3], __m256d x, __m256d y)
{
    return _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(row[0], x), _mm256_mul_pd(row[1], y)), row[2]);
}

/* First pixel whose centre is at or beyond `x`; 0 at least. */
static inline __m128i first_pixel(__m256d x)
{
    const __m256d half = all4(0.5), slack = all4(PROJECT_SLACK);
    const __m256d is = _mm256_cmp_pd(x, all4(0.5 + PROJECT_SLACK), _CMP_GT_OQ);
    return _mm256_cvttpd_epi32(_mm256_and_pd(is, _mm256_ceil_pd(_mm256_sub_pd(_mm256_sub_pd(x, half), slack))));
}

/* Last pixel whose centre is at or before `x`; `last` at most. */
static inline __m128i last_pixel(__m256d x, int last)
{
    const __m256d end = _mm256_add_pd(_mm256_sub_pd(x, all4(0.5)), all4(PROJECT_SLACK));
    const __m256d is = _mm256_cmp_pd(end, all4(last), _CMP_LT_OQ);
    return _mm256_cvttpd_epi32(_mm256_blendv_pd(all4(last), _mm256_floor_pd(end), is));
}

static inline __m256d corner_of(const float *values) { return _mm256_cvtps_pd(_mm_loadu_ps(values)); }

/* Bounds the pixels of segments first .. first + 3 of a group, as target_rectangle() of segment_project.c does. */
static void bound_segments(struct four_segments *f, const struct view_relation *r, const struct segment_group *g,
                           int first, const struct open_pixels *open)
{
    const __m256d zero = _mm256_setzero_pd(), one = all4(1), min_ratio = all4(PROJECT_MIN_RATIO);
    const __m256d u0 = corner_of(g->u0 + first), v0 = corner_of(g->v0 + first);
    const __m256d u1 = corner_of(g->u1 + first), v1 = corner_of(g->v1 + first);
    const __m256d us[4] = {u0, u1, u1, u0}, vs[4] = {v0, v0, v1, v1};
    const __m256d inverse = _mm256_loadu_pd(g->inverse_z + first), least = _mm256_mul_pd(min_ratio, inverse);
    __m256d x0 = all4(INFINITY), y0 = x0, x1 = all4(-INFINITY), y1 = x1;
    const __m256d *p = f->plane;

    for (int i = 0; i < 3; i++) f->plane[i] = _mm256_loadu_pd(g->plane[i] + first);
    f->facing = _mm256_sub_pd(
        one, _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(p[0], all4(r->k[0])), _mm256_mul_pd(p[1], all4(r->k[1]))),
                           _mm256_mul_pd(p[2], all4(r->k[2]))));
    __m256d seen = _mm256_and_pd(_mm256_cmp_pd(f->facing, all4(PROJECT_MIN_FACING), _CMP_GT_OQ),
                                 _mm256_cmp_pd(inverse, zero, _CMP_GT_OQ));
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            f->to_target[i][c] = _mm256_add_pd(all4(r->inverse_m[i][c]), _mm256_mul_pd(all4(r->inverse_k[i]), p[c]));
    __m256d inside = seen;
    for (int i = 0; i < 4; i++) {
        const __m256d ratio = row_at(f->to_target[2], us[i], vs[i]), w = _mm256_div_pd(one, ratio);
        const __m256d x = _mm256_mul_pd(row_at(f->to_target[0], us[i], vs[i]), w);
        const __m256d y = _mm256_mul_pd(row_at(f->to_target[1], us[i], vs[i]), w);
        inside = _mm256_and_pd(inside, _mm256_and_pd(_mm256_cmp_pd(row_at(p, us[i], vs[i]), least, _CMP_GE_OQ),
                                                     _mm256_cmp_pd(ratio, min_ratio, _CMP_GE_OQ)));
        x0 = _mm256_min_pd(x, x0);
        x1 = _mm256_max_pd(x, x1);
        y0 = _mm256_min_pd(y, y0);
        y1 = _mm256_max_pd(y, y1);
    }
    f->clipped = _mm256_movemask_pd(_mm256_andnot_pd(inside, seen));
    const __m256d within = _mm256_and_pd(
        _mm256_and_pd(_mm256_cmp_pd(x1, zero, _CMP_GT_OQ), _mm256_cmp_pd(y1, zero, _CMP_GT_OQ)),
        _mm256_and_pd(_mm256_cmp_pd(x0, all4(r->width), _CMP_LT_OQ), _mm256_cmp_pd(y0, all4(r->height), _CMP_LT_OQ)));
    f->x0 = first_pixel(x0);
    f->y0 = first_pixel(y0);
    f->x1 = last_pixel(x1, r->width - 1);
    f->y1 = last_pixel(y1, r->height - 1);
    const __m128i left = _mm_max_epi32(f->x0, _mm_set1_epi32(open->box.x0)),
                  right = _mm_min_epi32(f->x1, _mm_set1_epi32(open->box.x1)),
                  top = _mm_max_epi32(f->y0, _mm_set1_epi32(open->box.y0)),
                  bottom = _mm_min_epi32(f->y1, _mm_set1_epi32(open->box.y1));
    const __m128i empty = _mm_or_si128(_mm_cmpgt_epi32(left, right), _mm_cmpgt_epi32(top, bottom));
    int lanes = _mm256_movemask_pd(_mm256_and_pd(inside, within)) & ~_mm_movemask_ps(_mm_castsi128_ps(empty));
    f->visible = 0;
    if (!lanes) return;
    int box[4][LANES];
    _mm_storeu_si128((__m128i *)(void *)box[0], left);
    _mm_storeu_si128((__m128i *)(void *)box[1], top);
    _mm_storeu_si128((__m128i *)(void *)box[2], right);
    _mm_storeu_si128((__m128i *)(void *)box[3], bottom);
    for (; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz((unsigned)lanes);
        f->visible |= open_pixels_any(open, box[0][k], box[1][k], box[2][k], box[3][k]) << k;
    }
}

/* The forms of four segments at the centres of their first pixels: `forms` has their values and slopes, in the order of
 * struct drawn_segment. */
static void make_forms(__m128 forms[12], const struct four_segments *f, const struct view_relation *r)
{
    const __m256d half = all4(0.5);
    const __m256d x = _mm256_add_pd(_mm256_cvtepi32_pd(f->x0), half),
                  y = _mm256_add_pd(_mm256_cvtepi32_pd(f->y0), half);
    __m256d rows[4][3]; /* of u, v, w and 1/z */

    for (int i = 0; i < 3; i++)
        rows[3][i] = _mm256_div_pd(_mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(all4(r->m[0][i]), f->plane[0]),
                                                               _mm256_mul_pd(all4(r->m[1][i]), f->plane[1])),
                                                 _mm256_mul_pd(all4(r->m[2][i]), f->plane[2])),
                                   f->facing);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            rows[i][c] = _mm256_add_pd(all4(r->m[i][c]), _mm256_mul_pd(all4(r->k[i]), rows[3][c]));
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++) rows[i][c] = _mm256_add_pd(rows[i][c], _mm256_mul_pd(half, rows[2][c]));
    for (int i = 0; i < 4; i++) {
        forms[3 * i] = _mm256_cvtpd_ps(row_at(rows[i], x, y));
        forms[3 * i + 1] = _mm256_cvtpd_ps(rows[i][0]);
        forms[3 * i + 2] = _mm256_cvtpd_ps(rows[i][1]);
    }
}

/* Writes four vectors of four segments as four values of each segment, at `to`, `stride` bytes apart. */
static inline void store_transposed(void *to, size_t stride, __m128 a, __m128 b, __m128 c, __m128 d)
{
    char *at = to;
    _MM_TRANSPOSE4_PS(a, b, c, d);
    _mm_storeu_ps((float *)(void *)at, a);
    _mm_storeu_ps((float *)(void *)(at + stride), b);
    _mm_storeu_ps((float *)(void *)(at + 2 * stride), c);
    _mm_storeu_ps((float *)(void *)(at + 3 * stride), d);
}

/* Makes segments first .. first + 3 of a group; those that are not visible too. */
static void make_segments(struct drawn_segment s[LANES], const struct four_segments *f, const struct view_relation *r,
                          const struct segment_group *g, int first)
{
    const __m128 half = _mm_set1_ps(0.5f);
    __m128 forms[12];

    make_forms(forms, f, r);
    store_transposed(&s->u[0], sizeof *s, forms[0], forms[1], forms[2], forms[3]);
    store_transposed(&s->v[1], sizeof *s, forms[4], forms[5], forms[6], forms[7]);
    store_transposed(&s->w[2], sizeof *s, forms[8], forms[9], forms[10], forms[11]);
    store_transposed(&s->u0, sizeof *s, _mm_add_ps(_mm_loadu_ps(g->u0 + first), half),
                     _mm_add_ps(_mm_loadu_ps(g->v0 + first), half), _mm_add_ps(_mm_loadu_ps(g->u1 + first), half),
                     _mm_add_ps(_mm_loadu_ps(g->v1 + first), half));
    store_transposed(&s->x0, sizeof *s, _mm_castsi128_ps(f->x0), _mm_castsi128_ps(f->y0), _mm_castsi128_ps(f->x1),
                     _mm_castsi128_ps(f->y1));
    for (int k = 0; k < LANES; k++) {
        s[k].surface_gap = g->surface_gap[first + k];
        s[k].id = g->index[first + k] + 1;
    }
}

/* Adds those of segments first .. first + 3 of group `at` that may be in open pixels. t has room for all. */
static void add_segments(struct drawn_tile *t, const struct drawn_view *dv, const struct segment_group *g, int first,
                         const struct open_pixels *open)
{
    struct drawn_segment four[LANES];
    struct four_segments f;

    bound_segments(&f, &dv->relation, g, first, open);
    if (!(f.visible | f.clipped)) return;
    if (f.visible) make_segments(four, &f, &dv->relation, g, first);
    for (int lanes = f.visible | f.clipped; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz((unsigned)lanes);
        const uint32_t index = g->index[first + k];
        struct projected_segment p;
        if (f.visible >> k & 1) {
            t->segments[t->count] = four[k];
        } else {
            if (!segment_project(&p, &dv->relation, &dv->depth->segments[index], &dv->lv->shapes[index]) ||
                !open_pixels_any(open, p.x0, p.y0, p.x1, p.y1))
                continue;
            drawn_segment_make(&t->segments[t->count], &p, index + 1, g->surface_gap[first + k]);
        }
        t->marks[index / 64] |= (uint64_t)1 << index % 64;
        t->places[index] = (uint32_t)t->count;
        t->sigmas[t->count++] = g->sigma[first + k];
    }
}

/* Sorts the segments by their place in the depth map's list, and clears the marks. */
static void find_order(struct drawn_tile *t, size_t words)
{
    int n = 0;
    for (size_t i = 0; n < t->count && i < words; i++) {
        for (uint64_t bits = t->marks[i]; bits; bits &= bits - 1)
            t->order[n++] = t->places[64 * i + (size_t)__builtin_ctzll(bits)];
        t->marks[i] = 0;
    }
}

/* Room for `most` segments of `count`. */
static enum status reserve_tile(struct drawn_tile *t, size_t most, size_t count, struct err *err)
{
    const size_t words = count / 64 + 1, marked = t->mark_capacity;
    if (reserve(&t->segments, &t->segment_capacity, most + 1, sizeof *t->segments, err) ||
        reserve(&t->sigmas, &t->sigma_capacity, most + 1, sizeof *t->sigmas, err) ||
        reserve(&t->order, &t->order_capacity, most + 1, sizeof *t->order, err) ||
        reserve(&t->places, &t->place_capacity, count + 1, sizeof *t->places, err) ||
        reserve(&t->marks, &t->mark_capacity, words, sizeof *t->marks, err))
        return ST_NOMEM;
    if (t->mark_capacity != marked) memset(t->marks, 0, t->mark_capacity * sizeof *t->marks);
    return ST_OK;
}

enum status drawn_tile_project(struct drawn_tile *t, const struct drawn_view *dv, int tile,
                               const struct open_pixels *open, struct err *err)
{
    const uint32_t begin = dv->tile_begin[tile], end = dv->tile_begin[tile + 1];
    const size_t count = (size_t)dv->depth->segment_count;

    t->count = 0;
    if (reserve_tile(t, (size_t)(end - begin) * GROUP_SEGMENTS, count, err)) return ST_NOMEM;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t at = dv->tile_groups[i];
        const struct pixel_box *b = &dv->boxes[at];
        if (!open_pixels_any(open, b->x0, b->y0, b->x1, b->y1)) continue;
        for (int first = 0; first < GROUP_SEGMENTS; first += LANES)
            add_segments(t, dv, &dv->lv->groups[at], first, open);
    }
    find_order(t, count / 64 + 1);
    return ST_OK;
}

void drawn_tile_release(struct drawn_tile *t)
{
    if (!t) return;
    free(t->segments);
    free(t->sigmas);
    free(t->order);
    free(t->marks);
    free(t->places);
    *t = (struct drawn_tile){0};
}
