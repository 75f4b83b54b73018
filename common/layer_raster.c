/* layer_raster.c - see layer_raster.h. */
#include "common/layer_raster.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>

#define FULL         0.999f /* alpha from which a pixel takes no more from behind */
#define LEAST_FACING 1e-6   /* 1 - p . k: below, the plane is seen edge-on or from behind */
#define LEAST_RATIO  1e-6   /* of a depth in the novel camera to the depth in the view */
#define BORDER       0.05f  /* of the picture's long side: where a view fades out towards its border */
#define BLOCK        64     /* target pixels whose source positions are computed at once */

/* ---------------------------------------------------------------------------------------------- projection */

static struct mat3 intrinsics(const struct view *v)
{
    return (struct mat3){{{v->fx, 0, v->cx}, {0, v->fy, v->cy}, {0, 0, 1}}};
}

static struct mat3 intrinsics_inverse(const struct view *v)
{
    return (struct mat3){{{1 / v->fx, 0, -v->cx / v->fx}, {0, 1 / v->fy, -v->cy / v->fy}, {0, 0, 1}}};
}

/* M and k for "to pixels from pixels": (u, v, 1) ~ (M + k m^T) (x, y, 1), see the header. */
static void relate(struct mat3 *m, struct vec3 *k, const struct view *to, const struct view *from)
{
    const struct mat3 r = mat3_multiply(to->cam_from_world, mat3_transpose(from->cam_from_world));
    const struct vec3 t = vec3_sub(to->translation, mat3_apply(r, from->translation));
    *m = mat3_multiply(mat3_multiply(intrinsics(to), r), intrinsics_inverse(from));
    *k = mat3_apply(intrinsics(to), t);
}

static double row_at(const double row[3], double x, double y) { return row[0] * x + row[1] * y + row[2]; }

/* Keeps the part of a convex polygon where row . (u, v, 1) >= least. */
static int clip_polygon(double (*points)[2], int count, const double row[3], double least)
{
    double kept[16][2];
    int n = 0;
    for (int i = 0; i < count; i++) {
        const double *a = points[i], *b = points[(i + 1) % count];
        const double fa = row_at(row, a[0], a[1]) - least, fb = row_at(row, b[0], b[1]) - least;
        if (fa >= 0) {
            kept[n][0] = a[0];
            kept[n++][1] = a[1];
        }
        if ((fa >= 0) != (fb >= 0)) {
            const double t = fa / (fa - fb);
            kept[n][0] = a[0] + t * (b[0] - a[0]);
            kept[n++][1] = a[1] + t * (b[1] - a[1]);
        }
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) points[i][k] = kept[i][k];
    return n;
}

/* The target pixels that the rectangle [u0, u1] x [v0, v1] of the plane can touch; false if there are none. */
static bool target_rectangle(struct raster_segment *s, struct raster_order *o, const double plane[3],
                             double to_target[3][3], double u0, double v0, double u1, double v1, double inverse_z,
                             const struct view *novel)
{
    double points[8][2] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;

    int count = clip_polygon(points, 4, plane, LEAST_RATIO * inverse_z);
    count = clip_polygon(points, count, to_target[2], LEAST_RATIO);
    for (int i = 0; i < count; i++) {
        const double w = row_at(to_target[2], points[i][0], points[i][1]);
        const double x = row_at(to_target[0], points[i][0], points[i][1]) / w;
        const double y = row_at(to_target[1], points[i][0], points[i][1]) / w;
        x0 = fmin(x0, x);
        x1 = fmax(x1, x);
        y0 = fmin(y0, y);
        y1 = fmax(y1, y);
    }
    if (!(x1 > 0 && y1 > 0 && x0 < novel->width && y0 < novel->height)) return false;
    s->x0 = (int)fmax(0, x0 - 1);
    o->y0 = (int)fmax(0, y0 - 1);
    s->x1 = (int)fmin(novel->width - 1, x1 + 1);
    o->y1 = (int)fmin(novel->height - 1, y1 + 1);
    return true;
}

