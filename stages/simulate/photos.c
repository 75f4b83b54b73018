/* photos.c - see photos.h. */
#include "stages/simulate/photos.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
#include "common/product/product.h"
#include "stages/simulate/sensor.h"

#define FILM_MM 36.0 /* width of the sensor that focal lengths in millimetres refer to */

static char *text_format(struct err *err, const char *fmt, ...) PRINTF_LIKE(2, 3);
static char *text_format(struct err *err, const char *fmt, ...)
{
    char *text = NULL;
    va_list args;
    va_start(args, fmt);
    if (vasprintf(&text, fmt, args) < 0) text = NULL;
    va_end(args);
    if (!text) err_nomem(err, "a file name", strlen(fmt));
    return text;
}

char *photo_file_name(const struct shoot *s, const struct shoot_photo *photo, int exposure)
{
    char *name = NULL;
    const int made = shoot_exposures(s, photo).count > 1 ? asprintf(&name, "%s_e%d.jpg", photo->name, exposure)
                                                         : asprintf(&name, "%s.jpg", photo->name);
    return made < 0 ? NULL : name;
}

static struct photo_info exif_of(const struct shoot_lens *l, const struct shoot_exposure *e)
{
    struct photo_info info = {.orientation = 1, .make = "remodel"};
    info.seconds = e->seconds;
    info.f_number = e->f_number;
    info.iso = e->iso;
    info.focal_mm = l->fx * FILM_MM / l->width;
    /* for pinholes only: programs take it for the focal length of one */
    if (l->kind == SHOOT_PINHOLE) info.focal35_mm = l->fx * hypot(36, 24) / hypot(l->width, l->height);
    snprintf(info.model, sizeof info.model, "%.63s", l->name);
    return info;
}

static enum status write_exposure(const struct picture_job *job, const struct image *radiance,
                                  const struct shoot_photo *photo, int k, struct err *err)
{
    const struct shoot *s = job->shoot;
    const struct shoot_exposure *exposure = &shoot_exposures(s, photo).list[k];
    const struct photo_info info = exif_of(&s->lenses[photo->lens], exposure);
    const size_t bytes = (size_t)radiance->width * (size_t)radiance->height * 3;
    const char *folder = photo->kind == SHOOT_REFERENCE ? "lri" : "photos";
    unsigned char *rgb = malloc(bytes);
    char *file = photo_file_name(s, photo, k);
    char *path = file ? text_format(err, "%s/%s/%s", job->out, folder, file) : NULL;
    if (!rgb || !path) err_nomem(err, "a photo", bytes);
    if (!err->status) {
        const struct rng rng = rng_make(s->sensor.seed, "sensor", file);
        sensor_expose(rgb, radiance, &s->sensor, exposure, &rng);
        photo_write_jpeg(path, rgb, radiance->width, radiance->height, s->quality, &info, err);
    }
    free(path);
    free(file);
    free(rgb);
    return err->status;
}

enum status photo_write_colour(const struct image *radiance, bool half, const char *path, const struct provenance *prov,
                               struct err *err)
{
    static const char *const names[3] = {"R", "G", "B"};
    struct exr_image exr = {0};
    exr_image_init(&exr, radiance->width, radiance->height, err);
    const size_t count = (size_t)radiance->width * (size_t)radiance->height;
    for (int c = 0; !err->status && c < 3; c++) {
        struct exr_plane *plane = NULL;
        exr_add_plane(&exr, names[c], half ? EXR_HALF : EXR_FLOAT, &plane, err);
        for (size_t i = 0; !err->status && i < count; i++) plane->f[i] = radiance->data[3 * i + (size_t)c];
    }
    if (!err->status) exr_write(&exr, path, prov, err);
    exr_image_release(&exr);
    return err->status;
}

