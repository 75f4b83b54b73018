/* morph.c - view morphing by linear interpolation between matches [Colburn 2014, 3.4.5], with forward warping.
 *
 * The first picture is warped by t of its flow, the second by 1 - t of its own. Four neighbours of similar flow span a
 * mesh cell, drawn as two triangles. At a depth discontinuity the mesh is cut: each pixel keeps its own square, so that
 * the gap shows what the other picture has there. Where the mesh folds, the nearer surface is visible. The two warped
 * pictures are blended by t and by the confidence of their flow, so a surface that only one photo shows comes from that
 * photo. Pixels that neither covers are filled from the far side.
 *
 * The thesis only says that correspondences are interpolated linearly; occlusion, blending and filling are
 * additions. */
#include "stages/morph_views/morph.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/math/numbers.h"
#include "common/product/product.h"

#define MAX_STRETCH     1.0f  /* px, max flow difference inside a mesh cell; beyond, the mesh is cut */
#define OVERLAP         0.02f /* px, between triangles and squares of the mesh */
#define MIN_WEIGHT      0.02f /* of a pixel without confidence */
#define MAX_APART       2.0f  /* px between the points that both pictures show; beyond, they contradict each other */
#define CONFIDENCE_RANK 0.5f  /* confidence 1 counts as this many px of nearness in the depth order */

static const enum product_id FILES[2] = {PRODUCT_MORPH_FIRST, PRODUCT_MORPH_SECOND};
static const char *const PLANES[7] = {"R", "G", "B", "flow.x", "flow.y", "sure", "near"};

void morph_release(struct morph *m)
{
    if (!m) return;
    for (int i = 0; i < 2; i++) {
        image_release(&m->pictures[i]);
        flow_release(&m->flows[i]);
    }
    *m = (struct morph){0};
}

/* ---------------------------------------------------------------------------------------------------------- files */

/* First value of a plane, and the step to the next pixel's. */
static float *plane_of(struct morph *m, int side, int plane, size_t *step)
{
    struct flow *f = &m->flows[side];
    *step = plane < 3 ? 3 : plane < 5 ? 2 : 1;
    return plane < 3    ? m->pictures[side].data + plane
           : plane < 5  ? f->uv + plane - 3
           : plane == 5 ? f->confidence
                        : f->nearness;
}

enum status morph_write(const struct morph *m, const struct view *cameras, const char *folder,
                        const struct provenance *prov, struct err *err)
{
    for (int side = 1; !err->status && side >= 0; side--) { /* first.exr last */
        struct exr_image im = {0};
        char path[FILE_PATH], gain[128];
        const size_t n = (size_t)m->pictures[side].width * (size_t)m->pictures[side].height;
        if (!product_path_in(path, folder, FILES[side], NULL, err))
            exr_image_init(&im, m->pictures[side].width, m->pictures[side].height, err);
        for (int k = 0; !err->status && k < 7; k++) {
            struct exr_plane *plane;
            size_t step;
            const float *from = plane_of((struct morph *)m, side, k, &step);
            exr_add_plane(&im, PLANES[k], k < 3 || k == 5 ? EXR_HALF : EXR_FLOAT, &plane, err);
            for (size_t p = 0; !err->status && p < n; p++) plane->f[p] = from[step * p];
        }
        snprintf(gain, sizeof gain, "%.9g %.9g %.9g", m->gain[0], m->gain[1], m->gain[2]);
        if (!err->status && !exr_set_attribute(&im, "remodel:radiometry", m->radiometry, err))
            exr_set_attribute(&im, "remodel:gain", gain, err);
        if (!err->status && cameras) view_image_set_camera(&im, &cameras[side]);
        if (!err->status) exr_write(&im, path, prov, err);
        exr_image_release(&im);
    }
    return err->status;
}

