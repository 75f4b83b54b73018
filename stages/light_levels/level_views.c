/* level_views.c - see level_views.h.
 *
 * A ray through each pixel finds the face of the model, or the furniture, that the photograph shows. Its illuminance is
 * interpolated between patches (patch_values.h); furniture has that of its patch. The direct light of a sun at a given
 * time comes from a ray of its own, so that its edges are sharp. Colours (level_scale.h) are shaded by the photograph,
 * so that things can be recognised; where nothing is known, the photograph is dark and without colour. Isolines are
 * found on a grid of GRID pixels, where all four corners of a square lie on one face. */
#include "stages/light_levels/level_views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/scan.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/image/luminance.h"
#include "common/image/photo.h"
#include "common/product/product.h"
#include "stages/light_levels/level_lines.h"
#include "stages/light_levels/level_scale.h"
#include "stages/light_levels/patch_values.h"

enum { MOST_SIDE = 720, GRID = 4, QUALITY = 82, MARGIN = 56, ROWS = 8, PIXELS = 4096, SAMPLES = 4 };
static const double DARK = 0.3, SHADE = 0.35; /* of the photograph: alone, and below colours */

/* ----------------------------------------------------------------------------------------------------------- photos */

/* The camera of a photo, and how its picture is turned: by quarters, so that up is up. */
struct photo_sight {
    struct photo_camera camera;
    const struct model_axes *axes;
    int quarters; /* clockwise, from the stored photo to the upright one */
};

static void turn_upright(struct photo_sight *s)
{
    const struct vec3 up =
        mat3_apply(s->camera.cam_from_world, world_from_model_direction(s->axes, vec3_make(0, 0, 1)));
    if (fabs(up.x) > fabs(up.y))
        s->quarters = up.x > 0 ? 3 : 1;
    else
        s->quarters = up.y > 0 ? 2 : 0;
}

/* The ray through a place of the upright picture of v, in the world; false: beyond the photo. */
static bool sight_ray(struct vec3 *ray, const struct photo_sight *s, const struct level_view *v, double x, double y)
{
    const double a = x / v->width, b = y / v->height;
    const double across[4] = {a, b, 1 - a, 1 - b}, down[4] = {b, 1 - a, 1 - b, a};
    return photo_camera_ray(&s->camera, across[s->quarters] * s->camera.lens.width,
                            down[s->quarters] * s->camera.lens.height, ray);
}

/* Sums of what the views of a photo show of each pixel. */
struct looking_up {
    const struct view *view;
    const struct image *im; /* of three channels, or with a fourth that is 1 where the view shows the photo */
    double *sum;            /* of R, G, B and weights */
};

static void look_up(const struct looking_up *l, int pixel, struct vec3 ray)
{
    const struct vec3 p = mat3_apply(l->view->cam_from_world, ray);
    if (!(p.z > 0)) return;
    const double u = (l->view->fx * p.x / p.z + l->view->cx) / l->view->width;
    const double v = (l->view->fy * p.y / p.z + l->view->cy) / l->view->height;
    if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return;
    const float *rgb = image_at(l->im, (int)(u * l->im->width), (int)(v * l->im->height));
    if (l->im->channels == 4 && !(rgb[3] > 0.999f)) return;
    for (int c = 0; c < 3; c++) l->sum[4 * pixel + c] += p.z * (double)rgb[c];
    l->sum[4 * pixel + 3] += p.z;
}

/* An edit's picture of the view. */
static enum status read_picture(struct image *im, const char *folder, const char *name, struct provenance *prov,
                                struct err *err)
{
    struct photo photo = {0};
    char path[FILE_PATH];
    if (!provenance_add_in(prov, "pictures", folder, name, ".jpg", path, err) && !photo_read(&photo, path, err))
        photo_to_linear(im, &photo, err);
    photo_release(&photo);
    return err->status;
}

/* The edit's picture in the light that it makes. */
static enum status read_relit(struct image *im, const char *folder, const char *name, struct provenance *prov,
                              struct err *err)
{
    static const char *const channels[] = {"R", "G", "B"};
    struct exr_image exr = {0};
    char path[FILE_PATH];
    if (!provenance_add_in(prov, "relit", folder, name, ".exr", path, err) && !exr_read(&exr, path, channels, 3, err) &&
        !image_init(im, exr.width, exr.height, 3, err))
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < exr.width * exr.height; i++) im->data[3 * i + c] = exr_find(&exr, channels[c])->f[i];
    exr_image_release(&exr);
    return err->status;
}

