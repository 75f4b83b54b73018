/* resample.c - resamples a photograph to the pinhole camera of a view by Lanczos-3.
 *
 * The kernel is separable along the photo's axes. Its half width is 3 max(1, s) photo pixels, where s is the number of
 * photo pixels per pixel of the view along that axis (the length of a row of the map's Jacobian): a reduction widens
 * the kernel and so prevents aliasing. Negative lobes would draw dark lines beside bright windows in linear light, so
 * results are clamped to the range of the samples within one lobe.
 *
 * A photo of one exposure stays in memory as it was stored, with 3 bytes a pixel; in linear floats with noise and marks
 * it would take 17 more. The view is made in tiles, and the part of the photo under a tile's kernels is made linear.
 * Neighbouring tiles overlap by a kernel's width, which costs no more time than the memory did. A tile whose part is
 * too large, as it is where a lens spreads or turns the picture, is halved.
 *
 * Kernel weights would take much of the time. Without reduction they depend only on the position between pixels and
 * come from a table; photo_map.c finds the positions.
 *
 * Noise: the variance of a sum of independent samples is the sum of their variances by the squared weights
 * (pixel_quality.c). Marks of all samples under the kernel are united: the nearest ones alone would not do, since
 * beside a bright window the outer lobes carry its light, too. */
#include "stages/rectify/resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/lanes.h"
#include "common/math/numbers.h"
#include "stages/rectify/photo_map.h"
#include "stages/rectify/pixel_quality.h"

#define LOBES KERNEL_LOBES
#define STEPS 256 /* table entries per pixel; interpolated linearly, with an error below 1e-5 */

enum {
    CHUNK = 16, /* rows of a view */
    TILE = 256, /* columns */
    SHARP = 2 * LOBES,
    BEYOND = LANES / 3 + 1, /* pixels beyond the taps that the last load may read */
    MAX_PART = 1 << 18,     /* pixels; more than a single pixel of the view needs */
};

/* The photo, or what a tile of the view needs of it. */
struct part {
    struct image linear;         /* R G B */
    struct photo_quality marked; /* if it is not the whole photo */
    struct pixel_quality quality;
    int x0, y0; /* of its first pixel in the photo */
};

struct resample {
    struct image *out;
    struct photo_quality *out_quality; /* NULL: not wanted */
    const struct linear_photo *photo;  /* NULL: all of it is in `whole` */
    int width, height;                 /* of the photo */
    const unsigned char *masked;       /* per pixel of the photo; NULL: none */
    struct part whole, *parts;         /* parts: per thread */
    struct photo_map map;
    double *points; /* per thread: rows, u then v, and the knots of a row */
    size_t points_per_thread;
    float kernel[LOBES * STEPS + 2];
    float sharp[STEPS + 1][LANES]; /* weights without reduction, by the offset from the third sample's centre */
};

static void make_kernel(float *kernel)
{
    for (int i = 0; i < LOBES * STEPS + 2; i++) {
        double x = PI * i / STEPS;
        kernel[i] = i == 0 ? 1 : i < LOBES * STEPS ? (float)(sin(x) / x * sin(x / LOBES) / (x / LOBES)) : 0;
    }
}

static void make_sharp(float sharp[][LANES], const float *kernel)
{
    for (int j = 0; j <= STEPS; j++) {
        float sum = 0;
        for (int i = 0; i < SHARP; i++) {
            sharp[j][i] = kernel[abs((i - LOBES + 1) * STEPS - j)];
            sum += sharp[j][i];
        }
        for (int i = 0; i < SHARP; i++) sharp[j][i] /= sum;
    }
}

/* The kernel at eight positions, in units of table entries. */
static f32x8 kernel_at(const float *kernel, f32x8 steps)
{
    const f32x8 end = f32x8_all(LOBES * STEPS), away = f32x8_abs(steps);
    const i32x8 i = i32x8_truncate(f32x8_min(away, end));
    const f32x8 here = f32x8_gather(kernel, i), next = f32x8_gather(kernel + 1, i);
    const f32x8 part = away - f32x8_from_i32(i);
    return f32x8_where(away < end, here + part * (next - here));
}

