/* gamma_image.h - a view as matching and segmentation see it: exposed, gamma-encoded, one plane per channel. */
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
    uint8_t *valid; /* w * h: 1 where the photo has a pixel; owned */
};

/* The exposure and power that suit a picture (gamma_image.c); exposure 1 if it is black. */
struct tone gamma_tone_of(const struct image *linear_rgba);
/* g is empty after a failure (ST_NOMEM). */
enum status gamma_image_make(struct gamma_image *g, const struct image *linear_rgba, struct tone tone, struct err *err);
void gamma_image_release(struct gamma_image *g);

/* A picture of half the size, by averaging 2x2 pixels. An odd last row or column is dropped, unless it is the only one.
 * half is empty after a failure (ST_NOMEM). */
enum status gamma_image_half(struct gamma_image *half, const struct gamma_image *g, struct err *err);
/* The same, so that it covers all pixels of g: of an odd last row or column, too, and where only some of 2x2 are valid,
 * whose mean it is. */
enum status gamma_image_half_covering(struct gamma_image *half, const struct gamma_image *g, struct err *err);
/* gamma_image_half() in place. */
enum status gamma_image_halve(struct gamma_image *g, struct err *err);

/* Bilinear colour at pixel coordinates (centres at +0.5); false outside the picture or beside an invalid pixel. */
bool gamma_image_at(const struct gamma_image *g, double u, double v, float rgb[3]);

#endif
