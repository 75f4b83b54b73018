/* overlay_shape.h - what the picture of a model's edges depends on, so that only those are drawn that changed. */
#ifndef REMODEL_OVERLAY_SHAPE_H
#define REMODEL_OVERLAY_SHAPE_H

#include "common/base/hash.h"
#include "common/capture/photo_camera.h"
#include "common/model/solid_mesh.h"

struct shape_face {
    char hash[HASH_TEXT]; /* of its edges, and whether it is a pane */
    int face;             /* of the mesh */
};

/* {0} is the empty state. */
struct overlay_shape {
    struct shape_face *faces; /* in order of hash; owned */
    int count;
};

/* The caller releases the shape in each case. */
enum status overlay_shape_make(struct overlay_shape *shape, const struct solid_mesh *mesh, struct err *err);
void overlay_shape_release(struct overlay_shape *shape);
/* The same for meshes with the same edges and faces, whatever their names and order. */
enum status overlay_shape_hash(char hash[HASH_TEXT], const struct overlay_shape *shape, struct err *err);

/* Whether a photo may show, or would if nothing hid it, a face that only one of two meshes has. */
bool overlay_shape_differs(const struct solid_mesh *a, const struct overlay_shape *of_a, const struct solid_mesh *b,
                           const struct overlay_shape *of_b, const struct photo_camera *camera);

#endif
