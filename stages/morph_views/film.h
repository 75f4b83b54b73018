/* film.h - a photograph as the film shows it: upright, of the film's size.
 *
 * Scene-linear R G B; pixel centres at +0.5, in the film as in the stored photo. */
#ifndef REMODEL_MORPH_FILM_H
#define REMODEL_MORPH_FILM_H

#include "common/image/image.h"

struct film_picture {
    struct image rgb;
    int stored_width, stored_height; /* of the photo; its lens is of these pixels */
    double photo_from_film[2][3];    /* affine, to pixels of the stored photo */
    double film_from_photo[2][3];
};

/* The film's size for a first photo of this size, upright: even, at most max_side, with the photo's own pixels where no
 * reduction is needed (an odd row or column is cut off). ST_DATA: the photo is too small to make a film. */
enum status film_size(int *width, int *height, int photo_width, int photo_height, int max_side, struct err *err);

/* Width and height of a stored photo once it is turned upright (EXIF, 1..8). */
void film_upright_size(int *width, int *height, int stored_width, int stored_height, int orientation);

/* stored: R G B. The photo is turned upright, scaled until it covers the film, and cut evenly where it sticks out;
 * scale 1 takes the pixels as they are. Larger photos are reduced by a tent filter. ST_DATA: more than half of the
 * photo would be cut. Same bits for any number of threads. */
enum status film_picture_make(struct film_picture *out, const struct image *stored, int orientation, int width,
                              int height, struct err *err);
void film_picture_release(struct film_picture *p);

static inline void film_map(const double m[2][3], double x, double y, double *u, double *v)
{
    *u = m[0][0] * x + m[0][1] * y + m[0][2];
    *v = m[1][0] * x + m[1][1] * y + m[1][2];
}

#endif
