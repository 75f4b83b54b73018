/* fill_path.c - hole filling that is consistent along a camera path.
 *
 * Frames inpainted independently flicker, because different patches happen to match best. So some frames at fixed
 * positions of the path, the anchors (the first, every Nth and the last), are inpainted once, and their filled pixels
 * are kept as world points. The holes of a frame between two anchors get the splatted points of both, blended by the
 * position along the path; only the pixels that no point covers are inpainted. Anchors agree with each other because
 * they are filled the same way: the last from the first, the middle one from both, and so on in halves.
 *
 * Splatting: a point contributes to those of the four pixels around it that are empty, by bilinear weight. Of one
 * anchor's points in a pixel, the soft z-buffer selects those near the closest; the sum of their weights, at most 1, is
 * the anchor's cover. A pixel with a cover below MIN_COVER in both anchors stays empty. The others get the mean of both
 * anchors, weighted by cover and by 1 - t and t, where t is the position between the anchors. Known pixels never
 * change.
 *
 * This is not in the thesis, which inpaints each frame by itself. */
#include "stages/render_views/fill_path.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define MIN_COVER  0.25f
#define MIN_HIDING 0.25f /* min weight of a point in a pixel to hide others there */
#define NO_SLOT    UINT32_MAX

void fill_path_init(struct fill_path *fill, const struct camera_path *path, fill_path_render *render, void *ctx,
                    const struct fill_path_options *options)
{
    *fill = (struct fill_path){.path = path, .render = render, .ctx = ctx, .options = *options};
    for (int i = 0; i < FILL_MAX_ANCHORS; i++) fill->anchors[i].index = -1;
}

static void anchor_drop(struct fill_anchor *a)
{
    free(a->points);
    *a = (struct fill_anchor){.index = -1};
}

void fill_path_release(struct fill_path *fill)
{
    if (!fill) return;
    for (int i = 0; i < FILL_MAX_ANCHORS; i++) anchor_drop(&fill->anchors[i]);
}

/* Inpaints what is left empty in a frame of this camera. */
static enum status inpaint(const struct fill_path *fill, struct rendered_frame *f, const struct view *camera,
                           struct exemplar_stats *stats, struct err *err)
{
    const struct fill_path_options *o = &fill->options;
    const struct hole_photos photos = o->photos ? o->photos(fill->ctx, camera) : (struct hole_photos){0};
    return exemplar_fill(f, &photos, &o->depth, o->fill_diameter, &o->exemplar, stats, err);
}

/* -------------------------------------------------------------------------------------------------- splatting */

struct hole_pixel { /* sums in an empty pixel */
    float z_near;   /* closest point of the current anchor */
    float one[5];   /* of the current anchor: r g b z weight */
    float both[5];  /* of both anchors */
    float cover;    /* max of the anchors' */
};

struct splatting {
    const struct view *camera;
    const struct exemplar_depth *depth;
    int w, h;
    const uint32_t *slots; /* of each pixel: index into pixels, or NO_SLOT */
    struct hole_pixel *pixels;
};

