/* layer_view.c - packing of a view's two layers: texels, the composited photo, and the cells between texels.
 *
 * Cells replace the per-segment alpha tests of [Colburn 2014, 3.6.1], which compare the ids of single texels: they make
 * bilinear look-up possible without seams between segments of one surface. The photo has MIP levels [Williams 1983] for frames that show it
 * reduced. */
#include "common/layers/layer_view.h"

#include <immintrin.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/layers/soft_z.h"

#define HALF_MAX 65504.0f

/* Both layers and their sum, the photo, as half floats. NaN becomes 0. */
__attribute__((target("f16c"))) static void pack_rgba(uint16_t half[2][4], uint16_t photo[4], const float *interior,
                                                      const float *boundary)
{
    const __m256 max = _mm256_set1_ps(HALF_MAX), min = _mm256_set1_ps(-HALF_MAX);
    __m256 v = _mm256_set_m128(_mm_loadu_ps(boundary), _mm_loadu_ps(interior));
    v = _mm256_and_ps(v, _mm256_cmp_ps(v, v, _CMP_ORD_Q));
    v = _mm256_max_ps(_mm256_min_ps(v, max), min);
    _mm_storeu_si128((__m128i *)half, _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
    __m128 sum = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    sum = _mm_max_ps(_mm_min_ps(sum, _mm256_castps256_ps128(max)), _mm256_castps256_ps128(min));
    _mm_storel_epi64((__m128i *)(void *)photo, _mm_cvtps_ph(sum, _MM_FROUND_TO_NEAREST_INT));
}

/* One row of a level from two of the level before, of `width` texels each. */
static void reduce_row(uint16_t (*to)[4], const uint16_t (*top)[4], const uint16_t (*bottom)[4], int width)
{
    for (int x = 0; x < width; x += 2) { /* the padding to the right is empty */
        const __m256 sum = _mm256_add_ps(_mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)(top + x))),
                                         _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)(bottom + x))));
        const __m128 mean =
            _mm_mul_ps(_mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1)), _mm_set1_ps(0.25f));
        _mm_storel_epi64((__m128i *)(void *)to[x / 2], _mm_cvtps_ph(mean, _MM_FROUND_TO_NEAREST_INT));
    }
}

/* Makes the levels of the photo down to a few texels. Beyond its border, and where it has no depth, alpha is 0. */
static enum status reduce_photo(struct layer_view *lv, struct err *err)
{
    const uint16_t(*from)[4] = (const uint16_t(*)[4])lv->photo;
    int w = lv->width, h = lv->height, stride = lv->stride;
    while (lv->reduced_count < PHOTO_LEVELS && w > 2 && h > 2) {
        struct photo_level *to = &lv->reduced[lv->reduced_count];
        const int half_w = (w + 1) / 2, half_h = (h + 1) / 2;
        to->stride = half_w + 3;
        to->texels = calloc((size_t)to->stride * (size_t)(half_h + 3), sizeof *to->texels);
        if (!to->texels)
            return err_nomem(err, "a reduced photo", (size_t)to->stride * (size_t)(half_h + 3) * sizeof *to->texels);
        lv->reduced_count++;
        for (int y = 0; y < half_h; y++) { /* one texel of padding above and left */
            const uint16_t(*row)[4] = from + (size_t)(2 * y + 1) * (size_t)stride + 1;
            reduce_row(to->texels + (size_t)(y + 1) * (size_t)to->stride + 1, row, row + stride, w);
        }
        from = (const uint16_t(*)[4])to->texels;
        w = half_w, h = half_h, stride = to->stride;
    }
    return ST_OK;
}

static void shape_add(struct segment_shape *s, int x, int y, bool interior)
{
    if (s->x1 < s->x0) {
        s->x0 = s->x1 = x;
        s->y0 = s->y1 = y;
    }
    if (x < s->x0) s->x0 = x;
    if (x > s->x1) s->x1 = x;
    if (y > s->y1) s->y1 = y;
    if (interior) {
        s->u += x + 0.5;
        s->v += y + 0.5;
        s->pixels++;
    }
}