/* Whether all views of a photo were relit: old and new light do not go together. */
static bool is_relit(const struct level_view_files *files, const struct scene_cameras *cameras, int photo,
                     struct err *err)
{
    char path[FILE_PATH];
    for (int k = 0; files->relit && k < cameras->set.view_count; k++) {
        if (photo_of_view(&cameras->set, &cameras->lenses, k) != photo) continue;
        if (file_path(path, files->relit, cameras->set.views[k].name, ".exr", err) || !path_is_file(path)) return false;
    }
    return files->relit != NULL;
}

static enum status read_view(struct image *im, const struct level_view_files *files, const struct view *view,
                             bool relit, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH] = "";
    if (relit) return read_relit(im, files->relit, view->name, prov, err);
    if (files->pictures && file_path(path, files->pictures, view->name, ".jpg", err)) return err->status;
    if (*path && path_is_file(path)) return read_picture(im, files->pictures, view->name, prov, err);
    return view_image_read(im, files->views, view, prov, err);
}

static enum status read_photo(struct level_view *v, const struct photo_sight *s, const struct level_view_files *files,
                              const struct scene_cameras *cameras, struct provenance *prov, struct err *err)
{
    const int pixels = v->width * v->height, first = photo_of_view(&cameras->set, &cameras->lenses, s->camera.view_idx);
    const bool relit = v->relit = is_relit(files, cameras, first, err);
    double *sum = calloc(4 * (size_t)pixels + 1, sizeof *sum);
    if (!sum) return err_nomem(err, "a photo", 4 * (size_t)pixels * sizeof *sum);
    for (int k = 0; !err->status && k < cameras->set.view_count; k++) {
        struct image im = {0};
        struct vec3 ray;
        if (photo_of_view(&cameras->set, &cameras->lenses, k) != first) continue;
        read_view(&im, files, &cameras->set.views[k], relit, prov, err);
        const struct looking_up l = {&cameras->set.views[k], &im, sum};
        for (int i = 0; !err->status && i < SAMPLES * pixels; i++) {
            const int x = i / SAMPLES % v->width, y = i / SAMPLES / v->width;
            if (sight_ray(&ray, s, v, x + 0.25 + 0.5 * (i & 1), y + 0.25 + 0.5 * (i >> 1 & 1)))
                look_up(&l, i / SAMPLES, ray);
        }
        image_release(&im);
    }
    for (int i = 0; !err->status && i < pixels; i++) {
        const double weight = sum[4 * i + 3];
        for (int c = 0; c < 3; c++)
            v->photo[3 * i + c] =
                weight > 0 ? (unsigned char)lroundf(255 * srgb_from_linear((float)(sum[4 * i + c] / weight))) : 0;
        if (!(weight > 0)) v->pixels[i].surface = NO_PHOTO;
    }
    free(sum);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- tracing */

struct tracing {
    const struct level_view *view;
    const struct photo_sight *sight;
    const struct light_patches *patches;
};

static void trace_pixel(const struct tracing *t, int x, int y)
{
    struct level_pixel *p = &t->view->pixels[y * t->view->width + x];
    struct vec3 ray;
    struct ray_hit hit;
    *p = (struct level_pixel){.surface = NO_PHOTO};
    if (!sight_ray(&ray, t->sight, t->view, x + 0.5, y + 0.5)) return;
    ray = model_from_world_direction(t->sight->axes, ray);
    *p = (struct level_pixel){{(float)ray.x, (float)ray.y, (float)ray.z}, 0, -1};
    if (!ray_scene_hit(&t->patches->field->model.rays, t->view->from, ray, &hit)) return;
    const int patch = patches_hit(t->patches, &hit);
    if (patch < 0) return;
    p->surface = t->patches->list[patch].face >= 0 ? t->patches->list[patch].face : -2 - patch;
    p->away = (float)hit.t;
}

static void trace_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct tracing *t = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < t->view->width; x++) trace_pixel(t, x, (int)y);
}

static enum status make_view(struct level_view *v, const char *name, const struct level_view_files *files,
                             const struct scene_cameras *cameras, const struct model_axes *axes,
                             const struct level_light *light, struct provenance *prov, struct err *err)
{
    struct photo_sight sight = {.axes = axes};
    if (photo_camera_find(&sight.camera, name, &cameras->set, &cameras->lenses, "--photo", 0, err)) return err->status;
    turn_upright(&sight);
    const struct camera *lens = &sight.camera.lens;
    const double scale = fmin(1, (double)MOST_SIDE / fmax(lens->width, lens->height));
    const int wide = (int)fmax(2, 2 * floor(lens->width * scale / 2));
    const int high = (int)fmax(2, 2 * floor(lens->height * scale / 2));
    const bool lies = sight.quarters & 1;
    *v = (struct level_view){.name = name,
                             .width = lies ? high : wide,
                             .height = lies ? wide : high,
                             .from = model_from_world_point(axes, sight.camera.center)};
    const size_t pixels = (size_t)wide * (size_t)high;
    v->pixels = malloc(pixels * sizeof *v->pixels);
    v->photo = malloc(3 * pixels);
    if (!v->pixels || !v->photo) return err_nomem(err, "a photo", pixels * sizeof *v->pixels);
    const struct tracing t = {v, &sight, &light->patches};
    parallel_for((size_t)v->height, ROWS, trace_rows, (void *)&t);
    return read_photo(v, &sight, files, cameras, prov, err);
}

