/* visible.h - which face of a solid model each pixel of a pinhole view shows, and how far away it is.
 *
 * Pixels are stored tile by tile, so that a tile is contiguous. Tiles at the right and the lower border reach beyond
 * the picture. */
#ifndef REMODEL_RENDER_VISIBLE_H
#define REMODEL_RENDER_VISIBLE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/capture/camera_set.h"
#include "common/model/solid_mesh.h"

#define VISIBLE_TILE   64 /* px: side of a tile */
#define VISIBLE_PIXELS (VISIBLE_TILE * VISIBLE_TILE)

/* The triangles of a model that are drawn. {0} is the empty state. */
struct visible_model {
    const struct solid_mesh *mesh;    /* must outlive this */
    struct solid_triangle *triangles; /* in order of face; owned */
    int count;
    double size; /* largest side of the model's bounding box */
};

/* drawn[face]: whether the face is drawn; NULL: all are. The caller releases the model. */
enum status visible_model_make(struct visible_model *m, const struct solid_mesh *mesh, const bool *drawn,
                               struct err *err);
void visible_model_release(struct visible_model *m);

/* {0} is the empty state; everything is owned. A picture after another one reuses its memory. */
struct visible {
    int width, height, columns, rows; /* px; tiles */
    uint32_t *face;                   /* 1 + index of the face in the mesh; 0: none */
    float *inverse_z;                 /* 1 / depth along the camera's axis; 0 where there is no face */
    struct visible_triangle *list;    /* triangles in front of the camera */
    int *first, *bins;                /* tile i has bins[first[i]] .. bins[first[i + 1] - 1], indices into list */
    size_t pixel_room, list_room, first_room, bin_room;
};

/* camera: in the model's frame. A face is seen from outside of its solid only: a camera inside a solid looks through
 * it. Same bits for any number of threads. */
enum status visible_draw(struct visible *v, const struct visible_model *m, const struct view *camera, struct err *err);
void visible_release(struct visible *v);

#endif
