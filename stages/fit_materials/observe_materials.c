/* observe_materials.c - points of marked regions, and their radiance in all views that show them [Colburn 2014, 5.4].
 *
 * A region is a polygon in one photo. Points are where the rays of a square grid of its pixels hit the model; the grid
 * is as wide as the wished number of points needs. A view shows a point if its ids have the same face there, without
 * clutter, jump or clipped pixel near, and the surface is not seen at a grazing angle. The radiance is the mean of a
 * small square of pixels. Its variance is that of the mean of their noise, of their deviation from each other, and of a
 * fraction of the radiance for what no pixel tells (the model's place, gains).
 *
 * Of several views of one photo the one counts in which the point is nearest the centre. If more photos show a point
 * than wanted, every k-th is used: they are in order of name, which often is the order of the walk. */
#include "stages/fit_materials/observe_materials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/capture/photo_camera.h"
#include "common/capture/view_image.h"
#include "common/math/numbers.h"
#include "common/texture/view_ids.h"

void observe_release(struct observations *o)
{
    if (!o) return;
    free(o->points);
    free(o->sights);
    *o = (struct observations){0};
}

/* ----------------------------------------------------------------------------------------------------------- points */

static enum status add_point(struct observations *o, const struct observed_scene *s, const struct photo_camera *camera,
                             double x, double y, int material, struct err *err)
{
    struct vec3 world;
    struct ray_hit hit;
    if (!photo_camera_ray(camera, x, y, &world)) return ST_OK;
    const struct vec3 from = model_from_world_point(s->axes, camera->center);
    if (!ray_scene_hit(&s->model->rays, from, model_from_world_direction(s->axes, world), &hit) || !hit.front)
        return ST_OK;
    if (array_append(&o->points, (size_t)o->point_count, sizeof *o->points, "points of materials", err))
        return err->status;
    o->points[o->point_count++] =
        (struct material_point){hit.point, hit.normal, material, solid_face_id(&s->model->mesh, (int)hit.id)};
    return ST_OK;
}

static enum status check_region(const struct material_region *r, const struct photo_camera *camera, const char *path,
                                struct err *err)
{
    for (int i = 0; i < r->corners; i++) {
        const double *p = r->pixel + 2 * i;
        if (p[0] < 0 || p[1] < 0 || p[0] > camera->lens.width || p[1] > camera->lens.height)
            return err_set(err, ST_DATA,
                           "%s:%d: the corner %g %g is not inside the photo %s, which has %d x %d pixels.", path,
                           r->line, p[0], p[1], r->view, camera->lens.width, camera->lens.height);
    }
    return ST_OK;
}

/* Points of one region, `step` pixels apart. */
static enum status add_region(struct observations *o, const struct observed_scene *s, const struct material_region *r,
                              double step, int material, struct err *err)
{
    struct photo_camera camera;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    if (photo_camera_find(&camera, r->view, s->set, s->lenses, s->path, r->line, err) ||
        check_region(r, &camera, s->path, err))
        return err->status;
    for (int i = 0; i < 2 * r->corners; i++) {
        low[i % 2] = fmin(low[i % 2], r->pixel[i]);
        high[i % 2] = fmax(high[i % 2], r->pixel[i]);
    }
    const int before = o->point_count;
    for (double y = low[1] + step / 2; y < high[1]; y += step)
        for (double x = low[0] + step / 2; x < high[0]; x += step)
            if (material_region_holds(r, x, y) && add_point(o, s, &camera, x, y, material, err)) return err->status;
    if (o->point_count > before) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s:%d: no surface of the model is in the region in %s; draw it larger, or where the model has one.",
                   s->path, r->line, r->view);
}

