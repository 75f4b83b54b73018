/* photos.c - see photos.h. */
#include "stages/simulate/photos.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
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
    enum status st = rgb && path ? ST_OK : err_nomem(err, "a photo", bytes);
    if (!st) {
        const struct rng rng = rng_make(s->sensor.seed, "sensor", file);
        sensor_expose(rgb, radiance, &s->sensor, exposure, &rng);
        st = photo_write_jpeg(path, rgb, radiance->width, radiance->height, s->quality, &info, err);
    }
    free(path);
    free(file);
    free(rgb);
    return st;
}

enum status photo_write_colour(const struct image *radiance, bool half, const char *path, const struct provenance *prov,
                               struct err *err)
{
    static const char *const names[3] = {"R", "G", "B"};
    struct exr_image exr = {0};
    enum status st = exr_image_init(&exr, radiance->width, radiance->height, err);
    const size_t count = (size_t)radiance->width * (size_t)radiance->height;
    for (int c = 0; !st && c < 3; c++) {
        struct exr_plane *plane = NULL;
        st = exr_add_plane(&exr, names[c], half ? EXR_HALF : EXR_FLOAT, &plane, err);
        for (size_t i = 0; !st && i < count; i++) plane->f[i] = radiance->data[3 * i + (size_t)c];
    }
    if (!st) st = exr_write(&exr, path, prov, err);
    exr_image_release(&exr);
    return st;
}

static enum status write_surfaces(const struct world *w, const struct camera_view *view, const char *depth_path,
                                  const char *ids_path, const struct provenance *prov, struct err *err)
{
    struct exr_image depth = {0}, ids = {0};
    struct exr_plane *z = NULL, *id = NULL;
    const struct shoot_lens *l = view->lens;
    enum status st = exr_image_init(&depth, l->width, l->height, err);
    if (!st) st = exr_image_init(&ids, l->width, l->height, err);
    if (!st) st = exr_add_plane(&depth, "Z", EXR_FLOAT, &z, err);
    if (!st) st = exr_add_plane(&ids, "id", EXR_UINT, &id, err);
    if (!st) st = exr_set_attribute(&depth, "remodel:depth", l->kind == SHOOT_PINHOLE ? "z" : "ray", err);
    if (!st) {
        render_surfaces(z->f, id->u, w, view);
        st = exr_write(&depth, depth_path, prov, err);
    }
    if (!st) st = exr_write(&ids, ids_path, prov, err);
    exr_image_release(&depth);
    exr_image_release(&ids);
    return st;
}

static enum status render(struct image *radiance, const struct world *w, const struct camera_view *view,
                          const char *name, const struct simulate_params *params, struct err *err)
{
    const double started = clock_seconds();
    uint64_t rays = 0;
    enum status st = render_radiance(radiance, w, view, name, params, &rays, err);
    const double seconds = clock_seconds() - started;
    if (!st)
        log_note("%s: %d x %d px in %.1f s, %.2f million rays per second", name, radiance->width, radiance->height,
                 seconds, (double)rays / seconds / 1e6);
    return st;
}

/* True radiance with samples of its own has random numbers of its own: the photo's noise is not in it. */
static enum status render_truth(struct image *radiance, const struct picture_job *job, const struct world *w,
                                const struct camera_view *view, const struct shoot_photo *photo, struct err *err)
{
    struct simulate_params params = *job->params;
    if (!params.truth_samples) return render(radiance, w, view, photo->name, &params, err);
    params.samples = params.truth_samples;
    char *name = text_format(err, "%s (truth)", photo->name);
    enum status st = name ? render(radiance, w, view, name, &params, err) : err->status;
    free(name);
    return st;
}

/* `radiance` may be NULL: it is rendered. */
static enum status write_truth(const struct picture_job *job, const struct world *w, const struct shoot_photo *photo,
                               const char *folder, const struct image *radiance, struct err *err)
{
    struct image made = {0};
    const struct camera_view view = render_view_make(job->shoot, photo);
    char *depth = text_format(err, "%s/%s/depth/%s.exr", job->out, folder, photo->name);
    char *ids = text_format(err, "%s/%s/ids/%s.exr", job->out, folder, photo->name);
    char *hdr = text_format(err, "%s/%s/hdr/%s.exr", job->out, folder, photo->name);
    enum status st = depth && ids && hdr ? ST_OK : err->status;
    if (!st && !radiance) st = render_truth(&made, job, w, &view, photo, err);
    if (!st) st = write_surfaces(w, &view, depth, ids, job->prov, err);
    if (!st) st = photo_write_colour(radiance ? radiance : &made, true, hdr, job->prov, err);
    image_release(&made);
    free(depth);
    free(ids);
    free(hdr);
    return st;
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
    enum status st = render(&radiance, w, &view, photo->name, job->params, err);
    if (!st) st = render_check_light(&radiance, photo->name, err);
    if (!st && truth) st = write_truth(job, w, photo, "truth", job->params->truth_samples ? NULL : &radiance, err);
    for (int k = 0; !st && k < shoot_exposures(job->shoot, photo).count; k++)
        st = write_exposure(job, &radiance, photo, k, err);
    image_release(&radiance);
    return st;
}
