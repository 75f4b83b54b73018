/* observe_lights.c - see observe_lights.h.
 *
 * A point's radiance in a view is the mean over a small square of pixels about its place; that of a line's point is
 * bilinear, so that the edge of a cone stays sharp. Of several views of one photo the one counts in which the point is
 * nearest the centre: they are the same light on the same sensor.
 *
 * Furniture hides points as walls do. The clutter of a view's pixels alone does not tell of all of it: a wardrobe that
 * fills a corner looks like its wall. Where a person marked a point, the picture there shows it, whatever furniture is
 * taken to be. */
#include "stages/fit_lights/observe_lights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/capture/photo_camera.h"
#include "common/capture/photo_quality.h"
#include "common/capture/view_image.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "common/texture/view_ids.h"

enum { SIGHT_GRID = 24, MIN_SIGHT = 12 };
#define MIN_COSINE 0.05 /* between a surface's normal and the direction to the camera */

void observe_release(struct observations *o)
{
    free(o->items);
    free(o->sights);
    free(o->clipped_points);
    *o = (struct observations){0};
}

struct viewer {
    struct observations *o;
    const struct lit_scene *scene;
    const struct annotation_list *notes;
    const struct lit_model *model;
    const struct model_rays *furnished;
    const struct fit_lights_params *params;
    int index, photo;
    struct view camera; /* model frame */
    struct view_planes picture;
    struct view_ids ids;
};

/* Whether the camera is in front of a surface and the pixel lies inside the view. */
static bool project(const struct viewer *v, struct vec3 at, struct vec3 normal, double *x, double *y)
{
    const struct vec3 to = vec3_sub(v->camera.center, at);
    const double distance = vec3_length(to);
    if (!(vec3_dot(normal, to) > MIN_COSINE * distance)) return false;
    if (!(view_project(&v->camera, at, x, y) > 0)) return false;
    return *x >= 1 && *y >= 1 && *x <= v->camera.width - 1 && *y <= v->camera.height - 1;
}

static bool is_hidden(const struct viewer *v, const struct model_rays *by, struct vec3 at, struct vec3 normal)
{
    const struct vec3 from = vec3_add(at, vec3_scale(normal, 4 * by->rays.epsilon));
    return ray_scene_blocked(&by->rays, from, vec3_sub(v->camera.center, from), 1);
}

static int pixel_at(const struct viewer *v, int x, int y)
{
    return clamp_int(y, 0, v->camera.height - 1) * v->camera.width + clamp_int(x, 0, v->camera.width - 1);
}

/* Adds a pixel to a mean; false: it lies outside the photo, or is saturated or dark. */
static bool add_pixel(const struct viewer *v, int i, double weight, double sum[3], double *variance, bool *clipped)
{
    if (!(v->picture.channel[VIEW_A][i] > 0.999f)) return false;
    if (v->picture.channel[VIEW_CLIPPED][i] > 0) {
        *clipped = true;
        return false;
    }
    const double sigma = weight * v->picture.channel[VIEW_SIGMA][i];
    for (int c = 0; c < 3; c++) sum[c] += weight * v->picture.channel[c][i];
    *variance += sigma * sigma;
    return true;
}

static bool mean_square(const struct viewer *v, double x, double y, struct observation *o, bool *clipped)
{
    const int r = v->params->patch, cx = (int)floor(x), cy = (int)floor(y), n = (2 * r + 1) * (2 * r + 1);
    double variance = 0;
    for (int dy = -r; dy <= r; dy++)
        for (int dx = -r; dx <= r; dx++)
            if (!add_pixel(v, pixel_at(v, cx + dx, cy + dy), 1.0 / n, o->radiance, &variance, clipped)) return false;
    o->sigma = sqrt(variance);
    return true;
}

static bool bilinear(const struct viewer *v, double x, double y, struct observation *o, bool *clipped)
{
    const int cx = (int)floor(x - 0.5), cy = (int)floor(y - 0.5);
    const double fx = x - 0.5 - cx, fy = y - 0.5 - cy;
    double variance = 0;
    for (int k = 0; k < 4; k++) {
        const double weight = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        if (!add_pixel(v, pixel_at(v, cx + (k & 1), cy + (k >> 1)), weight, o->radiance, &variance, clipped))
            return false;
    }
    o->sigma = sqrt(variance);
    return true;
}

static bool marked_here(const struct viewer *v, const struct lit_point *p)
{
    if (v->scene->marks[p->mark].face >= 0) return false;
    const struct lens *lens = photo_lens_of_view(&v->model->in.set, &v->model->in.lenses, v->index);
    const char *marked = v->notes->items[p->note].view;
    return !strcmp(marked, v->camera.name) || (lens && !strcmp(marked, lens->photo));
}

static enum status observe_point(struct viewer *v, int point, struct err *err)
{
    const struct lit_point *p = &v->scene->points[point];
    struct observation o = {.point = point, .photo = v->photo};
    double x, y;
    bool clipped = false;
    if (!project(v, p->at, p->normal, &x, &y) || is_hidden(v, &v->model->rays, p->at, p->normal)) return ST_OK;
    const float clutter = v->ids.clutter[pixel_at(v, (int)floor(x), (int)floor(y))];
    if (!marked_here(v, p) &&
        (clutter >= (float)v->params->max_clutter || is_hidden(v, v->furnished, p->at, p->normal)))
        return ST_OK;
    if (!(p->kind == NOTE_LINE ? bilinear(v, x, y, &o, &clipped) : mean_square(v, x, y, &o, &clipped))) {
        v->o->clipped += clipped;
        v->o->clipped_points[point] += clipped;
        return ST_OK;
    }
    o.aside = hypot(x - 0.5 * v->camera.width, y - 0.5 * v->camera.height) / v->camera.width;
    if (array_append(&v->o->items, (size_t)v->o->count, sizeof *v->o->items, "observations", err)) return err->status;
    v->o->items[v->o->count++] = o;
    return ST_OK;
}

