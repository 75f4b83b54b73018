/* layer_visibility.h - visibility of one view's segments in a novel camera, tile by tile; used by both renderers.
 *
 * Depth is z along the novel camera's axis. See layer_visibility.c. */
#ifndef REMODEL_LAYER_VISIBILITY_H
#define REMODEL_LAYER_VISIBILITY_H

#include "common/layers/segment_project.h"

#define TILE_WIDTH  128
#define TILE_HEIGHT 16
#define TILE_STRIDE (TILE_WIDTH + 8) /* of the buffers: rows are written in groups of eight pixels */
#define TILE_PIXELS (TILE_STRIDE * TILE_HEIGHT)

/* A segment in the novel camera: linear forms in target pixels, relative to the pixel (x0, y0) so that single precision
 * suffices. u / w, v / w is the position in the padded texels. */
struct drawn_segment {
    float u[3], v[3], w[3], inverse_z[3]; /* value at (x0, y0), slope in x, slope in y */
    float u0, v0, u1, v1;                 /* bounding box in the padded texels */
    float surface_gap;                    /* relative difference of 1/z beyond which another surface begins */
    uint32_t id;
    int x0, y0, x1, y1; /* bounding box in target pixels, inclusive */
};

struct drawn_view { /* a view's segments projected into a novel camera and sorted into tiles */
    struct drawn_segment *segments;
    float *sigmas; /* relative uncertainty of each segment, at least SOFT_Z_MIN_SIGMA */
    float *levels; /* MIP level at which each segment's photo is looked up; 0: the photo itself */
    bool reduced;  /* some level is above 0 */
    int count;
    uint32_t *tile_begin;    /* tile_count + 1 indices into tile_segments */
    uint32_t *tile_segments; /* indices into segments */
    int tiles_x, tile_count;
    size_t segment_capacity, sigma_capacity, level_capacity, tile_capacity, list_capacity;
};

/* Buffers of dv are reused. ST_NOMEM. */
enum status drawn_view_prepare(struct drawn_view *dv, const struct layered_depth *depth, const struct layer_view *lv,
                               const struct view *view, const struct view *novel, struct err *err);
void drawn_view_release(struct drawn_view *dv);

#define VISIBLE_NONE UINT32_MAX
#define VISIBLE_FULL 0x80000000u /* flag: the segment covers the pixel completely, with the photo's colour */

/* The two nearest surfaces in each pixel of a tile, TILE_STRIDE pixels a row. Before drawing, 1/z is 0 in pixels to
 * draw and INFINITY in pixels to skip. */
struct tile_visibility {
    float inverse_front[TILE_PIXELS], inverse_behind[TILE_PIXELS]; /* 1/z; 0: no surface */
    uint32_t front[TILE_PIXELS], behind[TILE_PIXELS]; /* index into segments, with or without VISIBLE_FULL */
    float u[TILE_PIXELS], v[TILE_PIXELS];             /* of the front surface, in the padded texels */
    int first[TILE_HEIGHT], last[TILE_HEIGHT];        /* range of columns to draw in each row, inclusive */
};

/* Draws the view's segments into a tile. */
void visibility_draw(struct tile_visibility *tv, const struct drawn_view *dv, const struct layer_view *lv, int tile);

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
                        const struct drawn_view *dv, const struct layer_view *lv, size_t i, int tile_x, int tile_y);

#endif
