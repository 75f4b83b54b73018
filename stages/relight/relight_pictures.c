/* relight_pictures.c - reads what all pictures share, then relights one after another; see relight.h. */
#include <stdio.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/product/product.h"
#include "common/texture/exposure.h"
#include "common/texture/picture_list.h"
#include "common/texture/picture_record.h"
#include "stages/relight/integrals.h"
#include "stages/relight/relight.h"
#include "stages/relight/relit_files.h"

enum { LAMP_RAYS = 64 };

struct session {
    struct relight_job *job;
    struct light_change change;
    struct camera_set set;
    char vita[FILE_PATH], objects[FILE_PATH];
};

static enum status open_session(struct session *s, struct err *err)
{
    struct relight_job *j = s->job;
    if (!file_path(s->vita, j->relit, "vita", "", err))
        product_path_in(s->objects, j->relit, PRODUCT_OBJECT_LIGHT, NULL, err);
    j->files.edited_vita = s->vita;
    j->files.object_light = s->objects;
    if (!err->status) light_change_read(&s->change, &j->files, &j->prov, err);
    if (!err->status && j->views) camera_set_read_cameras(&s->set, j->views, &j->prov, err);
    if (!err->status && j->materials)
        model_field_read_materials(&s->change.before, j->materials, j->views, &s->change.axes, &j->prov, err);
    return err->status;
}

/* The camera in the scene's frame, for the attributes of EXR files. */
static struct view scene_view(const struct model_picture *p, const struct model_axes *axes, const char *name)
{
    struct view v = {.name = name, .width = p->width, .height = p->height};
    camera_focal(&p->lens, &v.fx, &v.fy, &v.cx, &v.cy);
    v.cam_from_world = mat3_multiply(mat3_from_quat(p->pose.rotation), mat3_from_quat(axes->rotation));
    v.center = world_from_model_point(axes, pose_center(&p->pose));
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

/* Reads a picture and its exposure. */
static enum status read_picture(struct model_picture *p, double *exposure, struct relight_job *j, const char *name,
                                struct err *err)
{
    const struct product_key key = {.name = name};
    char path[FILE_PATH];
    struct picture_record record;
    if (!product_path_in(path, j->pictures, PRODUCT_PICTURE_RECORD, &key, err) &&
        !picture_record_read(&record, path, &j->prov, err) &&
        !product_path_in(path, j->pictures, PRODUCT_PICTURE, &key, err))
        model_picture_read(p, path, &j->prov, err);
    if (!err->status && !p->has_camera)
        err_set(err, ST_DATA, "%s does not say which camera drew it; draw it again with this version.", path);
    if (!err->status) *exposure = record.exposure;
    return err->status;
}

/* Where an object covers a pixel, the lamps light the object. */
static enum status write_integrals(struct session *s, const struct relit *r, struct pixels *p,
                                   const struct view *camera, struct err *err)
{
    struct relight_job *j = s->job;
    char path[FILE_PATH];
    struct lamp_light lamps = {0};
    for (int k = 0; k < p->object_count; k++)
        if (p->objects[k].cover >= 0.5f) p->after[p->objects[k].pixel] = p->objects[k].point;
    lamp_light_gather(&lamps, p, &s->change, LAMP_RAYS, err);
    if (!err->status)
        product_path_in(path, j->out, PRODUCT_RELIT_INTEGRALS, &(struct product_key){.name = camera->name}, err);
    if (!err->status) integrals_write(r, p, &s->change, &lamps, camera, path, &j->prov, err);
    lamp_light_release(&lamps);
    return err->status;
}

static enum status write_frame(struct relight_job *j, const struct model_picture *picture, double exposure,
                               const struct view *camera, struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, j->out, PRODUCT_RELIT, &(struct product_key){.name = camera->name}, err))
        return err->status;
    return exposure_write_frame(picture, exposure, camera, path, &j->prov, err);
}

