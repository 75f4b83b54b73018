/* raster.h - triangles and lines into small pictures: what is in front of what.
 *
 * The buffer holds nearness, linear over a triangle in the picture: 1/z in perspective, minus the distance in an
 * orthographic view. Larger is nearer; -HUGE_VALF where nothing is. Pixel (x, y) has its centre at (x + 0.5, y +
 * 0.5). */
#ifndef REMODEL_BUILD_MODEL_RASTER_H
#define REMODEL_BUILD_MODEL_RASTER_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct raster {
    int width, height;
    float *near;        /* owned */
    unsigned char *rgb; /* owned; NULL if nearness alone is wanted */
};

enum status raster_init(struct raster *r, int width, int height, const unsigned char *background, struct err *err);
void raster_release(struct raster *r);

/* Corners: x, y in pixels, z the nearness. */
void raster_triangle(struct raster *r, struct vec3 a, struct vec3 b, struct vec3 c, const unsigned char *color);

/* A disc of soft edge, laid over what is there; opacity 0 .. 1. */
void raster_dot(unsigned char *rgb, int width, int height, double x, double y, double radius,
                const unsigned char color[3], double opacity);

#endif
