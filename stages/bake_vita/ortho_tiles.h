/* ortho_tiles.h - the tiles of a surface seen orthogonally. */
#ifndef REMODEL_ORTHO_TILES_H
#define REMODEL_ORTHO_TILES_H

#include "common/texture/bake.h"

/* Texels of the surface's bounding rectangle, whose sides lie along the axes of ortho_axes()
 * (common/texture/ortho.h). */
size_t ortho_texels(const struct surfaces *s, int surface, double side);

/* Adds the surface's tiles to the bake, every texel of its area wanted, with a margin of one texel for look-ups at its
 * edge. side: of a texel, model units. */
enum status ortho_tiles_add(struct bake *b, int surface, double side, struct err *err);

#endif
