/* surfaces.h - what textures are made for: the faces of the unedited model, each with the area that it has there and in
 * all declared edits.
 *
 * An edit may widen a face: below a wall that it removes there is floor which no photograph shows, under the id of the
 * room's floor. So a surface is an id with a plane, and its area is the union of all polygons of that id in that plane,
 * in any of the models. Polygons that an edit moved to another plane, and ids that the unedited model lacks, are left
 * out: they take their texture from elsewhere. */
#ifndef REMODEL_SURFACES_H
#define REMODEL_SURFACES_H

#include <stdbool.h>
#include <stdint.h>

#include "common/model/solid_mesh.h"

struct surface {
    int id;
    struct vec3 normal; /* unit, towards the room: normal . p = offset on the surface */
    double offset;
    bool glass;           /* a pane: shows what lies behind it */
    int first, triangles; /* its triangles */
};

struct surfaces {
    struct surface *list;        /* in order of id, then of plane; owned */
    struct vec3 (*triangles)[3]; /* owned; they overlap where several models have the same area */
    int count, triangle_count;
    double size; /* largest coordinate of a vertex, as a magnitude: what lengths are compared with */
};

/* models[0]: the unedited model; the rest: those of the edits. The caller releases s in each case. */
enum status surfaces_make(struct surfaces *s, const struct solid_mesh *models, int count, struct err *err);
void surfaces_release(struct surfaces *s);

/* The first surface of a face id, -1: none; the others of that id follow it. */
int surfaces_find(const struct surfaces *s, int id);
/* The surface of a face id whose plane holds a point to `tolerance`; the nearest one; -1: none. */
int surfaces_find_at(const struct surfaces *s, int id, struct vec3 p, double tolerance);

/* A raster laid over a surface: pixel centre (x + 0.5, y + 0.5) shows the point (X, Y, Z) / W of the model's frame,
 * (X, Y, Z, W) = point (x, y, 1), if W > 0. */
struct surface_raster {
    int width, height;
    double point[4][3];
};

/* Sets inside[y * width + x] to 1 where a pixel's centre lies in the surface's area, and leaves the others alone. */
void surface_fill(uint8_t *inside, const struct surfaces *s, int surface, const struct surface_raster *r);

#endif