static enum status read_side(struct morph *m, int side, const char *path, struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    exr_read_product(&im, FILES[side], path, PLANES, 7, prov, err);
    for (int k = 0; !err->status && k < 7; k++)
        if (!exr_find(&im, PLANES[k])->f)
            err_set(err, ST_DATA, "%s: channel %s holds integers, wanted half or float; make the morph again.", path,
                    PLANES[k]);
    if (!err->status && (im.width < 4 || im.height < 4 ||
                         (side && (im.width != m->pictures[0].width || im.height != m->pictures[0].height))))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but %s has %d x %d; make the morph again.", path, im.width,
                im.height, products[FILES[0]].file, m->pictures[0].width, m->pictures[0].height);
    if (!err->status && !image_init(&m->pictures[side], im.width, im.height, 3, err))
        flow_init(&m->flows[side], im.width, im.height, err);
    const float longest = (float)(im.width > im.height ? im.width : im.height);
    const size_t n = (size_t)im.width * (size_t)im.height;
    for (int k = 0; !err->status && k < 7; k++) {
        size_t step;
        float *to = plane_of(m, side, k, &step);
        const float *from = exr_find(&im, PLANES[k])->f;
        for (size_t p = 0; p < n; p++) to[step * p] = from[p];
        for (size_t p = 0; !err->status && (k == 3 || k == 4) && p < n; p++)
            if (fabsf(from[p]) > longest)
                err_set(
                    err, ST_DATA,
                    "%s: channel %s is %g at pixel (%zu, %zu), more than the picture's size (%d x %d); make the morph "
                    "again.",
                    path, PLANES[k], from[p], p % (size_t)im.width, p / (size_t)im.width, im.width, im.height);
    }
    const char *gain = exr_attribute(&im, "remodel:gain"), *radiometry = exr_attribute(&im, "remodel:radiometry");
    if (!err->status && side == 0) {
        m->posed = im.has_world_to_camera;
        int count = gain ? sscanf(gain, "%lf %lf %lf", &m->gain[0], &m->gain[1], &m->gain[2]) : 0;
        bool valid = count == 3;
        for (int c = 0; valid && c < 3; c++) valid = m->gain[c] > 1e-6 && m->gain[c] < 1e6;
        if (!valid)
            err_set(err, ST_DATA, "%s: the attribute remodel:gain is \"%s\", wanted three numbers above 0.", path,
                    gain ? gain : "");
        snprintf(m->radiometry, sizeof m->radiometry, "%s", radiometry ? radiometry : "approximate");
    }
    exr_image_release(&im);
    return err->status;
}

