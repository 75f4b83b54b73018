/* draw.h - lines and dots on 8-bit pictures, and the exposure of a linear picture to draw on.
 *
 * Places are in pixels; the centre of pixel (x, y) is at (x + 0.5, y + 0.5). What lies outside of the picture is
 * cut. */
#ifndef REMODEL_DRAW_H
#define REMODEL_DRAW_H

#include "common/image/image.h"

struct canvas {
    unsigned char *rgb; /* sRGB, interleaved, row-major; not owned */
    int width, height;
};

/* A line with round ends and soft edges; `half` of its width. Ends must be finite. */
void draw_line(const struct canvas *k, double x0, double y0, double x1, double y1, double half,
               const unsigned char colour[3]);

/* A disc with a dark rim of one pixel. */
void draw_dot(const struct canvas *k, double x, double y, double radius, const unsigned char colour[3]);

/* Scales R, G and B of an image of 4 channels so that `share` of the pixels with an A above 0.5 have a luminance of at
 * most `level` (1 is white). A black image stays black. ST_NOMEM. */
enum status image_expose(struct image *im, double share, double level, struct err *err);

#endif
