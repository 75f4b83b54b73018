/* flat_edges.h - the outline of what lies flat on a face, such as a rug, from one pixel: where its colour ends. */
#ifndef REMODEL_FLAT_EDGES_H
#define REMODEL_FLAT_EDGES_H

#include <stdint.h>

#include "common/image/image.h"

/* A corner of an outline, pixel coordinates. */
struct flat_corner {
    double u, v;
};

/* Finds the convex outline around the pixel (x, y) at which its colour ends most clearly. open: of each pixel, whether
 * the view shows the face there. *corners: the outline's, in order; the caller frees them; NULL and *count 0 if no
 * outline stands out, or if it reaches the border of the picture. ST_NOMEM. */
enum status flat_edges_find(struct flat_corner **corners, int *count, const struct image *photo, const uint8_t *open,
                            int x, int y, struct err *err);

#endif
