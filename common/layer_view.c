/* layer_view.c - see layer_view.h. */
#include "common/layer_view.h"

#include <immintrin.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/soft_z.h"

#define HALF_MOST 65504.0f

__attribute__((target("f16c"))) static void pack_rgba(uint16_t half[2][4], const float *interior, const float *boundary)
{
    const __m256 most = _mm256_set1_ps(HALF_MOST), least = _mm256_set1_ps(-HALF_MOST);
    __m256 v = _mm256_set_m128(_mm_loadu_ps(boundary), _mm_loadu_ps(interior));
    v = _mm256_max_ps(_mm256_min_ps(v, most), least);
    _mm_storeu_si128((__m128i *)half, _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
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

/* Whether the planes of two segments agree at pixel (u, v). */
static bool planes_meet(const struct depth_segment *a, const struct depth_segment *b, double u, double v)
{
    const double za = a->plane[0] * u + a->plane[1] * v + a->plane[2];
    const double zb = b->plane[0] * u + b->plane[1] * v + b->plane[2];
    const double sa = fmax(a->sigma, SOFT_Z_SIGMA_LEAST), sb = fmax(b->sigma, SOFT_Z_SIGMA_LEAST);
    return fabs(za - zb) <= JOIN_SIGMAS * hypot(sa, sb) * fmin(za, zb);
}

/* Whether the four texels at t belong to segments of one surface: in the middle of them, at (u, v), each one's plane
 * meets another's until all are linked. (On a slope, those at opposite corners need not meet.) */
static bool cell_joined(const struct texel *t, int stride, const struct layered_depth *d, double u, double v)
{
    const struct texel *cell[4] = {t, t + 1, t + stride, t + stride + 1};
    uint32_t ids[8];
    int count = 0, linked = 1;

    for (int k = 0; k < 4; k++)
        for (int l = 0; l < 2; l++) {
            const uint32_t id = cell[k]->id[l] & ~TEXEL_JOINED;
            bool known = false;
            if (!id && l == 0) return false;
            for (int i = 0; i < count; i++) known |= ids[i] == id;
            if (id && !known) ids[count++] = id;
        }
    for (int i = 0; i < linked; i++) /* ids[0 .. linked) hang together */
        for (int j = linked; j < count; j++)
            if (planes_meet(&d->segments[ids[i] - 1], &d->segments[ids[j] - 1], u, v)) {
                const uint32_t id = ids[j];
                ids[j] = ids[linked];
                ids[linked++] = id;
            }
    return linked == count;
}

void layer_view_release(struct layer_view *lv)
{
    if (!lv) return;
    free(lv->texels);
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

    *lv = (struct layer_view){w, h, stride, NULL, NULL};
    lv->texels = aligned_alloc(64, (size + 63) / 64 * 64);
    lv->shapes = calloc((size_t)depth->segment_count + 1, sizeof *lv->shapes);
    if (!lv->texels || !lv->shapes) {
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
            pack_rgba(t->rgba, depth->interior.rgba + 4 * p, depth->boundary.rgba + 4 * p);
            for (int l = 0; l < 2; l++) {
                if (t->id[l] > (uint32_t)depth->segment_count) {
                    const uint32_t id = t->id[l];
                    layer_view_release(lv);
                    return err_set(err, ST_DATA,
                                   "depth map of view %s: pixel (%d, %d) belongs to segment %u, but it "
                                   "has %d segments. Make it again.",
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
    for (int y = 0; y + 1 < h; y++)
        for (int x = 0; x + 1 < w; x++) {
            struct texel *t = &lv->texels[(size_t)(y + 1) * (size_t)stride + (size_t)(x + 1)];
            if (cell_joined(t, stride, depth, x + 1, y + 1)) t->id[0] |= TEXEL_JOINED;
        }
    layer_drop(&depth->interior);
    layer_drop(&depth->boundary);
    return ST_OK;
}