enum status observe_points(struct observations *o, const struct observed_scene *scene,
                           const struct material_list *marked, struct err *err)
{
    *o = (struct observations){0};
    for (int m = 0; m < marked->count; m++) {
        const struct material *material = &marked->items[m];
        double area = 0;
        for (int k = 0; k < material->region_count; k++) area += material_region_area(&material->regions[k]);
        const double step = fmax(1, sqrt(area / scene->params->points));
        for (int k = 0; k < material->region_count; k++)
            if (add_region(o, scene, &material->regions[k], step, m, err)) return err->status;
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ views */

struct viewer {
    struct observations *o;
    const struct observed_scene *scene;
    int index, photo;
    struct view camera; /* model frame */
    struct view_planes picture;
    struct view_ids ids;
};

/* Whether the camera sees the side of the surface, not too aslant, in the view; its pixel. */
static bool faces(const struct viewer *v, const struct material_point *p, double *x, double *y)
{
    const int margin = v->scene->params->patch;
    const struct vec3 to = vec3_sub(v->camera.center, p->at);
    if (!(vec3_dot(p->normal, to) > sin(v->scene->params->min_angle * DEGREE) * vec3_length(to))) return false;
    if (!(view_project(&v->camera, p->at, x, y) > 0)) return false;
    return *x >= margin && *y >= margin && *x < v->camera.width - margin && *y < v->camera.height - margin;
}

static bool shows(const struct viewer *v, const struct material_point *p, size_t pixel)
{
    const struct materials_params *params = v->scene->params;
    return v->ids.id[pixel] == (uint32_t)p->face && v->ids.clutter[pixel] < (float)params->max_clutter &&
           v->ids.jump[pixel] >= (float)params->edge;
}

/* Mean and variance of the square about a pixel; false: part of it is outside the photo, dark or saturated. */
static bool average(struct point_sight *sight, const struct viewer *v, int cx, int cy)
{
    const int r = v->scene->params->patch, n = (2 * r + 1) * (2 * r + 1);
    double squares[3] = {0, 0, 0}, noise = 0;
    for (int k = 0; k < n; k++) {
        const size_t i =
            (size_t)(cy - r + k / (2 * r + 1)) * (size_t)v->camera.width + (size_t)(cx - r + k % (2 * r + 1));
        if (!(v->picture.channel[VIEW_A][i] > 0.999f) || v->picture.channel[VIEW_CLIPPED][i] > 0) return false;
        noise += v->picture.channel[VIEW_SIGMA][i] * v->picture.channel[VIEW_SIGMA][i];
        for (int c = 0; c < 3; c++) {
            sight->radiance[c] += v->picture.channel[c][i] / n;
            squares[c] += v->picture.channel[c][i] * v->picture.channel[c][i] / n;
        }
    }
    for (int c = 0; c < 3; c++) {
        const double l = sight->radiance[c], more = v->scene->params->noise;
        if (!(l >= 0)) return false;
        sight->variance[c] = fmax(0, squares[c] - l * l) / n + l * l * (noise / n / n + more * more);
    }
    return true;
}

static enum status observe_point(struct viewer *v, int point, struct err *err)
{
    const struct material_point *p = &v->o->points[point];
    struct point_sight sight = {.point = point, .view = v->index, .photo = v->photo};
    if (!faces(v, p, &sight.x, &sight.y)) return ST_OK;
    const int x = (int)floor(sight.x), y = (int)floor(sight.y);
    if (!shows(v, p, (size_t)y * (size_t)v->camera.width + (size_t)x) || !average(&sight, v, x, y)) return ST_OK;
    sight.aside = hypot(sight.x - 0.5 * v->camera.width, sight.y - 0.5 * v->camera.height) / v->camera.width;
    if (array_append(&v->o->sights, (size_t)v->o->sight_count, sizeof *v->o->sights, "samples", err))
        return err->status;
    v->o->sights[v->o->sight_count++] = sight;
    return ST_OK;
}

static enum status read_view(struct viewer *v, struct provenance *prov, struct err *err)
{
    const struct product_key key = {.view = v->camera.name};
    char path[FILE_PATH];
    return view_planes_read(&v->picture, v->scene->views, &v->camera, VIEW_CHANNELS, prov, err) ||
                   product_path_in(path, v->scene->ids, PRODUCT_IDS, &key, err) ||
                   view_ids_read(&v->ids, &v->camera, path, prov, err)
               ? err->status
               : ST_OK;
}

static enum status observe_view(struct viewer *v, struct provenance *prov, struct err *err)
{
    bool any = false;
    double x, y;
    for (int i = 0; !any && i < v->o->point_count; i++) any = faces(v, &v->o->points[i], &x, &y);
    if (!any) return ST_OK;
    read_view(v, prov, err);
    for (int i = 0; !err->status && i < v->o->point_count; i++) observe_point(v, i, err);
    view_planes_release(&v->picture);
    view_ids_release(&v->ids);
    return err->status;
}

static int compare_sights(const void *a, const void *b)
{
    const struct point_sight *x = a, *y = b;
    if (x->point != y->point) return x->point - y->point;
    if (x->photo != y->photo) return x->photo - y->photo;
    if (x->aside != y->aside) return x->aside < y->aside ? -1 : 1;
    return x->view - y->view;
}

/* Keeps the first sight of each photo, and of the photos of a point at most `most`. */
static void thin(struct observations *o, int most)
{
    int kept = 0;
    for (int i = 0; i < o->sight_count; i++)
        if (!i || o->sights[i].point != o->sights[i - 1].point || o->sights[i].photo != o->sights[i - 1].photo)
            o->sights[kept++] = o->sights[i];
    const int count = kept;
    kept = 0;
    for (int from = 0, end; from < count; from = end) {
        for (end = from; end < count && o->sights[end].point == o->sights[from].point;) end++;
        const int have = end - from, use = have < most ? have : most;
        for (int k = 0; k < use; k++) o->sights[kept++] = o->sights[from + (int)((int64_t)k * have / use)];
    }
    o->sight_count = kept;
}

enum status observe_views(struct observations *o, const struct observed_scene *scene, struct provenance *prov,
                          struct err *err)
{
    struct viewer v = {.o = o, .scene = scene};
    for (int i = 0; i < scene->set->view_count; i++) {
        v.index = i;
        v.photo = photo_of_view(scene->set, scene->lenses, i);
        v.camera = model_from_world_view(scene->axes, &scene->set->views[i]);
        if (observe_view(&v, prov, err)) return err->status;
    }
    if (o->sight_count) qsort(o->sights, (size_t)o->sight_count, sizeof *o->sights, compare_sights);
    thin(o, scene->params->views);
    return ST_OK;
}
