/* fill_path.c - see fill_path.h.
 *
 * A point falls between four pixels and goes to those of them that are empty, by bilinear weight. Of the points of one
 * anchor in a pixel those count that the soft z holds with the nearest; the sum of their weights, 1 at most, says how
 * well the anchor covers the pixel. A pixel that is covered by less than LEAST_COVER in both anchors stays empty. The
 * others get the mean of the two anchors, weighted by cover and by nearness along the path: 1 - t and t, t the part of
 * the way from the one to the other. What the frame knows is never changed. */
#include "stages/render_views/fill_path.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_COVER 0.25f
#define IN_FRONT    0.25f /* of a pixel a point must hold to hide others there */
#define NO_SLOT     UINT32_MAX

void fill_path_init(struct fill_path *fill, const struct camera_path *path, fill_path_render *render, void *ctx,
                    const struct fill_path_options *options)
{
    *fill = (struct fill_path){.path = path, .render = render, .ctx = ctx, .options = *options};
    for (int i = 0; i < FILL_ANCHORS_MOST; i++) fill->anchors[i].index = -1;
}

static void anchor_drop(struct fill_anchor *a)
{
    free(a->points);
    *a = (struct fill_anchor){.index = -1};
}

void fill_path_release(struct fill_path *fill)
{
    if (!fill) return;
    for (int i = 0; i < FILL_ANCHORS_MOST; i++) anchor_drop(&fill->anchors[i]);
}

/* ------------------------------------------------------------------------------------- points seen by a camera */

struct hole_pixel { /* what the points of one anchor, then of both, make of an empty pixel */
    float z_near;   /* of one anchor */
    float one[5];   /* of one anchor: r g b z weight */
    float both[5];
    float cover; /* the better one's */
};

struct cover {
    const struct view *camera;
    const struct exemplar_depth *depth;
    int w, h;
    const uint32_t *slots; /* a pixel: index into pixels, or NO_SLOT */
    struct hole_pixel *pixels;
};

/* The empty pixels that a point falls on, with their weights. */
static int point_pixels(const struct cover *c, const struct fill_point *p, struct hole_pixel *at[4], float weights[4],
                        float *z)
{
    double u, v;
    int count = 0;

    *z = (float)view_project(c->camera, p->at, &u, &v);
    if (!(*z > 0) || !(u > -1 && v > -1 && u < c->w + 1 && v < c->h + 1)) return 0;
    const double x = floor(u - 0.5), y = floor(v - 0.5);
    const float fx = (float)(u - 0.5 - x), fy = (float)(v - 0.5 - y);
    for (int k = 0; k < 4; k++) {
        const int px = (int)x + (k & 1), py = (int)y + (k >> 1);
        if (px < 0 || py < 0 || px >= c->w || py >= c->h) continue;
        const uint32_t slot = c->slots[(size_t)py * (size_t)c->w + (size_t)px];
        weights[count] = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy);
        if (slot == NO_SLOT || !(weights[count] > 0)) continue;
        at[count++] = &c->pixels[slot];
    }
    return count;
}

static void add_anchor(const struct cover *c, size_t pixels, const struct fill_anchor *anchor, float share)
{
    const struct exemplar_depth *d = c->depth;
    struct hole_pixel *at[4];
    float weights[4], z;

    for (size_t i = 0; i < pixels; i++) {
        c->pixels[i].z_near = INFINITY;
        memset(c->pixels[i].one, 0, sizeof c->pixels[i].one);
    }
    for (size_t i = 0; i < anchor->count; i++)
        for (int k = point_pixels(c, &anchor->points[i], at, weights, &z); k-- > 0;)
            if (weights[k] >= IN_FRONT) at[k]->z_near = fminf(at[k]->z_near, z);
    for (size_t i = 0; i < anchor->count; i++)
        for (int k = point_pixels(c, &anchor->points[i], at, weights, &z); k-- > 0;) {
            float w = weights[k], *one = at[k]->one;
            if (z > at[k]->z_near) {
                const float rho = soft_z_rho(&d->soft, z, d->sigma, at[k]->z_near, d->sigma);
                w *= soft_z_weight(z - at[k]->z_near, 0.1f * rho, rho);
            }
            for (int n = 0; n < 3; n++) one[n] += w * anchor->points[i].rgb[n];
            one[3] += w * z;
            one[4] += w;
        }
    for (size_t i = 0; i < pixels; i++) {
        struct hole_pixel *p = &c->pixels[i];
        if (!(p->one[4] > 0)) continue;
        const float cover = fminf(1, p->one[4]), w = share * cover / p->one[4];
        for (int n = 0; n < 5; n++) p->both[n] += w * p->one[n];
        p->cover = fmaxf(p->cover, cover);
    }
}

