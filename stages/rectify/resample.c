/* resample.c - resamples a photograph to the pinhole camera of a view by Lanczos-3.
 *
 * The kernel is separable along the photo's axes. Its half width is 3 max(1, s) photo pixels, where s is the number of
 * photo pixels per pixel of the view along that axis (the length of a row of the map's Jacobian): a reduction widens
 * the kernel and so prevents aliasing. Negative lobes would draw dark lines beside bright windows in linear light, so
 * results are clamped to the range of the samples within one lobe.
 *
 * Lens projection and kernel weights would take most of the time. Along a row of the view the map is smooth: it is
 * computed at knots, every 16th or else every 8th pixel, and interpolated by the cubic through four knots where fourth
 * differences show that this is exact enough (the error is 3/128 of them); elsewhere it is computed at every pixel.
 * Without reduction the weights depend only on the position between pixels and come from a table. */
#include "stages/rectify/resample.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

#define LOBES 3
#define STEPS 256 /* table entries per pixel; interpolated linearly, with an error below 1e-5 */

#define MAX_REDUCTION 64    /* larger reductions alias a little; limits the memory of the taps */
#define SMOOTH        0.004 /* px: largest fourth difference of knots to interpolate; 1e-4 px of error */
enum { LANES = 8, MAX_TAPS = 2 * LOBES * MAX_REDUCTION + 1, CHUNK = 16, SHARP = 2 * LOBES, KNOTS = 8, MARGIN = 4 };

struct photo_point { /* the projection of a view's pixel in the photo, px */
    double u, v;     /* NAN: outside the lens */
};

struct resample {
    struct image *out;
    const struct image *photo;
    const unsigned char *masked; /* per pixel of the photo; NULL: none */
    const struct camera *lens;
    struct mat3 photo_from_view;
    const struct view *view;
    double *points; /* per thread: two rows, u then v, and the knots of a row */
    size_t row, knots, points_per_thread;
    /* weights of four knots, and of every other one, at each pixel from the second to the third */
    double cubic[2][4][2 * KNOTS];
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

/* Weights of four knots, `step` apart, for each pixel between the second and the third. */
static void make_cubic(double cubic[4][2 * KNOTS], int step)
{
    for (int i = 0; i < step; i++) {
        const double t = (double)i / step;
        cubic[0][i] = -t * (t - 1) * (t - 2) / 6;
        cubic[1][i] = (t + 1) * (t - 1) * (t - 2) / 2;
        cubic[2][i] = -(t + 1) * t * (t - 2) / 2;
        cubic[3][i] = (t + 1) * t * (t - 1) / 6;
    }
}

static struct photo_point photo_from_pixel(const struct resample *r, int x, int y)
{
    const struct view *view = r->view;
    struct vec3 ray = {(x + 0.5 - view->cx) / view->fx, (y + 0.5 - view->cy) / view->fy, 1};
    struct photo_point p;
    return camera_project(r->lens, mat3_apply(r->photo_from_view, ray), &p.u, &p.v) ? p
                                                                                    : (struct photo_point){NAN, NAN};
}

/* Taps of the kernel along one axis; those within one lobe are near. Weights from `count` to the next multiple of LANES
 * are 0. */
struct kernel_taps {
    int first, count;
    int near_begin, near_end; /* relative to first */
    float weight[MAX_TAPS + LANES];
};

/* The kernel at eight positions, in units of table entries. */
static __m256 kernel_at(const float *kernel, __m256 steps)
{
    const __m256 end = _mm256_set1_ps(LOBES * STEPS), away = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), steps);
    const __m256i i = _mm256_cvttps_epi32(_mm256_min_ps(away, end));
    const __m256 here = _mm256_i32gather_ps(kernel, i, 4), next = _mm256_i32gather_ps(kernel + 1, i, 4);
    const __m256 part = _mm256_sub_ps(away, _mm256_cvtepi32_ps(i));
    return _mm256_and_ps(_mm256_cmp_ps(away, end, _CMP_LT_OQ),
                         _mm256_add_ps(here, _mm256_mul_ps(part, _mm256_sub_ps(next, here))));
}

