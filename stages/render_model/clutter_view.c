/* clutter_view.c - parts a view into the model's surfaces and what stands in front of them.
 *
 * trace_ids has compared the view's depth with the model's and graded each pixel (stages/trace_ids/clutter.c), with a rim,
 * so that no texture shows furniture. Here the rim must stay with the shell, and the two layers of a pixel are judged one
 * by one. With n = 1 - z / z_model, the part of the way to the model that is missing, a texel of a layer is clutter by
 *
 *   w = smoothstep((n - t) / t),   t = TOLERANCE + SIGMAS sigma
 *
 * where the pixel counts as clutter. A cupboard's side meets the wall, and a table's leg the floor, where n falls to 0:
 * there the segment decides. One whose texels are mostly clutter is clutter as a whole, and its t shrinks to CONTACT. A
 * segment that covers a chair and the wall keeps only its chair.
 *
 * What lies below the tolerance everywhere, a rug or a poster, is texture of the shell, and so are shadows. */
#include "stages/render_model/clutter_view.h"

#include <math.h>
#include <stdlib.h>

#include "common/layers/depth_sigma.h"

#define TOLERANCE 0.02f /* of the depth: errors of the model and the cameras */
#define SIGMAS    1.5f
#define CONTACT   0.006f /* the same, in segments that are clutter */
#define GRADE     0.6f   /* of a pixel of clutter, from trace_ids */
#define DOUBT     0.4f   /* confidence in segments whose depth is inherited */
#define LEAST     0.02f  /* weights below are 0 */

struct judged_segment {
    float tolerance, contact; /* t in general, and in a segment of clutter */
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

static struct judged_segment *judge_segments(const struct layered_depth *d, const struct view_ids *ids, struct err *err)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    struct judged_segment *list = calloc((size_t)d->segment_count + 1, sizeof *list);
    if (!list) {
        err_nomem(err, "the segments of a view", (size_t)d->segment_count * sizeof *list);
        return NULL;
    }
    for (int i = 0; i < d->segment_count; i++) {
        const float sigma = (float)depth_sigma(&d->segments[i]);
        list[i].tolerance = TOLERANCE + SIGMAS * sigma;
        list[i].contact = CONTACT;
        list[i].sure = d->segments[i].confidence < DEPTH_INHERITED ? DOUBT : 1;
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
    const float near = nearness(z, z_model), whole = smooth((near - s->contact) / s->contact) * s->share;
    if (!(grade > GRADE)) return whole;
    return fmaxf(whole, smooth((near - s->tolerance) / s->tolerance));
}

/* Empties the texels of a layer that show the model, and lets the others fade by their weight. */
static void keep_clutter(struct layer *l, const struct judged_segment *list, const struct view_ids *ids, size_t pixels)
{
    for (size_t p = 0; p < pixels; p++) {
        if (!l->id[p]) continue;
        const float w = texel_weight(&list[l->id[p] - 1], l->z[p], ids->z[p], ids->clutter[p]);
        for (size_t c = 0; c < 4; c++) l->rgba[4 * p + c] *= w < LEAST ? 0 : w;
        if (w < LEAST) l->id[p] = 0;
    }
}

/* The nearest surface of both layers within one pixel: outlines of segments are off by as much, and a view must not
 * deny what another one shows for that. */
static void find_nearest(struct clutter_view *v, const struct layered_depth *d, const struct judged_segment *list,
                         float *rows)
{
    const int width = d->width, height = d->height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            const float inner = d->interior.z[p] > 0 ? 1 / d->interior.z[p] : 0;
            const float outer = d->boundary.id[p] && d->boundary.z[p] > 0 ? 1 / d->boundary.z[p] : 0;
            v->nearest[p] = fmaxf(inner, outer);
            v->sure[p] = d->interior.id[p] ? (uint8_t)(CLUTTER_SURE * list[d->interior.id[p] - 1].sure) : 0;
        }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float *row = v->nearest + (size_t)y * (size_t)width;
            const float side = fmaxf(row[x > 0 ? x - 1 : x], row[x + 1 < width ? x + 1 : x]);
            rows[(size_t)y * (size_t)width + (size_t)x] = row[x] > 0 ? fmaxf(row[x], side) : 0;
        }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            const float above = y > 0 ? rows[p - (size_t)width] : 0;
            const float below = y + 1 < height ? rows[p + (size_t)width] : 0;
            v->nearest[p] = rows[p] > 0 ? fmaxf(rows[p], fmaxf(above, below)) : 0;
        }
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

static size_t bytes_of(int width, int height)
{
    const size_t texel = sizeof(struct texel) + 8 + 2 * sizeof(uint32_t); /* with the photo and the cells */
    return (size_t)(width + 3) * (size_t)(height + 3) * (texel + sizeof(float) + 1);
}

size_t clutter_view_bytes(const struct view *view) { return bytes_of(view->width, view->height); }

enum status clutter_view_make(struct clutter_view *v, struct layered_depth *depth, const struct view_ids *ids,
                              const char *name, struct err *err)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    struct judged_segment *list = NULL;
    float *rows = NULL;
    *v = (struct clutter_view){.depth = *depth};
    *depth = (struct layered_depth){0};
    enum status st = check(&v->depth, ids, name, err);
    if (!st) list = judge_segments(&v->depth, ids, err);
    if (!st && !list) st = err->status;
    if (!st) {
        rows = malloc(pixels * sizeof *rows);
        v->nearest = malloc(pixels * sizeof *v->nearest);
        v->sure = malloc(pixels);
        if (!rows || !v->nearest || !v->sure) st = err_nomem(err, "what a view sees", pixels * 9);
    }
    if (!st) {
        find_nearest(v, &v->depth, list, rows);
        keep_clutter(&v->depth.interior, list, ids, pixels);
        keep_clutter(&v->depth.boundary, list, ids, pixels);
        st = layer_view_pack(&v->layers, &v->depth, name, err);
    }
    v->bytes = bytes_of(v->depth.width, v->depth.height);
    free(rows);
    free(list);
    if (st) clutter_view_release(v);
    return st;
}

void clutter_view_release(struct clutter_view *v)
{
    if (!v) return;
    layered_depth_release(&v->depth);
    layer_view_release(&v->layers);
    free(v->nearest);
    free(v->sure);
    *v = (struct clutter_view){0};
}
