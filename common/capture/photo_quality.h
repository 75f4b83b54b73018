/* photo_quality.h - how well the radiance of a photograph, or of a view, is known at each pixel.
 *
 * variance: of the noise of the Rec.709 luminance, in the square of the picture's unit. It is at most the square of the
 * luminance, which it also is where a colour saturates: nothing is then known of the radiance but a lower bound. Noise
 * of different pixels of a photo counts as independent. */
#ifndef REMODEL_PHOTO_QUALITY_H
#define REMODEL_PHOTO_QUALITY_H

#include <stdint.h>

#include "common/image/exr.h"
#include "common/image/image.h"
#include "common/image/photo.h"

/* Marks of pixels whose radiance the exposures do not measure. */
enum {
    PHOTO_BRIGHT = 1, /* a colour saturates even in the shortest exposure: its radiance is a lower bound */
    PHOTO_DARK = 2,   /* a colour is dark even in the longest exposure that does not saturate: mostly noise */
};

enum { QUALITY_PADDING = 8 }; /* readable zeros after the last variance, so that whole vectors may be loaded */

struct photo_quality {
    float *variance; /* per pixel; owned */
    uint8_t *marks;  /* per pixel: PHOTO_BRIGHT, PHOTO_DARK; owned */
};

/* What is assumed of a single exposure. */
struct single_exposure {
    double electrons, read_noise; /* as in noise_given() */
    double saturated, dark; /* linear values, as fractions of white, from which and up to which a pixel is marked */
};

/* Zeroed. q is {0} on entry. */
enum status photo_quality_init(struct photo_quality *q, int width, int height, struct err *err);
/* Of one exposure with the sRGB curve. linear: the photo's linear colour, R G B. */
enum status photo_quality_of_exposure(struct photo_quality *q, const struct photo *photo, const struct image *linear,
                                      const struct single_exposure *assumed, struct err *err);
/* The same of parts of a photo with samples or bytes, which must stay. */
struct exposure_judge {
    const struct photo *photo;
    float white; /* of the photo's colour space */
    float photon, read2, saturated, dark;
    float shared_photon, shared_read2; /* of noise that is the same in all colours */
};
void photo_quality_judge_init(struct exposure_judge *j, const struct photo *photo,
                              const struct single_exposure *assumed);
/* rgb, variance, marks: of `count` pixels from pixel `first` of the photo on, in order of rows. */
void photo_quality_judge(const struct exposure_judge *j, float *variance, uint8_t *marks, const float *rgb,
                         size_t first, size_t count);
/* From the channels `variance`, whose memory it takes, and `clipped` of a file of hdr_merge. linear: its colour.
 * ST_DATA, naming path: a channel is missing or has another type. */
enum status photo_quality_of_merged(struct photo_quality *q, struct exr_image *merged, const char *path,
                                    const struct image *linear, struct err *err);
void photo_quality_release(struct photo_quality *q);

/* Standard deviation of the luminance, divided by it: above 0, at most 1. */
float photo_relative_sigma(float variance, float luminance);

#endif
