/* image.h - a float picture in memory.
 *
 * Row-major, channels interleaved: data[(y * width + x) * channels + c]. Pixel (x, y) has its centre at (x + 0.5,
 * y + 0.5). Colour is scene-linear, Rec.709 primaries, unless a function says otherwise. */
#ifndef REMODEL_IMAGE_H
#define REMODEL_IMAGE_H

#include <stddef.h>

#include "common/base/err.h"

struct image {
    int width, height, channels;
    float *data; /* owned, 64-byte aligned, zeroed by image_init */
};

/* {0} is the empty state. ST_NOMEM, or ST_DATA for sizes below 1 or above 2^31 samples. */
enum status image_init(struct image *im, int width, int height, int channels, struct err *err);
void image_release(struct image *im);

static inline float *image_at(const struct image *im, int x, int y)
{
    return im->data + ((size_t)y * (size_t)im->width + (size_t)x) * (size_t)im->channels;
}

float srgb_from_linear(float linear); /* IEC 61966-2-1; clamps to [0, 1]; NaN gives 0 */
float linear_from_srgb(float srgb);   /* in [0, 1] */

/* 8-bit sRGB from linear, 3 channels (further channels are ignored, 1 channel is repeated). out: 3 * w * h bytes. */
void image_to_srgb8(const struct image *im, unsigned char *out);

#endif