static void make_taps(struct kernel_taps *t, const float *kernel, double at, double scale)
{
    const double radius = LOBES * scale, steps = STEPS / scale;
    const int last = (int)floor(at - 0.5 + radius);
    t->first = (int)ceil(at - 0.5 - radius);
    t->count = last - t->first + 1 < MAX_TAPS ? last - t->first + 1 : MAX_TAPS;
    t->near_begin = (int)ceil(at - 0.5 - scale) - t->first;
    t->near_end = (int)floor(at - 0.5 + scale) - t->first + 1;
    const __m256d centre = _mm256_set1_pd(at), spread = _mm256_set1_pd(steps), half = _mm256_set1_pd(0.5);
    for (int i = 0; i < t->count; i += LANES) {
        __m128 away[2];
        for (int k = 0; k < 2; k++) {
            const int x = t->first + i + 4 * k;
            const __m256d from = _mm256_sub_pd(_mm256_add_pd(_mm256_setr_pd(x, x + 1, x + 2, x + 3), half), centre);
            away[k] = _mm256_cvtpd_ps(_mm256_mul_pd(from, spread));
        }
        _mm256_storeu_ps(t->weight + i, kernel_at(kernel, _mm256_set_m128(away[1], away[0])));
    }
    float sum = 0;
    for (int i = 0; i < t->count; i++) sum += t->weight[i];
    for (int i = t->count; i % LANES; i++) t->weight[i] = 0;
    const __m256 share = _mm256_set1_ps(1 / sum);
    for (int i = 0; i < t->count; i += LANES)
        _mm256_storeu_ps(t->weight + i, _mm256_mul_ps(_mm256_loadu_ps(t->weight + i), share));
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
        __m256 sum = _mm256_setzero_ps();
        const float *at = rows + k;
        for (int j = 0; j < ty->count; j++, at += stride)
            sum = _mm256_add_ps(sum, _mm256_mul_ps(_mm256_set1_ps(ty->weight[j]), _mm256_loadu_ps(at)));
        _mm256_storeu_ps(columns + k, sum);
    }
    for (int k = 3 * tx->near_begin; k < 3 * tx->near_end; k += LANES) {
        const float *at = near + k;
        __m256 min = _mm256_loadu_ps(at), max = min;
        for (int j = ty->near_begin + 1; j < ty->near_end; j++) {
            const __m256 sample = _mm256_loadu_ps(at += stride);
            min = _mm256_min_ps(min, sample);
            max = _mm256_max_ps(max, sample);
        }
        _mm256_storeu_ps(low + k, min);
        _mm256_storeu_ps(high + k, max);
    }
    __m128 sum = _mm_setzero_ps(), min = _mm_set1_ps(INFINITY), max = sum;
    for (int i = 0; i < tx->count; i++)
        sum = _mm_add_ps(sum, _mm_mul_ps(_mm_set1_ps(tx->weight[i]), _mm_loadu_ps(columns + 3 * i)));
    for (int i = tx->near_begin; i < tx->near_end; i++) {
        min = _mm_min_ps(min, _mm_loadu_ps(low + 3 * i));
        max = _mm_max_ps(max, _mm_loadu_ps(high + 3 * i));
    }
    _mm_storeu_ps(rgba, _mm_blend_ps(_mm_min_ps(max, _mm_max_ps(min, sum)), _mm_set1_ps(1), 8));
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

/* Are the knots around the interval from knot[0] to knot[n] close to cubics? */
static bool is_smooth(const double *knot, int n)
{
    for (const double *k = knot; k <= knot + n; k += n)
        if (!(fabs(k[-2 * n] - 4 * k[-n] + 6 * k[0] - 4 * k[n] + k[2 * n]) <= SMOOTH)) return false;
    return true;
}

