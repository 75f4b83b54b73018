/* rendered_frame.h - the picture of a novel camera: colour, depth and hole mask. */
#ifndef REMODEL_RENDERED_FRAME_H
#define REMODEL_RENDERED_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

struct rendered_frame {
    int width, height;
    float *rgba;                             /* w * h * 4, scene-linear, premultiplied; alpha 1, or 0 if not filled */
    float *z;                                /* w * h, depth along the novel camera's axis, 0 unknown */
    uint8_t *hole;                           /* w * h: 1 where no view covers the pixel, before filling */
    double hole_fraction, unfilled_fraction; /* fractions of the pixels, before and after filling */
};

/* Allocates buffers of this size; reuses those of the same size. Without `color` rgba and z are NULL. {0} is a valid
 * frame. ST_NOMEM leaves the frame empty. */
enum status rendered_frame_resize(struct rendered_frame *frame, int width, int height, bool color, struct err *err);
void rendered_frame_release(struct rendered_frame *frame);

#endif
