/* layer_view.c - packing of a view's two layers: texels, the composited photo, and the cells between texels.
 *
 * Cells replace the per-segment alpha tests of [Colburn 2014, 3.6.1], which compare the ids of single texels: they make
 * bilinear look-up possible without seams between segments of one surface. The photo has MIP levels [Williams 1983] for
 * frames that show it reduced.
 *
 * Segments are bounded and projected in groups of eight (drawn_view.c), so a group should be small in both directions:
 * the picture is cut into strips as high as a square of eight segments of mean size, and the segments of each strip, by
 * their centroids, are grouped from left to right. Those that nobody can see are in no group. */
#include "common/layers/layer_view.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/layers/soft_z.h"
#include "common/math/lanes.h"

#define HALF_MAX     65504.0f
#define BOUNDS_SLACK 1e-9 /* of a bound of 1/z, relative to its terms */

/* Both layers and their sum, the photo, as half floats. NaN becomes 0. */
static void pack_rgba(uint16_t half[2][4], uint16_t photo[4], const float *interior, const float *boundary)
{
    const f32x8 max = f32x8_all(HALF_MAX), min = f32x8_all(-HALF_MAX);
    f32x8 v = f32x8_join(f32x4_load(interior), f32x4_load(boundary));
    v = f32x8_where(v <= INFINITY, v);
    v = f32x8_max(f32x8_min(v, max), min);
    f32x8_to_half(half[0], v);
    f32x4 sum = f32x8_low(v) + f32x8_high(v);
    sum = f32x4_max(f32x4_min(sum, f32x8_low(max)), f32x8_low(min));
    f32x4_to_half(photo, sum);
}

/* One row of a level from two of the level before, of `width` texels each. */
static void reduce_row(uint16_t (*to)[4], const uint16_t (*top)[4], const uint16_t (*bottom)[4], int width)
{
    for (int x = 0; x < width; x += 2) { /* the padding to the right is empty */
        const f32x8 sum = f32x8_from_half(top[x]) + f32x8_from_half(bottom[x]);
        const f32x4 mean = (f32x8_low(sum) + f32x8_high(sum)) * 0.25f;
        f32x4_to_half(to[x / 2], mean);
    }
}

