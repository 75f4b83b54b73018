/* page_pictures.h - small pictures for the page: upright thumbnails, and depth in colours.
 *
 * 8-bit sRGB, RGB interleaved, row-major. Depth is z along the camera's axis, 0 unknown; colours are linear in 1/z
 * between a near and a far depth, near bright and far dark. */
#ifndef REMODEL_PAGE_PICTURES_H
#define REMODEL_PAGE_PICTURES_H

#include <stdbool.h>

#include "common/image/exr.h"
#include "common/image/photo.h"

struct picture {
    int width, height;
    unsigned char *rgb; /* owned */
};

struct depth_thumb {
    int width, height;
    float *z;     /* owned; samples of single pixels, because a mean across an edge is no depth */
    double known; /* share of the full-size pixels that have a depth */
};

/* Black. */
enum status picture_init(struct picture *p, int width, int height, struct err *err);
void picture_release(struct picture *p);
void page_depth_thumb_release(struct depth_thumb *d);

/* Turns the photo upright and shrinks it to `height` px by box means of linear light; never enlarges it. */
enum status picture_from_photo(struct picture *p, const struct photo *photo, int height, struct err *err);
/* The same for float channels R, G, B (scene-linear, 1 is white). orientation: EXIF's, 1 to 8. ST_DATA: no such
 * channel. */
enum status picture_from_exr(struct picture *p, const struct exr_image *im, int orientation, int height,
                             struct err *err);

/* Size of a thumbnail as stored: `upright` px high once it is turned, never larger than its source. */
void page_thumb_size(int width, int height, int orientation, int upright, int *thumb_width, int *thumb_height);

/* z: width x height in the stored orientation; upright: the maximum height once turned, px. */
enum status page_depth_thumb_make(struct depth_thumb *d, const float *z, int width, int height, int orientation,
                                  int upright, struct err *err);

/* The stored pixel of pixel (x, y) of the upright picture; width x height is the stored size. */
void page_upright_source(int orientation, int width, int height, int x, int y, int *source_x, int *source_y);

/* In colours of colour_of_ramp((1/z - 1/far) / (1/near - 1/far)); unknown pixels are hatched in grey. */
enum status picture_from_depth(struct picture *p, const struct depth_thumb *d, double near, double far,
                               struct err *err);

/* The range of the known depths, without a share of `cut` at either end. False: none is known, or no memory. */
bool page_depth_range(const struct depth_thumb *d, double cut, double *near, double *far);

#endif