static void make_taps(struct kernel_taps *t, const float *kernel, double at, double scale)
{
    const double radius = LOBES * scale, steps = STEPS / scale;
    const int last = (int)floor(at - 0.5 + radius);
    t->first = (int)ceil(at - 0.5 - radius);
    t->count = last - t->first + 1 < MAX_TAPS ? last - t->first + 1 : MAX_TAPS;
    t->near_begin = (int)ceil(at - 0.5 - scale) - t->first;
    t->near_end = (int)floor(at - 0.5 + scale) - t->first + 1;
    for (int i = 0; i < t->count; i += LANES) {
        f32x4 away[2];
        for (int k = 0; k < 2; k++) {
            const int x = t->first + i + 4 * k;
            const f64x4 from = (f64x4){x, x + 1, x + 2, x + 3} + 0.5 - at;
            away[k] = f32x4_from_f64(from * steps);
        }
        f32x8_store(t->weight + i, kernel_at(kernel, f32x8_join(away[0], away[1])));
    }
    float sum = 0;
    for (int i = 0; i < t->count; i++) sum += t->weight[i];
    for (int i = t->count; i % LANES; i++) t->weight[i] = 0;
    const f32x8 share = f32x8_all(1 / sum);
    for (int i = 0; i < t->count; i += LANES) f32x8_store(t->weight + i, f32x8_load(t->weight + i) * share);
}

/* The samples of a photo's row under the taps. If they cross the border, copies them to `buffer` and repeats the border
 * sample. */
static const float *samples_under(const struct image *photo, int y, const struct kernel_taps *t, float *buffer)
{
    const float *row = image_at(photo, 0, clamp_int(y, 0, photo->height - 1));
    if (t->first >= 0 && t->first + t->count <= photo->width) return row + 3 * (size_t)t->first;
    for (int i = 0; i < t->count; i++)
        memcpy(buffer + 3 * (size_t)i, row + 3 * (size_t)clamp_int(t->first + i, 0, photo->width - 1),
               3 * sizeof *buffer);
    return buffer;
}

/* Filters columns first, since there all samples of a row share one weight. */
static void filter_border(float rgb[3], const struct image *photo, const struct kernel_taps *tx,
                          const struct kernel_taps *ty)
{
    float columns[3 * MAX_TAPS], buffer[3 * MAX_TAPS], min[3], max[3] = {0};
    int samples = 3 * tx->count;
    for (int c = 0; c < 3; c++) min[c] = INFINITY;
    for (int k = 0; k < samples; k++) columns[k] = 0;
    for (int j = 0; j < ty->count; j++) {
        const float *row = samples_under(photo, ty->first + j, tx, buffer), weight = ty->weight[j];
        for (int k = 0; k < samples; k++) columns[k] += weight * row[k];
        if (j < ty->near_begin || j >= ty->near_end) continue;
        for (int i = tx->near_begin; i < tx->near_end; i++)
            for (int c = 0; c < 3; c++) {
                float sample = row[3 * i + c];
                min[c] = sample < min[c] ? sample : min[c];
                max[c] = sample > max[c] ? sample : max[c];
            }
    }
    for (int c = 0; c < 3; c++) {
        float sum = 0;
        for (int i = 0; i < tx->count; i++) sum += tx->weight[i] * columns[3 * i + c];
        rgb[c] = sum < min[c] ? min[c] : sum > max[c] ? max[c] : sum;
    }
}