/* Interpolates the interval from knot[0] to knot[n]. n: 1 for neighbouring knots, 2 for every other one. */
static void interpolate(const struct resample *r, double *to, const double *knot, int n)
{
    const double(*w)[2 * KNOTS] = r->cubic[n - 1];
    for (int i = 0; i < n * KNOTS; i++)
        to[i] = w[0][i] * knot[-n] + w[1][i] * knot[0] + w[2][i] * knot[n] + w[3][i] * knot[2 * n];
}

/* The projections of a row's pixels and of the one after the last. */
struct row {
    double *u, *v;
};

static void project_at(const struct resample *r, const struct row *to, int i, int x, int y)
{
    const struct photo_point p = photo_from_pixel(r, x, y);
    to->u[i] = p.u;
    to->v[i] = p.v;
}

/* Projects a row of pixels. Uses every other knot where the map is smooth enough, as it is in large views. */
static void project_row(const struct resample *r, int y, const struct row *row, const struct row *knots)
{
    const int width = r->view->width, intervals = width / KNOTS + 1;
    for (int k = -MARGIN; k <= intervals + MARGIN; k += 2) project_at(r, knots, k + MARGIN, k * KNOTS, y);
    for (int k = 0, odd = 1 - MARGIN; k < intervals; k += 2) {
        const struct row at = {knots->u + k + MARGIN, knots->v + k + MARGIN};
        const struct row to = {row->u + k * KNOTS, row->v + k * KNOTS};
        if (is_smooth(at.u, 2) && is_smooth(at.v, 2)) {
            interpolate(r, to.u, at.u, 2);
            interpolate(r, to.v, at.v, 2);
            continue;
        }
        if (odd < k - 1) odd = k - 1;
        for (; odd <= k + 3; odd += 2) project_at(r, knots, odd + MARGIN, odd * KNOTS, y);
        for (int n = 0; n < 2; n++) {
            if (is_smooth(at.u + n, 1) && is_smooth(at.v + n, 1)) {
                interpolate(r, to.u + n * KNOTS, at.u + n, 1);
                interpolate(r, to.v + n * KNOTS, at.v + n, 1);
                continue;
            }
            for (int i = n * KNOTS; i < (n + 1) * KNOTS && k * KNOTS + i <= width; i++)
                project_at(r, &to, i, k * KNOTS + i, y);
        }
    }
}

static __m256 sharp_weights(const struct resample *r, double offset)
{
    const float at = (float)(offset * STEPS);
    const int j = (int)at < STEPS ? (int)at : STEPS - 1;
    const __m256 here = _mm256_loadu_ps(r->sharp[j]), next = _mm256_loadu_ps(r->sharp[j + 1]);
    return _mm256_add_ps(here, _mm256_mul_ps(_mm256_set1_ps(at - (float)j), _mm256_sub_ps(next, here)));
}

/* Filters six by six samples from (x, y) on. The 18 values of a row are loaded as pixels 0 and 1, 2 and 3, and 4 and 5
 * after two values of weight 0. */
