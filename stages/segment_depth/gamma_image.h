/* gamma_image.h - a view as matching and segmentation see it: exposed, gamma-encoded, in planes.
 *
 * value = min(1, sqrt(exposure x linear)). A square root stands for the display curve: it is a pure power, so a change
 * of exposure between two photos stays a factor. */
#ifndef REMODEL_GAMMA_IMAGE_H
#define REMODEL_GAMMA_IMAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/image.h"

struct gamma_image {
    int width, height;
    double exposure;
    float *rgb[3];  /* w * h each, 0 .. 1; owned */
    uint8_t *valid; /* w * h: the photo has a pixel here */
};

/* Factor that brings the 98th percentile of the brightest channel to 0.95; 1 where there is no light. */
double exposure_of(const struct image *linear_rgba);
enum status gamma_image_make(struct gamma_image *g, const struct image *linear_rgba, double exposure, struct err *err);
void gamma_image_release(struct gamma_image *g);

/* Halves the size by averaging 2x2 pixels (an odd last row or column is dropped, but one pixel is kept). */
enum status gamma_image_halve(struct gamma_image *g, struct err *err);

/* Bilinear colour at pixel coordinates (centres at +0.5); false outside the picture or where it is not valid. */
bool gamma_image_at(const struct gamma_image *g, double u, double v, float rgb[3]);

#endif