/* The same, eight samples at a time, where no tap and no load crosses the photo's border. */
static void filter_inside(float rgba[4], const struct image *photo, const struct kernel_taps *tx,
                          const struct kernel_taps *ty)
{
    float columns[3 * MAX_TAPS + 2 * LANES], low[3 * MAX_TAPS + 2 * LANES], high[3 * MAX_TAPS + 2 * LANES];
    const size_t stride = 3 * (size_t)photo->width;
    const float *rows = image_at(photo, tx->first, ty->first), *near = rows + (size_t)ty->near_begin * stride;
    for (int k = 0; k < 3 * tx->count; k += LANES) {
        f32x8 sum = {0};
        const float *at = rows + k;
        for (int j = 0; j < ty->count; j++, at += stride) sum += ty->weight[j] * f32x8_load(at);
        f32x8_store(columns + k, sum);
    }
    for (int k = 3 * tx->near_begin; k < 3 * tx->near_end; k += LANES) {
        const float *at = near + k;
        f32x8 min = f32x8_load(at), max = min;
        for (int j = ty->near_begin + 1; j < ty->near_end; j++) {
            const f32x8 sample = f32x8_load(at += stride);
            min = f32x8_min(min, sample);
            max = f32x8_max(max, sample);
        }
        f32x8_store(low + k, min);
        f32x8_store(high + k, max);
    }
    f32x4 sum = {0}, min = f32x4_all(INFINITY), max = sum;
    for (int i = 0; i < tx->count; i++) sum += tx->weight[i] * f32x4_load(columns + 3 * i);
    for (int i = tx->near_begin; i < tx->near_end; i++) {
        min = f32x4_min(min, f32x4_load(low + 3 * i));
        max = f32x4_max(max, f32x4_load(high + 3 * i));
    }
    f32x4_store(rgba, f32x4_min(max, f32x4_max(min, sum)));
    rgba[3] = 1;
}

/* Are the taps, and the lanes after the last one, inside the photo? */
static bool is_inside(const struct image *photo, const struct kernel_taps *tx, const struct kernel_taps *ty)
{
    return tx->first >= 0 && ty->first >= 0 && tx->first + tx->count + BEYOND <= photo->width &&
           ty->first + ty->count <= photo->height && tx->near_begin < tx->near_end && ty->near_begin < ty->near_end;
}

/* Is a sample masked within one lobe of (u, v), which is wide x high pixels each way? */
static bool is_masked(const struct resample *r, double u, double v, double wide, double high)
{
    const int x1 = (int)floor(u - 0.5 + wide), y1 = (int)floor(v - 0.5 + high);
    for (int y = (int)ceil(v - 0.5 - high); y <= y1; y++) {
        const size_t row = (size_t)clamp_int(y, 0, r->height - 1) * (size_t)r->width;
        for (int x = (int)ceil(u - 0.5 - wide); x <= x1; x++)
            if (r->masked[row + (size_t)clamp_int(x, 0, r->width - 1)]) return true;
    }
    return false;
}

static f32x8 sharp_weights(const struct resample *r, double offset)
{
    const float at = (float)(offset * STEPS);
    const int j = (int)at < STEPS ? (int)at : STEPS - 1;
    const f32x8 here = f32x8_load(r->sharp[j]), next = f32x8_load(r->sharp[j + 1]);
    return here + (at - (float)j) * (next - here);
}

/* Filters six by six samples from (x, y) on. The 18 values of a row are loaded as pixels 0 and 1, 2 and 3, and 4 and 5
 * after two values of weight 0. */
