/* layer_scene.c - see layer_render.h: loading a scene's layers and packing them for the rasteriser. */
#include "common/layer_render.h"

#include <immintrin.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/layer_raster.h"

#define NEAR_PERCENTILE 0.02
#define FAR_PERCENTILE  0.98
#define HALF_MOST       65504.0f

/* ---------------------------------------------------------------------------------------------- packing a view */

__attribute__((target("f16c"))) static void pack_rgba(uint16_t half[2][4], const float *interior, const float *boundary)
{
    const __m256 most = _mm256_set1_ps(HALF_MOST), least = _mm256_set1_ps(-HALF_MOST);
    __m256 v = _mm256_set_m128(_mm_loadu_ps(boundary), _mm_loadu_ps(interior));
    v = _mm256_max_ps(_mm256_min_ps(v, most), least);
    _mm_storeu_si128((__m128i *)half, _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
}

static void shape_add(struct segment_shape *s, int x, int y, bool interior)
{
    if (s->x1 < s->x0) {
        s->x0 = s->x1 = x;
        s->y0 = s->y1 = y;
    }
    if (x < s->x0) s->x0 = x;
    if (x > s->x1) s->x1 = x;
    if (y > s->y1) s->y1 = y;
    if (interior) {
        s->u += x + 0.5;
        s->v += y + 0.5;
        s->pixels++;
    }
}

/* Whether the planes of two segments agree at pixel (u, v). */
static bool planes_meet(const struct depth_segment *a, const struct depth_segment *b, double u, double v)
{
    const double za = a->plane[0] * u + a->plane[1] * v + a->plane[2];
    const double zb = b->plane[0] * u + b->plane[1] * v + b->plane[2];
    const double sa = fmax(a->sigma, SOFT_Z_SIGMA_LEAST), sb = fmax(b->sigma, SOFT_Z_SIGMA_LEAST);
    return fabs(za - zb) <= JOIN_SIGMAS * hypot(sa, sb) * fmin(za, zb);
}

/* Whether the four texels at t belong to segments of one surface: in the middle of them, at (u, v), each one's plane
 * meets another's until all are linked. (On a slope, those at opposite corners need not meet.) */
static bool cell_joined(const struct texel *t, int stride, const struct layered_depth *d, double u, double v)
{
    const struct texel *cell[4] = {t, t + 1, t + stride, t + stride + 1};
    uint32_t ids[8];
    int count = 0, linked = 1;

    for (int k = 0; k < 4; k++)
        for (int l = 0; l < 2; l++) {
            const uint32_t id = cell[k]->id[l] & ~TEXEL_JOINED;
            bool known = false;
            if (!id && l == 0) return false;
            for (int i = 0; i < count; i++) known |= ids[i] == id;
            if (id && !known) ids[count++] = id;
        }
    for (int i = 0; i < linked; i++) /* ids[0 .. linked) hang together */
        for (int j = linked; j < count; j++)
            if (planes_meet(&d->segments[ids[i] - 1], &d->segments[ids[j] - 1], u, v)) {
                const uint32_t id = ids[j];
                ids[j] = ids[linked];
                ids[linked++] = id;
            }
    return linked == count;
}

void layer_view_release(struct layer_view *lv)
{
    if (!lv) return;
    free(lv->texels);
    free(lv->shapes);
    *lv = (struct layer_view){0};
}

static void layer_drop(struct layer *l)
{
    free(l->rgba);
    free(l->z);
    free(l->id);
    *l = (struct layer){0};
}

enum status layer_view_pack(struct layer_view *lv, struct layered_depth *depth, const char *name, struct err *err)
{
    const int w = depth->width, h = depth->height, stride = w + 3;
    const size_t size = (size_t)stride * (size_t)(h + 3) * sizeof *lv->texels;

    *lv = (struct layer_view){w, h, stride, NULL, NULL};
    lv->texels = aligned_alloc(64, (size + 63) / 64 * 64);
    lv->shapes = calloc((size_t)depth->segment_count + 1, sizeof *lv->shapes);
    if (!lv->texels || !lv->shapes) {
        layer_view_release(lv);
        return err_nomem(err, "the layers of a view", size);
    }
    memset(lv->texels, 0, size);
    for (int i = 0; i < depth->segment_count; i++) lv->shapes[i].x1 = -1;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const size_t p = (size_t)y * (size_t)w + (size_t)x;
            struct texel *t = &lv->texels[(size_t)(y + 1) * (size_t)stride + (size_t)(x + 1)];
            t->id[0] = depth->interior.id[p];
            t->id[1] = depth->boundary.id[p];
            pack_rgba(t->rgba, depth->interior.rgba + 4 * p, depth->boundary.rgba + 4 * p);
            for (int l = 0; l < 2; l++) {
                if (t->id[l] > (uint32_t)depth->segment_count) {
                    const uint32_t id = t->id[l];
                    layer_view_release(lv);
                    return err_set(err, ST_DATA,
                                   "depth map of view %s: pixel (%d, %d) belongs to segment %u, but it "
                                   "has %d segments. Make it again.",
                                   name, x, y, id, depth->segment_count);
                }
                if (t->id[l])
                    shape_add(&lv->shapes[t->id[l] - 1], x, y, l == 0);
                else
                    memset(t->rgba[l], 0, sizeof t->rgba[l]);
            }
        }
    for (int i = 0; i < depth->segment_count; i++) {
        struct segment_shape *s = &lv->shapes[i];
        s->u = s->pixels > 0 ? s->u / s->pixels : 0.5 * (s->x0 + s->x1 + 1);
        s->v = s->pixels > 0 ? s->v / s->pixels : 0.5 * (s->y0 + s->y1 + 1);
    }
    for (int y = 0; y + 1 < h; y++)
        for (int x = 0; x + 1 < w; x++) {
            struct texel *t = &lv->texels[(size_t)(y + 1) * (size_t)stride + (size_t)(x + 1)];
            if (cell_joined(t, stride, depth, x + 1, y + 1)) t->id[0] |= TEXEL_JOINED;
        }
    layer_drop(&depth->interior);
    layer_drop(&depth->boundary);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------- the scene */

struct weighted {
    double value, weight;
};

static int compare_weighted(const void *a, const void *b)
{
    const double x = ((const struct weighted *)a)->value, y = ((const struct weighted *)b)->value;
    return (x > y) - (x < y);
}

/* Of values in ascending order. */
static double percentile(const struct weighted *values, size_t count, double part)
{
    double total = 0, sum = 0;
    for (size_t i = 0; i < count; i++) total += values[i].weight;
    for (size_t i = 0; i < count; i++) {
        sum += values[i].weight;
        if (sum >= part * total) return values[i].value;
    }
    return count ? values[count - 1].value : 0;
}

static enum status measure_depths(struct layer_scene *s, struct err *err)
{
    size_t most = 1, count = 0;
    for (int i = 0; i < s->set->view_count; i++) most += (size_t)s->depths[i].segment_count;
    struct weighted *depths = malloc(most * sizeof *depths), *sigmas = malloc(most * sizeof *sigmas);
    if (!depths || !sigmas) {
        free(depths);
        free(sigmas);
        return err_nomem(err, "the segments' depths", 2 * most * sizeof *depths);
    }
    for (int i = 0; i < s->set->view_count; i++)
        for (int k = 0; k < s->depths[i].segment_count; k++) {
            const struct depth_segment *seg = &s->depths[i].segments[k];
            const struct segment_shape *shape = &s->views[i].shapes[k];
            const double inverse = seg->plane[0] * shape->u + seg->plane[1] * shape->v + seg->plane[2];
            if (!(inverse > 0) || !(shape->pixels > 0)) continue;
            depths[count] = (struct weighted){1 / inverse, shape->pixels};
            sigmas[count++] = (struct weighted){seg->sigma, shape->pixels};
        }
    qsort(depths, count, sizeof *depths, compare_weighted);
    qsort(sigmas, count, sizeof *sigmas, compare_weighted);
    s->near_depth = percentile(depths, count, NEAR_PERCENTILE);
    s->far_depth = percentile(depths, count, FAR_PERCENTILE);
    s->sigma = percentile(sigmas, count, 0.5);
    free(depths);
    free(sigmas);
    return ST_OK;
}

static enum status scene_open(struct layer_scene *s, const struct camera_set *set, struct err *err)
{
    *s = (struct layer_scene){.set = set};
    s->depths = calloc((size_t)set->view_count + 1, sizeof *s->depths);
    s->views = calloc((size_t)set->view_count + 1, sizeof *s->views);
    return s->depths && s->views ? ST_OK
                                 : err_nomem(err, "the views of a scene", (size_t)set->view_count * sizeof *s->depths);
}

static enum status scene_add(struct layer_scene *s, int view, struct err *err)
{
    const struct layered_depth *d = &s->depths[view];
    const struct view *v = &s->set->views[view];
    if (d->width != v->width || d->height != v->height)
        return err_set(
            err, ST_DATA,
            "the depth map of view %s has %d x %d pixels, but its camera has %d x %d. Make the depth map again.",
            v->name, d->width, d->height, v->width, v->height);
    return layer_view_pack(&s->views[view], &s->depths[view], v->name, err);
}

enum status layer_scene_read(struct layer_scene *scene, const struct camera_set *set, const char *depth_folder,
                             struct provenance *prov, struct err *err)
{
    char path[4096], name[512];
    enum status st = scene_open(scene, set, err);

    for (int i = 0; !st && i < set->view_count; i++) {
        snprintf(name, sizeof name, "depth/%s.exr", set->views[i].name);
        if (snprintf(path, sizeof path, "%s/%s.exr", depth_folder, set->views[i].name) >= (int)sizeof path)
            st = err_set(err, ST_IO, "the path %s/%s.exr is too long.", depth_folder, set->views[i].name);
        else if (!(st = layered_depth_read(&scene->depths[i], path, err)) &&
                 !(st = prov ? provenance_add_file(prov, name, path, err) : ST_OK))
            st = scene_add(scene, i, err);
    }
    if (!st) st = view_mesh_build(&scene->mesh, set, err);
    if (!st) st = measure_depths(scene, err);
    if (st) layer_scene_release(scene);
    return st;
}

enum status layer_scene_init(struct layer_scene *scene, const struct camera_set *set, struct layered_depth *depths,
                             struct err *err)
{
    enum status st = scene_open(scene, set, err);

    for (int i = 0; i < set->view_count; i++) {
        struct layered_depth taken = depths[i];
        depths[i] = (struct layered_depth){0};
        if (st) {
            layered_depth_release(&taken);
            continue;
        }
        scene->depths[i] = taken;
        st = scene_add(scene, i, err);
    }
    if (!st) st = view_mesh_build(&scene->mesh, set, err);
    if (!st) st = measure_depths(scene, err);
    if (st) layer_scene_release(scene);
    return st;
}

void layer_scene_release(struct layer_scene *scene)
{
    if (!scene) return;
    for (int i = 0; scene->set && i < scene->set->view_count; i++) {
        if (scene->depths) layered_depth_release(&scene->depths[i]);
        if (scene->views) layer_view_release(&scene->views[i]);
    }
    free(scene->depths);
    free(scene->views);
    view_mesh_release(&scene->mesh);
    *scene = (struct layer_scene){0};
}
