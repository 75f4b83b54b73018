/* image.h - float images in memory.
 *
 * Row-major, channels interleaved: data[(y * width + x) * channels + c]. The centre of pixel (x, y) is at (x + 0.5, y +
 * 0.5). Colour is scene-linear with Rec.709 primaries unless a function says otherwise. */
#ifndef REMODEL_IMAGE_H
#define REMODEL_IMAGE_H

#include <stddef.h>

#include "common/base/err.h"

struct image {
    int width, height, channels;
    float *data; /* owned, 64-byte aligned, zeroed by image_init */
};

/* Allocates a zeroed image. {0} is the empty state. ST_DATA: a dimension below 1, or more than 2^31 samples;
 * ST_NOMEM. */
enum status image_init(struct image *im, int width, int height, int channels, struct err *err);
void image_release(struct image *im);

static inline float *image_at(const struct image *im, int x, int y)
{
    return im->data + ((size_t)y * (size_t)im->width + (size_t)x) * (size_t)im->channels;
}

float srgb_from_linear(float linear); /* IEC 61966-2-1; clamped to [0, 1]; 0 for NaN */
float linear_from_srgb(float srgb);   /* in [0, 1] */

/* Converts linear to 8-bit sRGB of 3 channels, 3 * w * h bytes. A fourth channel is ignored; a single one is
 * repeated. */
void image_to_srgb8(const struct image *im, unsigned char *out);

#endif