/* The lamp's pixels: medians of the colours on a grid over it. */
static enum status observe_lamp(struct viewer *v, int lamp, struct err *err)
{
    const struct lamp *l = &v->scene->lights.lamps[lamp];
    struct weighted values[3][SIGHT_GRID * SIGHT_GRID];
    int count = 0, saturated = 0, pixels = 0, last = -1;
    for (int i = 0; i < SIGHT_GRID * SIGHT_GRID; i++) {
        const double a = 0.85 * (2 * (i % SIGHT_GRID + 0.5) / SIGHT_GRID - 1);
        const double b = 0.85 * (2 * (i / SIGHT_GRID + 0.5) / SIGHT_GRID - 1);
        const struct vec3 at = vec3_add(l->centre, vec3_add(vec3_scale(l->x, a), vec3_scale(l->y, b)));
        double x, y;
        if (l->shape == LAMP_DISK && a * a + b * b > 0.7) continue;
        if (!project(v, at, l->normal, &x, &y) || is_hidden(v, &v->model->rays, at, l->normal)) continue;
        const int pixel = pixel_at(v, (int)floor(x), (int)floor(y));
        if (!(v->picture.channel[VIEW_A][pixel] > 0.999f)) continue;
        pixels += pixel != last;
        last = pixel;
        saturated += ((int)v->picture.channel[VIEW_CLIPPED][pixel] & PHOTO_BRIGHT) != 0;
        for (int c = 0; c < 3; c++) values[c][count] = (struct weighted){v->picture.channel[c][pixel], 1};
        count++;
    }
    if (pixels < MIN_SIGHT) return ST_OK;
    if (array_append(&v->o->sights, (size_t)v->o->sight_count, sizeof *v->o->sights, "views of lamps", err))
        return err->status;
    struct lamp_sight *s = &v->o->sights[v->o->sight_count++];
    const struct vec3 to = vec3_normalize(vec3_sub(v->camera.center, l->centre));
    *s = (struct lamp_sight){lamp, v->index, acos(clamp(vec3_dot(to, l->normal), -1, 1)), {0}, 2 * saturated > count};
    for (int c = 0; c < 3; c++) s->radiance[c] = weighted_percentile(values[c], (size_t)count, 0.5);
    return ST_OK;
}

/* Whether the view may show some point or lamp. */
static bool faces_any(const struct viewer *v)
{
    double x, y;
    for (int i = 0; i < v->scene->point_count; i++)
        if (project(v, v->scene->points[i].at, v->scene->points[i].normal, &x, &y)) return true;
    for (int i = 0; i < v->scene->lights.lamp_count; i++)
        if (project(v, v->scene->lights.lamps[i].centre, v->scene->lights.lamps[i].normal, &x, &y)) return true;
    return false;
}

static enum status read_view(struct viewer *v, const char *views, const char *ids, struct provenance *prov,
                             struct err *err)
{
    const struct product_key key = {.view = v->camera.name};
    char path[FILE_PATH];
    return view_planes_read(&v->picture, views, &v->camera, VIEW_CHANNELS, prov, err) ||
                   product_path_in(path, ids, PRODUCT_IDS, &key, err) ||
                   view_ids_read(&v->ids, &v->camera, path, prov, err)
               ? err->status
               : ST_OK;
}

static enum status observe_view(struct viewer *v, const char *views, const char *ids, struct provenance *prov,
                                struct err *err)
{
    if (!faces_any(v)) return ST_OK;
    read_view(v, views, ids, prov, err);
    for (int i = 0; !err->status && i < v->scene->point_count; i++) observe_point(v, i, err);
    for (int i = 0; !err->status && i < v->scene->lights.lamp_count; i++) observe_lamp(v, i, err);
    view_planes_release(&v->picture);
    view_ids_release(&v->ids);
    return err->status;
}

static int compare(const void *a, const void *b)
{
    const struct observation *x = a, *y = b;
    if (x->point != y->point) return x->point - y->point;
    if (x->photo != y->photo) return x->photo - y->photo;
    return x->aside < y->aside ? -1 : x->aside > y->aside;
}

enum status observe(struct observations *o, const struct lit_scene *scene, const struct annotation_list *notes,
                    const struct lit_model *model, const struct model_rays *furnished, const char *views,
                    const char *ids, const struct fit_lights_params *params, struct provenance *prov, struct err *err)
{
    struct viewer v = {
        .o = o, .scene = scene, .notes = notes, .model = model, .furnished = furnished, .params = params};
    *o = (struct observations){.clipped_points = calloc((size_t)scene->point_count + 1, sizeof(int))};
    if (!o->clipped_points) err_nomem(err, "points", (size_t)scene->point_count);
    for (int i = 0; !err->status && i < model->in.set.view_count; i++) {
        v.index = i;
        v.photo = photo_of_view(&model->in.set, &model->in.lenses, i);
        v.camera = model_from_world_view(&model->in.axes, &model->in.set.views[i]);
        observe_view(&v, views, ids, prov, err);
    }
    if (err->status) return err->status;
    if (o->count) qsort(o->items, (size_t)o->count, sizeof *o->items, compare);
    int kept = 0;
    for (int i = 0; i < o->count; i++)
        if (!i || o->items[i].point != o->items[i - 1].point || o->items[i].photo != o->items[i - 1].photo)
            o->items[kept++] = o->items[i];
    o->count = kept;
    return ST_OK;
}
