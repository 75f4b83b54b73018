/* outdoors.c - see outdoors.h. A look-up by direction is bilinear between pixel centres; columns wrap around at azimuth
 * +-pi, and across a pole a row continues at the azimuth on the other side. */
#include "common/texture/outdoors.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/exr.h"
#include "common/math/numbers.h"

enum { R, G, B, A, SOURCE, PLANES };
static const char *const names[PLANES] = {"R", "G", "B", "A", "source"};

void outdoors_release(struct outdoors *o)
{
    if (!o) return;
    free(o->rgb);
    free(o->source);
    *o = (struct outdoors){0};
}

enum status outdoors_init(struct outdoors *o, int height, struct err *err)
{
    *o = (struct outdoors){0};
    if (height < 1 || height > 1 << 13)
        return err_set(err, ST_DATA, "a picture of the outdoors cannot have %d rows, wanted 1 to %d.", height, 1 << 13);
    const size_t pixels = (size_t)height * (size_t)height * 2;
    o->rgb = calloc(pixels, 3 * sizeof *o->rgb);
    o->source = calloc(pixels, sizeof *o->source);
    if (!o->rgb || !o->source) {
        outdoors_release(o);
        return err_nomem(err, "a picture of the outdoors", pixels * (3 * sizeof *o->rgb + 1));
    }
    o->width = 2 * height;
    o->height = height;
    return ST_OK;
}

struct vec3 outdoors_direction(const struct outdoors *o, double x, double y)
{
    const double azimuth = 2 * PI * x / o->width - PI, elevation = PI / 2 - PI * y / o->height;
    return vec3_make(cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
}

/* --------------------------------------------------------------------------------------------------------- the file */

static enum status check_pixel(const struct exr_plane *const planes[PLANES], size_t i, int width, const char *path,
                               struct err *err)
{
    bool valid = planes[SOURCE]->u[i] <= OUTDOORS_PHOTO;
    for (int c = 0; c < 3; c++) valid &= planes[c]->f[i] >= 0;
    if (valid) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s: pixel (%zu, %zu) has R G B %g %g %g, source %u, wanted radiances of at least 0 and a source "
                   "from 0 to %d; run bake_outdoors again.",
                   path, i % (size_t)width, i / (size_t)width, (double)planes[R]->f[i], (double)planes[G]->f[i],
                   (double)planes[B]->f[i], planes[SOURCE]->u[i], OUTDOORS_PHOTO);
}

static enum status take_planes(struct outdoors *o, const struct exr_image *im, const char *path, struct err *err)
{
    const struct exr_plane *planes[PLANES];
    if (im->width != 2 * im->height)
        return err_set(err, ST_DATA, "%s is %d x %d px, wanted a width of twice the height; run bake_outdoors again.",
                       path, im->width, im->height);
    for (int k = 0; k < PLANES; k++) {
        planes[k] = exr_find(im, names[k]);
        if (k == SOURCE ? !planes[k]->u : !planes[k]->f)
            return err_set(err, ST_DATA, "%s: channel %s has the wrong type; run bake_outdoors again.", path, names[k]);
    }
    outdoors_init(o, im->height, err);
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    for (size_t i = 0; !err->status && i < pixels; i++) {
        check_pixel(planes, i, im->width, path, err);
        for (size_t c = 0; c < 3; c++) o->rgb[3 * i + c] = planes[c]->f[i];
        o->source[i] = (uint8_t)planes[SOURCE]->u[i];
    }
    return err->status;
}

enum status outdoors_read(struct outdoors *o, const char *path, struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    *o = (struct outdoors){0};
    if (!exr_read_product(&im, PRODUCT_OUTDOORS, path, names, PLANES, prov, err)) take_planes(o, &im, path, err);
    if (err->status) outdoors_release(o);
    exr_image_release(&im);
    return err->status;
}

enum status outdoors_write(const struct outdoors *o, const char *path, const struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    const size_t pixels = (size_t)o->width * (size_t)o->height;
    exr_image_init(&im, o->width, o->height, err);
    for (int k = 0; !err->status && k < PLANES; k++) {
        struct exr_plane *plane;
        exr_add_plane(&im, names[k], k == SOURCE ? EXR_UINT : EXR_HALF, &plane, err);
        for (size_t i = 0; !err->status && i < pixels; i++) {
            if (k == SOURCE)
                plane->u[i] = o->source[i];
            else
                plane->f[i] = k == A ? o->source[i] != OUTDOORS_GUESSED : o->rgb[3 * i + (size_t)k];
        }
    }
    if (!err->status) exr_write(&im, path, prov, err);
    exr_image_release(&im);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- look-up */

/* The pixel at column x, any integer from -1 to width, and row y from -1 to height. */
static size_t pixel_at(const struct outdoors *o, int x, int y)
{
    if (y < 0 || y >= o->height) { /* across the pole */
        y = y < 0 ? 0 : o->height - 1;
        x += o->width / 2;
    }
    return (size_t)y * (size_t)o->width + (size_t)((x + o->width) % o->width);
}

struct outdoors_place outdoors_find(const struct outdoors *o, struct vec3 direction)
{
    struct outdoors_place place;
    const double azimuth = atan2(direction.y, direction.x);
    const double elevation = atan2(direction.z, hypot(direction.x, direction.y));
    const double u = clamp((azimuth + PI) / (2 * PI), 0, 1) * o->width - 0.5;
    const double v = clamp((PI / 2 - elevation) / PI, 0, 1) * o->height - 0.5;
    const int x = (int)floor(u), y = (int)floor(v);
    place.right = (float)(u - x);
    place.bottom = (float)(v - y);
    for (int k = 0; k < 4; k++) {
        place.pixels[k] = pixel_at(o, x + (k & 1), y + (k >> 1));
        __builtin_prefetch(o->rgb + 3 * place.pixels[k]);
    }
    __builtin_prefetch(o->source + place.pixels[0]);
    return place;
}

enum outdoors_source outdoors_look(float rgb[3], const struct outdoors *o, const struct outdoors_place *place)
{
    const float fx = place->right, fy = place->bottom;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < 4; k++) {
        const float weight = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        const float *p = o->rgb + 3 * place->pixels[k];
        for (int c = 0; c < 3; c++) rgb[c] += weight * p[c];
    }
    return o->source[place->pixels[(fx >= 0.5f) + 2 * (fy >= 0.5f)]];
}

enum outdoors_source outdoors_sample(float rgb[3], const struct outdoors *o, struct vec3 direction)
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (!o->rgb) return OUTDOORS_GUESSED;
    const struct outdoors_place place = outdoors_find(o, direction);
    return outdoors_look(rgb, o, &place);
}