enum status morph_read(struct morph *m, const char *folder, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    for (int side = 0; side < 2; side++)
        if (product_path_in(path, folder, FILES[side], NULL, err) || read_side(m, side, path, prov, err))
            return err->status;
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- colour */

void morph_find_gain(struct morph *m)
{
    enum { BINS = 2048, PER_STOP = 128 }; /* of log2 of the ratio, 8 stops either way */
    const struct flow *f = &m->flows[0];
    for (int c = 0; c < 3; c++) {
        size_t bins[BINS] = {0}, count = 0, below = 0;
        for (int y = 0; y < f->height; y++)
            for (int x = 0; x < f->width; x++) {
                size_t p = (size_t)y * (size_t)f->width + (size_t)x;
                int u = (int)lrintf((float)x + f->uv[2 * p]), v = (int)lrintf((float)y + f->uv[2 * p + 1]);
                if (f->confidence[p] < 1 || u < 0 || v < 0 || u >= f->width || v >= f->height) continue;
                float a = image_at(&m->pictures[0], x, y)[c], b = image_at(&m->pictures[1], u, v)[c];
                if (a < 0.005f || b < 0.005f || a > 0.9f || b > 0.9f) continue; /* noise, or clipped */
                float at = (log2f(b / a) + 8) * PER_STOP;
                bins[at < 0 ? 0 : at > BINS - 1 ? BINS - 1 : (int)at]++;
                count++;
            }
        int b = 0;
        while (b < BINS - 1 && (below += bins[b]) <= count / 2) b++;
        m->gain[c] = count < 100 ? 1 : exp2((double)b / PER_STOP - 8);
        if (fabs(m->gain[c] - 1) < 0.02) m->gain[c] = 1; /* the same exposure */
    }
}

/* Catmull-Rom look-up [Catmull 1974], limited to the range of the four nearest pixels to avoid halos at edges. */
static void sample(const struct image *im, float x, float y, float out[3])
{
    int ix = (int)floorf(x), iy = (int)floorf(y);
    float fx = x - (float)ix, fy = y - (float)iy, wx[4], wy[4];
    float *const weights[2] = {wx, wy};
    for (int a = 0; a < 2; a++) {
        float f = a ? fy : fx, *w = weights[a];
        w[0] = 0.5f * f * (f * (2 - f) - 1);
        w[1] = 0.5f * (f * f * (3 * f - 5) + 2);
        w[2] = 0.5f * f * (f * (4 - 3 * f) + 1);
        w[3] = 0.5f * f * f * (f - 1);
    }
    float sum[3] = {0}, min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {0};
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            int qx = clamp_int(ix + i - 1, 0, im->width - 1), qy = clamp_int(iy + j - 1, 0, im->height - 1);
            const float *in = image_at(im, qx, qy);
            for (int c = 0; c < 3; c++) {
                sum[c] += wx[i] * wy[j] * in[c];
                if (i == 0 || i == 3 || j == 0 || j == 3) continue;
                min[c] = fminf(min[c], in[c]);
                max[c] = fmaxf(max[c], in[c]);
            }
        }
    for (int c = 0; c < 3; c++) out[c] = fminf(fmaxf(sum[c], min[c]), max[c]);
}

/* -------------------------------------------------------------------------------------------------------- warping */

struct warped_pixel { /* the point of a picture that a pixel of the frame shows */
    float x, y, rank; /* rank: depth order, greater is nearer; -INFINITY: none */
};

struct warp { /* one picture, warped by t of its flow */
    const struct flow *flow;
    float t;
    int width, height;
    struct warped_pixel *pixels;
};

static void put(const struct warp *s, int x, int y, float from_x, float from_y, float rank)
{
    struct warped_pixel *h = &s->pixels[(size_t)y * (size_t)s->width + (size_t)x];
    if (rank > h->rank) *h = (struct warped_pixel){from_x, from_y, rank};
}

struct warp_corner {    /* of a mesh cell */
    float x, y, rank;   /* in the frame */
    int from_x, from_y; /* in the picture */
};

static int first_pixel(float min) { return (int)ceilf(fmaxf(min - OVERLAP, 0)); }
static int last_pixel(float max, int size) { return (int)floorf(fminf(max + OVERLAP, (float)(size - 1))); }

static void put_triangle(const struct warp *s, const struct warp_corner *a, const struct warp_corner *b,
                         const struct warp_corner *c)
{
    float area = (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
    if (!(area > 1e-3f)) return; /* folded over: a back face */
    int x0 = first_pixel(fminf(a->x, fminf(b->x, c->x))), x1 = last_pixel(fmaxf(a->x, fmaxf(b->x, c->x)), s->width);
    int y0 = first_pixel(fminf(a->y, fminf(b->y, c->y))), y1 = last_pixel(fmaxf(a->y, fmaxf(b->y, c->y)), s->height);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            float px = (float)x - a->x, py = (float)y - a->y;
            float wb = (px * (c->y - a->y) - py * (c->x - a->x)) / area;
            float wc = (py * (b->x - a->x) - px * (b->y - a->y)) / area;
            if (wb < -OVERLAP || wc < -OVERLAP || wb + wc > 1 + OVERLAP) continue;
            float wa = 1 - wb - wc;
            put(s, x, y, wa * (float)a->from_x + wb * (float)b->from_x + wc * (float)c->from_x,
                wa * (float)a->from_y + wb * (float)b->from_y + wc * (float)c->from_y,
                wa * a->rank + wb * b->rank + wc * c->rank);
        }
}

