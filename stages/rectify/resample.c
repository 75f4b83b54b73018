/* resample.c - a photograph seen through the pinhole camera of its view.
 *
 * The kernel is separable along the photo's axes. Its half width is 3 max(1, s) photo pixels, s being how many photo
 * pixels one step in the view covers along that axis (length of a row of the map's Jacobian): the footprint grows with
 * the reduction, and with it the picture stays free of aliasing. Lanczos' negative lobes would draw dark lines beside
 * bright windows in linear light, hence the clamp to the samples within one lobe.
 *
 * Most of the time would go into the lens and into kernels. Along a row the map is a smooth curve: it is computed at every
 * KNOTS-th pixel, and in between by the cubic through four of them where fourth differences say that this is as
 * good (error 3/128 of them). Where nothing is reduced, weights depend on the place between pixels alone and are tabled. */
#include "stages/rectify/resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/parallel.h"

#define LOBES 3
#define STEPS 256 /* table entries a unit; read with linear interpolation: error below 1e-5 */

#define MAX_REDUCTION 64    /* a reduction beyond it aliases a little; it keeps the taps' memory small */
#define SMOOTH        0.004 /* px: fourth differences of knots up to it; 1e-4 px of error */
enum { MAX_TAPS = 2 * LOBES * MAX_REDUCTION + 1, CHUNK = 16, SHARP = 2 * LOBES, KNOTS = 8, MARGIN = 2 };

struct place { /* where in the photo a view's pixel lies */
    double u, v;
    bool seen;
};

struct resample {
    struct image *out;
    const struct image *photo;
    const unsigned char *masked; /* of the photo's pixels; NULL: none is */
    const struct camera *lens;
    struct mat3 photo_from_view;
    const struct view *view;
    struct place *places; /* of each thread: two rows, each of the view's width + 1, then the knots of a row */
    size_t places_of_thread;
    float kernel[LOBES * STEPS + 2];
    float sharp[STEPS + 1][SHARP]; /* weights without reduction, by the place behind the third sample's centre */
};

static void make_kernel(float *kernel)
{
    for (int i = 0; i < LOBES * STEPS + 2; i++) {
        double x = M_PI * i / STEPS;
        kernel[i] = i == 0 ? 1 : i < LOBES * STEPS ? (float)(sin(x) / x * sin(x / LOBES) / (x / LOBES)) : 0;
    }
}

static void make_sharp(float sharp[][SHARP], const float *kernel)
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

static float kernel_at(const float *kernel, float steps)
{
    float at = fabsf(steps);
    if (at >= LOBES * STEPS) return 0;
    int i = (int)at;
    return kernel[i] + (at - (float)i) * (kernel[i + 1] - kernel[i]);
}

static struct place photo_from_pixel(const struct resample *r, int x, int y)
{
    const struct view *view = r->view;
    struct vec3 ray = {(x + 0.5 - view->cx) / view->fx, (y + 0.5 - view->cy) / view->fy, 1};
    struct place p = {0};
    p.seen = camera_project(r->lens, mat3_apply(r->photo_from_view, ray), &p.u, &p.v);
    return p;
}

/* Taps along one axis around `at` (pixel centres at +0.5); those within one lobe are near. */
struct taps {
    int first, count;
    int near_begin, near_end; /* counted from the first */
    float weight[MAX_TAPS];
};

static void make_taps(struct taps *t, const float *kernel, double at, double scale)
{
    double radius = LOBES * scale, steps = STEPS / scale;
    int last = (int)floor(at - 0.5 + radius);
    t->first = (int)ceil(at - 0.5 - radius);
    t->count = last - t->first + 1 < MAX_TAPS ? last - t->first + 1 : MAX_TAPS;
    t->near_begin = (int)ceil(at - 0.5 - scale) - t->first;
    t->near_end = (int)floor(at - 0.5 + scale) - t->first + 1;
    float sum = 0;
    for (int i = 0; i < t->count; i++) {
        t->weight[i] = kernel_at(kernel, (float)((t->first + i + 0.5 - at) * steps));
        sum += t->weight[i];
    }
    float share = 1 / sum;
    for (int i = 0; i < t->count; i++) t->weight[i] *= share;
}

static int clamp_int(int x, int most) { return x < 0 ? 0 : x > most ? most : x; }

/* The samples of a photo's row under the taps, copied to `room` where they reach over the border: there the last sample
 * repeats. */
