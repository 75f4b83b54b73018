/* resample.c - resamples a photograph to the pinhole camera of a view by Lanczos-3.
 *
 * The kernel is separable along the photo's axes. Its half width is 3 max(1, s) photo pixels, where s is the number of
 * photo pixels per pixel of the view along that axis (the length of a row of the map's Jacobian): a reduction widens
 * the kernel and so prevents aliasing. Negative lobes would draw dark lines beside bright windows in linear light, so
 * results are clamped to the range of the samples within one lobe.
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

enum { CHUNK = 16, SHARP = 2 * LOBES };

struct resample {
    struct image *out;
    struct photo_quality *out_quality; /* NULL: not wanted */
    const struct image *photo;
    const unsigned char *masked; /* per pixel of the photo; NULL: none */
    struct pixel_quality quality;
    struct photo_map map;
    double *points; /* per thread: two rows, u then v, and the knots of a row */
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
    const int lanes = LANES / 3 + 1; /* pixels beyond the taps that the last load may read */
    return tx->first >= 0 && ty->first >= 0 && tx->first + tx->count + lanes <= photo->width &&
           ty->first + ty->count <= photo->height && tx->near_begin < tx->near_end && ty->near_begin < ty->near_end;
}

/* Is a sample masked within one lobe of (u, v), which is wide x high pixels each way? */
static bool is_masked(const struct resample *r, double u, double v, double wide, double high)
{
    const int x1 = (int)floor(u - 0.5 + wide), y1 = (int)floor(v - 0.5 + high);
    for (int y = (int)ceil(v - 0.5 - high); y <= y1; y++) {
        const size_t row = (size_t)clamp_int(y, 0, r->photo->height - 1) * (size_t)r->photo->width;
        for (int x = (int)ceil(u - 0.5 - wide); x <= x1; x++)
            if (r->masked[row + (size_t)clamp_int(x, 0, r->photo->width - 1)]) return true;
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
static void filter_sharp(const struct resample *r, float rgba[4], int x, int y, f32x8 across, const float *down)
{
    const size_t stride = 3 * (size_t)r->photo->width;
    const float *row = image_at(r->photo, x, y);
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
static __attribute__((noinline)) void filter_wide(const struct resample *r, size_t to, const struct photo_point *at,
                                                  double su, double sv)
{
    float *rgba = r->out->data + 4 * to;
    struct kernel_taps tx, ty;
    make_taps(&tx, r->kernel, at->u, su);
    make_taps(&ty, r->kernel, at->v, sv);
    if (is_inside(r->photo, &tx, &ty))
        filter_inside(rgba, r->photo, &tx, &ty);
    else
        filter_border(rgba, r->photo, &tx, &ty);
    rgba[3] = 1;
    if (!r->out_quality) return;
    r->out_quality->variance[to] = pixel_quality_variance(&r->quality, &tx, &ty);
    r->out_quality->marks[to] =
        pixel_quality_marks(&r->quality, tx.first, ty.first, tx.first + tx.count, ty.first + ty.count);
}

/* One-sided differences are exact enough for the width of a filter. At the end of the lens they are taken to the other
 * side. */
static void resample_pixel(const struct resample *r, int x, int y, const struct map_row *here,
                           const struct map_row *below)
{
    const struct image *photo = r->photo;
    const struct photo_point at = {here->u[x], here->v[x]};
    struct photo_point right = {here->u[x + 1], here->v[x + 1]}, down = {below->u[x], below->v[x]};
    if (!(at.u >= 0 && at.v >= 0 && at.u <= photo->width && at.v <= photo->height)) return;
    if (isnan(right.u)) right = photo_map_point(&r->map, x - 1, y);
    if (isnan(right.u)) right = at;
    if (isnan(down.u)) down = photo_map_point(&r->map, x, y - 1);
    if (isnan(down.u)) down = at;
    const double ru = right.u - at.u, du = down.u - at.u, rv = right.v - at.v, dv = down.v - at.v;
    const double across = ru * ru + du * du, along = rv * rv + dv * dv;
    const double su = across > 1 ? fmin(sqrt(across), MAX_REDUCTION) : 1;
    const double sv = along > 1 ? fmin(sqrt(along), MAX_REDUCTION) : 1;
    const double left = floor(at.u - 0.5), top = floor(at.v - 0.5);
    const int u = (int)left - LOBES + 1, v = (int)top - LOBES + 1;
    const size_t to = (size_t)y * (size_t)r->out->width + (size_t)x;
    if (r->masked && is_masked(r, at.u, at.v, su, sv)) return;
    if (su == 1 && sv == 1 && u >= 0 && v >= 0 && u + SHARP <= photo->width && v + SHARP <= photo->height) {
        const f32x8 weights_x = sharp_weights(r, at.u - 0.5 - left);
        float weights_y[LANES];
        f32x8_store(weights_y, sharp_weights(r, at.v - 0.5 - top));
        filter_sharp(r, r->out->data + 4 * to, u, v, weights_x, weights_y);
        if (!r->out_quality) return;
        r->out_quality->variance[to] = pixel_quality_sharp_variance(&r->quality, u, v, weights_x, weights_y, SHARP);
        r->out_quality->marks[to] = pixel_quality_marks(&r->quality, u, v, u + SHARP, v + SHARP);
        return;
    }
    filter_wide(r, to, &at, su, sv);
}

static void resample_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct resample *r = ctx;
    double *points = r->points + r->points_per_thread * (size_t)thread;
    const size_t row = r->map.row;
    struct map_row here = {points, points + row}, below = {points + 2 * row, points + 3 * row};
    const struct map_row knots = {points + 4 * row, points + 4 * row + r->map.knots};
    photo_map_row(&r->map, (int)begin, &here, &knots);
    for (int y = (int)begin; y < (int)end; y++) {
        photo_map_row(&r->map, y + 1, &below, &knots);
        for (int x = 0; x < r->map.view->width; x++) resample_pixel(r, x, y, &here, &below);
        const struct map_row done = here;
        here = below;
        below = done;
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

static void copy_photo(const struct resample *r)
{
    for (size_t i = 0; i < (size_t)r->out->width * (size_t)r->out->height; i++) {
        if (r->masked && r->masked[i]) continue;
        memcpy(r->out->data + 4 * i, r->photo->data + 3 * i, 3 * sizeof(float));
        r->out->data[4 * i + 3] = 1;
        if (!r->out_quality) continue;
        r->out_quality->variance[i] = r->quality.of->variance[i];
        r->out_quality->marks[i] = r->quality.of->marks[i];
    }
}

static enum status filter_photo(struct resample *r, struct err *err)
{
    const size_t bytes = r->points_per_thread * (size_t)parallel_threads() * sizeof *r->points;
    if (r->out_quality && pixel_quality_prepare(&r->quality, err)) return err->status;
    r->points = malloc(bytes);
    if (!r->points) return err_nomem(err, "rows of a view", bytes);
    make_kernel(r->kernel);
    make_sharp(r->sharp, r->kernel);
    parallel_for((size_t)r->out->height, CHUNK, resample_rows, r);
    free(r->points);
    return ST_OK;
}

enum status resample_photo(struct image *out, struct photo_quality *out_quality, const struct resample_source *source,
                           const struct camera *lens, const struct mat3 *photo_from_view, const struct view *view,
                           struct err *err)
{
    const struct image *photo = source->linear;
    struct resample r = {
        .out = out, .out_quality = source->quality ? out_quality : NULL, .photo = photo, .masked = source->masked};
    if (photo->width != lens->width || photo->height != lens->height)
        return err_set(err, ST_DATA,
                       "the photo has %d x %d pixels but its camera %d x %d: the photo was replaced after the cameras "
                       "were given; give those of the new photo (SFM) or restore the old one.",
                       photo->width, photo->height, lens->width, lens->height);
    photo_map_init(&r.map, lens, photo_from_view, view);
    r.points_per_thread = 4 * r.map.row + 2 * r.map.knots;
    r.quality = (struct pixel_quality){.of = source->quality, .width = photo->width, .height = photo->height};
    image_init(out, view->width, view->height, 4, err);
    if (!err->status && r.out_quality) photo_quality_init(r.out_quality, view->width, view->height, err);
    if (!err->status && same_camera(&r.map))
        copy_photo(&r);
    else if (!err->status)
        filter_photo(&r, err);
    if (err->status) {
        image_release(out);
        photo_quality_release(r.out_quality);
    }
    pixel_quality_release(&r.quality);
    return err->status;
}
