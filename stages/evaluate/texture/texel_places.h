/* texel_places.h - where the texels of an atlas tile lie in the model: the inverse of its matrix on the face's
 * plane. */
#ifndef REMODEL_TEXEL_PLACES_H
#define REMODEL_TEXEL_PLACES_H

#include "common/texture/atlas.h"

/* The point of page pixel (x, y) is (X / W, Y / W, Z / W) with (X, Y, Z, W) = inverse (x, y, 1). */
struct texel_places {
    double inverse[4][3];
    double w[4]; /* the matrix' last row: w > 0 in front of the camera */
};

/* The tile's face lies in the plane normal . p = offset of the model's frame. False: the tile sees it from the side. */
bool texel_places_init(struct texel_places *places, const struct atlas_tile *tile, struct vec3 normal, double offset);
/* False: the texel's ray meets the plane behind the camera or at infinity. */
bool texel_place(struct vec3 *p, const struct texel_places *places, double x, double y);

#endif
