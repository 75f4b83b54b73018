/* defocus.h - depth of field of the fast renderer: a finished pinhole frame, blurred through a MIP pyramid (thesis
 * 3.6.1).
 *
 * A pixel at depth z has the circle of confusion c = aperture fx (z - focus) / (z focus) px, below 0 if it is nearer
 * than the focus. What lies in or behind the focus and what lies before it are two pyramids, blurred in two ways, as
 * light is:
 *
 *  - before the focus a surface's light spreads over whatever is behind it. Each pixel's colour and coverage descend
 *    to the level of its own blur and are left there; the levels, brought up again and added, are the near layer,
 *    whose coverage fades across a silhouette. What is nearer is blurred more, so a coarser level
 *    covers a finer one where they add up to more than 1. The layer is laid over the rest.
 *  - in or behind the focus a pixel sees through its own circle what is not hidden by nearer things. It looks up the
 *    level of its own blur in a pyramid where a pixel counts on the way down only as long as its own blur is of the
 *    level's size: what is sharp or near does not bleed into a blurred background. Near pixels count nothing; behind
 *    them stands what surrounds them.
 *
 * The look-up is trilinear, bottom up: level by level bilinear (weights 3/4 1/4 on each axis), down by its transpose
 * (1 3 3 1) / 8, so that a moving point's blur moves evenly. The kernel of level l has the variance (4^l - 1) / 2, a
 * disk c^2 / 16, hence l = log4(1 + c^2 / 8). In between stand the level smoothed by (1 2 1) / 4, of twice the
 * variance, and the mixture of neighbours that has the variance asked for.
 *
 * What differs from the thesis: it blends pixels behind the focus with a blurred picture by the mean depth and part of
 * near pixels around; its kernels are Gaussians on one level. */
#ifndef REMODEL_RENDER_VIEWS_DEFOCUS_H
#define REMODEL_RENDER_VIEWS_DEFOCUS_H

#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"

#define DEFOCUS_LEVELS 24

/* The pyramids, kept from frame to frame. {0} is the empty state. */
struct defocus {
    int width, height, threads, level_count; /* levels 1 .. level_count; 0 is the frame */
    struct defocus_level {
        int width, height;
        size_t stride, plane; /* in floats: of a row, of a plane of rows */
        float *texels;
    } levels[DEFOCUS_LEVELS];
    float *memory, *scratch; /* of all levels; of the threads */
    size_t scratch_size;     /* in floats, a thread */
};

/* Blurs rgba (premultiplied) of a frame of that camera by its z; z and hole stay. Where z is 0 nothing is nearer.
 * aperture 0: nothing is touched. ST_DATA: an aperture below 0, a focus that is not above 0. Same bits for any
 * number of threads. */
enum status defocus_apply(struct defocus *d, struct rendered_frame *frame, const struct view *camera, double aperture,
                          double focus, struct err *err);
void defocus_release(struct defocus *d);

#endif