static void filter_sharp(const struct resample *r, float rgba[4], int x, int y, double offset_x, double offset_y)
{
    const size_t stride = 3 * (size_t)r->photo->width;
    const float *row = image_at(r->photo, x, y);
    const __m256i second = _mm256_setr_epi32(3, 4, 5, 5, 5, 5, 5, 5);
    const __m256 across = sharp_weights(r, offset_x);
    __m256 first = _mm256_setzero_ps(), middle = first, last = first, near[2];
    float down[LANES];
    _mm256_storeu_ps(down, sharp_weights(r, offset_y));
    for (int j = 0; j < SHARP; j++, row += stride) {
        const __m256 weight = _mm256_set1_ps(down[j]), inner = _mm256_loadu_ps(row + 6);
        first = _mm256_add_ps(first, _mm256_mul_ps(weight, _mm256_loadu_ps(row)));
        middle = _mm256_add_ps(middle, _mm256_mul_ps(weight, inner));
        last = _mm256_add_ps(last, _mm256_mul_ps(weight, _mm256_loadu_ps(row + 10)));
        if (j == LOBES - 1 || j == LOBES) near[j - LOBES + 1] = inner;
    }
    first = _mm256_mul_ps(first, _mm256_permutevar8x32_ps(across, _mm256_setr_epi32(0, 0, 0, 1, 1, 1, 6, 6)));
    middle = _mm256_mul_ps(middle, _mm256_permutevar8x32_ps(across, _mm256_setr_epi32(2, 2, 2, 3, 3, 3, 6, 6)));
    last = _mm256_mul_ps(last, _mm256_permutevar8x32_ps(across, _mm256_setr_epi32(6, 6, 4, 4, 4, 5, 5, 5)));
    __m128 sum = _mm_add_ps(_mm_setzero_ps(), _mm256_castps256_ps128(first));
    sum = _mm_add_ps(sum, _mm256_castps256_ps128(_mm256_permutevar8x32_ps(first, second)));
    sum = _mm_add_ps(sum, _mm256_castps256_ps128(middle));
    sum = _mm_add_ps(sum, _mm256_castps256_ps128(_mm256_permutevar8x32_ps(middle, second)));
    sum = _mm_add_ps(sum,
                     _mm256_castps256_ps128(_mm256_permutevar8x32_ps(last, _mm256_setr_epi32(2, 3, 4, 4, 4, 4, 4, 4))));
    sum = _mm_add_ps(sum,
                     _mm256_castps256_ps128(_mm256_permutevar8x32_ps(last, _mm256_setr_epi32(5, 6, 7, 7, 7, 7, 7, 7))));
    const __m256 low = _mm256_min_ps(near[0], near[1]), high = _mm256_max_ps(near[0], near[1]);
    const __m128 min =
        _mm_min_ps(_mm256_castps256_ps128(low), _mm256_castps256_ps128(_mm256_permutevar8x32_ps(low, second)));
    const __m128 max =
        _mm_max_ps(_mm256_castps256_ps128(high), _mm256_castps256_ps128(_mm256_permutevar8x32_ps(high, second)));
    _mm_storeu_ps(rgba, _mm_blend_ps(_mm_min_ps(max, _mm_max_ps(min, sum)), _mm_set1_ps(1), 8));
}

/* Not inlined, so that the usual case has a small stack frame. */
static __attribute__((noinline)) void filter_wide(const struct resample *r, float rgba[4], const struct photo_point *at,
                                                  double su, double sv)
{
    struct kernel_taps tx, ty;
    make_taps(&tx, r->kernel, at->u, su);
    make_taps(&ty, r->kernel, at->v, sv);
    if (is_inside(r->photo, &tx, &ty))
        filter_inside(rgba, r->photo, &tx, &ty);
    else
        filter_border(rgba, r->photo, &tx, &ty);
    rgba[3] = 1;
}

/* One-sided differences are exact enough for the width of a filter. At the end of the lens they are taken to the other
 * side. */
static void resample_pixel(const struct resample *r, int x, int y, const struct row *here, const struct row *below)
{
    const struct image *photo = r->photo;
    const struct photo_point at = {here->u[x], here->v[x]};
    struct photo_point right = {here->u[x + 1], here->v[x + 1]}, down = {below->u[x], below->v[x]};
    if (!(at.u >= 0 && at.v >= 0 && at.u <= photo->width && at.v <= photo->height)) return;
    if (isnan(right.u)) right = photo_from_pixel(r, x - 1, y);
    if (isnan(right.u)) right = at;
    if (isnan(down.u)) down = photo_from_pixel(r, x, y - 1);
    if (isnan(down.u)) down = at;
    const double ru = right.u - at.u, du = down.u - at.u, rv = right.v - at.v, dv = down.v - at.v;
    const double across = ru * ru + du * du, along = rv * rv + dv * dv;
    const double su = across > 1 ? fmin(sqrt(across), MAX_REDUCTION) : 1;
    const double sv = along > 1 ? fmin(sqrt(along), MAX_REDUCTION) : 1;
    const double left = floor(at.u - 0.5), top = floor(at.v - 0.5);
    const int u = (int)left - LOBES + 1, v = (int)top - LOBES + 1;
    float *out = image_at(r->out, x, y);
    if (r->masked && is_masked(r, at.u, at.v, su, sv)) return;
    if (su == 1 && sv == 1 && u >= 0 && v >= 0 && u + SHARP <= photo->width && v + SHARP <= photo->height) {
        filter_sharp(r, out, u, v, at.u - 0.5 - left, at.v - 0.5 - top);
        return;
    }
    filter_wide(r, out, &at, su, sv);
}

