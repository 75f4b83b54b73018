/* layer_view.h - a view's two layers, packed for rendering: 43 bytes a pixel, 64 for each cell of many segments, and
 * 100 a segment.
 *
 * A cell is the square between the centres of a texel and of its right, lower and diagonal neighbours. In a cell of one
 * surface every segment has the photo's colour; in a split cell a segment's coverage and colour are sums over its own
 * texels. */
#ifndef REMODEL_LAYER_VIEW_H
#define REMODEL_LAYER_VIEW_H

#include "common/layers/layered_depth.h"

/* Adjacent segments are one surface if their depths differ, relatively, by at most this times
 * sqrt(sigma_a^2 + sigma_b^2). */
#define JOIN_SIGMAS 2.0

#define TEXEL_JOINED 0x80000000u /* flag in id[0]: the cell that begins at this texel is one surface */

struct texel { /* layer 0: interior, 1: boundary */
    uint32_t id[2];
    uint16_t rgba[2][4]; /* half */
};

/* A cell's segments in two words: id of the first segment and flags; id of the second segment, 0 if there is none. With
 * CELL_MANY the first word is an index into the list of cells of many segments, and the second is 0. */
#define CELL_SPLIT 0x80000000u /* its segments are several surfaces, or some texel has no depth */
#define CELL_MANY  0x40000000u
#define CELL_IDS   8 /* ids of a cell of many segments, padded with 0 */

struct many_cell { /* a cell of more than two segments, or of two beside a texel without depth */
    uint32_t id[CELL_IDS];
    uint8_t surface[CELL_IDS]; /* number of each segment's surface in this cell */
    uint8_t padding[24];
};

struct segment_shape {
    int x0, y0, x1, y1; /* bounding box of its texels, inclusive; x1 < x0: it has none */
    double u, v;        /* centroid of its interior; without interior, centre of the bounding box */
    double pixels;      /* of its interior */
};

#define PHOTO_LEVELS 8

struct photo_level { /* the photo reduced by a power of two: means of 2 x 2 texels of the level before, premultiplied */
    int stride;      /* padding as in struct layer_view */
    uint16_t (*texels)[4];
};

/* Segments that are near each other in the picture: what projecting them needs, four or eight at a time. Each has its
 * bounding box, grown to the outer edges of the cells that its texels touch. */
#define GROUP_SEGMENTS 8

struct segment_group {
    double plane[3][GROUP_SEGMENTS];
    double inverse_z[GROUP_SEGMENTS]; /* at the segment's centroid; 0: there is none, or nobody can see it */
    float u0[GROUP_SEGMENTS], v0[GROUP_SEGMENTS], u1[GROUP_SEGMENTS], v1[GROUP_SEGMENTS]; /* px of the view */
    float sigma[GROUP_SEGMENTS];       /* relative uncertainty, at least SOFT_Z_MIN_SIGMA */
    float surface_gap[GROUP_SEGMENTS]; /* relative difference of 1/z beyond which another surface begins */
    uint32_t index[GROUP_SEGMENTS];    /* in the depth map's list */
};

/* What four groups fill: rectangles of the view and ranges of 1/z. high_inverse 0: nobody sees a segment of the
 * group. */
#define BOUNDS_GROUPS 4

struct group_bounds {
    double u0[BOUNDS_GROUPS], v0[BOUNDS_GROUPS], u1[BOUNDS_GROUPS], v1[BOUNDS_GROUPS];
    double low_inverse[BOUNDS_GROUPS], high_inverse[BOUNDS_GROUPS];
};

struct layer_view {
    int width, height, stride; /* stride of the texels; padding: one texel left and above, two right and below */
    struct texel *texels;
    uint16_t (*photo)[4];                     /* both layers composited: half, premultiplied; same stride and padding */
    struct photo_level reduced[PHOTO_LEVELS]; /* by 2, 4, 8, ... */
    int reduced_count;
    uint32_t *cells[2]; /* first and second word of the cell that begins at each texel */
    struct many_cell *many;
    struct segment_shape *shapes; /* of the depth map's segments, in their order */
    struct segment_group *groups;
    struct group_bounds *bounds; /* of the groups, four by four; the last one bounds all groups in its first place */
    int group_count;
};

/* Packs `depth` and frees its layers' planes; its segments stay. ST_DATA: a pixel's id has no segment. ST_NOMEM. */
enum status layer_view_pack(struct layer_view *lv, struct layered_depth *depth, const char *name, struct err *err);
void layer_view_release(struct layer_view *lv);

/* The photo at pixel (x, y), premultiplied. */
void layer_view_photo(const struct layer_view *lv, int x, int y, float rgba[4]);
/* Multiplies the colours of pixel (x, y). layer_view_reduce() must follow. */
void layer_view_scale(struct layer_view *lv, int x, int y, const float factor[3]);
/* Makes the reduced photos anew. ST_NOMEM. */
enum status layer_view_reduce(struct layer_view *lv, struct err *err);

#endif
