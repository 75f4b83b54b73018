/* layer_view.h - a view's two layers packed for rendering, in the order in which they are read: 40 bytes a pixel, and
 * 64 for each cell of more than two segments.
 *
 * A cell is what lies between the centres of a texel, its right, lower and diagonal neighbour. Where all of it belongs
 * to one surface, its colour is that of the photo, whichever of its segments asks; elsewhere a segment's coverage and
 * colour are the sums over its own texels. */
#ifndef REMODEL_LAYER_VIEW_H
#define REMODEL_LAYER_VIEW_H

#include "common/layers/layered_depth.h"

/* Neighbours are joined if their depths differ by at most this many times sqrt(sigma_a^2 + sigma_b^2), relative. */
#define JOIN_SIGMAS 2.0

#define TEXEL_JOINED 0x80000000u /* in id[0]: the cell of this texel and its right, lower and diagonal neighbour */

struct texel { /* of both layers, 0 interior and 1 boundary */
    uint32_t id[2];
    uint16_t rgba[2][4]; /* half */
};

/* What segments a cell has, in two words: the first one's id and the flags; the second one's id, 0 for none. Or with
 * CELL_MANY the first holds the place in the list of ids, and the second is 0. */
#define CELL_SPLIT 0x80000000u /* its segments are not of one surface, or it is at a border of what is known */
#define CELL_MANY  0x40000000u
#define CELL_IDS   8 /* of a cell with many, 0 where there are fewer */

struct many_cell { /* of more than two segments, or of two at a border; surface[i] tells which are of one surface */
    uint32_t id[CELL_IDS];
    uint8_t surface[CELL_IDS];
    uint8_t padding[24];
};

struct segment_shape {
    int x0, y0, x1, y1; /* its texels, inclusive; x1 < x0: it has none */
    double u, v;        /* the centre of its interior (or of all it has) */
    double pixels;      /* of its interior */
};

struct layer_view {
    int width, height, stride; /* stride of the texels: one of padding on the left and above, two right and below */
    struct texel *texels;
    uint16_t (*photo)[4]; /* both layers composited: half, premultiplied; stride and padding of the texels */
    uint32_t *cells[2];   /* first and second word of the cell that begins at a texel */
    struct many_cell *many;
    struct segment_shape *shapes; /* parallel to the depth map's segments */
};

/* The layers' planes of `depth` are freed. ST_DATA: an id without segment. */
enum status layer_view_pack(struct layer_view *lv, struct layered_depth *depth, const char *name, struct err *err);
void layer_view_release(struct layer_view *lv);

#endif
