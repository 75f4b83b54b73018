/* morph.c - see morph.h: pictures between two.
 *
 * Each picture is a sheet whose pixels have gone the part t of their way (the second one's 1 - t, backwards). Between
 * four neighbours that flow alike the sheet is stretched; where it tears, at a border of something nearer, each pixel
 * keeps its own square, so that the gap between them shows what the other picture has there. Where sheets fold, what is
 * nearer wins. The two are blended by t and by how sure they are: what only one of the photos saw comes from it
 * alone. */
#include "stages/morph_views/morph.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"

#define TEAR      1.0f  /* px: neighbours whose flows differ by more are not one surface */
#define ROOM      0.02f /* px by which pieces of a sheet overlap */
#define UNSURE    0.02f /* weight of what is not sure */
#define APART     2.0f  /* px: two pictures that show things farther apart from each other contradict each other */
#define SURE_RANK 0.5f  /* px of nearness that being sure is worth */

static const char *const FILES[2] = {"first.exr", "second.exr"};
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

static float *plane_place(struct morph *m, int side, int plane, size_t *step)
{
    struct flow *f = &m->flows[side];
    *step = plane < 3 ? 3 : plane < 5 ? 2 : 1;
    return plane < 3 ? m->pictures[side].data + plane : plane < 5 ? f->uv + plane - 3 : plane == 5 ? f->sure : f->near;
}

enum status morph_write(const struct morph *m, const struct view *cameras, const char *folder,
                        const struct provenance *prov, struct err *err)
{
    enum status st = ST_OK;
    for (int side = 1; !st && side >= 0; side--) { /* the first one last */
        struct exr_image im = {0};
        char path[FILE_PATH], gain[128];
        const size_t n = (size_t)m->pictures[side].width * (size_t)m->pictures[side].height;
        st = file_path(path, folder, FILES[side], "", err);
        if (!st) st = exr_image_init(&im, m->pictures[side].width, m->pictures[side].height, err);
        for (int k = 0; !st && k < 7; k++) {
            struct exr_plane *plane;
            size_t step;
            const float *from = plane_place((struct morph *)m, side, k, &step);
            st = exr_add_plane(&im, PLANES[k], k < 3 || k == 5 ? EXR_HALF : EXR_FLOAT, &plane, err);
            for (size_t p = 0; !st && p < n; p++) plane->f[p] = from[step * p];
        }
        snprintf(gain, sizeof gain, "%.9g %.9g %.9g", m->gain[0], m->gain[1], m->gain[2]);
        if (!st) st = exr_set_attribute(&im, "remodel:radiometry", m->radiometry, err);
        if (!st) st = exr_set_attribute(&im, "remodel:gain", gain, err);
        if (!st && cameras) exr_set_camera(&im, &cameras[side]);
        if (!st) st = exr_write(&im, path, prov, err);
        exr_image_release(&im);
    }
    return st;
}

static enum status read_side(struct morph *m, int side, const char *path, struct err *err)
{
    struct exr_image im = {0};
    enum status st = exr_read(&im, path, PLANES, 7, err);
    for (int k = 0; !st && k < 7; k++)
        if (!exr_find(&im, PLANES[k])->f)
            st = err_set(err, ST_DATA, "%s: channel %s holds integers, wanted half or float; make the morph again.",
                         path, PLANES[k]);
    if (!st && (im.width < 4 || im.height < 4 ||
                (side && (im.width != m->pictures[0].width || im.height != m->pictures[0].height))))
        st = err_set(err, ST_DATA, "%s has %d x %d pixels, but %s %d x %d; make the morph again.", path, im.width,
                     im.height, FILES[0], m->pictures[0].width, m->pictures[0].height);
    if (!st) st = image_init(&m->pictures[side], im.width, im.height, 3, err);
    if (!st) st = flow_init(&m->flows[side], im.width, im.height, err);
    const float longest = (float)(im.width > im.height ? im.width : im.height);
    const size_t n = (size_t)im.width * (size_t)im.height;
    for (int k = 0; !st && k < 7; k++) {
        size_t step;
        float *to = plane_place(m, side, k, &step);
        const float *from = exr_find(&im, PLANES[k])->f;
        for (size_t p = 0; p < n; p++) to[step * p] = from[p];
        for (size_t p = 0; !st && (k == 3 || k == 4) && p < n; p++)
            if (fabsf(from[p]) > longest)
                st = err_set(
                    err, ST_DATA,
                    "%s: channel %s is %g at pixel (%zu, %zu), farther than the picture is large (%d x %d); make "
                    "the morph again.",
                    path, PLANES[k], from[p], p % (size_t)im.width, p / (size_t)im.width, im.width, im.height);
    }
    const char *gain = exr_attribute(&im, "remodel:gain"), *radiometry = exr_attribute(&im, "remodel:radiometry");
    if (!st && side == 0) {
        int count = gain ? sscanf(gain, "%lf %lf %lf", &m->gain[0], &m->gain[1], &m->gain[2]) : 0;
        bool good = count == 3;
        for (int c = 0; good && c < 3; c++) good = m->gain[c] > 1e-6 && m->gain[c] < 1e6;
        if (!good)
            st = err_set(err, ST_DATA, "%s: the attribute remodel:gain is \"%s\", wanted three numbers above 0.", path,
                         gain ? gain : "");
        snprintf(m->radiometry, sizeof m->radiometry, "%s", radiometry ? radiometry : "approximate");
    }
    exr_image_release(&im);
    return st;
}