/* The empty pixels that a point contributes to, their weights and the point's depth. Returns their number. */
static int point_pixels(const struct splatting *c, const struct fill_point *p, struct hole_pixel *at[4],
                        float weights[4], float *z)
{
    double u, v;
    int count = 0;

    *z = (float)view_project(c->camera, p->position, &u, &v);
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

/* Adds an anchor's points with weight `share`. */
static void splat_anchor(const struct splatting *c, size_t pixels, const struct fill_anchor *anchor, float share)
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
            if (weights[k] >= MIN_HIDING) at[k]->z_near = fminf(at[k]->z_near, z);
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

/* Fills the holes that the points of anchors a and b cover. b may be NULL; t: weight of b, 1 - t that of a. */
static enum status splat_anchors(const struct fill_path *fill, const struct fill_anchor *a, const struct fill_anchor *b,
                                 float t, const struct view *camera, struct rendered_frame *f, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    uint32_t *slots = malloc(pixels * sizeof *slots), count = 0;
    struct hole_pixel *holes = NULL;

    if (!slots) return err_nomem(err, "the holes of a frame", pixels * sizeof *slots);
    for (size_t p = 0; p < pixels; p++) slots[p] = f->rgba[4 * p + 3] > 0 ? NO_SLOT : count++;
    if (!count) goto done;
    holes = calloc(count, sizeof *holes);
    if (!holes) {
        err_nomem(err, "the holes of a frame", count * sizeof *holes);
        goto done;
    }
    const struct splatting c = {camera, &fill->options.depth, f->width, f->height, slots, holes};
    if (t < 1) splat_anchor(&c, count, a, 1 - t);
    if (b && t > 0) splat_anchor(&c, count, b, t);
    for (size_t p = 0; p < pixels; p++) {
        if (slots[p] == NO_SLOT) continue;
        const struct hole_pixel *from = &holes[slots[p]];
        if (from->cover < MIN_COVER || !(from->both[4] > 0)) continue;
        for (size_t k = 0; k < 3; k++) f->rgba[4 * p + k] = from->both[k] / from->both[4];
        f->rgba[4 * p + 3] = 1;
        f->z[p] = from->both[3] / from->both[4];
    }
done:
    free(holes);
    free(slots);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------- anchors */

static int last_anchor(const struct fill_path *fill)
{
    const int n = fill->options.fill_anchor_spacing, last = fill->path->frame_count - 1;
    return last / n + (last % n != 0);
}

static int anchor_frame(const struct fill_path *fill, int index)
{
    const long long at = (long long)index * fill->options.fill_anchor_spacing;
    return at < fill->path->frame_count ? (int)at : fill->path->frame_count - 1;
}

/* Position of frame `frame` between anchors a and b: 0 at a, 1 at b. */
static float position_between(const struct fill_path *fill, const struct fill_anchor *a, const struct fill_anchor *b,
                              int frame)
{
    const int from = anchor_frame(fill, a->index), to = anchor_frame(fill, b->index);
    return (float)(frame - from) / (float)(to - from);
}

/* Renders anchor `index`, fills it using anchors a and b (may be NULL), and keeps its filled pixels as points. */
static enum status anchor_make(struct fill_path *fill, struct fill_anchor *to, int index, const struct fill_anchor *a,
                               const struct fill_anchor *b, struct err *err)
{
    const int frame = anchor_frame(fill, index);
    const struct view *camera = &fill->path->frames[frame].camera;
    struct rendered_frame f = {0};
    uint32_t *empty = NULL;
    size_t count = 0;

    anchor_drop(to);
    fill->render(fill->ctx, frame, &f, err);
    fill->rendered++;
    const size_t pixels = (size_t)f.width * (size_t)f.height;
    if (!err->status) {
        for (size_t p = 0; p < pixels; p++) count += !(f.rgba[4 * p + 3] > 0);
        empty = malloc((count + 1) * sizeof *empty);
        to->points = malloc((count + 1) * sizeof *to->points);
        if (!empty || !to->points) err_nomem(err, "the filled pixels of a frame", count * sizeof *to->points);
    }
    if (!err->status) {
        count = 0;
        for (size_t p = 0; p < pixels; p++)
            if (!(f.rgba[4 * p + 3] > 0)) empty[count++] = (uint32_t)p;
        if (a) splat_anchors(fill, a, b, b ? position_between(fill, a, b, frame) : 0, camera, &f, err);
    }
    if (!err->status) inpaint(fill, &f, camera, NULL, err);
    for (size_t i = 0; !err->status && i < count; i++) {
        const size_t p = empty[i];
        struct fill_point *point = &to->points[to->count];
        if (!(f.z[p] > 0)) continue;
        point->position = view_unproject(camera, (double)(p % (size_t)f.width) + 0.5,
                                         (double)(p / (size_t)f.width) + 0.5, (double)f.z[p]);
        memcpy(point->rgb, f.rgba + 4 * p, sizeof point->rgb);
        to->count++;
    }
    if (!err->status)
        to->index = index;
    else
        anchor_drop(to);
    free(empty);
    rendered_frame_release(&f);
    return err->status;
}

/* The anchors before and after a frame, made if needed; *b is NULL if the frame is anchor a itself. */
static enum status anchors_around(struct fill_path *fill, int frame, const struct fill_anchor **a,
                                  const struct fill_anchor **b, struct err *err)
{
    struct fill_anchor *kept = fill->anchors, *lo = &kept[0], *hi = &kept[1];
    const int last = last_anchor(fill);

    if (lo->index < 0) anchor_make(fill, lo, 0, NULL, NULL, err);
    *a = lo;
    *b = NULL;
    if (err->status || frame == 0) return err->status;
    if (hi->index < 0) anchor_make(fill, hi, last, lo, NULL, err);
    for (int level = 2; !err->status; level++) {
        *a = lo;
        *b = hi;
        if (frame == anchor_frame(fill, hi->index)) *a = hi;
        if (frame == anchor_frame(fill, (*a)->index)) *b = NULL;
        if (!*b || hi->index - lo->index <= 1) break;
        /* always the middle of these two, so that the result does not depend on earlier frames */
        const int index = lo->index + (hi->index - lo->index) / 2;
        struct fill_anchor *middle = &kept[level];
        if (middle->index != index) anchor_make(fill, middle, index, lo, hi, err);
        if (frame < anchor_frame(fill, index))
            hi = middle;
        else
            lo = middle;
    }
    return err->status;
}

enum status fill_path_frame(struct fill_path *fill, int frame, const struct view *camera, struct rendered_frame *f,
                            struct err *err)
{
    const struct fill_path_options *o = &fill->options;
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    const struct fill_anchor *a, *b;
    bool empty = false;

    for (size_t p = 0; p < pixels && !empty; p++) empty = !(f->rgba[4 * p + 3] > 0);
    if (empty && o->fill_diameter > 0 && o->fill_anchor_spacing > 0) {
        if (!anchors_around(fill, frame, &a, &b, err))
            splat_anchors(fill, a, b, b ? position_between(fill, a, b, frame) : 0, camera, f, err);
    }
    if (!err->status) inpaint(fill, f, camera, &fill->stats, err);
    return err->status;
}