static void resample_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct resample *r = ctx;
    double *points = r->points + r->points_per_thread * (size_t)thread;
    struct row here = {points, points + r->row}, below = {points + 2 * r->row, points + 3 * r->row};
    const struct row knots = {points + 4 * r->row, points + 4 * r->row + r->knots};
    project_row(r, (int)begin, &here, &knots);
    for (int y = (int)begin; y < (int)end; y++) {
        project_row(r, y + 1, &below, &knots);
        for (int x = 0; x < r->view->width; x++) resample_pixel(r, x, y, &here, &below);
        const struct row done = here;
        here = below;
        below = done;
    }
}

static bool same_camera(const struct resample *r)
{
    double fx, fy, cx, cy;
    if (r->lens->model != CAMERA_PINHOLE && r->lens->model != CAMERA_SIMPLE_PINHOLE) return false;
    camera_focal(r->lens, &fx, &fy, &cx, &cy);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (r->photo_from_view.m[i][j] != (i == j)) return false;
    return fx == r->view->fx && fy == r->view->fy && cx == r->view->cx && cy == r->view->cy &&
           r->lens->width == r->view->width && r->lens->height == r->view->height;
}

enum status resample_photo(struct image *out, const struct image *photo, const unsigned char *masked,
                           const struct camera *lens, const struct mat3 *photo_from_view, const struct view *view,
                           struct err *err)
{
    struct resample r = {
        .out = out, .photo = photo, .masked = masked, .lens = lens, .photo_from_view = *photo_from_view, .view = view};
    if (photo->width != lens->width || photo->height != lens->height)
        return err_set(
            err, ST_DATA,
            "the photo has %d x %d pixels but its camera %d x %d: the photo was replaced after structure from "
            "motion; run that again (make resfm) or restore the old photo.",
            photo->width, photo->height, lens->width, lens->height);
    if (image_init(out, view->width, view->height, 4, err)) return err->status;
    if (same_camera(&r)) {
        size_t pixels = (size_t)view->width * (size_t)view->height;
        for (size_t i = 0; i < pixels; i++) {
            if (masked && masked[i]) continue;
            memcpy(out->data + 4 * i, photo->data + 3 * i, 3 * sizeof(float));
            out->data[4 * i + 3] = 1;
        }
        return ST_OK;
    }
    const size_t pairs = (size_t)view->width / (2 * KNOTS) + 1; /* of intervals between knots */
    r.row = pairs * 2 * KNOTS;
    r.knots = 2 * pairs + 2 * MARGIN + 1;
    r.points_per_thread = 4 * r.row + 2 * r.knots;
    size_t bytes = r.points_per_thread * (size_t)parallel_threads() * sizeof *r.points;
    r.points = malloc(bytes);
    if (!r.points) {
        image_release(out);
        return err_nomem(err, "rows of a view", bytes);
    }
    for (int i = 0; i < 2; i++) make_cubic(r.cubic[i], (i + 1) * KNOTS);
    make_kernel(r.kernel);
    make_sharp(r.sharp, r.kernel);
    parallel_for((size_t)view->height, CHUNK, resample_rows, &r);
    free(r.points);
    return ST_OK;
}