/* The quarter of a pixel's square that lies in the cell, without stretching. */
static void put_quarter(const struct warp *s, const struct warp_corner *c, int right, int down)
{
    float x = right ? c->x - 0.5f : c->x, y = down ? c->y - 0.5f : c->y;
    int x0 = first_pixel(x), x1 = last_pixel(x + 0.5f, s->width), y0 = first_pixel(y),
        y1 = last_pixel(y + 0.5f, s->height);
    for (int v = y0; v <= y1; v++)
        for (int u = x0; u <= x1; u++) put(s, u, v, (float)c->from_x, (float)c->from_y, c->rank - OVERLAP);
}

static void draw_warp(const struct warp *s)
{
    const struct flow *f = s->flow;
    const size_t w = (size_t)s->width, n = w * (size_t)s->height;
    for (size_t p = 0; p < n; p++) s->pixels[p] = (struct warped_pixel){0, 0, -INFINITY};
    for (int y = 0; y + 1 < s->height; y++)
        for (int x = 0; x + 1 < s->width; x++) {
            struct warp_corner corners[4];
            float min[2] = {INFINITY, INFINITY}, max[2] = {-INFINITY, -INFINITY};
            for (int k = 0; k < 4; k++) {
                int qx = x + (k & 1), qy = y + (k >> 1);
                size_t q = (size_t)qy * w + (size_t)qx;
                corners[k] = (struct warp_corner){(float)qx + s->t * f->uv[2 * q], (float)qy + s->t * f->uv[2 * q + 1],
                                                  f->nearness[q] + CONFIDENCE_RANK * f->confidence[q], qx, qy};
                for (int a = 0; a < 2; a++) {
                    min[a] = fminf(min[a], f->uv[2 * q + (size_t)a]);
                    max[a] = fmaxf(max[a], f->uv[2 * q + (size_t)a]);
                }
            }
            if (max[0] - min[0] <= MAX_STRETCH && max[1] - min[1] <= MAX_STRETCH) {
                put_triangle(s, &corners[0], &corners[1], &corners[2]);
                put_triangle(s, &corners[1], &corners[3], &corners[2]);
            } else {
                for (int k = 0; k < 4; k++) put_quarter(s, &corners[k], k & 1, k >> 1);
            }
        }
}

/* -------------------------------------------------------------------------------------------------------- blending */

/* Blends what the two warped pictures show in a pixel; at least one of them shows something. */
static void blend(float rgba[4], float *rank, const struct morph *m, const struct warped_pixel *pixels[2], double t)
{
    float weight[2], colour[2][3], match[2][2], confidence[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        const struct warped_pixel *h = pixels[i];
        weight[i] = 0;
        if (h->rank == -INFINITY) continue;
        size_t q = (size_t)lrintf(h->y) * (size_t)m->flows[i].width + (size_t)lrintf(h->x);
        confidence[i] = m->flows[i].confidence[q];
        weight[i] = (MIN_WEIGHT + (1 - MIN_WEIGHT) * confidence[i]) * (float)(i ? t : 1 - t);
        match[i][0] = h->x + m->flows[i].uv[2 * q];
        match[i][1] = h->y + m->flows[i].uv[2 * q + 1];
        sample(&m->pictures[i], h->x, h->y, colour[i]);
        for (int c = 0; c < 3; c++) colour[i][c] *= (float)pow(m->gain[c], i ? t - 1 : t);
    }
    if (confidence[0] + confidence[1] >= 0.5f && weight[0] > 0 && weight[1] > 0 &&
        hypotf(match[0][0] - pixels[1]->x, match[0][1] - pixels[1]->y) > MAX_APART &&
        hypotf(match[1][0] - pixels[0]->x, match[1][1] - pixels[0]->y) > MAX_APART)
        for (int i = 0; i < 2; i++) /* contradiction: nearly only the stronger one */
            weight[i] = weight[i] * weight[i] * weight[i] * weight[i];
    float sum = weight[0] + weight[1];
    for (int c = 0; c < 3; c++) {
        rgba[c] = 0;
        for (int i = 0; i < 2; i++)
            if (weight[i] > 0) rgba[c] += weight[i] / sum * colour[i][c];
    }
    rgba[3] = 1;
    *rank = pixels[weight[1] > weight[0]]->rank;
}