static enum status write_surfaces(const struct world *w, const struct camera_view *view, const char *depth_path,
                                  const char *ids_path, const struct provenance *prov, struct err *err)
{
    struct exr_image depth = {0}, ids = {0};
    struct exr_plane *z = NULL, *id = NULL;
    const struct shoot_lens *l = view->lens;
    if (!exr_image_init(&depth, l->width, l->height, err) && !exr_image_init(&ids, l->width, l->height, err) &&
        !exr_add_plane(&depth, "Z", EXR_FLOAT, &z, err) && !exr_add_plane(&ids, "id", EXR_UINT, &id, err))
        exr_set_attribute(&depth, "remodel:depth", l->kind == SHOOT_PINHOLE ? "z" : "ray", err);
    if (!err->status) {
        render_surfaces(z->f, id->u, w, view);
        exr_write(&depth, depth_path, prov, err);
    }
    if (!err->status) exr_write(&ids, ids_path, prov, err);
    exr_image_release(&depth);
    exr_image_release(&ids);
    return err->status;
}

static enum status render(struct image *radiance, const struct world *w, const struct camera_view *view,
                          const char *name, const struct simulate_params *params, struct err *err)
{
    const double started = clock_seconds();
    uint64_t rays = 0;
    render_radiance(radiance, w, view, name, params, &rays, err);
    const double seconds = clock_seconds() - started;
    if (!err->status)
        log_note("%s: %d x %d px in %.1f s, %.2f million rays per second", name, radiance->width, radiance->height,
                 seconds, (double)rays / seconds / 1e6);
    return err->status;
}

/* True radiance with samples of its own has random numbers of its own: the photo's noise is not in it. */
static enum status render_truth(struct image *radiance, const struct picture_job *job, const struct world *w,
                                const struct camera_view *view, const struct shoot_photo *photo, struct err *err)
{
    struct simulate_params params = *job->params;
    if (!params.truth_samples) return render(radiance, w, view, photo->name, &params, err);
    params.samples = params.truth_samples;
    char *name = text_format(err, "%s (truth)", photo->name);
    if (name) render(radiance, w, view, name, &params, err);
    free(name);
    return err->status;
}

/* `radiance` may be NULL: it is rendered. */
static enum status write_truth(const struct picture_job *job, const struct world *w, const struct shoot_photo *photo,
                               const char *folder, const struct image *radiance, struct err *err)
{
    struct image made = {0};
    const struct camera_view view = render_view_make(job->shoot, photo);
    const struct product_key key = {.name = photo->name};
    char truth[FILE_PATH], depth[FILE_PATH], ids[FILE_PATH], hdr[FILE_PATH];
    if (file_path(truth, job->out, folder, "", err) || product_path_in(depth, truth, PRODUCT_TRUE_DEPTH, &key, err) ||
        product_path_in(ids, truth, PRODUCT_TRUE_IDS, &key, err) ||
        product_path_in(hdr, truth, PRODUCT_TRUE_RADIANCE, &key, err))
        return err->status;
    if (!radiance) render_truth(&made, job, w, &view, photo, err);
    if (!err->status && !write_surfaces(w, &view, depth, ids, job->prov, err))
        photo_write_colour(radiance ? radiance : &made, true, hdr, job->prov, err);
    image_release(&made);
    return err->status;
}

enum status photo_make_truth(const struct picture_job *job, const struct world *w, const struct shoot_photo *photo,
                             const char *folder, struct err *err)
{
    return write_truth(job, w, photo, folder, NULL, err);
}

enum status photo_make(const struct picture_job *job, const struct world *w, const struct shoot_photo *photo,
                       struct err *err)
{
    const struct camera_view view = render_view_make(job->shoot, photo);
    const bool truth = photo->kind == SHOOT_PHOTO && !strcmp(job->params->truth, "yes");
    struct image radiance = {0};
    if (photo->kind == SHOOT_WITNESS) return photo_make_truth(job, w, photo, "truth/novel", err);
    if (!render(&radiance, w, &view, photo->name, job->params, err)) render_check_light(&radiance, photo->name, err);
    if (!err->status && truth) write_truth(job, w, photo, "truth", job->params->truth_samples ? NULL : &radiance, err);
    for (int k = 0; !err->status && k < shoot_exposures(job->shoot, photo).count; k++)
        write_exposure(job, &radiance, photo, k, err);
    image_release(&radiance);
    return err->status;
}
