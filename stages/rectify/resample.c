/* resample.c - a photograph seen through the pinhole camera of its view.
 *
 * The kernel is separable along the photo's axes. Its half width is 3 max(1, s) photo pixels, s being how many photo
 * pixels one step in the view covers along that axis (length of a row of the map's Jacobian): the footprint grows with
 * the reduction, and with it the picture stays free of aliasing. Lanczos' negative lobes would draw dark lines beside
 * bright windows in linear light, hence the clamp to the samples within one lobe. */
#include "stages/rectify/resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/parallel.h"

#define LOBES 3
#define STEPS 256 /* table entries a unit; read with linear interpolation: error below 1e-5 */

struct resample {
    struct image *out;
    const struct image *photo;
    const struct camera *lens;
    struct mat3 photo_from_view;
    const struct view *view;
    float kernel[LOBES * STEPS + 2];
};

static void make_kernel(float *kernel)
{
    for (int i = 0; i < LOBES * STEPS + 2; i++) {
        double x = M_PI * i / STEPS;
        kernel[i] = i == 0 ? 1 : i < LOBES * STEPS ? (float)(sin(x) / x * sin(x / LOBES) / (x / LOBES)) : 0;
    }
}

static float kernel_at(const float *kernel, float x)
{
    float at = fabsf(x) * STEPS;
    if (at >= LOBES * STEPS) return 0;
    int i = (int)at;
    return kernel[i] + (at - (float)i) * (kernel[i + 1] - kernel[i]);
}

static bool photo_from_pixel(const struct resample *r, double u, double v, double *pu, double *pv)
{
    struct vec3 ray = {(u - r->view->cx) / r->view->fx, (v - r->view->cy) / r->view->fy, 1};
    return camera_project(r->lens, mat3_apply(r->photo_from_view, ray), pu, pv);
}

/* Taps along one axis around `at` (pixel centres at +0.5): first sample, weights; at the border the last sample repeats. */
struct taps {
    int first, count;
    float scale;
    float *weight; /* room for the largest count */
};

static void make_taps(struct taps *t, const float *kernel, double at, double scale, int max_count)
{
    double radius = LOBES * scale;
    int first = (int)ceil(at - 0.5 - radius), last = (int)floor(at - 0.5 + radius);
    t->first = first;
    t->count = last - first + 1 < max_count ? last - first + 1 : max_count;
    t->scale = (float)scale;
    float sum = 0;
    for (int i = 0; i < t->count; i++) {
        t->weight[i] = kernel_at(kernel, (float)((first + i + 0.5 - at) / scale));
        sum += t->weight[i];
    }
    for (int i = 0; i < t->count; i++) t->weight[i] /= sum;
}

static int clamp_int(int x, int most) { return x < 0 ? 0 : x > most ? most : x; }

static void filter(float rgb[3], const struct image *photo, const struct taps *tx, const struct taps *ty, double u,
                   double v)
{
    float sum[3] = {0}, least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {0};
    for (int j = 0; j < ty->count; j++) {
        int y = clamp_int(ty->first + j, photo->height - 1);
        const float *row = image_at(photo, 0, y);
        bool near_row = fabs(ty->first + j + 0.5 - v) <= (double)ty->scale;
        float line[3] = {0};
        for (int i = 0; i < tx->count; i++) {
            const float *p = row + 3 * (size_t)clamp_int(tx->first + i, photo->width - 1);
            for (int c = 0; c < 3; c++) line[c] += tx->weight[i] * p[c];
            if (near_row && fabs(tx->first + i + 0.5 - u) <= (double)tx->scale)
                for (int c = 0; c < 3; c++) {
                    least[c] = p[c] < least[c] ? p[c] : least[c];
                    most[c] = p[c] > most[c] ? p[c] : most[c];
                }
        }
        for (int c = 0; c < 3; c++) sum[c] += ty->weight[j] * line[c];
    }
    for (int c = 0; c < 3; c++) rgb[c] = sum[c] < least[c] ? least[c] : sum[c] > most[c] ? most[c] : sum[c];
}

#define MAX_REDUCTION 64 /* a reduction beyond it aliases a little; it keeps the taps' memory small */

static void resample_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct resample *r = ctx;
    enum { MAX_TAPS = 2 * LOBES * MAX_REDUCTION + 1 };
    float wx[MAX_TAPS], wy[MAX_TAPS];
    struct taps tx = {.weight = wx}, ty = {.weight = wy};
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < r->view->width; x++) {
            double u, v, ux, vx, uy, vy;
            double px = x + 0.5, py = (double)y + 0.5;
            if (!photo_from_pixel(r, px, py, &u, &v) || u < 0 || v < 0 || u > r->photo->width || v > r->photo->height)
                continue;
            /* one-sided differences suffice for a filter's width; where the lens ends, the centre's scale is taken */
            double su = 1, sv = 1;
            if (photo_from_pixel(r, px + 1, py, &ux, &vx) && photo_from_pixel(r, px, py + 1, &uy, &vy)) {
                su = hypot(ux - u, uy - u);
                sv = hypot(vx - v, vy - v);
            }
            make_taps(&tx, r->kernel, u, fmin(fmax(su, 1), MAX_REDUCTION), MAX_TAPS);
            make_taps(&ty, r->kernel, v, fmin(fmax(sv, 1), MAX_REDUCTION), MAX_TAPS);
            float *out = image_at(r->out, x, (int)y);
            filter(out, r->photo, &tx, &ty, u, v);
            out[3] = 1;
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

enum status resample_photo(struct image *out, const struct image *photo, const struct camera *lens,
                           const struct mat3 *photo_from_view, const struct view *view, struct err *err)
{
    struct resample r = {out, photo, lens, *photo_from_view, view, {0}};
    if (photo->width != lens->width || photo->height != lens->height)
        return err_set(err, ST_DATA,
                       "the photo has %d x %d pixels but its camera %d x %d: it was exchanged after structure from "
                       "motion; redo that (make resfm) or put the old photo back.",
                       photo->width, photo->height, lens->width, lens->height);
    if (image_init(out, view->width, view->height, 4, err)) return err->status;
    if (same_camera(&r)) {
        size_t pixels = (size_t)view->width * (size_t)view->height;
        for (size_t i = 0; i < pixels; i++) {
            memcpy(out->data + 4 * i, photo->data + 3 * i, 3 * sizeof(float));
            out->data[4 * i + 3] = 1;
        }
        return ST_OK;
    }
    make_kernel(r.kernel);
    parallel_for((size_t)view->height, 4, resample_rows, &r);
    return ST_OK;
}
