/* oversegment.h - a view divided into small connected segments of similar colour, and the borders between them. */
#ifndef REMODEL_OVERSEGMENT_H
#define REMODEL_OVERSEGMENT_H

#include "stages/segment_depth/gamma_image.h"

struct segment {
    int first, pixels;  /* into segmentation.pixel */
    double cx, cy;      /* centroid, pixel coordinates */
    int x0, y0, x1, y1; /* bounding box, inclusive */
    float colour[3];    /* mean; L a b of oversegment.c, 0..100 */
};

struct border { /* one direction of the border between two adjacent segments */
    int other;
    int length;     /* pixel sides */
    int edge;       /* number of the border, the same in both directions */
    float u, v;     /* middle of the border */
    float contrast; /* mean colour difference across the border, L a b */
};

struct segmentation {
    int width, height, count, edge_count;
    int *label; /* w * h: segment of a pixel, -1 where the view has none */
    int *pixel; /* pixel indices, segment by segment, ascending within one */
    struct segment *segments;
    int *first_border;      /* count + 1: borders of segment i are [first_border[i], first_border[i + 1]) */
    struct border *borders; /* in order of `other` */
};

/* SLIC superpixels of about segment_pixels pixels each; a higher compactness makes them rounder. s is {0} on entry.
 * Same result for any number of threads. ST_NOMEM. */
enum status oversegment(struct segmentation *s, const struct gamma_image *g, int segment_pixels, double compactness,
                        struct err *err);
/* The same segments, by the same numbers, in the picture g, of which gamma_image_half_covering() made the one that
 * `half` divides. They have no colours, and their borders no contrast. s is {0} on entry. ST_NOMEM. */
enum status oversegment_double(struct segmentation *s, const struct segmentation *half, const struct gamma_image *g,
                               struct err *err);
void oversegment_release(struct segmentation *s);

#endif