/* Levels go down to a few texels. Beyond the photo's border, and where it has no depth, alpha is 0. */
enum status layer_view_reduce(struct layer_view *lv, struct err *err)
{
    for (int k = 0; k < lv->reduced_count; k++) free(lv->reduced[k].texels);
    lv->reduced_count = 0;
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

static void scale_texel(uint16_t rgba[4], f32x4 factor)
{
    const f32x4 before = f32x4_from_half(rgba);
    const f32x4 after = f32x4_min(before * factor, f32x4_all(HALF_MAX));
    f32x4_to_half(rgba, after);
}

static size_t texel_index(const struct layer_view *lv, int x, int y)
{
    return (size_t)(y + 1) * (size_t)lv->stride + (size_t)(x + 1);
}

void layer_view_photo(const struct layer_view *lv, int x, int y, float rgba[4])
{
    const uint16_t *texel = lv->photo[texel_index(lv, x, y)];
    f32x4_store(rgba, f32x4_from_half(texel));
}

void layer_view_scale(struct layer_view *lv, int x, int y, const float factor[3])
{
    const size_t at = texel_index(lv, x, y);
    const f32x4 by = {factor[0], factor[1], factor[2], 1};
    for (int l = 0; l < 2; l++) scale_texel(lv->texels[at].rgba[l], by);
    scale_texel(lv->photo[at], by);
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

/* Grows bounds by a segment's box and by its plane's 1/z there, which is negative beyond the plane's horizon. */
static void bounds_add_segment(struct group_bounds *b, int at, const struct segment_group *g, int k)
{
    const double u[2] = {(double)g->u0[k], (double)g->u1[k]}, v[2] = {(double)g->v0[k], (double)g->v1[k]};
    const double a = g->plane[0][k], c = g->plane[1][k], d = g->plane[2][k];
    const double slack = BOUNDS_SLACK * (fabs(a * u[1]) + fabs(c * v[1]) + fabs(d)); /* of rounding */

    b->u0[at] = fmin(b->u0[at], u[0]);
    b->v0[at] = fmin(b->v0[at], v[0]);
    b->u1[at] = fmax(b->u1[at], u[1]);
    b->v1[at] = fmax(b->v1[at], v[1]);
    if (!isfinite(slack)) b->low_inverse[at] = 0, b->high_inverse[at] = INFINITY;
    for (int corner = 0; corner < 4; corner++) {
        const double inverse = a * u[corner % 2] + c * v[corner / 2] + d;
        b->low_inverse[at] = fmin(b->low_inverse[at], fmax(0, inverse - slack));
        b->high_inverse[at] = fmax(b->high_inverse[at], inverse + slack);
    }
}

static void bounds_add_group(struct group_bounds *b, int at, const struct group_bounds *group, int k)
{
    b->u0[at] = fmin(b->u0[at], group->u0[k]);
    b->v0[at] = fmin(b->v0[at], group->v0[k]);
    b->u1[at] = fmax(b->u1[at], group->u1[k]);
    b->v1[at] = fmax(b->v1[at], group->v1[k]);
    b->low_inverse[at] = fmin(b->low_inverse[at], group->low_inverse[k]);
    b->high_inverse[at] = fmax(b->high_inverse[at], group->high_inverse[k]);
}

static struct group_bounds bounds_empty(void)
{
    struct group_bounds b = {.high_inverse = {0}};
    for (int k = 0; k < BOUNDS_GROUPS; k++) {
        b.u0[k] = b.v0[k] = b.low_inverse[k] = INFINITY;
        b.u1[k] = b.v1[k] = -INFINITY;
    }
    return b;
}

struct segment_place {
    int strip;
    double u;
    uint32_t index;
};

static int compare_places(const void *a, const void *b)
{
    const struct segment_place *p = a, *q = b;
    if (p->strip != q->strip) return p->strip < q->strip ? -1 : 1;
    if (p->u != q->u) return p->u < q->u ? -1 : 1;
    return p->index < q->index ? -1 : 1;
}

static double inverse_at_centroid(const struct depth_segment *s, const struct segment_shape *shape)
{
    return s->plane[0] * shape->u + s->plane[1] * shape->v + s->plane[2];
}

/* Lists the segments that can be seen, in the order of the groups. */
static int list_places(struct segment_place *places, const struct layer_view *lv, const struct layered_depth *d)
{
    const double area = (double)lv->width * lv->height / (d->segment_count > 0 ? d->segment_count : 1);
    const double height = sqrt(GROUP_SEGMENTS * area);
    int count = 0;
    for (int i = 0; i < d->segment_count; i++) {
        const struct segment_shape *shape = &lv->shapes[i];
        if (shape->x1 < shape->x0 || !(inverse_at_centroid(&d->segments[i], shape) > 0)) continue;
        places[count++] = (struct segment_place){(int)(shape->v / height), shape->u, (uint32_t)i};
    }
    qsort(places, (size_t)count, sizeof *places, compare_places);
    return count;
}

static void group_set(struct segment_group *g, int k, const struct depth_segment *s, const struct segment_shape *shape,
                      uint32_t index)
{
    for (int c = 0; c < 3; c++) g->plane[c][k] = s->plane[c];
    g->inverse_z[k] = inverse_at_centroid(s, shape);
    g->u0[k] = (float)shape->x0 - 0.5f;
    g->v0[k] = (float)shape->y0 - 0.5f;
    g->u1[k] = (float)shape->x1 + 1.5f;
    g->v1[k] = (float)shape->y1 + 1.5f;
    g->sigma[k] = (float)s->sigma > SOFT_Z_MIN_SIGMA ? (float)s->sigma : SOFT_Z_MIN_SIGMA;
    g->surface_gap[k] = (float)(JOIN_SIGMAS * M_SQRT2 * fmax(s->sigma, SOFT_Z_MIN_SIGMA));
    g->index[k] = index;
}

/* Makes the groups and their bounds. */
static enum status group_segments(struct layer_view *lv, const struct layered_depth *d, struct err *err)
{
    struct segment_place *places = malloc(((size_t)d->segment_count + 1) * sizeof *places);
    if (!places) return err_nomem(err, "the segments of a view", (size_t)d->segment_count * sizeof *places);
    const int count = list_places(places, lv, d), groups = (count + GROUP_SEGMENTS - 1) / GROUP_SEGMENTS;
    const int blocks = (groups + BOUNDS_GROUPS - 1) / BOUNDS_GROUPS;

    lv->group_count = groups;
    lv->groups = calloc((size_t)groups + 1, sizeof *lv->groups);
    lv->bounds = malloc(((size_t)blocks + 1) * sizeof *lv->bounds);
    if (!lv->groups || !lv->bounds) {
        free(places);
        return err_nomem(err, "the segments of a view", (size_t)groups * sizeof *lv->groups);
    }
    for (int i = 0; i <= blocks; i++) lv->bounds[i] = bounds_empty();
    for (int i = 0; i < count; i++) {
        const int at = i / GROUP_SEGMENTS, k = i % GROUP_SEGMENTS;
        const uint32_t index = places[i].index;
        group_set(&lv->groups[at], k, &d->segments[index], &lv->shapes[index], index);
        bounds_add_segment(&lv->bounds[at / BOUNDS_GROUPS], at % BOUNDS_GROUPS, &lv->groups[at], k);
    }
    for (int i = 0; i < groups; i++)
        bounds_add_group(&lv->bounds[blocks], 0, &lv->bounds[i / BOUNDS_GROUPS], i % BOUNDS_GROUPS);
    free(places);
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
    free(lv->groups);
    free(lv->bounds);
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
    if (!index_cells(lv, depth, err) && !layer_view_reduce(lv, err)) group_segments(lv, depth, err);
    if (err->status) layer_view_release(lv);
    return err->status;
}
