/* layer_raster.h - one view's segments drawn in a novel camera: what layer_render.c is made of.
 *
 * A segment's plane p = (a, b, c), 1/z = p . (u, v, 1), and the relative pose X_view = R X_novel + t give, in
 * pixels,
 *   M = K_view R K_novel^-1,   k = K_view t,   m = M^T p / (1 - p . k)
 *   1/z_novel = m . (x, y, 1),   (u, v, 1) ~ (M + k m^T) (x, y, 1)
 * and 1 - p . k <= 0 where the novel camera is behind the plane: such a segment is not drawn.
 *
 * A target pixel taken back to the view gathers its four neighbours there: coverage and premultiplied colour are the
 * bilinear sums over those texels whose layer id is this segment's. In a cell whose texels all belong to segments of
 * one surface (linked by JOIN_SIGMAS below) the whole cell counts for each of them: neighbours on one surface then overlap
 * by up to a pixel with the same texture in both, so that planes that differ slightly show no crack while the novel
 * camera moves, and edges at depth jumps stay anti-aliased. */
#ifndef REMODEL_LAYER_RASTER_H
#define REMODEL_LAYER_RASTER_H

#include "layer_view.h"
#include "soft_z.h"

struct raster_segment { /* a segment as a novel camera sees it */
    uint32_t id;
    float sigma;
    double from_target[3][3]; /* target pixel -> index into the padded texels, homogeneous */
    double inverse_z[3];      /* 1/z_novel = inverse_z . (x, y, 1) */
    double u0, v0, u1, v1;    /* where in the padded texels it may have coverage */
    int x0, x1;               /* target columns, inclusive */
};

struct raster_order { /* what sorting and looking for a band's segments need, close together */
    double depth;     /* of the segment's centre in the novel camera */
    uint32_t id;
    int segment, y0, y1; /* y0, y1: target rows, inclusive */
};

struct raster_view {
    struct raster_segment *segments;
    struct raster_order *order; /* front to back by depth, ties by id */
    int count;
};

/* Of the view's segments those that the novel camera may see. */
enum status raster_view_prepare(struct raster_view *rv, const struct layered_depth *depth, const struct layer_view *lv,
                                const struct view *view, const struct view *novel, struct err *err);
void raster_view_release(struct raster_view *rv);

struct raster_surface {
    float z, alpha, sigma; /* means over its fragments */
};

struct raster_fragment { /* of a segment in a pixel */
    float rgba[4];       /* premultiplied, alpha > 0 */
    float z, sigma;
    float inside; /* 1, falling to 0 towards the border of the view's picture */
};

struct raster_pixel { /* what one view has accumulated */
    float rgba[4];
    float inside; /* sum over its fragments, weighted as the colour */
    struct raster_surface front, back;
};

/* Puts a fragment on a pixel: behind or beside what is there with weight min(alpha, 1 - accumulated); before it if it
 * is nearer than the front surface by more than `reach` (segments are sorted by their centres, which slanted ones can
 * belie). */
void raster_composite(struct raster_pixel *p, const struct raster_fragment *fragment, float reach);

/* The depth of a pixel is that of one surface, never a mean across a jump: the front surface's if it has at least
 * half of the alpha, else the one behind it. */
const struct raster_surface *raster_visible(const struct raster_pixel *p);

/* Rows [y0, y1) of the target in buffers of (y1 - y0) * width, first column 0. skip[i]: fragments with 1/z <=
 * skip[i] are not drawn at pixel i: 0 draws all, INFINITY none; it rises where a pixel is full. pixels: zeroed by
 * the caller where not masked. spans: first and last column of each row that need drawing at all. */
struct raster_target {
    int y0, y1, width;
    struct raster_pixel *pixels;
    float *skip;
    const int (*spans)[2];
};
void raster_rows(const struct raster_target *target, const struct raster_view *rv, const struct layer_view *lv,
                 const struct soft_z *soft);

#endif
