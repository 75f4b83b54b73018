/* eyes_picture.h - one picture of those of two eyes. */
#ifndef REMODEL_ENCODE_VIDEO_EYES_PICTURE_H
#define REMODEL_ENCODE_VIDEO_EYES_PICTURE_H

#include "common/film/stereo_boxes.h"
#include "common/image/image.h"

enum film_eyes {
    FILM_ONE_EYE,
    FILM_SIDE_BY_SIDE, /* left eye on the left; each of full size */
    FILM_TOP_BOTTOM,   /* left eye on top */
    FILM_ANAGLYPH,     /* for glasses with a red left and a cyan right lens */
    FILM_VR180,        /* half-spheres side by side */
    FILM_EYES
};

/* The kind of that name, or FILM_EYES. */
enum film_eyes eyes_find(const char *name);
enum stereo_mode eyes_mode(enum film_eyes eyes);
void eyes_size(enum film_eyes eyes, int *width, int *height); /* of the picture, from that of an eye's */

/* Fills `out`, of eyes_size(), from two scene-linear pictures of 3 channels and one size. */
void eyes_picture(struct image *out, const struct image *left, const struct image *right, enum film_eyes eyes);

#endif
