/* aperture.h - depth of field of the offline renderer: the view moved over a lens, averaged on the plane in focus
 * (thesis 3.6.2).
 *
 * A pinhole at the lens's centre sees the camera point (X, Y, Z) at u = fx X / Z + cx. From the lens point (a, b), an
 * offset of the centre in the camera's x and y, with the principal point moved by fx a / focus, it is at
 *   u' = fx (X - a) / Z + cx + fx a / focus = u + fx a (1 / focus - 1 / Z) = u + fx a (Z - focus) / (Z focus)
 * (v the same with fy and b): exactly u at Z = focus, so that frames need not be warped to be averaged; elsewhere
 * the lens's disk, |(a, b)| <= aperture / 2, becomes the circle of confusion, of diameter aperture fx |Z - focus| /
 * (Z focus) px. What is in focus is a plane parallel to the picture.
 *
 * Lens points: Sobol's first two dimensions, Owen-scrambled (common/base/rng.h), mapped to the disk with areas kept (P.
 * Shirley and K. Chiu 1997): the same for all frames, so that nothing flickers. Measured on smooth functions of the
 * lens their mean errs half as much at 32 and more points as that of the R2 sequence, and halves tell more of it. */
#ifndef REMODEL_RENDER_VIEWS_APERTURE_H
#define REMODEL_RENDER_VIEWS_APERTURE_H

#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"

/* name, type, default, least, most, unit, help: for the table of the stage's parameters */
#define APERTURE_PARAMS(X)                                                       \
    X(aperture_samples, int, 128, 1, 4096, "",                                   \
      "most points of the lens, a pinhole frame each, of a frame with depth of " \
      "field")                                                                   \
    X(aperture_error, double, 0.012, 0, 1, "",                                   \
      "points are added until the estimated error is below this, 1 being "       \
      "white and errors those of encoded pixels")

/* Renders the frame of a pinhole camera; out is kept from call to call. */
typedef enum status aperture_pinhole(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err);

struct aperture_options {
    int most;     /* points of the lens */
    double error; /* good enough */
};

struct aperture_stats {
    int samples;  /* points of the lens that were averaged; 0 without aperture */
    double error; /* estimated, of the mean; 0 without aperture, 1 if there were too few points to tell */
};

/* Point of the unit disk. */
void aperture_lens_point(int index, double *x, double *y);

/* out: rgba the (premultiplied) mean of the frames from the lens's points; z, hole and fractions of one more frame,
 * at the lens's centre. aperture 0: that frame itself. Points are added in batches that double their number, from 8.
 * The error estimate: with the means A and B of the points before and in the last batch, n_A and n_B of them, the
 * error of the whole mean is about |A - B| sqrt(n_A n_B) / (n_A + n_B); of it, on square roots of colours cut at
 * white, the root mean square in each 32x32 tile, and of the tiles the 98th percentile, so that a small blurred part
 * is not lost in a sharp picture. stats may be NULL. ST_DATA: an aperture below 0, a focus that is not above 0. Same
 * bits for any number of threads. */
enum status aperture_render(struct rendered_frame *out, const struct view *camera, double aperture, double focus,
                            const struct aperture_options *options, aperture_pinhole *render, void *ctx,
                            struct aperture_stats *stats, struct err *err);

#endif
