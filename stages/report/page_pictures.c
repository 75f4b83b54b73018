/* page_pictures.c - see page_pictures.h. */
#include "stages/report/page_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/image/false_colour.h"

enum status picture_init(struct picture *p, int width, int height, struct err *err)
{
    const size_t bytes = (size_t)width * (size_t)height * 3;
    *p = (struct picture){width, height, calloc(bytes, 1)};
    return p->rgb ? ST_OK : err_nomem(err, "a thumbnail", bytes);
}

void picture_release(struct picture *p)
{
    free(p->rgb);
    *p = (struct picture){0};
}

void page_depth_thumb_release(struct depth_thumb *d)
{
    free(d->z);
    *d = (struct depth_thumb){0};
}

void page_upright_source(int orientation, int width, int height, int x, int y, int *source_x, int *source_y)
{
    int right = width - 1, bottom = height - 1;
    switch (orientation) {
    case 2:
        *source_x = right - x, *source_y = y;
        break;
    case 3:
        *source_x = right - x, *source_y = bottom - y;
        break;
    case 4:
        *source_x = x, *source_y = bottom - y;
        break;
    case 5:
        *source_x = y, *source_y = x;
        break;
    case 6:
        *source_x = y, *source_y = bottom - x;
        break;
    case 7:
        *source_x = right - y, *source_y = bottom - x;
        break;
    case 8:
        *source_x = right - y, *source_y = x;
        break;
    default:
        *source_x = x, *source_y = y;
    }
}

void page_thumb_size(int width, int height, int orientation, int upright, int *thumb_width, int *thumb_height)
{
    int side = orientation >= 5 ? width : height; /* the upright height */
    double scale = side > upright ? (double)upright / side : 1;
    *thumb_width = (int)fmax(1, floor(width * scale + 0.5));
    *thumb_height = (int)fmax(1, floor(height * scale + 0.5));
}

/* Samples to look up in a table, or interleaved or in planes linear light. */
struct source {
    int width, height, orientation;
    const uint16_t *samples; /* interleaved; indices into `linear`; NULL: `linear` is the picture */
    const float *linear;
    const float *planes[3];
};

static void box_mean(const struct source *s, int x0, int x1, int y0, int y1, unsigned char rgb[3])
{
    double sum[3] = {0};
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            size_t at = (size_t)y * (size_t)s->width + (size_t)x;
            for (int c = 0; c < 3; c++)
                sum[c] += s->samples  ? s->linear[s->samples[3 * at + (size_t)c]]
                          : s->linear ? s->linear[3 * at + (size_t)c]
                                      : s->planes[c][at];
        }
    double area = (double)(x1 - x0) * (y1 - y0);
    for (int c = 0; c < 3; c++) rgb[c] = (unsigned char)(255 * srgb_from_linear((float)(sum[c] / area)) + 0.5f);
}

static enum status shrink(struct picture *p, const struct source *s, int upright, struct err *err)
{
    int w, h;
    page_thumb_size(s->width, s->height, s->orientation, upright, &w, &h);
    if (picture_init(p, s->orientation >= 5 ? h : w, s->orientation >= 5 ? w : h, err)) return err->status;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            int tx, ty;
            page_upright_source(s->orientation, w, h, x, y, &tx, &ty);
            int64_t x0 = (int64_t)tx * s->width / w, x1 = ((int64_t)tx + 1) * s->width / w;
            int64_t y0 = (int64_t)ty * s->height / h, y1 = ((int64_t)ty + 1) * s->height / h;
            box_mean(s, (int)x0, (int)x1, (int)y0, (int)y1, p->rgb + 3 * ((size_t)y * (size_t)p->width + (size_t)x));
        }
    return ST_OK;
}

/* Of a photo in another space than sRGB. */
static enum status picture_from_spaced(struct picture *p, const struct photo *photo, int height, struct err *err)
{
    struct image linear = {0};
    struct source s = {photo->info.width, photo->info.height, photo->info.orientation, NULL, NULL, {NULL}};
    if (!photo_to_linear(&linear, photo, err)) {
        s.linear = linear.data;
        shrink(p, &s, height, err);
    }
    image_release(&linear);
    return err->status;
}

