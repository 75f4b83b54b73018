/* clutter_view.c - parts a view into the model's surfaces and what stands in front of them.
 *
 * trace_ids has compared the view's depth with the model's and graded each pixel (stages/trace_ids/view_clutter.c),
 * with a rim, so that no texture shows furniture. Here the rim must stay with the shell, and the two layers of a pixel
 * are judged one by one. With n = 1 - z / z_model, the part of the way to the model that is missing, a texel of a layer
 * is clutter by
 *
 *   w = smoothstep((n - t) / t),   t = TOLERANCE + SIGMAS sigma
 *
 * where the pixel counts as clutter. A cupboard's side meets the wall, and a table's leg the floor, where n falls to 0:
 * there the segment decides. One whose texels are mostly clutter is clutter as a whole, and its t shrinks to CONTACT. A
 * segment that covers a chair and the wall keeps only its chair.
 *
 * What lies below the tolerance everywhere, a rug or a poster, is texture of the shell, and so are shadows.
 *
 * Depth also bleeds over the model's jumps; see find_rims().
 *
 * Source: none. The thesis draws whole views [Colburn 2014, 3.6]. */
#include "common/clutter/clutter_view.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "common/layers/depth_sigma.h"
#include "common/math/lanes.h"

#define TOLERANCE  0.02f /* of the depth: errors of the model and the cameras */
#define SIGMAS     1.5f
#define CONTACT    0.006f /* the same, in segments that are clutter */
#define GRADE      0.6f   /* of a pixel of clutter, from trace_ids */
#define DOUBT      0.4f   /* confidence in segments whose depth is inherited */
#define MAX_SIGMA  0.04   /* relative uncertainty of a depth that deserves its full confidence */
#define MIN_WEIGHT 0.02f  /* weights below are 0 */
#define JUMP       0.03f  /* of inverse depth: where a part of the model ends before another */

enum { REACH = 32 }; /* px: that depth bleeds over a jump of the model */

struct judged_segment {
    float tolerance; /* t */
    float sure;
    float share; /* 0: part of it is clutter; 1: all of it is */
    uint32_t texels, near;
};

static float smooth(float x)
{
    const float t = x < 0 ? 0 : x > 1 ? 1 : x;
    return t * t * (3 - 2 * t);
}

static float nearness(float z, float z_model) { return z > 0 && z_model > 0 ? 1 - z / z_model : 0; }

/* DOUBT for inherited depth, up to 1 for what counts as sure; less for depth of large uncertainty. */
static float sureness(double confidence, double sigma)
{
    const double rise = (confidence - DEPTH_INHERITED) / (DEPTH_SURE - DEPTH_INHERITED);
    const double sharp = sigma > MAX_SIGMA ? MAX_SIGMA / sigma : 1;
    return (DOUBT + (1 - DOUBT) * (float)fmin(1, fmax(0, rise))) * (float)sharp;
}

static struct judged_segment *judge_segments(const struct layered_depth *d, const struct view_ids *ids, struct err *err)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    struct judged_segment *list = calloc((size_t)d->segment_count + 1, sizeof *list);
    if (!list) {
        err_nomem(err, "the segments of a view", (size_t)d->segment_count * sizeof *list);
        return NULL;
    }
    for (int i = 0; i < d->segment_count; i++) {
        const float sigma = (float)depth_width(&d->segments[i]);
        list[i].tolerance = TOLERANCE + SIGMAS * sigma;
        list[i].sure = sureness(d->segments[i].confidence, (double)sigma);
    }
    for (size_t p = 0; p < pixels; p++) {
        if (!d->interior.id[p]) continue;
        struct judged_segment *s = &list[d->interior.id[p] - 1];
        s->texels++;
        s->near += ids->clutter[p] > GRADE && nearness(d->interior.z[p], ids->z[p]) > s->tolerance;
    }
    for (int i = 0; i < d->segment_count; i++)
        list[i].share = list[i].texels ? smooth(2 * (float)list[i].near / (float)list[i].texels - 0.8f) : 0;
    return list;
}

