/* hole_pieces.h - pieces of furniture that its masks missed, beside the holes that it leaves in a texture. */
#ifndef REMODEL_TEXTURE_HOLE_PIECES_H
#define REMODEL_TEXTURE_HOLE_PIECES_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

/* A texture, seen straight on. All arrays are of width * height texels. */
struct hole_picture {
    int width, height;
    const float *value;  /* 3 a texel, in display units (bake.h); read where `seen` */
    const uint8_t *hole; /* 1: furniture hides the texel in all views */
    const uint8_t *seen; /* 1: a view shows it */
};

/* Sets piece[texel] to 1 for seen texels of a piece that touches a hole and ends near it, with an edge of more than
 * `edge` all around; else to 0. ST_NOMEM. */
enum status hole_pieces_find(uint8_t *piece, const struct hole_picture *picture, float edge, struct err *err);

#endif
