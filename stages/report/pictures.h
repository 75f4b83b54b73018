/* pictures.h - small pictures for the page: thumbnails, turned upright, and colour-mapped depth.
 *
 * 8-bit sRGB, RGB interleaved, row-major. Depth is z along the camera's axis, 0 unknown; it is shown by 1/z between two
 * stated depths, near bright and far dark. */
#ifndef REMODEL_PICTURES_H
#define REMODEL_PICTURES_H

#include <stdbool.h>

#include "common/image/exr.h"
#include "common/image/photo.h"

struct picture {
    int width, height;
    unsigned char *rgb; /* owned */
};

struct depth_thumb {
    int width, height;
    float *z;     /* owned; the nearest pixel's, never a mean over an edge */
    double known; /* share of the full-size pixels that have a depth */
};

void picture_release(struct picture *p);
void depth_thumb_release(struct depth_thumb *d);

/* Shrinks by box means of linear light to `height` px once it is turned upright (never enlarges), and turns it. */
enum status picture_from_photo(struct picture *p, const struct photo *photo, int height, struct err *err);
/* The same for planes R, G, B (scene-linear, 1 is white). orientation as EXIF's. */
enum status picture_from_exr(struct picture *p, const struct exr_image *im, int orientation, int height,
                             struct err *err);

enum status depth_thumb_make(struct depth_thumb *d, const float *z, int width, int height, int orientation, int upright,
                             struct err *err);

/* A pixel of the upright picture of a stored one of width x height: where it is in the stored rows. */
void upright_source(int orientation, int width, int height, int x, int y, int *source_x, int *source_y);

/* 0 far .. 1 near; lightness grows strictly. */
void depth_colour(double t, unsigned char rgb[3]);

/* Colours by (1/z - 1/far) / (1/near - 1/far), clamped; unknown is hatched in greys. */
enum status picture_from_depth(struct picture *p, const struct depth_thumb *d, double near, double far,
                               struct err *err);

/* The depths that bound a share of 1 - 2 * cut of the known pixels. False if none is known, or there is no memory. */
bool depth_range(const struct depth_thumb *d, double cut, double *near, double *far);

#endif