static int compare_depth(const void *a, const void *b)
{
    const struct raster_order *s = a, *t = b;
    if (s->depth != t->depth) return s->depth < t->depth ? -1 : 1;
    return (s->id > t->id) - (s->id < t->id);
}

enum status raster_view_prepare(struct raster_view *rv, const struct layered_depth *d, const struct layer_view *lv,
                                const struct view *view, const struct view *novel, struct err *err)
{
    struct mat3 m, inverse;
    struct vec3 k, inverse_k;

    rv->count = 0;
    rv->segments = malloc(((size_t)d->segment_count + 1) * sizeof *rv->segments);
    rv->order = malloc(((size_t)d->segment_count + 1) * sizeof *rv->order);
    if (!rv->segments || !rv->order)
        return err_nomem(err, "a view's segments", (size_t)d->segment_count * sizeof *rv->segments);
    relate(&m, &k, view, novel);
    relate(&inverse, &inverse_k, novel, view);

    for (int i = 0; i < d->segment_count; i++) {
        const struct segment_shape *shape = &lv->shapes[i];
        const double *p = d->segments[i].plane, kv[3] = {k.x, k.y, k.z},
                     ik[3] = {inverse_k.x, inverse_k.y, inverse_k.z};
        const double facing = 1 - (p[0] * k.x + p[1] * k.y + p[2] * k.z);
        const double inverse_z = row_at(p, shape->u, shape->v);
        if (shape->x1 < shape->x0 || !(facing > LEAST_FACING) || !(inverse_z > 0)) continue;

        struct raster_segment s = {.id = d->segments[i].id, .sigma = (float)d->segments[i].sigma};
        double to_target[3][3];
        for (int r = 0; r < 3; r++) s.inverse_z[r] = (m.m[0][r] * p[0] + m.m[1][r] * p[1] + m.m[2][r] * p[2]) / facing;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                s.from_target[r][c] = m.m[r][c] + kv[r] * s.inverse_z[c];
                to_target[r][c] = inverse.m[r][c] + ik[r] * p[c];
            }
        struct raster_order o = {.id = s.id, .segment = rv->count};
        o.depth = row_at(to_target[2], shape->u, shape->v) / inverse_z;
        if (!target_rectangle(&s, &o, p, to_target, shape->x0 - 0.5, shape->y0 - 0.5, shape->x1 + 1.5, shape->y1 + 1.5,
                              inverse_z, novel))
            continue;

        /* pixel (u, v) has its centre at + 0.5 and the texels have one of padding: index = u - 0.5 + 1 */
        for (int r = 0; r < 2; r++)
            for (int c = 0; c < 3; c++) s.from_target[r][c] += 0.5 * s.from_target[2][c];
        s.u0 = shape->x0;
        s.v0 = shape->y0;
        s.u1 = shape->x1 + 2;
        s.v1 = shape->y1 + 2;
        rv->order[rv->count] = o;
        rv->segments[rv->count++] = s;
    }
    qsort(rv->order, (size_t)rv->count, sizeof *rv->order, compare_depth);
    return ST_OK;
}

void raster_view_release(struct raster_view *rv)
{
    if (!rv) return;
    free(rv->segments);
    free(rv->order);
    *rv = (struct raster_view){0};
}

/* --------------------------------------------------------------------------------------------- compositing */

static void surface_add(struct raster_surface *s, float z, float sigma, float alpha)
{
    const float total = s->alpha + alpha;
    s->z += (z - s->z) * (alpha / total);
    s->sigma += (sigma - s->sigma) * (alpha / total);
    s->alpha = total;
}