/* Whether the planes of two segments agree in depth at pixel (u, v). */
static bool planes_meet(const struct depth_segment *a, const struct depth_segment *b, double u, double v)
{
    const double za = a->plane[0] * u + a->plane[1] * v + a->plane[2];
    const double zb = b->plane[0] * u + b->plane[1] * v + b->plane[2];
    const double sa = fmax(a->sigma, SOFT_Z_MIN_SIGMA), sb = fmax(b->sigma, SOFT_Z_MIN_SIGMA);
    return fabs(za - zb) <= JOIN_SIGMAS * hypot(sa, sb) * fmin(za, zb);
}

/* The distinct ids of a cell's texels; returns their number. *empty: some texel has no depth. */
static int cell_ids(const struct texel *t, int stride, uint32_t ids[CELL_IDS], bool *empty)
{
    const struct texel *cell[4] = {t, t + 1, t + stride, t + stride + 1};
    int count = 0;

    *empty = false;
    for (int k = 0; k < 4; k++)
        for (int l = 0; l < 2; l++) {
            const uint32_t id = cell[k]->id[l] & ~TEXEL_JOINED;
            bool known = !id;
            *empty |= l == 0 && !id;
            for (int i = 0; i < count; i++) known |= ids[i] == id;
            if (!known) ids[count++] = id;
        }
    return count;
}

/* Whether the cell does not fit into two words. */
static bool is_many(int count, bool empty) { return count > 2 || (count == 2 && empty); }

/* Numbers the surfaces of a cell whose middle is (u, v); returns their number. Segments whose planes agree there are
 * linked, and a surface is a connected component: on a slope, segments at opposite corners need not agree. */
static int cell_surfaces(const uint32_t ids[CELL_IDS], int count, const struct layered_depth *d, double u, double v,
                         uint8_t surface[CELL_IDS])
{
    int surfaces = 0;

    memset(surface, 0xFF, CELL_IDS);
    for (int first = 0; first < count; first++) {
        uint8_t linked[CELL_IDS];
        int known = 0;
        if (surface[first] != 0xFF) continue;
        surface[first] = (uint8_t)surfaces;
        linked[known++] = (uint8_t)first;
        for (int i = 0; i < known; i++)
            for (int j = 0; j < count; j++)
                if (surface[j] == 0xFF &&
                    planes_meet(&d->segments[ids[linked[i]] - 1], &d->segments[ids[j] - 1], u, v)) {
                    surface[j] = (uint8_t)surfaces;
                    linked[known++] = (uint8_t)j;
                }
        surfaces++;
    }
    return surfaces;
}

/* Makes the cells and the list of cells of many segments. */
static enum status index_cells(struct layer_view *lv, const struct layered_depth *d, struct err *err)
{
    const size_t row = (size_t)lv->stride, rows = (size_t)lv->height + 2;
    size_t many = 0;

    for (size_t i = 0; i + 1 < row * rows; i++) {
        uint32_t ids[CELL_IDS];
        bool empty;
        const int count = cell_ids(&lv->texels[i], lv->stride, ids, &empty);
        many += is_many(count, empty);
    }
    lv->many = aligned_alloc(64, (many + 1) * sizeof *lv->many);
    if (!lv->many) return err_nomem(err, "the cells of a view", many * sizeof *lv->many);
    many = 0;
    for (size_t y = 0; y < rows; y++)
        for (size_t x = 0; x + 1 < row; x++) {
            struct texel *t = &lv->texels[y * row + x];
            uint32_t *first = &lv->cells[0][y * row + x], *second = &lv->cells[1][y * row + x];
            uint32_t ids[CELL_IDS] = {0};
            uint8_t surface[CELL_IDS];
            bool empty;
            const int count = cell_ids(t, lv->stride, ids, &empty);
            const bool one = cell_surfaces(ids, count, d, (double)x, (double)y, surface) <= 1 && !empty;
            *first = ids[0];
            *second = ids[1];
            if (is_many(count, empty)) {
                memcpy(lv->many[many].id, ids, sizeof ids);
                memcpy(lv->many[many].surface, surface, sizeof surface);
                *first = CELL_MANY | (uint32_t)many++;
                *second = 0;
            }
            if (!one) *first |= CELL_SPLIT;
            if (one && count) t->id[0] |= TEXEL_JOINED;
        }
    return ST_OK;
}

