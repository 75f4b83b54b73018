/* evaluate_heldout_textures.c - held-out photographs, predicted from the textures of the others: texture.heldout_psnr,
 * texture.vita.heldout_psnr.
 *
 * A ray through each pixel of a held-out view finds a face of the model, without its glass. The pixel's colour is that
 * of the nearest viewpoint's atlas, or of the VITA where that atlas has none; for texture.vita always of the VITA. */
#include "stages/evaluate/texture/texture_metrics.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "stages/evaluate/measure/metrics.h"
#include "stages/evaluate/texture/loaded_atlas.h"

enum { ROWS = 4 };

struct heldout_job {
    struct textures textures;
    struct model_rays model;
    struct model_axes axes;
    struct loaded_atlas vita;
    struct vec3 *centres; /* of the viewpoints, in the model's frame */
    int pictures;
    double psnr[2], filled[2]; /* sums over pictures: of the nearest viewpoint, of the VITA alone */
};

static const char *const prefixes[2] = {"texture", "texture.vita"};

/* ------------------------------------------------------------------------------------------------------ one picture */

struct predict_job {
    const struct solid_mesh *mesh;
    const struct view *view;               /* in the model's frame */
    const uint32_t *faces;                 /* 1 + the index of the face at each pixel; 0: none */
    const struct loaded_atlas *atlases[2]; /* tried in this order; NULL: none */
    struct image *out;                     /* 3 channels */
    uint8_t *predicted;                    /* a pixel each: 1 where an atlas has a colour */
};

static void predict_pixel(const struct predict_job *job, size_t at)
{
    const struct solid_face *f = &job->mesh->faces[job->faces[at] - 1];
    const int id = solid_face_id(job->mesh, (int)job->faces[at] - 1);
    const double x = (double)(at % (size_t)job->view->width) + 0.5, y = (double)(at / (size_t)job->view->width) + 0.5;
    const struct vec3 from = job->view->center, ray = vec3_sub(view_unproject(job->view, x, y, 1), from);
    const struct vec3 p =
        vec3_add(from, vec3_scale(ray, (f->offset - vec3_dot(f->normal, from)) / vec3_dot(f->normal, ray)));
    for (int k = 0; k < 2 && !job->predicted[at]; k++)
        job->predicted[at] = job->atlases[k] && loaded_atlas_look_up(job->out->data + 3 * at, job->atlases[k], id, p);
}

static void predict_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct predict_job *job = ctx;
    const size_t width = (size_t)job->view->width;
    (void)thread;
    for (size_t i = begin * width; i < end * width; i++)
        if (job->faces[i]) predict_pixel(job, i);
}

/* Predicts a view and compares it with its photograph. *found: some pixel shows the model. */
static enum status predict(struct predict_job *job, const struct linear_picture *photo, bool *found, double *psnr,
                           double *filled, struct err *err)
{
    const int width = job->view->width, height = job->view->height;
    const size_t pixels = (size_t)width * (size_t)height;
    struct image out = {0};
    uint8_t *bytes = calloc(8 * pixels, 1), *mask = bytes + 7 * pixels;
    size_t counted = 0, predicted = 0;
    if (!bytes) return err_nomem(err, "pictures", 8 * pixels);
    job->out = &out;
    job->predicted = bytes + 6 * pixels;
    if (!image_init(&out, width, height, 3, err)) parallel_for((size_t)height, ROWS, predict_rows, job);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        mask[i] = photo->known[i] && job->faces[i];
        counted += mask[i];
        predicted += mask[i] && job->predicted[i];
    }
    *found = counted > 0;
    if (!err->status && *found) {
        image_to_srgb8(&photo->rgb, bytes);
        image_to_srgb8(&out, bytes + 3 * pixels);
        *filled = 100 * (double)predicted / (double)counted;
        metrics_psnr(bytes, bytes + 3 * pixels, width, height, mask, psnr, err);
    }
    image_release(&out);
    free(bytes);
    return err->status;
}

static int nearest_viewpoint(const struct heldout_job *job, struct vec3 centre)
{
    int best = -1;
    double least = INFINITY;
    for (int i = 0; i < job->textures.viewpoint_count; i++) {
        const double d = vec3_length(vec3_sub(job->centres[i], centre));
        if (d < least) best = i, least = d;
    }
    return best;
}

/* Which predictions there are: 0, of the nearest viewpoint; 1, of the VITA. */
static int first_kind(const struct heldout_job *job) { return job->textures.viewpoint_count ? 0 : 1; }
static int kinds(const struct heldout_job *job) { return job->textures.vita ? 2 : 1; }

