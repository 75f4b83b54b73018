/* rendered_frame.h - the picture of a novel camera: colour, depth, and where no view saw anything. */
#ifndef REMODEL_RENDERED_FRAME_H
#define REMODEL_RENDERED_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

struct rendered_frame {
    int width, height;
    float *rgba;                             /* w * h * 4, linear, premultiplied; alpha 1, or 0 in what is not filled */
    float *z;                                /* w * h, depth in the novel camera, 0 unknown */
    uint8_t *hole;                           /* w * h: 1 where no segment was, before filling */
    double hole_fraction, unfilled_fraction; /* of the pixels: before and after filling */
};

/* Buffers of this size, kept if they have it already; without colour rgba and z are NULL. {0} is a valid frame. */
enum status rendered_frame_resize(struct rendered_frame *frame, int width, int height, bool color, struct err *err);
void rendered_frame_release(struct rendered_frame *frame);

#endif
