/* field_view.c - see field_view.h. */
#include "stages/gather_irradiance/field_view.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/file_path.h"
#include "common/image/exr.h"

static struct vec3 pixel_ray(const struct view *v, int x, int y)
{
    const struct vec3 d = vec3_make((x + 0.5 - v->cx) / v->fx, (y + 0.5 - v->cy) / v->fy, 1);
    return mat3_apply(mat3_transpose(v->cam_from_world), d);
}

/* The point of the model that each pixel shows; a normal of 0 0 0 where there is none, or the view is in a solid. */
static void find_points(struct gather_point *points, const struct gather_job *j, const struct view *v)
{
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            struct gather_point *p = &points[(size_t)y * (size_t)v->width + (size_t)x];
            struct ray_hit hit;
            if (ray_scene_hit(&j->field.model.rays, v->center, pixel_ray(v, x, y), &hit) && hit.front)
                *p = (struct gather_point){hit.point, hit.normal};
        }
}

enum { R, G, B, A, ERROR, LAMPS, UNKNOWN, PLANES };

static void set_pixel(float to[PLANES], const struct irradiance *e)
{
    const double unknown = e->from[LIGHT_SYNTHESISED] + e->from[LIGHT_SKY_GUESSED] + e->from[LIGHT_NONE];
    to[R] = (float)e->value.r, to[G] = (float)e->value.g, to[B] = (float)e->value.b;
    to[A] = 1;
    to[ERROR] = (float)rgb_luminance(e->error);
    to[LAMPS] = (float)e->from[LIGHT_LAMP];
    to[UNKNOWN] = (float)unknown;
}

static enum status write_picture(const struct gather_job *j, const struct view *v, const struct gather_point *points,
                                 const struct irradiance *e, struct err *err)
{
    static const char *const names[PLANES] = {"R", "G", "B", "A", "error", "lamps", "unknown"};
    char folder[FILE_PATH], path[FILE_PATH];
    struct exr_image im = {0};
    enum status st = file_path(folder, j->out, "irradiance", "", err);
    if (!st) st = file_path(path, folder, v->name, ".exr", err);
    if (!st) st = exr_image_init(&im, v->width, v->height, err);
    for (int k = 0; !st && k < PLANES; k++)
        st = exr_add_plane(&im, names[k], k <= ERROR ? EXR_FLOAT : EXR_HALF, NULL, err);
    for (size_t i = 0; !st && i < (size_t)v->width * (size_t)v->height; i++) {
        float pixel[PLANES] = {0};
        if (vec3_length(points[i].normal) > 0) set_pixel(pixel, &e[i]);
        for (int k = 0; k < PLANES; k++) im.planes[k].f[i] = pixel[k];
    }
    if (!st) st = exr_write(&im, path, &j->prov, err);
    exr_image_release(&im);
    return st;
}

enum status gather_view(struct gather_job *j, const char *views, const char *name, struct err *err)
{
    struct camera_set set = {0};
    enum status st = camera_set_add_camera_inputs(&j->prov, views, err);
    if (!st) st = camera_set_read_cameras(&set, views, err);
    const int index = st ? -1 : camera_set_find(&set, name);
    if (!st && index < 0)
        st = err_set(err, ST_DATA, "%s has no view %s; see its images.txt for the names.", views, name);
    const size_t pixels = st ? 0 : (size_t)set.views[index].width * (size_t)set.views[index].height;
    struct gather_point *points = calloc(pixels + 1, sizeof *points);
    struct irradiance *found = calloc(pixels + 1, sizeof *found);
    if (!st && !(points && found)) st = err_nomem(err, "points", pixels * (sizeof *points + sizeof *found));
    if (!st) {
        const struct view view = model_from_world_view(&j->axes, &set.views[index]);
        find_points(points, j, &view);
        st = gather_all(found, points, pixels, j, name, err);
        if (!st) st = write_picture(j, &view, points, found, err);
    }
    free(points);
    free(found);
    camera_set_release(&set);
    return st;
}
