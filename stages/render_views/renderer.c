/* renderer.c - the passes of a frame, in the order of renderer.h's table. */
#include "stages/render_views/renderer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "stages/render_views/half_sphere.h"

#define PARAM_STRUCT struct render_params
const struct param render_param_table[] = {RENDER_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status render_anchor(void *ctx, int frame, struct rendered_frame *out, struct err *err)
{
    struct renderer *r = ctx;
    return layer_render(out, r->scene, &r->path->frames[frame].camera, &r->options, err);
}

static struct hole_photos photos_of(void *ctx, const struct view *camera)
{
    const struct renderer *r = ctx;
    return layer_photos(r->scene, camera, &r->options);
}

static void log_exposures(const struct layer_scene *scene)
{
    const struct photo_exposures *e = &scene->exposures;
    double low = INFINITY, high = -INFINITY;
    if (!e->gain) return;
    for (int i = 0; i < scene->set->view_count; i++) {
        low = fmin(low, e->gain[i][1]);
        high = fmax(high, e->gain[i][1]);
    }
    log_note("the brightest photo has %.2f times the exposure of the darkest: they are brought to one",
             exp(high - low));
}

enum status renderer_match_exposures(struct layer_scene *scene, const struct render_params *params, struct err *err)
{
    /* a single photo needs no match */
    if (strcmp(params->exposure, "matched") != 0 || strcmp(params->views, "nearest") == 0) return ST_OK;
    if (!layer_scene_match_exposures(scene, err)) log_exposures(scene);
    return err->status;
}

void renderer_init(struct renderer *r, const struct layer_scene *scene, const struct camera_path *path,
                   const struct effects *effects, const struct render_params *params)
{
    *r = (struct renderer){.scene = scene, .path = path, .effects = effects, .fill_diameter = params->fill_diameter};
    r->options.offline = strcmp(params->renderer, "offline") == 0;
    r->options.nearest_alone = strcmp(params->views, "nearest") == 0;
    r->options.more_views = params->more_views;
    r->options.soft_z = params->soft_z;
    r->options.fill_diameter = r->options.offline ? 0 : params->fill_diameter;
    r->exemplar = (struct exemplar_params){.fill_patch = params->fill_patch, .fill_window = params->fill_window};
    r->depth = (struct exemplar_depth){layer_scene_soft_z(scene, SOFT_Z_FILL_WIDTHS), (float)scene->sigma};
    r->aperture = (struct aperture_options){params->aperture_samples, params->aperture_error};
    if (!path || !r->options.offline) return;
    const struct fill_path_options fill = {r->depth, r->exemplar, params->fill_diameter, params->fill_anchor_spacing,
                                           photos_of};
    fill_path_init(&r->fill, path, render_anchor, r, &fill);
}

/* A pinhole picture of the current frame, from its camera or one within its aperture. */
static enum status render_pinhole(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    struct renderer *r = ctx;
    layer_render(out, r->scene, camera, &r->options, err);
    return err->status || !r->options.offline ? err->status : fill_path_frame(&r->fill, r->frame, camera, out, err);
}

/* Fills the holes of a face, except those beyond the photos. */
static enum status fill_within_photos(struct renderer *r, const struct view *camera, struct rendered_frame *out,
                                      struct err *err)
{
    const struct hole_photos photos = photos_of(r, camera);
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    uint8_t *beyond = malloc(pixels);
    if (!beyond) return err_nomem(err, "the holes of a frame", pixels);
    if (!hole_find_overhang(beyond, out, &photos, err) && out->hole_fraction < 1)
        hole_fill(out, &photos, &r->depth.soft, r->depth.sigma, r->fill_diameter, err);
    for (size_t p = 0; !err->status && p < pixels; p++) {
        if (!beyond[p]) continue;
        memset(out->rgba + 4 * p, 0, 4 * sizeof *out->rgba);
        out->z[p] = 0;
    }
    free(beyond);
    return err->status;
}

/* A face of a half-sphere. */
static enum status render_face(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    struct renderer *r = ctx;
    struct layer_render_options options = r->options;
    options.fill_diameter = 0;
    if (layer_render(out, r->scene, camera, &options, err) || fill_within_photos(r, camera, out, err))
        return err->status;
    photo_exposures_apply(&r->scene->exposures, &r->scene->mesh, camera, out);
    effects_apply(r->effects, r->path->frames[r->frame].time, camera, out);
    return ST_OK;
}

enum status renderer_frame(struct renderer *r, int frame, struct rendered_frame *out, struct err *err)
{
    const struct path_frame *f = &r->path->frames[frame];

    r->frame = frame;
    if (r->half_sphere) return half_sphere_render(out, &f->camera, render_face, r, err);
    if (r->options.offline)
        aperture_render(out, &f->camera, f->aperture, f->focus, &r->aperture, render_pinhole, r, NULL, err);
    else if (!render_pinhole(r, &f->camera, out, err))
        defocus_apply(&r->defocus, out, &f->camera, f->aperture, f->focus, err);
    if (!err->status) {
        photo_exposures_apply(&r->scene->exposures, &r->scene->mesh, &f->camera, out);
        effects_apply(r->effects, f->time, &f->camera, out);
    }
    return err->status;
}

enum status renderer_camera(struct renderer *r, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    const struct hole_photos photos = photos_of(r, camera);
    layer_render(out, r->scene, camera, &r->options, err);
    if (!err->status && r->options.offline)
        exemplar_fill(out, &photos, &r->depth, r->fill_diameter, &r->exemplar, NULL, err);
    if (!err->status) photo_exposures_apply(&r->scene->exposures, &r->scene->mesh, camera, out);
    return err->status;
}

void renderer_release(struct renderer *r)
{
    if (!r) return;
    if (r->fill.path) fill_path_release(&r->fill);
    defocus_release(&r->defocus);
    *r = (struct renderer){0};
}
