/* pixel_quality.h - noise and marks of a photo's pixels, as a filter passes them on. */
#ifndef REMODEL_PIXEL_QUALITY_H
#define REMODEL_PIXEL_QUALITY_H

#include "common/capture/photo_quality.h"
#include "common/math/lanes.h"
#include "stages/rectify/kernel_taps.h"

struct pixel_quality {
    const struct photo_quality *of;
    int width, height;
    uint8_t *tiles; /* owned: the union of the marks in each tile */
};

/* Allocates tiles for up to `pixels` pixels. ST_NOMEM. */
enum status pixel_quality_init(struct pixel_quality *q, size_t pixels, struct err *err);
/* Fills tiles for the present size. */
void pixel_quality_prepare(struct pixel_quality *q);
void pixel_quality_release(struct pixel_quality *q);

/* Union of the marks in columns x0 to x1 - 1 and rows y0 to y1 - 1; those beyond the border are those at it. */
uint8_t pixel_quality_marks(const struct pixel_quality *q, int x0, int y0, int x1, int y1);
/* Variance of the filtered luminance; taps beyond the border repeat the sample there. */
float pixel_quality_variance(const struct pixel_quality *q, const struct kernel_taps *tx, const struct kernel_taps *ty);
/* The same for n by n taps from (x, y) on, all inside the photo, n at most LANES. across: weights, 0 from n on. */
float pixel_quality_sharp_variance(const struct pixel_quality *q, int x, int y, f32x8 across, const float *down, int n);

#endif
