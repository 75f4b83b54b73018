/* gamma_image.h - a view as matching and segmentation see it: exposed, gamma-encoded, in planes.
 *
 * value = min(1, (exposure x linear)^power). The power stands for the display curve, and is lower where a few bright
 * windows would leave all else dark; being a pure power, it keeps a change of exposure between two photos a factor. */
#ifndef REMODEL_GAMMA_IMAGE_H
#define REMODEL_GAMMA_IMAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/image/image.h"

struct tone {
    double exposure, power;
};

struct gamma_image {
    int width, height;
    struct tone tone;
    float *rgb[3];  /* w * h each, 0 .. 1; owned */
    uint8_t *valid; /* w * h: the photo has a pixel here */
};

/* Brings the 98th percentile of the brightest channel to 0.95, and the median to a third or above: by power 1/2, or a lower
 * one, 1/5 at least. Exposure 1 where there is no light. */
struct tone tone_of(const struct image *linear_rgba);
enum status gamma_image_make(struct gamma_image *g, const struct image *linear_rgba, struct tone tone, struct err *err);
void gamma_image_release(struct gamma_image *g);

/* Halves the size by averaging 2x2 pixels (an odd last row or column is dropped, but one pixel is kept). */
enum status gamma_image_halve(struct gamma_image *g, struct err *err);

/* Bilinear colour at pixel coordinates (centres at +0.5); false outside the picture or where it is not valid. */
bool gamma_image_at(const struct gamma_image *g, double u, double v, float rgb[3]);

#endif