static void filter_sharp(const struct image *photo, float rgba[4], int x, int y, f32x8 across, const float *down)
{
    const size_t stride = 3 * (size_t)photo->width;
    const float *row = image_at(photo, x, y);
    const i32x8 second = {3, 4, 5, 5, 5, 5, 5, 5};
    f32x8 first = {0}, middle = first, last = first, near[2];
    for (int j = 0; j < SHARP; j++, row += stride) {
        const f32x8 weight = f32x8_all(down[j]), inner = f32x8_load(row + 6);
        first += weight * f32x8_load(row);
        middle += weight * inner;
        last += weight * f32x8_load(row + 10);
        if (j == LOBES - 1 || j == LOBES) near[j - LOBES + 1] = inner;
    }
    first *= f32x8_pick(across, (i32x8){0, 0, 0, 1, 1, 1, 6, 6});
    middle *= f32x8_pick(across, (i32x8){2, 2, 2, 3, 3, 3, 6, 6});
    last *= f32x8_pick(across, (i32x8){6, 6, 4, 4, 4, 5, 5, 5});
    f32x4 sum = (f32x4){0} + f32x8_low(first);
    sum += f32x8_low(f32x8_pick(first, second));
    sum += f32x8_low(middle);
    sum += f32x8_low(f32x8_pick(middle, second));
    sum += f32x8_low(f32x8_pick(last, (i32x8){2, 3, 4, 4, 4, 4, 4, 4}));
    sum += f32x8_low(f32x8_pick(last, (i32x8){5, 6, 7, 7, 7, 7, 7, 7}));
    const f32x8 low = f32x8_min(near[0], near[1]), high = f32x8_max(near[0], near[1]);
    const f32x4 min = f32x4_min(f32x8_low(low), f32x8_low(f32x8_pick(low, second)));
    const f32x4 max = f32x4_max(f32x8_low(high), f32x8_low(f32x8_pick(high, second)));
    f32x4_store(rgba, f32x4_min(max, f32x4_max(min, sum)));
    rgba[3] = 1;
}

/* Not inlined, so that the usual case has a small stack frame. */
static __attribute__((noinline)) void filter_wide(const struct resample *r, const struct part *part, size_t to,
                                                  const struct photo_point *at, double su, double sv)
{
    float *rgba = r->out->data + 4 * to;
    struct kernel_taps tx, ty;
    make_taps(&tx, r->kernel, at->u, su);
    make_taps(&ty, r->kernel, at->v, sv);
    tx.first -= part->x0;
    ty.first -= part->y0;
    if (is_inside(&part->linear, &tx, &ty))
        filter_inside(rgba, &part->linear, &tx, &ty);
    else
        filter_border(rgba, &part->linear, &tx, &ty);
    rgba[3] = 1;
    if (!r->out_quality) return;
    r->out_quality->variance[to] = pixel_quality_variance(&part->quality, &tx, &ty);
    r->out_quality->marks[to] =
        pixel_quality_marks(&part->quality, tx.first, ty.first, tx.first + tx.count, ty.first + ty.count);
}

/* A pixel of the view in the photo, and how many of the photo's pixels it covers along its axes, at least 1. One-sided
 * differences are exact enough for the width of a filter. At the end of the lens they are taken to the other side.
 * False: it is outside the photo. */
static inline bool find_footprint(const struct resample *r, int x, int y, const struct map_row *here,
                                  const struct map_row *below, struct photo_point *at, double *su, double *sv)
{
    *at = (struct photo_point){here->u[x], here->v[x]};
    struct photo_point right = {here->u[x + 1], here->v[x + 1]}, down = {below->u[x], below->v[x]};
    if (!(at->u >= 0 && at->v >= 0 && at->u <= r->width && at->v <= r->height)) return false;
    if (isnan(right.u)) right = photo_map_point(&r->map, x - 1, y);
    if (isnan(right.u)) right = *at;
    if (isnan(down.u)) down = photo_map_point(&r->map, x, y - 1);
    if (isnan(down.u)) down = *at;
    const double ru = right.u - at->u, du = down.u - at->u, rv = right.v - at->v, dv = down.v - at->v;
    const double across = ru * ru + du * du, along = rv * rv + dv * dv;
    *su = across > 1 ? fmin(sqrt(across), MAX_REDUCTION) : 1;
    *sv = along > 1 ? fmin(sqrt(along), MAX_REDUCTION) : 1;
    return true;
}