static float texel_weight(const struct judged_segment *s, float z, float z_model, float grade)
{
    if (!(z_model > 0)) return 0; /* outdoors */
    const float near = nearness(z, z_model), whole = smooth((near - CONTACT) / CONTACT) * s->share;
    if (!(grade > GRADE)) return whole;
    return fmaxf(whole, smooth((near - s->tolerance) / s->tolerance));
}

/* ------------------------------------------------------------------------------------------------------------- rims */

enum { INTERIOR = 1, BOUNDARY = 2 }; /* bits of a pixel's mask */

/* A walk along a row or a column, over inverse depths of the model. */
struct walk {
    float plane, slope; /* the nearer plane that ended at a jump, continued to this pixel; 0: none */
    int away;           /* px from its end */
    float last, before; /* of the two pixels before */
};

static void step(struct walk *w, float inverse)
{
    const float expected = w->before > 0 ? 2 * w->last - w->before : w->last;
    w->plane += w->plane > 0 ? w->slope : 0;
    w->away++;
    if (w->last > 0 && inverse < fminf(w->last, expected) * (1 - JUMP) && expected > w->plane)
        *w = (struct walk){.plane = expected, .slope = expected - w->last, .away = 1, .last = w->last};
    else if (!(inverse < w->plane * (1 - JUMP)))
        w->plane = 0;
    w->before = w->last;
    w->last = inverse;
}

/* Whether a layer's depth only continues the plane of the walk. */
static bool continues(const struct walk *w, uint32_t id, float z, const struct judged_segment *list)
{
    if (!id || !(w->plane > 0)) return false;
    const struct judged_segment *s = &list[id - 1];
    return fabsf(w->plane * z - 1) < s->tolerance && (w->away <= REACH || s->sure < 1);
}

static void walk_line(uint8_t *rim, const struct layered_depth *d, const struct judged_segment *list,
                      const struct view_ids *ids, size_t first, ptrdiff_t stride, int count)
{
    struct walk w = {0};
    size_t p = first;
    for (int i = 0; i < count; i++, p = (size_t)((ptrdiff_t)p + stride)) {
        step(&w, ids->z[p] > 0 ? 1 / ids->z[p] : 0);
        if (continues(&w, d->interior.id[p], d->interior.z[p], list)) rim[p] |= INTERIOR;
        if (continues(&w, d->boundary.id[p], d->boundary.z[p], list)) rim[p] |= BOUNDARY;
    }
}

/* Marks the layers that continue a nearer part of the model beyond its end. Depth bleeds: the sky in a window inherits
 * the depth of its frame, and what shows through a door that of the wall. The planes of the model are continued over
 * its jumps, in rows and columns, and what lies in them is no clutter: REACH px far, and all the way to the other end
 * of the opening if it is not sure. */
static void find_rims(uint8_t *rim, const struct layered_depth *d, const struct judged_segment *list,
                      const struct view_ids *ids)
{
    const size_t width = (size_t)d->width, height = (size_t)d->height;
    for (size_t y = 0; y < height; y++) {
        walk_line(rim, d, list, ids, y * width, 1, d->width);
        walk_line(rim, d, list, ids, (y + 1) * width - 1, -1, d->width);
    }
    for (size_t x = 0; x < width; x++) {
        walk_line(rim, d, list, ids, x, (ptrdiff_t)width, d->height);
        walk_line(rim, d, list, ids, (height - 1) * width + x, -(ptrdiff_t)width, d->height);
    }
}

/* Whether a pixel shows a thing that is fused from other views, such as a table's leg, whatever its own depth is. */
static bool shows_fused(const struct thing_mask *things, size_t p)
{
    return things && things->shows[p] && things->meets[p] == things->shows[p];
}

/* Empties the texels of a layer that show the model, and lets the others fade by their weight. Texels of things whose
 * depth is the model's keep their colour for the fused surface, but are part of no segment. */