void raster_composite(struct raster_pixel *p, const struct raster_fragment *fragment, float reach)
{
    const float total = p->rgba[3], alpha = fragment->rgba[3], z = fragment->z;

    if (total > 0 && z < p->front.z - reach) {
        const float keep = fmaxf(0, fminf(1, (1 - alpha) / total));
        for (int k = 0; k < 4; k++) p->rgba[k] = fragment->rgba[k] + keep * p->rgba[k];
        p->inside = alpha * fragment->inside + keep * p->inside;
        p->back = p->front;
        p->back.alpha *= keep;
        p->front = (struct raster_surface){z, alpha, fragment->sigma};
        return;
    }
    const float weight = fminf(alpha, 1 - total);
    if (!(weight > 0)) return;
    for (int k = 0; k < 4; k++) p->rgba[k] += weight / alpha * fragment->rgba[k];
    p->inside += weight * fragment->inside;
    if (!(total > 0) || z <= p->front.z + reach)
        surface_add(&p->front, z, fragment->sigma, weight);
    else if (!(p->back.alpha > 0) || fabsf(z - p->back.z) <= reach)
        surface_add(&p->back, z, fragment->sigma, weight);
}

const struct raster_surface *raster_visible(const struct raster_pixel *p)
{
    return p->front.alpha >= 0.5f * p->rgba[3] || p->back.alpha <= p->front.alpha ? &p->front : &p->back;
}

/* ---------------------------------------------------------------------------------------------- rasteriser */

/* Coverage and premultiplied colour of segment `id` at texel position (u, v): false if there is none. */
__attribute__((target("f16c"))) static inline bool sample(const struct layer_view *lv, uint32_t id, float u, float v,
                                                          float rgba[4])
{
    const int i = (int)u, j = (int)v;
    const float fu = u - (float)i, fv = v - (float)j;
    const struct texel *t = lv->texels + (size_t)j * (size_t)lv->stride + (size_t)i;
    const struct texel *cell[4] = {t, t + 1, t + lv->stride, t + lv->stride + 1};
    const float weights[4] = {(1 - fu) * (1 - fv), fu * (1 - fv), (1 - fu) * fv, fu * fv};
    const __m128i wanted = _mm_set1_epi32((int)id), id_bits = _mm_set1_epi32((int)~TEXEL_JOINED);
    __m128i is[4];

    for (int k = 0; k < 4; k++) {
        const __m128i ids = _mm_loadl_epi64((const __m128i *)(const void *)cell[k]->id);
        is[k] = _mm_cmpeq_epi32(_mm_and_si128(ids, id_bits), wanted);
    }
    const __m128i any = _mm_or_si128(_mm_or_si128(is[0], is[1]), _mm_or_si128(is[2], is[3]));
    if (!_mm_cvtsi128_si64(any)) return false;
    const __m256i whole = _mm256_set1_epi32(t->id[0] & TEXEL_JOINED ? -1 : 0);

    /* lanes 0..3 the interior layer's colour, 4..7 the boundary layer's */
    const __m256i spread = _mm256_set_epi32(1, 1, 1, 1, 0, 0, 0, 0);
    __m256 sum = _mm256_setzero_ps();
    for (int k = 0; k < 4; k++) {
        const __m256i mask = _mm256_or_si256(whole, _mm256_permutevar8x32_epi32(_mm256_castsi128_si256(is[k]), spread));
        const __m256 w = _mm256_and_ps(_mm256_castsi256_ps(mask), _mm256_set1_ps(weights[k]));
        const __m256 color = _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)cell[k]->rgba));
        sum = _mm256_add_ps(sum, _mm256_mul_ps(w, color));
    }
    _mm_storeu_ps(rgba, _mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1)));
    return rgba[3] > 0;
}

/* How far texel position (u, v) is inside the picture: 0 at its border, 1 from BORDER of its long side on. */
static inline float inside(const struct layer_view *lv, float u, float v)
{
    const float across = (float)(lv->width > lv->height ? lv->width : lv->height) * BORDER;
    const float x = fminf(u - 0.5f, (float)lv->width + 0.5f - u), y = fminf(v - 0.5f, (float)lv->height + 0.5f - v);
    return fminf(1, fmaxf(0, fminf(x, y)) / across);
}

/* Narrows [*lo, *hi] to where slope x + offset >= 0. */
static void clip_span(double slope, double offset, double *lo, double *hi)
{
    if (slope > 0)
        *lo = fmax(*lo, -offset / slope);
    else if (slope < 0)
        *hi = fmin(*hi, -offset / slope);
    else if (offset < 0)
        *hi = -INFINITY;
}

