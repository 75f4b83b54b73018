/* oversegment.h - a view cut into small connected segments of like colour, and which of them touch. */
#ifndef REMODEL_OVERSEGMENT_H
#define REMODEL_OVERSEGMENT_H

#include "stages/segment_depth/gamma_image.h"

struct segment {
    int first, pixels;  /* into segmentation.pixel */
    double cx, cy;      /* centroid, pixel coordinates */
    int x0, y0, x1, y1; /* bounding box, inclusive */
    float colour[3];    /* mean; L a b of oversegment.c, 0..100 */
};

struct touch { /* one direction of a border between two segments */
    int other;
    int length;     /* pixel sides that they share */
    int edge;       /* the border's number, the same in both directions */
    float u, v;     /* the border's middle */
    float contrast; /* mean colour difference across the border, L a b */
};

struct segmentation {
    int width, height, count, edge_count;
    int *label; /* w * h: segment of a pixel, -1 where the view has none */
    int *pixel; /* pixel indices, segment by segment, ascending within one */
    struct segment *segments;
    int *first_touch;      /* count + 1: touches of segment i are [first_touch[i], first_touch[i + 1]) */
    struct touch *touches; /* in order of `other` */
};

/* SLIC (Achanta et al. 2012) with connected segments; the same for any number of threads. s is {0} on entry. */
enum status oversegment(struct segmentation *s, const struct gamma_image *g, int segment_pixels, double compactness,
                        struct err *err);
void segmentation_release(struct segmentation *s);

#endif
