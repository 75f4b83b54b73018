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

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/lanes.h"

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

/* min and max over the sums of one term of each pair */
static inline f64x4 low_sum(const f64x4 a[2], const f64x4 b[2], const f64x4 c[2])
{
    return f64x4_min(a[0], a[1]) + f64x4_min(b[0], b[1]) + f64x4_min(c[0], c[1]);
}

static inline f64x4 high_sum(const f64x4 a[2], const f64x4 b[2], const f64x4 c[2])
{
    return f64x4_max(a[0], a[1]) + f64x4_max(b[0], b[1]) + f64x4_max(c[0], c[1]);
}

/* Boxes that hold the pixels of four groups. Returns the lanes of those that may have pixels. */
static int bound_pixels(struct pixel_box boxes[LANES], const struct view_relation *r, const struct group_bounds *b)
{
    const f64x4 zero = {0}, one = f64x4_all(1);
    const f64x4 u[2] = {f64x4_load(b->u0), f64x4_load(b->u1)};
    const f64x4 v[2] = {f64x4_load(b->v0), f64x4_load(b->v1)};
    const f64x4 q[2] = {f64x4_load(b->low_inverse), f64x4_load(b->high_inverse)};
    const double shift = fmax(fmax(fabs(r->inverse_k[0]), fabs(r->inverse_k[1])), fabs(r->inverse_k[2]));
    const i64x4 exact = q[1] <= f64x4_all(fmin(MAX_SHIFT / shift, 1e300));
    f64x4 by_u[3][2], by_v[3][2], by_q[3][2];

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            by_u[i][k] = r->inverse_m[i][0] * u[k];
            by_v[i][k] = r->inverse_m[i][1] * v[k] + r->inverse_m[i][2];
            by_q[i][k] = r->inverse_k[i] * q[k];
        }
    const f64x4 min_w = low_sum(by_u[2], by_v[2], by_q[2]), max_w = high_sum(by_u[2], by_v[2], by_q[2]);
    const i64x4 safe = exact & (min_w >= SAFE_RATIO);
    const i64x4 hidden = exact & (max_w <= HIDDEN_RATIO);
    const i64x4 seen = ~hidden & (q[1] > zero);
    int lanes = i64x4_signs(seen);
    if (!lanes) return 0;

    f64x4 x0 = f64x4_all(INFINITY), y0 = x0, x1 = f64x4_all(-INFINITY), y1 = x1;
    for (int corner = 0; corner < 8; corner++) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const f64x4 w = one / (by_u[2][i] + by_v[2][j] + by_q[2][k]);
        const f64x4 x = (by_u[0][i] + by_v[0][j] + by_q[0][k]) * w;
        const f64x4 y = (by_u[1][i] + by_v[1][j] + by_q[1][k]) * w;
        x0 = f64x4_min(x, x0);
        x1 = f64x4_max(x, x1);
        y0 = f64x4_min(y, y0);
        y1 = f64x4_max(y, y1);
    }
    /* a pixel more on each side: for rounding, and PROJECT_SLACK */
    const f64x4 right = f64x4_all(r->width - 1), bottom = f64x4_all(r->height - 1);
    x0 = f64x4_where(safe, f64x4_max(f64x4_floor(x0) - one, zero));
    y0 = f64x4_where(safe, f64x4_max(f64x4_floor(y0) - one, zero));
    x1 = f64x4_if(safe, f64x4_min(f64x4_ceil(x1), right), right);
    y1 = f64x4_if(safe, f64x4_min(f64x4_ceil(y1), bottom), bottom);
    const i64x4 within = (x0 <= right) & (y0 <= bottom) & (x1 >= 0) & (y1 >= 0);
    lanes &= i64x4_signs(within);
    int box[4][LANES];
    i32x4_store(box[0], i32x4_truncate_f64(x0));
    i32x4_store(box[1], i32x4_truncate_f64(y0));
    i32x4_store(box[2], i32x4_truncate_f64(x1));
    i32x4_store(box[3], i32x4_truncate_f64(y1));
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
    f64x4 plane[3], to_target[3][3], facing;
    i32x4 x0, y0, x1, y1;
    int visible, clipped; /* lanes: with open pixels; to be projected alone */
};

static inline f64x4 row_at(const f64x4 row[3], f64x4 x, f64x4 y) { return row[0] * x + row[1] * y + row[2]; }

/* First pixel whose centre is at or beyond `x`; 0 at least. */
static inline i32x4 first_pixel(f64x4 x)
{
    const i64x4 is = x > 0.5 + PROJECT_SLACK;
    return i32x4_truncate_f64(f64x4_where(is, f64x4_ceil(x - 0.5 - PROJECT_SLACK)));
}

/* Last pixel whose centre is at or before `x`; `last` at most. */
static inline i32x4 last_pixel(f64x4 x, int last)
{
    const f64x4 end = x - 0.5 + PROJECT_SLACK;
    const i64x4 is = end < f64x4_all(last);
    return i32x4_truncate_f64(f64x4_if(is, f64x4_floor(end), f64x4_all(last)));
}

static inline f64x4 corner_of(const float *values) { return f64x4_from_f32(f32x4_load(values)); }