static void resample_pixel(const struct resample *r, const struct part *part, int x, int y, const struct map_row *here,
                           const struct map_row *below)
{
    const struct image *photo = &part->linear;
    struct photo_point at;
    double su, sv;
    if (!find_footprint(r, x, y, here, below, &at, &su, &sv)) return;
    const double left = floor(at.u - 0.5), top = floor(at.v - 0.5);
    const int u = (int)left - LOBES + 1 - part->x0, v = (int)top - LOBES + 1 - part->y0;
    const size_t to = (size_t)y * (size_t)r->out->width + (size_t)x;
    if (r->masked && is_masked(r, at.u, at.v, su, sv)) return;
    if (su == 1 && sv == 1 && u >= 0 && v >= 0 && u + SHARP <= photo->width && v + SHARP <= photo->height) {
        const f32x8 weights_x = sharp_weights(r, at.u - 0.5 - left);
        float weights_y[LANES];
        f32x8_store(weights_y, sharp_weights(r, at.v - 0.5 - top));
        filter_sharp(photo, r->out->data + 4 * to, u, v, weights_x, weights_y);
        if (!r->out_quality) return;
        r->out_quality->variance[to] = pixel_quality_sharp_variance(&part->quality, u, v, weights_x, weights_y, SHARP);
        r->out_quality->marks[to] = pixel_quality_marks(&part->quality, u, v, u + SHARP, v + SHARP);
        return;
    }
    filter_wide(r, part, to, &at, su, sv);
}

/* Columns x0 to x1 - 1 and rows y0 to y1 - 1, of a view or of the photo. */
struct box {
    int x0, y0, x1, y1;
};

/* The projections of a chunk's rows and of the one below it. */
struct chunk {
    const struct map_row *rows;
    int first; /* the row of rows[0] */
};

/* What the kernels of a tile reach of the photo, with the widest of them; empty: nothing. */
static struct box find_reach(const struct resample *r, const struct box *tile, const struct chunk *chunk)
{
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY, wide = 1, high = 1;
    for (int y = tile->y0; y < tile->y1; y++) {
        const struct map_row *here = chunk->rows + (y - chunk->first), *below = here + 1;
        for (int x = tile->x0; x < tile->x1; x++) {
            const double u = here->u[x], v = here->v[x];
            if (!(u >= 0 && v >= 0 && u <= r->width && v <= r->height)) continue;
            const double ru = here->u[x + 1] - u, du = below->u[x] - u, rv = here->v[x + 1] - v, dv = below->v[x] - v;
            double across = ru * ru + du * du, along = rv * rv + dv * dv;
            if (isnan(across) || isnan(along)) { /* at the end of the lens */
                struct photo_point at;
                double su = 1, sv = 1;
                find_footprint(r, x, y, here, below, &at, &su, &sv);
                across = su * su;
                along = sv * sv;
            }
            left = u < left ? u : left;
            right = u > right ? u : right;
            top = v < top ? v : top;
            bottom = v > bottom ? v : bottom;
            wide = across > wide ? across : wide;
            high = along > high ? along : high;
        }
    }
    if (left > right) return (struct box){0};
    const double su = LOBES * fmin(sqrt(wide), MAX_REDUCTION) + 2, sv = LOBES * fmin(sqrt(high), MAX_REDUCTION) + 2;
    return (struct box){clamp_int((int)(left - su), 0, r->width), clamp_int((int)(top - sv), 0, r->height),
                        clamp_int((int)(right + su) + BEYOND + 1, 0, r->width),
                        clamp_int((int)(bottom + sv) + 1, 0, r->height)};
}

/* Makes a box of the photo linear. */
static void fill_part(struct part *part, const struct resample *r, const struct box *b)
{
    const size_t width = (size_t)(b->x1 - b->x0);
    part->x0 = b->x0;
    part->y0 = b->y0;
    part->linear.width = part->quality.width = b->x1 - b->x0;
    part->linear.height = part->quality.height = b->y1 - b->y0;
    for (int y = b->y0; y < b->y1; y++) {
        const size_t to = (size_t)(y - b->y0) * width;
        linear_photo_take(r->photo, part->linear.data + 3 * to, part->marked.variance + to, part->marked.marks + to,
                          (size_t)y * (size_t)r->width + (size_t)b->x0, width);
    }
}

