/* shade_tiles.h - texels of eight neighbouring pixels of a row at a time. */
#ifndef REMODEL_RENDER_SHADE_TILES_H
#define REMODEL_RENDER_SHADE_TILES_H

#include "stages/render_model/shade.h"

/* A tile of an atlas in a tile of the picture. */
struct tile_lanes {
    struct lanes x, y, w;
    const struct shade_tile *tile;
    bool whole; /* all pixels of the picture's tile look into it */
};

/* Keeps the tiles that pixels (x, y) to (x + side - 1, y + side - 1) may look into. Returns their number. */
int tile_lanes_make(struct tile_lanes *to, const struct shade_tile *tiles, int count, int x, int y, int side);

struct texels {
    __m128 rgba[LANES]; /* A is 1 where there is a texel */
    int x[LANES], y[LANES], tile[LANES];
};

/* The texels of the pixels whose bits are set in `lanes`; the first of the eight is `down` rows and `right` columns from
 * the pixel that the lists were made for. Returns those that have one. */
unsigned texels_find(struct texels *t, const struct tile_lanes *list, int count, unsigned lanes, float down,
                     float right);
/* What the nearest texel of a pixel that has one comes from. */
enum picture_made texels_made(const struct texels *t, const struct tile_lanes *list, int lane);

/* The texel nearest to a pixel, wherever it looks; false: the tiles are empty. */
bool texel_nearest(float rgb[3], const struct tile_lanes *list, int count, int lane, float down, float right);

#endif
