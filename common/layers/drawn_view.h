/* drawn_view.h - a view's segments in a novel camera: which tiles they may fall into, and their linear forms there.
 *
 * See drawn_view.c. Depth is z along the novel camera's axis. */
#ifndef REMODEL_DRAWN_VIEW_H
#define REMODEL_DRAWN_VIEW_H

#include "common/layers/segment_project.h"

#define TILE_WIDTH  128
#define TILE_HEIGHT 16

struct pixel_box { /* in target pixels, inclusive; x1 < x0: empty */
    int x0, y0, x1, y1;
};

/* A segment in the novel camera: linear forms in target pixels, relative to the pixel (x0, y0) so that single precision
 * suffices. u / w, v / w is the position in the padded texels. */
struct drawn_segment {
    float u[3], v[3], w[3], inverse_z[3]; /* value at (x0, y0), slope in x, slope in y */
    float u0, v0, u1, v1;                 /* bounding box in the padded texels */
    int x0, y0, x1, y1;                   /* bounding box in target pixels, inclusive */
    float surface_gap;                    /* relative difference of 1/z beyond which another surface begins */
    uint32_t id;
};

struct drawn_view { /* a view's groups of segments, sorted into the tiles of a novel camera's picture */
    const struct layered_depth *depth; /* not owned, as is lv */
    const struct layer_view *lv;
    struct view_relation relation;
    struct pixel_box *boxes; /* of each group: no segment of it has pixels outside */
    uint32_t *tile_begin;    /* tile_count + 1 indices into tile_groups */
    uint32_t *tile_groups;   /* indices of groups */
    int tiles_x, tile_count;
    size_t box_capacity, tile_capacity, list_capacity;
};

/* Sorts groups into tiles; projects no segment. Buffers of dv are reused; depth and lv must outlive its use. A view of
 * which nothing can be in the picture costs almost nothing. ST_NOMEM. */
enum status drawn_view_prepare(struct drawn_view *dv, const struct layered_depth *depth, const struct layer_view *lv,
                               const struct view *view, const struct view *novel, struct err *err);
void drawn_view_release(struct drawn_view *dv);

/* Whether a tile may show something of the view. */
static inline bool drawn_view_has_tile(const struct drawn_view *dv, int tile)
{
    return dv->tile_begin[tile] < dv->tile_begin[tile + 1];
}

struct drawn_tile { /* the segments of a view in a tile */
    struct drawn_segment *segments;
    float *sigmas;   /* relative uncertainty of each segment, at least SOFT_Z_MIN_SIGMA */
    uint32_t *order; /* indices into segments, in the order of the depth map's list */
    int count;
    uint64_t *marks;  /* a bit for each segment of the depth map: scratch, all 0 */
    uint32_t *places; /* of those marked, the index into segments */
    size_t segment_capacity, sigma_capacity, order_capacity, mark_capacity, place_capacity;
};

/* The pixels of a tile that are still to be drawn. */
struct open_pixels {
    int x, y;                     /* first pixel of the tile */
    struct pixel_box box;         /* all open pixels are in it */
    uint64_t row[TILE_HEIGHT][2]; /* a bit for each pixel, columns 0 .. 63 and 64 .. 127 */
};

/* Whether there is an open pixel in columns x0 .. x1 of rows y0 .. y1, in target pixels. */
static inline bool open_pixels_any(const struct open_pixels *open, int x0, int y0, int x1, int y1)
{
    const int left = (x0 > open->box.x0 ? x0 : open->box.x0) - open->x;
    const int right = (x1 < open->box.x1 ? x1 : open->box.x1) - open->x;
    const int top = (y0 > open->box.y0 ? y0 : open->box.y0) - open->y;
    const int bottom = (y1 < open->box.y1 ? y1 : open->box.y1) - open->y;
    uint64_t any[2] = {0, 0};

    if (left > right) return false;
    for (int y = top; y <= bottom; y++) {
        any[0] |= open->row[y][0];
        any[1] |= open->row[y][1];
    }
    if (left < 64 && any[0] >> left << left << (right < 63 ? 63 - right : 0)) return true;
    const int from = left > 64 ? left - 64 : 0;
    return right >= 64 && any[1] >> from << from << (127 - right);
}

/* Projects the segments whose bounding box has open pixels. Buffers of t are reused. ST_NOMEM leaves t without
 * segments. */
enum status drawn_tile_project(struct drawn_tile *t, const struct drawn_view *dv, int tile,
                               const struct open_pixels *open, struct err *err);
void drawn_tile_release(struct drawn_tile *t);

#endif
