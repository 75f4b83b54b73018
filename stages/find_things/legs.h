/* legs.h - legs of standing things, which are too thin for depth: found by their colours before the floor. */
#ifndef REMODEL_LEGS_H
#define REMODEL_LEGS_H

#include "common/capture/view.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "common/model/thing_volume.h"
#include "common/texture/view_ids.h"

/* A thing that may stand on legs. */
struct legged {
    uint32_t id;
    struct vec3 low, high; /* the box around its surfaces, model frame */
    double floor;          /* Z of the floor below it */
};

struct gap;
/* {0} is the empty state. */
struct legs {
    struct voxel_grid grid;
    struct gap *gaps; /* below things, with the floor around them; owned */
    int count;
    float dark; /* radiance that is added to all colours before they are compared; 0: no view was seen yet */
};

/* Finds the gaps between these things' surfaces and the floor; a thing without one is left out. */
enum status legs_init(struct legs *l, const struct thing_volume *surfaces, const struct legged *things, int count,
                      struct err *err);
void legs_release(struct legs *l);

/* A view as legs are sought in it. */
struct legs_view {
    struct view camera;                /* model frame */
    const struct layered_depth *depth; /* scene units, like those of ids */
    const struct view_ids *ids;
    const struct image *photo;
    double scale; /* model units per scene unit */
};

/* First with all views, then legs_settle(), then the second with all views. */
void legs_learn_floor(struct legs *l, const struct legs_view *view);
void legs_settle(struct legs *l);
void legs_look(struct legs *l, const struct legs_view *view);

/* Adds the legs that were found to the surfaces, and tells the volume that they are solid. *voxels: which these are;
 * the caller frees it. ST_NOMEM. */
enum status legs_take(int64_t **voxels, size_t *count, struct legs *l, struct thing_volume *surfaces, struct err *err);

#endif