enum status level_views_make(struct level_views *v, const struct level_view_files *files, const struct model_axes *axes,
                             const struct level_light *light, struct provenance *prov, struct err *err)
{
    char lenses[FILE_PATH];
    *v = (struct level_views){.count = 0};
    if (!files->views || !files->names.count) return ST_OK;
    if (camera_set_read_cameras(&v->cameras.set, files->views, prov, err) ||
        product_path_in(lenses, files->views, PRODUCT_LENSES, &(struct product_key){0}, err) ||
        lens_list_read(&v->cameras.lenses, lenses, prov, err))
        return err->status;
    v->list = calloc((size_t)files->names.count, sizeof *v->list);
    if (!v->list) return err_nomem(err, "photos", (size_t)files->names.count * sizeof *v->list);
    for (int i = 0; !err->status && i < files->names.count; i++)
        make_view(&v->list[v->count++], files->names.items[i], files, &v->cameras, axes, light, prov, err);
    v->relit = v->count > 0;
    for (int i = 0; i < v->count; i++) v->relit &= v->list[i].relit;
    return err->status;
}

void level_views_release(struct level_views *v)
{
    for (int i = 0; i < v->count; i++) {
        free(v->list[i].photo);
        free(v->list[i].pixels);
    }
    free(v->list);
    lens_list_release(&v->cameras.lenses);
    camera_set_release(&v->cameras.set);
    *v = (struct level_views){.count = 0};
}

/* ----------------------------------------------------------------------------------------------------------- values */

enum status level_views_patches(double *patches, const struct level_light *light, const struct level_views_state *state,
                                struct err *err)
{
    const struct light_groups *g = &light->groups;
    const struct state_weights *w = state->weights;
    const int count = light->patches.count;
    double(*sums)[2] = malloc(((size_t)count + 1) * sizeof *sums);
    if (!sums) return err_nomem(err, "patches", (size_t)count * sizeof *sums);
    level_patches_sum(sums, light, w, err);
    for (int i = 0; !err->status && i < count; i++) {
        const float *direct = light->rows.direct + 3 * (size_t)g->count * (size_t)i;
        for (int k = g->beam; w->sun > 0 && k < g->beam + g->windows_count * g->patches.count; k++)
            sums[i][1] -= w->absolute[k] * (double)luminance_of(direct + 3 * (size_t)k);
        patches[i] = state->factors[0] * sums[i][0] + state->factors[1] * fmax(0, sums[i][1]);
    }
    free(sums);
    return err->status;
}

struct valuing {
    float *values;
    const struct level_view *view;
    const struct level_light *light;
    const double *patches;
    const struct level_views_state *state;
};

static float value_of(const struct valuing *j, const struct level_pixel *pixel)
{
    const struct light_patches *p = &j->light->patches;
    const int surface = pixel->surface;
    if (surface == -1 || surface == NO_PHOTO) return NAN;
    const struct vec3 ray = vec3_make((double)pixel->ray[0], (double)pixel->ray[1], (double)pixel->ray[2]);
    const struct vec3 at = vec3_add(j->view->from, vec3_scale(ray, (double)pixel->away));
    const struct vec3 normal =
        surface >= 0 ? p->field->model.mesh.faces[surface].normal : p->list[-2 - surface].origins[0].normal;
    const double value = surface >= 0 ? patch_values_at(p, j->patches, surface, at) : j->patches[-2 - surface];
    const struct gather_point point = {at, normal};
    return (float)(value + j->state->factors[1] * level_weights_sun(j->state->weights, point));
}

static void value_pixels(void *ctx, size_t begin, size_t end, int thread)
{
    const struct valuing *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) j->values[i] = value_of(j, &j->view->pixels[i]);
}

void level_views_values(float *values, const struct level_view *v, const struct level_light *light,
                        const double *patches, const struct level_views_state *state)
{
    const struct valuing j = {values, v, light, patches, state};
    parallel_for((size_t)v->width * (size_t)v->height, PIXELS, value_pixels, (void *)&j);
}

/* ---------------------------------------------------------------------------------------------------------- drawing */

