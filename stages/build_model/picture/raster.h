/* raster.h - small pictures of triangles and discs, with a depth buffer.
 *
 * The buffer holds nearness, which is linear over a triangle in the picture: 1/z in perspective, minus the distance in
 * an orthographic view. Larger is nearer; empty pixels have -HUGE_VALF. Pixel (x, y) has its centre at (x + 0.5, y +
 * 0.5). */
#ifndef REMODEL_BUILD_MODEL_RASTER_H
#define REMODEL_BUILD_MODEL_RASTER_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct raster {
    int width, height;
    float *near;        /* owned */
    unsigned char *rgb; /* owned; NULL: nearness alone */
};

enum status raster_init(struct raster *r, int width, int height, const unsigned char *background, struct err *err);
void raster_release(struct raster *r);

/* Corners have x, y in pixels and z the nearness. color may be NULL if rgb is. */
void raster_triangle(struct raster *r, struct vec3 a, struct vec3 b, struct vec3 c, const unsigned char *color);

/* Blends a disc with a soft edge over the picture; radius in pixels, opacity 0 .. 1. */
void raster_dot(unsigned char *rgb, int width, int height, double x, double y, double radius,
                const unsigned char color[3], double opacity);

#endif