enum status morph_read(struct morph *m, const char *folder, struct err *err)
{
    char path[FILE_PATH];
    for (int side = 0; side < 2; side++)
        if (file_path(path, folder, FILES[side], "", err) || read_side(m, side, path, err)) return err->status;
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
                if (f->sure[p] < 1 || u < 0 || v < 0 || u >= f->width || v >= f->height) continue;
                float a = image_at(&m->pictures[0], x, y)[c], b = image_at(&m->pictures[1], u, v)[c];
                if (a < 0.005f || b < 0.005f || a > 0.9f || b > 0.9f) continue; /* noise, or cut at white */
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

/* Catmull-Rom, kept within the four samples around: no halo where something nearer begins. */
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
    float sum[3] = {0}, least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {0};
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            int qx = ix + i - 1, qy = iy + j - 1;
            qx = qx < 0 ? 0 : qx > im->width - 1 ? im->width - 1 : qx;
            qy = qy < 0 ? 0 : qy > im->height - 1 ? im->height - 1 : qy;
            const float *in = image_at(im, qx, qy);
            for (int c = 0; c < 3; c++) {
                sum[c] += wx[i] * wy[j] * in[c];
                if (i == 0 || i == 3 || j == 0 || j == 3) continue;
                least[c] = fminf(least[c], in[c]);
                most[c] = fmaxf(most[c], in[c]);
            }
        }
    for (int c = 0; c < 3; c++) out[c] = fminf(fmaxf(sum[c], least[c]), most[c]);
}

/* --------------------------------------------------------------------------------------------------------- sheets */

struct hit { /* what a frame's pixel shows of a picture: a place in it */
    float x, y, rank;
};

struct sheet {
    const struct flow *flow;
    float t; /* part of the way gone */
    int width, height;
    struct hit *hits;
};

static void put(const struct sheet *s, int x, int y, float from_x, float from_y, float rank)
{
    struct hit *h = &s->hits[(size_t)y * (size_t)s->width + (size_t)x];
    if (rank > h->rank) *h = (struct hit){from_x, from_y, rank};
}

struct corner {
    float x, y, rank; /* where it has gone */
    int from_x, from_y;
};

static int first_pixel(float least) { return (int)ceilf(fmaxf(least - ROOM, 0)); }
static int last_pixel(float most, int size) { return (int)floorf(fminf(most + ROOM, (float)(size - 1))); }

static void put_triangle(const struct sheet *s, const struct corner *a, const struct corner *b, const struct corner *c)
{
    float area = (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
    if (!(area > 1e-3f)) return; /* folded over: seen from behind */
    int x0 = first_pixel(fminf(a->x, fminf(b->x, c->x))), x1 = last_pixel(fmaxf(a->x, fmaxf(b->x, c->x)), s->width);
    int y0 = first_pixel(fminf(a->y, fminf(b->y, c->y))), y1 = last_pixel(fmaxf(a->y, fmaxf(b->y, c->y)), s->height);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            float px = (float)x - a->x, py = (float)y - a->y;
            float wb = (px * (c->y - a->y) - py * (c->x - a->x)) / area;
            float wc = (py * (b->x - a->x) - px * (b->y - a->y)) / area;
            if (wb < -ROOM || wc < -ROOM || wb + wc > 1 + ROOM) continue;
            float wa = 1 - wb - wc;
            put(s, x, y, wa * (float)a->from_x + wb * (float)b->from_x + wc * (float)c->from_x,
                wa * (float)a->from_y + wb * (float)b->from_y + wc * (float)c->from_y,
                wa * a->rank + wb * b->rank + wc * c->rank);
        }
}

/* The quarter of a pixel's square that lies in the cell, moved along. */
static void put_quarter(const struct sheet *s, const struct corner *c, int right, int down)
{
    float x = right ? c->x - 0.5f : c->x, y = down ? c->y - 0.5f : c->y;
    int x0 = first_pixel(x), x1 = last_pixel(x + 0.5f, s->width), y0 = first_pixel(y),
        y1 = last_pixel(y + 0.5f, s->height);
    for (int v = y0; v <= y1; v++)
        for (int u = x0; u <= x1; u++) put(s, u, v, (float)c->from_x, (float)c->from_y, c->rank - ROOM);
}