static void resample_tile(const struct resample *r, struct part *part, const struct box *tile,
                          const struct chunk *chunk)
{
    if (r->photo) {
        const struct box reach = find_reach(r, tile, chunk);
        if (reach.x0 >= reach.x1 || reach.y0 >= reach.y1) return;
        if ((int64_t)(reach.x1 - reach.x0) * (reach.y1 - reach.y0) > MAX_PART) {
            struct box half[2] = {*tile, *tile};
            if (tile->x1 - tile->x0 >= tile->y1 - tile->y0)
                half[0].x1 = half[1].x0 = tile->x0 + (tile->x1 - tile->x0) / 2;
            else
                half[0].y1 = half[1].y0 = tile->y0 + (tile->y1 - tile->y0) / 2;
            for (int i = 0; i < 2; i++) resample_tile(r, part, &half[i], chunk);
            return;
        }
        fill_part(part, r, &reach);
        if (r->out_quality) pixel_quality_prepare(&part->quality);
    }
    for (int y = tile->y0; y < tile->y1; y++) {
        const struct map_row *here = chunk->rows + (y - chunk->first);
        for (int x = tile->x0; x < tile->x1; x++) resample_pixel(r, part, x, y, here, here + 1);
    }
}

static void resample_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct resample *r = ctx;
    double *points = r->points + r->points_per_thread * (size_t)thread;
    const size_t row = r->map.row;
    const int width = r->map.view->width;
    struct map_row rows[CHUNK + 1];
    const struct map_row knots = {points, points + r->map.knots};
    points += 2 * r->map.knots;
    for (size_t y = begin; y <= end; y++) {
        double *at = points + 2 * row * (y - begin);
        rows[y - begin] = (struct map_row){at, at + row};
        photo_map_row(&r->map, (int)y, &rows[y - begin], &knots);
    }
    const struct chunk chunk = {rows, (int)begin};
    for (int x = 0; x < width; x += TILE) {
        const struct box tile = {x, (int)begin, x + TILE < width ? x + TILE : width, (int)end};
        resample_tile(r, r->photo ? &r->parts[thread] : &r->whole, &tile, &chunk);
    }
}

static bool same_camera(const struct photo_map *m)
{
    double fx, fy, cx, cy;
    if (m->lens->model != CAMERA_PINHOLE && m->lens->model != CAMERA_SIMPLE_PINHOLE) return false;
    camera_focal(m->lens, &fx, &fy, &cx, &cy);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (m->photo_from_view.m[i][j] != (i == j)) return false;
    return fx == m->view->fx && fy == m->view->fy && cx == m->view->cx && cy == m->view->cy &&
           m->lens->width == m->view->width && m->lens->height == m->view->height;
}

static void copy_pixels(const struct resample *r, const struct part *part, const struct box *b)
{
    const struct photo_quality *from = part->quality.of;
    size_t i = 0;
    for (int y = b->y0; y < b->y1; y++)
        for (int x = b->x0; x < b->x1; x++, i++) {
            const size_t to = (size_t)y * (size_t)r->width + (size_t)x;
            if (r->masked && r->masked[to]) continue;
            memcpy(r->out->data + 4 * to, part->linear.data + 3 * i, 3 * sizeof(float));
            r->out->data[4 * to + 3] = 1;
            if (!r->out_quality) continue;
            r->out_quality->variance[to] = from->variance[i];
            r->out_quality->marks[to] = from->marks[i];
        }
}