struct line { /* of a row of the target: value = slope x + offset at pixel centre x */
    double slope, offset;
};

static struct line line_at(const double row[3], double y) { return (struct line){row[0], row[1] * y + row[2]}; }

static void raster_row(const struct raster_target *target, int y, const struct raster_segment *s,
                       const struct layer_view *lv, const struct soft_z *soft)
{
    const struct line u = line_at(s->from_target[0], y + 0.5), v = line_at(s->from_target[1], y + 0.5);
    const struct line w = line_at(s->from_target[2], y + 0.5), inverse = line_at(s->inverse_z, y + 0.5);
    const int *span = target->spans[y - target->y0];
    const size_t row = (size_t)(y - target->y0) * (size_t)target->width;
    double lo = s->x0 > span[0] ? s->x0 : span[0], hi = s->x1 < span[1] ? s->x1 : span[1];

    lo += 0.5;
    hi += 0.5;
    clip_span(u.slope - s->u0 * w.slope, u.offset - s->u0 * w.offset, &lo, &hi);
    clip_span(s->u1 * w.slope - u.slope, s->u1 * w.offset - u.offset, &lo, &hi);
    clip_span(v.slope - s->v0 * w.slope, v.offset - s->v0 * w.offset, &lo, &hi);
    clip_span(s->v1 * w.slope - v.slope, s->v1 * w.offset - v.offset, &lo, &hi);
    clip_span(w.slope, w.offset - 1e-9, &lo, &hi);
    clip_span(inverse.slope, inverse.offset, &lo, &hi);
    if (!(lo <= hi)) return;

    const int first = (int)ceil(lo - 0.5), last = (int)floor(hi - 0.5);
    for (int x0 = first; x0 <= last; x0 += BLOCK) {
        const int count = last - x0 + 1 < BLOCK ? last - x0 + 1 : BLOCK;
        float us[BLOCK], vs[BLOCK], inverses[BLOCK];
        for (int i = 0; i < count; i++) {
            const double x = x0 + i + 0.5, scale = 1 / (w.slope * x + w.offset);
            const double ui = (u.slope * x + u.offset) * scale, vi = (v.slope * x + v.offset) * scale;
            us[i] = (float)(ui < s->u0 ? s->u0 : ui > s->u1 ? s->u1 : ui);
            vs[i] = (float)(vi < s->v0 ? s->v0 : vi > s->v1 ? s->v1 : vi);
            inverses[i] = (float)(inverse.slope * x + inverse.offset);
        }
        for (int i = 0; i < count; i++) {
            struct raster_fragment f;
            float *skip = &target->skip[row + (size_t)(x0 + i)];
            if (inverses[i] <= *skip || !sample(lv, s->id, us[i], vs[i], f.rgba)) continue;
            f.z = 1 / inverses[i];
            f.sigma = s->sigma;
            f.inside = inside(lv, us[i], vs[i]);
            struct raster_pixel *p = &target->pixels[row + (size_t)(x0 + i)];
            raster_composite(p, &f, soft_z_reach(soft, f.z, f.sigma));
            if (p->rgba[3] >= FULL) {
                const float nearer = p->front.z - soft_z_reach(soft, p->front.z, p->front.sigma);
                *skip = nearer > 0 ? 1 / nearer : INFINITY;
            }
        }
    }
}

void raster_rows(const struct raster_target *target, const struct raster_view *rv, const struct layer_view *lv,
                 const struct soft_z *soft)
{
    for (int i = 0; i < rv->count; i++) {
        const struct raster_order *o = &rv->order[i];
        const int first = o->y0 > target->y0 ? o->y0 : target->y0;
        const int last = o->y1 < target->y1 - 1 ? o->y1 : target->y1 - 1;
        for (int y = first; y <= last; y++) raster_row(target, y, &rv->segments[o->segment], lv, soft);
    }
}