void level_views_paint(unsigned char *rgb, const struct level_view *v, const float *values,
                       const struct level_scale *scale)
{
    const int pixels = v->width * v->height;
    for (int i = 0; i < pixels; i++) {
        unsigned char colour[3] = {255, 255, 255};
        const unsigned char *p = v->photo + 3 * i;
        const double photo = (LUMINANCE_R * p[0] + LUMINANCE_G * p[1] + LUMINANCE_B * p[2]) / 255;
        const bool known = isfinite(values[i]);
        if (known) level_scale_colour(scale, (double)values[i], colour);
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (unsigned char)(colour[c] * (known ? 1 - SHADE + SHADE * photo : DARK * photo) + 0.5);
    }
}

/* The values on the grid of isolines, where they are of faces. */
static enum status draw_lines(FILE *to, const struct level_view *v, const float *values,
                              const struct level_scale *scale, struct err *err)
{
    const int width = (v->width - 1) / GRID + 1, height = (v->height - 1) / GRID + 1;
    const size_t count = (size_t)width * (size_t)height;
    struct level_grid grid = {width, height, GRID, malloc(count * sizeof(float)), malloc(count * sizeof(int))};
    if (!grid.values || !grid.surface) err_nomem(err, "isolines", count * sizeof(float));
    for (size_t i = 0; !err->status && i < count; i++) {
        const int at = ((int)i / width) * GRID * v->width + ((int)i % width) * GRID;
        grid.values[i] = values[at];
        grid.surface[i] = isfinite(values[at]) ? v->pixels[at].surface : -1;
    }
    for (int k = 0; !err->status && k < scale->line_count; k++) level_lines_put(to, &grid, scale->lines[k], err);
    free(grid.values);
    free(grid.surface);
    return err->status;
}

static void put_title(FILE *to, const struct level_view *v, const struct level_views_state *state, const float *values)
{
    double low = INFINITY, high = 0;
    char numbers[2][32];
    for (int i = 0; i < v->width * v->height; i++)
        if (isfinite(values[i])) {
            low = fmin(low, (double)values[i]);
            high = fmax(high, (double)values[i]);
        }
    fprintf(to, "<text class=\"name\" x=\"%d\" y=\"%d\">", v->width / 2, v->height + 17);
    fprintf(to, "%s, %s: %s to %s %s</text>\n", state->name, v->name, level_scale_number(numbers[0], fmin(low, high)),
            level_scale_number(numbers[1], high), state->unit);
}

static enum status write_view(const struct level_view *v, const struct level_light *light, const double *patches,
                              const struct level_views_state *state, const char *path, struct err *err)
{
    const struct level_scale scale = level_scale_of(state->unit, 0);
    const int width = v->width, height = v->height;
    const size_t pixels = (size_t)width * (size_t)height;
    float *values = malloc(pixels * sizeof *values);
    unsigned char *rgb = malloc(3 * pixels), *jpeg = NULL;
    struct outfile f = {0};
    size_t size = 0;
    if (!values || !rgb) err_nomem(err, "a picture", 3 * pixels);
    if (!err->status) {
        level_views_values(values, v, light, patches, state);
        level_views_paint(rgb, v, values, &scale);
        if (!jpeg_encode(&jpeg, &size, rgb, width, height, QUALITY, err)) outfile_open(&f, path, err);
    }
    if (!err->status) {
        const locale_t was = uselocale(scan_c_locale());
        fprintf(
            f.fp,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"Light levels "
            "over a photograph\">\n<style>text{font:13px sans-serif;text-anchor:middle;fill:#222}"
            ".name{font-weight:600}" LEVEL_STYLES
            "</style>\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n<image width=\"%d\" height=\"%d\" "
            "href=\"data:image/jpeg;base64,",
            width, height + MARGIN, width, height);
        base64_write(f.fp, jpeg, size);
        fputs("\"/>\n", f.fp);
        draw_lines(f.fp, v, values, &scale, err);
        put_title(f.fp, v, state, values);
        level_scale_put_key(&scale, f.fp, 0.06 * width, height + 23, 0.84 * width);
        fputs("</svg>\n", f.fp);
        uselocale(was);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    free(jpeg);
    free(values);
    free(rgb);
    return err->status;
}

enum status level_views_draw(const struct level_views *v, const struct level_light *light,
                             const struct level_views_state *state, const char *out, struct err *err)
{
    if (!v->count) return ST_OK;
    double *patches = malloc(((size_t)light->patches.count + 1) * sizeof *patches);
    if (!patches) return err_nomem(err, "patches", (size_t)light->patches.count * sizeof *patches);
    level_views_patches(patches, light, state, err);
    for (int i = 0; !err->status && i < v->count; i++) {
        char name[FILE_PATH], path[FILE_PATH];
        snprintf(name, sizeof name, "%s.%s", state->name, v->list[i].name);
        if (!product_path_in(path, out, PRODUCT_LIGHT_PLAN, &(struct product_key){.name = name}, err))
            write_view(&v->list[i], light, patches, state, path, err);
    }
    free(patches);
    return err->status;
}
