/* aperture.h - depth of field of the offline renderer: pinhole frames averaged over a lens [Colburn 2014, 3.6.2].
 *
 * Aperture (diameter of the lens) and focus (depth along the camera's axis) are in scene units. See aperture.c. */
#ifndef REMODEL_RENDER_VIEWS_APERTURE_H
#define REMODEL_RENDER_VIEWS_APERTURE_H

#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"

/* name, type, default, min, max, unit, help: for the table of the stage's parameters */
#define APERTURE_PARAMS(X)                                                                               \
    X(aperture_samples, int, 128, 1, 4096, "",                                                           \
      "offline: maximum number of lens samples, one pinhole frame each, per frame with depth of field")  \
    X(aperture_error, double, 0.012, 0, 1, "",                                                           \
      "offline: lens samples are added until the estimated error, in gamma-encoded pixel values from 0 " \
      "to 1, is below this")

/* Renders the frame of a pinhole camera; `out` is reused from call to call. */
typedef enum status aperture_pinhole(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err);

struct aperture_options {
    int max_samples;
    double max_error;
};

struct aperture_stats {
    int samples;  /* lens samples averaged; 0 without aperture */
    double error; /* estimated error of the mean; 0 without aperture, 1 if there were too few samples for an estimate */
};

/* Lens sample `index` (from 0), a point of the unit disk. */
void aperture_lens_point(int index, double *x, double *y);

/* out: rgba is the (premultiplied) mean of the frames from the lens samples; z, hole and fractions are those of one
 * more frame, at the lens's centre. With aperture 0 this frame is the result. stats may be NULL. ST_DATA: aperture
 * below 0, or focus not above 0. Same bits for any number of threads. */
enum status aperture_render(struct rendered_frame *out, const struct view *camera, double aperture, double focus,
                            const struct aperture_options *options, aperture_pinhole *render, void *ctx,
                            struct aperture_stats *stats, struct err *err);

#endif
