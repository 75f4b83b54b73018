/* photo_measures.h - how sharp and how well exposed a photograph is. */
#ifndef REMODEL_PHOTO_MEASURES_H
#define REMODEL_PHOTO_MEASURES_H

#include <stdbool.h>

#include <stddef.h>

struct photo_measures {
    double edge;         /* width of its sharper edges, px; 0: it has too few edges to tell */
    double bright, dark; /* fractions of pixels that are white, or black */
    bool round;          /* all four corners are black, but not the middle: the circle of a fisheye lens */
};

/* rgb: 8 bits in sRGB, interleaved. luma: room for a byte a pixel, which is overwritten.
 *
 * An edge is a rise or fall of the luma along a row or a column by a seventh of the range or more; its width is the
 * height divided by the largest step [Marziliano 2004]. The lower quartile is taken, since what is out of focus or
 * round has wide edges in a sharp photo too; of rows and columns the larger one, since a shaken camera blurs in one
 * direction. White pixels are so in all colours. */
void photo_measures_take(struct photo_measures *m, const unsigned char *rgb, int width, int height,
                         unsigned char *luma);

#endif