static void keep_clutter(struct layer *l, const uint8_t *rim, uint8_t bit, const struct judged_segment *list,
                         const struct view_ids *ids, const struct thing_mask *things)
{
    const size_t pixels = (size_t)ids->width * (size_t)ids->height;
    for (size_t p = 0; p < pixels; p++) {
        if (!l->id[p]) continue;
        const struct judged_segment *s = &list[l->id[p] - 1];
        const float w = rim[p] & bit ? 0 : texel_weight(s, l->z[p], ids->z[p], ids->clutter[p]);
        const float kept = w < MIN_WEIGHT ? (float)shows_fused(things, p) : w;
        for (size_t c = 0; c < 4; c++) l->rgba[4 * p + c] *= kept;
        if (w < MIN_WEIGHT) l->id[p] = 0;
    }
}

static void see_pixels(struct clutter_view *v, const struct layered_depth *d, const struct judged_segment *list,
                       const struct thing_mask *things)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    for (size_t p = 0; p < pixels; p++) {
        const float inner = d->interior.z[p] > 0 ? 1 / d->interior.z[p] : 0;
        const float outer = d->boundary.id[p] && d->boundary.z[p] > 0 ? 1 / d->boundary.z[p] : 0;
        v->sight[p].nearest = fmaxf(inner, outer);
        v->sight[p].thing = things ? (uint16_t)things->shows[p] : 0;
        v->sight[p].sure = inner > 0 ? (uint8_t)(CLUTTER_SURE * list[d->interior.id[p] - 1].sure) : 0;
    }
}

/* Lets each pixel of a line see the nearest surface of its neighbours, with the least confidence. */
static void spread_line(struct clutter_view *v, size_t first, size_t stride, int count)
{
    float before = 0;
    uint8_t sure_before = UINT8_MAX;
    for (int i = 0; i < count; i++) {
        const size_t p = first + (size_t)i * stride, next = i + 1 < count ? p + stride : p;
        const float own = v->sight[p].nearest;
        const uint8_t sure = v->sight[p].sure;
        if (own > 0) {
            v->sight[p].nearest = fmaxf(own, fmaxf(before, v->sight[next].nearest));
            if (v->sight[next].nearest > 0 && v->sight[next].sure < v->sight[p].sure)
                v->sight[p].sure = v->sight[next].sure;
            if (before > 0 && sure_before < v->sight[p].sure) v->sight[p].sure = sure_before;
        }
        before = own;
        sure_before = sure;
    }
}

static uint8_t greater(uint8_t a, uint8_t b) { return a > b ? a : b; }

static void spread_shows(struct clutter_view *v, size_t first, size_t stride, int count)
{
    uint8_t before = 0;
    for (int i = 0; i < count; i++) {
        const size_t p = first + (size_t)i * stride;
        const uint8_t own = v->sight[p].shows, next = i + 1 < count ? v->sight[p + stride].shows : 0;
        v->sight[p].shows = greater(own, greater(before, next));
        before = own;
    }
}

/* Call it when the layers hold clutter alone. */
static void find_shows(struct clutter_view *v, const struct layered_depth *d)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    for (size_t p = 0; p < pixels; p++)
        v->sight[p].shows =
            (uint8_t)(CLUTTER_SURE * fminf(1, d->interior.rgba[4 * p + 3] + d->boundary.rgba[4 * p + 3]));
    for (int y = 0; y < d->height; y++) spread_shows(v, (size_t)y * (size_t)d->width, 1, d->width);
    for (int x = 0; x < d->width; x++) spread_shows(v, (size_t)x, (size_t)d->width, d->height);
}

/* What the view sees within one pixel, of both layers: outlines of segments are off by as much, and a view must not
 * deny what another one shows for that. */
static void find_nearest(struct clutter_view *v, const struct layered_depth *d, const struct judged_segment *list,
                         const struct thing_mask *things)
{
    see_pixels(v, d, list, things);
    for (int y = 0; y < d->height; y++) spread_line(v, (size_t)y * (size_t)d->width, 1, d->width);
    for (int x = 0; x < d->width; x++) spread_line(v, (size_t)x, (size_t)d->width, d->height);
}

