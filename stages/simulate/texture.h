/* texture.h - procedural textures: the colour (albedo, 0..1) of a face at a place on it.
 *
 * u and v are metres along the face's axes from its corner, v upwards where the face stands. A texture is a fixed
 * function of the place, the same for every ray that meets it; edges are softened over a millimetre or two, and what is
 * finer than a pixel is averaged by the samples of that pixel. A number that belongs to the face varies it, so that no two
 * faces bear the same marks. */
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
    double
        size[3]; /* checker: size; wood: scale; brick: width height mortar; plaster: scale amount; print, books: width
                       height */
    uint32_t seed;
    struct rgb colour[2];
};

struct rgb texture_at(const struct texture *t, uint32_t face, double u, double v);

/* No channel of the texture is above this anywhere. */
double texture_bound(const struct texture *t);

#endif