static const float *samples_under(const struct image *photo, int y, const struct taps *t, float *room)
{
    const float *row = image_at(photo, 0, clamp_int(y, photo->height - 1));
    if (t->first >= 0 && t->first + t->count <= photo->width) return row + 3 * (size_t)t->first;
    for (int i = 0; i < t->count; i++)
        memcpy(room + 3 * (size_t)i, row + 3 * (size_t)clamp_int(t->first + i, photo->width - 1), 3 * sizeof *room);
    return room;
}

/* Down the columns first: there a row's samples, of whatever colour, share one weight. */
static void filter(float rgb[3], const struct image *photo, const struct taps *tx, const struct taps *ty)
{
    float columns[3 * MAX_TAPS], room[3 * MAX_TAPS], least[3], most[3] = {0};
    int samples = 3 * tx->count;
    for (int c = 0; c < 3; c++) least[c] = INFINITY;
    for (int k = 0; k < samples; k++) columns[k] = 0;
    for (int j = 0; j < ty->count; j++) {
        const float *row = samples_under(photo, ty->first + j, tx, room), weight = ty->weight[j];
        for (int k = 0; k < samples; k++) columns[k] += weight * row[k];
        if (j < ty->near_begin || j >= ty->near_end) continue;
        for (int i = tx->near_begin; i < tx->near_end; i++)
            for (int c = 0; c < 3; c++) {
                float sample = row[3 * i + c];
                least[c] = sample < least[c] ? sample : least[c];
                most[c] = sample > most[c] ? sample : most[c];
            }
    }
    for (int c = 0; c < 3; c++) {
        float sum = 0;
        for (int i = 0; i < tx->count; i++) sum += tx->weight[i] * columns[3 * i + c];
        rgb[c] = sum < least[c] ? least[c] : sum > most[c] ? most[c] : sum;
    }
}

/* Is one of the samples masked that are within one lobe of u, v, of so many pixels each way? */
static bool is_masked(const struct resample *r, double u, double v, double wide, double high)
{
    const int x1 = (int)floor(u - 0.5 + wide), y1 = (int)floor(v - 0.5 + high);
    for (int y = (int)ceil(v - 0.5 - high); r->masked && y <= y1; y++) {
        const size_t row = (size_t)clamp_int(y, r->photo->height - 1) * (size_t)r->photo->width;
        for (int x = (int)ceil(u - 0.5 - wide); x <= x1; x++)
            if (r->masked[row + (size_t)clamp_int(x, r->photo->width - 1)]) return true;
    }
    return false;
}

/* Do the knots about the interval from knot[0] to knot[1] lie on cubics? */
static bool is_smooth(const struct place *knot)
{
    for (int i = -MARGIN; i <= MARGIN + 1; i++)
        if (!knot[i].seen) return false;
    for (const struct place *k = knot; k < knot + 2; k++) {
        const double u = k[-2].u - 4 * k[-1].u + 6 * k[0].u - 4 * k[1].u + k[2].u;
        const double v = k[-2].v - 4 * k[-1].v + 6 * k[0].v - 4 * k[1].v + k[2].v;
        if (!(fabs(u) <= SMOOTH && fabs(v) <= SMOOTH)) return false;
    }
    return true;
}

static void project_row(const struct resample *r, int y, struct place *row, struct place *knots)
{
    const int width = r->view->width, intervals = width / KNOTS + 1;
    for (int k = -MARGIN; k <= intervals + MARGIN; k++) knots[k + MARGIN] = photo_from_pixel(r, k * KNOTS, y);
    for (int k = 0; k < intervals; k++) {
        const struct place *p = knots + k + MARGIN;
        const int x0 = k * KNOTS, end = width - x0 < KNOTS ? width - x0 + 1 : KNOTS;
        const bool smooth = is_smooth(p);
        row[x0] = *p;
        for (int i = 1; i < end; i++) {
            if (!smooth) {
                row[x0 + i] = photo_from_pixel(r, x0 + i, y);
                continue;
            }
            const double t = (double)i / KNOTS, before = -t * (t - 1) * (t - 2) / 6,
                         at = (t + 1) * (t - 1) * (t - 2) / 2;
            const double next = -(t + 1) * t * (t - 2) / 2, after = (t + 1) * t * (t - 1) / 6;
            row[x0 + i] = (struct place){before * p[-1].u + at * p[0].u + next * p[1].u + after * p[2].u,
                                         before * p[-1].v + at * p[0].v + next * p[1].v + after * p[2].v, true};
        }
    }
}

