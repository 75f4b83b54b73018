/* hemicube_picture.h - a picture of the light that a point sees: its hemicube, unfolded (unfold.h). */
#ifndef REMODEL_HEMICUBE_PICTURE_H
#define REMODEL_HEMICUBE_PICTURE_H

#include "common/gather/irradiance.h"

/* Writes a JPEG of 2 n x 2 n pixels, n even: the radiance, exposed so that nine tenths of it are below half of white.
 * Striped: no picture shows what is there (synthesised texels, guessed sky, nothing). */
enum status hemicube_picture_write(const struct light_field *f, struct gather_point p, int n, const char *path,
                                   struct err *err);

#endif