static void lay_sheet(const struct sheet *s)
{
    const struct flow *f = s->flow;
    const size_t w = (size_t)s->width, n = w * (size_t)s->height;
    for (size_t p = 0; p < n; p++) s->hits[p] = (struct hit){0, 0, -INFINITY};
    for (int y = 0; y + 1 < s->height; y++)
        for (int x = 0; x + 1 < s->width; x++) {
            struct corner corners[4];
            float least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
            for (int k = 0; k < 4; k++) {
                int qx = x + (k & 1), qy = y + (k >> 1);
                size_t q = (size_t)qy * w + (size_t)qx;
                corners[k] = (struct corner){(float)qx + s->t * f->uv[2 * q], (float)qy + s->t * f->uv[2 * q + 1],
                                             f->near[q] + SURE_RANK * f->sure[q], qx, qy};
                for (int a = 0; a < 2; a++) {
                    least[a] = fminf(least[a], f->uv[2 * q + (size_t)a]);
                    most[a] = fmaxf(most[a], f->uv[2 * q + (size_t)a]);
                }
            }
            if (most[0] - least[0] <= TEAR && most[1] - least[1] <= TEAR) {
                put_triangle(s, &corners[0], &corners[1], &corners[2]);
                put_triangle(s, &corners[1], &corners[3], &corners[2]);
            } else {
                for (int k = 0; k < 4; k++) put_quarter(s, &corners[k], k & 1, k >> 1);
            }
        }
}

/* -------------------------------------------------------------------------------------------------------- blending */

static void blend(float rgba[4], float *rank, const struct morph *m, const struct hit *hits[2], double t)
{
    float weight[2], colour[2][3], place[2][2], sure[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        const struct hit *h = hits[i];
        weight[i] = 0;
        if (h->rank == -INFINITY) continue;
        size_t q = (size_t)lrintf(h->y) * (size_t)m->flows[i].width + (size_t)lrintf(h->x);
        sure[i] = m->flows[i].sure[q];
        weight[i] = (UNSURE + (1 - UNSURE) * sure[i]) * (float)(i ? t : 1 - t);
        place[i][0] = h->x + m->flows[i].uv[2 * q];
        place[i][1] = h->y + m->flows[i].uv[2 * q + 1];
        sample(&m->pictures[i], h->x, h->y, colour[i]);
        for (int c = 0; c < 3; c++) colour[i][c] *= (float)pow(m->gain[c], i ? t - 1 : t);
    }
    if (sure[0] + sure[1] >= 0.5f && weight[0] > 0 && weight[1] > 0 &&
        hypotf(place[0][0] - hits[1]->x, place[0][1] - hits[1]->y) > APART &&
        hypotf(place[1][0] - hits[0]->x, place[1][1] - hits[0]->y) > APART)
        for (int i = 0; i < 2; i++) weight[i] = weight[i] * weight[i] * weight[i] * weight[i]; /* one of them, nearly */
    float sum = weight[0] + weight[1];
    for (int c = 0; c < 3; c++) {
        rgba[c] = 0;
        for (int i = 0; i < 2; i++)
            if (weight[i] > 0) rgba[c] += weight[i] / sum * colour[i][c];
    }
    rgba[3] = 1;
    *rank = hits[weight[1] > weight[0]]->rank;
}

/* What neither picture shows is a crack, or hidden in both: of what eight directions meet first, the second, third and
 * fourth farthest (the farthest alone may be a wrong match). */
static void fill_holes(struct rendered_frame *f)
{
    static const int ways[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
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
                    qx += ways[d][0];
                    qy += ways[d][1];
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
    struct hit *hits = NULL;
    float least = INFINITY, most = -INFINITY;
    size_t holes = 0;
    if (rendered_frame_resize(out, width, height, true, err)) return err->status;
    if (t <= 0 || t >= 1) {
        copy_picture(out, &m->pictures[t >= 1]);
        return ST_OK;
    }
    if (!(hits = malloc(2 * n * sizeof *hits))) return err_nomem(err, "a frame", 2 * n * sizeof *hits);
    for (int i = 0; i < 2; i++) {
        struct sheet s = {&m->flows[i], (float)(i ? 1 - t : t), width, height, hits + (size_t)i * n};
        lay_sheet(&s);
    }
    for (size_t p = 0; p < n; p++) {
        const struct hit *pair[2] = {&hits[p], &hits[n + p]};
        out->hole[p] = pair[0]->rank == -INFINITY && pair[1]->rank == -INFINITY;
        holes += out->hole[p];
        if (out->hole[p]) {
            memset(out->rgba + 4 * p, 0, 4 * sizeof(float));
            continue;
        }
        blend(out->rgba + 4 * p, &out->z[p], m, pair, t);
        least = fminf(least, out->z[p]);
        most = fmaxf(most, out->z[p]);
    }
    free(hits);
    for (size_t p = 0; p < n; p++) out->z[p] = out->hole[p] ? 0 : 1 + most - out->z[p]; /* far is what ranks low */
    out->hole_fraction = (double)holes / (double)n;
    fill_holes(out);
    return ST_OK;
}