static enum status relight_one(struct session *s, const char *name, struct err *err)
{
    struct relight_job *j = s->job;
    struct model_picture picture = {0};
    struct pixels pixels = {0};
    struct relit relit = {0};
    double exposure = 1;
    read_picture(&picture, &exposure, j, name, err);
    const int view = j->views ? camera_set_find(&s->set, name) : -1;
    const struct pixel_layers layers = {j->ids, j->depth, view < 0 ? NULL : &s->set.views[view]};
    const bool is_own = view >= 0 && j->ids && j->depth;
    if (!err->status && !pixels_find(&pixels, &s->change, &picture, is_own ? &layers : NULL, &j->prov, err))
        relit_make(&relit, &picture, &pixels, &s->change, &j->params, err);
    if (!err->status) {
        const struct view camera = scene_view(&picture, &s->change.axes, name);
        if (j->frames)
            write_frame(j, &picture, exposure, &camera, err);
        else if (!strcmp(j->params.integrals, "yes"))
            write_integrals(s, &relit, &pixels, &camera, err);
        if (!err->status && pixels.is_black) log_note("%s: all but nothing is drawn; nothing is relit", name);
        if (!err->status && relit.penumbra.fitted)
            log_note("%s: old light's edges are fitted at %d of %d places, by %.1f px", name, relit.penumbra.fitted,
                     relit.penumbra.points, relit.penumbra.shift);
        if (!err->status && !j->frames)
            relit_write(&relit, &picture, &j->params, exposure, &camera, j->out, name, &j->prov, err);
    }
    relit_release(&relit);
    pixels_release(&pixels);
    model_picture_release(&picture);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- changes */

/* A picture with changed materials and lamps, from its integrals. */
static enum status change_one(struct relight_job *j, const char *name, struct err *err)
{
    char path[FILE_PATH];
    struct model_picture picture = {0};
    struct exr_image integrals = {0};
    double exposure = 1;
    const struct product_key key = {.name = name};
    if (!product_path_in(path, j->from, PRODUCT_RELIT_RECORD, &key, err) &&
        !relit_read_exposure(&exposure, path, &j->prov, err) &&
        !product_path_in(path, j->from, PRODUCT_RELIT, &key, err))
        model_picture_read(&picture, path, &j->prov, err);
    if (!err->status && !product_path_in(path, j->from, PRODUCT_RELIT_INTEGRALS, &key, err) &&
        !exr_read_product(&integrals, PRODUCT_RELIT_INTEGRALS, path, NULL, 0, &j->prov, err) &&
        !integrals_change(&picture, &integrals, j->changes, err))
        relit_changed_write(&picture, j->params.exposure > 0 ? j->params.exposure : exposure, j->out, name, &j->prov,
                            err);
    exr_image_release(&integrals);
    model_picture_release(&picture);
    return err->status;
}

static enum status change_all(struct relight_job *j, const struct cli_list *names, struct err *err)
{
    provenance_add_file(&j->prov, "changes", j->changes, err);
    const int inputs = j->prov.count;
    for (int i = 0; !err->status && i < names->count; i++) {
        change_one(j, names->items[i], err);
        provenance_keep(&j->prov, inputs);
    }
    return err->status;
}

enum status relight(struct relight_job *j, struct err *err)
{
    struct session s = {.job = j};
    struct picture_list names = {0};
    if (j->changes) return change_all(j, &j->names, err);
    if (j->list) picture_list_read(&names, j->pictures, NULL, err);
    for (int i = 0; !err->status && i < j->names.count; i++) picture_list_add(&names, j->names.items[i], err);
    if (!err->status) open_session(&s, err);
    const int inputs = j->prov.count;
    for (int i = 0; !err->status && i < names.count; i++) {
        relight_one(&s, names.names[i], err);
        provenance_keep(&j->prov, inputs);
        if (!err->status) log_note("relit %d of %d: %s", i + 1, names.count, names.names[i]);
    }
    if (!err->status && j->list) picture_list_write(&names, j->out, &j->prov, err);
    picture_list_release(&names);
    camera_set_release(&s.set);
    light_change_release(&s.change);
    return err->status;
}
