/* shade_tiles.h - texels of eight neighbouring pixels of a row at a time. */
#ifndef REMODEL_RENDER_SHADE_TILES_H
#define REMODEL_RENDER_SHADE_TILES_H

#include "common/math/lanes.h"
#include "stages/render_model/shade.h"

/* A tile of an atlas in a tile of the picture. */
struct tile_lanes {
    struct lanes x, y, w;
    const struct shade_tile *tile;
    bool whole; /* all pixels of the picture's tile look into it */
};

/* Keeps the tiles that pixels (x, y) to (x + side - 1, y + side - 1) may look into. Returns their number. */
int tile_lanes_make(struct tile_lanes *to, const struct shade_tile *tiles, int count, int x, int y, int side);

#define TEXELS_SHIFT 8 /* places are multiples of 1/256 texel */

struct texels {
    f32x4 rgba[LANES];                   /* A is 1 where there is a texel */
    int x[LANES], y[LANES], tile[LANES]; /* places, from the frame's upper left texel; in which tile of the list */
};

/* The texels of the pixels whose bits are set in `lanes`; the first of the eight is `down` rows and `right` columns
 * from the pixel that the lists were made for. Returns those that have one. */
unsigned tile_texels_find(struct texels *t, const struct tile_lanes *list, int count, unsigned lanes, float down,
                          float right);
/* What the nearest of the four texels that exist comes from: its neighbours in the row and the column, then the one
 * across, follow the nearest place. */
enum picture_made tile_texels_made_near(const struct texels *t, const struct tile_lanes *list, int lane);
/* What the nearest texel of a pixel that has one comes from. */
static inline enum picture_made texels_made(const struct texels *t, const struct tile_lanes *list, int lane)
{
    const struct shade_tile *s = list[t->tile[lane]].tile;
    const int half = 1 << (TEXELS_SHIFT - 1);
    const int x = (t->x[lane] + half) >> TEXELS_SHIFT, y = (t->y[lane] + half) >> TEXELS_SHIFT;
    const uint8_t made = s->made[y * (ptrdiff_t)s->stride + x];
    return made != MADE_NOTHING ? made : tile_texels_made_near(t, list, lane);
}

/* The texel nearest to a pixel, wherever it looks; false: the tiles are empty. */
bool tile_texel_nearest(float rgb[3], const struct tile_lanes *list, int count, int lane, float down, float right);

#endif
