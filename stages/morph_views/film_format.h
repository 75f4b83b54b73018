/* film_format.h - photographs brought to the film's format: upright, and of the film's size.
 *
 * Scene-linear R G B; pixel centres at +0.5, in the film as in the stored photo. */
#ifndef REMODEL_FILM_FORMAT_H
#define REMODEL_FILM_FORMAT_H

#include "common/image/image.h"

struct film_picture {
    struct image rgb;
    int stored_width, stored_height; /* of the stored photo, whose pixels its lens refers to */
    double photo_from_film[2][3];    /* affine: stored photo's pixels from film pixels */
    double film_from_photo[2][3];
};

/* Size of the film for a first photo of this size, upright: even, and at most max_side. A photo within max_side keeps
 * its pixels; an odd row or column is cut off. ST_DATA: the photo is too small. */
enum status film_size(int *width, int *height, int photo_width, int photo_height, int max_side, struct err *err);

/* Size of a stored photo after turning it upright; orientation: EXIF, 1..8. */
void film_upright_size(int *width, int *height, int stored_width, int stored_height, int orientation);

/* stored: R G B. Turns the photo upright, scales it until it covers the film (larger photos by a tent filter; scale 1
 * copies pixels), and crops it centrally. ST_DATA: more than half of the photo would be cut off. Same bits for any
 * number of threads. */
enum status film_picture_make(struct film_picture *out, const struct image *stored, int orientation, int width,
                              int height, struct err *err);
void film_picture_release(struct film_picture *p);

static inline void film_map(const double m[2][3], double x, double y, double *u, double *v)
{
    *u = m[0][0] * x + m[0][1] * y + m[0][2];
    *v = m[1][0] * x + m[1][1] * y + m[1][2];
}

#endif
