/* layer_visibility.h - visibility of one view's segments in a novel camera, tile by tile; used by both renderers.
 *
 * Depth is z along the novel camera's axis. See layer_visibility.c. */
#ifndef REMODEL_LAYER_VISIBILITY_H
#define REMODEL_LAYER_VISIBILITY_H

#include "common/layers/drawn_view.h"

#define TILE_STRIDE (TILE_WIDTH + 8) /* of the buffers: rows are written in groups of eight pixels */
#define TILE_PIXELS (TILE_STRIDE * TILE_HEIGHT)

#define VISIBLE_NONE UINT32_MAX
#define VISIBLE_FULL 0x80000000u /* flag: the segment covers the pixel completely, with the photo's colour */

/* The two nearest surfaces in each pixel of a tile, TILE_STRIDE pixels a row. Before drawing, 1/z is 0 in pixels to
 * draw and INFINITY in pixels to skip. */
struct tile_visibility {
    float inverse_front[TILE_PIXELS], inverse_behind[TILE_PIXELS]; /* 1/z; 0: no surface */
    uint32_t front[TILE_PIXELS], behind[TILE_PIXELS]; /* index into the drawn segments, perhaps with VISIBLE_FULL */
    float u[TILE_PIXELS], v[TILE_PIXELS];             /* of the front surface, in the padded texels */
    int first[TILE_HEIGHT], last[TILE_HEIGHT];        /* range of columns to draw in each row, inclusive */
};

/* Draws the view's segments into a tile; `segments` gets those that were projected for it. ST_NOMEM draws nothing. */
enum status visibility_draw(struct tile_visibility *tv, struct drawn_tile *segments, const struct drawn_view *dv,
                            int tile, struct err *err);

struct view_samples {                         /* colour and depth of views in a tile's pixels */
    float rgba[TILE_PIXELS][4];               /* premultiplied */
    float alpha[TILE_PIXELS];                 /* copy of rgba's; 0: no surface, all other fields are 0 */
    float z[TILE_PIXELS], sigma[TILE_PIXELS]; /* of the visible surface; sigma relative */
    float inside[TILE_PIXELS];                /* 1, falling to 0 towards the border of the view's picture */
};

/* Samples the eight pixels from i on of a tile whose first pixel is (tile_x, tile_y).
 * behind NULL (fast): a partly covering front is composited with the surface behind it, with saturating alpha, and the
 * photo is looked up bilinearly. Otherwise (offline): `behind` gets the surface behind, with the alpha that the front
 * leaves free (inside is set in s only), and the photo is looked up bicubically [Catmull 1974] within one surface. */
void visibility_sample8(struct view_samples *s, struct view_samples *behind, const struct tile_visibility *tv,
                        const struct drawn_tile *segments, const struct layer_view *lv, size_t i, int tile_x,
                        int tile_y);
/* alpha, z and sigma alone, as visibility_sample8 sets them without `behind`. */
void visibility_cover8(struct view_samples *s, const struct tile_visibility *tv, const struct drawn_tile *segments,
                       const struct layer_view *lv, size_t i, int tile_x, int tile_y);

#endif