/* Fills pixels that neither picture shows, cracks or points hidden in both: the mean of the second, third and fourth
 * farthest of the pixels that eight directions meet first (the farthest may be a mismatch). */
static void fill_holes(struct rendered_frame *f)
{
    static const int steps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    const size_t w = (size_t)f->width;
    size_t unfilled = 0;
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            size_t p = (size_t)y * w + (size_t)x, met[8];
            int count = 0;
            if (!f->hole[p]) continue;
            for (int d = 0; d < 8; d++) {
                int qx = x, qy = y;
                do {
                    qx += steps[d][0];
                    qy += steps[d][1];
                } while (qx >= 0 && qy >= 0 && qx < f->width && qy < f->height && f->hole[(size_t)qy * w + (size_t)qx]);
                if (qx < 0 || qy < 0 || qx >= f->width || qy >= f->height) continue;
                size_t q = (size_t)qy * w + (size_t)qx;
                int k = count++;
                for (; k > 0 && f->z[met[k - 1]] < f->z[q]; k--) met[k] = met[k - 1];
                met[k] = q;
            }
            int first = count > 1 ? 1 : 0, last = count < 4 ? count : 4;
            unfilled += count == 0;
            for (int k = first; k < last; k++)
                for (size_t c = 0; c < 4; c++) f->rgba[4 * p + c] += f->rgba[4 * met[k] + c] / (float)(last - first);
        }
    f->unfilled_fraction = (double)unfilled / ((double)f->width * (double)f->height);
}

static void copy_picture(struct rendered_frame *out, const struct image *picture)
{
    const size_t n = (size_t)picture->width * (size_t)picture->height;
    for (size_t p = 0; p < n; p++) {
        memcpy(out->rgba + 4 * p, picture->data + 3 * p, 3 * sizeof(float));
        out->rgba[4 * p + 3] = 1;
        out->z[p] = 1;
        out->hole[p] = 0;
    }
    out->hole_fraction = out->unfilled_fraction = 0;
}

enum status morph_frame(struct rendered_frame *out, const struct morph *m, double t, struct err *err)
{
    const int width = m->pictures[0].width, height = m->pictures[0].height;
    const size_t n = (size_t)width * (size_t)height;
    struct warped_pixel *pixels = NULL;
    float max = -INFINITY;
    size_t holes = 0;
    if (rendered_frame_resize(out, width, height, true, err)) return err->status;
    if (t <= 0 || t >= 1) {
        copy_picture(out, &m->pictures[t >= 1]);
        return ST_OK;
    }
    if (!(pixels = malloc(2 * n * sizeof *pixels))) return err_nomem(err, "a frame", 2 * n * sizeof *pixels);
    for (int i = 0; i < 2; i++) {
        struct warp s = {&m->flows[i], (float)(i ? 1 - t : t), width, height, pixels + (size_t)i * n};
        draw_warp(&s);
    }
    for (size_t p = 0; p < n; p++) {
        const struct warped_pixel *pair[2] = {&pixels[p], &pixels[n + p]};
        out->hole[p] = pair[0]->rank == -INFINITY && pair[1]->rank == -INFINITY;
        holes += out->hole[p];
        if (out->hole[p]) {
            memset(out->rgba + 4 * p, 0, 4 * sizeof(float));
            continue;
        }
        blend(out->rgba + 4 * p, &out->z[p], m, pair, t);
        max = fmaxf(max, out->z[p]);
    }
    free(pixels);
    for (size_t p = 0; p < n; p++) out->z[p] = out->hole[p] ? 0 : 1 + max - out->z[p]; /* low rank is far */
    out->hole_fraction = (double)holes / (double)n;
    fill_holes(out);
    return ST_OK;
}