enum status picture_from_photo(struct picture *p, const struct photo *photo, int height, struct err *err)
{
    if (photo->space) return picture_from_spaced(p, photo, height, err);
    int levels = photo->info.bits == 16 ? 65536 : 256;
    float *linear = malloc((size_t)levels * sizeof *linear);
    if (!linear) return err_nomem(err, "an sRGB table", (size_t)levels * sizeof *linear);
    for (int i = 0; i < levels; i++) linear[i] = linear_from_srgb((float)i / (float)(levels - 1));
    struct source s = {photo->info.width, photo->info.height, photo->info.orientation, photo->samples, linear, {NULL}};
    shrink(p, &s, height, err);
    free(linear);
    return err->status;
}

enum status picture_from_exr(struct picture *p, const struct exr_image *im, int orientation, int height,
                             struct err *err)
{
    static const char *const NAMES[3] = {"R", "G", "B"};
    struct source s = {im->width, im->height, orientation, NULL, NULL, {NULL}};
    for (int c = 0; c < 3; c++) {
        const struct exr_plane *plane = exr_find(im, NAMES[c]);
        if (!plane || !plane->f) return err_set(err, ST_DATA, "the picture has no float channel %s.", NAMES[c]);
        s.planes[c] = plane->f;
    }
    return shrink(p, &s, height, err);
}

enum status page_depth_thumb_make(struct depth_thumb *d, const float *z, int width, int height, int orientation,
                                  int upright, struct err *err)
{
    size_t known = 0, size = (size_t)width * (size_t)height;
    int w, h;
    page_thumb_size(width, height, orientation, upright, &w, &h);
    *d = (struct depth_thumb){orientation >= 5 ? h : w, orientation >= 5 ? w : h,
                              malloc((size_t)w * (size_t)h * sizeof *z), 0};
    if (!d->z) return err_nomem(err, "a depth thumbnail", (size_t)w * (size_t)h * sizeof *z);
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++) {
            int tx, ty;
            page_upright_source(orientation, w, h, x, y, &tx, &ty);
            int64_t sx = (2 * (int64_t)tx + 1) * width / (2 * w), sy = (2 * (int64_t)ty + 1) * height / (2 * h);
            d->z[(size_t)y * (size_t)d->width + (size_t)x] = z[(size_t)sy * (size_t)width + (size_t)sx];
        }
    for (size_t i = 0; i < size; i++) known += z[i] > 0;
    d->known = (double)known / (double)size;
    return ST_OK;
}

enum status picture_from_depth(struct picture *p, const struct depth_thumb *d, double near, double far, struct err *err)
{
    if (picture_init(p, d->width, d->height, err)) return err->status;
    double low = 1 / far, span = 1 / near - low;
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++) {
            size_t at = (size_t)y * (size_t)d->width + (size_t)x;
            if (d->z[at] > 0)
                colour_of_ramp(span > 0 ? (1 / (double)d->z[at] - low) / span : 0.5, p->rgb + 3 * at);
            else
                memset(p->rgb + 3 * at, (x + y) % 8 < 3 ? 120 : 165, 3);
        }
    return ST_OK;
}

bool page_depth_range(const struct depth_thumb *d, double cut, double *near, double *far)
{
    size_t size = (size_t)d->width * (size_t)d->height, n = 0;
    float *known = malloc((size + 1) * sizeof *known);
    if (!known) return false;
    for (size_t i = 0; i < size; i++)
        if (d->z[i] > 0) known[n++] = d->z[i];
    if (n) {
        sort_floats(known, n);
        *near = known[(size_t)(cut * (double)(n - 1))];
        *far = known[(size_t)((1 - cut) * (double)(n - 1))];
    }
    free(known);
    return n > 0;
}
