/* field_view.c - see field_view.h. */
#include "stages/gather_irradiance/field_view.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/file_path.h"
#include "common/image/exr.h"
#include "common/product/product.h"
#include "stages/gather_irradiance/light_summary.h"
#include "stages/gather_irradiance/view_gloss.h"

static struct vec3 pixel_ray(const struct view *v, int x, int y)
{
    const struct vec3 d = vec3_make((x + 0.5 - v->cx) / v->fx, (y + 0.5 - v->cy) / v->fy, 1);
    return mat3_apply(mat3_transpose(v->cam_from_world), d);
}

/* What the pixels of a view show. Everything is owned. */
struct view_surface {
    struct gather_point *points; /* a normal of 0 0 0: nothing, or the view is in a solid */
    int *faces;                  /* ids; 0: nothing, or furniture */
    struct irradiance *irradiance;
    struct view_gloss gloss;
};

static enum status surface_init(struct view_surface *s, const struct view *v, struct err *err)
{
    const size_t pixels = (size_t)v->width * (size_t)v->height;
    s->points = calloc(pixels + 1, sizeof *s->points);
    s->faces = calloc(pixels + 1, sizeof *s->faces);
    s->irradiance = calloc(pixels + 1, sizeof *s->irradiance);
    return s->points && s->faces && s->irradiance
               ? ST_OK
               : err_nomem(err, "points", pixels * (sizeof *s->points + sizeof *s->irradiance));
}

static void surface_release(struct view_surface *s)
{
    free(s->points);
    free(s->faces);
    free(s->irradiance);
    view_gloss_release(&s->gloss);
}

static void find_points(struct view_surface *s, const struct gather_job *j, const struct view *v)
{
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            const size_t i = (size_t)y * (size_t)v->width + (size_t)x;
            struct ray_hit hit;
            if (!ray_scene_hit(&j->field.model.rays, v->center, pixel_ray(v, x, y), &hit) || !hit.front) continue;
            s->points[i] = (struct gather_point){hit.point, hit.normal};
            if ((int)hit.id < j->field.model.mesh.face_count)
                s->faces[i] = solid_face_id(&j->field.model.mesh, (int)hit.id);
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

static enum status add_irradiance(struct exr_image *im, const struct view_surface *s, struct err *err)
{
    static const char *const names[PLANES] = {"R", "G", "B", "A", "error", "lamps", "unknown"};
    for (int k = 0; k < PLANES; k++)
        if (exr_add_plane(im, names[k], k <= ERROR ? EXR_FLOAT : EXR_HALF, NULL, err)) return err->status;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++) {
        float pixel[PLANES] = {0};
        if (vec3_length(s->points[i].normal) > 0) set_pixel(pixel, &s->irradiance[i]);
        for (int k = 0; k < PLANES; k++) im->planes[k].f[i] = pixel[k];
    }
    return ST_OK;
}

static enum status add_gloss(struct exr_image *im, const struct view_gloss *g, struct err *err)
{
    static const char *const names[4] = {"specular.R", "specular.G", "specular.B", "material"};
    for (int k = 0; k < 4; k++)
        if (exr_add_plane(im, names[k], k < 3 ? EXR_FLOAT : EXR_UINT, NULL, err)) return err->status;
    const struct exr_plane *planes = im->planes + im->count - 4;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++) {
        planes[0].f[i] = (float)g->specular[i].r;
        planes[1].f[i] = (float)g->specular[i].g;
        planes[2].f[i] = (float)g->specular[i].b;
        planes[3].u[i] = g->material[i];
    }
    return ST_OK;
}

static enum status write_picture(const struct gather_job *j, const struct view *v, const struct view_surface *s,
                                 struct err *err)
{
    char name[FILE_PATH], path[FILE_PATH];
    struct exr_image im = {0};
    if (!file_path(name, "irradiance", v->name, "", err) &&
        !product_path_in(path, j->out, PRODUCT_IRRADIANCE_VIEW, &(struct product_key){.gathered = name}, err) &&
        !exr_image_init(&im, v->width, v->height, err))
        add_irradiance(&im, s, err);
    if (!err->status && s->gloss.material) add_gloss(&im, &s->gloss, err);
    if (!err->status) exr_write(&im, path, &j->prov, err);
    exr_image_release(&im);
    return err->status;
}

enum status gather_view(struct gather_job *j, const char *views, const char *name, bool gloss, struct err *err)
{
    struct camera_set set = {0};
    struct view_surface s = {0};
    camera_set_read_cameras(&set, views, &j->prov, err);
    const int index = err->status ? -1 : camera_set_find(&set, name);
    if (!err->status && index < 0)
        err_set(err, ST_DATA, "%s has no view %s; see its images.txt for the names.", views, name);
    if (!err->status && !surface_init(&s, &set.views[index], err)) {
        const struct view view = model_from_world_view(&j->axes, &set.views[index]);
        find_points(&s, j, &view);
        if (!gather_grid(s.irradiance, s.points, view.width, view.height, j, name, err))
            light_summary_of_view(j, &view, s.points, s.irradiance, err);
        if (!err->status && gloss) view_gloss_gather(&s.gloss, j, &view, s.points, s.faces, s.irradiance, err);
        if (!err->status) write_picture(j, &view, &s, err);
    }
    surface_release(&s);
    camera_set_release(&set);
    return err->status;
}