/* Fills what the anchors' points cover. b may be NULL; t is its share. */
static enum status take_over(const struct fill_path *fill, const struct fill_anchor *a, const struct fill_anchor *b,
                             float t, const struct view *camera, struct rendered_frame *f, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    uint32_t *slots = malloc(pixels * sizeof *slots), count = 0;
    struct hole_pixel *holes = NULL;
    enum status st = ST_OK;

    if (!slots) return err_nomem(err, "the holes of a frame", pixels * sizeof *slots);
    for (size_t p = 0; p < pixels; p++) slots[p] = f->rgba[4 * p + 3] > 0 ? NO_SLOT : count++;
    if (!count) goto done;
    holes = calloc(count, sizeof *holes);
    if (!holes) {
        st = err_nomem(err, "the holes of a frame", count * sizeof *holes);
        goto done;
    }
    const struct cover c = {camera, &fill->options.depth, f->width, f->height, slots, holes};
    if (t < 1) add_anchor(&c, count, a, 1 - t);
    if (b && t > 0) add_anchor(&c, count, b, t);
    for (size_t p = 0; p < pixels; p++) {
        if (slots[p] == NO_SLOT) continue;
        const struct hole_pixel *from = &holes[slots[p]];
        if (from->cover < LEAST_COVER || !(from->both[4] > 0)) continue;
        for (size_t k = 0; k < 3; k++) f->rgba[4 * p + k] = from->both[k] / from->both[4];
        f->rgba[4 * p + 3] = 1;
        f->z[p] = from->both[3] / from->both[4];
    }
done:
    free(holes);
    free(slots);
    return st;
}

/* --------------------------------------------------------------------------------------------------- anchors */

static int last_anchor(const struct fill_path *fill)
{
    const int n = fill->options.fill_anchors, last = fill->path->frame_count - 1;
    return last / n + (last % n != 0);
}

static int anchor_frame(const struct fill_path *fill, int index)
{
    const long long at = (long long)index * fill->options.fill_anchors;
    return at < fill->path->frame_count ? (int)at : fill->path->frame_count - 1;
}

/* Of b in frame `frame`, between the two. */
static float share_of(const struct fill_path *fill, const struct fill_anchor *a, const struct fill_anchor *b, int frame)
{
    const int from = anchor_frame(fill, a->index), to = anchor_frame(fill, b->index);
    return (float)(frame - from) / (float)(to - from);
}

/* Renders and fills anchor `index`, from a and b (NULL: there is none yet), and keeps what was filled. */
static enum status anchor_make(struct fill_path *fill, struct fill_anchor *to, int index, const struct fill_anchor *a,
                               const struct fill_anchor *b, struct err *err)
{
    const struct fill_path_options *o = &fill->options;
    const int frame = anchor_frame(fill, index);
    const struct view *camera = &fill->path->frames[frame].camera;
    struct rendered_frame f = {0};
    uint32_t *empty = NULL;
    size_t count = 0;

    anchor_drop(to);
    enum status st = fill->render(fill->ctx, frame, &f, err);
    fill->rendered++;
    const size_t pixels = (size_t)f.width * (size_t)f.height;
    if (!st) {
        for (size_t p = 0; p < pixels; p++) count += !(f.rgba[4 * p + 3] > 0);
        empty = malloc((count + 1) * sizeof *empty);
        to->points = malloc((count + 1) * sizeof *to->points);
        if (!empty || !to->points) st = err_nomem(err, "what was filled in a frame", count * sizeof *to->points);
    }
    if (!st) {
        count = 0;
        for (size_t p = 0; p < pixels; p++)
            if (!(f.rgba[4 * p + 3] > 0)) empty[count++] = (uint32_t)p;
        if (a) st = take_over(fill, a, b, b ? share_of(fill, a, b, frame) : 0, camera, &f, err);
    }
    if (!st) st = exemplar_fill(&f, &o->depth, o->fill_diameter, &o->exemplar, NULL, err);
    for (size_t i = 0; !st && i < count; i++) {
        const size_t p = empty[i];
        struct fill_point *point = &to->points[to->count];
        if (!(f.z[p] > 0)) continue;
        point->at = view_unproject(camera, (double)(p % (size_t)f.width) + 0.5, (double)(p / (size_t)f.width) + 0.5,
                                   (double)f.z[p]);
        memcpy(point->rgb, f.rgba + 4 * p, sizeof point->rgb);
        to->count++;
    }
    if (!st)
        to->index = index;
    else
        anchor_drop(to);
    free(empty);
    rendered_frame_release(&f);
    return st;
}

