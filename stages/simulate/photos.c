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
    const int made = shoot_exposures(s, photo)->count > 1 ? asprintf(&name, "%s_e%d.jpg", photo->name, exposure)
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

static enum status write_exposure(const struct image *radiance, const struct shoot *s, const struct shoot_photo *photo,
                                  int k, const char *out, struct err *err)
{
    const struct photo_info info = exif_of(&s->lenses[photo->lens], &shoot_exposures(s, photo)->list[k]);
    const size_t bytes = (size_t)radiance->width * (size_t)radiance->height * 3;
    unsigned char *rgb = malloc(bytes);
    char *file = photo_file_name(s, photo, k);
    char *path = file ? text_format(err, "%s/%s/%s", out, photo->reference ? "lri" : "photos", file) : NULL;
    enum status st = rgb && path ? ST_OK : err_nomem(err, "a photo", bytes);
    if (!st) {
        const struct rng rng = rng_make(s->sensor.seed, "sensor", file);
        sensor_expose(rgb, radiance, &s->sensor, &shoot_exposures(s, photo)->list[k], &rng);
        st = photo_write_jpeg(path, rgb, radiance->width, radiance->height, s->quality, &info, err);
    }
    free(path);
    free(file);
    free(rgb);
    return st;
}

static enum status write_radiance(const struct image *radiance, const char *path, const struct provenance *prov,
                                  struct err *err)
{
    static const char *const names[3] = {"R", "G", "B"};
    struct exr_image exr = {0};
    enum status st = exr_image_init(&exr, radiance->width, radiance->height, err);
    const size_t count = (size_t)radiance->width * (size_t)radiance->height;
    for (int c = 0; !st && c < 3; c++) {
        struct exr_plane *plane = NULL;
        st = exr_add_plane(&exr, names[c], EXR_HALF, &plane, err);
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
                          const struct shoot_photo *photo, const struct simulate_params *params, struct err *err)
{
    const double started = clock_seconds();
    uint64_t rays = 0;
    enum status st = render_radiance(radiance, w, view, photo->name, params, &rays, err);
    const double seconds = clock_seconds() - started;
    if (!st)
        log_note("%s: %d x %d px in %.1f s, %.2f million rays per second", photo->name, radiance->width,
                 radiance->height, seconds, (double)rays / seconds / 1e6);
    return st;
}

enum status photo_make(const struct world *w, const struct shoot *s, const struct shoot_photo *photo, const char *out,
                       const struct simulate_params *params, const struct provenance *prov, struct err *err)
{
    struct image radiance = {0};
    const struct camera_view view = camera_view_make(s, photo);
    char *depth = text_format(err, "%s/truth/depth/%s.exr", out, photo->name);
    char *ids = text_format(err, "%s/truth/ids/%s.exr", out, photo->name);
    char *hdr = text_format(err, "%s/truth/hdr/%s.exr", out, photo->name);
    enum status st = depth && ids && hdr ? ST_OK : err->status;
    const bool truth = !photo->reference && !strcmp(params->truth, "yes");
    if (!st) st = render(&radiance, w, &view, photo, params, err);
    if (!st && truth) st = write_surfaces(w, &view, depth, ids, prov, err);
    if (!st && truth) st = write_radiance(&radiance, hdr, prov, err);
    for (int k = 0; !st && k < shoot_exposures(s, photo)->count; k++)
        st = write_exposure(&radiance, s, photo, k, out, err);
    image_release(&radiance);
    free(depth);
    free(ids);
    free(hdr);
    return st;
}

enum status photo_make_edited(const struct world *w, const struct shoot *s, const struct shoot_photo *photo,
                              const char *out, const char *edit, const struct simulate_params *params,
                              const struct provenance *prov, struct err *err)
{
    struct image radiance = {0};
    const struct camera_view view = camera_view_make(s, photo);
    char *path = text_format(err, "%s/truth/edited-%s/hdr/%s.exr", out, edit, photo->name);
    enum status st = path ? render(&radiance, w, &view, photo, params, err) : err->status;
    if (!st) st = write_radiance(&radiance, path, prov, err);
    image_release(&radiance);
    free(path);
    return st;
}
