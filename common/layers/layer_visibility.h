/* layer_visibility.h - which segments of a view a novel camera sees, tile by tile: what both renderers are made of.
 *
 * Drawing a segment writes no colour: for each pixel of a tile the two nearest surfaces that have texels there are kept,
 * each by its nearest segment, with the place in the view that the nearer one shows. Colour is looked up once a pixel
 * after that, however many segments were drawn. Segments need no sorting, and eight pixels are drawn at once.
 *
 * The two surfaces do not depend on the order in which segments are drawn, except where three or more at one pixel make a
 * chain, each within the tolerance of the next but the first and last not: where the chain is cut then depends on the
 * order. That order is the tile's list, which is always the same. */
#ifndef REMODEL_LAYER_VISIBILITY_H
#define REMODEL_LAYER_VISIBILITY_H

#include "common/layers/segment_project.h"

#define TILE_WIDTH  128
#define TILE_HEIGHT 16
#define TILE_STRIDE (TILE_WIDTH + 8) /* of the buffers: eight pixels are written where one is meant */
#define TILE_PIXELS (TILE_STRIDE * TILE_HEIGHT)

/* A segment in the novel camera. Its linear forms in target pixels - place in the padded texels (u, v, both times w), w,
 * 1/z - are relative to the pixel (x0, y0), where single precision is enough. */
struct drawn_segment {
    float u[3], v[3], w[3], inverse_z[3]; /* at (x0, y0), by x, by y */
    float u0, v0, u1, v1;                 /* where in the padded texels it may have coverage */
    float apart;                          /* beyond this difference of 1/z, relative, another surface begins */
    uint32_t id;
    int x0, y0, x1, y1; /* target pixels, inclusive */
};

struct drawn_view { /* a view's segments as a novel camera sees them, sorted into tiles */
    struct drawn_segment *segments;
    float *sigmas; /* a segment's relative uncertainty, at least SOFT_Z_SIGMA_LEAST */
    int count;
    uint32_t *tile_begin; /* tile_count + 1 places in tile_segments */
    uint32_t *tile_segments;
    int tiles_x, tile_count;
    size_t segment_room, sigma_room, tile_room, list_room; /* what is allocated */
};

/* Buffers are kept from call to call. */
enum status drawn_view_prepare(struct drawn_view *dv, const struct layered_depth *depth, const struct layer_view *lv,
                               const struct view *view, const struct view *novel, struct err *err);
void drawn_view_release(struct drawn_view *dv);

#define VISIBLE_NONE UINT32_MAX
#define VISIBLE_FULL 0x80000000u /* in front: the segment covers the pixel whole, with the photo's colour */

/* Of the pixels of a tile, TILE_STRIDE a row. 1/z 0: none. A pixel that is not wanted has 1/z INFINITY in both. */
struct tile_visibility {
    float inverse_front[TILE_PIXELS], inverse_behind[TILE_PIXELS];
    uint32_t front[TILE_PIXELS], behind[TILE_PIXELS]; /* places in segments; front with VISIBLE_FULL or not */
    float u[TILE_PIXELS], v[TILE_PIXELS];             /* of front, in the padded texels */
    int first[TILE_HEIGHT], last[TILE_HEIGHT];        /* a row: the columns in which pixels are wanted, inclusive */
};

/* Draws the view's segments on a tile. */
void visibility_draw(struct tile_visibility *tv, const struct drawn_view *dv, const struct layer_view *lv, int tile);

struct view_samples {                         /* what views show in a tile's pixels */
    float rgba[TILE_PIXELS][4];               /* premultiplied */
    float alpha[TILE_PIXELS];                 /* that of rgba; 0: nothing is there, nor in what else is here */
    float z[TILE_PIXELS], sigma[TILE_PIXELS]; /* of the visible surface; sigma relative */
    float inside[TILE_PIXELS];                /* 1, falling to 0 towards the border of the view's picture */
};

/* Of the eight pixels from i on of a tile whose first pixel is (tile_x, tile_y). behind NULL: what is behind a front
 * that leaves something free is composited with it, saturating, and the photo is looked up bilinearly. Else it stays
 * apart (inside is the front's), with no more alpha than is left, and the photo is looked up bicubically (Catmull and
 * Rom 1974) wherever one surface is all around. */
void visibility_sample8(struct view_samples *s, struct view_samples *behind, const struct tile_visibility *tv,
                        const struct drawn_view *dv, const struct layer_view *lv, size_t i, int tile_x, int tile_y);

#endif