/* The photograph of a held-out view. */
static enum status read_photo(struct linear_picture *photo, struct evaluation *e, const struct view *view,
                              struct err *err)
{
    char path[FILE_PATH];
    if (!evaluation_path(path, e, PRODUCT_VIEW, &(struct product_key){.view = view->name, .views = "holdout/views"},
                         err) &&
        !provenance_add_file(e->prov, product_name(PRODUCT_VIEW, path), path, err))
        linear_picture_read(photo, path, err);
    if (!err->status && (photo->rgb.width != view->width || photo->rgb.height != view->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its camera %d x %d; make it again.", path, photo->rgb.width,
                photo->rgb.height, view->width, view->height);
    return err->status;
}

static enum status add_predictions(struct heldout_job *job, struct evaluation *e, const struct view *view,
                                   const struct linear_picture *photo, const struct loaded_atlas *nearest,
                                   struct err *err)
{
    const struct view inside = model_from_world_view(&job->axes, view);
    uint32_t *faces = malloc((size_t)view->width * (size_t)view->height * sizeof *faces);
    bool found = false;
    if (!faces) err_nomem(err, "faces", (size_t)view->width * (size_t)view->height);
    if (!err->status) model_rays_view(faces, &job->model, &inside);
    for (int k = first_kind(job); !err->status && k < kinds(job); k++) {
        struct predict_job one = {&job->model.mesh,
                                  &inside,
                                  faces,
                                  {k == 0 ? nearest : NULL, job->textures.vita ? &job->vita : NULL},
                                  NULL,
                                  NULL};
        double psnr = 0, filled = 0;
        if (predict(&one, photo, &found, &psnr, &filled, err) || !found) break;
        job->psnr[k] += psnr;
        job->filled[k] += filled;
        evaluation_metric(e, view->name, prefixes[k], "heldout_psnr", psnr, err);
    }
    job->pictures += !err->status && found;
    if (!err->status && !found)
        metric_note(&e->table, err, "skipped the textures of %s: it does not see the model", view->name);
    free(faces);
    return err->status;
}

static enum status add_picture(struct heldout_job *job, struct evaluation *e, const struct view *view, struct err *err)
{
    struct linear_picture photo = {0};
    struct loaded_atlas nearest = {0};
    const int viewpoint = nearest_viewpoint(job, model_from_world_view(&job->axes, view).center);
    read_photo(&photo, e, view, err);
    if (!err->status && viewpoint >= 0) loaded_atlas_read(&nearest, e, job->textures.viewpoints[viewpoint], err);
    if (!err->status) add_predictions(job, e, view, &photo, viewpoint < 0 ? NULL : &nearest, err);
    loaded_atlas_release(&nearest);
    linear_picture_release(&photo);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------- the scene */

static enum status prepare(struct heldout_job *job, struct evaluation *e, struct err *err)
{
    char path[FILE_PATH];
    job->centres = malloc(((size_t)job->textures.viewpoint_count + 1) * sizeof *job->centres);
    if (!job->centres) return err_nomem(err, "viewpoints", (size_t)job->textures.viewpoint_count);
    if (!evaluation_path(path, e, PRODUCT_AXES, NULL, err) && !model_axes_read(&job->axes, path, e->prov, err) &&
        !evaluation_path(path, e, PRODUCT_MODEL, NULL, err))
        model_rays_read(&job->model, path, MODEL_WITHOUT_GLASS, e->prov, err);
    if (!err->status && job->textures.vita) loaded_atlas_read(&job->vita, e, NULL, err);
    for (int i = 0; !err->status && i < job->textures.viewpoint_count; i++) {
        struct atlas a = {0};
        textures_read(&a, e, job->textures.viewpoints[i], err);
        job->centres[i] = a.centre;
        atlas_release(&a);
    }
    return err->status;
}

static enum status add_means(struct evaluation *e, const struct heldout_job *job, struct err *err)
{
    const int n = job->pictures;
    if (!n) return metric_note(&e->table, err, "skipped textures of held-out photos: none sees the model");
    for (int k = first_kind(job); k < kinds(job); k++)
        if (evaluation_metric(e, NULL, prefixes[k], "heldout_psnr", job->psnr[k] / n, err) ||
            evaluation_metric(e, NULL, prefixes[k], "heldout_filled", job->filled[k] / n, err))
            return err->status;
    return ST_OK;
}

enum status evaluate_heldout_textures(struct evaluation *e, struct err *err)
{
    struct heldout_job job = {0};
    textures_find(&job.textures, e, err);
    const bool some = !err->status && (job.textures.vita || job.textures.viewpoint_count);
    if (some) prepare(&job, e, err);
    for (int i = 0; !err->status && some && i < e->held.cameras.view_count; i++)
        add_picture(&job, e, &e->held.cameras.views[i], err);
    if (!err->status && some) add_means(e, &job, err);
    model_rays_release(&job.model);
    loaded_atlas_release(&job.vita);
    free(job.centres);
    textures_release(&job.textures);
    return err->status;
}