/* The anchors around a frame; *b is NULL if the frame is anchor a itself. */
static enum status anchors_around(struct fill_path *fill, int frame, const struct fill_anchor **a,
                                  const struct fill_anchor **b, struct err *err)
{
    struct fill_anchor *kept = fill->anchors, *lo = &kept[0], *hi = &kept[1];
    const int last = last_anchor(fill);
    enum status st = ST_OK;

    if (lo->index < 0) st = anchor_make(fill, lo, 0, NULL, NULL, err);
    *a = lo;
    *b = NULL;
    if (st || frame == 0) return st;
    if (hi->index < 0) st = anchor_make(fill, hi, last, lo, NULL, err);
    for (int level = 2; !st; level++) {
        *a = lo;
        *b = hi;
        if (frame == anchor_frame(fill, hi->index)) *a = hi;
        if (frame == anchor_frame(fill, (*a)->index)) *b = NULL;
        if (!*b || hi->index - lo->index <= 1) break;
        /* the middle of these two, whatever was asked for before: its place among the kept says which it halves */
        const int index = lo->index + (hi->index - lo->index) / 2;
        struct fill_anchor *middle = &kept[level];
        if (middle->index != index) st = anchor_make(fill, middle, index, lo, hi, err);
        if (frame < anchor_frame(fill, index))
            hi = middle;
        else
            lo = middle;
    }
    return st;
}

enum status fill_path_frame(struct fill_path *fill, int frame, const struct view *camera, struct rendered_frame *f,
                            struct err *err)
{
    const struct fill_path_options *o = &fill->options;
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    const struct fill_anchor *a, *b;
    bool empty = false;
    enum status st = ST_OK;

    for (size_t p = 0; p < pixels && !empty; p++) empty = !(f->rgba[4 * p + 3] > 0);
    if (empty && o->fill_diameter > 0 && o->fill_anchors > 0) {
        st = anchors_around(fill, frame, &a, &b, err);
        if (!st) st = take_over(fill, a, b, b ? share_of(fill, a, b, frame) : 0, camera, f, err);
    }
    if (!st) st = exemplar_fill(f, &o->depth, o->fill_diameter, &o->exemplar, &fill->stats, err);
    return st;
}

/* ---------------------------------------------------------------------------------------------------- flicker */

void fill_flicker_add(double *difference, double *pixels, const struct rendered_frame *a, const struct view *camera_a,
                      const struct rendered_frame *b, const struct view *camera_b)
{
    const size_t wa = (size_t)a->width, wb = (size_t)b->width;

    for (size_t p = 0; p < wa * (size_t)a->height; p++) {
        double u, v;
        if (!a->hole[p] || !(a->rgba[4 * p + 3] > 0) || !(a->z[p] > 0)) continue;
        const struct vec3 at =
            view_unproject(camera_a, (double)(p % wa) + 0.5, (double)(p / wa) + 0.5, (double)a->z[p]);
        if (!(view_project(camera_b, at, &u, &v) > 0)) continue;
        if (!(u >= 0.5 && v >= 0.5 && u < b->width - 0.5 && v < b->height - 0.5)) continue;
        const size_t q = (size_t)(v - 0.5) * wb + (size_t)(u - 0.5);
        const size_t around[4] = {q, q + 1, q + wb, q + wb + 1};
        const double fx = u - 0.5 - floor(u - 0.5), fy = v - 0.5 - floor(v - 0.5);
        const double weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
        double sum = 0;
        bool filled = true; /* a near object beside the hole is another matter */
        for (int k = 0; k < 4; k++) filled &= b->hole[around[k]] && b->rgba[4 * around[k] + 3] > 0;
        if (!filled) continue;
        for (size_t c = 0; c < 3; c++) {
            double other = 0;
            for (int k = 0; k < 4; k++) other += weights[k] * sqrt(fmax(0, (double)b->rgba[4 * around[k] + c]));
            sum += fabs(sqrt(fmax(0, (double)a->rgba[4 * p + c])) - other) / 3;
        }
        *difference += sum;
        *pixels += 1;
    }
}