void layer_view_release(struct layer_view *lv)
{
    if (!lv) return;
    free(lv->texels);
    free(lv->photo);
    for (int k = 0; k < lv->reduced_count; k++) free(lv->reduced[k].texels);
    for (int k = 0; k < 2; k++) free(lv->cells[k]);
    free(lv->many);
    free(lv->shapes);
    *lv = (struct layer_view){0};
}

static void layer_drop(struct layer *l)
{
    free(l->rgba);
    free(l->z);
    free(l->id);
    *l = (struct layer){0};
}

enum status layer_view_pack(struct layer_view *lv, struct layered_depth *depth, const char *name, struct err *err)
{
    const int w = depth->width, h = depth->height, stride = w + 3;
    const size_t size = (size_t)stride * (size_t)(h + 3) * sizeof *lv->texels;

    *lv = (struct layer_view){.width = w, .height = h, .stride = stride};
    lv->texels = aligned_alloc(64, (size + 63) / 64 * 64);
    lv->photo = calloc((size_t)stride * (size_t)(h + 3), sizeof *lv->photo);
    for (int k = 0; k < 2; k++) /* padding: sixteen words are read at a time */
        lv->cells[k] = calloc((size_t)stride * (size_t)(h + 3) + 16, sizeof *lv->cells[k]);
    lv->shapes = calloc((size_t)depth->segment_count + 1, sizeof *lv->shapes);
    if (!lv->texels || !lv->photo || !lv->cells[0] || !lv->cells[1] || !lv->shapes) {
        layer_view_release(lv);
        return err_nomem(err, "the layers of a view", size);
    }
    memset(lv->texels, 0, size);
    for (int i = 0; i < depth->segment_count; i++) lv->shapes[i].x1 = -1;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const size_t p = (size_t)y * (size_t)w + (size_t)x;
            struct texel *t = &lv->texels[(size_t)(y + 1) * (size_t)stride + (size_t)(x + 1)];
            t->id[0] = depth->interior.id[p];
            t->id[1] = depth->boundary.id[p];
            pack_rgba(t->rgba, lv->photo[t - lv->texels], depth->interior.rgba + 4 * p, depth->boundary.rgba + 4 * p);
            for (int l = 0; l < 2; l++) {
                if (t->id[l] > (uint32_t)depth->segment_count) {
                    const uint32_t id = t->id[l];
                    layer_view_release(lv);
                    return err_set(err, ST_DATA,
                                   "depth map of view %s: pixel (%d, %d) belongs to segment %u, but there are only %d "
                                   "segments. Make the depth map again.",
                                   name, x, y, id, depth->segment_count);
                }
                if (t->id[l])
                    shape_add(&lv->shapes[t->id[l] - 1], x, y, l == 0);
                else
                    memset(t->rgba[l], 0, sizeof t->rgba[l]);
            }
        }
    for (int i = 0; i < depth->segment_count; i++) {
        struct segment_shape *s = &lv->shapes[i];
        s->u = s->pixels > 0 ? s->u / s->pixels : 0.5 * (s->x0 + s->x1 + 1);
        s->v = s->pixels > 0 ? s->v / s->pixels : 0.5 * (s->y0 + s->y1 + 1);
    }
    layer_drop(&depth->interior);
    layer_drop(&depth->boundary);
    enum status st = index_cells(lv, depth, err);
    if (!st) st = reduce_photo(lv, err);
    if (st) layer_view_release(lv);
    return st;
}