/* Bounds the pixels of segments first .. first + 3 of a group, as target_rectangle() of segment_project.c does. */
static void bound_segments(struct four_segments *f, const struct view_relation *r, const struct segment_group *g,
                           int first, const struct open_pixels *open)
{
    const f64x4 zero = {0}, one = f64x4_all(1), min_ratio = f64x4_all(PROJECT_MIN_RATIO);
    const f64x4 u0 = corner_of(g->u0 + first), v0 = corner_of(g->v0 + first);
    const f64x4 u1 = corner_of(g->u1 + first), v1 = corner_of(g->v1 + first);
    const f64x4 us[4] = {u0, u1, u1, u0}, vs[4] = {v0, v0, v1, v1};
    const f64x4 inverse = f64x4_load(g->inverse_z + first), least = min_ratio * inverse;
    f64x4 x0 = f64x4_all(INFINITY), y0 = x0, x1 = f64x4_all(-INFINITY), y1 = x1;
    const f64x4 *p = f->plane;

    for (int i = 0; i < 3; i++) f->plane[i] = f64x4_load(g->plane[i] + first);
    f->facing = one - (p[0] * r->k[0] + p[1] * r->k[1] + p[2] * r->k[2]);
    i64x4 seen = (f->facing > PROJECT_MIN_FACING) & (inverse > zero);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) f->to_target[i][c] = r->inverse_m[i][c] + r->inverse_k[i] * p[c];
    i64x4 inside = seen;
    for (int i = 0; i < 4; i++) {
        const f64x4 ratio = row_at(f->to_target[2], us[i], vs[i]), w = one / ratio;
        const f64x4 x = row_at(f->to_target[0], us[i], vs[i]) * w;
        const f64x4 y = row_at(f->to_target[1], us[i], vs[i]) * w;
        inside &= (row_at(p, us[i], vs[i]) >= least) & (ratio >= min_ratio);
        x0 = f64x4_min(x, x0);
        x1 = f64x4_max(x, x1);
        y0 = f64x4_min(y, y0);
        y1 = f64x4_max(y, y1);
    }
    f->clipped = i64x4_signs(seen & ~inside);
    const i64x4 within = (x1 > 0) & (y1 > 0) & (x0 < (double)r->width) & (y0 < (double)r->height);
    f->x0 = first_pixel(x0);
    f->y0 = first_pixel(y0);
    f->x1 = last_pixel(x1, r->width - 1);
    f->y1 = last_pixel(y1, r->height - 1);
    const i32x4 left = i32x4_max(f->x0, i32x4_all(open->box.x0)), right = i32x4_min(f->x1, i32x4_all(open->box.x1)),
                top = i32x4_max(f->y0, i32x4_all(open->box.y0)), bottom = i32x4_min(f->y1, i32x4_all(open->box.y1));
    const i32x4 empty = (left > right) | (top > bottom);
    int lanes = i64x4_signs(inside & within) & ~i32x4_signs(empty);
    f->visible = 0;
    if (!lanes) return;
    int box[4][LANES];
    i32x4_store(box[0], left);
    i32x4_store(box[1], top);
    i32x4_store(box[2], right);
    i32x4_store(box[3], bottom);
    for (; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz((unsigned)lanes);
        f->visible |= open_pixels_any(open, box[0][k], box[1][k], box[2][k], box[3][k]) << k;
    }
}

/* The forms of four segments at the centres of their first pixels: `forms` has their values and slopes, in the order of
 * struct drawn_segment. */
static void make_forms(f32x4 forms[12], const struct four_segments *f, const struct view_relation *r)
{
    const f64x4 x = f64x4_from_i32(f->x0) + 0.5, y = f64x4_from_i32(f->y0) + 0.5;
    f64x4 rows[4][3]; /* of u, v, w and 1/z */

    for (int i = 0; i < 3; i++)
        rows[3][i] = (r->m[0][i] * f->plane[0] + r->m[1][i] * f->plane[1] + r->m[2][i] * f->plane[2]) / f->facing;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) rows[i][c] = r->m[i][c] + r->k[i] * rows[3][c];
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++) rows[i][c] += 0.5 * rows[2][c];
    for (int i = 0; i < 4; i++) {
        forms[3 * i] = f32x4_from_f64(row_at(rows[i], x, y));
        forms[3 * i + 1] = f32x4_from_f64(rows[i][0]);
        forms[3 * i + 2] = f32x4_from_f64(rows[i][1]);
    }
}

/* Writes four vectors of four segments as four values of each segment, at `to`, `stride` bytes apart. */
static inline void store_transposed(void *to, size_t stride, f32x4 a, f32x4 b, f32x4 c, f32x4 d)
{
    f32x4 v[4] = {a, b, c, d};
    f32x4_transpose(v);
    for (int k = 0; k < 4; k++) memcpy((char *)to + (size_t)k * stride, &v[k], sizeof v[k]);
}

/* Makes segments first .. first + 3 of a group; those that are not visible too. */
static void make_segments(struct drawn_segment s[LANES], const struct four_segments *f, const struct view_relation *r,
                          const struct segment_group *g, int first)
{
    f32x4 forms[12];

    make_forms(forms, f, r);
    store_transposed(&s->u[0], sizeof *s, forms[0], forms[1], forms[2], forms[3]);
    store_transposed(&s->v[1], sizeof *s, forms[4], forms[5], forms[6], forms[7]);
    store_transposed(&s->w[2], sizeof *s, forms[8], forms[9], forms[10], forms[11]);
    store_transposed(&s->u0, sizeof *s, f32x4_load(g->u0 + first) + 0.5f, f32x4_load(g->v0 + first) + 0.5f,
                     f32x4_load(g->u1 + first) + 0.5f, f32x4_load(g->v1 + first) + 0.5f);
    store_transposed(&s->x0, sizeof *s, (f32x4)f->x0, (f32x4)f->y0, (f32x4)f->x1, (f32x4)f->y1);
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
