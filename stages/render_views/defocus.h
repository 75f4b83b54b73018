/* defocus.h - depth of field of the fast renderer: a pinhole frame blurred by a MIP map [Colburn 2014, 3.6.1].
 *
 * Aperture (diameter of the lens) and focus (depth along the camera's axis) are in scene units. See defocus.c. */
#ifndef REMODEL_RENDER_VIEWS_DEFOCUS_H
#define REMODEL_RENDER_VIEWS_DEFOCUS_H

#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"

#define DEFOCUS_LEVELS 24

/* The MIP maps, reused from frame to frame. {0} is the empty state. */
struct defocus {
    int width, height, threads, level_count; /* levels 1 .. level_count; 0 is the frame */
    struct defocus_level {
        int width, height;
        size_t stride, plane; /* floats of one channel of a row, and of all channels of a row */
        float *texels;
    } levels[DEFOCUS_LEVELS];
    float *memory, *scratch; /* memory of all levels; scratch lines of the threads */
    size_t scratch_size;     /* floats per thread */
};

/* Blurs rgba (premultiplied) of a frame of this camera by its z; z and hole stay. Depth 0 (unknown) counts as infinite.
 * Aperture 0 changes nothing. ST_DATA: aperture below 0, or focus not above 0. Same bits for any number of threads. */
enum status defocus_apply(struct defocus *d, struct rendered_frame *frame, const struct view *camera, double aperture,
                          double focus, struct err *err);
void defocus_release(struct defocus *d);

#endif
