/* texture.h - procedural textures: the albedo (0..1) of a face at a point on it.
 *
 * u and v are metres from the face's corner along its axes; on vertical faces v points up. A texture is a pure
 * function of the point and of the face's seed, which varies it so that no two faces look the same. Edges are softened
 * over 3 mm; detail finer than a pixel is averaged by the pixel's samples. */
#ifndef REMODEL_SIMULATE_TEXTURE_H
#define REMODEL_SIMULATE_TEXTURE_H

#include <stdint.h>

#include "common/light/colour.h"

enum texture_kind {
    TEXTURE_RGB,
    TEXTURE_CHECKER,
    TEXTURE_WOOD,
    TEXTURE_BRICK,
    TEXTURE_PLASTER,
    TEXTURE_PRINT,
    TEXTURE_BOOKS,
    TEXTURE_KINDS,
};

struct texture {
    enum texture_kind kind;
    /* m, by kind. checker: size of a square; wood: scale; brick: width, height, mortar; plaster: scale, amount (no
     * unit); print, books: width, height */
    double size[3];
    uint32_t seed;
    struct rgb colour[2];
};

struct rgb texture_at(const struct texture *t, uint32_t face, double u, double v);

/* An upper bound of all channels of the texture. */
double texture_bound(const struct texture *t);

#endif
