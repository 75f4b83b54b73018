/* layer_view.h - a view's two layers packed for rendering: 24 bytes a pixel, in the order in which they are read. */
#ifndef REMODEL_LAYER_VIEW_H
#define REMODEL_LAYER_VIEW_H

#include "layered_depth.h"

/* Neighbours are joined if their depths differ by at most this many times sqrt(sigma_a^2 + sigma_b^2), relative. */
#define JOIN_SIGMAS 2.0

#define TEXEL_JOINED 0x80000000u /* in id[0]: the cell of this texel and its right, lower and diagonal neighbour */

struct texel { /* of both layers, 0 interior and 1 boundary */
    uint32_t id[2];
    uint16_t rgba[2][4]; /* half */
};

struct segment_shape {
    int x0, y0, x1, y1; /* its texels, inclusive; x1 < x0: it has none */
    double u, v;        /* the centre of its interior (or of all it has) */
    double pixels;      /* of its interior */
};

struct layer_view {
    int width, height, stride; /* stride of the texels: one of padding on the left and above, two right and below */
    struct texel *texels;
    struct segment_shape *shapes; /* parallel to the depth map's segments */
};

/* The layers' planes of `depth` are freed. ST_DATA: an id without segment. */
enum status layer_view_pack(struct layer_view *lv, struct layered_depth *depth, const char *name, struct err *err);
void layer_view_release(struct layer_view *lv);

#endif