static enum status check(const struct layered_depth *d, const struct view_ids *ids, const char *name, struct err *err)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    if (d->width != ids->width || d->height != ids->height)
        return err_set(err, ST_DATA,
                       "the depth map of view %s has %d x %d pixels, but its faces have %d x %d. Trace it again.", name,
                       d->width, d->height, ids->width, ids->height);
    for (size_t p = 0; p < pixels; p++)
        if (d->interior.id[p] > (uint32_t)d->segment_count || d->boundary.id[p] > (uint32_t)d->segment_count)
            return err_set(err, ST_DATA,
                           "the depth map of view %s has a pixel of segment %u, but only %d segments. Make it again.",
                           name, d->interior.id[p] > d->boundary.id[p] ? d->interior.id[p] : d->boundary.id[p],
                           d->segment_count);
    return ST_OK;
}

void clutter_view_sample(float rgba[4], const struct clutter_view *view, double u, double v)
{
    const struct layer_view *layers = &view->layers;
    const double x = u + 0.5, y = v + 0.5; /* the padding is one texel, and texels have their centres at + 0.5 */
    const int i = (int)x, j = (int)y;
    const float fx = (float)(x - i), fy = (float)(y - j);
    const uint16_t(*t)[4] = (const uint16_t(*)[4])layers->photo + (size_t)j * (size_t)layers->stride + (size_t)i;
    const uint16_t(*b)[4] = t + layers->stride;
    const f32x4 a0 = f32x4_from_half(t[0]), a1 = f32x4_from_half(t[1]), b0 = f32x4_from_half(b[0]),
                b1 = f32x4_from_half(b[1]);
    const f32x4 top = a0 + fx * (a1 - a0), bottom = b0 + fx * (b1 - b0), all = top + fy * (bottom - top);
    for (int c = 0; c < 4; c++) rgba[c] = all[c];
}

static size_t bytes_of(int width, int height)
{
    const size_t texel = sizeof(struct texel) + 8 + 2 * sizeof(uint32_t); /* with the photo and the cells */
    return (size_t)(width + 3) * (size_t)(height + 3) * (texel + sizeof(struct clutter_sight));
}

size_t clutter_view_bytes(const struct view *view) { return bytes_of(view->width, view->height); }

enum status clutter_view_make(struct clutter_view *v, struct layered_depth *depth, const struct view_ids *ids,
                              const struct thing_mask *things, const char *name, struct err *err)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    struct judged_segment *list = NULL;
    uint8_t *rim = NULL;
    *v = (struct clutter_view){.depth = *depth, .knows_things = things != NULL};
    *depth = (struct layered_depth){0};
    if (!check(&v->depth, ids, name, err)) list = judge_segments(&v->depth, ids, err);
    if (!err->status) {
        v->sight = malloc(pixels * sizeof *v->sight);
        rim = calloc(pixels, 1);
        if (!rim || !v->sight) err_nomem(err, "what a view sees", pixels * (sizeof *v->sight + 1));
    }
    if (!err->status) {
        find_nearest(v, &v->depth, list, things);
        find_rims(rim, &v->depth, list, ids);
        keep_clutter(&v->depth.interior, rim, INTERIOR, list, ids, things);
        keep_clutter(&v->depth.boundary, rim, BOUNDARY, list, ids, things);
        find_shows(v, &v->depth);
        layer_view_pack(&v->layers, &v->depth, name, err);
    }
    v->bytes = bytes_of(v->depth.width, v->depth.height);
    free(rim);
    free(list);
    if (err->status) clutter_view_release(v);
    return err->status;
}

void clutter_view_release(struct clutter_view *v)
{
    if (!v) return;
    layered_depth_release(&v->depth);
    layer_view_release(&v->layers);
    free(v->sight);
    *v = (struct clutter_view){0};
}