/* Six samples each way from x, y on. */
static void filter_sharp(const struct resample *r, float rgb[3], int x, int y, double behind_x, double behind_y)
{
    const size_t stride = 3 * (size_t)r->photo->width;
    const float *rows = image_at(r->photo, x, y);
    float weights[2][SHARP], columns[3 * SHARP] = {0};
    for (int k = 0; k < 2; k++) {
        const float at = (float)((k ? behind_y : behind_x) * STEPS);
        const int j = (int)at < STEPS ? (int)at : STEPS - 1;
        const float part = at - (float)j;
        for (int i = 0; i < SHARP; i++) weights[k][i] = r->sharp[j][i] + part * (r->sharp[j + 1][i] - r->sharp[j][i]);
    }
    for (int j = 0; j < SHARP; j++)
        for (int k = 0; k < 3 * SHARP; k++) columns[k] += weights[1][j] * rows[(size_t)j * stride + (size_t)k];
    const float *near = rows + (LOBES - 1) * stride + 3 * (LOBES - 1), *below = near + stride;
    for (int c = 0; c < 3; c++) {
        const float a = near[c] < near[c + 3] ? near[c] : near[c + 3],
                    b = near[c] < near[c + 3] ? near[c + 3] : near[c];
        const float d = below[c] < below[c + 3] ? below[c] : below[c + 3],
                    e = below[c] < below[c + 3] ? below[c + 3] : below[c];
        const float least = a < d ? a : d, most = b > e ? b : e;
        float sum = 0;
        for (int i = 0; i < SHARP; i++) sum += weights[0][i] * columns[3 * i + c];
        rgb[c] = sum < least ? least : sum > most ? most : sum;
    }
}

/* One-sided differences suffice for a filter's width; where the lens ends they are taken to the other side. */
static void resample_pixel(const struct resample *r, int x, int y, const struct place *here, const struct place *below)
{
    struct place at = here[x], right = here[x + 1], down = below[x];
    struct taps tx, ty;
    if (!at.seen || at.u < 0 || at.v < 0 || at.u > r->photo->width || at.v > r->photo->height) return;
    if (!right.seen) right = photo_from_pixel(r, x - 1, y);
    if (!right.seen) right = at;
    if (!down.seen) down = photo_from_pixel(r, x, y - 1);
    if (!down.seen) down = at;
    const double ru = right.u - at.u, du = down.u - at.u, rv = right.v - at.v, dv = down.v - at.v;
    const double across = ru * ru + du * du, along = rv * rv + dv * dv;
    const double su = across > 1 ? fmin(sqrt(across), MAX_REDUCTION) : 1;
    const double sv = along > 1 ? fmin(sqrt(along), MAX_REDUCTION) : 1;
    const int u = (int)floor(at.u - 0.5) - LOBES + 1, v = (int)floor(at.v - 0.5) - LOBES + 1;
    float *out = image_at(r->out, x, y);
    if (is_masked(r, at.u, at.v, su, sv)) return;
    out[3] = 1;
    if (su > 1 || sv > 1 || u < 0 || v < 0 || u + SHARP > r->photo->width || v + SHARP > r->photo->height) {
        make_taps(&tx, r->kernel, at.u, su);
        make_taps(&ty, r->kernel, at.v, sv);
        filter(out, r->photo, &tx, &ty);
    } else {
        filter_sharp(r, out, u, v, at.u - 0.5 - floor(at.u - 0.5), at.v - 0.5 - floor(at.v - 0.5));
    }
}

static void resample_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct resample *r = ctx;
    size_t row = (size_t)r->view->width + 1;
    struct place *here = r->places + r->places_of_thread * (size_t)thread, *below = here + row, *knots = below + row;
    project_row(r, (int)begin, here, knots);
    for (int y = (int)begin; y < (int)end; y++) {
        project_row(r, y + 1, below, knots);
        for (int x = 0; x < r->view->width; x++) resample_pixel(r, x, y, here, below);
        struct place *done = here;
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
        return err_set(err, ST_DATA,
                       "the photo has %d x %d pixels but its camera %d x %d: it was exchanged after structure from "
                       "motion; redo that (make resfm) or put the old photo back.",
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
    r.places_of_thread = 2 * ((size_t)view->width + 1) + (size_t)view->width / KNOTS + 2 + 2 * MARGIN;
    size_t room = r.places_of_thread * (size_t)parallel_threads() * sizeof *r.places;
    r.places = malloc(room);
    if (!r.places) {
        image_release(out);
        return err_nomem(err, "rows of a view", room);
    }
    make_kernel(r.kernel);
    make_sharp(r.sharp, r.kernel);
    parallel_for((size_t)view->height, CHUNK, resample_rows, &r);
    free(r.places);
    return ST_OK;
}