/* Rows of a view that has the photo's own camera. */
static void copy_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct resample *r = ctx;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < r->width; x += MAX_PART) {
            const int after = r->width - x > MAX_PART ? x + MAX_PART : r->width;
            const struct box b = {x, (int)y, after, (int)y + 1};
            fill_part(&r->parts[thread], r, &b);
            copy_pixels(r, &r->parts[thread], &b);
        }
}

static enum status filter_photo(struct resample *r, struct err *err)
{
    r->points_per_thread = 2 * (CHUNK + 1) * r->map.row + 2 * r->map.knots;
    const size_t bytes = r->points_per_thread * (size_t)parallel_threads() * sizeof *r->points;
    if (!r->photo && r->out_quality) {
        if (pixel_quality_init(&r->whole.quality, (size_t)r->width * (size_t)r->height, err)) return err->status;
        pixel_quality_prepare(&r->whole.quality);
    }
    r->points = malloc(bytes);
    if (!r->points) return err_nomem(err, "rows of a view", bytes);
    make_kernel(r->kernel);
    make_sharp(r->sharp, r->kernel);
    parallel_for((size_t)r->out->height, CHUNK, resample_rows, r);
    free(r->points);
    return ST_OK;
}

/* Memory for a part of the photo for each thread. */
static enum status init_parts(struct resample *r, struct err *err)
{
    const int threads = parallel_threads();
    r->parts = calloc((size_t)threads, sizeof *r->parts);
    if (!r->parts) return err_nomem(err, "parts of a photo", (size_t)threads * sizeof *r->parts);
    for (int i = 0; !err->status && i < threads; i++) {
        struct part *part = &r->parts[i];
        part->quality.of = &part->marked;
        if (!image_init(&part->linear, MAX_PART, 1, 3, err) && !photo_quality_init(&part->marked, MAX_PART, 1, err))
            pixel_quality_init(&part->quality, MAX_PART, err);
    }
    return err->status;
}

static void release_parts(struct resample *r)
{
    for (int i = 0; r->parts && i < parallel_threads(); i++) {
        image_release(&r->parts[i].linear);
        photo_quality_release(&r->parts[i].marked);
        pixel_quality_release(&r->parts[i].quality);
    }
    free(r->parts);
    pixel_quality_release(&r->whole.quality);
}

enum status resample_photo(struct image *out, struct photo_quality *out_quality, const struct resample_source *source,
                           const struct camera *lens, const struct mat3 *photo_from_view, const struct view *view,
                           struct err *err)
{
    const struct linear_photo *photo = source->photo;
    struct resample r = {.out = out,
                         .out_quality = photo || source->quality ? out_quality : NULL,
                         .photo = photo,
                         .width = photo ? photo->width : source->linear->width,
                         .height = photo ? photo->height : source->linear->height,
                         .masked = source->masked};
    if (r.width != lens->width || r.height != lens->height)
        return err_set(err, ST_DATA,
                       "the photo has %d x %d pixels but its camera %d x %d: the photo was replaced after the cameras "
                       "were given; give those of the new photo (SFM) or restore the old one.",
                       r.width, r.height, lens->width, lens->height);
    photo_map_init(&r.map, lens, photo_from_view, view);
    if (!photo) r.whole.linear = *source->linear;
    r.whole.quality = (struct pixel_quality){.of = source->quality, .width = r.width, .height = r.height};
    image_init(out, view->width, view->height, 4, err);
    if (!err->status && r.out_quality) photo_quality_init(r.out_quality, view->width, view->height, err);
    if (!err->status && photo) init_parts(&r, err);
    if (!err->status && same_camera(&r.map)) {
        if (photo)
            parallel_for((size_t)r.height, CHUNK, copy_rows, &r);
        else
            copy_pixels(&r, &r.whole, &(struct box){0, 0, r.width, r.height});
    } else if (!err->status) {
        filter_photo(&r, err);
    }
    if (err->status) {
        image_release(out);
        photo_quality_release(out_quality);
    }
    release_parts(&r);
    return err->status;
}
